"""The answers of a model to a problem: what is read from them, and the lines that they add to the problem's picture."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from comparisons.claims.claim import StoppedError
from comparisons.claims.manual.problem import Problem, Reading, Trial, varied
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.response import Array, Response
from comparisons.response.axis import STATIONS, axes_at_stations
from comparisons.response.table import table
from comparisons.scene import Scene

ANSWER = "exact answer"
"""Style of curves of the exact answer, which no model computed."""


class Curve(NamedTuple):
    """A line of a picture; its style also is its label, and rows of nan part its points (n, 2) into pieces."""

    style: str
    points: Array


class Answers:
    """A model at a problem, and the curves that it adds to the picture."""

    def __init__(self, problem: Problem, trial: Trial) -> None:
        self.trial, self.scene, self.shown = trial, trial.scene, problem.picture.shown
        self.curves: list[Curve] = []

    def solved(
        self, scene: Scene | None = None, *, draw: bool = True, options: Options | None = None
    ) -> Response:
        """Return the response to the trial's scene or another one, whose deflected axes are drawn."""
        scene = scene or self.scene
        response = answered(scene, self.trial.key, options or self.trial.options)
        if draw:
            self.curves.append(deflected(scene, response, self.trial.model, self.shown))
        return response

    def draw(self, *lines: Array | Sequence[Sequence[float]], style: str = "") -> None:
        """Draw lines of points (n, 2) that are not joined, by default in the style of the model."""
        self.curves.append(pieces(style or self.trial.model, lines))


def answered(scene: Scene, model: str, options: Options | None = None) -> Response:
    """Return the response of a model to a scene.

    Raises StoppedError if it is not complete and checked.
    """
    response = solve(scene, model, options)
    if not response.completed:
        raise StoppedError(f"{response.status}: {response.message}")
    return response


def readings(problem: Problem, answers: Answers) -> list[float]:
    """Read every quantity from the answer to the problem's scene, with what each changes in it."""
    found: dict[str, Response] = {}
    values = []
    for reading in problem.readings:
        key = repr(reading.changes)
        if key not in found:
            found[key] = answers.solved(varied(answers.scene, reading.changes))
        values.append(reading.times * _read(found[key], reading))
    return values


def _read(response: Response, reading: Reading) -> float:
    found = value(response, reading.words, reading.at)
    if reading.since is not None:
        found -= value(response, reading.words, reading.since)
    return found / _read(response, reading.over) if reading.over else found


def value(response: Response, words: str, at: float) -> float:
    """Return a number of a response at a load parameter of its scene; nan for an event that it does not have.

    The words are a name of `comparisons.response.table`, of a vector without ``_x`` for its size; ``axis BEAM .5 x``, a place of the axis at
    half the length; ``slip-off PAIR``, and ``event KIND PAIR 0``, the load parameter of the first one.
    """
    what, *more = words.split()
    if what == "slip-off":
        return response.contacts[more[0]].slip_off
    if what == "event":
        kind, pair, number = more
        located = [
            one.load_parameter for one in response.events or () if (one.kind, one.pair) == (kind, pair)
        ]
        return float(next(iter(located[int(number) :]), np.nan))
    k = step(response, at)
    if what == "axis":
        beam, part, direction = more
        station = round(float(part) * (len(STATIONS) - 1))
        return float(axes_at_stations(response, beam, [k])[0, station, "xy".index(direction)])
    columns = table(replace(response, definition=None))
    if what in columns:
        return float(columns[what][k])
    return float(np.hypot(columns[f"{what}_x"][k], columns[f"{what}_y"][k]))


def step(response: Response, load_parameter: float) -> int:
    """Return the number of a load parameter of the scene."""
    k = int(np.argmin(np.abs(response.load_parameter - load_parameter)))
    assert abs(response.load_parameter[k] - load_parameter) < 1e-9, "must be one of the scene's"
    return k


def deflected(scene: Scene, response: Response, style: str, shown: Sequence[float] = (1.0,)) -> Curve:
    """Return the deflected axes of all beams at some load parameters as one curve."""
    at = [(beam.name, step(response, t)) for beam in scene.beams for t in shown]
    return pieces(style, (response.axis_line(name, k)[1] for name, k in at))


def pieces(style: str, lines: Iterable[Array | Sequence[Sequence[float]]]) -> Curve:
    """Return lines that are not joined as one curve."""
    parted = [
        part for line in lines for part in (np.asarray(line, dtype=np.float64), np.full((1, 2), np.nan))
    ]
    return Curve(style, np.concatenate(parted[:-1]))


def undeformed(scene: Scene) -> tuple[Curve, ...]:
    """Return the undeformed axes and the paths of the pins."""
    axes = pieces("undeformed", ([beam.start, beam.end] for beam in scene.beams))
    return (axes, pieces("path of the pin", (pin.points for pin in scene.pins))) if scene.pins else (axes,)

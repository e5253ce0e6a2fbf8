"""The answers of a model to a problem: what is read from them, and the lines that they add to the problem's picture."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from comparisons.claims.claim import StoppedError
from comparisons.claims.manual.problem import Problem, Trial, varied
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.response import Array, Response
from comparisons.response.axis import STATIONS, axes_at_stations
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

    Raises
    ------
    StoppedError
        If it is not complete and checked.
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
        values.append(reading.times * value(found[key], reading.words, reading.at))
    return values


def value(response: Response, words: str, at: float) -> float:
    """Return a number of a response at a load parameter of its scene; nan for an event that it does not have.

    The words are ``force PAIR``, ``arc PAIR``, ``dissipated PAIR``, ``moment NODE``, ``reaction NODE x``, ``tip BEAM x``, ``axis BEAM .5 x``
    at half the length, with ``x``, ``y`` or ``size``; ``slip-off PAIR``, and ``event KIND PAIR 0``, the load parameter of the first one.
    """
    what, name, *more = words.split()
    if what == "slip-off":
        return response.contacts[name].slip_off
    if what == "event":
        pair, number = more
        located = [
            one.load_parameter for one in response.events or () if (one.kind, one.pair) == (name, pair)
        ]
        return float(next(iter(located[int(number) :]), np.nan))
    k = step(response, at)
    if what in ("force", "arc", "dissipated"):
        contact = response.contacts[name]
        spent = None if contact.friction is None else contact.friction.dissipated
        values = {"force": contact.force, "arc": contact.arc_position, "dissipated": spent}[what]
        assert values is not None, "all state their friction"
        return float(values[k])
    if what == "moment":
        return float(response.supports[name].moment[k])
    if what == "axis":
        vector = axes_at_stations(response, name, [k])[0, round(float(more[0]) * (len(STATIONS) - 1))]
    else:
        vector = (response.supports[name].force if what == "reaction" else response.tips[name])[k]
    return float({"x": vector[0], "y": vector[1], "size": np.hypot(*vector)}[more[-1]])


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

"""The answers of a model to a problem: what is read from them, and the lines that they add to the problem's picture."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from comparisons.claims.manual.problem import Line, Problem, Quantity, Trial, varied
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.response import Response
from comparisons.response.axis import STATIONS, axes_at_stations
from comparisons.response.table import table
from comparisons.scene import Scene

ANSWER = "exact answer"
"""Style of lines of the exact answer, which no model computed."""


class StoppedError(RuntimeError):
    """A solution that stopped before it had an answer: its status and sentence."""


class Answers:
    """A model at a problem, and the lines that it adds to the picture."""

    def __init__(self, problem: Problem, trial: Trial) -> None:
        self.trial, self.scene, self.shown = trial, trial.scene, problem.picture.shown
        self.lines: list[Line] = []

    def solved(
        self, scene: Scene | None = None, *, draw: bool = True, options: Options | None = None
    ) -> Response:
        """Return the response to the trial's scene or another one, whose deflected axes are drawn."""
        scene = scene or self.scene
        response = answered(scene, self.trial.key, options or self.trial.options)
        if draw:
            self.lines.extend(deflected(scene, response, self.trial.model, self.shown))
        return response

    def draw(self, *lines: ArrayLike, style: str = "") -> None:
        """Draw lines of points (n, 2), by default in the style of the model."""
        self.lines.extend((style or self.trial.model, np.asarray(line, dtype=float)) for line in lines)


def answered(scene: Scene, model: str, options: Options | None = None) -> Response:
    """Return the response of a model to a scene; one that is not complete and checked is a `StoppedError`."""
    response = solve(scene, model, options)
    if not response.completed:
        raise StoppedError(f"{response.status}: {response.message}")
    return response


def readings(problem: Problem, answers: Answers) -> list[float]:
    """Read every quantity from the answer to the problem's scene, with what each changes in it."""
    found: dict[str, Response] = {}
    for one in problem.quantities:
        if repr(one.changes) not in found:
            found[repr(one.changes)] = answers.solved(varied(answers.scene, one.changes))
    return [one.times * _read(found[repr(one.changes)], one) for one in problem.quantities]


def _read(response: Response, quantity: Quantity) -> float:
    found = value(response, quantity.read, quantity.at)
    if quantity.since is not None:
        found -= value(response, quantity.read, quantity.since)
    return found / _read(response, quantity.over) if quantity.over else found


def value(response: Response, words: str, at: float) -> float:
    """Return a number of a response at a load parameter; nan for an event that it does not have."""
    # a name of `comparisons.response.table`, of a vector without _x for its size; "axis BEAM .5 x", a place
    # of the axis at half the length; "slip-off PAIR"; "event KIND PAIR 0", the load parameter of the first
    # one
    what, *more = words.split()
    if what == "slip-off":
        return response.contacts[more[0]].slip_off
    if what == "event":
        kind, pair, number = more
        located = [
            one.load_parameter for one in response.events or () if [one.kind, one.pair] == [kind, pair]
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


def deflected(
    scene: Scene, response: Response, style: str, shown: Sequence[float] = (1.0,)
) -> Iterator[Line]:
    """Yield the deflected axes of all beams at some load parameters."""
    for beam in scene.beams:
        yield from ((style, response.axis_line(beam.name, step(response, t))[1]) for t in shown)


def undeformed(scene: Scene) -> Iterator[Line]:
    """Yield the undeformed axes and the paths of the pins."""
    yield from (("undeformed", np.array([beam.start, beam.end])) for beam in scene.beams)
    yield from (("path of the pin", np.array(pin.points)) for pin in scene.pins)

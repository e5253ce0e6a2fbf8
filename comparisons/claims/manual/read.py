"""What the manual reads from answers, and the answers of its models."""

from collections.abc import Iterable, Sequence

import numpy as np

from comparisons.claims.claim import StoppedError
from comparisons.claims.manual.problem import Curve, Measured, Problem, Trial, varied
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.response import Array, Response
from comparisons.response.axis import STATIONS, axes_at_stations
from comparisons.scene import Scene

BREAK = np.full((1, 2), np.nan)
"""Row of nan that separates two pieces of a curve."""
ANSWER = "exact answer"
"""Style of curves of the exact answer, which no model computed."""


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
            event.load_parameter
            for event in response.events or ()
            if (event.kind, event.pair) == (name, pair)
        ]
        return located[int(number)] if -1 <= int(number) < len(located) and located else np.nan
    k = step(response, at)
    if what in ("force", "arc"):
        contact = response.contacts[name]
        return float((contact.force if what == "force" else contact.arc_position)[k])
    if what == "dissipated":
        friction = response.contacts[name].friction
        assert friction is not None, "all state their friction"
        return float(friction.dissipated[k])
    if what == "moment":
        return float(response.supports[name].moment[k])
    if what == "reaction":
        vector = response.supports[name].force[k]
    elif what == "tip":
        vector = response.tips[name][k]
    else:
        vector = axes_at_stations(response, name, [k])[0, round(float(more[0]) * (len(STATIONS) - 1))]
    return float({"x": vector[0], "y": vector[1], "size": np.hypot(*vector)}[more[-1]])


def step(response: Response, load_parameter: float) -> int:
    """Return the number of a load parameter of the scene."""
    k = int(np.argmin(np.abs(response.load_parameter - load_parameter)))
    assert abs(response.load_parameter[k] - load_parameter) < 1e-9, "must be one of the scene's"
    return k


def readings(problem: Problem, trial: Trial) -> Measured:
    """Read every quantity from the answer of a model to the problem's scene, with what each changes in it."""
    answers: dict[str, tuple[Scene, Response]] = {}
    values = []
    for reading in problem.readings:
        key = repr(reading.changes)
        if key not in answers:
            scene = varied(trial.scene, reading.changes)
            answers[key] = scene, answered(scene, trial.key, trial.options)
        values.append(reading.times * value(answers[key][1], reading.words, reading.at))
    shown = problem.picture.shown
    return Measured(
        values=tuple(values),
        curves=tuple(deflected(scene, found, trial.model, shown) for scene, found in answers.values()),
    )


def deflected(scene: Scene, response: Response, style: str, shown: Sequence[float] = (1.0,)) -> Curve:
    """Return the deflected axes of all beams at some load parameters as one curve."""
    return pieces(
        style,
        (response.axis_line(beam.name, step(response, t))[1] for beam in scene.beams for t in shown),
    )


def pieces(style: str, lines: Iterable[Array]) -> Curve:
    """Return lines that are not joined as one curve."""
    parted = [part for line in lines for part in (np.asarray(line, dtype=np.float64), BREAK)]
    return Curve(style=style, points=np.concatenate(parted[:-1]))


def undeformed(scene: Scene) -> tuple[Curve, ...]:
    """Return the undeformed axes and the paths of the pins."""
    axes = pieces("undeformed", (np.array([beam.start, beam.end]) for beam in scene.beams))
    if not scene.pins:
        return (axes,)
    return axes, pieces("path of the pin", (np.array(pin.points) for pin in scene.pins))

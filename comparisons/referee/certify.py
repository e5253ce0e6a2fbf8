"""The certificate of an answer: judgements at load parameters, and checks of the path between them."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from itertools import pairwise
from time import perf_counter

import numpy as np

from comparisons.referee.certificate import Certificate, Judgement, Verdict
from comparisons.referee.distance import scales
from comparisons.referee.equilibrium import SearchStatus
from comparisons.referee.follow import at_rest, departs
from comparisons.referee.history import History
from comparisons.referee.judge import impossible, judged
from comparisons.referee.passing import changes, passages
from comparisons.referee.rubbing import rubs_wrongly_on_the_way
from comparisons.referee.state import Equilibrium
from comparisons.response import Response
from comparisons.scene import Scene
from comparisons.scene.keys import REFEREE, unstated

ALLOWED = 1e-2
"""Default of the largest difference allowed; smaller differences are not visible in a plot."""


def certify(
    response: Response, scene: Scene, *, at: Sequence[int] | None = None, allowance: float | None = None
) -> Certificate:
    """Judge `response` to `scene`.

    Parameters
    ----------
    response : Response
        The answer of any model, complete or incomplete.
    scene : Scene
        The scene that was solved.
    at : sequence of int, optional
        Indices of the load parameters to judge; negative ones count from the end. The default are the last one of every stage and the
        ones next to events. Between neighbours without an event the path is followed too.
    allowance : float, optional
        Largest difference allowed; the default is `default_allowance`.
    """
    began = perf_counter()
    unknown = unstated(scene, "the referee", REFEREE)
    if unknown is not None:
        allowed = ALLOWED if allowance is None else allowance
        return Certificate(
            verdict=Verdict.NOT_JUDGED, reason=unknown, allowance=allowed, judged=(), path=(), seconds=0.0
        )
    response = replace(response, axis_line=cache(response.axis_line))
    allowed = default_allowance(response, scene) if allowance is None else allowance
    steps = len(response.load_parameter)
    numbers = (
        tuple(sorted({*beside_events(response), *ends_of_stages(response, scene)}))
        if at is None
        else tuple(sorted({k % steps for k in at if -steps <= k < steps}))
    )
    history = _history(response, scene)
    states = tuple(judged(response, scene, k, allowed, history=history) for k in numbers)
    states = tuple(_on_the_path(response, scene, numbers, states, allowed, history))
    path = tuple(_path(response, scene))
    if history is not None:
        path += tuple(rubs_wrongly_on_the_way(history, numbers, states, allowed))
    verdict, reason = _worst(states, path, steps)
    gone = next(_departures(response, scene, states, numbers), "") if verdict is Verdict.CERTIFIED else ""
    if gone:
        verdict, reason = Verdict.UNSTABLE, gone
    if history is not None and history.taken:
        reason = f"{reason}; {history.taken}"
    return Certificate(
        verdict=verdict, reason=reason, allowance=allowed, judged=states, path=path,
        seconds=perf_counter() - began,
    )  # fmt: skip


def _on_the_path(
    response: Response,
    scene: Scene,
    numbers: Sequence[int],
    states: Sequence[Judgement],
    allowed: float,
    history: History | None,
) -> Iterator[Judgement]:
    """Yield the judgements; a refused state is judged again with the largest force and moment of all judged load parameters.

    A moment that changes its sign is small at one load parameter, and a difference relative to it alone is large.
    """
    sizes = [scales(scene, item.exact) for item in states if item.exact is not None]
    largest = tuple(max(column, default=0.0) for column in zip(*sizes, strict=True)) or (0.0, 0.0)
    for k, item in zip(numbers, states, strict=True):
        if item.verdict is Verdict.NOT_AN_EQUILIBRIUM and item.exact is not None:
            yield judged(
                response,
                scene,
                k,
                allowed,
                history=history,
                exact=item.exact,
                largest=(largest[0], largest[1]),
            )
        else:
            yield item


_GRAVITY = (
    Verdict.CERTIFIED,
    Verdict.NOT_JUDGED,
    Verdict.UNSTABLE,
    Verdict.INADMISSIBLE,
    Verdict.NOT_AN_EQUILIBRIUM,
)


def _worst(states: Sequence[Judgement], path: Sequence[str], steps: int) -> tuple[Verdict, str]:
    """Return the most serious verdict and its reason."""
    if not states:
        what = "asked for" if steps else "reached"
        return Verdict.NOT_JUDGED, f"no load parameter was {what}"
    worst = max(states, key=lambda item: _GRAVITY.index(item.verdict))
    if path and worst.verdict is not Verdict.NOT_AN_EQUILIBRIUM:
        return Verdict.INADMISSIBLE, path[0]
    if worst.verdict is Verdict.CERTIFIED:
        return Verdict.CERTIFIED, _certified_reason(states, steps)
    return worst.verdict, f"{worst.reason} at load parameter {worst.load_parameter:.6g}"


def default_allowance(response: Response, scene: Scene) -> float:
    """Return the largest difference allowed to a model: `ALLOWED`, and for a solid the height over the length in addition.

    The local field at a support or a contact decays within the height (Saint-Venant's principle), and a rod neglects the
    corresponding part of the deflection.
    """
    if not response.continuum:
        return ALLOWED
    return ALLOWED + max(beam.rectangle_height / beam.length for beam in scene.beams)


def beside_events(response: Response, most: int = 4) -> tuple[int, ...]:
    """Return the indices of the last load parameter and of the ones next to events, the latest ones up to `most`."""
    steps = len(response.load_parameter)
    if not steps:
        return ()
    numbers = {steps - 1}
    events = [event for event in response.events or () if event.kind != "pass-through"]
    for event in sorted(events, key=lambda event: -event.load_parameter):
        after = int(np.searchsorted(response.load_parameter, event.load_parameter))
        for k in (after, after - 1):
            if 0 <= k < steps and len(numbers) < most:
                numbers.add(k)
    return tuple(sorted(numbers))


def ends_of_stages(response: Response, scene: Scene) -> tuple[int, ...]:
    """Return the indices of the load parameters at which a stage ends and another follows."""
    ends = [float(k + 1) for k in range(len(scene.stages))]
    return tuple(k for k, t in enumerate(map(float, response.load_parameter)) if t in ends)


def _certified_reason(states: Sequence[Judgement], steps: int) -> str:
    worst = max((item.distance for item in states if item.distance), key=lambda item: item.largest[1])
    stable = "index 0" if all(item.index == 0 for item in states) else "stability not judged (friction)"
    return f"{worst.line()}, {stable}, admissible, at {len(states)} of {steps} load parameters"


def _history(response: Response, scene: Scene) -> History | None:
    """Return the states of friction in an answer; None without friction, and for an answer that is not one to the scene."""
    if not any(spec.friction for spec in scene.contacts):
        return None
    if any(next(impossible(response, scene, k), "") for k in range(len(response.load_parameter))):
        return None
    return History(response, scene)


def _path(response: Response, scene: Scene) -> Iterator[str]:
    """Yield violations between load parameters, if the answer has the load parameters, pairs and supports of the scene."""
    steps = range(len(response.load_parameter))
    if not steps or any(next(impossible(response, scene, k), "") for k in steps):
        return
    yield from passages(response, scene)
    yield from changes(response, scene)
    for spec in scene.contacts:
        closed = response.contacts[spec.pair].force > 0.0
        dropped = np.logical_or.accumulate(closed) & ~closed
        if spec.keep and dropped.any():
            yield f"{spec.pair} must persist and is open at load parameter {response.load_parameter[np.argmax(dropped)]:.6g}"


def _event_times(response: Response) -> list[float]:
    """Load parameters at which contacts open or close."""
    return [event.load_parameter for event in response.events or () if event.kind != "pass-through"]


def _intervals(
    response: Response, states: Sequence[Judgement], numbers: Sequence[int]
) -> Iterator[tuple[Equilibrium, Equilibrium]]:
    """Yield neighbouring equilibria with the same contacts in the same order along the beams and without an event between them.

    The path is not followed where two contacts pass each other, since the part between them has no length.
    """
    times = _event_times(response)
    for (j, a), (k, b) in pairwise(zip(numbers, states, strict=True)):
        first, last = a.exact, b.exact
        if first is None or last is None or k != j + 1 or first.contacts.keys() != last.contacts.keys():
            continue
        held = _slips(first) == _slips(last) and _order(first) == _order(last)
        if held and not any(first.load_parameter <= t <= last.load_parameter for t in times):
            yield first, last


def _slips(exact: Equilibrium) -> dict[str, int]:
    """Signs of the slip rates of the contacts with friction, 0 in stick."""
    return {pair: grip.slip for pair, grip in exact.solution.layout.grips.items()}


def _order(exact: Equilibrium) -> list[tuple[int, ...]]:
    """Order of the contacts along the beams, as the stations of the parts."""
    return [(part.beam, part.first, part.last) for part in exact.solution.layout.parts]


def _departures(
    response: Response, scene: Scene, states: Sequence[Judgement], numbers: Sequence[int]
) -> Iterator[str]:
    """Yield reasons why an answer is not on the branch from the undeformed state, or changes its branch between neighbours."""
    start = states[0].exact
    smooth = not any(t <= states[0].load_parameter for t in _event_times(response))
    if numbers[0] == 0 and smooth and start is not None and not start.contacts:
        rest = at_rest(scene)
        if rest.status is SearchStatus.FOUND:
            yield from filter(None, [departs(scene, rest, start.solution)])
    for first, last in _intervals(response, states, numbers):
        yield from filter(None, [departs(scene, first.solution, last.solution)])

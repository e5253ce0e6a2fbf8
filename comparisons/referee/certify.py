"""The certificate of an answer: judgements at load parameters, and checks of the path between them."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from time import perf_counter

import numpy as np

from comparisons.answer import Response
from comparisons.answer.axis import SampledAxes
from comparisons.answer.material import material_forces
from comparisons.answer.round_off import least_force
from comparisons.referee.balance import BALANCE, balance_failures, unpaid
from comparisons.referee.certificate import Certificate, Judgement, Verdict
from comparisons.referee.judge import Trial, compared, impossible, judged
from comparisons.referee.passing import Passage, changes, history_of, misstated, passages
from comparisons.referee.path import changes_of, departures
from comparisons.referee.rod import largest
from comparisons.referee.state import Equilibrium
from comparisons.scene import Scene

ALLOWED = 5e-2
"""Default of the largest difference allowed to an answer; ten straight elements of a beam that bends to a half circle need it."""
_MOST = 4
"""Largest number of load parameters that are judged beside events."""


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
        Indices of the load parameters to judge; negative ones count from the end. The default are the last one of every stage, the
        ones next to events, and the one with the largest contact force. The path is followed from the undeformed state to all of
        them. The other load parameters are held against what needs no equilibrium: their balance, the material force, and the work up to
        the judged ones.
    allowance : float, optional
        Largest difference allowed; the default is `default_allowance`.
    """
    began = perf_counter()
    if not isinstance(response.axis_line, SampledAxes):
        response = replace(response, axis_line=cache(response.axis_line))
    allowed = default_allowance(response, scene) if allowance is None else allowance
    steps = len(response.load_parameter)
    numbers = (
        _chosen(response, scene) if at is None else sorted({k % steps for k in at if -steps <= k < steps})
    )
    contradictions = [sentence for k in range(steps) for sentence in impossible(response, scene, k)]
    history = None if contradictions else history_of(response, scene)
    states = _judged(Trial(response, scene, allowed, history), numbers)
    found = {k: item.exact for k, item in states.items() if item.exact is not None}
    unsound = [*_unsound(response, scene, allowed, contradictions)]
    unsound = unsound or [*unpaid(response, scene, found, allowed)]
    passed, path = list[Passage](), list[str]()
    if steps and not unsound:
        passed = [*passages(response, scene)]
        path = [item.sentence for item in passed if item.certain]
        path += _path(response, scene, found, allowed)
    if history is not None:
        from comparisons.referee.friction import rubs_wrongly_on_the_way

        apart = max((item.distance.largest[1] for item in states.values() if item.distance), default=0.0)
        path += rubs_wrongly_on_the_way(history, found, apart, allowed)
    verdict, reason = _worst(states.values(), unsound, path)
    if verdict is Verdict.CERTIFIED:
        verdict, reason = _sound(response, scene, states, found, passed)
    if history is not None and history.taken:
        reason = f"{reason}; {history.taken}"
    return Certificate(
        verdict=verdict, reason=reason, allowance=allowed, judged=tuple(states.values()),
        path=(*unsound, *path), seconds=perf_counter() - began,
    )  # fmt: skip


def _judged(trial: Trial, numbers: Sequence[int]) -> dict[int, Judgement]:
    """Return the judgements; an equilibrium is sought from the one at the load parameter before, where that was judged."""
    states: dict[int, Judgement] = {}
    for k in numbers:
        states[k] = judged(trial, k, states[k - 1].exact if k - 1 in states else None)
    sizes = [item.distance.scales for item in states.values() if item.distance]
    for k, item in states.items():
        if item.verdict is Verdict.NOT_AN_EQUILIBRIUM and item.exact is not None:
            # a moment that changes its sign is small, and a difference relative to it alone is large
            force, moment, moved = map(max, *sizes, (0.0, 0.0, 0.0))
            states[k] = compared(trial, k, item.exact, (force, moment, moved))
    return states


def _worst(states: Collection[Judgement], unsound: Sequence[str], path: Sequence[str]) -> tuple[Verdict, str]:
    """Return the most serious verdict and its reason."""
    if not states:
        return Verdict.NOT_JUDGED, "no load parameter was reached or asked for"
    worst = max(states, key=lambda item: [*Verdict].index(item.verdict))
    if worst.verdict is Verdict.NOT_AN_EQUILIBRIUM or not (unsound or path):
        return worst.verdict, f"{worst.reason} at load parameter {worst.load_parameter:.6g}"
    return (Verdict.NOT_AN_EQUILIBRIUM, unsound[0]) if unsound else (Verdict.INADMISSIBLE, path[0])


def default_allowance(response: Response, scene: Scene) -> float:
    """Return the largest difference allowed to a model: `ALLOWED`, and for a solid the height over the length in addition.

    The local field at a support or a contact decays within the height (Saint-Venant's principle), and a rod neglects the
    corresponding part of the deflection.
    """
    if not response.continuum:
        return ALLOWED
    return ALLOWED + max(beam.rectangle_height / beam.length for beam in scene.beams)


def _chosen(response: Response, scene: Scene) -> list[int]:
    """Return the indices of the load parameters that are judged by default: see `certify`."""
    times, steps = response.load_parameter, len(response.load_parameter)
    numbers = {steps - 1} if steps else set()
    for event in sorted(changes_of(response), key=lambda event: -event.load_parameter):
        after = int(np.searchsorted(times, event.load_parameter))
        for k in (after, after - 1):
            if 0 <= k < steps and len(numbers) < _MOST:
                numbers.add(k)
    ends = [k for k in range(steps) if 0.0 < times[k] <= len(scene.stages) and times[k] % 1.0 == 0.0]
    return sorted({*numbers, *ends, *_hardest(response)})


def _hardest(response: Response) -> tuple[int, ...]:
    """Return the index of the load parameter with the largest contact force; none without contact force."""
    none = np.zeros(len(response.load_parameter))
    force = np.nan_to_num(sum((np.abs(item.force) for item in response.contacts.values()), none))
    return (int(np.argmax(force)),) if force.any() else ()


def _sound(
    response: Response, scene: Scene, states: Mapping[int, Judgement], found: Mapping[int, Equilibrium],
    passed: Sequence[Passage],
) -> tuple[Verdict, str]:  # fmt: skip
    """Return the verdict on an answer in whose states nothing is wrong, and its reason."""
    distances = [item.distance for item in states.values() if item.distance]
    if max((item.scales[0] for item in distances), default=0.0) <= least_force(scene):
        return Verdict.NOT_JUDGED, "nothing to judge: no load, support or contact carries a force"
    for gone in departures(response, found):
        return Verdict.UNSTABLE, gone
    if passed:
        return Verdict.NOT_JUDGED, passed[0].sentence
    worst = max(distances, key=lambda item: item.largest[1])
    stable = "stability not judged (friction)" if any(item.index for item in states.values()) else "stable"
    count = f"{len(states)} of {len(scene.times)} load parameters"
    for k in _hardest(response):
        if k in states and len(states) < len(scene.times):
            count += f", the largest contact force (at {response.load_parameter[k]:.6g}) among them"
    return Verdict.CERTIFIED, f"{worst.line()}, admissible, {stable}; judged at {count}"


def _unsound(
    response: Response, scene: Scene, allowed: float, contradictions: Sequence[str]
) -> Iterator[str]:
    """Yield what is wrong with an answer at any load parameter, by its own numbers alone."""
    steps = range(len(response.load_parameter))
    if response.completed and len(steps) < len(scene.times):
        yield f"{len(steps)} of {len(scene.times)} load parameters, and the status is {response.status}"
    yield from contradictions
    if not steps or contradictions:
        return
    # the solid is in balance with the pins where they touch it, and its contacts may lie inside it by their penetration
    yield from balance_failures(response, scene, allowed if response.outside else BALANCE)
    if response.continuum:
        return
    forces = material_forces(response, scene)
    acting = max([least_force(scene), *(largest(item.force) for item in response.contacts.values())])
    for beam, force in response.material_force.items():
        off = np.abs(force - forces.get(beam, np.nan))
        if not np.all(off <= allowed * acting):
            t = response.load_parameter[np.argmax(np.nan_to_num(off, nan=np.inf))]
            yield f"the material force of {beam} is not that of its reactions at load parameter {t:.6g}"


def _path(
    response: Response, scene: Scene, found: Mapping[int, Equilibrium], allowed: float
) -> Iterator[str]:
    """Yield violations between load parameters."""
    yield from changes(response, scene)
    yield from misstated(response, scene, found, allowed)
    for spec in scene.contacts:
        closed = response.contacts[spec.pair].force > 0.0
        dropped = np.logical_or.accumulate(closed) & ~closed
        if spec.keep and dropped.any():
            yield f"{spec.pair} must persist and is open at load parameter {response.load_parameter[np.argmax(dropped)]:.6g}"

"""The path of equilibria: steps from one to another, and whether two are on one branch, by steps too short to jump to another branch."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.elements import DEGREE, mesh_for, mesh_of
from comparisons.referee.grip import Grip
from comparisons.referee.guess import AnswerState
from comparisons.referee.layout import NONE, lay_out
from comparisons.referee.newton import SearchStatus, Solution, correct, newton_step, rotation_at, solve
from comparisons.referee.stability import index_of, orientation_of
from comparisons.referee.state import Equilibrium, described
from comparisons.response import ContactEvent, Response
from comparisons.scene import Scene

Array = NDArray[np.float64]
Rate = tuple[Array, Array]
"""Rates of the unknowns and bubbles per load parameter."""

_ITERATIONS = 12
"""Largest number of Newton iterations of a step."""
_TURN = 0.3
"""Largest change of a rotation in a step [rad]; a longer step could lead to another equilibrium."""
_HALVINGS = 8
"""Number of times that a step is halved at most."""
_NEAR = 0.2
"""Largest correction of a tangent prediction over the change in the step, at which the step is accepted."""
_SHORT = 0.1
"""Largest correction of a tangent prediction [rad, L] at which the step is accepted."""
_AIM = 0.1
"""Correction over the change for which the next step is chosen; it grows with the step."""
_ROUND_OFF = 1e-9
"""Changes of rotations [rad] and lengths below this are round-off."""
_LITTLE = 1e-7
"""Fraction of the remaining path over which the tangent is a difference."""
_SMALLEST = 1e-10
"""Smallest step of the load parameter, over the distance from the start; an imperfect column needs steps this small."""
_SAME = 1e-6
"""Largest difference between the end of the followed path and the second equilibrium."""
_MEET, _MEETING = 1e-4, 0.02
"""Largest distances in the load parameter, over the interval, and in place between the ends of two branches that meet there."""
_PLACES = np.linspace(0.0, 1.0, 33)
"""Fractions of a part at which rotations are compared."""
_SWITCHED = ("touch", "release")
"""Kinds of events without a jump at which a contact closes or opens."""
_POINTS = 201
"""Points of an axis from which an equilibrium with other contacts is sought."""

PASSES = "pass-through"


def changes_of(response: Response, pair: str = "") -> list[ContactEvent]:
    """Return the events at which a contact, or any one, changes; at a pass-through none does."""
    events = [event for event in response.events or () if event.kind != PASSES]
    return [event for event in events if pair in ("", event.pair)]


def corners(scene: Scene) -> tuple[float, ...]:
    """Load parameters at which rates jump: corners of the pins' paths, and ends of stages."""
    turns = {corner for pin in scene.pins for corner in pin.corners}
    return tuple(sorted(turns | {float(k + 1) for k in range(len(scene.stages))}))


def closed_pairs(solution: Solution) -> dict[str, float]:
    """Arc positions of the closed contacts, by pair."""
    layout = solution.layout
    return {touch.spec.pair: float(solution.z[touch.arc]) * layout.length for touch in layout.touches}


def moved(
    scene: Scene, now: Solution, t: float, grips: Mapping[str, Grip], rate: Rate | None = None
) -> Solution:
    """Return the guess at load parameter t with the contacts of an equilibrium and its unknowns, or those predicted by their rates."""
    layout, way = lay_out(scene, t, closed_pairs(now), grips), t - now.layout.load_parameter
    z, bubbles = (
        (now.z, now.bubbles) if rate is None else (now.z + way * rate[0], now.bubbles + way * rate[1])
    )
    return Solution(layout=layout, mesh=mesh_for(layout, now.mesh), z=z, bubbles=bubbles)


def reach(
    scene: Scene, near: Solution, t: float, grips: Mapping[str, Grip], halvings: int = _HALVINGS
) -> Solution:
    """Return the equilibrium at load parameter t with the same contacts, held by `grips`, by steps from `near`."""
    there = correct(moved(scene, near, t, grips), _ITERATIONS)
    turning = [k for k in (item.unknown[2] for item in there.layout.stations) if k != NONE]
    turned = float(np.abs(there.z[turning] - near.z[turning]).max(initial=0.0))
    here = near.layout.load_parameter
    if (there.status is SearchStatus.FOUND and turned < _TURN) or not halvings or here == t:
        return there
    middle = reach(scene, near, (here + t) / 2.0, grips, halvings - 1)
    if middle.status is not SearchStatus.FOUND:
        return middle
    return reach(scene, middle, t, grips, halvings - 1)


def tangent(scene: Scene, now: Solution, little: float) -> Rate:
    """Rates of the unknowns and bubbles per load parameter, by a difference over `little`."""
    if little == 0.0:
        return np.zeros_like(now.z), np.zeros_like(now.bubbles)
    change, inside = newton_step(moved(scene, now, now.layout.load_parameter + little, now.layout.grips))
    if scene.stages:
        # in a stage that changes nothing the difference is round-off alone, which the correction here has too
        change_here, inside_here = newton_step(now)
        change, inside = change - change_here, inside - inside_here
    return change / little, inside / little


def departures(response: Response, scene: Scene, states: Mapping[int, Equilibrium]) -> Iterator[str]:
    """Yield reasons why the equilibria at load parameters of an answer, by number, are not on the path from the undeformed state.

    The path is followed to every equilibrium from the one before, the first one from rest, with the contacts that the events close and
    open in between. It is not followed where a contact slips off, where friction changes its direction, or where two contacts pass
    each other on a beam.
    """
    closed = [
        {pair for pair, item in response.contacts.items() if item.force[k] != 0.0}
        for k in range(len(response.load_parameter))
    ]
    now, begin = at_rest(scene), -1
    for k, there in states.items():
        if now.status is SearchStatus.FOUND:
            events = events_between(response, now.layout.load_parameter, there.load_parameter)
            same = all(closed[i] == closed_pairs(now).keys() for i in range(max(begin, 0), k + 1))
            ways = [now] if same and not events else on_the_way(scene, now, events)
            for way in (item for item in ways[-1:] if _alike(item, there.solution)):
                # beyond an event that is stated within an allowance only, a path that is not found tells nothing
                if way is now or not _followed(scene, way, there.load_parameter, there.solution)[1]:
                    yield from filter(None, [departs(scene, way, there.solution)])
        now, begin = there.solution, k


def events_between(response: Response, after: float, until: float) -> list[ContactEvent]:
    """Events at which contacts open, close, stick or slip."""
    return [event for event in changes_of(response) if after <= event.load_parameter <= until]


def on_the_way(
    scene: Scene, now: Solution, events: Sequence[ContactEvent], stops: Sequence[float] = ()
) -> list[Solution]:
    """Follow the path from `now` through events, and return the equilibria at stops and behind the events.

    Empty where contacts rub, an event jumps, or no path leads on.
    """
    if now.layout.grips or any(event.kind not in _SWITCHED for event in events):
        return []
    found: list[Solution] = []
    marks = [(t, None) for t in stops] + [(event.load_parameter, event) for event in events]
    for t, event in sorted(marks, key=lambda mark: mark[0]):
        now, stopped = _followed(scene, now, t)
        if event and not stopped:
            now = _switched(scene, now, event)
        if stopped or now.status is not SearchStatus.FOUND:
            return []
        found.append(now)
    return found


def _switched(scene: Scene, now: Solution, event: ContactEvent) -> Solution:
    """Return the equilibrium with the contact of an event closed or open."""
    exact, arcs = described(scene, now), closed_pairs(now)
    arcs.pop(event.pair, None)
    if event.kind == "touch":
        arcs[event.pair] = event.arc_position
    lines = {beam.name: np.linspace(0.0, beam.length, _POINTS) for beam in scene.beams}
    answer = AnswerState(
        load_parameter=exact.load_parameter,
        arcs=arcs,
        forces={pair: exact.contacts[pair].force if pair in exact.contacts else np.zeros(2) for pair in arcs},
        axes={name: (arc, exact.shape(name, arc).position) for name, arc in lines.items()},
        reactions={end: held.tolist() for end, held in exact.reactions.items()},
    )
    return solve(scene, answer)


def _alike(one: Solution, other: Solution) -> bool:
    """Whether two equilibria have the same contacts in the same order along the beams, which slip in the same direction or stick."""
    slips = [{pair: grip.slip for pair, grip in item.layout.grips.items()} for item in (one, other)]
    orders = [[(part.beam, part.first, part.last) for part in item.layout.parts] for item in (one, other)]
    same = closed_pairs(one).keys() == closed_pairs(other).keys()
    return one.status is SearchStatus.FOUND and same and slips[0] == slips[1] and orders[0] == orders[1]


def at_rest(scene: Scene) -> Solution:
    """Return the undeformed state of a scene with all contacts open."""
    layout = lay_out(scene, 0.0, {})
    mesh = mesh_of(layout, [np.linspace(0.0, 1.0, 4) for _ in layout.parts])
    bubbles = np.zeros((len(mesh.part), DEGREE - 1))
    return correct(Solution(layout=layout, mesh=mesh, z=np.zeros(mesh.unknowns), bubbles=bubbles), 6)


def departs(scene: Scene, first: Solution, last: Solution) -> str:
    """Return the reason why the path from `first` does not lead to `last` with the same contacts; empty if it does.

    Where the path ends at a bifurcation, all stable branches that lead back to it are right.
    """
    start, end = first.layout.load_parameter, last.layout.load_parameter
    there, stopped = _followed(scene, first, end, last)
    if not stopped:
        off = _apart(there, last)
        if off < _SAME:
            return ""
        return (
            f"the path from load parameter {start:.6g} ends on another branch at {end:.6g}, {off:.2g} L away"
        )
    back, stopped = _followed(scene, last, start)
    t, met = (item.layout.load_parameter for item in (there, back))
    if stopped and abs(met - t) < _MEET * (end - start) and _apart(there, back) < _MEETING:
        return ""
    index = index_of(first)
    kind = "" if index < 0 else f" of index {index}"
    return f"no continuous path{kind} leads on beyond load parameter {t:.6g}"


def _followed(
    scene: Scene, first: Solution, end: float, last: Solution | None = None
) -> tuple[Solution, bool]:
    """Follow the path from `first` to a load parameter, ahead or back, and to the equilibrium `last` there if it is on the path; say if it stopped.

    A step is accepted if the tangents at both its ends explain it, and the index is unchanged; with friction, the sign of the
    determinant. Displacements and rotations along all parts are compared, so that nothing depends on the elements.
    """
    index, start = _kind(first), first.layout.load_parameter
    ways, sign = abs(end - start), 1.0 if end > start else -1.0
    stops = sorted(sign * t for t in {*corners(scene), end} if 0.0 < sign * (t - start) <= ways)
    now, step, rate = first, ways, None
    while (here := now.layout.load_parameter) != end:
        stop = sign * next(t for t in stops if t > sign * here)
        left = abs(stop - here)
        rate = rate or tangent(scene, now, sign * _LITTLE * left)
        t = here + sign * step if step < left - _ROUND_OFF * ways else stop
        if t == here:
            return now, True
        there, off, behind = last or now, np.inf, None
        if last and t == end:
            off, behind = _unexplained(scene, now, rate, last, index)
        if off >= _NEAR:
            there = correct(moved(scene, now, t, now.layout.grips, rate), _ITERATIONS)
            off, behind = _unexplained(scene, now, rate, there, index)
        step = min(step, abs(t - here)) * float(np.clip(_AIM / max(off, 1e-300), 0.25, 3.0))
        if off < _NEAR:
            now, rate = there, None if t == stop else behind
        elif step < _SMALLEST * max(abs(here - start), _SMALLEST * ways):
            return now, True
    return now, False


def _unexplained(
    scene: Scene, now: Solution, rate: Rate, there: Solution, index: int
) -> tuple[float, Rate | None]:
    """Largest part of a step that the tangents at its ends do not explain, and the tangent at its end; infinite off the branch."""
    if there.status is not SearchStatus.FOUND or _kind(there) != index:
        return np.inf, None
    off = _off(now, rate, there)
    if off >= _NEAR:
        return off, None
    behind = tangent(scene, there, _LITTLE * (now.layout.load_parameter - there.layout.load_parameter))
    return max(off, _off(there, behind, now)), behind


def _kind(solution: Solution) -> int:
    """What changes at a critical point: the index, or the sign of the determinant where there is none."""
    return orientation_of(solution) if solution.layout.grips else index_of(solution)


def _off(now: Solution, rate: Rate, there: Solution) -> float:
    """Error of a prediction along a tangent over the change from one state to another; infinite for a large error."""
    way, mesh = there.layout.load_parameter - now.layout.load_parameter, mesh_for(there.layout, now.mesh)
    z, bubbles = now.z + way * rate[0], now.bubbles + way * rate[1]
    off = _apart(replace(now, layout=there.layout, mesh=mesh, z=z, bubbles=bubbles), there)
    return off / (_apart(now, there) + _ROUND_OFF) if off < _SHORT else np.inf


def _apart(one: Solution, other: Solution) -> float:
    return float(np.abs(_state(one) - _state(other)).max())


@lru_cache(maxsize=3)
def _state(solution: Solution) -> Array:
    """Displacements, arc positions and directions of the stations, and the rotations along all parts."""
    layout = solution.layout
    rest = np.delete(solution.z[: layout.unknowns], layout.forces)
    return np.append(rest, rotation_at(solution, np.arange(len(layout.parts))[:, None], _PLACES))

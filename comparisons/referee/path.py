"""The path of equilibria: steps from one to another, and whether two are on one branch, by steps too short to jump to another branch."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import lru_cache
from operator import itemgetter

import numpy as np

from comparisons.answer import Array, ContactEvent, Response
from comparisons.referee.elements import mesh_of
from comparisons.referee.equations import orientation_of
from comparisons.referee.grip import LOOSE, Grip
from comparisons.referee.layout import lay_out
from comparisons.referee.newton import correct, newton_step, switched, undeformed
from comparisons.referee.rod import largest
from comparisons.referee.state import Equilibrium
from comparisons.scene import Scene

Held = Callable[[float], Mapping[str, Grip]]
"""How friction holds the contacts at a load parameter."""

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
"""Fraction of the remaining path over which the tangent is a difference, and force [EI/L^2] of a guess at a contact without force."""
_SMALLEST = 1e-10
"""Smallest step of the load parameter, over the distance from the start; an imperfect column needs steps this small."""
_STEPS = 300
"""Largest number of steps; beside a bifurcation round-off accepts the smallest ones without end."""
_SAME = 1e-6
"""Largest difference between the end of the followed path and the second equilibrium."""
_MEET, _MEETING = 1e-4, 0.02
"""Largest distances in the load parameter, over the interval, and in place between the ends of two branches that meet there, or of contacts
before and behind the place where they pass each other."""
_PLACES = np.linspace(0.0, 1.0, 33)
"""Fractions of a part at which rotations are compared."""
_LEAVING = 1e-3
"""Part of the way to the next change, behind which a contact that touches has a force, and two that pass each other are apart."""
SAME = 1e-9
"""Distance of load parameters that are one."""
CLOSES, OPENS, STAYS, PASSES = ("touch",), ("release", "slip-off"), ("slip", "stick"), "pass-through"
"""Kinds of events at which a contact closes, opens, by a slip-off with a jump, stays closed, and at which nothing changes."""


def changes_of(response: Response, pair: str = "") -> list[ContactEvent]:
    """Return the events at which a contact, or any one, changes; at a pass-through none does."""
    return [one for one in response.events or () if one.kind != PASSES and pair in ("", one.pair)]


def corners(scene: Scene) -> tuple[float, ...]:
    """Load parameters at which rates jump: corners of the pins' paths, and ends of stages."""
    turns = {corner for pin in scene.pins for corner in pin.corners}
    return tuple(sorted(turns | {float(k + 1) for k in range(len(scene.stages))}))


def moved(now: Equilibrium, t: float, grips: Mapping[str, Grip]) -> Equilibrium:
    """Return the guess at load parameter t with the contacts of an equilibrium and its unknowns."""
    layout = lay_out(now.layout.scene, t, now.closed, grips)
    return Equilibrium(mesh=mesh_of(layout, now.mesh.grids), z=now.z)


def reach(near: Equilibrium, t: float, grips: Mapping[str, Grip], halvings: int = _HALVINGS) -> Equilibrium:
    """Return the equilibrium at load parameter t with the same contacts, held by `grips`, by steps from `near`."""
    there = correct(moved(near, t, grips), _ITERATIONS)
    turning = there.layout.tables[0][:, 2]
    turning = turning[turning >= 0]
    turned = largest(there.z[turning] - near.z[turning])
    if (there.found and turned < _TURN) or not halvings or near.load_parameter == t:
        return there
    middle = reach(near, (near.load_parameter + t) / 2.0, grips, halvings - 1)
    return reach(middle, t, grips, halvings - 1) if middle.found else middle


def tangent(now: Equilibrium, little: float) -> Array:
    """Rates of the unknowns per load parameter, by a difference over `little`."""
    if little == 0.0:
        return np.zeros_like(now.z)
    ahead = np.nan_to_num(newton_step(moved(now, now.load_parameter + little, now.layout.grips)))
    # in a stage that changes nothing the difference is round-off alone, which the correction here has too
    here = np.nan_to_num(newton_step(now)) if now.scene.stages else 0.0
    return np.asarray((ahead - here) / little)


def departures(response: Response, states: Mapping[int, Equilibrium]) -> Iterator[str]:
    """Yield reasons why equilibria, by number, are not on the path from rest, which is followed from each to the next through the events."""
    # not where a contact slips off, or friction changes its direction
    now, begin = None, 0
    for k, there in states.items():
        now = now or at_rest(there.scene)
        stated = response.events is not None or all(
            np.all((item.force[begin : k + 1] != 0.0) == (pair in now.closed))
            for pair, item in response.contacts.items()
        )
        for way in way_to(response, now, there.load_parameter, steps=0)[-1:] if stated else ():
            if _alike(way, there):
                yield from _departs(way, there, beyond=way is not now)
        now, begin = there, k


def way_to(
    response: Response, begin: Equilibrium, end: float, held: Held | None = None, steps: int = 1
) -> list[Equilibrium]:
    """Follow the path from rest, or an equilibrium that an answer states, through its events; return what is behind these and steps.

    Nothing where a contact jumps, or no path leads on. `held` says how friction holds the contacts between two events; without it the path
    is not followed where contacts rub.
    """
    now, found, start = begin, [begin], begin.load_parameter
    events = [event for event in changes_of(response) if start <= event.load_parameter <= end]
    events = [*(_from_the_start(response) if start == 0.0 else ()), *events]
    marks: list[tuple[float, ContactEvent | None]] = [
        (t, None) for t in np.linspace(start, end, steps + 1)[1:].tolist()
    ]
    marks = sorted([*marks, *((event.load_parameter, event) for event in events)], key=itemgetter(0))
    kinds = (*CLOSES, OPENS[0], *(STAYS if held else ()))
    rubs = bool(marks and now.layout.grips and not held)
    if rubs or not now.found or any(event.kind not in kinds for event in events):
        return []
    for t, event in marks:
        now, stopped = _followed(now, t)
        for _ in now.closed:
            behind = _passed(now, t) if stopped else None
            now, stopped = (now, stopped) if behind is None else _followed(behind, t)
        if event and not stopped:
            after = next((later for later, _ in marks if later > t), end)
            now = _changed(now, event, held((t + after) / 2.0) if held else {}, t + _LEAVING * (after - t))
        if stopped or not now.found:
            return []
        found.append(now)
    return found


def _passed(now: Equilibrium, end: float) -> Equilibrium | None:
    """Return the equilibrium behind the place where two contacts pass each other on a beam; None where they do not."""
    layout, left = now.layout, end - now.load_parameter
    ahead = now.z + _LEAVING * left * tangent(now, _LITTLE * left)
    if np.diff(layout.extents(ahead)).min() < 0.0 and largest((ahead - now.z)[layout.arcs]) < _MEETING:
        arcs = {pair: float(ahead[touch.arc]) * layout.length for pair, touch in layout.touches.items()}
        behind = switched(now, arcs, layout.grips, now.load_parameter + _LEAVING * left)
        return behind if behind.found and _kind(behind) == _kind(now) else None
    return None


def _from_the_start(response: Response) -> Iterator[ContactEvent]:
    """Yield the contacts that are closed from the start, as touches there."""
    for pair, contact in response.contacts.items():
        own = changes_of(response, pair)
        if own[0].kind != "touch" if own else contact.force[0] != 0.0:
            arc = own[0].arc_position if own else float(contact.arc_position[0])
            yield ContactEvent(
                kind="touch", load_parameter=0.0, pair=pair, element=0, arc_position=arc, force=0.0, released=0.0
            )  # fmt: skip


def _changed(now: Equilibrium, event: ContactEvent, grips: Mapping[str, Grip], after: float) -> Equilibrium:
    """Return the equilibrium behind an event; behind a touch at the load parameter `after`."""
    arcs = {pair: arc for pair, arc in now.closed.items() if pair != event.pair or event.kind in STAYS}
    if event.kind != "touch":
        return switched(now, arcs, grips, now.load_parameter)
    loose = {**grips, event.pair: LOOSE}
    now = switched(now, {**arcs, event.pair: event.arc_position}, loose, now.load_parameter)
    now = reach(_pushed(now), after, loose) if now.found else now
    return correct(moved(now, after, grips), _ITERATIONS) if now.found else now


def _pushed(now: Equilibrium) -> Equilibrium:
    """Return a guess with a little more force at the contacts; without any the direction of a face is stationary at every place."""
    z = now.z.copy()
    for touch in now.layout.touches.values():
        if touch.angle >= 0:
            force, phi = now.layout.beside(touch)[0].force, z[touch.angle]
            z[force : force + 2] += _LITTLE * touch.face.left * np.array([np.sin(phi), -np.cos(phi)])
    return replace(now, z=z)


def _alike(one: Equilibrium, other: Equilibrium) -> bool:
    """Whether two equilibria have the same contacts in the same order along the beams, which slip in the same direction or stick."""
    if not one.found or one.closed.keys() != other.closed.keys():
        return False
    slips = [{pair: grip.slip for pair, grip in item.layout.grips.items()} for item in (one, other)]
    orders = [[(part.beam, part.stations) for part in item.layout.parts] for item in (one, other)]
    return slips[0] == slips[1] and orders[0] == orders[1]


def same(one: Equilibrium, other: Equilibrium) -> bool:
    """Whether two equilibria are the same, with the same contacts."""
    return _alike(one, other) and _apart(one, other) <= _SAME


def at_rest(scene: Scene) -> Equilibrium:
    """Return the undeformed state of a scene with all contacts open."""
    return correct(undeformed(lay_out(scene, 0.0, {})), 6)


def _departs(first: Equilibrium, last: Equilibrium, *, beyond: bool) -> Iterator[str]:
    """Yield the reason why the path from `first`, or from `beyond` an event, does not lead to `last` with the same contacts."""
    start, end = first.load_parameter, last.load_parameter
    there, stopped = _followed(first, end, last)
    if not stopped:
        off = _apart(there, last)
        if not off < _SAME:
            yield f"the path from load parameter {start:.6g} ends on another branch at {end:.6g}, {off:.2g} L away"
    # beyond an event that is stated within an allowance only, a path that is not found tells nothing
    if not stopped or beyond:
        return
    # where it ends at a bifurcation, all stable branches that lead back to it are right
    back, stopped = _followed(last, start)
    met, t = back.load_parameter, there.load_parameter
    if not stopped or abs(met - t) >= _MEET * (end - start) or _apart(there, back) >= _MEETING:
        kind = "" if first.index < 0 else f" of index {first.index}"
        yield f"no continuous path{kind} leads on beyond load parameter {t:.6g}"


def _followed(first: Equilibrium, end: float, last: Equilibrium | None = None) -> tuple[Equilibrium, bool]:
    """Follow the path to a load parameter, and to the equilibrium `last` there if it is on the path; say if it stopped.

    A step is accepted if the tangents at both its ends explain it, and the index, or with friction the sign of the determinant, is unchanged.
    """
    index, start = _kind(first), first.load_parameter
    ways, sign = abs(end - start), 1.0 if end > start else -1.0
    stops = sorted(sign * t for t in {*corners(first.scene), end} if 0.0 < sign * (t - start) <= ways)
    now, step, rate = first, ways, None
    for _ in range(_STEPS):
        here = now.load_parameter
        if here == end:
            return now, False
        stop = sign * next(t for t in stops if t > sign * here)
        left = abs(stop - here)
        rate = tangent(now, sign * _LITTLE * left) if rate is None else rate
        t = here + sign * step if step < left - _ROUND_OFF * ways else stop
        if t == here:
            return now, True
        there, off, behind = last or now, np.inf, None
        if last and t == end:
            off, behind = _unexplained(now, rate, last, index)
        if off >= _NEAR:
            there = correct(moved(now, t, now.layout.grips).plus((t - here) * rate), _ITERATIONS)
            off, behind = _unexplained(now, rate, there, index)
        step = min(step, abs(t - here)) * float(np.clip(_AIM / max(off, 1e-300), 0.25, 3.0))
        if off < _NEAR:
            now, rate = there, None if t == stop else behind
        elif step < _SMALLEST * max(abs(here - start), _SMALLEST * ways):
            return now, True
    return now, True


def _unexplained(now: Equilibrium, rate: Array, there: Equilibrium, index: int) -> tuple[float, Array | None]:
    """Largest part of a step that the tangents at its ends do not explain, and the tangent at its end; infinite off the branch."""
    if not there.found or _kind(there) != index:
        return np.inf, None
    off = _off(now, rate, there)
    if off >= _NEAR:
        return off, None
    behind = tangent(there, _LITTLE * (now.load_parameter - there.load_parameter))
    return max(off, _off(there, behind, now)), behind


def _kind(now: Equilibrium) -> int:
    """What changes at a critical point: the index, or the sign of the determinant where there is none."""
    return orientation_of(now.system) if now.layout.grips else now.index


def _off(now: Equilibrium, rate: Array, there: Equilibrium) -> float:
    """Error of a prediction along a tangent over the change from one state to another; infinite for a large error."""
    guess = replace(now, mesh=mesh_of(there.layout, now.mesh.grids))
    off = _apart(guess.plus((there.load_parameter - now.load_parameter) * rate), there)
    return off / (_apart(now, there) + _ROUND_OFF) if off < _SHORT else np.inf


def _apart(one: Equilibrium, other: Equilibrium) -> float:
    return largest(_state(one) - _state(other))


@lru_cache(maxsize=3)
def _state(now: Equilibrium) -> Array:
    """Displacements, arc positions and directions of the stations, and the rotations along all parts."""
    layout = now.layout
    rest = np.delete(now.z[: layout.unknowns], layout.forces)
    return np.append(rest, now.located(np.arange(len(layout.parts))[:, None], _PLACES)[2])

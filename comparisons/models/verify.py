"""Checks of a response against its scene, without any other solution."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from comparisons.answer import Array, ContactHistory, Deformation, Response
from comparisons.answer.axis import place_of
from comparisons.referee.balance import balance_failures
from comparisons.referee.passing import passages
from comparisons.referee.rod import cross, face_of
from comparisons.scene import BeamSpec, ContactSpec, Scene
from comparisons.scene.ends import BeamEnd, free_ends

Check = Callable[[Response, Scene], Iterator[str]]
Mask = NDArray[np.bool_]
CHECK_FAILED = "CHECK_FAILED"
UNSTABLE = "UNSTABLE"
PULL = 1e-9
"""Largest tensile force of a contact at its release, relative to EI/L^2; it allows for round-off."""
CLOSED = 1e-9
"""Largest gap of a closed contact, relative to the length; the round-off of 2000 elements is below it."""
PENETRATION = 1e-2
"""Largest penetration of a penalty model, relative to the length."""
INSIDE = 1e-3
"""Largest depth of a round pin or thick end inside a beam away from the contact point, relative to the length. It allows for the error
of the axis between the points that a model states."""
KINK = 0.2
"""Largest kink of the axis at a contact for which a round pin may lie inside the beam [rad]; see `penetration`."""
STRAIN = 0.1
"""Largest section force over the smaller of EA and GA in small-strain elements: at this strain, half its square is .5 %."""
MOTION = 1e-10
"""Shortest path of a pin, over the length, that solutions resolve: their positions are accurate to 1e-13 of the length."""


def verified(response: Response, scene: Scene) -> Response:
    """Return `response`; a response that breaks a check has the status ``CHECK_FAILED`` and the reason.

    A path with unstable equilibria is not completed, and has the status ``UNSTABLE``. A response that stopped early is checked only for
    elements that are bent too much and for numbers below the round-off.
    """
    names = CHECKS if response.completed else UNRESOLVED
    reason = next((said for name in names for said in CHECKS[name](response, scene)), None)
    if reason is not None:
        stop = "" if response.completed else f"; then {response.ended}"
        return replace(response, status=CHECK_FAILED, message=reason + stop)
    if not response.completed or response.index is None or not np.any(response.index > 0):
        return response
    sentence = f"the equilibrium is unstable {_first(response.index > 0, response)} and may be so beyond"
    return replace(response, status=UNSTABLE, message=sentence)


def _first(failed: Mask, at: Response | Deformation) -> str:
    return f"at load parameter {at.load_parameter[np.argmax(failed)]:.6g}"


def _unreached(response: Response, scene: Scene) -> Iterator[str]:
    if not np.array_equal(response.load_parameter, scene.times):
        yield f"{len(response.load_parameter)} of {len(scene.times)} load parameters reached"


def _infinite(response: Response, _: Scene) -> Iterator[str]:
    numbers = {f"tip of {beam}": tip for beam, tip in response.tips.items()}
    for kind, held in (("support", response.supports), ("spring", response.springs)):
        for node, item in held.items():
            numbers |= {f"{kind} force of {node}": item.force, f"{kind} moment of {node}": item.moment}
    for pair, contact in response.contacts.items():
        closed = contact.force > 0.0
        numbers |= {
            f"force of {pair}": contact.force,
            f"arc position of {pair}": contact.arc_position[closed],
            f"gap of {pair}": contact.gap[closed],
        }
    yield from (f"{name} is not finite" for name, values in numbers.items() if not np.isfinite(values).all())


def _deformed(sentence: str, failed: Callable[[Deformation], Mask]) -> Check:
    """Return the check that no element fails up to the last load parameter; the sentence has the largest turn and the bearable one."""

    def check(response: Response, _: Scene) -> Iterator[str]:
        at = response.deformation
        if at is not None:
            claimed = at.load_parameter <= max(response.load_parameter, default=0.0)
            found = claimed & failed(at)
            if found.any():
                yield f"{sentence.format(at.turn[claimed].max(), at.bearable)} {_first(found, at)}"

    return check


def _motionless(_: Response, scene: Scene) -> Iterator[str]:
    length = max(beam.length for beam in scene.beams)
    for pin in scene.pins:
        way = float(np.hypot(*np.diff(pin.points, axis=0).T).sum())
        if 0.0 < way < MOTION * length:
            yield f"{pin.name} moves by {way:.2g}, less than {MOTION:g} of the length, which is not resolved"


def _contacts(
    sentence: str, failed: Callable[[ContactHistory, ContactSpec, BeamSpec, Response], Mask]
) -> Check:
    """Return the check that no contact fails; the sentence names its pair, and the load parameter follows."""

    def check(response: Response, scene: Scene) -> Iterator[str]:
        for spec in scene.contacts:
            found = failed(response.contacts[spec.pair], spec, scene.beam(spec.beam), response)
            if found.any():
                yield f"{sentence.format(spec.pair)} {_first(found, response)}"

    return check


def _ajar(contact: ContactHistory, spec: ContactSpec, beam: BeamSpec, response: Response) -> Mask:
    stated = spec.penetration or 0.0 if response.continuum else 0.0
    # a penalty leaves a negative gap, which "small penetration" bounds
    penalty = response.outside or (response.continuum and not stated)
    gap = contact.gap if penalty else np.abs(contact.gap)
    return (contact.force > 0.0) & (gap > max(CLOSED, stated) * beam.length)


def _inside(response: Response, scene: Scene) -> Iterator[str]:
    for spec in scene.contacts:
        length, gap = scene.beam(spec.beam).length, np.nan_to_num(response.contacts[spec.pair].gap)
        depth = penetration(response, scene, spec, KINK) + np.minimum(gap, 0.0)
        inside = depth > INSIDE * length
        if inside.any():
            deep = f"{spec.node} is {depth[inside][0] / length:.2g} L inside beam {spec.beam} away from its contact"
            yield f"{deep} {_first(inside, response)}: one contact of a pair is modelled"


def _overlapping(response: Response, scene: Scene) -> Iterator[str]:
    for spec in scene.contacts:
        deepest, steps = INSIDE * scene.beam(spec.beam).length, range(len(response.load_parameter))
        for end in free_ends(scene, spec):
            over = np.array([_depth(response, scene, spec, end, k) > deepest for k in steps])
            if over.any():
                where = f"the {end.name} of beam {spec.beam} {_first(over, response)}"
                yield f"{spec.node} overlaps {where}, where no contact is modelled"


def _depth(response: Response, scene: Scene, spec: ContactSpec, end: BeamEnd, k: int) -> float:
    """Depth of a node or round pin in an end at load parameter k; a closed contact is clear of the end that it is beside."""
    arc, place = response.axis_line(spec.beam, k)
    at = 0 if end.name == "start" else -1
    if abs(response.contacts[spec.pair].arc_position[k] - arc[at]) < end.half + end.radius:
        return -math.inf
    inward = (1 + 2 * at) * np.gradient(place, arc, axis=0, edge_order=2)[at]
    x, y = place_of(response, scene, spec.node, k).tolist()
    return -end._replace(place=tuple(place[at].tolist()), inward=tuple(inward.tolist())).room((x, y))


def penetration(response: Response, scene: Scene, spec: ContactSpec, kink: float = math.inf) -> Array:
    """Return the largest depth of the axis inside a round pin or thick end at each load parameter; at most zero without penetration.

    The depth is measured at points of the axis with the least distance from the node, on the stated side. The axis of a shearing beam has
    a kink of F/GA at a contact. Near the contact, a round pin is therefore inside the beam by half of the kink times the distance from the
    contact. This depth is allowed, for kinks up to `kink`.
    """
    beam, contact = scene.beam(spec.beam), response.contacts[spec.pair]
    depth, face = np.zeros(len(response.load_parameter)), face_of(scene, spec)
    for k in range(len(depth) if face.start else 0):
        arc, place = response.axis_line(spec.beam, k)
        away, along = place_of(response, scene, spec.node, k) - place, np.gradient(place, arc, axis=0)
        distance = np.hypot(*away.T)
        if contact.force[k] > 0.0:
            half_kink = 0.5 * min(contact.force[k] / beam.GA, kink)
            distance += half_kink * np.abs(arc - contact.arc_position[k])
        ahead, slack = np.einsum("mi,mi->m", along, away), distance - face.reach(arc)
        inner = (slack[1:-1] <= slack[:-2]) & (slack[1:-1] <= slack[2:])
        least = np.r_[ahead[0] > 0.0, inner, ahead[-1] < 0.0]
        facing = face.left * cross(along, away) > 0.0
        depth[k] = np.max(-slack[least & facing], initial=0.0)
    return depth


CHECKS: dict[str, Check] = {
    "load parameters": _unreached,
    "finite numbers": _infinite,
    "pushing contacts": _contacts(
        "the contact force of {} pulls",
        lambda contact, _, beam, __: contact.force < -PULL * beam.EI / beam.length**2,
    ),
    "closed gaps": _contacts("{} carries a force with an open gap", _ajar),
    "small penetration": _contacts(
        f"the penetration of {{}} exceeds {PENETRATION:.0%} of the length",
        lambda contact, _, beam, __: (contact.force > 0.0) & (contact.gap < -PENETRATION * beam.length),
    ),
    "contacts that persist": _contacts(
        "{} must persist and is open",
        lambda contact, spec, _, __: (
            spec.keep & np.isnan(contact.arc_position) & np.logical_or.accumulate(contact.force > 0.0)
        ),
    ),
    "round pins outside": _inside,
    "clear ends": _overlapping,
    "sides of beams": lambda response, scene: (
        item.sentence for item in passages(response, scene) if item.certain
    ),
    "balance": lambda response, scene: iter(() if response.outside else balance_failures(response, scene)),
    "bend of elements": _deformed(
        "too few elements: one bends by {:.2g} rad, more than {:g}", lambda at: at.turn > at.bearable
    ),
    "strain of elements": _deformed(
        f"forces exceed {STRAIN:g} EA or GA, beyond elements of small strain,", lambda at: at.strain > STRAIN
    ),
    "motion of pins": _motionless,
}
"""The checks of a response, in their order. Each yields a sentence for what is wrong, nothing for a right answer."""
UNRESOLVED = ("bend of elements", "strain of elements", "motion of pins")
"""The checks of a response that stopped."""

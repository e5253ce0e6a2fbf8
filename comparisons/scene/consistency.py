"""What the records of a scene must obey together."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

from comparisons.scene.contact import ContactSpec
from comparisons.scene.hinges import check_hinges
from comparisons.scene.joints import check_joints
from comparisons.scene.rules import MISSING, FieldError, Point, shown
from comparisons.scene.stage_rules import check_stages

if TYPE_CHECKING:
    from comparisons.scene.records import BeamSpec, Scene


def check_scene(scene: Scene) -> None:
    """Raise `FieldError` for the first rule that the records of `scene` break together."""
    beams = [(f"beam[{i}].name", beam.name) for i, beam in enumerate(scene.beams)]
    pins = [(f"pin[{i}].name", pin.name) for i, pin in enumerate(scene.pins)]
    _distinct(beams + pins)
    keys = {name: key.removesuffix(".name") for key, name in beams + pins}
    for i, contact in enumerate(scene.contacts):
        try:
            _check_contact(scene, contact, keys)
        except FieldError as error:
            raise error.within(f"contact[{i}].") from None
        _check_side(scene, contact, keys)
    _distinct([(f"contact[{i}].node", contact.pair) for i, contact in enumerate(scene.contacts)])
    named = [(f"support[{i}].beam", support.beam) for i, support in enumerate(scene.supports)]
    named += [(f"load[{i}].beam", load.beam) for i, load in enumerate(scene.loads)]
    named += [(f"hinge[{i}].beam", hinge.beam) for i, hinge in enumerate(scene.hinges)]
    named += [(f"spring[{i}].beam", spring.beam) for i, spring in enumerate(scene.springs)]
    known = {beam.name for beam in scene.beams}
    for key, name in named:
        if name not in known:
            raise FieldError(key, name, f"must name a beam: {_known(beam.name for beam in scene.beams)}")
    _distinct([(f"load[{i}].{load.key}", load.node) for i, load in enumerate(scene.loads)])
    _distinct([(f"hinge[{i}].end", hinge.node) for i, hinge in enumerate(scene.hinges)])
    _distinct([(f"spring[{i}].end", spring.node) for i, spring in enumerate(scene.springs)])
    check_stages(scene)
    check_hinges(scene)
    check_joints(scene)
    _check_weight(scene)
    _check_cause(scene)


def _check_cause(scene: Scene) -> None:
    touching = {contact.node for contact in scene.contacts}
    for i, pin in enumerate(scene.pins):
        if pin.name not in touching:
            raise FieldError(f"pin[{i}].name", pin.name, "must be the node of a contact")
        if len(set(pin.points)) == 1:
            raise FieldError(
                f"pin[{i}].displacement", pin.displacement, "must not be zero: the pin never moves"
            )
    acting = (scene.pins, scene.load_histories, scene.gravity)
    if not (any(acting) or any(support.moves for support in scene.all_supports)):
        raise FieldError("pin", MISSING, "give a pin, a load or a support that moves: nothing happens")


def _check_weight(scene: Scene) -> None:
    heavy = [i for i, beam in enumerate(scene.beams) if beam.density is not None]
    if heavy and scene.gravity is None:
        density = scene.beams[heavy[0]].density
        raise FieldError(f"beam[{heavy[0]}].density", density, "needs gravity in [scene]")
    if scene.gravity is not None and not heavy:
        raise FieldError("scene.gravity", scene.gravity, "needs the density of a beam")
    pulls = [scene.gravity or (0.0, 0.0), *(stage.gravity for stage in scene.stages)]
    if scene.gravity is not None and not any(map(any, pulls)):
        raise FieldError("scene.gravity", scene.gravity, "must not be zero in every stage")
    for i, stage in enumerate(scene.stages):
        if any(stage.gravity) and scene.gravity is None:
            raise FieldError(f"stage[{i}].gravity", stage.gravity, "needs gravity in [scene]")


def _distinct(named: list[tuple[str, str]]) -> None:
    seen: set[str] = set()
    for key, name in named:
        if name in seen:
            raise FieldError(key, name, "must not appear twice")
        seen.add(name)


def _known(names: Iterable[str]) -> str:
    return ", ".join(shown(name) for name in names)


def _check_contact(scene: Scene, contact: ContactSpec, keys: dict[str, str]) -> None:
    """Check a contact; `keys` gives the place in the file, ``beam[0]`` or ``pin[0]``, of every name."""
    if not keys.get(contact.beam, "").startswith("beam"):
        known = _known(beam.name for beam in scene.beams)
        raise FieldError("beam", contact.beam, f"must name a beam: {known}")
    name, dot, end = contact.node.partition(".")
    kind = keys.get(name, "").partition("[")[0]
    if (kind, dot, end) not in (("pin", "", ""), ("beam", ".", "start"), ("beam", ".", "end")):
        ends = (f"{beam.name}.{end}" for beam in scene.beams for end in ("start", "end"))
        known = _known((*(pin.name for pin in scene.pins), *ends))
        raise FieldError("node", contact.node, f"must name a pin or a beam's end: {known}")
    if contact.node.split(".")[0] == contact.beam and "." in contact.node:
        raise FieldError("node", contact.node, "must not be an end of the beam itself")
    beam = scene.beam(contact.beam)
    if contact.node.count(".") and scene.place(contact.node) in (beam.start, beam.end):
        raise FieldError("node", contact.node, f'must not be joined to beam "{beam.name}"')
    if contact.surface == "face" and beam.height is None:
        raise FieldError("surface", contact.surface, f'needs the height of beam "{contact.beam}"')


def signed_gap(beam: BeamSpec, side: str, offset: float, point: Point) -> tuple[float, float]:
    """Return the gap of `point` to the undeformed beam and the fraction of the axis it projects on.

    ``g = s n.(x_c - x_start) - offset`` with n the left normal and s = -1 for a node from the right.
    """
    (tx, ty), (x0, y0) = beam.tangent(0.0), beam.start
    dx, dy = point[0] - x0, point[1] - y0
    sign = 1.0 if side == "left" else -1.0
    if beam.turn:
        left, fraction = _from_arc(beam, (tx * dx + ty * dy, tx * dy - ty * dx))
        return sign * left - offset, fraction
    return sign * (tx * dy - ty * dx) - offset, (tx * dx + ty * dy) / beam.length


def _from_arc(beam: BeamSpec, point: Point) -> Point:
    """Return the distance of a point to the left of an arc and the fraction of its length there; the start is the origin along x."""
    (x, y), k = point, beam.curvature
    far = math.hypot(k * x, k * y - 1.0)
    turned = math.remainder(math.atan2(k * x, 1.0 - k * y) - beam.turn / 2.0, 2.0 * math.pi)
    return (2.0 * y - k * (x * x + y * y)) / (1.0 + far), turned / beam.turn + 0.5


def _check_side(scene: Scene, contact: ContactSpec, keys: dict[str, str]) -> None:
    beam = scene.beam(contact.beam)
    name, dot, end = contact.node.partition(".")
    if dot:
        key, position = f"{keys[name]}.{end}", scene.place(contact.node)
    else:
        pin = scene.pin(name)
        key, position = f"{keys[name]}.{'start' if pin.path is None else 'path'}", pin.points[0]
    _, fraction = signed_gap(beam, contact.side, 0.0, position)
    gap, fraction = signed_gap(beam, contact.side, scene.offset(contact, fraction), position)
    if 0.0 <= fraction <= 1.0 and gap < -1e-12 * beam.length:
        where = f'on the {contact.side} of beam "{beam.name}"'
        raise FieldError(key, position, f"must lie {where} ({contact.surface}), gap {gap:.6g}")

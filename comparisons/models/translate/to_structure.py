"""A scene as TSM beams: Timoshenko sections on the axis, rigid joints, supports, dead loads at nodes and along the beams."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from comparisons.models.options import ModelError
from comparisons.scene import BeamSpec, ContactSpec, Scene, SpringSpec
from comparisons.scene.keys import BEAMS, unstated
from comparisons.scene.stages import PrescribedMotion

if TYPE_CHECKING:
    from tsm import Beam, ContactPair, LineLoad, Load, Section, Spring, Structure, Support
    from tsm.elements import ElementType
    from tsm.structure import End


def to_structure(scene: Scene, *, elements: int | None = None, element: str | None = None) -> "Structure":
    """Return the `tsm.Structure` of `scene`.

    Parameters
    ----------
    scene : Scene
        Any scene.
    elements : int, optional
        Elements of every beam. By default the scene's number, or one exact element.
    element : str, optional
        Key of `tsm.ELEMENTS`, `mixed` if not given.

    Raises
    ------
    ModelError
        If there is no such element, or the scene uses a key that the beams do not state.
    """
    from tsm import Hinge, Pin, Structure
    from tsm.elements import ELEMENTS, MIXED

    refused = beams_refusal(scene)
    if refused is not None:
        raise ModelError(refused)
    if element is not None and element not in ELEMENTS:
        raise ModelError(f"element = {element}: must be one of {', '.join(ELEMENTS)}")
    kind = MIXED if element is None else ELEMENTS[element]
    return Structure(
        beams=tuple(_beam(scene, beam, elements, kind) for beam in scene.beams),
        supports=tuple(_support(motion) for motion in scene.prescribed_motions.values()),
        loads=tuple(_loads(scene)),
        line_loads=(*_line_loads(scene), *_weights(scene)),
        hinges=tuple(
            Hinge(beam=item.beam, end=_end(item.end), stiffness=item.stiffness) for item in scene.hinges
        ),
        springs=tuple(_spring(spring) for spring in scene.springs),
        pins=tuple(
            Pin(name=pin.name, path=pin.stage_points[0], onward=tuple(p[1:] for p in pin.stage_points[1:]))
            for pin in scene.pins
        ),
        contacts=tuple(_pair(scene, contact) for contact in scene.contacts),
    )


def beams_refusal(scene: Scene) -> str | None:
    """Return why no element of the tangent stiffness method states `scene`; None if one does."""
    for contact in scene.contacts:
        if contact.friction and _face_slope(scene, contact):
            return (
                f"contact {contact.pair}: the tangent stiffness method does not state friction on the face of a beam whose height tapers; "
                'use --model solid, surface = "axis" or one height'
            )
    return unstated(scene, "the tangent stiffness method", BEAMS)


def _face_slope(scene: Scene, contact: ContactSpec) -> float:
    """Derivative of the radius of the circles whose envelope is the face, ``h'/2 / sqrt(1 + (h'/2)^2)``."""
    beam = scene.beam(contact.beam)
    steep = (beam.height_at(1.0) - beam.height_at(0.0)) / (2.0 * beam.length)
    return steep / math.hypot(1.0, steep) if contact.surface == "face" else 0.0


def _pair(scene: Scene, contact: ContactSpec) -> "ContactPair":
    """Contact pair. The face of a beam whose height tapers lies at half the height from the undeformed axis, see `_face_slope`."""
    from tsm import ContactPair

    steep, beam, radius = _face_slope(scene, contact), scene.beam(contact.beam), scene.radius(contact)
    offset = (
        radius + beam.height_at(0.0) / 2.0 * math.sqrt(1.0 - steep**2) if steep else scene.offset(contact)
    )
    return ContactPair(
        node=contact.node,
        beam=contact.beam,
        side="left" if contact.side == "left" else "right",
        offset=offset,
        end_offset=offset + steep * beam.length if steep else None,
        keep=contact.keep,
        friction=contact.friction,
        radius=radius,
    )


def _support(motion: PrescribedMotion) -> "Support":
    from tsm import Support

    spec = motion.support
    ux, uy, rotation = spec.motion
    return Support(
        beam=spec.beam,
        end=_end(spec.end),
        ux=ux,
        uy=uy,
        rotation=rotation,
        onward=motion.increments[1:],
    )


def _beam(scene: Scene, spec: BeamSpec, elements: int | None, kind: "ElementType") -> "Beam":
    """Beam with nodes where loads inside it begin, end or act."""
    from tsm import Beam

    nodes = spec.nodes if kind.meshed and not elements else ()
    count = elements or (len(nodes) + 1 if nodes else spec.elements if kind.meshed else 1)
    own = [load for _, load in scene.numbered_loads() if load.beam == spec.name]
    ends = [part for load in own if load.force_per_length is not None for part in load.span]
    places = [load.at for load in own if load.at is not None]
    return Beam(
        name=spec.name,
        start=spec.start,
        end=spec.end,
        section=_section(spec, 0.0 if spec.tapers else 0.5),
        end_section=_section(spec, 1.0) if spec.tapers else None,
        turn=spec.turn,
        elements=count,
        element=kind.name,
        nodes=nodes,
    ).divided(*(part * spec.length for part in (*ends, *places)))


def _section(spec: BeamSpec, fraction: float) -> "Section":
    from tsm import Section

    EA, GA, EI = spec.stiffness(fraction)
    return Section(EA=EA, GA=GA, EI=EI)


def _end(end: str | None) -> "End":
    return "start" if end == "start" else "end"


def _spring(spec: SpringSpec) -> "Spring":
    from tsm import Spring

    x, y = spec.stiffness
    return Spring(beam=spec.beam, end=_end(spec.end), x=x, y=y, rotation=spec.rotation)


def _loads(scene: Scene) -> Iterator["Load"]:
    """Yield the forces and moments at points."""
    from tsm import Load

    for stage, load in scene.numbered_loads():
        force, moment = load.force, load.moment
        if load.at is not None:
            arc = load.at * scene.beam(load.beam).length
            yield Load(beam=load.beam, arc=arc, force=force, moment=moment, stage=stage)
        elif load.end is not None:
            yield Load(beam=load.beam, end=_end(load.end), force=force, moment=moment, stage=stage)


def _line_loads(scene: Scene) -> Iterator["LineLoad"]:
    """Yield the forces per length."""
    from tsm import LineLoad

    for stage, load in scene.numbered_loads():
        if load.force_per_length is not None:
            start, end = (part * scene.beam(load.beam).length for part in load.span)
            force = (load.force_per_length,)
            yield LineLoad(beam=load.beam, force=force, start=start, end=end, stage=stage)


def _weights(scene: Scene) -> Iterator["LineLoad"]:
    """Yield the weights of the beams."""
    from tsm import LineLoad

    for beam in scene.beams:
        if beam.density is None:
            continue
        for stage, (gx, gy) in enumerate(scene.stage_gravities):
            if gx or gy:
                force = tuple((gx * mass, gy * mass) for mass in beam.mass_coefficients())
                yield LineLoad(beam=beam.name, force=force, stage=stage)

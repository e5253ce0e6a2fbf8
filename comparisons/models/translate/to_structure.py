"""A scene as TSM beams: Timoshenko sections on the axis, rigid joints, supports and dead loads at nodes."""

from typing import TYPE_CHECKING

from comparisons.models.options import ModelError
from comparisons.scene import BeamSpec, Scene, SupportSpec
from comparisons.scene.keys import BEAMS, unstated

if TYPE_CHECKING:
    from tsm import Beam, Structure, Support
    from tsm.elements import ElementType


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
    from tsm import ContactPair, Load, Pin, Structure
    from tsm.elements import ELEMENTS, MIXED

    unknown = unstated(scene, "the tangent stiffness method", BEAMS)
    if unknown is not None:
        raise ModelError(unknown)
    if element is not None and element not in ELEMENTS:
        raise ModelError(f"element = {element}: must be one of {', '.join(ELEMENTS)}")
    kind = MIXED if element is None else ELEMENTS[element]
    return Structure(
        beams=tuple(_beam(beam, elements, kind) for beam in scene.beams),
        supports=tuple(_support(support) for support in scene.all_supports),
        loads=tuple(
            Load(
                beam=load.beam,
                end="start" if load.end == "start" else "end",
                force=load.force,
                moment=load.moment,
            )
            for load in scene.loads
        ),
        pins=tuple(Pin(name=pin.name, path=pin.points) for pin in scene.pins),
        contacts=tuple(
            ContactPair(
                node=contact.node,
                beam=contact.beam,
                side="left" if contact.side == "left" else "right",
                offset=scene.offset(contact),
                keep=contact.keep,
                friction=contact.friction,
                radius=scene.radius(contact),
            )
            for contact in scene.contacts
        ),
    )


def _support(spec: SupportSpec) -> "Support":
    from tsm import Support

    ux, uy, rotation = spec.motion
    return Support(
        beam=spec.beam, end="start" if spec.end == "start" else "end", ux=ux, uy=uy, rotation=rotation
    )


def _beam(spec: BeamSpec, elements: int | None, kind: "ElementType") -> "Beam":
    from tsm import Beam, Section

    section = Section(EA=spec.EA, GA=spec.GA, EI=spec.EI)
    nodes = spec.nodes if kind.meshed and not elements else ()
    count = elements or (len(nodes) + 1 if nodes else spec.elements if kind.meshed else 1)
    return Beam(
        name=spec.name,
        start=spec.start,
        end=spec.end,
        section=section,
        elements=count,
        element=kind.name,
        nodes=nodes,
    )

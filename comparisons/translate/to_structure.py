"""A scene as TSM beams: Timoshenko sections on the axis, clamps that hold position and rotation."""

from typing import TYPE_CHECKING

from comparisons.options import ModelError
from comparisons.scene import BeamSpec, Scene

if TYPE_CHECKING:
    from tsm import Beam, Structure


def to_structure(scene: Scene, *, elements: int | None = None, element: str | None = None) -> "Structure":
    """Return the `tsm.Structure` of `scene`.

    Parameters
    ----------
    scene : Scene
        Any scene.
    elements : int, optional
        Elements of every beam, in place of the scene's.
    element : str, optional
        Key of `tsm.ELEMENTS`, ``"mixed"`` if not given.

    Raises
    ------
    ModelError
        If there is no such element.
    """
    from tsm import ELEMENTS, ContactPair, Pin, Structure, Support

    if element is not None and element not in ELEMENTS:
        raise ModelError(f"element = {element}: must be one of {', '.join(ELEMENTS)}")
    return Structure(
        beams=tuple(_beam(beam, elements or beam.elements, element or "mixed") for beam in scene.beams),
        supports=tuple(
            Support(beam=beam.name, end="start" if end == "start" else "end")
            for beam in scene.beams
            for end in beam.clamped
        ),
        pins=tuple(Pin(name=pin.name, path=pin.points) for pin in scene.pins),
        contacts=tuple(
            ContactPair(
                node=contact.node,
                beam=contact.beam,
                side="left" if contact.side == "left" else "right",
                offset=scene.offset(contact),
            )
            for contact in scene.contacts
        ),
    )


def _beam(spec: BeamSpec, elements: int, element: str) -> "Beam":
    from tsm import Beam, Section

    section = Section(EA=spec.EA, GA=spec.GA, EI=spec.EI)
    return Beam(
        name=spec.name, start=spec.start, end=spec.end, section=section, elements=elements, element=element
    )

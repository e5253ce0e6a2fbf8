"""A scene as solid strips: plane stress, thickness equal to the width, unilateral contact."""

from collections import defaultdict
from typing import TYPE_CHECKING

from comparisons.models.options import ModelError
from comparisons.scene import BeamSpec, Scene, SupportSpec
from comparisons.scene.conditions import COMPONENTS
from comparisons.scene.keys import STRIPS, unstated
from comparisons.scene.rules import Point

if TYPE_CHECKING:
    from fem_reference import SolidProblem, Strip

ENDS = ("start", "end")
LEAST_RATIO = -0.999
"""Least Poisson's ratio. There the shear modulus is 500 times Young's modulus; a solid that is stiffer in shear locks."""

SLENDER = 0.125
"""Largest height over length of the rectangle that replaces a section given by area and second moment."""


def to_solid(scene: Scene, *, mesh: tuple[int, int] | None = None) -> "SolidProblem":
    """Return the `fem_reference.SolidProblem` of `scene`.

    Parameters
    ----------
    scene : Scene
        Any scene whose supports, with the pins that touch at the start, hold every structure.
    mesh : (int, int), optional
        Elements along and across of every beam, in place of the scene's.

    Raises
    ------
    ValueError
        If the solid cannot state the scene, in one line.
    """
    from fem_reference import Contact, EndLoad, Joint, Pin, SolidProblem, Support

    unknown = unstated(scene, "the solid", STRIPS)
    if unknown is not None:
        raise ModelError(unknown)
    joints = tuple(Joint(ends=ends) for ends in _joints(scene))
    clamps = {spec.node for spec in scene.all_supports if _is_clamp(scene, spec)}
    return SolidProblem(
        strips=tuple(_strip(beam, clamps, mesh) for beam in scene.beams),
        supports=tuple(
            Support(strip=spec.beam, end=spec.end, motion=spec.motion)
            for spec in scene.all_supports
            if spec.node not in clamps
        ),
        joints=joints,
        loads=tuple(
            EndLoad(strip=load.beam, end=load.end, force=load.force, moment=load.moment)
            for load in scene.loads
            if load.end is not None
        ),
        pins=tuple(Pin(name=pin.name, path=pin.points, radius=pin.radius or 0.0) for pin in scene.pins),
        contacts=tuple(
            Contact(
                node=contact.node,
                strip=contact.beam,
                side=contact.side,
                surface=contact.surface,
                penalty=contact.penalty,
                penetration=contact.penetration,
                keep=contact.keep,
                friction=contact.friction,
            )
            for contact in scene.contacts
        ),
    )


def _joints(scene: Scene) -> list[tuple[str, ...]]:
    """Return the ends that meet, joint by joint."""
    meeting: dict[Point, list[str]] = defaultdict(list)
    for beam in scene.beams:
        for end in ENDS:
            meeting[scene.place(f"{beam.name}.{end}")].append(f"{beam.name}.{end}")
    return [tuple(ends) for ends in meeting.values() if len(ends) > 1]


def _is_clamp(scene: Scene, spec: SupportSpec) -> bool:
    """Whether a support clamps the edge itself: it holds a single end at rest that bears no load.

    Any other support holds the mean displacement and rotation of the end's section.

    Raises
    ------
    ModelError
        If the beam asks for a full clamp where its section is held.
    """
    if len(spec.held) < len(COMPONENTS):
        return False
    joined = any(spec.node in ends for ends in _joints(scene))
    loaded = any(load.node == spec.node for load in scene.loads)
    if not (spec.moves or joined or loaded):
        return True
    if scene.beam(spec.beam).solid_clamp == "full":
        raise ModelError(
            f'the solid model has a full clamp at rest without joint and load, "{spec.node}" is another'
        )
    return False


def rectangle(beam: BeamSpec) -> tuple[float, float]:
    """Return width and height of a beam's section, or of the rectangle with its area and second moment.

    ``h = sqrt(12 I / A)``, ``b = A / h``.

    Raises
    ------
    ModelError
        If the rectangle is not slender in the plane.
    """
    if isinstance(beam.width, float) and isinstance(beam.height, float):
        return beam.width, beam.height
    height = beam.rectangle_height
    if height > SLENDER * beam.length:
        raise ModelError(
            f'the solid model needs the width and height of beam "{beam.name}": the rectangle of its area and second '
            f"moment is {height:.3g} high, more than an eighth of the length"
        )
    return beam.cross_section[0] / height, height


def _strip(beam: BeamSpec, clamps: set[str], mesh: tuple[int, int] | None) -> "Strip":
    from fem_reference import Strip

    width, height = rectangle(beam)
    nu = beam.poissons_ratio
    if nu is None:
        nu = beam.youngs_modulus / (2.0 * (beam.shear_modulus or beam.youngs_modulus)) - 1.0
    if not LEAST_RATIO < nu < 0.5:
        raise ModelError(
            f"the solid model needs a Poisson's ratio between {LEAST_RATIO:g} and 0.5, E/(2 G) - 1 = {nu:.6g}"
        )
    if (mesh or beam.mesh)[0] < 2:
        raise ModelError("the solid model needs at least 2 elements along the beam")
    return Strip(
        name=beam.name,
        start=beam.start,
        end=beam.end,
        height=height,
        width=width,
        youngs_modulus=beam.youngs_modulus,
        poissons_ratio=nu,
        clamped=tuple(end for end in ENDS if f"{beam.name}.{end}" in clamps),
        clamp=beam.solid_clamp,
        element=beam.solid_element,
        mesh_file=beam.solid_mesh_file if mesh is None else None,
        mesh=mesh or beam.mesh,
        material=beam.material,
    )

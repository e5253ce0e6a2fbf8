"""A scene as solid strips: plane stress, thickness equal to the width, unilateral contact."""

from math import sqrt
from typing import TYPE_CHECKING

from comparisons.models.options import ModelError
from comparisons.scene import BeamSpec, Scene

if TYPE_CHECKING:
    from fem_reference import SolidProblem, Strip

SLENDER = 0.1
"""Largest height over length of the rectangle that replaces a section given by area and second moment."""


def to_solid(scene: Scene, *, mesh: tuple[int, int] | None = None) -> "SolidProblem":
    """Return the `fem_reference.SolidProblem` of `scene`.

    Parameters
    ----------
    scene : Scene
        Beams, each clamped at one end and free at the other, with pins and contacts.
    mesh : (int, int), optional
        Elements along and across of every beam, in place of the scene's.

    Raises
    ------
    ModelError
        If the solid cannot state the scene.
    """
    from fem_reference import Contact, EndLoad, Pin, SolidProblem

    if not scene.pins and not scene.loads:
        raise ModelError("the solid model has a pin that moves or a dead load, the scene has none")
    for load in scene.loads:
        if load.moment:
            raise ModelError(f'the solid model has no dead moments, the scene loads "{load.node}"')
    return SolidProblem(
        strips=tuple(_strip(beam, _clamp(scene, beam), mesh) for beam in scene.beams),
        loads=tuple(EndLoad(strip=load.beam, force=load.force) for load in scene.loads),
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
            )
            for contact in scene.contacts
        ),
    )


def _clamp(scene: Scene, beam: BeamSpec) -> str:
    """Return the clamped end of a beam that is held nowhere else."""
    supports = scene.supports_of(beam.name)
    if not supports or len(supports[0].held) < 3:
        raise ModelError(f'the solid model has one end clamped, none of beam "{beam.name}" is')
    clamp, *others = supports
    if others:
        raise ModelError(f'the solid model has one support, beam "{beam.name}" has two')
    if clamp.moves:
        raise ModelError(f'the solid model has the clamp at rest, "{clamp.node}" moves')
    others_ends = {end for other in scene.beams if other is not beam for end in (other.start, other.end)}
    if others_ends & {beam.start, beam.end}:
        raise ModelError(f'the solid model has no joints, beam "{beam.name}" is joined to another')
    return clamp.end


def rectangle(beam: BeamSpec) -> tuple[float, float]:
    """Return width and height of a beam's section, or of the rectangle with its area and second moment.

    ``h = sqrt(12 I / A)``, ``b = A / h``.

    Raises
    ------
    ModelError
        If the rectangle is not slender in the plane.
    """
    if beam.width is not None and beam.height is not None:
        return beam.width, beam.height
    area, inertia, _ = beam.cross_section
    height = sqrt(12.0 * inertia / area)
    if height > SLENDER * beam.length:
        raise ModelError(
            f'the solid model needs the width and height of beam "{beam.name}": the rectangle of its area and second '
            f"moment is {height:.3g} high, more than a tenth of the length"
        )
    return area / height, height


def _strip(beam: BeamSpec, clamped: str, mesh: tuple[int, int] | None) -> "Strip":
    from fem_reference import Strip

    width, height = rectangle(beam)
    nu = beam.poissons_ratio
    if nu is None:
        nu = beam.youngs_modulus / (2.0 * (beam.shear_modulus or beam.youngs_modulus)) - 1.0
    if not -1.0 < nu < 0.5:
        raise ModelError(
            f"the solid model needs a Poisson's ratio between -1 and 0.5, E/(2 G) - 1 = {nu:.6g}"
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
        clamped=(clamped,),
        clamp=beam.solid_clamp,
        element=beam.solid_element,
        mesh_file=beam.solid_mesh_file if mesh is None else None,
        mesh=mesh or beam.mesh,
        material=beam.material,
    )

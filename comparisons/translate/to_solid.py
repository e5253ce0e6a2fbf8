"""A scene as a solid strip: plane stress, thickness equal to the width, a penalty for the contact."""

from typing import TYPE_CHECKING

from comparisons.options import ModelError
from comparisons.scene import BeamSpec, Scene
from comparisons.translate.one_beam import one_beam_under_a_pin

if TYPE_CHECKING:
    from fem_reference import SolidProblem, Strip


def to_solid(scene: Scene, *, mesh: tuple[int, int] | None = None) -> "SolidProblem":
    """Return the `fem_reference.SolidProblem` of `scene`.

    Parameters
    ----------
    scene : Scene
        One beam given by width and height, clamped at one end and not supported at the other, and one pin.
    mesh : (int, int), optional
        Elements along and across, in place of the scene's.

    Raises
    ------
    ModelError
        If the scene is another one.
    """
    from fem_reference import Contact, Pin, SolidProblem, default_penalty

    clamp = one_beam_under_a_pin(scene, "the solid model has")
    strip, pin, contact = _strip(scene.beams[0], clamp.end, mesh), scene.pins[0], scene.contacts[0]
    return SolidProblem(
        strip=strip,
        pin=Pin(name=pin.name, path=pin.points),
        contact=Contact(
            pin=contact.node,
            strip=contact.beam,
            side=contact.side,
            surface=contact.surface,
            penalty=contact.penalty or default_penalty(strip),
        ),
    )


def _strip(beam: BeamSpec, clamped: str, mesh: tuple[int, int] | None) -> "Strip":
    from fem_reference import Strip

    if beam.width is None or beam.height is None:
        raise ModelError(f'the solid model needs the width and height of beam "{beam.name}"')
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
        height=beam.height,
        width=beam.width,
        youngs_modulus=beam.youngs_modulus,
        poissons_ratio=nu,
        clamped=(clamped,),
        clamp=beam.solid_clamp,
        mesh=mesh or beam.mesh,
        material=beam.material,
    )

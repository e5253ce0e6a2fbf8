"""The exact rods: Reissner's, which stretch and shear, by collocation under one pin and else by the referee, and the elastica."""

from typing import TYPE_CHECKING

from comparisons.answer import Response
from comparisons.models.model import Model, ModelError, Options, Style, Watch, refused
from comparisons.models.shared import kept
from comparisons.models.theory import CHANGE, ROUND_OFF, Bending
from comparisons.models.tsm import beams_refusal
from comparisons.scene import Scene
from comparisons.scene.keys import SPECIAL

if TYPE_CHECKING:
    from comparisons.models.cantilever import RodScene


class Rod(Model):
    """Exact rods."""

    name = "rod"
    label = "exact rod"
    libraries = ("comparisons.models.cantilever",)
    meshed = False
    keys = SPECIAL.keys()
    reference = Options()
    style = Style(colour="#000000", width=1.2, unbroken=True)

    def by_referee(self, scene: Scene) -> bool:
        """Whether the scene is not one rod under one pin."""
        from comparisons.models.cantilever import to_rod

        return refused(to_rod, scene) is not None

    def setting(self, scene: Scene, options: Options) -> str:  # noqa: ARG002 - the rod has no options
        """Return where the equilibria of several rods are from; empty for one rod."""
        return "exact equilibria along TSM's path" if self.by_referee(scene) else ""

    def refusal(self, scene: Scene) -> str | None:
        """Return why the rods cannot state `scene`; None if they can. Several rods are solved along the path of exact elements."""
        return beams_refusal(scene)

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:  # noqa: ARG002 - the rod has no options
        """Return the response to `scene`, not yet checked."""
        if self.by_referee(scene):
            from comparisons.models.rods import solve_rods

            return solve_rods(scene, watch)
        from comparisons.exact import rod_under_pin
        from comparisons.models.cantilever import local_response, to_rod

        local = to_rod(scene)
        section, radius = kept(local.beam, "EA GA EI length"), scene.radius(local.contact)
        pin = {"friction": local.contact.friction, "offset": local.offset - radius, "radius": radius}
        return local_response(local, rod_under_pin(local.path, **section, **pin), unknowns=4)


class Elastica(Model):
    """The elastica, which neither stretches nor shears, under one pin on its axis, in closed form."""

    name = "elastica"
    label = "elastica"
    libraries = ("comparisons.models.cantilever",)
    meshed = False
    rod = False
    style = Style(colour="#444444", width=1.2)

    def apart(self, scene: Scene) -> float:
        """Return the part of a cantilever's deflection under a force at its tip that is shear, and as much of stretch."""
        return max(3.0 * beam.EI / beam.length**2 * (1.0 / beam.EA + 1.0 / beam.GA) for beam in scene.beams)

    def refusal(self, scene: Scene) -> str | None:
        """Return why the elastica cannot state `scene`; None if it can."""
        return refused(_on_axis, scene)

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:  # noqa: ARG002 - the elastica has no options
        """Return the response to `scene`, not yet checked."""
        from comparisons.exact import elastica_under_pin
        from comparisons.models.cantilever import local_response

        local = _on_axis(scene)
        sizes = kept(local.beam, "EI length")
        return local_response(local, elastica_under_pin(local.path, **sizes), unknowns=1)

    def error_parts(self, scene: Scene, options: Options, bent: Bending) -> dict[str, float]:  # noqa: ARG002 - as above
        """Return the errors from missing stretch and shear."""
        beam = scene.beams[0]
        soft = beam.EI / beam.length**2 * (1 / beam.EA + 1 / beam.GA)
        return {
            "stretch and shear: EI/s^2 (1/EA + 1/GA) with the nearest s": CHANGE**2 * soft / bent.nearest**2,
            "round-off": ROUND_OFF,
        }


def _on_axis(scene: Scene) -> "RodScene":
    """Return `scene` in the frame of the one cantilever that a pin on its axis pushes."""
    from comparisons.models.cantilever import to_rod

    local = to_rod(scene, "the elastica")
    if local.contact.friction:
        raise ModelError("the elastica has no friction here, the scene has some")
    if local.offset:
        raise ModelError(
            "the elastica has a point in contact on its axis only, the scene has a face or a round pin"
        )
    return local


ROD, ELASTICA = Rod(), Elastica()
MODELS = (ROD, ELASTICA)

"""The exact models: Reissner's rod and the elastica."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comparisons.models.base import Model, Style
from comparisons.models.options import ModelError, Options
from comparisons.scene.keys import ONE_ROD, RODS

if TYPE_CHECKING:
    from comparisons.models.progress import Watch
    from comparisons.models.theory import Bending
    from comparisons.response import Response
    from comparisons.scene import Scene


class Rod(Model):
    """Reissner's rods, which stretch and shear: one by quadrature under one pin, any others by the referee."""

    name = "rod"
    label = "exact rod"
    libraries = ("comparisons.models.exact",)
    meshed = False
    keys = RODS

    @property
    def reference(self) -> Options | None:
        """Default options: the rod has no settings."""
        return Options()

    def by_referee(self, scene: Scene) -> bool:
        """Whether the scene is not one rod under one pin."""
        from comparisons.models.translate import to_rod

        try:
            to_rod(scene)
        except ModelError:
            return True
        return False

    def setting(self, scene: Scene, options: Options) -> str:
        """Return where the equilibria of several rods are from; empty for one rod."""
        del options
        return "exact equilibria along TSM's path" if self.by_referee(scene) else ""

    def refusal(self, scene: Scene) -> str | None:
        """Return why the rods cannot state `scene`; None if they can. Several rods are solved along the path of exact elements."""
        from comparisons.models.translate import beams_refusal

        return self.unstated(scene) or beams_refusal(scene)

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:
        """Return the response to `scene`, not yet checked."""
        from comparisons.models.exact import solve_rod
        from comparisons.models.network import solve_network
        from comparisons.models.translate import to_rod

        del options
        if self.by_referee(scene):
            return solve_network(scene, self.name, watch)
        local = to_rod(scene)
        if any(contact.friction for contact in scene.contacts):
            from comparisons.models.rod_friction import solve_rod_with_friction

            return solve_rod_with_friction(scene, local)
        return solve_rod(scene, local)

    def styles(self) -> dict[str, Style]:
        """Return one style."""
        return {self.label: Style(colour="#000000", width=1.2, unbroken=True)}


class Elastica(Rod):
    """The elastica, which neither stretches nor shears, under one pin on its axis."""

    name = "elastica"
    label = "elastica"
    rod = False
    keys = ONE_ROD

    def apart(self, scene: Scene) -> float:
        """Return the part of a cantilever's deflection under a force at its tip that is shear, and as much of stretch."""
        return max(3.0 * beam.EI / beam.length**2 * (1.0 / beam.EA + 1.0 / beam.GA) for beam in scene.beams)

    def by_referee(self, scene: Scene) -> bool:
        """Never: other scenes are refused."""
        del scene
        return False

    @property
    def reference(self) -> None:
        """None: without stretch and shear, the elastica is no reference."""
        return

    def refusal(self, scene: Scene) -> str | None:
        """Return why the elastica cannot state `scene`; None if it can."""
        from comparisons.models.exact import elastica_scene

        try:
            elastica_scene(scene)
        except ModelError as error:
            return str(error)
        return None

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:
        """Return the response to `scene`, not yet checked."""
        from comparisons.models.exact import solve_elastica

        return solve_elastica(scene, options, watch)

    def styles(self) -> dict[str, Style]:
        """Return one style."""
        return {self.label: Style(colour="#444444", width=1.2)}

    def error_parts(self, scene: Scene, options: Options, bent: Bending) -> dict[str, float]:
        """Return the errors from missing stretch and shear."""
        from comparisons.models.theory import elastica_errors

        del options
        return elastica_errors(scene, bent)


ROD, ELASTICA = MODELS = Rod(), Elastica()

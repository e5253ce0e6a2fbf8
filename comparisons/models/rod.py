"""Reissner's rods, which stretch and shear: one by collocation under one pin, any others by the referee."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comparisons.models.base import Model, Style
from comparisons.models.options import ModelError, Options
from comparisons.models.tsm import beams_refusal
from comparisons.scene.keys import RODS

if TYPE_CHECKING:
    from comparisons.models.progress import Watch
    from comparisons.response import Response
    from comparisons.scene import Scene


class Rod(Model):
    """Exact rods."""

    name = "rod"
    label = "exact rod"
    libraries = ("comparisons.models.cantilever",)
    meshed = False
    keys = RODS

    @property
    def reference(self) -> Options | None:
        """Default options: the rod has no settings."""
        return Options()

    def by_referee(self, scene: Scene) -> bool:
        """Whether the scene is not one rod under one pin."""
        from comparisons.models.cantilever import to_rod

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
        return self.unstated(scene) or beams_refusal(scene)

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:
        """Return the response to `scene`, not yet checked."""
        from comparisons.models.cantilever import solve_rod, to_rod
        from comparisons.models.rods import solve_rods

        del options
        return solve_rods(scene, watch) if self.by_referee(scene) else solve_rod(to_rod(scene))

    def styles(self) -> dict[str, Style]:
        """Return one style."""
        return {self.label: Style(colour="#000000", width=1.2, unbroken=True)}


ROD = Rod()
MODELS = (ROD,)

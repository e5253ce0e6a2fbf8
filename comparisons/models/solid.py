"""The two-dimensional solid."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING

from comparisons.models.base import Model, Style
from comparisons.models.options import Options
from comparisons.scene.keys import STRIPS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from comparisons.models.progress import Watch
    from comparisons.models.theory import Bending
    from comparisons.response import Response
    from comparisons.scene import Scene

REFINED = ((25, 1), (50, 2), (100, 4), (200, 8))
"""Meshes refined alike in both directions, to which an order of convergence can be fitted."""
COARSE = ((8, 1), (12, 1), (16, 1), (25, 2))


class Solid(Model):
    """Beams as two-dimensional solid elements in contact."""

    name = "solid"
    label = "solid"
    options = ("mesh", "branch")
    libraries = ("fem_reference", "skfem")
    refinable = True
    continuum = True
    keys = STRIPS

    def refusal(self, scene: Scene) -> str | None:
        """Return why the solid cannot state `scene`; None if it can."""
        from comparisons.models.translate import to_solid

        try:
            to_solid(scene)
        except ValueError as error:
            return str(error)
        return None

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:
        """Return the response to `scene`, not yet checked."""
        from comparisons.models.discrete import solve_solid

        return solve_solid(scene, options, watch)

    def styles(self) -> dict[str, Style]:
        """Return one style for every order of the elements."""
        markers = {"": "h", " Q2": "h", " Q2-full": "P", " Q1": "X"}
        return {
            f"{self.label}{order}": Style(colour="#56B4E9", marker=marker, width=6.0, unbroken=True)
            for order, marker in markers.items()
        }

    def setting(self, scene: Scene, options: Options) -> str:
        """Return element order, mesh and contact, as ``Q2 50x2``."""
        meshes = {options.mesh or beam.solid_mesh_file or beam.mesh for beam in scene.beams}
        names = sorted(mesh if isinstance(mesh, str) else f"{mesh[0]}x{mesh[1]}" for mesh in meshes)
        given = "".join(
            f" {name} {value:g}"
            for name in ("penalty", "penetration")
            for value in sorted({getattr(item, name) for item in scene.contacts} - {None})
        )
        return f"{_order(scene)} {'+'.join(names)}{given}"

    def family(self, scene: Scene, options: Options) -> str:
        """Return the order of the elements, as ``solid Q2``."""
        del options
        return f"{self.label} {_order(scene)}"

    def resolution(self, options: Options) -> float:
        """Return the number of elements along a beam; nan where the scene gives the number."""
        return nan if options.mesh is None else float(options.mesh[0])

    def resolutions(self, *, quick: bool) -> Iterator[Options]:
        """Yield meshes, coarse to fine."""
        yield from (Options(mesh=mesh) for mesh in (*COARSE, *REFINED[: 2 if quick else 3]))

    def error_parts(self, scene: Scene, options: Options, bent: Bending) -> dict[str, float]:
        """Return the parts of the difference between a strip and the rod."""
        from comparisons.models.theory import solid_errors

        return solid_errors(scene, options, bent)


def _order(scene: Scene) -> str:
    return "+".join(sorted({beam.solid_element for beam in scene.beams}))


SOLID = Solid()
MODELS = (SOLID,)

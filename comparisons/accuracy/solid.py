"""The solid to a stated accuracy: meshes twice as fine until two of them agree."""

from dataclasses import replace

import numpy as np

from comparisons.accuracy.answer import Discretised
from comparisons.accuracy.pilot import SAFETY, pilot
from comparisons.errors import difference
from comparisons.models import SOLID, solve
from comparisons.models.options import Options
from comparisons.response import Response
from comparisons.scene import Scene

MESHES = ((12, 2), (25, 2), (50, 2), (100, 4), (200, 8), (400, 16))
"""Elements along and across a strip of `SLENDER` and more lengths over heights; fewer along in stockier ones."""
SLENDER = 20.0
ORDER = 2


def solid_to(scene: Scene, accuracy: float, quantity: str) -> Discretised:
    """Solve with solid elements on the coarsest mesh that differs little enough from the one before.

    Its error is the difference over ``2^p - 1`` with p = 2, times a safety factor of two; meshes are compared at a few load parameters.
    """
    said: list[str] = []
    before: Response | None = None
    short, estimate, mesh = pilot(scene), np.inf, MESHES[0]
    for mesh in MESHES:
        here = _meshed(short, mesh)
        response = solve(here, SOLID.name, Options())
        if before is not None:
            apart = float(np.fmax(difference(before, response, scene, quantity), 0.0))
            estimate = SAFETY * apart / (2**ORDER - 1)
            said.append(f"solid, {mesh[0]}x{mesh[1]}: estimate {estimate:.1e} of {quantity}")
        if estimate <= accuracy:
            break
        if not response.completed:
            said.append(f"solid, {mesh[0]}x{mesh[1]}: {response.status}")
        before = response
    chosen = _meshed(scene, mesh)
    response = solve(chosen, SOLID.name, Options())
    shown = " + ".join("x".join(map(str, beam.mesh)) for beam in chosen.beams)
    return Discretised(
        response=response,
        scene=chosen,
        resolution=f"{chosen.beams[0].solid_element} elements, {shown}, {response.unknowns} unknowns",
        estimate=float(estimate),
        decisions=tuple(said),
    )


def _meshed(scene: Scene, mesh: tuple[int, int]) -> Scene:
    """Return the scene with every strip meshed alike, stocky ones with fewer elements along."""
    from comparisons.models.solid import rectangle

    beams = []
    for beam in scene.beams:
        part = min(1.0, beam.length / rectangle(beam)[1] / SLENDER)
        beams.append(replace(beam, mesh=(max(4, round(part * mesh[0])), mesh[1]), solid_mesh_file=None))
    return replace(scene, beams=tuple(beams))

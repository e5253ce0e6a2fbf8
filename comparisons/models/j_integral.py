"""Material forces of the solid: the J-integral, averaged over the sections between clamp and contact."""

from typing import Any

import numpy as np

from comparisons.response import Array
from comparisons.response.material import clamped
from comparisons.scene import Scene

MARGIN = 1.5
"""Distance from clamp and contact, over the height, within which stresses are local; sections there are left out."""
SHARE = 0.25
"""Largest part of the distance between clamp and contact that is left out at either end."""


def j_integrals(scene: Scene, result: Any) -> dict[str, Array]:
    """Return the J-integrals at the clamps of `comparisons.response.material.clamped`, shape (s,) by beam [force].

    The J-integral is the same for all sections between the clamp and the nearest contact. Its error changes its sign between
    neighbouring Gauss stations and is largest beside clamp and contact. The value is therefore the mean over the Gauss stations in
    between, without those nearer to clamp or contact than 1.5 heights or a quarter of the distance. It is nan where no station is left.
    The J-integral of a naturally curved beam is not constant, and is left out.

    Parameters
    ----------
    scene : Scene
        The scene that was solved.
    result : fem_reference.Result
        The solution.
    """
    steps = range(len(result.load_parameter))
    return {
        beam: np.array([_mean(scene, result, beam, clamp.end, k) for k in steps])
        for beam, clamp in clamped(scene).items()
        if not scene.beam(beam).turn
    }


def _mean(scene: Scene, result: Any, beam: str, end: str, k: int) -> float:
    """Mean of the J-integral at load parameter k over the sections between the clamp at `end` and the nearest contact."""
    import fem_reference

    length, height = scene.beam(beam).length, scene.beam(beam).rectangle_height
    arcs = np.array(
        [result.contacts[contact.pair].arc_position[k] for contact in scene.contacts if contact.beam == beam]
    )
    from_clamp = arcs if end == "start" else length - arcs
    free = float(np.fmin.reduce(from_clamp, initial=length))
    margin = min(MARGIN * height, SHARE * free)
    sections = fem_reference.section_forces(result, beam, k)
    distance = sections.stations if end == "start" else length - sections.stations
    inside = (distance > margin) & (distance < free - margin)
    return float(sections.material_force[inside].mean()) if inside.any() else float(np.nan)

"""The von Mises stress of beams and solids on one footing, on quadrilaterals."""

from typing import Any

import numpy as np

from comparisons.response import Array, Grid, Response
from comparisons.scene import BeamSpec, Scene
from comparisons.show.export import nodes
from comparisons.show.panel import Body, Panel, joined, marks

LAYERS = 8
"""Layers over the height of a beam's picture."""
QUARTERS = {
    "quad9": np.array([[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]]),
    "quad": np.array([[0, 1, 2, 3]]),
}
"""The quadrilaterals in the cells of a solid, in VTK's order of points."""


def solid_body(grid: Grid, stress: str, factor: float = 1.0) -> Body:
    """Return a solid's deformed body with one of its stresses; the deformation is enlarged by `factor`."""
    quads = [
        grid.cells[kind][:, quarters].reshape(-1, 4)
        for kind, quarters in QUARTERS.items()
        if kind in grid.cells
    ]
    data = grid.point_data
    return data["deformed"] + (factor - 1.0) * data["displacement"], np.concatenate(quads), data[stress]


def solid_panel(response: Response, scene: Scene, ks: list[int], title: str) -> Panel:
    """Return the solid's deformed shapes at the load parameters numbered `ks`."""
    bodies = [solid_body(response.grid(k), "von_mises") for k in ks]
    return joined(title, bodies, [_marks(response, scene, k) for k in ks])


def beam_panel(response: Response, scene: Scene, ks: list[int], title: str) -> Panel:
    """Return the beams' deformed shapes at the load parameters numbered `ks`, as ribbons.

    A ribbon has the height of the section, or of the rectangle with its area and second moment.

    ``sigma_x = N/A - M y/I``, ``tau = V/(2 I) (h^2/4 - y^2)``, ``sigma^2 = sigma_x^2 + 3 tau^2``.
    """
    bodies = [_ribbon(response, scene, beam, k) for k in ks for beam in scene.beams]
    return joined(title, bodies, [_marks(response, scene, k) for k in ks])


def _marks(response: Response, scene: Scene, k: int) -> dict[str, Any]:
    """Return the pins and supports of a load parameter, without forces: arrows at several load parameters would hide the bodies."""
    ends = np.array([point for beam in scene.beams for point in (beam.start, beam.end)])
    found = marks(nodes(response, scene, k), float(np.ptp(ends, axis=0).max()))
    return {**found, "forces": 0.0 * found["forces"]}


def _ribbon(response: Response, scene: Scene, beam: BeamSpec, k: int) -> Body:
    arc, line = response.axis_line(beam.name, k)
    sections = np.array([beam.section(part) for part in arc / beam.length])
    area, inertia = sections[:, 0, None], sections[:, 1, None]
    tangent = np.gradient(line, axis=0)
    tangent /= np.hypot(*tangent.T)[:, None]
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
    N, V, M = (values[:, None] for values in _section_forces(response, scene, beam, k, arc))
    height = np.sqrt(12.0 * inertia / area)  # of the rectangle with this area and second moment
    y = height * np.linspace(-0.5, 0.5, LAYERS + 1)
    points = line[:, None, :] + y[:, :, None] * normal[:, None, :]
    sigma = N / area - M * y / inertia
    tau = V * (height**2 / 4.0 - y**2) / (2.0 * inertia)
    first = (np.arange(len(arc) - 1)[:, None] * (LAYERS + 1) + np.arange(LAYERS)).ravel()
    quads = np.stack([first, first + LAYERS + 1, first + LAYERS + 2, first + 1], axis=1)
    return points.reshape(-1, 2), quads, np.sqrt(sigma**2 + 3.0 * tau**2).ravel()


def _section_forces(
    response: Response, scene: Scene, beam: BeamSpec, k: int, arc: Array
) -> tuple[Array, ...]:
    """N, V, M at arc positions of one beam, linear inside its elements."""
    data = response.grid(k).point_data
    rows = data["beam"] == scene.beams.index(beam)
    return tuple(np.interp(arc, data["arc"][rows], data[name][rows]) for name in ("N", "V", "M"))

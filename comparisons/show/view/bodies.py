"""A grid as a body of quadrilaterals with its axial stress, and pins with the forces on the beams."""

import numpy as np
from numpy.typing import NDArray

from comparisons.response import SLIPS, Array, Grid
from comparisons.show.stress import QUAD9_QUARTERS, Panel

Body = tuple[Array, NDArray[np.int64], Array]
PARTS, LAYERS = 8, 4
"""Quadrilaterals along the line of an element of a beam and over its height."""
THIN = 2e-3
"""Height of a beam whose section has none, over the size of the picture."""


def panel(body: Grid, pins: Grid, title: str) -> Panel:
    """Return the deformed body, the solid's or the ribbons of beams, and its pins with their contact forces."""
    points, quads, stress = _solid(body) if "quad9" in body.cells else _ribbons(body)
    places = pins.point_data.get("deformed", np.zeros((0, 2)))
    forces = pins.point_data.get("contact_force", np.zeros_like(places))
    slip = np.where(forces.any(axis=1), pins.point_data.get("slip", np.full(len(places), np.nan)), np.nan)
    return Panel(
        title=f"{title}{_states(slip)}",
        points=points,
        quads=quads,
        stress=stress,
        pins=places,
        forces=forces,
        slip=slip,
    )


def _states(slip: Array) -> str:
    """Return the states of pins with friction in words."""
    words = [SLIPS[int(one)] for one in slip[~np.isnan(slip)]]
    return f", pin {' and '.join(words)}" if words else ""


def _solid(grid: Grid) -> Body:
    quads = grid.cells["quad9"][:, QUAD9_QUARTERS].reshape(-1, 4)
    return grid.point_data["deformed"], quads, grid.point_data["axial_stress"]


def _ribbons(grid: Grid) -> Body:
    """Ribbons of the beams' heights about the cubics that have the ends and end rotations of the lines."""
    data, ends = grid.point_data, grid.cells["line"]
    place, turn = data["deformed"][ends], data["rotation"][ends]
    undeformed = np.diff(grid.points[ends], axis=1)[:, 0]
    angle = turn + np.arctan2(undeformed[:, 1], undeformed[:, 0])[:, None]
    chord = np.hypot(*np.diff(place, axis=1)[:, 0].T)
    tangent = np.stack([np.cos(angle), np.sin(angle)], axis=-1) * chord[:, None, None]
    u = np.linspace(0.0, 1.0, PARTS + 1)
    blends = np.stack([1 - 3 * u**2 + 2 * u**3, 3 * u**2 - 2 * u**3, u - 2 * u**2 + u**3, u**3 - u**2])
    line = np.einsum("bu,ebx->eux", blends, np.concatenate([place, tangent], axis=1))
    between = np.stack([1 - u, u])
    section = np.einsum("bu,eb->eu", between, angle)
    normal = np.stack([-np.sin(section), np.cos(section)], axis=-1)
    half = data["height"][ends[:, 0]] / 2.0
    half[half == 0.0] = THIN / 2.0 * float(np.ptp(grid.points, axis=0).max())
    across = np.linspace(-1.0, 1.0, LAYERS + 1)
    points = line[:, :, None] + half[:, None, None, None] * across[:, None] * normal[:, :, None]
    right, left = (
        np.einsum("bu,eb->eu", between, data[name][ends])
        for name in ("axial_stress_right", "axial_stress_left")
    )
    stress = right[..., None] * (1 - across) / 2 + left[..., None] * (1 + across) / 2
    number = np.arange(points[..., 0].size).reshape(points.shape[:-1])
    corners = (number[:, :-1, :-1], number[:, 1:, :-1], number[:, 1:, 1:], number[:, :-1, 1:])
    quads = np.stack(corners, axis=-1).reshape(-1, 4)
    return points.reshape(-1, 2), quads, stress.ravel()

"""Blocks of a load parameter as one picture: bodies with their axial stress, contacts with the forces on the beams, supports."""

from collections.abc import Mapping

import numpy as np

from comparisons.response import Array, Grid
from comparisons.show.export import POINTS
from comparisons.show.panel import Body, Panel, joined, marks
from comparisons.show.stress import QUARTERS, solid_body

PARTS, LAYERS = 8, 4
"""Quadrilaterals along the line of an element of a beam and over its height."""
THIN = 2e-3
"""Height of a beam whose section has none, over the size of the picture."""


def panel(blocks: Mapping[str, Grid], title: str, factor: float = 1.0) -> Panel:
    """Return the deformed bodies, solids or the ribbons of beams, with contacts, their forces and supports.

    Parameters
    ----------
    blocks : mapping of Grid
        As `comparisons.show.export.blocks` gives them.
    title : str
        What it shows; the enlargement is added.
    factor : float
        Enlargement of the displacements.
    """
    bodies = [grid for name, grid in blocks.items() if name not in POINTS]
    size = float(np.ptp(np.concatenate([grid.points for grid in bodies]), axis=0).max())
    drawn = marks(blocks, size, factor)
    shapes = [
        solid_body(grid, "axial_stress", factor)
        if QUARTERS.keys() & grid.cells.keys()
        else _ribbons(grid, size, factor)
        for grid in bodies
    ]
    enlarged = "" if factor == 1.0 else f", deformation x {factor:g}"
    return joined(f"{title}{enlarged}", shapes, [drawn])


def _ribbons(grid: Grid, size: float, factor: float) -> Body:
    """Ribbons of a beam's height about the cubics that have the ends and end tangents of the lines; straight lines without rotations."""
    data, ends = grid.point_data, grid.cells["line"]
    straight = np.diff(grid.points[ends], axis=1)
    place = (data["deformed"] + (factor - 1.0) * data["displacement"])[ends]
    chord = np.diff(data["deformed"][ends], axis=1)
    if "rotation" in data:
        before = _end_angles(np.arctan2(straight[:, 0, 1], straight[:, 0, 0]))
        undeformed = np.hypot(*straight.T).T[..., None] * _unit(before)
        tangent = np.hypot(*chord.T).T[..., None] * _unit(before + data["rotation"][ends])
    else:
        undeformed, tangent = (np.repeat(vectors, 2, axis=1) for vectors in (straight, chord))
    tangent = tangent + (factor - 1.0) * (tangent - undeformed)
    u = np.linspace(0.0, 1.0, PARTS + 1)
    blends = np.stack([1 - 3 * u**2 + 2 * u**3, 3 * u**2 - 2 * u**3, u - 2 * u**2 + u**3, u**3 - u**2])
    line = np.einsum("bu,ebx->eux", blends, np.concatenate([place, tangent], axis=1))
    between = np.stack([1 - u, u])
    section = np.einsum("bu,eb->eu", between, _angles(tangent))
    normal = _unit(section + np.pi / 2.0)
    half = np.einsum("bu,eb->eu", between, data.get("height", np.zeros(len(grid.points)))[ends]) / 2.0
    half[half == 0.0] = THIN / 2.0 * size
    across = np.linspace(-1.0, 1.0, LAYERS + 1)
    points = line[:, :, None] + half[..., None, None] * across[:, None] * normal[:, :, None]
    right, left = (
        np.einsum("bu,eb->eu", between, data.get(name, np.zeros(len(grid.points)))[ends])
        for name in ("axial_stress_right", "axial_stress_left")
    )
    stress = right[..., None] * (1 - across) / 2 + left[..., None] * (1 + across) / 2
    number = np.arange(points[..., 0].size).reshape(points.shape[:-1])
    corners = (number[:, :-1, :-1], number[:, 1:, :-1], number[:, 1:, 1:], number[:, :-1, 1:])
    quads = np.stack(corners, axis=-1).reshape(-1, 4)
    return points.reshape(-1, 2), quads, stress.ravel()


def _end_angles(chords: Array) -> Array:
    """Return the angles of an undeformed axis at both ends of every line, shape (e, 2), from those of the lines of an arc."""
    chords = np.unwrap(chords)
    between = (chords[1:] + chords[:-1]) / 2.0
    if not len(between):
        return np.repeat(chords[:, None], 2, axis=1)
    first, last = 2.0 * chords[0] - between[0], 2.0 * chords[-1] - between[-1]
    return np.stack([np.append(first, between), np.append(between, last)], axis=1)


def _unit(angles: Array) -> Array:
    return np.stack([np.cos(angles), np.sin(angles)], axis=-1)


def _angles(tangent: Array) -> Array:
    """Return the angles of the tangents at both ends of every line, the second within half a turn of the first."""
    first = np.arctan2(tangent[:, 0, 1], tangent[:, 0, 0])
    cross = tangent[:, 0, 0] * tangent[:, 1, 1] - tangent[:, 0, 1] * tangent[:, 1, 0]
    turn = np.arctan2(cross, np.einsum("ex,ex->e", tangent[:, 0], tangent[:, 1]))
    return np.stack([first, first + turn], axis=1)

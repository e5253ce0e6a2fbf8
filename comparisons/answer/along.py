"""Extremes of section forces, axial stress and displacement along the beams, with their places."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.answer.record import Answer, Array, Sections
from comparisons.scene import BeamSpec, Scene

FIRST = 1e-9
"""Relative difference up to which values count as equal, so that the first of them is taken whatever the round-off."""
APART = 1e-12
"""Largest distance of two stations at one place, over the length of the beam."""
CLOSE = 0.9
"""Fraction of the largest station value of all load parameters below which a largest value cannot be."""
UNEVEN = 1e-3
"""Smallest ratio of the shortest to the longest station spacing at which a polynomial is used."""
ALONG = {
    "axial_force": ("force", "axial force"),
    "shear_force": ("force", "shear force"),
    "bending_moment": ("moment", "bending moment"),
    "tensile_stress": ("stress", "nominal axial stress, tension"),
    "compressive_stress": ("stress", "nominal axial stress, compression"),
    "displacement": ("length", "displacement of the axis"),
}
"""The quantities along a beam: their kinds and words. Forces and moments are the largest in magnitude with their signs. The stresses are the
nominal ones at the faces, ``N/A + M h/2I`` and ``N/A - M h/2I``; the other sign counts as 0."""


Curve = tuple[Array, Array]
"""Arc lengths, and the values of a quantity at them."""


class Extreme(NamedTuple):
    """Extremes of a quantity along a beam, one per load parameter: values (s,), and their arc positions (s,) from the start."""

    value: Array
    arc_position: Array


def extremes_along(
    response: Answer, scene: Scene, *, every: bool = True, steps: Iterable[int] | None = None
) -> dict[str, dict[str, Extreme]]:
    """Return the extremes by beam and by quantity, a key of `ALONG`, at all load parameters or some; without quantities that the model does not state.

    An extreme may lie between stations, see `peak`. Without `every` it is 0 where it cannot be the largest over the load parameters.
    """
    chosen = range(len(response.load_parameter)) if steps is None else steps
    return {beam.name: _along(response, beam, every, chosen) for beam in scene.beams}


def _along(response: Answer, beam: BeamSpec, every: bool, steps: Iterable[int]) -> dict[str, Extreme]:
    rows: dict[str, list[list[Curve]]] = {}
    for k in steps:
        found = {} if response.sections is None else _forces(response.sections(beam.name, k), beam)
        arc, line = response.axis_line(beam.name, k)
        undeformed = [beam.place(part) for part in (arc / beam.length).tolist()]
        found["displacement"] = [(arc, np.hypot(*(line - undeformed).T))]
        for name, curves in found.items():
            rows.setdefault(name, []).append(curves)
    return {name: _extreme(curves, every) for name, curves in rows.items()}


def _extreme(rows: list[list[Curve]], every: bool) -> Extreme:
    """Return one extreme per row (load parameter); of equal curves, the first."""
    sizes = [max(float(np.abs(values).max()) for _, values in curves) for curves in rows]
    least = 0.0 if every else CLOSE * max(sizes)
    found = [
        max((peak(*curve) for curve in row), key=lambda one: abs(one[0])) if size >= least else (0.0, 0.0)
        for row, size in zip(rows, sizes, strict=True)
    ]
    return Extreme(*np.array(found).T)


def _forces(at: Sections, beam: BeamSpec) -> dict[str, list[Curve]]:
    own = _once(at, APART * beam.length)
    arc, N, V, M = (values[own] for values in (at.arc, at.N, at.V, at.M))
    curves = {"axial_force": [N], "shear_force": [V], "bending_moment": [M]}
    if beam.height is not None:
        parts = np.minimum(arc / beam.length, 1.0).tolist() if beam.tapers else [0.0]
        area, inertia, _ = np.array([beam.section(part) for part in parts]).T
        bending = M * (np.array([beam.height_at(part) for part in parts]) / (2.0 * inertia))
        faces = N / area + bending, N / area - bending
        curves["tensile_stress"] = [np.maximum(face, 0.0) for face in faces]
        curves["compressive_stress"] = [np.minimum(face, 0.0) for face in faces]
    return {name: [(arc, values) for values in found] for name, found in curves.items()}


def _once(at: Sections, apart: float) -> NDArray[np.bool_]:
    """Return which stations are no doubles at which no force jumps."""
    forces = np.stack([at.N, at.V, at.M])
    scale = np.array([[1.0], [1.0], [max(at.arc[-1], apart)]]) * max(float(np.abs(forces[:2]).max()), 1e-300)
    jumps = np.any(np.abs(np.diff(forces, axis=1)) > FIRST * scale, axis=0)
    return np.append(True, (np.diff(at.arc) > apart) | jumps)


def peak(arc: Array, values: Array) -> tuple[float, float]:
    """Return the value of the largest magnitude, and its arc length: the first one of equal values.

    Around the largest station value, a polynomial through it and two neighbours on each side (or one) may be larger. There is none
    at an end or across a jump (two stations at one place).

    Examples
    --------
    >>> s = np.linspace(0.0, 1.0, 6)
    >>> value, at = peak(s, 1.0 - (s - 0.35) ** 2 + 0.1 * (s - 0.35) ** 4)
    >>> round(value, 12), round(at, 12)
    (1.0, 0.35)
    """
    sizes = np.abs(values)
    k = int(np.argmax(sizes >= (1.0 - FIRST) * sizes.max()))
    value, place = float(values[k]), float(arc[k])
    for reach in (2, 1):
        near = slice(k - reach, k + reach + 1)
        spacing = np.diff(arc[near]) if reach <= k < len(arc) - reach else np.zeros(1)
        if spacing.min() > UNEVEN * spacing.max():
            return _vertex(arc[near] - place, values[near], value, place)
    return value, place


def _vertex(x: Array, values: Array, value: float, place: float) -> tuple[float, float]:
    """Return the largest value, and its place, of the polynomial through values at the distances `x` from a place, between its neighbours."""
    scale, middle = np.abs(x).max(), len(x) // 2
    curve = np.linalg.solve(np.vander(x / scale), values)
    roots = np.roots(np.polyder(curve))
    turns = [
        float(at.real) for at in roots if at.imag == 0.0 and x[middle - 1] <= at.real * scale <= x[middle + 1]
    ]
    best = max(turns, key=lambda at: abs(np.polyval(curve, at)), default=0.0)
    found = float(np.polyval(curve, best))
    return (found, float(place + best * scale)) if abs(found) > abs(value) else (value, place)

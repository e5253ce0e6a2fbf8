"""Extremes of section forces, axial stress and displacement along the beams, with their places."""

from collections.abc import Callable
from functools import cache
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from comparisons.answer.record import Answer, Array, Sections
from comparisons.scene import BeamSpec, Scene

FIRST = 1e-9
"""Part of the largest value by which the first place of an extreme may be smaller, so that round-off does not choose between equals."""
APART = 1e-12
"""Distance of two stations, over the length of the beam, that are the two sides of one place."""
UNEVEN = 1e-3
"""Smallest distance of two stations, over the largest near them, between which a polynomial is drawn."""
ALONG = {
    "axial_force": ("force", "axial force"),
    "shear_force": ("force", "shear force"),
    "bending_moment": ("moment", "bending moment"),
    "tensile_stress": ("stress", "nominal axial stress, tension"),
    "compressive_stress": ("stress", "nominal axial stress, compression"),
    "displacement": ("length", "displacement of the axis"),
}
"""The quantities along a beam: their kinds and words. Forces and moments are the largest in magnitude with their signs. The stresses are the
nominal ones at the faces, ``N/A + M h/2I`` and ``N/A - M h/2I``, the largest and the smallest."""


class Extreme(NamedTuple):
    """The extreme of a quantity along a beam over the load parameters: value (s,), and its distance (s,) along the axis from the start."""

    value: Array
    arc_position: Array


def extremes_along(response: Answer, scene: Scene) -> dict[str, dict[str, Extreme]]:
    """Return the extremes by beam and by quantity, a key of `ALONG`; without quantities that the model does not state."""
    return {beam.name: _along(response, beam) for beam in scene.beams}


def _along(response: Answer, beam: BeamSpec) -> dict[str, Extreme]:
    rows: dict[str, list[tuple[float, float]]] = {}
    undeformed = cache(lambda arcs: np.array([beam.place(arc / beam.length) for arc in arcs]))
    section = cache(lambda arcs: _sections(beam, arcs))
    for k in range(len(response.load_parameter)):
        found = {} if response.sections is None else _forces(response.sections(beam.name, k), beam, section)
        arc, line = response.axis_line(beam.name, k)
        found["displacement"] = peak(arc, np.hypot(*(line - undeformed(tuple(arc))).T))
        for name, extreme in found.items():
            rows.setdefault(name, []).append(extreme)
    return {name: Extreme(*np.array(values).T) for name, values in rows.items()}


def _sections(beam: BeamSpec, arcs: tuple[float, ...]) -> Array:
    """Return area and half the height over the second moment at arc lengths, shape (2, m); of a uniform beam (2, 1)."""
    found, arcs = [], arcs if beam.tapers else (0.0,)
    for arc in arcs:
        fraction = min(arc / beam.length, 1.0)
        area, inertia, _ = beam.section(fraction)
        found.append((area, beam.height_at(fraction) / (2.0 * inertia)))
    return np.array(found).T


def _forces(
    at: Sections, beam: BeamSpec, section: Callable[[tuple[float, ...]], Array]
) -> dict[str, tuple[float, float]]:
    at = _once(at, APART * beam.length)
    forces = {"axial_force": at.N, "shear_force": at.V, "bending_moment": at.M}
    found = {name: peak(at.arc, values) for name, values in forces.items()}
    if beam.height is None:
        return found
    area, lever = section(tuple(at.arc))
    faces = np.stack([at.N / area + at.M * lever, at.N / area - at.M * lever])
    for name, sign in (("tensile_stress", 1.0), ("compressive_stress", -1.0)):
        ends = (peak(at.arc, np.maximum(sign * face, 0.0)) for face in faces)
        value, arc = max(ends, key=itemgetter(0))
        found[name] = sign * value, arc
    return found


def _once(at: Sections, apart: float) -> Sections:
    """Return the stations, with those at which nothing jumps stated once."""
    forces = np.stack([at.N, at.V, at.M])
    scale = np.array([[1.0], [1.0], [max(at.arc[-1], apart)]]) * max(float(np.abs(forces[:2]).max()), 1e-300)
    same = np.diff(at.arc) <= apart
    jumps = np.any(np.abs(np.diff(forces, axis=1)) > FIRST * scale, axis=0)
    kept = np.append(True, ~same | jumps)
    return Sections(arc=at.arc[kept], N=at.N[kept], V=at.V[kept], M=at.M[kept])


def peak(arc: Array, values: Array) -> tuple[float, float]:
    """Return the value of the largest magnitude, and its arc length: the first one of equal values.

    Between stations the value is that of the polynomial through the station and its neighbours, two on each side or one; there is none
    across a jump, which has two stations at one place.

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
        if k < reach or k + reach >= len(arc):
            continue
        spacing = np.diff(arc[near])
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

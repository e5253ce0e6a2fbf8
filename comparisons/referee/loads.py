"""The dead loads of a scene at a load parameter, and their places along the axis that an answer states."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

from comparisons.scene import Scene

Array = NDArray[np.float64]

_POINTS, _WEIGHTS = leggauss(3)


class DeadLoad(NamedTuple):
    """A dead load on a beam, at a node, at a fraction of the length, or along a part of the beam.

    Attributes
    ----------
    beam, node : str
        The beam, and its loaded end as ``upper.end``; no node for a load inside or along a beam.
    first, last : float
        Fractions of the undeformed length between which the load acts.
    force : (float, float)
        The whole force.
    moment : float
        Moment.
    shares : tuple of float
        Parts of the force at the Gauss points between `first` and `last`; the sum is 1.
    """

    beam: str
    node: str
    first: float
    last: float
    force: tuple[float, float]
    moment: float = 0.0
    shares: tuple[float, ...] = ()


def dead_loads(scene: Scene, t: float) -> Iterator[DeadLoad]:
    """Yield the dead loads at load parameter t, and the weights of the beams."""
    for item in scene.load_histories:
        load, (x, y, moment) = item.load, item.at(t)
        if load.force_per_length is not None:
            (first, last), length = load.span, scene.beam(load.beam).length
            span = (last - first) * length
            yield DeadLoad(
                load.beam, "", first, last, (x * span, y * span), shares=tuple(map(float, _WEIGHTS / 2.0))
            )
        elif load.at is not None:
            yield DeadLoad(load.beam, "", load.at, load.at, (x, y), moment)
        else:
            yield DeadLoad(load.beam, load.node, 0.0, 0.0, (x, y), moment)
    gx, gy = scene.gravity_at(t)
    for beam in scene.beams:
        if beam.density is not None and (gx or gy):
            masses = np.array([beam.mass_per_length((1.0 + x) / 2.0) for x in _POINTS]) * _WEIGHTS / 2.0
            mass = float(masses.sum()) * beam.length
            shares = tuple(map(float, masses / masses.sum()))
            yield DeadLoad(beam.name, "", 0.0, 1.0, (mass * gx, mass * gy), shares=shares)


def lever(load: DeadLoad, arc: Array, line: Array) -> tuple[Array, float]:
    """Return the point at which the force of a load inside or along a beam acts, and the error of the point.

    `line` (m, 2) are the positions of the axis at arc lengths `arc` (m,). Between them the axis is a cubic spline; the error is estimated
    by the spline through every second point.
    """
    points = [_centre(load, arc[k], line[k]) for k in (np.arange(len(arc)), _every_second(len(arc)))]
    return points[0], float(np.hypot(*(points[0] - points[1])))


def _every_second(count: int) -> NDArray[np.int64]:
    """Every second number below `count`, with the last one."""
    return np.unique([*range(0, count, 2), count - 1])


def _centre(load: DeadLoad, arc: Array, line: Array) -> Array:
    """Centre of the load's force on a spline; the Gauss points are those between neighbouring points of the axis."""
    from scipy.interpolate import CubicSpline

    axis, length = CubicSpline(arc, line), float(arc[-1])
    first, last = load.first * length, load.last * length
    if first == last:
        return np.asarray(axis(first))
    nodes = np.unique([first, *arc[(arc > first) & (arc < last)], last])
    middle, half = (nodes[1:] + nodes[:-1]) / 2.0, np.diff(nodes) / 2.0
    s = middle[:, None] + half[:, None] * _POINTS
    density = _density(load, (s - first) / (last - first))
    weights = density * half[:, None] * _WEIGHTS
    return np.asarray(np.einsum("ij,ijk->k", weights, axis(s)) / weights.sum())


def _density(load: DeadLoad, part: Array) -> Array:
    """Force per length over its mean at parts of the loaded length, the quadratic polynomial with the stated shares."""
    values = np.array(load.shares) / (_WEIGHTS / 2.0)
    return np.asarray(np.polyval(np.polyfit((1.0 + _POINTS) / 2.0, values, 2), part))

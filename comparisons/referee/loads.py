"""The dead loads of a scene at a load parameter."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import leggauss

from comparisons.scene import Scene

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
    """

    beam: str
    node: str
    first: float
    last: float
    force: tuple[float, float]
    moment: float = 0.0


def dead_loads(scene: Scene, t: float) -> Iterator[DeadLoad]:
    """Yield the dead loads at load parameter t, and the weights of the beams."""
    for item in scene.load_histories:
        load, (x, y, moment) = item.load, item.at(t)
        if load.force_per_length is not None:
            (first, last), length = load.span, scene.beam(load.beam).length
            span = (last - first) * length
            yield DeadLoad(load.beam, "", first, last, (x * span, y * span))
        elif load.at is not None:
            yield DeadLoad(load.beam, "", load.at, load.at, (x, y), moment)
        else:
            yield DeadLoad(load.beam, load.node, 0.0, 0.0, (x, y), moment)
    gx, gy = scene.gravity_at(t)
    for beam in scene.beams:
        if beam.density is not None and (gx or gy):
            masses = np.array([beam.mass_per_length((1.0 + x) / 2.0) for x in _POINTS]) * _WEIGHTS / 2.0
            mass = float(masses.sum()) * beam.length
            yield DeadLoad(beam.name, "", 0.0, 1.0, (mass * gx, mass * gy))

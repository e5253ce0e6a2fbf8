"""Whether two equilibria belong to one branch: the rods are followed from one load parameter to the next in steps that cannot hide a jump."""

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.basis import AMPLITUDE, DEGREE
from comparisons.referee.equations import mesh_of, moved
from comparisons.referee.equilibrium import Found, Solution, correct, newton_step
from comparisons.referee.layout import Layout, lay_out
from comparisons.referee.stability import count
from comparisons.scene import Scene

Array = NDArray[np.float64]

_NEAR = 0.2
"""Largest correction of a prediction along the tangent, over the whole change: half a step then ends at the same equilibrium."""
_ROUND_OFF = 1e-9
"""Change, in rotations [rad] and lengths, that is nothing."""
_LITTLE = 1e-7
"""Part of the way ahead over which the tangent is taken."""
_ITERATIONS = 12
"""Most iterations of Newton's method after a prediction."""
_SMALLEST = 1e-10
"""Smallest step of the load parameter, over the way that it has come: an imperfect column turns off within so little of it."""
_SAME = 1e-6
"""Largest difference between the end of the followed path and the equilibrium that it is to reach."""


def at_rest(scene: Scene) -> Solution:
    """Return the undeformed state of a scene with all contacts open."""
    layout = lay_out(scene, 0.0, {})
    mesh = mesh_of(layout, [np.linspace(0.0, 1.0, 4) for _ in layout.parts])
    return correct(layout, mesh, np.zeros(mesh.unknowns), np.zeros((len(mesh.part), DEGREE - 1)), 6)


def departs(scene: Scene, first: Solution, last: Solution) -> str:
    """Return why the path from `first` does not lead to `last`, which has the same contacts; nothing if it does.

    Prediction along the tangent; a step is kept if Newton's correction is small against it and the index is the first state's.
    """
    closed = {
        touch.spec.pair: float(first.z[touch.arc]) * first.layout.length for touch in first.layout.touches
    }
    start, end = first.layout.load_parameter, last.layout.load_parameter
    now, step, index = first, (end - start) / 4.0, count(first)[0]
    ahead = _tangent(scene, now, closed, end)
    while now.layout.load_parameter < end:
        here = now.layout.load_parameter
        t = here + step if here + step < end - _ROUND_OFF * (end - start) else end
        z, bubbles = now.z + (t - here) * ahead[0], now.bubbles + (t - here) * ahead[1]
        layout = lay_out(scene, t, closed)
        found = correct(layout, moved(layout, now.mesh), z, bubbles, _ITERATIONS)
        if found.found is Found.FOUND and count(found)[0] == index:
            off = _apart(found, z, bubbles) / (_apart(found, now.z, now.bubbles) + _ROUND_OFF)
            if off < _NEAR:
                step *= 2.0 if off < _NEAR / 3.0 else 1.0
                now, ahead = found, _tangent(scene, found, closed, end)
                continue
        step /= 2.0
        if step < _SMALLEST * max(here - start, _SMALLEST * (end - start)):
            return f"no continuous path of index {index} leads on beyond load parameter {here:.6g}"
    off = _difference(now, last)
    return (
        ""
        if off < _SAME
        else f"the path from load parameter {start:.6g} ends elsewhere at {end:.6g}, {off:.2g} L away"
    )


def _tangent(scene: Scene, now: Solution, closed: dict[str, float], end: float) -> tuple[Array, Array]:
    """Rates of the unknowns by load parameter: what is given moves in a straight line over a small part of the way ahead."""
    little = _LITTLE * (end - now.layout.load_parameter)
    if little == 0.0:
        return np.zeros_like(now.z), np.zeros_like(now.bubbles)
    layout = lay_out(scene, now.layout.load_parameter + little, closed)
    change, inside = newton_step(layout, moved(layout, now.mesh), now.z, now.bubbles)
    return change / little, inside / little


def _apart(found: Solution, z: Array, bubbles: Array) -> float:
    """Largest correction of rotations and lengths."""
    forces = [k for part in found.layout.parts for k in (part.force, part.force + 1)]
    own = found.layout.unknowns
    change = float(np.abs(np.delete(found.z[:own] - z[:own], forces)).max(initial=0.0))
    if len(found.z) != len(z):
        return change
    return max(
        change,
        float(np.abs(found.z[own:] - z[own:]).max(initial=0.0)),
        float((np.abs(found.bubbles - bubbles) * AMPLITUDE).max()),
    )


def _difference(one: Solution, other: Solution) -> float:
    """Largest distance between the stations of two equilibria with the same contacts, and of the arc positions."""
    stations: Layout = one.layout
    apart = [
        float(np.abs(stations.position(one.z, k) - other.layout.position(other.z, k)).max())
        for k in range(len(stations.stations))
    ]
    turned = [
        abs(stations.turned(one.z, k) - other.layout.turned(other.z, k))
        for k in range(len(stations.stations))
    ]
    arcs = [
        abs(float(one.z[a.arc] - other.z[b.arc]))
        for a, b in zip(stations.touches, other.layout.touches, strict=True)
    ]
    return max([*apart, *turned, *arcs])

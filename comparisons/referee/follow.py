"""Whether two equilibria belong to one branch: the rods are followed from one load parameter to the next in steps that cannot hide a jump."""

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.basis import AMPLITUDE, DEGREE
from comparisons.referee.equations import mesh_of
from comparisons.referee.equilibrium import Found, Solution, correct
from comparisons.referee.layout import Layout, lay_out
from comparisons.referee.stability import count
from comparisons.scene import Scene

Array = NDArray[np.float64]

_NEAR = 0.02
"""Largest correction of a prediction, in rotations [rad] and lengths: half a step then ends at the same equilibrium."""
_SMALLEST = 1e-11
"""Smallest step of the load parameter, over the distance."""
_SAME = 1e-6
"""Largest difference between the end of the followed path and the equilibrium that it is to reach."""


def at_rest(scene: Scene) -> Solution:
    """Return the undeformed state of a scene with all contacts open."""
    layout = lay_out(scene, 0.0, {})
    mesh = mesh_of(layout, [np.linspace(0.0, 1.0, 4) for _ in layout.parts])
    return correct(layout, mesh, np.zeros(mesh.unknowns), np.zeros((len(mesh.part), DEGREE - 1)), 6)


def departs(scene: Scene, first: Solution, last: Solution) -> str:
    """Return why the path from `first` does not lead to `last`, which has the same contacts; nothing if it does.

    Prediction along the last step's direction; a step is kept if Newton's correction is small and the index is the first state's.
    """
    closed = {
        touch.spec.pair: float(first.z[touch.arc]) * first.layout.length for touch in first.layout.touches
    }
    start, end = first.layout.load_parameter, last.layout.load_parameter
    now, before, step, index = first, None, (end - start) / 4.0, count(first)[0]
    while now.layout.load_parameter < end:
        t = min(now.layout.load_parameter + step, end)
        layout = lay_out(scene, t, closed)
        ahead = _ahead(now, before, t)
        found = correct(layout, now.mesh, *ahead, 6)
        apart = _apart(found, *ahead)
        if found.found is Found.FOUND and apart < _NEAR and count(found)[0] == index:
            step *= 2.0 if apart < _NEAR / 8.0 else 1.0
            now, before = found, now if len(found.z) == len(now.z) else None
            continue
        step /= 2.0
        if step < _SMALLEST * (end - start):
            return f"no continuous path of index {index} leads on beyond load parameter {now.layout.load_parameter:.6g}"
    off = _difference(now, last)
    return (
        ""
        if off < _SAME
        else f"the path from load parameter {start:.6g} ends elsewhere at {end:.6g}, {off:.2g} L away"
    )


def _ahead(now: Solution, before: Solution | None, t: float) -> tuple[Array, Array]:
    """Prediction on the straight line through the last two states."""
    if before is None:
        return now.z, now.bubbles
    last, here = before.layout.load_parameter, now.layout.load_parameter
    part = (t - here) / (here - last)
    return now.z + part * (now.z - before.z), now.bubbles + part * (now.bubbles - before.bubbles)


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

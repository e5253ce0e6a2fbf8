"""Whether two equilibria are on one branch: the path is followed between them in steps too short to jump to another branch."""

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.basis import AMPLITUDE, DEGREE
from comparisons.referee.elements import mesh_for, mesh_of
from comparisons.referee.equilibrium import SearchStatus, Solution, correct
from comparisons.referee.layout import Layout, lay_out
from comparisons.referee.march import closed_pairs, tangent
from comparisons.referee.stability import index_of
from comparisons.scene import Scene

Array = NDArray[np.float64]

_NEAR = 0.2
"""Largest correction of a tangent prediction over the change in the step, at which the step is accepted."""
_ROUND_OFF = 1e-9
"""Changes of rotations [rad] and lengths below this are round-off."""
_LITTLE = 1e-7
"""Fraction of the remaining path over which the tangent is a difference."""
_ITERATIONS = 12
"""Largest number of Newton iterations after a prediction."""
_SMALLEST = 1e-10
"""Smallest step of the load parameter, over the distance from the start; an imperfect column needs steps this small."""
_SAME = 1e-6
"""Largest difference between the end of the followed path and the second equilibrium."""


def at_rest(scene: Scene) -> Solution:
    """Return the undeformed state of a scene with all contacts open."""
    layout = lay_out(scene, 0.0, {})
    mesh = mesh_of(layout, [np.linspace(0.0, 1.0, 4) for _ in layout.parts])
    return correct(layout, mesh, np.zeros(mesh.unknowns), np.zeros((len(mesh.part), DEGREE - 1)), 6)


def departs(scene: Scene, first: Solution, last: Solution) -> str:
    """Return the reason why the path from `first` does not lead to `last` with the same contacts; empty if it does.

    A step is a prediction along the tangent. It is accepted if Newton's correction is small compared with the step and the index
    is unchanged.
    """
    closed, grips = closed_pairs(first), first.layout.grips
    start, end = first.layout.load_parameter, last.layout.load_parameter
    now, step, index = first, (end - start) / 4.0, index_of(first)
    ahead = _tangent(scene, now, end)
    while now.layout.load_parameter < end:
        here = now.layout.load_parameter
        t = here + step if here + step < end - _ROUND_OFF * (end - start) else end
        z, bubbles = now.z + (t - here) * ahead[0], now.bubbles + (t - here) * ahead[1]
        layout = lay_out(scene, t, closed, grips)
        corrected = correct(layout, mesh_for(layout, now.mesh), z, bubbles, _ITERATIONS)
        if corrected.status is SearchStatus.FOUND and index_of(corrected) == index:
            off = _apart(corrected, z, bubbles) / (_apart(corrected, now.z, now.bubbles) + _ROUND_OFF)
            if off < _NEAR:
                step *= 2.0 if off < _NEAR / 3.0 else 1.0
                now, ahead = corrected, _tangent(scene, corrected, end)
                continue
        step /= 2.0
        if step < _SMALLEST * max(here - start, _SMALLEST * (end - start)):
            kind = "" if index < 0 else f" of index {index}"
            return f"no continuous path{kind} leads on beyond load parameter {here:.6g}"
    off = _difference(now, last)
    return (
        ""
        if off < _SAME
        else f"the path from load parameter {start:.6g} ends elsewhere at {end:.6g}, {off:.2g} L away"
    )


def _tangent(scene: Scene, now: Solution, end: float) -> tuple[Array, Array]:
    """Rates of the unknowns, by a difference over a small fraction of the remaining path."""
    return tangent(scene, now, _LITTLE * (end - now.layout.load_parameter))


def _apart(corrected: Solution, z: Array, bubbles: Array) -> float:
    """Largest correction of rotations and lengths."""
    forces = [k for part in corrected.layout.parts for k in (part.force, part.force + 1)]
    count = corrected.layout.unknowns
    change = float(np.abs(np.delete(corrected.z[:count] - z[:count], forces)).max(initial=0.0))
    if len(corrected.z) != len(z):
        return change
    return max(
        change,
        float(np.abs(corrected.z[count:] - z[count:]).max(initial=0.0)),
        float((np.abs(corrected.bubbles - bubbles) * AMPLITUDE).max()),
    )


def _difference(one: Solution, other: Solution) -> float:
    """Largest distance between the stations of two equilibria with the same contacts, and of the arc positions."""
    stations: Layout = one.layout
    apart = [
        float(np.abs(stations.position(one.z, k) - other.layout.position(other.z, k)).max())
        for k in range(len(stations.stations))
    ]
    turned = [
        abs(stations.rotation(one.z, k) - other.layout.rotation(other.z, k))
        for k in range(len(stations.stations))
    ]
    arcs = [
        abs(float(one.z[a.arc] - other.z[b.arc]))
        for a, b in zip(stations.touches, other.layout.touches, strict=True)
    ]
    return max([*apart, *turned, *arcs])

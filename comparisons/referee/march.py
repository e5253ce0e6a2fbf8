"""Steps from one exact equilibrium to another at a near load parameter, and the tangent of the path."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.elements import mesh_for
from comparisons.referee.equilibrium import SearchStatus, Solution, correct, newton_step
from comparisons.referee.grip import Grip
from comparisons.referee.layout import NONE
from comparisons.referee.numbering import lay_out
from comparisons.scene import Scene

Array = NDArray[np.float64]
Rate = tuple[Array, Array]
"""Rates of the unknowns and bubbles per load parameter."""

_ITERATIONS = 12
"""Largest number of Newton iterations of a step."""
_TURN = 0.3
"""Largest change of a rotation in a step [rad]; a longer step could lead to another equilibrium."""
_HALVINGS = 8
"""Number of times that a step is halved at most."""


def corners(scene: Scene) -> tuple[float, ...]:
    """Load parameters at which rates jump: corners of the pins' paths, and ends of stages."""
    turns = {corner for pin in scene.pins for corner in pin.corners}
    return tuple(sorted(turns | {float(k + 1) for k in range(len(scene.stages))}))


def closed_pairs(solution: Solution) -> dict[str, float]:
    """Arc positions of the closed contacts, by pair."""
    layout = solution.layout
    return {touch.spec.pair: float(solution.z[touch.arc]) * layout.length for touch in layout.touches}


def moved(
    scene: Scene, now: Solution, t: float, grips: Mapping[str, Grip], rate: Rate | None = None
) -> Solution:
    """Return the guess at load parameter t with the contacts of an equilibrium and its unknowns, or those predicted by their rates."""
    layout, way = lay_out(scene, t, closed_pairs(now), grips), t - now.layout.load_parameter
    z, bubbles = (
        (now.z, now.bubbles) if rate is None else (now.z + way * rate[0], now.bubbles + way * rate[1])
    )
    return Solution(layout=layout, mesh=mesh_for(layout, now.mesh), z=z, bubbles=bubbles)


def reach(
    scene: Scene, near: Solution, t: float, grips: Mapping[str, Grip], halvings: int = _HALVINGS
) -> Solution:
    """Return the equilibrium at load parameter t with the same contacts, held by `grips`, by steps from `near`."""
    there = correct(moved(scene, near, t, grips), _ITERATIONS)
    turning = [k for k in (item.rotation_unknown for item in there.layout.stations) if k != NONE]
    turned = float(np.abs(there.z[turning] - near.z[turning]).max(initial=0.0))
    here = near.layout.load_parameter
    if (there.status is SearchStatus.FOUND and turned < _TURN) or not halvings or here == t:
        return there
    middle = reach(scene, near, (here + t) / 2.0, grips, halvings - 1)
    if middle.status is not SearchStatus.FOUND:
        return middle
    return reach(scene, middle, t, grips, halvings - 1)


def tangent(scene: Scene, now: Solution, little: float) -> Rate:
    """Rates of the unknowns and bubbles per load parameter, by a difference over `little`."""
    if little == 0.0:
        return np.zeros_like(now.z), np.zeros_like(now.bubbles)
    change, inside = newton_step(moved(scene, now, now.layout.load_parameter + little, now.layout.grips))
    if scene.stages:
        # in a stage that changes nothing the difference is round-off alone, which the correction here has too
        change_here, inside_here = newton_step(now)
        change, inside = change - change_here, inside - inside_here
    return change / little, inside / little

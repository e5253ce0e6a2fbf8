"""Steps from one exact equilibrium to another at a near load parameter, and rates in the load parameter."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.elements import mesh_for
from comparisons.referee.equilibrium import SearchStatus, Solution, correct, newton_step
from comparisons.referee.friction import Grip, Hold, rows
from comparisons.referee.layout import Touch, lay_out
from comparisons.referee.stations import NONE
from comparisons.scene import Scene

Array = NDArray[np.float64]

_ITERATIONS = 12
"""Largest number of Newton iterations of a step."""
_TURN = 0.3
"""Largest change of a rotation in a step [rad]; a longer step could lead to another equilibrium."""
_HALVINGS = 8
"""Number of times that a step is halved at most."""
_AHEAD, _AHEAD_TURNED = 1e-4, 1e-6
"""Load parameters over which rates are differences. The equations are linear in pins and loads, but not in prescribed rotations."""


_CORNER = 1e-9
"""Distance from a corner, in load parameters, that counts as none."""


def corners(scene: Scene) -> tuple[float, ...]:
    """Load parameters at which rates jump: corners of the pins' paths, and ends of stages."""
    turns = {corner for pin in scene.pins for corner in pin.corners}
    return tuple(sorted(turns | {float(k + 1) for k in range(len(scene.stages))}))


def closed_pairs(solution: Solution) -> dict[str, float]:
    """Arc positions of the closed contacts, by pair."""
    layout = solution.layout
    return {touch.spec.pair: float(solution.z[touch.arc]) * layout.length for touch in layout.touches}


def reach(
    scene: Scene, near: Solution, t: float, grips: Mapping[str, Grip], halvings: int = _HALVINGS
) -> Solution:
    """Return the equilibrium at load parameter t with the same contacts, held by `grips`, by steps from `near`."""
    layout = lay_out(scene, t, closed_pairs(near), grips)
    there = correct(layout, mesh_for(layout, near.mesh), near.z, near.bubbles, _ITERATIONS)
    turning = [k for k in (item.rotation_unknown for item in layout.stations) if k != NONE]
    turned = float(np.abs(there.z[turning] - near.z[turning]).max(initial=0.0))
    here = near.layout.load_parameter
    if (there.status is SearchStatus.FOUND and turned < _TURN) or not halvings or here == t:
        return there
    middle = reach(scene, near, (here + t) / 2.0, grips, halvings - 1)
    if middle.status is not SearchStatus.FOUND:
        return middle
    return reach(scene, middle, t, grips, halvings - 1)


def tangent(scene: Scene, now: Solution, little: float) -> tuple[Array, Array]:
    """Rates of the unknowns and bubbles per load parameter, by a difference over `little`."""
    if little == 0.0:
        return np.zeros_like(now.z), np.zeros_like(now.bubbles)
    layout = lay_out(scene, now.layout.load_parameter + little, closed_pairs(now), now.layout.grips)
    change, inside = newton_step(layout, mesh_for(layout, now.mesh), now.z, now.bubbles)
    if scene.stages:
        # in a stage that changes nothing the difference is round-off alone, which the correction here has too
        change_here, inside_here = newton_step(now.layout, now.mesh, now.z, now.bubbles)
        change, inside = change - change_here, inside - inside_here
    return change / little, inside / little


def rates(scene: Scene, now: Solution, *, behind: bool = False) -> Array:
    """Rates of the unknowns ahead, or behind, up to the next of the `corners`."""
    t, sign = now.layout.load_parameter, -1.0 if behind else 1.0
    turned = any(change[2] for motion in scene.prescribed_motions.values() for change in motion.increments)
    apart = [sign * (corner - t) for corner in corners(scene)]
    little = [part / 2.0 for part in apart if part > _CORNER]
    return tangent(scene, now, sign * min([_AHEAD_TURNED if turned else _AHEAD, *little]))[0]


def speed(scene: Scene, now: Solution, rate: Array) -> float:
    """Largest rate of a position per load parameter, in units of `Layout`; rates of slip are measured against it."""
    layout = now.layout
    moved = [k for item in layout.stations for k in item.place.unknown if k != NONE]
    moved += [touch.arc for touch in layout.touches]
    ways = [float(np.hypot(*np.diff(pin.points, axis=0).T).sum()) / layout.length for pin in scene.pins]
    return max([float(np.abs(rate[moved]).max(initial=0.0)), *ways, 1e-300])


def place(solution: Solution, touch: Touch) -> Hold:
    """The place of a contact with friction, at which it may begin to stick."""
    layout, z = solution.layout, solution.z
    before, behind = layout.beside(touch)
    theta = layout.rotation(z, before.last)
    phi = 0.0 if touch.angle == NONE else float(z[touch.angle])
    forces = [z[part.force + n] for part in (before, behind) for n in range(2)]
    given = np.array([theta, *forces, phi, _moment(solution, touch), z[touch.arc]])
    stretch = float(rows(layout, touch, (before, behind), given).values.stretch)
    return Hold(
        load_parameter=layout.load_parameter,
        arc_position=float(z[touch.arc]) * layout.length,
        stretch=stretch,
        shear=phi - theta - before.rod.curvature * float(z[touch.arc]),
        direction=phi,
    )


def slip_rate(solution: Solution, touch: Touch, rate: Array) -> float:
    """Slip rate of a contact with friction from the rates of the unknowns, in units of `Layout`."""
    layout = solution.layout
    before, _ = layout.beside(touch)
    slipping = place(solution, touch).stretch * float(rate[touch.arc])
    if touch.angle == NONE:
        return slipping
    theta, phi = float(rate[layout.stations[before.last].rotation_unknown]), float(rate[touch.angle])
    theta += before.rod.curvature * float(rate[touch.arc])
    lever = float(touch.lever(float(solution.z[touch.arc])))
    return slipping + lever * (phi - theta) + touch.roll * phi


def _moment(solution: Solution, touch: Touch) -> float:
    """Moment before a contact."""
    assert solution.system is not None, "an equilibrium has its equations"
    before, _ = solution.layout.beside(touch)
    e = int(np.flatnonzero(solution.mesh.part == solution.layout.parts.index(before))[-1])
    return float(solution.system.ends[e, 1])

"""The place of a contact with friction, and its slip rate, by the referee's own equilibria."""

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.equations import element_before
from comparisons.referee.grip import Hold, rows
from comparisons.referee.layout import NONE, Touch
from comparisons.referee.newton import Solution
from comparisons.referee.path import corners, tangent

Array = NDArray[np.float64]

_AHEAD, _AHEAD_TURNED = 1e-4, 1e-6
"""Load parameters over which rates are differences. The equations are linear in pins and loads, but not in prescribed rotations."""
_CORNER = 1e-9
"""Distance from a corner, in load parameters, that counts as none."""


def rates(now: Solution, *, behind: bool = False) -> Array:
    """Rates of the unknowns ahead, or behind, up to the next of the `corners`."""
    scene, t, sign = now.layout.scene, now.t, -1.0 if behind else 1.0
    turned = any(change[2] for motion in scene.prescribed_motions.values() for change in motion.increments)
    apart = [sign * (corner - t) for corner in corners(scene)]
    little = [part / 2.0 for part in apart if part > _CORNER]
    return tangent(now, sign * min([_AHEAD_TURNED if turned else _AHEAD, *little]))[0]


def speed(now: Solution, rate: Array) -> float:
    """Largest rate of a position per load parameter, in units of `Layout`; rates of slip are measured against it."""
    layout = now.layout
    ways = [
        float(np.hypot(*np.diff(pin.points, axis=0).T).sum()) / layout.length for pin in layout.scene.pins
    ]
    return max([float(np.abs(rate[layout.moving]).max(initial=0.0)), *ways, 1e-300])


def place(solution: Solution, touch: Touch) -> Hold:
    """The place of a contact with friction, at which it may begin to stick."""
    layout, z = solution.layout, solution.z
    before, _ = layout.beside(touch)
    theta = float(layout.motions(z)[before.last, 2])
    phi = 0.0 if touch.angle == NONE else float(z[touch.angle])
    moment = float(solution.system.ends[element_before(solution.mesh, touch), 1])
    return Hold(
        load_parameter=layout.load_parameter,
        arc_position=float(z[touch.arc]) * layout.length,
        stretch=rows(layout, touch, z, moment).stretch,
        shear=phi - theta - before.rod.curvature * float(z[touch.arc]),
        direction=phi,
    )


def slip_rate(solution: Solution, touch: Touch, rate: Array) -> float:
    """Slip rate of a contact with friction from the rates of the unknowns, in units of the layout."""
    layout = solution.layout
    before, _ = layout.beside(touch)
    slipping = place(solution, touch).stretch * float(rate[touch.arc])
    if touch.angle == NONE:
        return slipping
    theta, phi = float(rate[layout.stations[before.last].unknown[2]]), float(rate[touch.angle])
    theta += before.rod.curvature * float(rate[touch.arc])
    lever = float(touch.lever(float(solution.z[touch.arc])))
    return slipping + lever * (phi - theta) + touch.roll * phi

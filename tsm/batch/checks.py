"""What the stepper asks of a configuration before it accepts it, of many at once."""

from __future__ import annotations

import numpy as np

from tsm.batch.equations import OWN, Equations, System
from tsm.batch.front import Front, newest
from tsm.batch.geometry import project
from tsm.elements.properties import Array
from tsm.events import ROUND_OFF
from tsm.newton import SHARP
from tsm.path import FOLLOWED, LONGEST_STEP

SHORT = 0.1
"""Step, in largest Newton steps, that needs no history to be extrapolated from."""


def norm(equations: Equations, front: Front, system: System) -> Array:
    """Scaled norms of the residuals, as of `Newton`, shape (N,)."""
    force, length, turning = front.numbers.force, front.numbers.length, equations.turning
    forces = np.abs(system.nodal[equations.model.free])
    largest = np.maximum(
        forces[~turning].max(axis=0, initial=0.0) / force,
        forces[turning].max(axis=0, initial=0.0) / (force * length),
    )
    own = np.abs(system.own).reshape(-1, OWN, len(force))
    largest = np.maximum(largest, own[:, :2].max(axis=(0, 1)) / (SHARP * length))
    scaled: Array = np.maximum(largest, own[:, 2].max(axis=0) / force)
    return scaled


def largest_step(equations: Equations, step: Array, length: Array) -> Array:
    """Largest changes of the free displacements, shape (equations, m), in parts of 0.3 L and 0.7 rad."""
    size, turning = np.abs(step), equations.turning
    shift = size[~turning].max(axis=0, initial=0.0) / (0.3 * length)
    largest: Array = np.maximum(shift, size[turning].max(axis=0, initial=0.0) / 0.7)
    return largest


def follows(equations: Equations, front: Front, which: Array) -> Array:
    """Whether equilibria lie near their prediction, on the side of the determinant that the path is on.

    The stepper asks both tangents of a step. Here its extrapolation has to explain it; what it does not is left to the stepper.
    """
    free, history = equations.model.free[:, None], front.history
    last = history.q[newest(history, which), free, which]
    length = front.numbers.length[which]
    moved = largest_step(equations, front.at.q[free, which] - front.predicted[free, which], length)
    taken = largest_step(equations, front.at.q[free, which] - last, length)
    near = ((moved <= FOLLOWED * taken) | (taken <= SHORT)) & (taken <= LONGEST_STEP)
    begun = np.where(front.orientation == 0, front.first, front.orientation)[which]
    kept: Array = near & (begun == front.last[which])
    return kept


def eventless(
    equations: Equations, front: Front, which: Array, normal: Array, arc: Array, tolerance: float
) -> Array:
    """Whether surely no contact opened or closed on the way to equilibria with given contact forces and arc positions.

    A node behind its line past an end of the beam may have come there through the beam, which the stepper looks into.
    """
    at, numbers, length = front.at, front.numbers, front.numbers.length[which]
    soft = np.minimum(1.0, ROUND_OFF / np.maximum(tolerance, numbers.noise[which]))
    inside = np.minimum(arc, numbers.span[:, which] - arc) / length
    push = normal / numbers.force[which] * soft
    kept = ~at.closed[:, which] | ((inside >= -ROUND_OFF) & (push >= -ROUND_OFF))
    for k in range(len(kept)):
        waiting = np.flatnonzero(~at.closed[k, which] & front.armed[k, which])
        if len(waiting):
            seen = project(equations, numbers, at, k, which[waiting])
            small = ROUND_OFF * length[waiting]
            kept[k, waiting] = seen.gap >= -small
    whole: Array = kept.all(axis=0)
    return whole


def balanced(equations: Equations, front: Front, system: System, which: Array, tolerance: float) -> Array:
    """Whether support reactions and pin forces add up to nothing, as in `Stepper`."""
    model, at, numbers = equations.model, front.at, front.numbers
    total = np.zeros((2, len(which)))
    for c in range(2):
        total[c] = system.nodal[model.fixed[model.fixed % 3 == c]][:, which].sum(axis=0)
    largest = np.zeros(len(which))
    for k, pair in enumerate(model.pairs):
        if pair.pin is not None:
            force = np.where(at.closed[k, which], at.force[k][:, which], 0.0)
            total += force
            largest = np.maximum(largest, np.hypot(*force))
    noise = np.maximum(numbers.noise, tolerance) * numbers.force
    bound = 1e-8 * largest + len(model.coordinates) * noise[which]
    whole: Array = np.abs(total).max(axis=0) <= bound
    return whole

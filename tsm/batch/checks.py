"""Conditions on a configuration before it is accepted, for many structures at once; see `tsm.stepping`."""

from __future__ import annotations

import numpy as np

from tsm.batch.equations import BatchLinearisation, Equations
from tsm.batch.geometry import project
from tsm.batch.state import BatchState, newest
from tsm.elements.properties import Array
from tsm.events import ROUND_OFF
from tsm.path import FOLLOWED, LONGEST_STEP
from tsm.scaling import largest

SHORT = 0.1
"""Step over the largest Newton step below which no history is needed for an extrapolation."""


def norm(equations: Equations, batch: BatchState, system: BatchLinearisation) -> Array:
    """Scaled norms of the residuals, see `Newton.norm`, shape (N,)."""
    residual = np.concatenate([system.nodal[equations.model.free], system.contacts])
    return largest(residual, batch.constants.scales.residual)


def follows(equations: Equations, batch: BatchState, which: Array) -> Array:
    """Whether equilibria lie near their prediction and the determinant of the tangent keeps its sign.

    The stepper compares a step with the tangents at both ends. The batch requires an end near the extrapolation and leaves all other
    steps to the stepper.
    """
    free, history = equations.model.free[:, None], batch.history
    last = history.q[newest(history, which), free, which]
    per_step = batch.constants.scales.step[: len(free), which]
    moved = largest(batch.iterate.q[free, which] - batch.predicted[free, which], per_step)
    taken = largest(batch.iterate.q[free, which] - last, per_step)
    near = ((moved <= FOLLOWED * taken) | (taken <= SHORT)) & (taken <= LONGEST_STEP)
    begun = np.where(batch.orientation == 0, batch.first, batch.orientation)[which]
    kept: Array = near & (begun == batch.last[which])
    return kept


def eventless(
    equations: Equations, batch: BatchState, which: Array, normal: Array, arc: Array, tolerance: float
) -> Array:
    """Whether it is certain that no contact opened or closed on the way to equilibria with given contact forces and arc positions.

    A node that is past an end of the beam and behind its extended surface may have gone through the beam. The stepper examines this case.
    """
    iterate, constants, length = batch.iterate, batch.constants, batch.constants.sizes.length[which]
    soft = np.minimum(1.0, ROUND_OFF / np.maximum(tolerance, constants.scales.noise[which]))
    inside = np.minimum(arc, constants.span[:, which] - arc) / length
    push = normal / constants.sizes.force_scale[which] * soft
    kept = ~iterate.closed[:, which] | ((inside >= -ROUND_OFF) & (push >= -ROUND_OFF))
    for k in range(len(kept)):
        waiting = np.flatnonzero(~iterate.closed[k, which] & batch.armed[k, which])
        if len(waiting):
            seen = project(equations, constants, iterate, k, which[waiting])
            small = ROUND_OFF * length[waiting]
            kept[k, waiting] = seen.gap >= -small
    whole: Array = kept.all(axis=0)
    return whole


def balanced(
    equations: Equations, batch: BatchState, system: BatchLinearisation, which: Array, tolerance: float
) -> Array:
    """Whether support reactions and pin forces are in balance, as in `Newton.balanced`."""
    model, iterate, constants = equations.model, batch.iterate, batch.constants
    total = np.zeros((2, len(which)))
    for c in range(2):
        total[c] = system.nodal[model.fixed[model.fixed % 3 == c]][:, which].sum(axis=0)
    largest = np.zeros(len(which))
    for k, pair in enumerate(model.pairs):
        if pair.pin is not None:
            force = np.where(iterate.closed[k, which], iterate.force[k][:, which], 0.0)
            total += force
            largest = np.maximum(largest, np.hypot(*force))
    noise = np.maximum(constants.scales.noise, tolerance) * constants.sizes.force_scale
    bound = 1e-8 * largest + len(model.coordinates) * noise[which]
    whole: Array = np.abs(total).max(axis=0) <= bound
    return whole

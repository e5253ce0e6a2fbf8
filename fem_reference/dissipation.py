"""Rate of slip, and the energy that friction dissipates over a load step."""

from dataclasses import replace

import numpy as np

from fem_reference.friction import force_before_slip, slip_gradient
from fem_reference.state import State, with_conditions
from fem_reference.tangent import Tangent, pin_motion

_INTERVAL = 1e-6
"""Interval of the load parameter over which the motion of a pin is a velocity."""


def slip_rates(tangent: Tangent, pair: int, *, forward: bool) -> tuple[float, float] | None:
    """Rates of slip [m] and of tangential force [N] per load parameter of a closed contact; None if they are singular.

    At a corner of a pin's path, the rates ``forward`` differ from those of the path before.
    """
    state = tangent.state
    before, after = (state.t, state.t + _INTERVAL) if forward else (state.t - _INTERVAL, state.t)
    rate = tangent.rate(before, after)
    if rate is None:
        return None
    touch = state.touches[pair]
    assert touch.friction is not None, "an open contact does not slip"
    motion = touch.slopes.T @ rate.u.ravel() + pin_motion(touch, before, after)
    number = len(state.closed) + state.rubbing.index(touch)
    slip = slip_gradient(touch.pair, touch.projection, touch.friction) @ motion
    return float(slip), float(rate.forces[number])


def with_dissipation(last: Tangent, tangent: Tangent) -> State:
    """Return the state of a tangent with the energies dissipated since the state of the ``last`` one.

    ``integral T d xi`` where slip and tangential force are Hermite polynomials of the load parameter. A contact that slips and opens in
    between dissipates until its force is zero, see `_last_work`.
    """
    state, conditions = tangent.state, list(tangent.state.conditions)
    for pair, touch in enumerate(state.touches):
        before, after = last.state.conditions[pair].friction, touch.condition.friction
        if before is None or after is None:
            continue
        if touch.closed and after.direction:
            energy = _work(last, tangent, pair)
        elif last.state.touches[pair].closed and not touch.closed and before.direction:
            energy = _last_work(last, state.t, pair)
        else:
            continue
        friction = replace(after, dissipated=before.dissipated + energy)
        conditions[pair] = replace(touch.condition, friction=friction)
    return with_conditions(state, tuple(conditions))


def _work(last: Tangent, tangent: Tangent, pair: int) -> float:
    """Work of a contact's tangential force on its slip between two states [J].

    Where the contact did not slip at the last state, the polynomials have degree 2.
    """
    (a, b), span = (at.state.touches[pair] for at in (last, tangent)), tangent.state.t - last.state.t
    before, after = a.condition.friction, b.condition.friction
    assert before is not None, "a contact keeps its friction"
    assert after is not None, "a contact keeps its friction"
    begin = force_before_slip(after, before.force)
    change = np.array([after.slip - before.slip, after.force - begin])
    ends = slip_rates(tangent, pair, forward=False)
    final = change if ends is None else span * np.array(ends)
    slips = a.closed and before.direction == after.direction
    starts = slip_rates(last, pair, forward=True) if slips else None
    initial = 2 * change - final if starts is None else span * np.array(starts)
    points, weights = np.polynomial.legendre.leggauss(3)
    total = 0.0
    for x, w in zip((1 + points) / 2, weights / 2, strict=True):
        slope = 6 * x * (1 - x) * change + (1 - x) * (1 - 3 * x) * initial + x * (3 * x - 2) * final
        value = x * x * (3 - 2 * x) * change + x * (1 - x) ** 2 * initial + x * x * (x - 1) * final
        total += w * (begin + value[1]) * slope[0]
    return float(total)


def _last_work(last: Tangent, t: float, pair: int) -> float:
    """Work of a contact's tangential force on its slip from a state to the opening before ``t`` [J].

    To first order in the step, slip goes on at its rate, and the force falls to zero at its rate: ``-T^2 (d xi/dt) / (2 dT/dt)``.
    """
    friction, rates = last.state.touches[pair].friction, slip_rates(last, pair, forward=True)
    assert friction is not None, "a contact keeps its friction"
    if rates is None or rates[1] * friction.force >= 0.0:
        return 0.0
    slip, fall = rates
    duration = min(-friction.force / fall, t - last.state.t)
    return max(0.0, (friction.force + 0.5 * fall * duration) * slip * duration)

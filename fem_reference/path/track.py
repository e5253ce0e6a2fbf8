"""Accepted states of a path: prediction of the next state, the check that a step stays on its branch, and states between."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import inf, isfinite
from typing import TypeVar

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval

from fem_reference.contact.friction import settled, slip_gradient
from fem_reference.statement.arrays import Floats
from fem_reference.statement.status import Status
from fem_reference.system.newton import augmented, equilibrium
from fem_reference.system.state import State
from fem_reference.system.system import Correction, Tangent, linearise, pin_motion

Item = TypeVar("Item")
LARGEST_DEPARTURE = 1 / 3
"""Largest accepted distance of a step from the tangents at its ends, relative to the step's length."""
_INTERVAL = 1e-6
"""Interval of the load parameter over which the motion of a pin is a velocity."""
_MAX_STEPS = 80
_VANISHED = 1e-9
"""Value at which a search ends, relative to the one at the beginning."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Accepted:
    """An accepted state with its tangent and index."""

    tangent: Tangent  # linearisation at the state
    index: int  # number of negative eigenvalues of the energy's Hessian; -1 if undefined, see `Tangent.index`
    rates: dict[tuple[float, float], Correction] = field(default_factory=dict)  # results of `rate`

    @property
    def state(self) -> State:
        """The state."""
        return self.tangent.state

    @property
    def t(self) -> float:
        """Load parameter."""
        return self.state.t

    def rate(self, before: float, after: float) -> Correction:
        """Change per load parameter with the mean velocity of the pins between two load parameters; nan if singular."""
        if (before, after) not in self.rates:
            nan = Correction(u=self.state.u * np.nan, forces=self.state.forces * np.nan)
            self.rates[before, after] = self.tangent.rate(before, after) or nan
        return self.rates[before, after]

    def slip_rates(self, pair: int, *, forward: bool) -> Floats:
        """Rates of slip [m] and tangential force [N] of a closed contact ``(2,)``, before a corner of a pin's path or ``forward``."""
        state, touch = self.state, self.state.touches[pair]
        before, after = (self.t, self.t + _INTERVAL) if forward else (self.t - _INTERVAL, self.t)
        rate = self.rate(before, after)
        motion = touch.columns.T @ rate.u.ravel() + pin_motion(touch, before, after)
        number = len(state.closed) + state.rubbing.index(touch)
        return np.array([slip_gradient(touch) @ motion, rate.forces[number]])


def accept(state: State, last: Accepted | None = None) -> Accepted | None:
    """Linearise at a state, from which slip then counts; None if its tangent is singular. Energy is dissipated since ``last``."""
    if any(touch.begin for touch in state.touches):
        state = state.touching(tuple(map(settled, state.touches)))
    tangent = linearise(state)
    if tangent is None:
        return None
    index = tangent.index(state.model.settings.tolerance * state.force_scale)
    found = Accepted(tangent=tangent, index=index)
    if last is None or not (state.rubbing or last.state.rubbing):
        return found
    touches = [
        replace(touch, dissipated=touch.dissipated + _dissipated(last, found, pair))
        for pair, touch in enumerate(state.touches)
    ]
    return replace(found, tangent=replace(tangent, state=state.touching(touches)))


def _dissipated(last: Accepted, found: Accepted, pair: int) -> float:
    """Energy ``integral T d xi`` that a contact dissipates between two states by cubic polynomials [J]."""
    before, after, span = last.state.touches[pair], found.state.touches[pair], found.t - last.t
    if before.closed and not after.closed and before.direction:
        # slip goes on at its rate until the force has fallen to zero at its rate
        slip, fall = last.slip_rates(pair, forward=True)
        if not fall * before.tangential < 0:
            return 0.0
        duration = min(-before.tangential / fall, span)
        return max(0.0, float((before.tangential + 0.5 * fall * duration) * slip * duration))
    if not (after.closed and after.direction):
        return 0.0
    # a slip begins at the last force; behind a turn in between, at the present one
    begin = after.tangential if after.direction * before.tangential < 0 else before.tangential
    change = np.array([after.slipped - before.slipped, after.tangential - begin])
    final = span * found.slip_rates(pair, forward=False)
    final = final if np.all(np.isfinite(final)) else change
    slips = before.closed and before.direction == after.direction
    first = span * last.slip_rates(pair, forward=True) if slips else np.array([np.nan])
    first = first if np.all(np.isfinite(first)) else 2 * change - final  # polynomials of degree 2
    path = cubic((0 * change, change), (first, final))
    x, w = np.polynomial.legendre.leggauss(3)
    (_, force), (rate, _) = (polyval((1 + x) / 2, part) for part in (path, polyder(path)))
    return float(w / 2 @ ((begin + force) * rate))


def state_at(last: Accepted, t: float, *, keep_set: bool = False) -> Accepted | None:
    """Equilibrium at ``t`` from the linear extrapolation of a state; None if it does not converge. ``keep_set`` keeps its contact set."""
    if t == last.t:
        return last
    attempt = equilibrium(predict((last,), t), keep_set=keep_set)
    if attempt.status is not Status.CONVERGED:
        return None
    return accept(attempt.state, last if keep_set else None)


def departure(a: Accepted, b: Accepted, floor: float) -> float:
    """Distance of a step from the tangents at its ends, relative to the length of the step.

    With ``d = u_b - u_a`` and the rates v at both ends it is the larger of ``|d - dt v_a| / |d|`` and ``|d - dt v_b| / |d|``.
    If contacts change, the path has a corner, and it is the minimum of ``|d - dt ((1 - tau) v_a + tau v_b)| / |d|`` over tau
    between 0 and 1. Norms are root mean squares over the nodes, and differences below ``floor`` [m] count as zero.
    """
    dt, d = b.t - a.t, b.state.u - a.state.u
    va, vb = (dt * accepted.rate(a.t, b.t).u for accepted in (a, b))
    if a.state.contact_set == b.state.contact_set:
        errors = [_size(d - va), _size(d - vb)]
    else:
        between = vb - va
        tau = np.clip(np.sum((d - va) * between) / max(float(np.sum(between**2)), 1e-300), 0.0, 1.0)
        errors = [_size(d - va - tau * between)]
    worst = float(np.max(errors))  # nan stays nan
    return 0.0 if worst <= floor else worst / max(_size(d), floor)


def _size(u: Floats) -> float:
    return float(np.sqrt(np.mean(u**2)))


def predict(states: tuple[Accepted, ...], t: float) -> State:
    """Extrapolate the last two states to ``t`` by a cubic polynomial; along the tangent if one is given or their contact sets differ."""
    first, last = states[-2:][0], states[-1]
    state, size, h = last.state, last.state.u.size, last.t - first.t
    rate = last.rate(last.t, t)
    found = _unknowns(state) + (t - last.t) * _unknowns(rate)
    if h and first.state.contact_set == state.contact_set:
        slopes = h * _unknowns(first.rate(first.t, last.t)), h * _unknowns(rate)
        path = cubic((_unknowns(first.state), _unknowns(state)), slopes)
        found[:] = polyval((t - first.t) / h, path)
    state = state.moved(found[:size].reshape(-1, 2), t, found[size:])
    return state.touching(tuple(map(augmented, state.touches)))


def _unknowns(of: State | Correction) -> Floats:
    """Displacements and forces in one array."""
    return np.append(of.u, of.forces)


def cubic(values: tuple[Floats, Floats], slopes: tuple[Floats, Floats]) -> Floats:
    """Coefficients ``(4, ...)`` of the cubic polynomial with these values and slopes at 0 and 1."""
    (p, q), (v, w) = values, slopes
    return np.array([p, v, 3 * (q - p) - 2 * v - w, v + w - 2 * (q - p)])


def root(
    evaluate: Callable[[float, Item], tuple[float, Item] | None],
    low: tuple[float, float, Item],
    end: float,
    precision: float = 1e-14,
) -> tuple[float, Item] | None:
    """Place and item where a value that is positive at ``low`` vanishes up to ``end``; None where it stays positive.

    Regula falsi in Illinois' form. ``evaluate`` has a place and the item of the nearest place before. Where nothing converges, it returns
    None, which counts as beyond the root. If the value does not vanish, the last place before is the answer.
    """
    (x, value, item), high, beyond, side = low, end, -inf, 0
    vanished = _VANISHED * value
    for step in range(_MAX_STEPS):
        width = high - x
        if width <= precision:
            break
        share = value / (value - beyond) if isfinite(beyond) else 0.5
        at = end if step == 0 else x + min(max(share, 1e-6), 1 - 1e-6) * width
        found = evaluate(at, item)
        if found is not None and found[0] > 0:
            if step == 0:
                return None
            x, (value, item) = at, found
            beyond, side = beyond / 2 if side > 0 else beyond, 1
        else:
            high, beyond = at, -inf if found is None else found[0]
            value, side = value / 2 if side < 0 else value, -1
        if found is not None and abs(found[0]) <= vanished:
            return at, found[1]
    return x, item


def located(last: Accepted, end: float, margin: Callable[[Accepted], float]) -> Accepted | None:
    """Accepted state with the contact set of ``last`` at which a positive ``margin`` vanishes up to ``end``; None without one."""

    def evaluate(t: float, low: Accepted) -> tuple[float, Accepted] | None:
        at = state_at(low, t, keep_set=True)
        return None if at is None else (margin(at), at)

    value = margin(last)
    found = (last.t, last) if value < 0 else root(evaluate, (last.t, value, last), end)
    return None if found is None else found[1]

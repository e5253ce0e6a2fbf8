"""Accepted states of a path: prediction of the next state, and the check that a step stays on its branch."""

from dataclasses import dataclass, field, replace

import numpy as np

from fem_reference.active_set import equilibrium
from fem_reference.arrays import Array, Floats
from fem_reference.dissipation import with_dissipation
from fem_reference.model import Model
from fem_reference.newton import force_scale
from fem_reference.settings import Settings
from fem_reference.state import State, as_accepted, build_state, with_contact_forces
from fem_reference.status import Status
from fem_reference.tangent import Correction, Tangent, linearise

TRACK_LENGTH = 3
"""Largest number of accepted states in a prediction."""
ORDER = 3
"""Degree of the polynomial in the load parameter that extrapolates accepted states and their rates."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Accepted:
    """An accepted state with its tangent and index."""

    state: State  # the state
    tangent: Tangent  # linearisation at the state
    index: int  # number of negative eigenvalues of the energy's Hessian; -1 if undefined, see `Tangent.index`
    _rates: dict[tuple[float, float], Correction] = field(default_factory=dict, repr=False)

    def rate(self, before: float, after: float) -> Correction:
        """Change per load parameter with the mean velocity of the pins between two load parameters; nan if singular."""
        if (before, after) not in self._rates:
            rate = self.tangent.rate(before, after)
            if rate is None:
                count = self.state.contact_forces.size + self.state.tie_forces.size
                rate = Correction(u=np.full_like(self.state.u, np.nan), forces=np.full(count, np.nan))
            self._rates[before, after] = rate
        return self._rates[before, after]


def accept(model: Model, state: State, settings: Settings, last: Accepted | None = None) -> Accepted | None:
    """Linearise at a state, from which slip then counts; None if its tangent is singular.

    With the ``last`` accepted state, the energy that friction dissipates is accurate to the fourth order of the step.
    """
    state = as_accepted(state)
    tangent = linearise(model, state)
    if tangent is None:
        return None
    if last is not None and (state.rubbing or last.state.rubbing):
        state = with_dissipation(last.tangent, tangent)
        tangent = replace(tangent, state=state)
    force_tolerance = settings.tolerance * force_scale(model, state)
    return Accepted(state=state, tangent=tangent, index=tangent.index(force_tolerance))


def accepted_state(
    model: Model, states: tuple[Accepted, ...], t: float, settings: Settings
) -> Accepted | None:
    """Equilibrium at ``t`` from the linear extrapolation of the last state; None if it does not converge."""
    attempt = equilibrium(model, predict(model, states, t, 1), settings)
    return accept(model, attempt.state, settings) if attempt.status is Status.CONVERGED else None


def departure(a: Accepted, b: Accepted, floor: float) -> float:
    """Distance of a step from the tangents at its ends, relative to the length of the step.

    With ``d = u_b - u_a`` and the rates v at both ends it is the larger of ``|d - dt v_a| / |d|`` and ``|d - dt v_b| / |d|``.
    If the set of closed contacts changes, the path has a corner, and the distance is the minimum of
    ``|d - dt ((1 - tau) v_a + tau v_b)| / |d|`` over tau between 0 and 1. Norms are root mean squares over the nodes.
    Differences below ``floor`` [m] count as zero.
    """
    before, after = sorted((a.state.t, b.state.t))
    dt = b.state.t - a.state.t
    d = b.state.u - a.state.u
    va, vb = (dt * accepted.rate(before, after).u for accepted in (a, b))
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


def predict(model: Model, states: tuple[Accepted, ...], t: float, degree: int) -> State:
    """Extrapolate the last states to ``t`` by Hermite's polynomial, with the contact set of the last state.

    Only states with this contact set are used, so that the degree may be lower than ``degree``.
    """
    last = states[-1]
    same = [
        accepted
        for accepted in states[-TRACK_LENGTH:]
        if accepted.state.contact_set == last.state.contact_set
    ]
    if degree == 0:
        return build_state(model, last.state.u, t, last.state.conditions, last.state.tie_forces)
    nodes, values, rates = [], [], []
    following = [*(accepted.state.t for accepted in same[1:]), t]
    for accepted, after in zip(same, following, strict=True):
        rate = accepted.rate(accepted.state.t, after)
        nodes.append(accepted.state.t)
        at = accepted.state
        values.append(np.concatenate([at.u.ravel(), at.contact_forces, at.tie_forces]))
        rates.append(np.append(rate.u.ravel(), rate.forces))
    extrapolated = hermite(nodes[::-1], values[::-1], rates[::-1], t, degree)
    size, count = last.state.u.size, last.state.contact_forces.size
    u = extrapolated[:size].reshape(-1, 2)
    conditions = with_contact_forces(last.state.conditions, extrapolated[size : size + count])
    augmented = (touch.closed and touch.pair.contact.penetration is not None for touch in last.state.touches)
    conditions = tuple(
        replace(condition, multiplier=condition.force if removed else 0.0)
        for condition, removed in zip(conditions, augmented, strict=True)
    )
    return build_state(model, u, t, conditions, extrapolated[size + count :])


def hermite(nodes: list[float], values: list[Array], rates: list[Array], t: float, degree: int) -> Array:
    """Evaluate Hermite's interpolation polynomial at ``t`` by Newton's form with every node repeated.

    The polynomial takes the first ``degree + 1`` conditions in the order value and rate at the first node, value and rate
    at the second node, and so on.

    >>> hermite([0.0, 1.0], [np.array([0.0]), np.array([1.0])], [np.array([0.0]), np.array([3.0])], 2.0, 3)
    array([8.])
    """
    twice = [node for node in nodes for _ in range(2)][: degree + 1]
    column: list[Array] = [value for value in values for _ in range(2)][: degree + 1]
    total, power = column[0].copy(), 1.0
    for order in range(1, len(twice)):
        column = [
            rates[k // 2]
            if twice[k] == twice[k + order]
            else (column[k + 1] - column[k]) / (twice[k + order] - twice[k])
            for k in range(len(column) - 1)
        ]
        power *= t - twice[order - 1]
        total += power * column[0]
    return total


def root_by_inverse_interpolation(values: list[tuple[float, float]]) -> float:
    """Load parameter at which a quantity vanishes, by inverse interpolation of pairs ``(value, t)``."""
    total = 0.0
    for number, (value, t) in enumerate(values):
        others = [other for k, (other, _) in enumerate(values) if k != number]
        total += t * float(np.prod([other / (other - value) for other in others]))
    return total

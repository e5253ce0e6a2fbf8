"""Accepted states of a path: their tangents, what they predict, and whether a step stays on its branch."""

from dataclasses import dataclass, replace

import numpy as np

from fem_reference.arrays import Array, Floats
from fem_reference.model import Model
from fem_reference.newton import force_scale
from fem_reference.settings import Settings
from fem_reference.state import State, state
from fem_reference.tangent import Correction, Tangent, linearise

KEPT = 3
"""Accepted states that a prediction uses at most."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Accepted:
    """An accepted state.

    Parameters
    ----------
    at
        The state.
    tangent
        Its linearisation.
    index
        Number of negative eigenvalues of the energy's Hessian, -1 where it is not defined.
    """

    at: State
    tangent: Tangent
    index: int

    @property
    def closed(self) -> tuple[bool, ...]:
        """Which contacts act."""
        return tuple(touch.closed for touch in self.at.touches)

    def rate(self, before: float, after: float) -> Correction:
        """Change per load parameter with the pins' mean velocity between two load parameters; nan if undetermined."""
        found = self.tangent.rate(before, after)
        if found is None:
            return Correction(u=np.full_like(self.at.u, np.nan), forces=np.full(len(self.at.closed), np.nan))
        return found


def accept(model: Model, at: State, settings: Settings) -> Accepted | None:
    """Linearise at a state; None if its tangent is singular."""
    tangent = linearise(model, at)
    if tangent is None:
        return None
    weak = settings.tolerance * force_scale(model, at)
    return Accepted(at=at, tangent=tangent, index=tangent.index(weak))


def departure(a: Accepted, b: Accepted, floor: float) -> float:
    """Distance of a step from its tangents, relative to its length.

    With ``d = u_b - u_a`` and the rates v at both ends it is the larger of ``|d - dt v_a| / |d|`` and ``|d - dt v_b| / |d|``.
    Where the set of closed contacts changes on the way, the path has a corner: then the best of
    ``|d - dt ((1 - tau) v_a + tau v_b)| / |d|``, tau between 0 and 1. Norms are root mean squares over the nodes;
    differences below ``floor`` [m] are none.
    """
    before, after = sorted((a.at.t, b.at.t))
    dt = b.at.t - a.at.t
    d = b.at.u - a.at.u
    va, vb = (dt * one.rate(before, after).u for one in (a, b))
    if a.closed == b.closed:
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
    """State at ``t`` by Hermite's polynomial through values and rates of the last states, contacts as in the last.

    The degree is lower where fewer states are known since the last change of the set of closed contacts.
    """
    last = states[-1]
    same = [one for one in states[-KEPT:] if one.closed == last.closed]
    if degree == 0:
        return state(model, last.at.u, t, last.at.conditions)
    nodes, values, rates = [], [], []
    following = [*(one.at.t for one in same[1:]), t]
    for one, after in zip(same, following, strict=True):
        rate = one.rate(one.at.t, after)
        nodes.append(one.at.t)
        values.append(np.append(one.at.u.ravel(), [touch.force for touch in one.at.closed]))
        rates.append(np.append(rate.u.ravel(), rate.forces))
    found = hermite(nodes[::-1], values[::-1], rates[::-1], t, degree)
    u = found[: last.at.u.size].reshape(-1, 2)
    forces = iter(found[last.at.u.size :])
    conditions = []
    for touch in last.at.touches:
        force = float(next(forces)) if touch.closed else 0.0
        kept = touch.closed and touch.pair.contact.penetration is not None
        conditions.append(replace(touch.condition, force=force, multiplier=force if kept else 0.0))
    return state(model, u, t, tuple(conditions))


def hermite(nodes: list[float], values: list[Array], rates: list[Array], t: float, degree: int) -> Array:
    """Value at ``t`` of the polynomial with the values and rates at the nodes, the first ``degree + 1`` of them in turn.

    Newton's form with every node twice.

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


def vanishing(values: list[tuple[float, float]]) -> float:
    """Load parameter at which a value vanishes, by inverse interpolation of ``(value, t)``."""
    total = 0.0
    for number, (value, t) in enumerate(values):
        others = [other for k, (other, _) in enumerate(values) if k != number]
        total += t * float(np.prod([other / (other - value) for other in others]))
    return total

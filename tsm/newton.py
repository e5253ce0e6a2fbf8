"""Equilibrium at one load parameter. Never raises: what was reached comes back with a status."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tsm.contact import chord_owner, slide
from tsm.elements.properties import Array
from tsm.model import Model
from tsm.state import State, Touch
from tsm.status import Status
from tsm.system import Assembler, Linearisation

_ROUND_OFF = 4 * float(np.finfo(float).eps)
_SHARP = 1e-3
"""Positions are held this much sharper than forces: they cost nothing, and a stiff contact needs them."""
_CRITICAL = 1e-6
"""A contact so stiff that round-off leaves a larger residual than this has no equilibrium: the critical area."""


@dataclass(frozen=True, kw_only=True)
class Equilibrium:
    """A configuration, how far from equilibrium it is, and what it took.

    Attributes
    ----------
    state : State
        Configuration.
    status : Status
        CONVERGED or the reason why not.
    iterations : int
        Linear systems solved.
    residuals : tuple of float
        Scaled norm before the first and after every iteration.
    system : Linearisation
        Residual and tangent at the configuration.
    """

    state: State
    status: Status
    iterations: int
    residuals: tuple[float, ...]
    system: Linearisation


class Newton:
    """Newton's method on forces, contact positions and directions together.

    The norm is the largest entry of the residual, forces over ``EI/L^2``, moments over ``EI/L``, positions over
    L/1000, with L the longest beam: a scale that cannot vanish. Converged is what lies below `tolerance`, or twice in a row
    below the residual's round-off, ``4 eps (EA L/l0 + EI/l0^2)`` and ``4 eps k_c L`` for a contact of stiffness k_c.
    """

    def __init__(self, model: Model, *, tolerance: float, max_iterations: int) -> None:
        self.model = model
        self.assembler = Assembler(model)
        self.max_iterations = max_iterations
        p = model.properties
        noise = _ROUND_OFF * (p.EA * model.length / p.l0 + p.EI / p.l0**2).max() / model.force_scale
        self.tolerance = tolerance
        blur = _ROUND_OFF * np.abs(model.coordinates).max() / (_SHARP * model.length)
        self.noise = float(max(noise, blur if model.contact_unknowns else 0.0))
        force, length = model.force_scale, model.length
        scale = np.array([1 / force, 1 / force, 1 / (force * length)])
        own = np.array([1 / (_SHARP * length), 1 / (_SHARP * length), 1 / force])
        self.scale = np.concatenate([scale[model.free % 3], np.tile(own, model.contact_unknowns // 3)])
        limit = np.array([0.3 * length, 0.3 * length, 0.7])
        self.per_limit = 1 / limit[model.free % 3]

    def norm(self, system: Linearisation) -> float:
        """Scaled norm of a residual."""
        return float(np.abs(system.residual * self.scale).max())

    def solve(self, start: State, load: Array | None = None) -> Equilibrium:
        """Iterate from a start to equilibrium at the start's load parameter, under nodal forces if given."""
        state = start
        residuals: list[float] = []
        owners: list[tuple[int, ...]] = []
        for iteration in range(self.max_iterations + 1):
            system = self.assembler.linearise(state, load)
            residuals.append(self.norm(system))
            status = None
            owners.append(tuple(touch.element for touch in state.touches if touch is not None))
            if not np.isfinite(residuals[-1]):
                status = Status.NOT_FINITE
            elif self.converged(residuals, system):
                status = Status.TWO_CONTACTS if system.crowded else Status.CONVERGED
            elif iteration == self.max_iterations:
                status = Status.PING_PONG if _alternates(owners) else Status.ITERATION_LIMIT
            step = self.assembler.solve(system) if status is None else None
            if step is None:
                return Equilibrium(
                    state=state,
                    status=status or Status.SINGULAR_TANGENT,
                    iterations=iteration,
                    residuals=tuple(residuals),
                    system=system,
                )
            state = self.update(state, step[:, 0])
        raise AssertionError("the last iteration returns")

    def converged(self, residuals: list[float], system: Linearisation) -> bool:
        """Whether the last residual is small enough, or the last two are round-off."""
        noise = max(self.noise, min(system.noise / self.model.force_scale, _CRITICAL))
        return residuals[-1] <= self.tolerance or (len(residuals) > 1 and max(residuals[-2:]) <= noise)

    def prescribed(self, state: State, t: float) -> State:
        """State at a load parameter, its supports where they are prescribed."""
        if not self.model.fixed_values.any():
            return replace(state, load_parameter=t)
        q = state.q.copy()
        q[self.model.fixed] = t * self.model.fixed_values
        return replace(state, load_parameter=t, q=q)

    def update(self, state: State, step: Array) -> State:
        """State after a step, shortened so that no node and no contact moves too far at once."""
        model = self.model
        dq, dz = step[: model.equations], step[model.equations :]
        largest = float(np.abs(dq * self.per_limit).max(initial=0.0))
        if len(dz):
            largest = max(largest, float(np.abs(dz[2::3]).max()) / (0.3 * model.length))
        factor = 1 / largest if largest > 1 else 1.0
        q = state.q.copy()
        q[model.free] += factor * dq
        moved = State(load_parameter=state.load_parameter, q=q, touches=state.touches, armed=state.armed)
        if not state.touches or not np.isfinite(largest):
            return moved
        own = (factor * dz).tolist()
        return replace(
            moved,
            touches=tuple(
                self._moved(k, moved, touch, own) if touch is not None else None
                for k, touch in enumerate(state.touches)
            ),
        )

    def _moved(self, k: int, state: State, touch: Touch, dz: list[float]) -> Touch:
        pair = self.model.pairs[k]
        if pair.slot < 0:
            return chord_owner(self.model, pair, state, touch)
        dFx, dFy, ds = dz[pair.slot : pair.slot + 3]
        element, xi = slide(pair.target, touch.element, touch.xi + ds / self.model.element[touch.element].l0)
        return Touch(element=element, xi=xi, force=(touch.force[0] + dFx, touch.force[1] + dFy))


def _alternates(owners: list[tuple[int, ...]]) -> bool:
    """Whether the owners of the contacts went to and fro over the last six iterations."""
    last = owners[-6:]
    return len(last) == 6 and last[0] != last[1] and all(a == b for a, b in zip(last, last[2:], strict=False))

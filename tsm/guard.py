"""How far the tangent of the path can be trusted, where loads or supports drive the structure.

Newton's method finds some equilibrium; near a buckling load or a limit point it may be one of another branch. A step that keeps
to its branch stays close to the tangent: its prediction is short, and the equilibrium is near the prediction. A node that is driven
through its contact needs no guard: its force and position are unknowns that the extrapolation follows.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tsm.elements import beam
from tsm.elements.properties import Array
from tsm.newton import Newton
from tsm.state import State

SHORT = 0.1
"""Longest prediction, in largest Newton steps (0.3 L, 0.7 rad)."""
FORCE = 0.1
"""Largest predicted change of an internal force, in parts of ``EI/L^2 + max |N|``."""


class PathGuard:
    """Tangent at a configuration.

    Parameters
    ----------
    newton : Newton
        Its assembler gives the tangent.
    state : State
        In equilibrium.
    """

    def __init__(self, newton: Newton, state: State) -> None:
        self.newton = newton
        self.state = state
        assembler, model = newton.assembler, newton.model
        system = assembler.linearise(state)
        solved = assembler.solve(system, -assembler.rate(state))
        rates = None if solved is None else solved.x[:, 1]
        self.rates: Array | None = rates if rates is not None and np.isfinite(rates).all() else None
        self.system = system
        q = assembler.prescribed_rate()
        if self.rates is not None:
            q[model.free] = self.rates[: model.equations]
        self.q_rate = q
        own = np.zeros(model.contact_unknowns)
        if self.rates is not None:
            own = self.rates[model.equations :]
        at = self._internal_force(state, 1e-60j * q, 1e-60j * own)
        self.force, self.force_rate = at.real, at.imag / 1e-60
        self.force_scale = FORCE * (model.force_scale + np.abs(self.force).max())

    @property
    def speed(self) -> float:
        """Largest rate of a displacement or rotation, in largest Newton steps; infinite at a limit point."""
        if self.rates is None:
            return float("inf")
        moving = self.q_rate[self.newton.model.free] * self.newton.per_limit
        return float(np.abs(moving).max(initial=0.0))

    def reach(self, longest: float) -> float:
        """Longest step of the load parameter that the tangent is trusted for."""
        if self.rates is None:
            return longest
        fastest = max(self.speed / SHORT, np.abs(self.force_rate).max() / self.force_scale)
        return longest if fastest * longest <= 1 else float(1 / fastest)

    def predicted(self, t: float) -> State:
        """State at a load parameter along the tangent."""
        moved = self.newton.prescribed(self.state, t)
        if self.rates is None:
            return moved
        length = t - self.state.load_parameter
        return self.newton.update(moved, length * self.rates, self.system, along=length)

    def keeps(self, found: State) -> bool:
        """Whether an equilibrium is near its prediction, in displacements and in internal forces."""
        model = self.newton.model
        step = found.load_parameter - self.state.load_parameter
        miss = (found.q - self.state.q - step * self.q_rate)[model.free] * self.newton.per_limit
        force = self._internal_force(found) - self.force - step * self.force_rate
        return bool(np.abs(miss).max(initial=0.0) <= SHORT / 2 and np.abs(force).max() <= self.force_scale)

    def _internal_force(self, state: State, dq: Any = 0.0, own: Array | None = None) -> Array:
        """Axial forces along chords, and mean forces (x, y) of the exact elements, which no passing contact makes jump.

        Parameters
        ----------
        state : State
            Where.
        dq, own : ndarray, optional
            Added to displacements and contact unknowns.
        """
        model = self.newton.model
        q = state.q + dq
        own = np.zeros(model.contact_unknowns) if own is None else own
        force: Array = q[model.exact_dofs[3:5]]
        for pair, touch in zip(model.pairs, state.touches, strict=True):
            if touch is not None and pair.cuts:
                x, y, arc, _ = own[pair.slots]
                behind = 1 - touch.xi - arc / model.element[touch.element].l0
                force[0, model.place[touch.element]] -= behind * (touch.force[0] + x)
                force[1, model.place[touch.element]] -= behind * (touch.force[1] + y)
        if model.coefficients is None:
            return force.ravel()
        axial = beam.axial_force(model.coefficients, q[model.dofs[:, model.closed]])
        return np.concatenate([axial, force.ravel()])

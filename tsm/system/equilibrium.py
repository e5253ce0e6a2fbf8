"""An equilibrium, and what it has besides: its index, its rates."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple, cast

import numpy as np

from tsm.elements.properties import Array
from tsm.model.contact import closed
from tsm.model.model import Model
from tsm.model.state import State
from tsm.statement.status import Status
from tsm.system.stability import index
from tsm.system.system import Drive, Linearisation

Newton = Any
"""`tsm.system.newton.Newton`, which imports this module."""
RESOLVED = 1e-8
"""Smaller motions, in largest Newton steps, are round-off, as of a column that stays straight: it moves along itself only."""


class Rates(NamedTuple):
    """Derivatives in the load parameter."""

    unknowns: Array  # of the equations and the contacts' unknowns
    dofs: Array  # of all degrees of freedom
    contacts: Array  # of the contacts' unknowns
    motion: Array  # of the motion, see `Newton.motion`


@dataclass(kw_only=True, eq=False)
class Equilibrium:
    """A configuration with its residual, and the iterations that led to it; what follows from it is computed once."""

    newton: Newton
    state: State
    status: Status  # CONVERGED or the reason why not
    iterations: int  # linear systems solved
    residuals: tuple[float, ...]  # scaled norm before the first and after every iteration
    system: Linearisation  # residual and tangent at the configuration
    # residual and tangent a small Newton step away, and the rates of the unknowns there; None if that step was large
    nearby: tuple[Linearisation, Array] | None = None
    behind: float = 0.0  # part of the step to here that the tangent at its start does not explain
    margins: dict[Drive, list[Any]] = field(default_factory=dict, init=False)  # see `tsm.path.margins`
    _rates: dict[Drive, Rates | None] = field(default_factory=dict, init=False)

    @property
    def model(self) -> Model:
        """Model of the structure."""
        return cast(Model, self.newton.model)

    @property
    def t(self) -> float:
        """Load parameter."""
        return self.state.load_parameter

    @property
    def converged(self) -> bool:
        """Whether the configuration is in equilibrium."""
        return self.status is Status.CONVERGED

    def with_state(self, state: State) -> Equilibrium:
        """The same with other contacts, in equilibrium too."""
        return replace(self, state=state, system=self.newton.assembler.linearise(state), nearby=None)

    def sharpened(self) -> Equilibrium:
        """The same with its own tangent."""
        return replace(self, nearby=None) if self.nearby else self

    @cached_property
    def index(self) -> int:
        """Number of the energy's negative eigenvalues, -1 where it is not defined, see `tsm.system.stability`."""
        with np.errstate(all="ignore"):  # a singular tangent has infinite entries
            return index(self.newton.assembler, self.linear)

    @cached_property
    def on_chords(self) -> bool:
        """Whether a closed contact has a stiffness that grows without bound at the beam nodes: round-off spoils its tangent."""
        return any(pair.slot < 0 for _, pair, _ in closed(self.model, self.state))

    @property
    def linear(self) -> Linearisation:
        """System with the tangent that serves for index and rates."""
        return self.nearby[0] if self.nearby else self.system

    def rates(self, drive: Drive) -> Rates | None:
        """Rates while the pins go straight and the loads grow as the drive says; None where the tangent is singular."""
        if drive not in self._rates:
            self._rates[drive] = self._solved(drive)
        return self._rates[drive]

    def _solved(self, drive: Drive) -> Rates | None:
        assembler, model = self.newton.assembler, self.model
        if self.nearby and drive == assembler.steady:
            rates = self.nearby[1]
        else:
            solved = assembler.solve(self.linear, -assembler.rate(self.linear, drive))
            if solved is None:
                return None
            rates = solved[:, 1]
        if not np.isfinite(rates).all():
            return None
        dofs = assembler.prescribed_rate(drive.stage)
        dofs[model.free], contacts = rates[: model.equations], rates[model.equations :]
        motion, rods = dofs[model.free], model.rods
        if rods:
            tangent = self.linear.tangent.groups[rods.number]
            motion = np.concatenate([motion, rods.inside(tangent, dofs, contacts).ravel()])
        return Rates(rates, dofs, contacts, motion)

    def _rates_to(self, t: float) -> Rates | None:
        return self.rates(self.newton.assembler.drive(self.t, t))

    @cached_property
    def speed(self) -> float:
        """Size of the motion per whole load, no less than what round-off may be; infinite at a limit point."""
        rates = self._rates_to(self.t)
        return math.inf if rates is None else max(self.newton.size(rates.motion), RESOLVED)

    def release(self) -> None:
        """Let go of the assembled tangent and the rates, which every accepted configuration would hold otherwise; its speed stays known."""
        _ = self.speed
        self._rates.clear()
        self.nearby = None
        self.system.__dict__.pop("tangent", None)

    def axis_line(self, beam: str, points_per_element: int | None = None) -> tuple[Array, Array]:
        """Distances (m,) along the undeformed axis of a beam, and deformed positions (m, 2), see `Result.axis_line`."""
        place = self.model.beams[beam]
        group = self.model.group_of(place)
        xi = np.linspace(0, 1, (points_per_element or group.intervals(place.beam.elements)) + 1)
        axes = group.axes(place, self.state, self.system.groups[group.number], xi)
        arcs = np.array(place.arcs[:-1])[:, None] + xi * np.array(place.lengths)[:, None]
        return np.append(arcs[:, :-1], place.beam.length), np.concatenate([*axes[:, :-1], axes[-1, -1:]])

    def slope(self, t: float) -> Array | None:
        """Rates towards a load parameter of what `_values` holds."""
        rates = self._rates_to(t)
        return rates and np.concatenate([rates.dofs, rates.contacts, rates.motion[self.model.equations :]])

    def predicted(self, t: float) -> State:
        """State at a load parameter along the tangent."""
        rates = self._rates_to(t)
        if rates is None:
            return cast(State, self.newton.prescribed(self.state, t))
        return cast(State, self.newton.update(self.state, (t - self.t) * rates.unknowns, self.linear, t=t))

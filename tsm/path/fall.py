"""Falls: the motion of a structure from a lost contact, or from a critical point, to the equilibrium where it rests.

There may be no equilibrium nearby. The structure therefore moves against a viscous drag, in steps that each
lower its potential and may be as short as necessary. Beams and pins that the structure meets on the way
become contacts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tsm.contact.contact_set import opened
from tsm.contact.events import ROUND_OFF, EventKind, normal_force, over
from tsm.elements.properties import Array
from tsm.model.model import Model
from tsm.model.state import State
from tsm.path.critical import mode_shape
from tsm.path.friction import grips, least_push
from tsm.path.margins import Margin
from tsm.path.step import Step
from tsm.statement.status import Status, StopError
from tsm.system.equilibrium import Equilibrium
from tsm.system.newton import Newton
from tsm.system.system import Drag

_LAST_PART = 1e-2
"""Accuracy of a touch within a fall, as a part of the lost force. It may be low, because the path of a fall has no physical meaning."""
_FIRST_PACE = 1e-1
"""First time step of a fall, in the units of `_resistance`."""
_LEVEL = 1e-9
"""Largest rise of the energy that counts as round-off, over the energy and over ``EI/L``."""
_PUSH = 0.006
"""Displacement along the mode of a critical point at which a fall starts, over the longest beam."""
_TRIALS = 200
"""Largest number of steps of a fall, with refused ones; a structure without supports and contacts never comes to rest."""
_FAR = 1.0
"""Largest distance of an equilibrium to which a structure goes without a fall, over the largest Newton step."""


@dataclass(kw_only=True)
class Fall:
    """Falls of a structure."""

    newton: Newton
    measure: Callable[[Equilibrium], list[Margin]]  # margins at a point
    log: Step  # where iterations, touches and releases are noted

    def beside(self, critical: Equilibrium, ahead: float) -> tuple[Equilibrium, float]:
        """Return the point of least potential beside a critical one, and the potential that the fall there releases.

        The structure is pushed along its mode, one way and the other. Of two points with the same potential
        it is the one on the mode's positive side, see `mode_shape`. Raises StopError with FALLING if the structure
        finds no rest, with REST_UNKNOWN if it falls onto contacts with friction.
        """
        newton, shape = self.newton, mode_shape(critical)
        if shape is None:
            raise StopError(Status.FALLING)
        held, push = newton.prescribed(critical.state, ahead), _PUSH * newton.model.length * shape[0]
        rests = []
        for way in (1.0, -1.0):
            start = newton.update(held, way * push, critical.system)
            rest = self.rest(start, newton.potential(start))
            if rest is not None and rest.index <= 0:
                rests.append(rest)
        if not rests:
            raise StopError(Status.FALLING)
        if any(grips(rest.state) for rest in rests):
            raise StopError(Status.REST_UNKNOWN)
        least = min(newton.potential(rest.state) for rest in rests)
        return next(r for r in rests if self._descends(least, r.state)), newton.potential(held) - least

    def after(self, event: Equilibrium, state: State) -> tuple[Equilibrium, float]:
        """Return the point after a slip-off, and the released potential; contacts whose force would become tensile are released.

        ``state``: the configuration of the slip-off without the lost contact. Raises StopError with FALLING if
        the structure finds no rest, with LOST_CONTACT if a contact opens that must persist.
        """
        model = self.newton.model
        energy = began = self.newton.potential(event.state)
        while True:
            point = self._next(state, energy)
            if point is None:
                raise StopError(Status.FALLING)
            state, energy = point.state, self.newton.potential(point.state)
            closed = (k for k, touch in enumerate(state.touches) if touch is not None)
            pushes = ((normal_force(point, k) / least_push(point, k), k) for k in closed)
            least, k = min(pushes, default=(0.0, -1))
            if least >= -1.0:
                return point, began - energy
            self.log.note(EventKind.RELEASE, event, state, k)
            state = opened(model, state, k, EventKind.RELEASE, alone=True)

    def _next(self, state: State, energy: float) -> Equilibrium | None:
        """Equilibrium near the state, of a potential of at most `energy`, or at the end of a fall."""
        point = self.newton.solve(state)
        self.log.iterations += point.iterations
        near = point.converged and self.newton.apart(state, point.state) <= _FAR
        if near and self._descends(energy, point.state) and not met(self.measure(point)):
            return point
        return self.rest(state, energy)

    def rest(self, state: State, energy: float) -> Equilibrium | None:
        """Find the point that the structure reaches against a drag which is reduced from step to step; None if there is none.

        ``state``: configuration at the start of the fall, without the lost contact and therefore out of
        equilibrium. ``energy``: potential of this configuration with the lost contact.
        """
        newton, model, pace = self.newton, self.newton.model, _FIRST_PACE
        before, resistance = _before(model, state), _resistance(model)
        for _ in range(_TRIALS):
            at_rest = pace > _FIRST_PACE * 1e8
            drag = None if at_rest else Drag(resistance / pace, state.q)
            point = newton.solve(state, drag=drag)
            self.log.iterations += point.iterations
            taken = 0.0 if drag is None else float(drag.per_way @ (point.state.q - state.q) ** 2) / 2
            down = point.converged and self._descends(energy - taken, point.state)
            margins = self.measure(point) if down else []
            landed = met(margins)
            if down and not landed:
                if at_rest:
                    return point
                state, pace, energy = point.state, 10 * pace, newton.potential(point.state)
                before = {m.pair for m in margins if m.kind is EventKind.TOUCH and m.value < 1.0}
            elif landed and newton.apart(state, point.state) < _LAST_PART:
                for margin in landed:
                    touch = margin._replace(value=0.0) if margin.pair in before else margin
                    state = self.log.applied(point, state, touch)
            else:
                pace /= 4
        return None

    def _descends(self, energy: float, after: State) -> bool:
        """Whether the potential of an equilibrium is at most `energy`. A time step that is too long may end on another with more."""
        scale = self.newton.model.force_scale * self.newton.model.length
        return self.newton.potential(after) <= energy + _LEVEL * (scale + abs(energy))


def _before(model: Model, state: State) -> set[int]:
    """Open pairs whose node lies on the stated side of the beam or on the surface, and which must touch before they pass it."""
    open_ones = [k for k, touch in enumerate(state.touches) if touch is None and state.armed[k]]
    seen = {k: model.project(model.pairs[k], state) for k in open_ones}
    return {k for k, place in seen.items() if over(model, place) and place.gap >= -ROUND_OFF * model.length}


def met(margins: list[Margin]) -> list[Margin]:
    """Open pairs whose gap has closed."""
    return [m for m in margins if m.kind is EventKind.TOUCH and m.value < -ROUND_OFF]


def _resistance(model: Model) -> Array:
    """Drag of the nodes, proportional to the lengths of their elements. In the unit of time a beam falls by L under ``EI/L^2``."""
    l0 = model.properties.l0
    share = np.bincount(model.element_nodes.ravel(), np.repeat(l0 / 2, 2), len(model.coordinates))
    per_way = np.zeros(model.dof_count)
    unit = model.force_scale * np.array([1 / model.length, 1 / model.length, model.length])
    per_way[: 3 * len(share)] = (share[:, None] / model.length * unit).ravel()
    np.add.at(per_way, model.masters, per_way[model.slaves])
    per_way[model.slaves] = 0.0
    return per_way

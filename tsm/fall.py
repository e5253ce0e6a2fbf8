"""Falls: the motion of a structure from a lost contact to the equilibrium where it rests.

Without the lost contact there may be no equilibrium nearby. The structure therefore moves against a viscous drag, in steps that each
lower its potential and may be as short as necessary. Beams and pins that the structure meets on the way become contacts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from tsm.critical import mode_shape
from tsm.elements.properties import Array
from tsm.events import ROUND_OFF, EventKind, Margin
from tsm.friction import grips
from tsm.model import Model
from tsm.newton import Equilibrium, Newton
from tsm.path import PathTangent
from tsm.state import State
from tsm.status import Status
from tsm.system import Drag, Linearisation

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


@dataclass(kw_only=True)
class Fall:
    """One fall."""

    newton: Newton  # solver of the structure
    measure: Callable[[Equilibrium], list[Margin]]  # margins of an equilibrium
    close: Callable[[State, Margin], State]  # state with an open pair closed
    iterations: int = 0  # Newton iterations spent

    def beside(self, critical: Equilibrium, ahead: float) -> tuple[Equilibrium, float] | Status:
        """Return the equilibrium of least potential beside a critical point, and the potential that the fall there releases.

        Of two with the same potential it is the one on the mode's positive side, see `mode_shape`.

        ``critical``: equilibrium at the point; the structure is pushed along its mode, one way and the other.
        Returns FALLING if the structure finds no rest, REST_UNKNOWN if it falls onto contacts with friction.
        """
        mode = mode_shape(self.newton, critical)
        if mode is None:
            return Status.FALLING
        held = self.newton.prescribed(critical.state, ahead)
        push = mode[0] * (_PUSH * self.newton.model.length)
        rests = [
            (self.newton.potential(rest.state), rest)
            for rest in self.rests_beside(held, push, critical.system)
        ]
        if not rests:
            return Status.FALLING
        if any(grips(rest.state) for _, rest in rests):
            return Status.REST_UNKNOWN
        least = min(energy for energy, _ in rests)
        rest = next(rest for _, rest in rests if descends(self.newton, least, rest.state))
        return rest, self.newton.potential(held) - least

    def rests_beside(self, state: State, push: Array, system: Linearisation) -> Iterator[Equilibrium]:
        """Yield the stable equilibria at which falls end that begin at a state pushed one way and the other."""
        for way in (1.0, -1.0):
            start = self.newton.update(state, way * push, system)
            rest = self.rest(start, self.newton.potential(start))
            if rest is not None and PathTangent(self.newton, rest).index <= 0:
                yield rest

    def rest(self, state: State, energy: float) -> Equilibrium | None:
        """Find the equilibrium that the structure reaches against a drag which is reduced from step to step.

        ``state``: configuration at the start of the fall, without the lost contact and therefore out of
        equilibrium. ``energy``: potential of this configuration with the lost contact. Returns the
        equilibrium at
        rest; None if the structure finds none.
        """
        pace, over = _FIRST_PACE, _before(self.newton.model, state)
        resistance = _resistance(self.newton.model)
        for _ in range(_TRIALS):
            at_rest = pace > _FIRST_PACE * 1e8
            drag = None if at_rest else Drag(resistance / pace, state.q)
            equilibrium = self.newton.solve(state, drag=drag)
            self.iterations += equilibrium.iterations
            moved = equilibrium.state.q - state.q
            taken = 0.0 if drag is None else float(drag.per_way @ moved**2) / 2
            down = equilibrium.status is Status.CONVERGED and descends(
                self.newton, energy - taken, equilibrium.state
            )
            margins = self.measure(equilibrium) if down else []
            landed = met(margins)
            if down and not landed:
                if at_rest:
                    return equilibrium
                state, pace, energy = equilibrium.state, 10 * pace, self.newton.potential(equilibrium.state)
                over = {m.pair for m in margins if m.kind is EventKind.TOUCH and m.value < 1.0}
            elif landed and self.newton.apart(state, equilibrium.state) < _LAST_PART:
                for margin in landed:
                    state = self.close(state, replace(margin, value=0.0) if margin.pair in over else margin)
            else:
                pace /= 4
        return None


def descends(newton: Newton, energy: float, after: State) -> bool:
    """Whether the potential of an equilibrium is at most `energy`. A time step that is too long may end on another equilibrium with more."""
    scale = newton.model.force_scale * newton.model.length
    return newton.potential(after) <= energy + _LEVEL * (scale + abs(energy))


def _before(model: Model, state: State) -> set[int]:
    """Open pairs whose node lies on the stated side of the beam or on the surface, and which must touch before they pass it."""
    small = ROUND_OFF * model.length
    beside = set()
    for k, (pair, touch, armed) in enumerate(zip(model.pairs, state.touches, state.armed, strict=True)):
        if touch is None and armed:
            seen = pair.group.project(pair, state)
            if seen.overshoot <= small and seen.gap >= -small:
                beside.add(k)
    return beside


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

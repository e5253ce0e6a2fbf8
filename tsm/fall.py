"""Falls: where a structure comes to rest when a contact that held it slips off.

Without the lost contact there may be no equilibrium nearby. The structure therefore moves against a drag, and its potential decreases in steps
that may be as short as necessary. Beams and pins that it meets on the way become contacts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from tsm.elements.properties import Array
from tsm.events import ROUND_OFF, EventKind, Margin
from tsm.model import Model
from tsm.newton import Equilibrium, Newton
from tsm.state import State
from tsm.status import Status
from tsm.system import Drag

_LAST_PART = 1e-2
"""A touch within a fall is located to this part of the lost force; the path of a fall is not the load's."""
_FIRST_PACE = 1e-1
"""Time of the first step of a fall."""
_LEVEL = 1e-9
"""Rise of the energy, in parts of itself and of ``EI/L``, that round-off may leave."""
_TRIALS = 200
"""Steps of a fall at most, refused ones included: a structure that nothing holds never comes to rest."""


@dataclass(kw_only=True)
class Fall:
    """One fall.

    Attributes
    ----------
    newton : Newton
        Solver of the structure.
    measure : callable
        Margins of an equilibrium.
    close : callable
        State with an open pair closed.
    iterations : int
        Newton iterations spent.
    """

    newton: Newton
    measure: Callable[[Equilibrium], list[Margin]]
    close: Callable[[State, Margin], State]
    iterations: int = 0

    def rest(self, state: State, energy: float) -> Equilibrium | None:
        """Find where the structure comes to rest when it moves against a dwindling drag.

        Parameters
        ----------
        state : State
            From where it falls, without what held it: its forces are in no equilibrium any more.
        energy : float
            Potential of that configuration while it was held.

        Returns
        -------
        Equilibrium or None
            None if nothing holds it.
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
    """Whether an equilibrium has no more potential than `energy`; too long a step against little drag ends on another equilibrium."""
    scale = newton.model.force_scale * newton.model.length
    return newton.potential(after) <= energy + _LEVEL * (scale + abs(energy))


def _before(model: Model, state: State) -> set[int]:
    """Open pairs whose node lies on its side of the beam, or on the surface: it cannot come to lie behind without a contact."""
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
    """Drag of the nodes, in proportion to the lengths of their elements; per time that is counted in beams falling under ``EI/L^2``."""
    l0 = model.properties.l0
    share = np.bincount(model.element_nodes.ravel(), np.repeat(l0 / 2, 2), len(model.coordinates))
    per_way = np.zeros(model.dof_count)
    unit = model.force_scale * np.array([1 / model.length, 1 / model.length, model.length])
    per_way[: 3 * len(share)] = (share[:, None] / model.length * unit).ravel()
    return per_way

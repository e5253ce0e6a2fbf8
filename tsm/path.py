"""The tangent of the equilibrium path, and whether a step kept to the path.

Newton's method finds some equilibrium; after a long step it may belong to another branch. A step from A to B has followed the path if the
tangents at both its ends explain it: with the displacements q, their rates q' and the step h of the load parameter::

    |q_B - q_A - h q'_A| <= c |q_B - q_A|,    |q_B - q_A - h q'_B| <= c |q_B - q_A|

The tangent at A does not lead to an equilibrium of another branch, nor does the tangent there lead back to A. The decision therefore depends on
the path, and not on the prescribed load parameters.
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from tsm.elements.properties import Array
from tsm.newton import Equilibrium, Newton
from tsm.stability import index
from tsm.state import State
from tsm.system import Drive

FOLLOWED = 0.35
"""The bound c. A limit point is approached by a factor of (1 + 2 c)^2 = 2.9 a step."""
LONGEST_STEP = 1.0
"""Longest step whatever its tangents are, in largest Newton steps (0.3 L, 0.7 rad)."""
_RESOLVED = 1e-9
"""Shorter steps, in the same measure, are round-off."""


class PathTangent:
    """Tangent of the path at an equilibrium.

    Parameters
    ----------
    newton : Newton
        Its assembler gives the tangent.
    equilibrium : Equilibrium
        The point of the path.
    """

    def __init__(self, newton: Newton, equilibrium: Equilibrium) -> None:
        self.newton, self.state, self.system = newton, equilibrium.state, equilibrium.system
        self._known: dict[Drive, Array | None] = {}

    @cached_property
    def index(self) -> int:
        """Number of the energy's negative eigenvalues, -1 where it is not defined, see `tsm.stability`."""
        _ = self.system.tangent  # which the rates need besides, and the index is cheaper with
        return index(self.newton.assembler, self.state, self.system)

    def rates(self, begin: float, end: float) -> Array | None:
        """Rates of the unknowns while the pins go straight from where they are at one load parameter to where they are at another.

        Returns
        -------
        ndarray, shape (equations + contact unknowns,) or None
            Derivatives in the load parameter; None where the tangent is singular.
        """
        assembler = self.newton.assembler
        drive = assembler.drive(begin, end)
        if drive not in self._known:
            solved = assembler.solve(self.system, -assembler.rate(self.state, drive))
            rates = None if solved is None else solved[:, 1]
            finite = rates is not None and bool(np.isfinite(rates).all())
            self._known[drive] = rates if finite else None
        return self._known[drive]

    def speed(self) -> float:
        """Largest rate of a displacement or rotation in largest Newton steps per whole load; infinite at a limit point."""
        t = self.state.load_parameter
        rates = self.rates(t, t)
        if rates is None:
            return math.inf
        return self.newton.size(rates[: self.newton.model.equations])

    def release(self) -> None:
        """Let go of the assembled tangent, which every accepted configuration would hold otherwise; its speed stays known."""
        self.speed()
        self.system.__dict__.pop("tangent", None)

    def predicted(self, state: State, t: float) -> State:
        """State at a load parameter along the tangent from a state, which has the tangent's displacements."""
        rates = self.rates(state.load_parameter, t)
        if rates is None:
            return self.newton.prescribed(state, t)
        return self.newton.update(state, (t - state.load_parameter) * rates, self.system, t=t)

    def unexplained(self, before: State, after: State) -> float:
        """Part of the step between two states that the tangent does not explain, ``|q_B - q_A - h q'|/|q_B - q_A|``."""
        model, newton = self.newton.model, self.newton
        step = (after.q - before.q)[model.free]
        size = newton.size(step)
        rates = self.rates(before.load_parameter, after.load_parameter)
        if size <= _RESOLVED or rates is None:
            return 0.0
        length = after.load_parameter - before.load_parameter
        return newton.size(step - length * rates[: model.equations]) / size

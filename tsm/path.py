"""The tangent of the equilibrium path, and whether a step kept to the path.

Newton's method finds some equilibrium; after a long step it may belong to another branch. A step from A to B has followed the path if the
tangents at both its ends explain it: with the displacements and rotations q, at nodes and inside exact elements (`Newton.motion`), their
rates q' and the step h of the load parameter::

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
_RESOLVED = 1e-8
"""Smaller motions, in the same measure, are round-off, as of a column that stays straight: it moves along itself only."""


class PathTangent:
    """Tangent of the path at an equilibrium."""

    def __init__(self, newton: Newton, equilibrium: Equilibrium) -> None:
        self.newton, self.state, self.system = newton, equilibrium.state, equilibrium.system
        self._known: dict[Drive, tuple[Array, Array] | None] = {}
        self._left: tuple[State, State, float] | None = None

    @cached_property
    def index(self) -> int:
        """Number of the energy's negative eigenvalues, -1 where it is not defined, see `tsm.stability`."""
        _ = self.system.tangent  # which the rates need besides, and the index is cheaper with
        return index(self.newton.assembler, self.state, self.system)

    def rates(self, begin: float, end: float) -> Array | None:
        """Rates of the unknowns while the pins go straight from where they are at one load parameter to where they are at another.

        Returns the derivatives in the load parameter, (equations + contact unknowns,); None where the tangent
        is singular.
        """
        along = self._along(begin, end)
        return None if along is None else along[0]

    def _along(self, begin: float, end: float) -> tuple[Array, Array] | None:
        """Rates, and motion per unit of the load parameter, see `Newton.motion`."""
        assembler, model = self.newton.assembler, self.newton.model
        drive = assembler.drive(begin, end)
        if drive not in self._known:
            solved = assembler.solve(self.system, -assembler.rate(self.system, drive))
            if solved is None or not np.isfinite(solved[:, 1]).all():
                self._known[drive] = None
                return None
            rates, dofs = solved[:, 1], assembler.prescribed_rate(drive.stage)
            dofs[model.free], contacts = rates[: model.equations], rates[model.equations :]
            inside = [
                group.turning(self.state, tangent, dofs, contacts)
                for group, tangent in zip(model.groups, self.system.tangent.groups, strict=True)
            ]
            self._known[drive] = rates, np.concatenate([dofs[model.free], *inside])
        return self._known[drive]

    @cached_property
    def speed(self) -> float:
        """Size of the motion per whole load, no less than what round-off may be; infinite at a limit point."""
        t = self.state.load_parameter
        along = self._along(t, t)
        return math.inf if along is None else max(self.newton.size(along[1]), _RESOLVED)

    def release(self) -> None:
        """Let go of the assembled tangent, which every accepted configuration would hold otherwise; its speed stays known."""
        _ = self.speed
        self.system.__dict__.pop("tangent", None)

    def predicted(self, state: State, t: float) -> State:
        """State at a load parameter along the tangent from a state, which has the tangent's displacements."""
        rates = self.rates(state.load_parameter, t)
        if rates is None:
            return self.newton.prescribed(state, t)
        return self.newton.update(state, (t - state.load_parameter) * rates, self.system, t=t)

    def unexplained(self, before: State, after: State) -> float:
        """Part of the step between two states that the tangent does not explain, ``|q_B - q_A - h q'|/|q_B - q_A|``."""
        if self._left is None or self._left[0] is not before or self._left[1] is not after:
            self._left = before, after, self._unexplained(before, after)
        return self._left[2]

    def _unexplained(self, before: State, after: State) -> float:
        along = self._along(before.load_parameter, after.load_parameter)
        if along is None:
            return 0.0
        step = self.newton.motion(before, after, self.state)
        size, length = self.newton.size(step), after.load_parameter - before.load_parameter
        left = self.newton.size(step - length * along[1])
        return left / size if min(left, size) > _RESOLVED else 0.0

"""The path up to the last accepted equilibrium, with its states, its tangents and the prediction of the next state.

The next step starts from the extrapolation of the last accepted states, or from the tangent if there are few states. The step has
followed the path if the tangents at both of its ends explain it.
"""

from __future__ import annotations

from tsm.critical import limit_load
from tsm.newton import Equilibrium, Newton
from tsm.path import LONGEST_STEP, PathTangent
from tsm.predictor import extrapolate
from tsm.state import State
from tsm.status import Status

MEMORY = 4
"""Number of states in the extrapolation, a cubic in the load parameter. More states do not help where contacts pass from element to
element, because the path has kinks there."""
_MEMORY_WHOLE = 8
"""Number of states in the extrapolation where no contact passes from element to element."""
FAR = 1.0
"""Largest distance of an equilibrium from its prediction, over the largest Newton step. With 2 instead of 1, one random pin in a hundred
ends on another branch."""
_FEW = 3
"""Number of states below which the tangent predicts the next state."""
_FOLD = 100.0
"""Speed of the path, in largest Newton steps per whole load, above which a limit point is near. At a limit point the speed is infinite."""
_GROWING, _ROOM = 1.4, 0.6
"""Growth of the speed that shows a limit point ahead, and the next step over the distance to it. The tangents explain a little more."""


class Track:
    """The path up to the last accepted equilibrium.

    ``accepted``: the last one.
    ``history``: states for the extrapolation, oldest first, all with the same closed contacts.
    ``tangent, earlier``: tangents at the last equilibrium and at the one before it.
    ``index``: index of the last equilibrium that has one.
    """

    def __init__(self, newton: Newton, start: Equilibrium) -> None:
        self.newton, self.accepted = newton, start
        self.history = [start.state]
        self.tangent = self.earlier = PathTangent(newton, start)
        self.index = max(self.tangent.index, 0) if start.status is Status.CONVERGED else 0

    def accept(self, equilibrium: Equilibrium, tangent: PathTangent | None = None) -> None:
        """Make an equilibrium the last of the path."""
        state = equilibrium.state
        self.accepted = equilibrium
        memory = _MEMORY_WHOLE if self.newton.model.whole else MEMORY
        before = [old for old in self.history if old.load_parameter < state.load_parameter]
        self.history = [*before[1 - memory :], state]
        self.earlier, self.tangent = self.tangent, tangent or PathTangent(self.newton, equilibrium)
        self.earlier.release()
        self.index = self.tangent.index if self.tangent.index >= 0 else self.index

    def predicted(self, t: float) -> State:
        """State at t from the last states, or along the tangent where they are few."""
        if len(self.history) < _FEW and not self.chord_contact():
            return self.tangent.predicted(self.accepted.state, t)
        return self.newton.prescribed(extrapolate(self.newton.model, self.history, t), t)

    def unexplained(self, tangent: PathTangent, reached: Equilibrium) -> float:
        """Fraction of the step to an equilibrium that a tangent does not explain; 0 if `chord_contact`, where no tangent is usable."""
        return 0.0 if self.chord_contact() else tangent.unexplained(self.accepted.state, reached.state)

    def strays(self, predicted: State, reached: Equilibrium) -> bool:
        """Whether an equilibrium lies too far away, or too far from its prediction where contacts on chords have no usable tangent."""
        if self.chord_contact():
            return self.newton.apart(predicted, reached.state) > FAR
        return self.newton.apart(self.accepted.state, reached.state) > LONGEST_STEP

    def chord_contact(self) -> bool:
        """Whether a closed contact has a stiffness that grows without bound at the beam nodes, where round-off spoils its tangent."""
        pairs = zip(self.newton.model.pairs, self.accepted.state.touches, strict=True)
        return any(touch is not None and pair.slot < 0 for pair, touch in pairs)

    def room(self) -> float:
        """Part of the way to a limit point ahead that a step can follow; infinite where the last two speeds show none."""
        (t0, v0), (t1, v1) = self._speeds()
        if len(self.history) < 2 or t0 >= t1 or not v1 > _GROWING * v0:
            return float("inf")
        return _ROOM * (limit_load((t0, v0), (t1, v1)) - t1) or float("inf")

    def limit(self) -> float:
        """Load parameter of the limit point ahead."""
        return limit_load(*self._speeds())

    def folds(self) -> bool:
        """Whether the path is as fast as beside a limit point."""
        return self.tangent.speed > _FOLD

    def _speeds(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Load parameter and speed of the path at the last two equilibria."""
        one, two = ((item.state.load_parameter, item.speed) for item in (self.earlier, self.tangent))
        return one, two

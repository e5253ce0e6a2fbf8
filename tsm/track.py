"""The path up to the last accepted equilibrium: states and tangents, and what they predict.

The next step starts from the extrapolation of the last accepted states, or along the tangent where they are few. It has followed the
path if the tangents at both of its ends explain it.
"""

from __future__ import annotations

from tsm.critical import limit_load
from tsm.newton import Equilibrium, Newton
from tsm.path import LONGEST_STEP, PathTangent
from tsm.predictor import extrapolate
from tsm.state import State
from tsm.status import Status

MEMORY = 4
"""States that the predictor extrapolates from, a cubic in the load parameter: a path has kinks where contacts pass from element to element."""
_MEMORY_WHOLE = 8
"""The same where nothing is passed."""
FAR = 1.0
"""Largest distance of an equilibrium from its prediction, in largest Newton steps; with 2, one random pin in a hundred ends on another branch."""
_FEW = 3
"""Fewer states than these are extrapolated along the tangent."""
_FOLD = 100.0
"""Faster than this, in largest Newton steps per whole load, a path nears a limit point: there the speed is infinite."""
_GROWING, _ROOM = 1.4, 0.6
"""Growth of the speed that shows a limit point ahead, and the part of the way there of the next step, a little less than tangents explain."""


class Track:
    """The path up to the last accepted equilibrium.

    Attributes
    ----------
    accepted : Equilibrium
        The last one.
    history : list of State
        States that the predictor extrapolates from, oldest first: all with the same closed contacts.
    tangent, earlier : PathTangent
        Tangents at the last equilibrium and at the one before it.
    index : int
        Index of the last equilibrium that has one.
    """

    def __init__(self, newton: Newton, start: Equilibrium) -> None:
        self.newton, self.accepted = newton, start
        self.history = [start.state]
        self.tangent = self.earlier = PathTangent(newton, start)
        self.index = max(self.tangent.index, 0) if start.status is Status.CONVERGED else 0

    def resume(self, states: list[State]) -> None:
        """Go on from states that were accepted elsewhere, oldest first."""
        state = states[-1]
        self.accepted = Equilibrium(
            state=state,
            status=Status.CONVERGED,
            iterations=0,
            residuals=(),
            system=self.newton.assembler.linearise(state),
        )
        self.history = states
        self.tangent = PathTangent(self.newton, self.accepted)

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
        """Part of the step to an equilibrium that a tangent does not explain; 0 with contacts that have no energy, whose tangents are not compared."""
        return 0.0 if self.chord_contact() else tangent.unexplained(self.accepted.state, reached.state)

    def strays(self, predicted: State, reached: Equilibrium) -> bool:
        """Whether an equilibrium lies too far away; where contacts on chords allow no tangent, too far from its prediction."""
        if self.chord_contact():
            return self.newton.apart(predicted, reached.state) > FAR
        return self.newton.apart(self.accepted.state, reached.state) > LONGEST_STEP

    def chord_contact(self) -> bool:
        """Whether a contact is closed whose stiffness grows without bound at the nodes: its tangents are round-off there."""
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
        return self.tangent.speed() > _FOLD

    def _speeds(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Load parameter and speed of the path at the last two equilibria."""
        one, two = ((item.state.load_parameter, item.speed()) for item in (self.earlier, self.tangent))
        return one, two

"""Jumps: the equilibrium that a structure reaches after a slip-off, and the contacts that it loses on the way."""

from __future__ import annotations

from dataclasses import dataclass

from tsm.contact_set import changed
from tsm.events import EventKind, least_push, normal_force
from tsm.fall import Fall, descends, met
from tsm.friction import grips
from tsm.newton import Equilibrium
from tsm.state import State
from tsm.status import Status
from tsm.step import StepLog
from tsm.step_control import StepControl
from tsm.track import FAR


@dataclass(frozen=True, kw_only=True)
class Jump:
    """A jump."""

    fall: Fall  # the motion of the structure where no equilibrium is nearby
    control: StepControl  # length of the next step
    log: StepLog  # events and iterations

    def rest(self, event: Equilibrium, state: State) -> Equilibrium | Status:
        """Equilibrium after the slip-off; contacts whose force would become tensile are released.

        ``event``: equilibrium at the slip-off. ``state``: the same configuration without the lost contact.
        Returns FALLING if the structure finds no rest. LOST_CONTACT if a contact opens that must persist.
        REST_UNKNOWN if contacts with friction are closed at the rest.
        """
        newton, model = self.fall.newton, self.fall.newton.model
        energy = began = newton.potential(event.state)
        while True:
            equilibrium = self._next(state, energy)
            if equilibrium is None:
                return Status.FALLING
            state = equilibrium.state
            energy = newton.potential(state)
            forces = [
                (normal_force(model, equilibrium, k) / least_push(newton, k), k)
                for k, touch in enumerate(state.touches)
                if touch is not None
            ]
            least, k = min(forces, default=(0.0, -1))
            if least >= -1.0:
                break
            touch = state.touches[k]
            assert touch is not None, "a pulling contact is closed"
            pair = model.pairs[k]
            before = normal_force(model, event, k) if event.state.touches[k] is not None else 0.0
            self.log.note(EventKind.RELEASE, state.load_parameter, pair, touch, before)
            if pair.pair.keep:
                return Status.LOST_CONTACT
            state = changed(model, state, k, None, armed=True)
        self.log.note_release(began - energy)
        return Status.REST_UNKNOWN if grips(state) else equilibrium

    def _next(self, state: State, energy: float) -> Equilibrium | None:
        """Equilibrium near the state, of a potential of at most `energy`, or at the end of a fall."""
        newton = self.fall.newton
        equilibrium = newton.solve(state)
        self.log.iterations += equilibrium.iterations
        converged = equilibrium.status is Status.CONVERGED
        near = converged and newton.apart(state, equilibrium.state) <= FAR
        down = near and descends(newton, energy, equilibrium.state)
        if down and not met(self.fall.measure(equilibrium)):
            self.control.fail(equilibrium.status)
            return equilibrium
        self.fall.iterations = 0
        rest = self.fall.rest(state, energy)
        self.log.iterations += self.fall.iterations
        return rest

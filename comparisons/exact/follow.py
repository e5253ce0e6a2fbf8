"""Equilibrium of a cantilever along the path of a pin, with all changes of state.

Steps end at the first event. The answer depends on history only through the place at which a stick began, so that it does not depend on
the steps. Where a contact begins, where the path of the pin turns and where a phase ends, the state that follows is the one whose forces
and slip have admissible rates.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from comparisons.exact.contact import Cantilever, Held, Linear, Phase, Real
from comparisons.exact.outcome import Outcome
from comparisons.exact.step import AT_ONCE, EDGE, Ending, Piece

_TOUCH = 1e-12  # distance, in lengths of the rod, below which the pin touches
_FIRST_STEP, _SMALLEST_STEP = 0.05, 1e-11  # of the path
_MOST_ITERATIONS = (
    3000  # on a straight piece without friction; more are spent only near a position without equilibrium
)
_SAME_DIRECTION = 1e-9
_NO_RATE, _SHORT_STEP = 1e-9, 1e-5
"""A rate below the first is zero; the next order shows after the second, in load parameters."""
_STATES = {1: Outcome.SLIP_TO_TIP, -1: Outcome.SLIP_TO_CLAMP, 0: Outcome.STICK}


@dataclass(frozen=True, kw_only=True)
class Event:
    """Change of the state of contact.

    Attributes
    ----------
    load_parameter : float
        Fraction of the path's length at which the state changes.
    before, after : Outcome
        States on both sides.
    arc_position : float
        Distance of the contact from the clamp along the undeformed axis.
    magnitude : float
        Contact force at the event.
    """

    load_parameter: float
    before: Outcome
    after: Outcome
    arc_position: float
    magnitude: float


@dataclass(frozen=True, kw_only=True)
class Standing:
    """State, unknowns, phase of a contact, energies, events and iterations up to a load parameter."""

    t: float = 0.0
    state: Outcome = Outcome.OPEN
    z: Real
    phase: Phase
    work: float = 0.0
    dissipated: float = 0.0
    released: float = 0.0
    events: tuple[Event, ...] = ()
    iterations: int = 0


def follow(rod: Cantilever, pins: Real, t: Real) -> Iterator[Standing]:
    """Yield the equilibria at the vertices (s, 2) of a path, whose load parameters are t (s,)."""
    x, height = pins[0, 0], pins[0, 1] + rod.reach
    if (height > _TOUCH and x <= 1.0 + _TOUCH) or (height >= -_TOUCH and x <= 0.0):
        raise ValueError(
            f"points[0] = {pins[0]} length: the path must start below the rod, on its surface or beyond its tip"
        )
    standing = Standing(z=np.array([0.0, 0.0, 0.0, x]), phase=Phase(1, 0.0, Held(x, 1.0, 0.0)))
    if not rod.friction and height >= -_TOUCH and x <= 1.0 + _TOUCH:
        standing = replace(standing, state=Outcome.CONTACT)
    velocity = np.zeros(2)
    for (start, end), (begin, finish) in zip(pairwise(pins), pairwise(t), strict=True):
        last = here = standing
        if finish > begin:
            way = (end - start) / (finish - begin)
            walk = _Walk(Piece(rod=rod, start=start, velocity=way, begin=begin))
            turns = np.linalg.norm(way - velocity) > _SAME_DIRECTION * np.linalg.norm(velocity)
            here = walk.begin(standing, finish, turns=bool(turns))
            standing, velocity = walk.along(here, finish), way
        yield here if rod.friction else last
    yield standing


@dataclass(frozen=True)
class _Walk:
    """One straight piece of the pin's path."""

    piece: Piece

    def begin(self, standing: Standing, finish: float, *, turns: bool) -> Standing:
        """State at the beginning of the piece, after a corner of the path or a touch there."""
        if standing.state.touches:
            return self._turned(standing) if turns and self.piece.rod.friction else standing
        touch = self._until_touch(standing, finish)
        return touch if touch.t == standing.t else standing

    def along(self, standing: Standing, finish: float) -> Standing:
        """Equilibrium at the end of the piece."""
        piece, step, growth = self.piece, _FIRST_STEP, 2.0
        while finish - standing.t > AT_ONCE and not standing.state.ends:
            if not standing.state.touches:
                standing = self._until_touch(standing, finish)
                continue
            start = piece.node(standing.phase, standing.t, standing.z)
            end = finish if finish - standing.t <= 1.001 * step else standing.t + step
            found = None if start is None else piece.take(standing.phase, start, end)
            if found is None:
                step, growth = (end - standing.t) / 3.0, 1.0
                many = not piece.rod.friction and piece.iterations > _MOST_ITERATIONS
                if step < _SMALLEST_STEP or many:
                    standing = self._change(standing, Outcome.LOST)
                continue
            standing = replace(
                standing,
                t=found.node.t,
                z=found.node.z,
                phase=found.phase,
                work=standing.work + found.work,
                dissipated=standing.dissipated + found.dissipated,
            )
            if found.ending is not None:
                standing = self._after(standing, found.ending)
            step, growth = growth * step, 2.0
        return replace(standing, t=finish, iterations=standing.iterations + piece.iterations)

    def _until_touch(self, standing: Standing, finish: float) -> Standing:
        """Pin at its touch with the straight rod, or at the end of the piece."""
        rod, state = self.piece.rod, standing.state
        gaps = [-self.piece.pin(t)[1] - rod.reach for t in (standing.t, finish)]
        if state is Outcome.SLIPPED and gaps[1] > _TOUCH:
            state = Outcome.OPEN
        resting = state is Outcome.OPEN and abs(gaps[0]) <= _TOUCH and gaps[1] < -_TOUCH
        if not resting and (gaps[0] <= _TOUCH or gaps[1] > _TOUCH):
            return replace(standing, t=finish, state=state)
        share = 0.0 if resting else min(gaps[0] / (gaps[0] - gaps[1]), 1.0)
        t = standing.t + share * (finish - standing.t)
        x = float(self.piece.pin(t)[0])
        if (t >= finish and rod.friction) or not 0.0 < x <= 1.0 + _TOUCH:
            return replace(standing, t=finish, state=state)
        touch = replace(standing, t=t, state=state, z=np.array([0.0, 0.0, 0.0, min(x, 1.0)]))
        return self._decide(touch, (0, 1, -1)) if rod.friction else self._enter(touch, [1])

    def _turned(self, standing: Standing) -> Standing:
        """Return the state after a corner of the pin's path; on the edge of the cone a slip goes on or begins, or the pin sticks."""
        here = self._linear(standing).here
        edge = standing.phase.sense or int(np.sign(here.tangential))
        inside = self.piece.rod.friction * here.normal - edge * here.tangential > EDGE
        return standing if inside else self._decide(standing, (edge, 0))

    def _after(self, standing: Standing, ending: Ending) -> Standing:
        """Return the state after the end of a phase."""
        if ending is Ending.RELEASE:
            return self._change(standing, Outcome.OPEN)
        if ending is Ending.SLIP_OFF:
            energy = self.piece.rod.energy(standing.z)
            return self._change(replace(standing, released=standing.released + energy), Outcome.SLIPPED)
        if standing.phase.sense:
            return self._enter(standing, [0])
        return self._decide(standing, (int(np.sign(self._linear(standing).here.tangential)),))

    def _decide(self, standing: Standing, senses: Iterable[int]) -> Standing:
        """Return the only state whose rates are admissible: slip in the sense of its friction, stick whose force enters the cone.

        At a touch, where there is no force, they raise the normal force.
        """
        rod, linear, touch, possible = self.piece.rod, self._linear(standing), not standing.state.touches, []
        edge = np.sign(linear.here.tangential)
        for sense in senses:
            phase = Phase(sense, standing.t, linear.held)
            rates = linear.rates(rod.law(linear, phase, standing.t)[1], self.piece.velocity)
            if rates is None or (touch and linear.slope.normal @ rates <= 0.0):
                continue
            drag = linear.slope.tangential @ rates
            margin = float(sense * linear.slip @ rates)
            if not sense:
                margin = float(
                    rod.friction * linear.slope.normal @ rates - (abs(drag) if touch else edge * drag)
                )
            if touch and abs(margin) < _NO_RATE * np.linalg.norm(self.piece.velocity):
                soon = self.piece.node(phase, standing.t + _SHORT_STEP, standing.z)
                margin = -1.0 if soon is None else float(soon.margins[0])
            if margin > 0.0:
                possible.append(sense)
        return self._enter(standing, possible)

    def _enter(self, standing: Standing, possible: list[int]) -> Standing:
        """Return the only possible state."""
        if len(possible) != 1:
            return self._change(standing, Outcome.JAMMED)
        (sense,) = possible
        if standing.state.touches and sense == standing.phase.sense:
            return standing
        state = _STATES[sense] if self.piece.rod.friction else Outcome.CONTACT
        phase = Phase(sense, standing.t, self._linear(standing).held)
        return self._change(replace(standing, phase=phase), state)

    def _linear(self, standing: Standing) -> Linear:
        """Equations at a state."""
        return self.piece.rod.linearise(standing.z, self.piece.pin(standing.t))

    def _change(self, standing: Standing, state: Outcome) -> Standing:
        """Change the state and record the event."""
        event = Event(
            load_parameter=float(standing.t),
            before=standing.state,
            after=state,
            arc_position=float(standing.z[3]),
            magnitude=float(np.hypot(*standing.z[:2])),
        )
        return replace(standing, state=state, events=(*standing.events, event))

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
    3000  # on a straight piece without friction; more are spent near a place without equilibrium
)
_SAME_DIRECTION = 1e-9
_NO_RATE, _SHORT_STEP = 1e-9, 1e-5
"""A rate below the first is zero; the next order shows after the second, in load parameters."""
_UNTOUCHED = Phase(1, 0.0, Held(1.0, 1.0, 0.0))
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
    phase: Phase = _UNTOUCHED
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
    standing = Standing(z=np.array([0.0, 0.0, 0.0, x]))
    if not rod.friction and height >= -_TOUCH and x <= 1.0 + _TOUCH:
        standing = replace(standing, state=Outcome.CONTACT)
    velocity = np.zeros(2)
    for (start, end), (begin, finish) in zip(pairwise(pins), pairwise(t), strict=True):
        last = here = standing
        if finish > begin:
            way = (end - start) / (finish - begin)
            piece = Piece(rod=rod, start=start, velocity=way, begin=begin)
            turns = np.linalg.norm(way - velocity) > _SAME_DIRECTION * np.linalg.norm(velocity)
            here = _begin(piece, standing, finish, turns=bool(turns))
            standing, velocity = _along(piece, here, finish), way
        yield here if rod.friction else last
    yield standing


def _begin(piece: Piece, standing: Standing, finish: float, *, turns: bool) -> Standing:
    """State at the beginning of the piece, after a corner of the path or a touch there."""
    if standing.state.touches:
        return _turned(piece, standing) if turns and piece.rod.friction else standing
    touch = _until_touch(piece, standing, finish)
    return touch if touch.t == standing.t else standing


def _along(piece: Piece, standing: Standing, finish: float) -> Standing:
    """Equilibrium at the end of the piece."""
    step, growth = _FIRST_STEP, 2.0
    while finish - standing.t > AT_ONCE and not standing.state.ends:
        if not standing.state.touches:
            standing = _until_touch(piece, standing, finish)
            continue
        start = piece.node(standing.phase, standing.t, standing.z)
        end = finish if finish - standing.t <= 1.001 * step else standing.t + step
        found = None if start is None else piece.take(standing.phase, start, end)
        if found is None:
            step, growth = (end - standing.t) / 3.0, 1.0
            many = not piece.rod.friction and piece.iterations > _MOST_ITERATIONS
            if step < _SMALLEST_STEP or many:
                standing = changed(standing, Outcome.LOST)
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
            standing = _after(piece, standing, found.ending)
        step, growth = growth * step, 2.0
    return replace(standing, t=finish, iterations=standing.iterations + piece.iterations)


def _until_touch(piece: Piece, standing: Standing, finish: float) -> Standing:
    """Pin at its touch with the straight rod, or at the end of the piece."""
    rod, state = piece.rod, standing.state
    gaps = [-piece.pin(t)[1] - rod.reach for t in (standing.t, finish)]
    if state is Outcome.SLIPPED and gaps[1] > _TOUCH:
        state = Outcome.OPEN
    resting = state is Outcome.OPEN and abs(gaps[0]) <= _TOUCH and gaps[1] < -_TOUCH
    if not resting and (gaps[0] <= _TOUCH or gaps[1] > _TOUCH):
        return replace(standing, t=finish, state=state)
    share = 0.0 if resting else min(gaps[0] / (gaps[0] - gaps[1]), 1.0)
    t = standing.t + share * (finish - standing.t)
    x = float(piece.pin(t)[0])
    if (t >= finish and rod.friction) or not 0.0 < x <= 1.0 + _TOUCH:
        return replace(standing, t=finish, state=state)
    touch = replace(standing, t=t, state=state, z=np.array([0.0, 0.0, 0.0, min(x, 1.0)]))
    return _decide(piece, touch, (0, 1, -1)) if rod.friction else _enter(piece, touch, [1])


def _turned(piece: Piece, standing: Standing) -> Standing:
    """Return the state after a corner of the pin's path; on the edge of the cone a slip goes on or begins, or the pin sticks."""
    here = _linear(piece, standing).here
    edge = standing.phase.sense or int(np.sign(here.tangential))
    inside = piece.rod.friction * here.normal - edge * here.tangential > EDGE
    return standing if inside else _decide(piece, standing, (edge, 0))


def _after(piece: Piece, standing: Standing, ending: Ending) -> Standing:
    """Return the state after the end of a phase."""
    if ending is Ending.RELEASE:
        return changed(standing, Outcome.OPEN)
    if ending is Ending.SLIP_OFF:
        energy = piece.rod.energy(standing.z)
        return changed(replace(standing, released=standing.released + energy), Outcome.SLIPPED)
    if standing.phase.sense:
        return _enter(piece, standing, [0])
    return _decide(piece, standing, (int(np.sign(_linear(piece, standing).here.tangential)),))


def _decide(piece: Piece, standing: Standing, senses: Iterable[int]) -> Standing:
    """Return the only state whose rates are admissible: slip in the sense of its friction, stick whose force enters the cone.

    At a touch, where there is no force, they raise the normal force.
    """
    rod, linear, touch, possible = piece.rod, _linear(piece, standing), not standing.state.touches, []
    edge = np.sign(linear.here.tangential)
    for sense in senses:
        phase = Phase(sense, standing.t, linear.held)
        rates = linear.rates(rod.law(linear, phase, standing.t)[1], piece.velocity)
        if rates is None or (touch and linear.slope.normal @ rates <= 0.0):
            continue
        drag = linear.slope.tangential @ rates
        margin = float(sense * linear.slip @ rates)
        if not sense:
            margin = float(rod.friction * linear.slope.normal @ rates - (abs(drag) if touch else edge * drag))
        if touch and abs(margin) < _NO_RATE * np.linalg.norm(piece.velocity):
            soon = piece.node(phase, standing.t + _SHORT_STEP, standing.z)
            margin = -1.0 if soon is None else float(soon.margins[0])
        if margin > 0.0:
            possible.append(sense)
    return _enter(piece, standing, possible)


def _enter(piece: Piece, standing: Standing, possible: list[int]) -> Standing:
    """Return the only possible state."""
    if len(possible) != 1:
        return changed(standing, Outcome.JAMMED)
    (sense,) = possible
    if standing.state.touches and sense == standing.phase.sense:
        return standing
    state = _STATES[sense] if piece.rod.friction else Outcome.CONTACT
    phase = Phase(sense, standing.t, _linear(piece, standing).held)
    return changed(replace(standing, phase=phase), state)


def _linear(piece: Piece, standing: Standing) -> Linear:
    """Equations at a state."""
    return piece.rod.linearise(standing.z, piece.pin(standing.t))


def changed(standing: Standing, state: Outcome) -> Standing:
    """Return a state after a change, with the event."""
    event = Event(
        load_parameter=float(standing.t),
        before=standing.state,
        after=state,
        arc_position=float(standing.z[3]),
        magnitude=float(np.hypot(*standing.z[:2])),
    )
    return replace(standing, state=state, events=(*standing.events, event))

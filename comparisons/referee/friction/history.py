"""How friction holds the contacts of an answer at its load parameters, with the places of stick from the referee's own equilibria.

A slip has no memory. A stick holds the place at which it began: where the referee's own slip rate is zero, or its own contact force begins.
"""

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from itertools import pairwise, product
from typing import TypeVar

import numpy as np

from comparisons.answer import Response
from comparisons.referee.friction.phases import OPEN, UNKNOWN, Phase, phases, states
from comparisons.referee.friction.slip import place, relative_slip_rate, roll, slip_rate
from comparisons.referee.grip import LOOSE, Grip, Hold, UnknownFrictionError
from comparisons.referee.guess import answer_state
from comparisons.referee.newton import equilibrium
from comparisons.referee.path import SAME, corners, reach
from comparisons.referee.rod import face_of, units_of
from comparisons.referee.state import Equilibrium
from comparisons.scene import ContactSpec, Scene

T = TypeVar("T")

_ITERATIONS = 60
"""Largest number of steps of a root."""
_FIRST = 1e-4
"""First step of a secant, in load parameters."""
_FEET = 40
"""Number of corrections of a place on a face whose height tapers."""
_CLOSE = 1e-13
"""Change of a load parameter at which a root is found."""
_ROUND_OFF = 1e-8
"""Change of a load parameter within which a margin that no longer decreases is round-off."""
_ZERO = 1e-12
"""Dimensionless margin that is zero."""


class History:
    """The phases of the contacts of an answer, and where they begin; `taken` says what its states of friction were taken from."""

    def __init__(self, response: Response, scene: Scene) -> None:
        self.response, self.scene = response, scene
        self.phases: dict[str, tuple[Phase, ...]] = {}
        self.numbers: dict[str, tuple[int, ...]] = {}
        how: list[str] = []
        for spec in scene.contacts:
            column, taken = states(response, scene, spec)
            self.phases[spec.pair], self.numbers[spec.pair] = phases(response, spec, column)
            how += [f"friction of {spec.pair} taken from {taken}"] if taken else []
        self.taken = "; ".join(how)
        self._begins: dict[Phase, Equilibrium] = {}
        self._signs: dict[Phase, int] = {}
        self._sticks: dict[Phase, tuple[Hold, Hold]] = {}
        """Where sticks began, and the places up to which they were followed."""
        changes = [phase.begin for own in self.phases.values() for phase in own[1:]]
        times = sorted([0.0, *changes, *corners(scene), float(np.max(response.load_parameter, initial=0.0))])
        self._cuts = [t for t, after in pairwise([*times, math.inf]) if after > t + SAME]
        self._sought: set[Phase] = set()

    def phase(self, pair: str, k: int) -> Phase:
        """Return the phase of a contact at load parameter number k."""
        return self.phases[pair][self.numbers[pair][k]]

    def grips(self, k: int) -> dict[str, Grip]:
        """Return how friction holds the closed contacts at load parameter number k; raises `UnknownFrictionError`, as the following."""
        t = float(self.response.load_parameter[k])
        now = {spec.pair: self.phase(spec.pair, k) for spec in self.scene.contacts if spec.friction}
        return {pair: self.grip(phase, t) for pair, phase in now.items() if phase.slip != OPEN}

    def closed(self, t: float) -> set[str]:
        """Return the contacts that are closed at load parameter t, those that touch there included."""
        return {pair for pair in self.phases if self._phase_at(pair, t).slip != OPEN}

    def begin(self, phase: Phase) -> Equilibrium:
        """Return the equilibrium where a phase of a contact begins, in the state before it; not for the first phase, nor for a slip-off."""
        return self._once(self._begins, phase, self._found)

    def _once(self, known: dict[Phase, T], phase: Phase, seek: Callable[[Phase], T]) -> T:
        """Seek something of a phase that is not known yet, but not while it is sought."""
        if phase not in known:
            if phase in self._sought:
                raise UnknownFrictionError(
                    f"the changes of {phase.spec.pair} and of another contact depend on each other"
                )
            self._sought.add(phase)
            try:
                known[phase] = seek(phase)
            finally:
                self._sought.discard(phase)
        return known[phase]

    def grip(self, phase: Phase, until: float) -> Grip:
        """Return how friction holds a contact in a closed phase, up to a load parameter in it."""
        spec, slip = phase.spec, phase.slip
        if slip == UNKNOWN:
            slip = self._once(self._signs, phase, self._sign)
        if slip:
            return Grip(friction=spec.friction, slip=slip)
        if phase not in self._sticks:
            begin = at_rest(self.scene, spec)
            if phase.before is not None:
                begin = place(self.begin(phase), spec.pair)
            self._sticks[phase] = begin, begin
        if self.scene.offset(spec):
            for first, last in pairwise(self._cuts):
                if phase.begin <= first + SAME and first < until - SAME:
                    self._roll(phase, first, last)
        return Grip(friction=spec.friction, slip=0, hold=self._sticks[phase][0])

    def _roll(self, phase: Phase, first: float, last: float) -> None:
        """Follow the contacts that stick between two neighbouring changes, as far as this has not been done."""
        if self._sticks[phase][1].load_parameter > last - SAME:
            return
        middle = (first + last) / 2.0
        grips = self.around(middle, until=first)
        sticking = {pair: self._phase_at(pair, middle) for pair, grip in grips.items() if not grip.slip}
        sticks = {pair: self._sticks[item] for pair, item in sticking.items()}
        begin = max(reached.load_parameter for _, reached in sticks.values())
        if begin > last - SAME:
            return
        closed = self.closed(middle)
        began = [self._begins[item] for item in sticking.values() if item in self._begins]
        began = [item for item in began if item.closed.keys() == closed]
        # a stick is followed from its begin: at the load parameters of the answer it may have no equilibrium
        latest = max(began, key=lambda item: item.load_parameter, default=None)
        rolled = roll(latest or self.near(middle, closed, grips), (begin, last), grips, sticks)
        if rolled is None:
            raise UnknownFrictionError(f"no equilibria in stick were found up to load parameter {last:.6g}")
        self._sticks |= {item: rolled[pair] for pair, item in sticking.items()}

    def _sign(self, phase: Phase) -> int:
        """Sign of a slip between two load parameters: the one that the slip rate has, too, in the middle of it."""
        pair = phase.spec.pair
        after = next(later for later in self.phases[pair] if later.before is phase)
        t = (phase.begin + after.begin) / 2.0
        around = self.around(t, phase.spec)
        # no load parameter may have the contacts of the middle, if another one opens where this slip ends
        for closed, sign in product((self.closed(t) | {pair}, self.closed(after.begin) | {pair}), (1, -1)):
            state = {**around, pair: Grip(friction=phase.spec.friction, slip=sign)}
            with suppress(UnknownFrictionError):
                now = reach(self.near(t, closed, state), t, state)
                if now.found and sign * slip_rate(now, pair) > 0.0:
                    return sign
        raise UnknownFrictionError(f"{pair} slips between two load parameters, and its sign is not stated")

    def _found(self, phase: Phase) -> Equilibrium:
        """Find the root of a phase's margin, in the state `own` that the contact was in before."""
        before = phase.before
        assert before is not None, "the first phase has no begin"
        if math.isnan(phase.stated) and before.slip == -phase.slip != 0:
            raise UnknownFrictionError(
                f"the slip of {phase.spec.pair} turns between two load parameters, and a stick in between is not stated"
            )
        own = LOOSE if before.slip == OPEN else self.grip(before, phase.begin)
        state = {**self.around(phase.begin, phase.spec), phase.spec.pair: own}
        now = self._start(phase, state)

        def margin(t: float) -> float:
            nonlocal now
            now = _found_at(reach(now, t, state), phase, t)
            return _margin(now, phase, own)

        # each way evaluates the margin at the root last
        if self._jumps(phase, phase.begin):
            margin(phase.begin)
        elif math.isfinite(phase.stated):
            _secant(margin, phase)
        elif not (
            # the slip rate changes its sign by a jump, and the margin has the rate behind it
            own.friction and own.slip and self._jumps(phase, phase.low) and margin(phase.low) < 0.0
        ):
            _bisected(margin, phase)
        return now

    def _start(self, phase: Phase, state: dict[str, Grip]) -> Equilibrium:
        """Return an equilibrium from which the beginning of a phase is sought, in the state before: near an answer, or where that state began."""
        t, found, before = phase.begin, None, phase.before
        closed = self.closed(t) | {phase.spec.pair}
        with suppress(UnknownFrictionError):
            found = reach(self.near(t, closed, state), t, state)
        if before is not None and before.before is not None and (found is None or not found.found):
            began = self.begin(before)
            found = reach(began, t, state) if closed == began.closed.keys() else None
        return _found_at(found, phase, t)

    def _jumps(self, phase: Phase, t: float) -> bool:
        """Whether rates jump at load parameter t: at a corner of a pin's path, at the end of a stage, and where another contact changes."""
        others = [
            one.stated for pair, own in self.phases.items() if pair != phase.spec.pair for one in own[1:]
        ]
        return any(abs(t - other) <= SAME for other in (*corners(self.scene), *others))

    def _phase_at(self, pair: str, t: float) -> Phase:
        """Phase of a contact at a load parameter; the later one where it changes."""
        first, *others = self.phases[pair]
        return next((phase for phase in reversed(others) if phase.begin <= t + SAME), first)

    def around(
        self, t: float, spec: ContactSpec | None = None, until: float | None = None
    ) -> dict[str, Grip]:
        """Return how friction holds the closed contacts but one at t, before a change there; sticks are followed `until` a load parameter."""
        held, until = {}, t if until is None else until
        for other in self.scene.contacts:
            now = self._phase_at(other.pair, t)
            if other is spec or not other.friction or now.slip == OPEN:
                continue
            if now.before is not None and abs(now.begin - t) <= SAME:
                now = now.before
            held[other.pair] = LOOSE if now.slip == OPEN else self.grip(now, until)
        return held

    def near(self, t: float, closed: set[str], state: dict[str, Grip]) -> Equilibrium:
        """Return an equilibrium with given contacts and state, at a load parameter of the answer that is near t."""
        times = self.response.load_parameter
        after = int(np.searchsorted(times, t))
        for k in range(max(after - 1, 0), min(after + 2, len(times))):
            answer = answer_state(self.response, self.scene, k)
            if not closed <= answer.arcs.keys():
                continue
            kept = {pair: arc for pair, arc in answer.arcs.items() if pair in closed}
            # far from t there may be no equilibrium in this state, while frictionless contacts lead to t
            loose = dict.fromkeys(state, LOOSE)
            for first in (state, loose):
                found = equilibrium(self.scene, replace(answer, arcs=kept, grips=first))
                for then in (loose, state) if first is loose else ():
                    if found.found:
                        found = reach(found, t, then)
                if found.found:
                    return found
        raise UnknownFrictionError(
            f"no equilibrium near load parameter {t:.6g} was found in the contacts there"
        )


def _found_at(solution: Equilibrium | None, phase: Phase, t: float) -> Equilibrium:
    """Return an equilibrium that was found where a phase begins, or raise `UnknownFrictionError`."""
    if solution is None or not solution.found:
        raise UnknownFrictionError(
            f"no equilibrium was found where {phase.spec.pair} {phase.does} at {t:.6g}"
        )
    return solution


def at_rest(scene: Scene, spec: ContactSpec) -> Hold:
    """The place of a contact with the undeformed beam."""
    beam = scene.beam(spec.beam)
    there = scene.place(spec.node) if "." in spec.node else scene.pin(spec.node).position(0.0)
    face = face_of(scene, spec)
    arc = min(max(beam.projected(there)[1], 0.0), 1.0) * beam.length
    for _ in range(_FEET if face.slope else 0):
        apart = np.array(there) - beam.place(arc / beam.length)
        ahead = float(apart @ beam.tangent(arc / beam.length)) + face.slope * face.reach(arc)
        arc = min(max(arc + ahead, 0.0), beam.length)
    tilt, (x, y) = math.asin(face.tilt), beam.direction
    return Hold(
        load_parameter=0.0, arc_position=arc / units_of(scene)[0], shear=tilt,
        stretch=math.sqrt(1.0 - face.slope**2) + face.lever(arc) * beam.curvature,
        direction=math.atan2(y, x) + beam.turn * (arc / beam.length - 0.5) + tilt,
    )  # fmt: skip


def _margin(now: Equilibrium, phase: Phase, own: Grip) -> float:
    """A dimensionless number that is zero where a state ends: push at a touch or release, slip rate in slip, distance from the cone in stick."""
    pair, opens = phase.spec.pair, phase.slip == OPEN
    if own.friction and own.slip and not opens:
        return relative_slip_rate(now, pair)
    contact = now.contacts[pair]
    if opens or not own.friction:
        return contact.push / now.layout.force
    return (own.friction * contact.push - abs(contact.drag)) / now.layout.force


def _secant(margin: Callable[[float], float], phase: Phase) -> None:
    """Find the root of a margin near a stated load parameter; the margin is evaluated there last."""
    low, high = max(0.0, 2.0 * phase.low - phase.high), 2.0 * phase.high - phase.low
    first, value = phase.stated, margin(phase.stated)
    if abs(value) <= _ZERO:
        return
    second = first + _FIRST * (phase.high - phase.low)
    for _ in range(_ITERATIONS):
        other = margin(second)
        width = abs(second - first)
        if abs(other) <= _ZERO or width <= (_ROUND_OFF if 4.0 * abs(other) >= abs(value) else _CLOSE):
            return
        ahead = second - other * (second - first) / (other - value)
        if not low <= ahead <= high:
            break
        first, value, second = second, other, ahead
    raise UnknownFrictionError(f"no change of a contact was found near load parameter {phase.stated:.6g}")


def _bisected(margin: Callable[[float], float], phase: Phase) -> None:
    """Find the root of a margin between two load parameters; the margin is evaluated there last."""
    from scipy.optimize import brentq

    low, high = max(phase.low, 1e-3 * phase.high), phase.high
    if margin(low) * margin(high) > 0.0:
        raise UnknownFrictionError(
            f"{phase.spec.pair} {phase.does} from between load parameters {phase.low:.6g} and {phase.high:.6g}, where it does not begin to",
            wrong=True,
        )
    margin(float(brentq(margin, low, high, xtol=_CLOSE)))

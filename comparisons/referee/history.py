"""How friction holds the contacts of an answer at its load parameters, with the places of stick from the referee's own equilibria.

A slip has no memory. A stick holds the place at which it began: where the referee's own slip rate is zero, or its own contact force begins.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from comparisons.referee.equilibrium import SearchStatus, Solution, solve
from comparisons.referee.faces import face_slope, touching_distance
from comparisons.referee.friction import LOOSE, Grip, Hold
from comparisons.referee.march import closed_pairs, corners, place, rates, reach, slip_rate, speed
from comparisons.referee.phases import OPEN, PASSES, SAME, UNKNOWN, Phase, phases, states
from comparisons.referee.rolling import roll
from comparisons.referee.start import answer_state
from comparisons.referee.state import touching
from comparisons.response import Response
from comparisons.scene import BeamSpec, ContactSpec, Scene
from comparisons.scene.coherence import signed_gap

_ITERATIONS = 60
"""Largest number of steps of a root."""
_FIRST = 1e-4
"""First step of a secant, in load parameters."""
_BEFORE = 0.01
"""Part of a slip's interval of load parameters before its end at which its sign is compared with the slip rate."""
_FEET = 40
"""Number of corrections of a place on a face whose height tapers."""
_CLOSE = 1e-13
"""Change of a load parameter at which a root is found."""
_ZERO = 1e-12
"""Dimensionless margin that is zero."""


class UnknownFrictionError(ValueError):
    """The friction of an answer at a load parameter cannot be computed; `wrong` if the answer is to blame."""

    def __init__(self, reason: str, *, wrong: bool = False) -> None:
        super().__init__(reason)
        self.wrong = wrong


@dataclass(frozen=True, kw_only=True)
class Begin:
    """Where a phase begins by the referee's own equations: load parameter, and the equilibrium there in the state before."""

    load_parameter: float
    solution: Solution


class History:
    """The phases of the contacts of an answer, and where they begin.

    Attributes
    ----------
    response, scene
        The answer and its scene.
    taken : str
        What was taken for the states of friction if the answer does not state them; empty if it does.
    """

    def __init__(self, response: Response, scene: Scene) -> None:
        self.response, self.scene = response, scene
        self.specs = {spec.pair: spec for spec in scene.contacts}
        self.phases: dict[str, tuple[Phase, ...]] = {}
        self.numbers: dict[str, tuple[int, ...]] = {}
        how: list[str] = []
        for spec in scene.contacts:
            column, taken = states(response, scene, spec)
            self.phases[spec.pair], self.numbers[spec.pair] = phases(response, spec, column)
            how += [f"friction of {spec.pair} taken from {taken}"] if taken else []
        self.taken = "; ".join(how)
        self._begins: dict[tuple[str, int], Begin] = {}
        self._holds: dict[tuple[str, int], Hold] = {}
        self._reached: dict[tuple[str, int], Hold] = {}
        self._followed: set[tuple[str, int, float]] = set()
        """Where sticks began, the places up to which they were followed, and from where they were."""
        changes = [phase.begin for own in self.phases.values() for phase in own[1:]]
        times = sorted([0.0, *changes, *corners(scene), float(np.max(response.load_parameter, initial=0.0))])
        self._cuts = [t for t, after in pairwise([*times, math.inf]) if after > t + SAME]
        self._sought: set[tuple[str, int]] = set()

    def grips(self, k: int) -> dict[str, Grip]:
        """Return how friction holds the closed contacts at load parameter number k.

        Raises
        ------
        UnknownFrictionError
            If no equilibrium is found where a stick begins.
        """
        held = {}
        for pair, spec in self.specs.items():
            number = self.numbers[pair][k]
            if spec.friction and self.phases[pair][number].slip != OPEN:
                held[pair] = self.grip(spec, number, float(self.response.load_parameter[k]))
        return held

    def around(self, t: float) -> dict[str, Grip]:
        """Return how friction holds the closed contacts at load parameter t; contacts that change there, as before.

        Raises
        ------
        UnknownFrictionError
            If no equilibrium is found where a stick begins.
        """
        return self._around(None, t)

    def closed(self, t: float) -> set[str]:
        """Return the contacts that are closed at load parameter t, those that touch there included."""
        return {
            pair
            for pair, own in self.phases.items()
            if [phase for phase in own if phase.begin <= t + SAME][-1].slip != OPEN
        }

    def begin(self, pair: str, number: int) -> Begin:
        """Return where a phase of a contact begins; not for the first phase, nor for a slip-off, where a part has no length.

        Raises
        ------
        UnknownFrictionError
            If no beginning is found.
        """
        if (pair, number) not in self._begins:
            if (pair, number) in self._sought:
                raise UnknownFrictionError(
                    f"the changes of {pair} and of another contact depend on each other"
                )
            self._sought.add((pair, number))
            try:
                self._begins[pair, number] = self._found(self.specs[pair], number)
            finally:
                self._sought.discard((pair, number))
        return self._begins[pair, number]

    def grip(self, spec: ContactSpec, number: int, until: float) -> Grip:
        """Return how friction holds a contact in a closed phase, up to a load parameter in it.

        Raises
        ------
        UnknownFrictionError
            If no equilibrium is found where a stick begins, or in it, or a slip has no known sign.
        """
        slip = self.phases[spec.pair][number].slip
        if slip == UNKNOWN:
            slip = self._sign(spec, number)
        if slip:
            return Grip(friction=spec.friction, slip=slip)
        own = spec.pair, number
        if own not in self._holds:
            if number == 0:
                begin = at_rest(self.scene, spec)
            else:
                solution = self.begin(*own).solution
                begin = place(solution, solution.layout.touch(spec.pair))
            self._holds[own] = self._reached[own] = begin
        if spec.surface == "face" or self.scene.radius(spec):
            for first, last in pairwise(self._cuts):
                if self.phases[spec.pair][number].begin <= first + SAME and first < until - SAME:
                    self._roll(own, first, last)
        return Grip(friction=spec.friction, slip=0, hold=self._holds[own])

    def _roll(self, own: tuple[str, int], first: float, last: float) -> None:
        """Follow the contacts that stick between two neighbouring changes, as far as this has not been done."""
        if (*own, first) in self._followed:
            return
        middle = (first + last) / 2.0
        grips = self._around(None, middle, until=first)
        sticking = {pair: (pair, self._number(pair, middle)) for pair, grip in grips.items() if not grip.slip}
        begins = {pair: self._reached[item] for pair, item in sticking.items()}
        begin = max(item.load_parameter for item in begins.values())
        if begin >= last:
            return
        closed = self.closed(middle)
        began = [self._begins[item].solution for item in sticking.values() if item in self._begins]
        began = [item for item in began if closed_pairs(item).keys() == closed]
        # a stick is followed from its begin: at the load parameters of the answer it may have no equilibrium
        near = (
            max(began, key=lambda item: item.layout.load_parameter)
            if began
            else self.near(middle, closed, grips)
        )
        rolled = roll(self.scene, near, (begin, last), grips, begins)
        if rolled is None:
            raise UnknownFrictionError(f"no equilibria in stick were found up to load parameter {last:.6g}")
        for pair, item in sticking.items():
            self._holds[item], self._reached[item] = rolled[0][pair], rolled[1][pair]
            self._followed.add((*item, first))

    def _sign(self, spec: ContactSpec, number: int) -> int:
        """Sign of a slip between two load parameters: of the force where it begins, or of the slip that ends where it does."""
        own = self.phases[spec.pair]
        if number and own[number - 1].slip == 0:
            solution = self.begin(spec.pair, number).solution
            return 1 if touching(solution, solution.layout.touch(spec.pair)).drag > 0.0 else -1
        if number + 1 < len(own) and own[number + 1].slip == 0:
            return self.begin(spec.pair, number + 1).solution.layout.grips[spec.pair].slip
        raise UnknownFrictionError(
            f"{spec.pair} slips between two load parameters, and its sign is not stated"
        )

    def _found(self, spec: ContactSpec, number: int) -> Begin:
        """Find the root of a phase's margin, in each state that the contact may have been in before."""
        before, phase = self.phases[spec.pair][number - 1 : number + 1]
        if before.slip == OPEN:
            return self._root(spec, number, LOOSE)
        if math.isnan(phase.stated) and before.slip == -phase.slip != 0:
            raise UnknownFrictionError(
                f"the slip of {spec.pair} turns between two load parameters, and a stick in between is not stated"
            )
        if before.slip != UNKNOWN or (number > 1 and self.phases[spec.pair][number - 2].slip == 0):
            return self._root(spec, number, self.grip(spec, number - 1, phase.begin))
        found, reasons = [], []
        for sign in (1, -1):
            own = Grip(friction=spec.friction, slip=sign)
            try:
                begin = self._root(spec, number, own)
                found.append((self._unlike(spec, number, own, begin), begin))
            except UnknownFrictionError as error:
                reasons.append(error)
        if not found:
            raise reasons[0]
        # at a corner of a pin's path, and where another contact changes, a slip of either sign can end
        return min(found, key=lambda item: item[0])[1]

    def _unlike(self, spec: ContactSpec, number: int, own: Grip, begin: Begin) -> tuple[bool, float, float]:
        """How unlikely it is that the slip `own` ends where a phase begins: a slip rate of the other sign, and distances from the stated place."""
        phase = self.phases[spec.pair][number]
        off = abs(closed_pairs(begin.solution)[spec.pair] - self.stated_arc(spec.pair, number))
        slipped = self._slipped(spec, number, own, begin)
        return not slipped, 0.0 if math.isnan(off) else off, abs(begin.load_parameter - phase.begin)

    def stated_arc(self, pair: str, number: int) -> float:
        """Return the arc position that the answer states where a phase of a contact begins; nan without an event."""
        stated = self.phases[pair][number].stated
        arcs = [
            event.arc_position
            for event in self.response.events or ()
            if event.pair == pair and event.load_parameter == stated and event.kind != PASSES
        ]
        return arcs[-1] if arcs else math.nan

    def _slipped(self, spec: ContactSpec, number: int, own: Grip, begin: Begin) -> bool:
        """Whether the slip rate before the beginning of a phase has the sign of the slip `own`, where the same contacts are closed there."""
        before = self.phases[spec.pair][number - 1].begin
        t = begin.load_parameter - _BEFORE * (begin.load_parameter - before)
        if self.closed(t) != closed_pairs(begin.solution).keys():
            return True
        state = {**self._around(spec, t), spec.pair: own}
        now = reach(self.scene, begin.solution, t, state)
        if now.status is not SearchStatus.FOUND:
            return False
        return own.slip * slip_rate(now, now.layout.touch(spec.pair), rates(self.scene, now)) > 0.0

    def _root(self, spec: ContactSpec, number: int, own: Grip) -> Begin:
        """Find the load parameter at which the state `own` of a contact ends."""
        phase = self.phases[spec.pair][number]
        around = self._around(spec, phase.begin)
        state = {**around, spec.pair: own}
        now = self._start(spec, number, state)

        def margin(t: float) -> float:
            nonlocal now
            now = reach(self.scene, now, t, state)
            if now.status is not SearchStatus.FOUND:
                raise UnknownFrictionError(
                    f"no equilibrium was found where {spec.pair} {_does(phase)} at {t:.6g}"
                )
            return _margin(self.scene, now, spec, own, opens=phase.slip == OPEN)

        if self._jumps(spec, phase.begin):
            margin(phase.begin)
            return Begin(load_parameter=phase.begin, solution=now)
        if math.isfinite(phase.stated):
            begin = _secant(margin, phase)
        elif own.friction and own.slip and self._jumps(spec, phase.low) and margin(phase.low) < 0.0:
            begin = (
                phase.low
            )  # the slip rate changes its sign by a jump, and the margin has the rate behind it
        else:
            begin = _bisected(margin, phase, spec.pair)
        return Begin(load_parameter=begin, solution=now)

    def _start(self, spec: ContactSpec, number: int, state: dict[str, Grip]) -> Solution:
        """Return an equilibrium from which the beginning of a phase is sought, in the state before: near an answer, or where that state began."""
        phase = self.phases[spec.pair][number]
        t, found = phase.begin, None
        closed = self.closed(t) | {spec.pair}
        try:
            found = reach(self.scene, self.near(t, closed, state), t, state)
        except UnknownFrictionError:
            if number < 2:
                raise
        if number > 1 and (found is None or found.status is not SearchStatus.FOUND):
            began = self.begin(spec.pair, number - 1).solution
            found = reach(self.scene, began, t, state) if closed == closed_pairs(began).keys() else None
        if found is None or found.status is not SearchStatus.FOUND:
            raise UnknownFrictionError(
                f"no equilibrium was found where {spec.pair} {_does(phase)} at {t:.6g}"
            )
        return found

    def _jumps(self, spec: ContactSpec, t: float) -> bool:
        """Whether rates jump at load parameter t: at a corner of a pin's path, at the end of a stage, and where another contact changes."""
        others = [phase.stated for pair, own in self.phases.items() if pair != spec.pair for phase in own[1:]]
        return any(abs(t - other) <= SAME for other in (*corners(self.scene), *others))

    def _number(self, pair: str, t: float) -> int:
        """Number of the phase of a contact at a load parameter; the later one where it changes."""
        return max((n for n, phase in enumerate(self.phases[pair]) if phase.begin <= t + SAME), default=0)

    def _around(self, spec: ContactSpec | None, t: float, until: float | None = None) -> dict[str, Grip]:
        """How friction holds the other closed contacts up to load parameter t; `LOOSE` if they touch there. Sticks are followed `until` there."""
        held, until = {}, t if until is None else until
        for pair, other in self.specs.items():
            if other is spec or not other.friction:
                continue
            number = self._number(pair, t)
            now = self.phases[pair][number]
            if number and abs(now.begin - t) <= SAME and now.slip != OPEN:
                before = self.phases[pair][number - 1]
                held[pair] = LOOSE if before.slip == OPEN else self.grip(other, number - 1, until)
            elif now.slip != OPEN:
                held[pair] = self.grip(other, number, until)
        return held

    def near(self, t: float, closed: set[str], state: dict[str, Grip]) -> Solution:
        """Return an equilibrium with given contacts and state, at a load parameter of the answer that is near t.

        Raises
        ------
        UnknownFrictionError
            If none is found.
        """
        times = self.response.load_parameter
        after = int(np.searchsorted(times, t))
        for k in (after - 1, after, after + 1):
            if not 0 <= k < len(times):
                continue
            answer = answer_state(self.response, self.scene, k)
            if closed <= answer.arcs.keys():
                kept = {pair: arc for pair, arc in answer.arcs.items() if pair in closed}
                # far from t there may be no equilibrium in this state, while frictionless contacts lead to t
                loose = dict.fromkeys(state, LOOSE)
                for first in (state, loose):
                    found = solve(self.scene, replace(answer, arcs=kept, grips=first))
                    if first is loose and found.status is SearchStatus.FOUND:
                        found = reach(self.scene, found, t, loose)
                        if found.status is SearchStatus.FOUND:
                            found = reach(self.scene, found, t, state)
                    if found.status is SearchStatus.FOUND:
                        return found
        raise UnknownFrictionError(
            f"no equilibrium near load parameter {t:.6g} was found in the contacts there"
        )


def _does(phase: Phase) -> str:
    return {0: "sticks", OPEN: "opens"}.get(phase.slip, "slips")


def at_rest(scene: Scene, spec: ContactSpec) -> Hold:
    """The place of a contact with the undeformed beam."""
    beam = scene.beam(spec.beam)
    x, y = beam.direction
    there = scene.place(spec.node) if "." in spec.node else scene.pin(spec.node).position(0.0)
    left, steep = 1.0 if spec.side == "left" else -1.0, face_slope(scene, spec)
    arc = _foot(beam, there)
    for _ in range(_FEET if steep else 0):
        apart = np.array(there) - np.array(beam.place(arc / beam.length))
        ahead = float(apart @ beam.tangent(arc / beam.length)) + steep * touching_distance(scene, spec, arc)
        arc = min(max(arc + ahead, 0.0), beam.length)
    angle, tilt = math.atan2(y, x), left * math.asin(steep)
    lever = left * (scene.radius(spec) - touching_distance(scene, spec, arc))
    return Hold(
        load_parameter=0.0,
        arc_position=arc,
        stretch=math.sqrt(1.0 - steep**2) + lever * beam.curvature,
        shear=angle - beam.turn / 2.0 + tilt,
        direction=angle + beam.turn * (arc / beam.length - 0.5) + tilt,
    )


def _foot(beam: BeamSpec, point: tuple[float, float]) -> float:
    """Arc position of the point of the undeformed axis that is nearest to `point`."""
    x, y = beam.direction
    if not beam.turn:
        return float(np.clip((np.array(point) - np.array(beam.start)) @ np.array([x, y]), 0.0, beam.length))
    _, fraction = signed_gap(beam, "left", 0.0, point)
    return float(np.clip(fraction, 0.0, 1.0)) * beam.length


def _margin(scene: Scene, now: Solution, spec: ContactSpec, own: Grip, *, opens: bool) -> float:
    """A dimensionless number that is zero where a state ends: push at a touch or release, slip rate in slip, distance from the cone in stick."""
    touch = now.layout.touch(spec.pair)
    if own.friction and own.slip and not opens:
        rate = rates(scene, now)
        return own.slip * slip_rate(now, touch, rate) / speed(scene, now, rate)
    contact = touching(now, touch)
    if opens or not own.friction:
        return contact.push / now.layout.force
    return (own.friction * contact.push - abs(contact.drag)) / now.layout.force


def _secant(margin: Callable[[float], float], phase: Phase) -> float:
    """Root of a margin near a stated load parameter; the margin is evaluated there last."""
    low, high = max(0.0, 2.0 * phase.low - phase.high), 2.0 * phase.high - phase.low
    first, value = phase.stated, margin(phase.stated)
    if abs(value) <= _ZERO:
        return first
    second = first + _FIRST * (phase.high - phase.low)
    for _ in range(_ITERATIONS):
        other = margin(second)
        if abs(other) <= _ZERO or abs(second - first) <= _CLOSE or other == value:
            return second
        ahead = second - other * (second - first) / (other - value)
        if not low <= ahead <= high:
            break
        first, value, second = second, other, ahead
    raise UnknownFrictionError(f"no change of a contact was found near load parameter {phase.stated:.6g}")


def _bisected(margin: Callable[[float], float], phase: Phase, pair: str) -> float:
    """Root of a margin between two load parameters."""
    from scipy.optimize import brentq

    low, high = max(phase.low, 1e-3 * phase.high), phase.high
    at_low, at_high = margin(low), margin(high)
    if at_low * at_high > 0.0:
        raise UnknownFrictionError(
            f"{pair} {_does(phase)} from between load parameters {phase.low:.6g} and {phase.high:.6g}, where it does not begin to",
            wrong=True,
        )
    found = float(brentq(margin, low, high, xtol=_CLOSE))
    margin(found)
    return found

"""A Reissner rod under a pin that moves along a path, without or with Coulomb friction, with all changes of state.

The clamp is at the origin and the undeformed rod lies along +x. A pin below it pushes to +y. Steps end at the first event. The answer
depends on history only through the place at which a stick began, so that it does not depend on the steps. Where a contact begins, where
the path of the pin turns and where a phase ends, the state that follows is the one whose forces and slip have admissible rates.
"""

from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq

from comparisons.exact.contact import Cantilever, Linear, Phase, Real
from comparisons.exact.path import Change, Outcome, RodPath, Row, collected, require, vertices
from comparisons.exact.section import Flexibility, rule

_GAUSS, _WEIGHTS = rule(8)
_FEWER = [0, 1, 3, 4, 6, 7]
_DIFFERENCE = _WEIGHTS.copy()
_DIFFERENCE[_FEWER] -= np.linalg.solve(np.vander(_GAUSS[_FEWER], increasing=True).T, 1.0 / np.arange(1, 7))
"""Weights of the difference between eight points, of degree 15, and six of them, of degree 5."""
_ALLOWED_FLOW, _ALLOWED_AREA = 1e-6, 1e-11
"""Differences of work and dissipation, and of c in a stick."""
_SAME, _SWEEPS = 1e-15, 20
"""Largest change of c in the last of so many sweeps at most."""
_TOGETHER, _AT_ONCE, _EDGE, _STIFF = 1e-9, 1e-14, 1e-12, 2e-17
"""Load parameters nearer than the first are one event (a pin that leaves square to the rod ends its slip where it leaves), nearer
than the second are one; a margin within the third, or the fourth over the flexibility, up to the first, is at its edge."""
_TOUCH = 1e-12
"""Distance, in lengths of the rod, below which the pin touches."""
_FIRST_STEP, _SMALLEST_STEP = 0.05, 1e-11
_MOST_ITERATIONS = 3000
"""On a straight piece without friction; more are spent near a place without equilibrium."""
_SAME_DIRECTION = 1e-9
_NO_RATE, _SHORT_STEP = 1e-9, 1e-5
"""A rate below the first is zero; the next order shows after the second, in load parameters."""
_STATES = {1: Outcome.SLIP_TO_TIP, -1: Outcome.SLIP_TO_CLAMP, 0: Outcome.STICK}
_ENDINGS = (None, Outcome.OPEN, Outcome.SLIPPED)
"""States after a phase by the margin that ends it, None where friction decides; of two at one load parameter the later one counts."""


class Node(NamedTuple):
    """Equilibrium at a load parameter, with the rates of its unknowns (4,), margins (3,), and rates of work and dissipation (2,).

    The margins are positive while a phase lasts: slip rate or distance from the cone, normal force, rest of the rod.
    """

    t: float
    linear: Linear
    rates: Real
    margins: Real
    flow: Real


class Follower:
    """A contact that is followed along the straight pieces of the path of a pin, whose start has been checked."""

    def __init__(self, rod: Cantilever, place: Real) -> None:
        x, height = place[0], place[1] + rod.reach
        if (height > _TOUCH and x <= 1.0 + _TOUCH) or (height >= -_TOUCH and x <= 0.0):
            raise ValueError(
                f"points[0] = {place} length: the path must start below the rod, on its surface or beyond its tip"
            )
        touches = not rod.friction and height >= -_TOUCH and x <= 1.0 + _TOUCH
        self.rod, self.state = rod, Outcome.CONTACT if touches else Outcome.OPEN
        self.t, self.z, self.phase = 0.0, np.array([0.0, 0.0, 0.0, x]), Phase(1, 0.0)
        self.edge = max(_EDGE, min(_STIFF / (rod.flexibility.stretch or 1.0), _TOGETHER))
        self.energies = np.zeros(2)
        self.changes: list[Change] = []
        self.iterations = 0
        self.start, self.begin, self.velocity = place, 0.0, np.zeros(2)

    def follow(self, pins: Real, t: Real) -> Iterator[Row]:
        """Yield the equilibria at the vertices (s, 2) of a path, whose load parameters are t (s,)."""
        for (start, end), (begin, finish) in zip(pairwise(pins), pairwise(t), strict=True):
            if finish > begin:
                way, before = (end - start) / (finish - begin), self.velocity
                turns = np.linalg.norm(way - before) > _SAME_DIRECTION * np.linalg.norm(before)
                self.start, self.begin, self.velocity = start, begin, way
                if self.rod.friction:
                    if not self.state.touches and self._touching(finish) == self.t:
                        self._touch(self.t)
                    elif self.state.touches and turns:
                        self._turn()
            yield self._row()
            self._along(finish)
        yield self._row()

    def _row(self) -> Row:
        return Row(self.t, self.state, self.z, self.energies, self.iterations)

    def _pin(self, t: float) -> Real:
        """Position of the pin."""
        return np.asarray(self.start + (t - self.begin) * self.velocity)

    def _along(self, finish: float) -> None:
        """Follow the contact to the end of a piece."""
        step, growth, before = _FIRST_STEP, 2.0, self.iterations
        while finish - self.t > _AT_ONCE and not self.state.ends:
            if not self.state.touches:
                t = self._touching(finish)
                if t is not None:
                    self._touch(t)
                    continue
                if self.state is Outcome.SLIPPED and -self._pin(finish)[1] - self.rod.reach > _TOUCH:
                    self.state = Outcome.OPEN
                break
            end = finish if finish - self.t <= 1.001 * step else self.t + step
            if self._taken(end):
                step, growth = growth * step, 2.0
                continue
            step, growth = (end - self.t) / 3.0, 1.0
            many = not self.rod.friction and self.iterations - before > _MOST_ITERATIONS
            if step < _SMALLEST_STEP or many:
                self._change(Outcome.LOST)
        self.t = finish

    def _touching(self, finish: float) -> float | None:
        """Load parameter at which the pin touches the straight rod up to the end of a piece; None if it does not."""
        gaps = [-self._pin(t)[1] - self.rod.reach for t in (self.t, finish)]
        resting = self.state is Outcome.OPEN and abs(gaps[0]) <= _TOUCH and gaps[1] < -_TOUCH
        if not resting and (gaps[0] <= _TOUCH or gaps[1] > _TOUCH):
            return None
        share = 0.0 if resting else min(gaps[0] / (gaps[0] - gaps[1]), 1.0)
        t = self.t + share * (finish - self.t)
        beside = not 0.0 < self._pin(t)[0] <= 1.0 + _TOUCH
        return None if beside or (t >= finish and self.rod.friction) else t

    def _touch(self, t: float) -> None:
        """Begin a contact."""
        self.t, self.z = t, np.array([0.0, 0.0, 0.0, min(float(self._pin(t)[0]), 1.0)])
        if self.rod.friction:
            self._decide((0, 1, -1))
        else:
            self._enter([1])

    def _turn(self) -> None:
        """Pass a corner of the pin's path; on the edge of the cone a slip goes on or begins, or the pin sticks."""
        here = self._linear().here
        edge = self.phase.sense or int(np.sign(here.tangential))
        if self.rod.friction * here.normal - edge * here.tangential <= self.edge:
            self._decide((edge, 0))

    def _decide(self, senses: Iterable[int]) -> None:
        """Enter the only state whose rates are admissible; at a touch they raise the normal force, too."""
        touch, possible = not self.state.touches, []
        for sense in senses:
            linear = self._linear(sense)
            rates = linear.rates(self.velocity, stick=not sense)
            if rates is None or (touch and linear.slope.normal @ rates <= 0.0):
                continue
            drag = linear.slope.tangential @ rates
            margin = float(sense * linear.slip @ rates)
            if not sense:
                beyond = abs(drag) if touch else np.sign(linear.here.tangential) * drag
                margin = float(self.rod.friction * linear.slope.normal @ rates - beyond)
            if touch and abs(margin) < _NO_RATE * np.linalg.norm(self.velocity):
                soon = self._node(Phase(sense, self.t, linear), self.t + _SHORT_STEP, self.z)
                margin = -1.0 if soon is None else float(soon.margins[0])
            if margin > 0.0:
                possible.append(sense)
        self._enter(possible)

    def _enter(self, possible: list[int]) -> None:
        """Enter the only possible state."""
        if len(possible) != 1:
            self._change(Outcome.JAMMED)
        elif not self.state.touches or possible[0] != self.phase.sense:
            self.phase = Phase(possible[0], self.t, self._linear())
            self._change(_STATES[possible[0]] if self.rod.friction else Outcome.CONTACT)

    def _linear(self, sense: int = 1) -> Linear:
        """Equations at the present state, of a phase that begins here."""
        return self.rod.linearise(self.z, self._pin(self.t), Phase(sense, self.t), self.t)

    def _change(self, state: Outcome) -> None:
        """Change the state, with the event."""
        self.changes.append((self.t, self.state, state, self.z))
        self.state = state

    def _taken(self, end: float) -> bool:
        """Take a step up to a load parameter or the first event before it; false where the step must be shorter."""
        start = self._node(self.phase, self.t, self.z)
        if start is None or (swept := self._sweep(self.phase, start, end)) is None:
            return False
        (phase, nodes), ending = swept, None
        for before, after in pairwise([start, *nodes]):
            if np.any(after.margins < -self.edge):
                if (event := self._event(phase, start, before, after)) is None:
                    return False
                t, ending = event
                own = [] if t - start.t < _AT_ONCE else self._nodes(phase, start, t)
                if own is None:
                    return False
                nodes = own
                break
        if self.rod.friction and nodes:
            flow = (nodes[-1].t - start.t) * np.array([each.flow for each in nodes[:-1]])
            if np.any(np.abs(_DIFFERENCE @ flow) > _ALLOWED_FLOW):
                return False
            self.energies = self.energies + _WEIGHTS @ flow
        node = [start, *nodes][-1]
        self.t, self.z, self.phase = node.t, node.linear.z, Phase(phase.sense, phase.since, node.linear)
        if ending is not None:
            self._end(_ENDINGS[ending])
        return True

    def _end(self, after: Outcome | None) -> None:
        """Enter the state after the end of a phase."""
        if after is not None:
            self._change(after)
        elif self.phase.sense:
            self._enter([0])
        else:
            self._decide((int(np.sign(self._linear().here.tangential)),))

    def _node(self, phase: Phase, t: float, guess: Real) -> Node | None:
        """Equilibrium at a load parameter from nearby unknowns; None without convergence."""
        linear, count = self.rod.solve(guess, self._pin(t), phase, t)
        self.iterations += count
        if linear is None or (rates := linear.rates(self.velocity, stick=not phase.sense)) is None:
            return None
        tangential, normal = float(linear.here.tangential), float(linear.here.normal)
        slip = float(linear.slip @ rates) if phase.sense else 0.0
        first = phase.sense * slip if phase.sense else self.rod.friction * normal - abs(tangential)
        margins = np.array([first if self.rod.friction else 1.0, normal, 1.0 - linear.z[3]])
        flow = np.array([linear.z[:2] @ self.velocity, tangential * slip])
        return Node(t, linear, rates, margins, flow)

    def _sweep(self, phase: Phase, start: Node, end: float) -> tuple[Phase, list[Node]] | None:
        """Phase with c of its stick in a step, and the nodes of the step; None where the step must be shorter."""
        for _ in range(_SWEEPS):
            nodes = self._nodes(phase, start, end)
            if nodes is None or phase.sense:
                return None if nodes is None else (phase, nodes)
            times, creep = np.array([(node.t, node.linear.matrix[3] @ node.rates) for node in nodes]).T
            if abs(_DIFFERENCE @ creep[:-1]) * (end - start.t) > _ALLOWED_AREA:
                return None
            area = Polynomial.fit(times[:-1], creep[:-1], len(_GAUSS) - 1).integ(lbnd=start.t)
            if np.max(np.abs(area(times) - phase.area(times))) < _SAME:
                return phase, nodes
            phase = phase._replace(area=area)
        return None

    def _nodes(self, phase: Phase, start: Node, end: float) -> list[Node] | None:
        """Equilibria at the Gauss points of a step, unless there is no friction, and at its end."""
        nodes = [start]
        for t in (*(start.t + (end - start.t) * _GAUSS if self.rod.friction else ()), end):
            guess = start.linear.z + (t - start.t) * start.rates
            if len(nodes) > 1:
                ends = ((node.t, node.linear.z, node.rates) for node in nodes[-2:])
                guess = CubicHermiteSpline(*zip(*ends, strict=True))(t)
            node = self._node(phase, float(t), guess)
            if node is None:
                return None
            nodes.append(node)
        return nodes[1:]

    def _event(self, phase: Phase, start: Node, before: Node, after: Node) -> tuple[float, int] | None:
        """First root of a margin between two equilibria of a step, and which; None where the first one is an event itself."""

        def margin(t: float, k: int) -> float:
            share = (t - before.t) / (after.t - before.t)
            node = self._node(phase, t, before.linear.z + share * (after.linear.z - before.linear.z))
            return float(node.margins[k]) + self.edge - _EDGE if node is not None else np.nan

        roots = list[tuple[float, int]]()
        for ending, state in enumerate(_ENDINGS):
            if after.margins[ending] >= -self.edge:
                continue
            at_edge = max(start.margins[ending], before.margins[ending]) <= self.edge
            has_lasted = start.t - phase.since > _TOGETHER or not self.rod.friction
            if at_edge and (state is Outcome.SLIPPED or (before is start and has_lasted)):
                return start.t, ending
            if before.margins[ending] <= self.edge:
                return None
            try:
                roots.append((float(brentq(margin, before.t, after.t, args=(ending,), xtol=1e-15)), ending))
            except ValueError:  # Newton's method fails in between
                return None
        first = min(t for t, _ in roots)
        return max((item for item in roots if item[0] <= first + _TOGETHER), key=lambda item: item[1])


def rod_under_pin(
    points: ArrayLike,
    *,
    EA: float,
    GA: float,
    EI: float,
    length: float,
    friction: float = 0.0,
    offset: float = 0.0,
    radius: float = 0.0,
) -> RodPath:
    """Equilibrium of a clamped Reissner rod under a pin at every vertex of the pin's path.

    Parameters
    ----------
    points : array_like, shape (s, 2)
        Vertices of the path of the pin's centre, joined by straight lines. The first is the start of the pin and must not be inside or
        above the rod.
    EA, GA : float
        Stretch stiffness and shear stiffness `GA_e`; `inf` is rigid.
    EI : float
        Bending stiffness.
    length : float
        Undeformed length.
    friction : float
        Coefficient of friction mu.
    offset : float
        Distance of the rod's face from its axis, half the height; zero for contact with the axis.
    radius : float
        Radius of the pin, which does not turn; zero is a sharp one.

    Returns
    -------
    RodPath

    Raises
    ------
    ValueError
        If a stiffness or the length is not positive, another number is negative, the path is not finite, or its start is not outside the
        rod.

    Examples
    --------
    >>> path = rod_under_pin([[1.0, 0.0], [0.0, 2 / np.pi]], EA=np.inf, GA=np.inf, EI=1.0, length=1.0)
    >>> round(float(path.magnitude[1]), 12), round(float(path.arc_position[1]), 12)
    (8.182128140184, 0.89572169201)
    >>> path = rod_under_pin([[1.0, 0.0], [0.0, 2 / np.pi]], EA=3e4, GA=1e4, EI=1.0, length=1.0, friction=0.3)
    >>> [event.after.value for event in path.events]
    ['slip to clamp', 'stick', 'slip to tip']
    """
    require("positive and finite", EI=EI, length=length)
    require("positive", EA=EA, GA=GA)
    require("finite and not negative", friction=friction, offset=offset, radius=radius)
    pins, t = vertices(points)
    unit = EI / length**2
    flexibility = Flexibility(stretch=unit / EA, shear=unit / GA)
    rod = Cantilever(flexibility=flexibility, face=offset / length, radius=radius / length, friction=friction)
    follower = Follower(rod, pins[0] / length)
    rows = list(follower.follow(pins / length, t))
    return collected(rod, rows, follower.changes, EI, length)

"""Steps of a contact with friction along a straight piece of the pin's path, and the first event in a step."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial
from scipy.optimize import brentq

from comparisons.exact.friction_law import Contact, Equations, Linear, Phase, Real, linearise, margins

_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_GAUSS, _WEIGHTS = (_GAUSS + 1.0) / 2.0, _WEIGHTS / 2.0
_FEWER = np.linalg.solve(np.vander(_GAUSS[[0, 1, 3, 4, 6, 7]], increasing=True).T, 1.0 / np.arange(1, 7))
_DIFFERENCE = _WEIGHTS.copy()
_DIFFERENCE[[0, 1, 3, 4, 6, 7]] -= _FEWER
"""Weights of the difference between eight points, of degree 15, and six of them, of degree 5."""
_ALLOWED_DIFFERENCE = 1e-6
_ALLOWED_AREA, _SAME_AREA, _SWEEPS = 1e-11, 1e-15, 20
"""Differences of c in a stick: of the two rules, and of two corrections, of which there are so many at most."""
_LARGEST_CORRECTION, _CONVERGED = 0.1, 3e-8
_ROUND_OFF, _NOISE = 1e-14, 1e-5
"""A residual at round-off, and the correction that it may leave where the equations are stiff."""
_TOGETHER, AT_ONCE, EDGE = 1e-9, 1e-14, 1e-12
"""Load parameters nearer than the first are one event (a pin that leaves square to the rod ends its slip where it leaves), nearer
than the second are one; a margin within the third is at its edge."""


class Ending(Enum):
    """Why a phase ends, in the order of `margins`; of two at one load parameter the later one counts."""

    FRICTION = 0
    RELEASE = 1
    SLIP_OFF = 2


class Piece(NamedTuple):
    """Straight piece of the pin's path from `start` (2,) at the load parameter `begin` with `velocity` (2,) per load parameter."""

    start: Real
    velocity: Real
    begin: float

    def pin(self, t: float) -> Real:
        """Position of the pin."""
        return self.start + (t - self.begin) * self.velocity


@dataclass(frozen=True, kw_only=True)
class Problem:
    """Equations and coefficient of friction."""

    equations: Equations
    friction: float

    def solve(self, z: Real, pin: Real, phase: Phase) -> tuple[Real, Linear] | None:
        """Unknowns at a position of the pin from nearby ones by Newton's method; None without convergence."""
        last = _LARGEST_CORRECTION
        for _ in range(14):
            linear = linearise(self.equations, z, pin, phase, self.friction)
            if not (self.equations.exists(z) and np.all(np.isfinite(linear.tangent))):
                return None
            try:
                change = np.linalg.solve(linear.tangent, -linear.residual)
            except np.linalg.LinAlgError:
                return None
            size = float(np.max(np.abs(change) / (1.0 + np.abs(z))))
            at_round_off = np.max(np.abs(linear.residual)) < _ROUND_OFF
            if size < (_NOISE if at_round_off else _CONVERGED):
                z = z + change
                return z, linearise(self.equations, z, pin, phase, self.friction)
            if not size <= last:
                return None
            z, last = z + change, size / 2.0
        return None


class Node(NamedTuple):
    """Equilibrium at a load parameter: unknowns (n,), rates (n,), margins (3,), power of the pin, dissipation, contact, and dc/dt of a stick."""

    t: float
    z: Real
    rates: Real
    margins: Real
    power: float
    dissipation: float
    contact: Contact
    creep: float


class Step(NamedTuple):
    """Equilibrium at the end of a step, work and dissipation in it, why the phase ends there, or None, and the phase from there on."""

    node: Node
    work: float
    dissipated: float
    ending: Ending | None
    phase: Phase


def node_at(problem: Problem, piece: Piece, phase: Phase, t: float, guess: Real) -> Node | None:
    """Equilibrium at a load parameter from nearby unknowns; None without convergence."""
    pin = piece.pin(t)
    solution = problem.solve(guess, pin, phase.at(t))
    if solution is None:
        return None
    z, linear = solution
    contact, row = linear.contact, linear.tangent[-1]
    if not phase.sense:
        here = replace(phase, start=contact)
        linear = linearise(problem.equations, z, pin, here, problem.friction)
    rates = linear.rates(piece.velocity)
    dissipation = float(contact.tangential * (linear.slip @ rates)) if phase.sense else 0.0
    return Node(
        t,
        z,
        rates,
        margins(linear, rates, phase, problem.friction),
        float(contact.force @ piece.velocity),
        dissipation,
        contact,
        0.0 if phase.sense else float(row @ rates),
    )


def take(problem: Problem, piece: Piece, phase: Phase, start: Node, end: float) -> Step | None:
    """Take a step up to a load parameter or the first event before it; None where the step must be shorter."""
    rolled = _rolled(problem, piece, phase, start, end)
    if rolled is None:
        return None
    phase, nodes = rolled
    before = start
    for node in nodes:
        if np.any(node.margins < -EDGE):
            return _up_to_event(problem, piece, phase, start, (before, node))
        before = node
    return _integrate(start, nodes, None, phase)


def _rolled(
    problem: Problem, piece: Piece, phase: Phase, start: Node, end: float
) -> tuple[Phase, list[Node]] | None:
    """Return the phase with c of its stick in a step, and the nodes of the step; None where the step must be shorter."""
    for _ in range(_SWEEPS):
        nodes = _nodes(problem, piece, phase, start, end)
        if nodes is None:
            return None
        times, creep = np.array([node.t for node in nodes]), np.array([node.creep for node in nodes[:-1]])
        if abs(_DIFFERENCE @ creep) * (end - start.t) > _ALLOWED_AREA:
            return None
        area = Polynomial.fit(times[:-1], creep, len(creep) - 1).integ(lbnd=start.t)
        if np.max(np.abs(area(times) - phase.area(times))) < _SAME_AREA:
            return phase, nodes
        phase = replace(phase, area=area)
    return None


def _nodes(problem: Problem, piece: Piece, phase: Phase, start: Node, end: float) -> list[Node] | None:
    """Equilibria at the Gauss points of a step and at its end."""
    nodes = [start]
    for t in (*(start.t + (end - start.t) * _GAUSS).tolist(), end):
        node = node_at(problem, piece, phase, t, _extrapolate(nodes[-2:], t))
        if node is None:
            return None
        nodes.append(node)
    return nodes[1:]


def _extrapolate(nodes: list[Node], t: float) -> Real:
    """Unknowns beyond one node by their rates, or beyond two nodes by the cubic through both with their rates."""
    last = nodes[-1]
    linear = last.z + (t - last.t) * last.rates
    if len(nodes) < 2:
        return linear
    width, ahead = last.t - nodes[0].t, (t - last.t) / (last.t - nodes[0].t)
    slope = (last.z - nodes[0].z) / width
    curvature = 2.0 * last.rates + nodes[0].rates - 3.0 * slope
    return np.asarray(
        linear + width * ahead**2 * (curvature + (1.0 + ahead) * (curvature - last.rates + slope))
    )


def _integrate(start: Node, nodes: list[Node], ending: Ending | None, phase: Phase) -> Step | None:
    """Work and dissipation of a step; None where the step is too long for them."""
    length = nodes[-1].t - start.t
    values = np.array([[node.power, node.dissipation] for node in nodes[:-1]])
    if np.max(np.abs(_DIFFERENCE @ values)) * length > _ALLOWED_DIFFERENCE:
        return None
    work, dissipated = length * (_WEIGHTS @ values)
    return Step(nodes[-1], float(work), float(dissipated), ending, _held(phase, nodes[-1]))


def _held(phase: Phase, node: Node) -> Phase:
    """Phase whose stick is held in its place at a node."""
    return phase if phase.sense else Phase(sense=0, since=phase.since, start=node.contact)


def _up_to_event(
    problem: Problem, piece: Piece, phase: Phase, start: Node, bracket: tuple[Node, Node]
) -> Step | None:
    """Step up to the first root of a margin between two equilibria; None where the first one is an event itself."""
    before, after = bracket

    def at(t: float) -> Node | None:
        share = (t - before.t) / (after.t - before.t)
        return node_at(problem, piece, phase, t, before.z + share * (after.z - before.z))

    roots: list[tuple[float, Ending]] = []
    for ending in Ending:
        k = ending.value
        if after.margins[k] >= -EDGE:
            continue
        goes_on = start.t - phase.since > _TOGETHER or ending is Ending.SLIP_OFF
        if before is start and start.margins[k] <= EDGE and goes_on:
            return Step(start, 0.0, 0.0, ending, _held(phase, start))
        if before.margins[k] <= EDGE:
            return None
        root = _root(at, k, bracket)
        if root is None:
            return None
        roots.append((root, ending))
    first = min(t for t, _ in roots)
    t, ending = max((item for item in roots if item[0] <= first + _TOGETHER), key=lambda item: item[1].value)
    if t - start.t < AT_ONCE:
        return Step(start, 0.0, 0.0, ending, _held(phase, start))
    nodes = _nodes(problem, piece, phase, start, t)
    return None if nodes is None else _integrate(start, nodes, ending, phase)


def _root(at: Callable[[float], Node | None], k: int, bracket: tuple[Node, Node]) -> float | None:
    """Load parameter at which a margin vanishes; None where Newton's method fails."""

    def margin(t: float) -> float:
        node = at(t)
        return float(node.margins[k]) if node is not None else np.nan

    try:
        return float(brentq(margin, bracket[0].t, bracket[1].t, xtol=1e-15))
    except ValueError:
        return None

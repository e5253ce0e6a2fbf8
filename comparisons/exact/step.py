"""Steps of a contact along a straight piece of the pin's path, and the first event in a step."""

from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial
from scipy.optimize import brentq

from comparisons.exact.contact import Cantilever, Held, Phase, Real
from comparisons.exact.section import rule

_GAUSS, _WEIGHTS = rule(8)
_FEWER = [0, 1, 3, 4, 6, 7]
_DIFFERENCE = _WEIGHTS.copy()
_DIFFERENCE[_FEWER] -= np.linalg.solve(np.vander(_GAUSS[_FEWER], increasing=True).T, 1.0 / np.arange(1, 7))
"""Weights of the difference between eight points, of degree 15, and six of them, of degree 5."""
_ALLOWED_FLOW, _ALLOWED_AREA = 1e-6, 1e-11
"""Differences of work and dissipation, and of c in a stick."""
_SAME, _SWEEPS = 1e-15, 20
"""Largest change of c in the last of so many sweeps at most."""
_TOGETHER, AT_ONCE, EDGE = 1e-9, 1e-14, 1e-12
"""Load parameters nearer than the first are one event (a pin that leaves square to the rod ends its slip where it leaves), nearer
than the second are one; a margin within the third is at its edge."""


class Ending(IntEnum):
    """Why a phase ends, in the order of the margins; of two at one load parameter the later one counts."""

    FRICTION = 0
    RELEASE = 1
    SLIP_OFF = 2


class Node(NamedTuple):
    """Equilibrium at a load parameter: unknowns and rates (4,), margins (3,), rates of work and dissipation (2,), place of a stick and dc/dt.

    The margins are positive while a phase lasts: slip rate or distance from the cone, normal force, rest of the rod.
    """

    t: float
    z: Real
    rates: Real
    margins: Real
    flow: Real
    held: Held
    creep: float


class Step(NamedTuple):
    """Equilibrium at the end of a step, work and dissipation in it, why the phase ends there, or None, and the phase from there on."""

    node: Node
    work: float
    dissipated: float
    ending: Ending | None
    phase: Phase


@dataclass(kw_only=True)
class Piece:
    """A rod and a straight piece of the pin's path: `start` (2,) at the load parameter `begin`, `velocity` (2,) per load parameter.

    `iterations` counts those of Newton's method.
    """

    rod: Cantilever
    start: Real
    velocity: Real
    begin: float
    iterations: int = 0

    def pin(self, t: float) -> Real:
        """Position of the pin."""
        return self.start + (t - self.begin) * self.velocity

    def node(self, phase: Phase, t: float, guess: Real) -> Node | None:
        """Equilibrium at a load parameter from nearby unknowns; None without convergence."""
        rod = self.rod
        linear, count = rod.solve(guess, self.pin(t), phase, t)
        self.iterations += count
        if linear is None:
            return None
        row = rod.law(linear, phase, t)[1]
        rates = linear.rates(row if phase.sense else linear.slip, self.velocity)
        if rates is None:
            return None
        z, tangential, normal = linear.z, float(linear.here.tangential), float(linear.here.normal)
        slip = float(linear.slip @ rates) if phase.sense else 0.0
        first = phase.sense * slip if phase.sense else rod.friction * normal - abs(tangential)
        return Node(
            t,
            z,
            rates,
            np.array([first if rod.friction else 1.0, normal, 1.0 - z[3]]),
            np.array([z[:2] @ self.velocity, tangential * slip]),
            linear.held,
            float(row @ rates),
        )

    def take(self, phase: Phase, start: Node, end: float) -> Step | None:
        """Take a step up to a load parameter or the first event before it; None where the step must be shorter."""
        swept = self._sweep(phase, start, end)
        if swept is None:
            return None
        phase, nodes = swept
        for before, node in zip([start, *nodes], nodes, strict=False):
            if np.any(node.margins < -EDGE):
                return self._up_to_event(phase, start, before, node)
        return self._integrate(start, nodes, None, phase)

    def _sweep(self, phase: Phase, start: Node, end: float) -> tuple[Phase, list[Node]] | None:
        """Phase with c of its stick in a step, and the nodes of the step; None where the step must be shorter."""
        for _ in range(_SWEEPS):
            nodes = self._nodes(phase, start, end)
            if nodes is None or phase.sense:
                return None if nodes is None else (phase, nodes)
            times, creep = np.array([(node.t, node.creep) for node in nodes]).T
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
            node = self.node(phase, float(t), _extrapolate(nodes[-2:], t))
            if node is None:
                return None
            nodes.append(node)
        return nodes[1:]

    def _integrate(self, start: Node, nodes: list[Node], ending: Ending | None, phase: Phase) -> Step | None:
        """Step with its work and dissipation; None where it is too long for them."""
        node, length = nodes[-1], nodes[-1].t - start.t
        if not self.rod.friction:
            return Step(node, 0.0, 0.0, ending, _held(phase, node))
        flow = length * np.array([each.flow for each in nodes[:-1]])
        if np.any(np.abs(_DIFFERENCE @ flow) > _ALLOWED_FLOW):
            return None
        work, dissipated = _WEIGHTS @ flow
        return Step(node, float(work), float(dissipated), ending, _held(phase, node))

    def _up_to_event(self, phase: Phase, start: Node, before: Node, after: Node) -> Step | None:
        """Step up to the first root of a margin between two equilibria; None where the first one is an event itself."""

        def margin(t: float, k: int) -> float:
            share = (t - before.t) / (after.t - before.t)
            node = self.node(phase, t, before.z + share * (after.z - before.z))
            return float(node.margins[k]) if node is not None else np.nan

        roots: list[tuple[float, Ending]] = []
        for ending in Ending:
            if after.margins[ending] >= -EDGE:
                continue
            goes_on = start.t - phase.since > _TOGETHER or ending is Ending.SLIP_OFF or not self.rod.friction
            if before is start and start.margins[ending] <= EDGE and goes_on:
                return Step(start, 0.0, 0.0, ending, _held(phase, start))
            if before.margins[ending] <= EDGE:
                return None
            try:
                roots.append((float(brentq(margin, before.t, after.t, args=(ending,), xtol=1e-15)), ending))
            except ValueError:  # Newton's method fails in between
                return None
        first = min(t for t, _ in roots)
        t, ending = max((item for item in roots if item[0] <= first + _TOGETHER), key=lambda item: item[1])
        if t - start.t < AT_ONCE:
            return Step(start, 0.0, 0.0, ending, _held(phase, start))
        nodes = self._nodes(phase, start, t)
        return None if nodes is None else self._integrate(start, nodes, ending, phase)


def _held(phase: Phase, node: Node) -> Phase:
    """Phase whose stick is held in its place at a node."""
    return Phase(phase.sense, phase.since, node.held)


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

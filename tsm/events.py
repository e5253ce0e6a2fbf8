"""Contact events between two configurations, and their exact load parameters.

============= ==============================================================================
touch         the gap of an open pair falls below zero, its node on the stated side
release       the force of a closed pair falls below zero
slip-off      the position of a closed pair leaves the beam past an end
pass-through  the owner of a closed pair changes from an element to its neighbour
slip          the force of a pair that sticks reaches the edge of its cone ``|F_t| <= mu F_n``
stick         the slip rate of a pair that slips falls to zero
end-contact   a node or a round pin meets an end of its beam, or the side that its contact does not have
line-contact  the curvature of the beam at a closed pair reaches the contact surface's
limit-point   the load parameter is stationary along the path
bifurcation   another branch crosses the path, which goes on unstable
============= ==============================================================================

The first three events change the set of closed contacts, slip and stick the state of a contact with friction. Each of them, and line
contact, has a margin: a number that is positive before the event and negative after it. The event is located at the root of its margin.
A pass-through does not change the set of closed contacts; its load parameter is interpolated.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np

from tsm import scales
from tsm.ends import clearance
from tsm.friction import cone, traction
from tsm.line_contact import curvature
from tsm.model import Model
from tsm.newton import Equilibrium, Newton
from tsm.projection import arc_position
from tsm.root import find_root

ROUND_OFF = 1e-10
"""Absolute margin below which a margin counts as zero."""

_DEGREE, _FINE = 4, 41
"""Degree of the polynomial through a margin, and points at which it is evaluated."""
SHORT = 2e-3
"""Length of a step within which contacts are not searched for a slip or stick that has passed at its end."""
_LOCATED = 1e-12
"""Largest margin of a located event. Results at the event may depend on its load parameter with a factor of a thousand."""
_APART = 1e-14
"""Width of the bracket of load parameters at which a margin that jumps is located."""


class EventKind(Enum):
    """Kind of a contact event."""

    TOUCH = "touch"
    RELEASE = "release"
    SLIP_OFF = "slip-off"
    PASS_THROUGH = "pass-through"
    SLIP = "slip"
    STICK = "stick"
    LINE_CONTACT = "line-contact"
    END_CONTACT = "end-contact"
    LIMIT_POINT = "limit-point"
    BIFURCATION = "bifurcation"


GRIPS = frozenset({EventKind.SLIP, EventKind.STICK})
"""Events at which a contact stays closed."""


@dataclass(frozen=True, kw_only=True)
class Event:
    """A located event; limit points and bifurcations belong to no contact.

    Attributes
    ----------
    kind : EventKind
        Kind of the event.
    load_parameter : float
        Load parameter of the event.
    pair : str
        Name of the pair.
    element : int
        Number of the owner, from 0 at the beam's start; after a pass-through, number of the new owner.
    arc_position : float
        Distance along the undeformed axis [length].
    force : float
        Contact force, before the event.
    released : float
        Potential energy (strain energy less the work of the loads) that is released in the jump after a slip-off.
    stage : int
        Number of the stage of the load, from 1. An event at the load parameter at which a stage begins belongs to that stage if it
        happens because the load goes on.
    """

    kind: EventKind
    load_parameter: float
    pair: str = ""
    element: int = -1
    arc_position: float = math.nan
    force: float = 0.0
    released: float = 0.0
    stage: int = 1


@dataclass(frozen=True, kw_only=True)
class Passage:
    """Two configurations between which a closed contact changed its owner."""

    pair: int  # number of the pair
    # t, element, arc, force: load parameters, owners, arc positions and contact forces, before and after
    t: tuple[float, float]
    element: tuple[int, int]
    arc: tuple[float, float]
    force: tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Margin:
    """A dimensionless quantity that is positive until its event happens."""

    kind: EventKind
    pair: int
    value: float


def normal_force(model: Model, equilibrium: Equilibrium, k: int) -> float:
    """Contact force of closed pair k, friction included, positive where it pushes the beam away from the node's side."""
    fx, fy = equilibrium.system.forces[k]
    touch = equilibrium.state.touches[k]
    assert touch is not None, "a closed pair has a touch"
    if touch.grip is not None:
        across = traction(model, equilibrium.state, equilibrium.system, k).normal
        return math.copysign(math.hypot(fx, fy), across)
    dx, dy = model.pairs[k].group.direction(touch, equilibrium.state.q)
    push = model.pairs[k].side * (fy * dx - fx * dy)
    size = float((fx * fx + fy * fy) ** 0.5)
    return size if push >= 0 else -size


def passed(model: Model, passage: Passage) -> list[Event]:
    """Pass-throughs of a passage, one per beam node, at linearly interpolated load parameters."""
    pair = model.pairs[passage.pair]
    (old, new), (start, end) = passage.element, passage.arc
    (t0, t1), (before, after) = passage.t, passage.force
    ahead = 1 if new > old else -1
    events = []
    for element in range(old + ahead, new + ahead, ahead):
        arc = arc_position(pair.target, element, 0.0 if ahead > 0 else 1.0)
        part = (arc - start) / (end - start) if end != start else 1.0
        events.append(
            Event(
                kind=EventKind.PASS_THROUGH,
                load_parameter=t0 + part * (t1 - t0),
                pair=pair.pair.name,
                element=element - pair.target.first,
                arc_position=arc,
                force=before + part * (after - before),
            )
        )
    return events


def passes(model: Model, before: Equilibrium, after: Equilibrium) -> list[Event]:
    """Pass-throughs of the contacts that changed their owner between two equilibria."""
    events = []
    for k, (old, new) in enumerate(zip(before.state.touches, after.state.touches, strict=True)):
        if old is None or new is None or old.element == new.element:
            continue
        first, last = (arc_position(model.pairs[k].target, touch.element, touch.xi) for touch in (old, new))
        passage = Passage(
            pair=k,
            t=(before.state.load_parameter, after.state.load_parameter),
            element=(old.element, new.element),
            arc=(first, last),
            force=(normal_force(model, before, k), normal_force(model, after, k)),
        )
        events += passed(model, passage)
    return events


def least_push(newton: Newton, k: int) -> float:
    """Tensile contact force that is round-off: of the touched beam, which may be far softer than others, unless a beam's end touches it."""
    pair = newton.model.pairs[k]
    beam, section = pair.target.beam, pair.target.beam.section
    own = max(ROUND_OFF, newton.tolerance) * section.EI / beam.length**2
    noise = scales.ROUND_OFF * section.EA * beam.elements
    return max(own, noise if pair.node < 0 else newton.noise * newton.model.least_force)


def margins(newton: Newton, equilibrium: Equilibrium, slip_rates: Mapping[int, float]) -> list[Margin]:
    """Margins of the events that may come next.

    ``newton, equilibrium``: the solution, by whose tolerance forces are measured, and an equilibrium.
    ``slip_rates``: rates of the pairs that slip, positive the way they slip; a pair without a rate is taken
    to slip on.
    """
    model, state = newton.model, equilibrium.state
    upcoming: list[Margin] = []
    for k, (pair, touch) in enumerate(zip(model.pairs, state.touches, strict=True)):
        if pair.pair.offset > 0:
            room = clearance(model, state, k).distance / model.length
            upcoming.append(Margin(kind=EventKind.END_CONTACT, pair=k, value=room))
        if touch is not None:
            arc = pair.arc_position(touch)
            inside = min(arc, pair.target.beam.length - arc) / model.length
            upcoming.append(Margin(kind=EventKind.SLIP_OFF, pair=k, value=inside))
            push = normal_force(model, equilibrium, k) * ROUND_OFF / least_push(newton, k)
            upcoming.append(Margin(kind=EventKind.RELEASE, pair=k, value=push))
            if touch.grip is not None and touch.grip.slip:
                value = slip_rates.get(k, model.length) / model.length
                upcoming.append(Margin(kind=EventKind.STICK, pair=k, value=value))
            elif touch.grip is not None and touch.grip.held is not None:
                inside = cone(model, state, equilibrium.system, k) / model.force_scale
                upcoming.append(Margin(kind=EventKind.SLIP, pair=k, value=inside))
            if pair.pair.offset > 0:
                room = 1.0 - abs(pair.reach_at(arc)) * curvature(model, equilibrium, k)
                upcoming.append(Margin(kind=EventKind.LINE_CONTACT, pair=k, value=room))
        elif state.armed[k]:
            seen = pair.group.project(pair, state)
            over = seen.overshoot <= ROUND_OFF * model.length
            upcoming.append(
                Margin(kind=EventKind.TOUCH, pair=k, value=seen.gap / model.length if over else 1.0)
            )
    return upcoming


def broken(before: list[Margin], after: list[Margin]) -> list[tuple[Margin, Margin]]:
    """Pairs of margins, before and after, of the events whose margin became negative; a node over the beam touches its surface first."""
    past = [(a, b) for a, b in zip(before, after, strict=True) if b.value < -ROUND_OFF]
    over = {a.pair for a, _ in past if a.kind is EventKind.TOUCH and a.value < 1.0}
    return [(a, b) for a, b in past if a.kind is not EventKind.END_CONTACT or a.pair not in over]


def below(values: list[float], times: list[float]) -> float | None:
    """Load parameter at which the polynomial through some values of a margin is least, if it is below zero there; else None."""
    middle, half = (times[0] + times[-1]) / 2, (times[-1] - times[0]) / 2
    places = (np.array(times) - middle) / half
    line = np.polynomial.Polynomial.fit(places, values, min(len(values) - 1, _DEGREE), domain=[-1, 1])
    fine = np.linspace(-1, 1, _FINE)
    found = np.concatenate([places, fine]), np.concatenate([values, line(fine)])
    least = int(np.argmin(found[1]))
    return float(middle + half * found[0][least]) if found[1][least] < -ROUND_OFF else None


def passed_within(measured: list[list[Margin]], times: list[float]) -> float | None:
    """First load parameter at which the margin of a slip or stick is below zero between others, from margins at all these times."""
    trails = (trail for trail in zip(*measured, strict=True) if trail[0].kind in GRIPS)
    dips = [below([margin.value for margin in trail], times) for trail in trails]
    return min((t for t in dips if t is not None), default=None)


def locate(
    before: tuple[float, Margin],
    after: tuple[float, Margin],
    solve: Callable[[float], Equilibrium | None],
    measure: Callable[[Equilibrium], list[Margin]],
) -> tuple[Equilibrium, Margin] | None:
    """Equilibrium at which a margin is zero.

    ``solve``: equilibrium at a load parameter, None where none is found. ``measure``: margins of an
    equilibrium. Returns the equilibrium at the root of the margin, with the margin; or just past a jump of
    the
    margin to below zero, whose load parameter is exact to round-off.
    """
    (begin, first), (end, last) = before, after

    def evaluate(t: float) -> tuple[float, tuple[Equilibrium, Margin]] | None:
        equilibrium = solve(t)
        if equilibrium is None:
            return None
        margin = next(m for m in measure(equilibrium) if (m.kind, m.pair) == (first.kind, first.pair))
        return margin.value, (equilibrium, margin)

    return find_root(evaluate, (begin, first.value), (end, last.value), small=_LOCATED, apart=_APART)

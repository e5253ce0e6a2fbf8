"""Elements whose equations are integrated from load to load; contacts cut them."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tsm.contact_block import ContactBlock
from tsm.elements.properties import Array
from tsm.groups.base import Change, ElementGroup
from tsm.projection import PROJECTED, Projection, arc_position, overshoot, slide
from tsm.rods.accuracy import deflected, finer, inaccurate, truncation
from tsm.rods.assembly import Rods
from tsm.rods.layout import OWN
from tsm.rods.profile import alike, angles_at, recut, undeformed
from tsm.rods.records import RodBalance, RodTangent
from tsm.rods.shape import RodShape, Stations, pieces, tangent_at
from tsm.rods.varying import VaryingRods
from tsm.state import Profile, State, Touch, Traction

if TYPE_CHECKING:
    from tsm.pairs import BeamModel, PairModel

_SAMPLES = 33
"""Points of an element in the search for the nearest one."""
_STEPS = 30
"""Largest number of Newton steps of a projection."""
_POINTS, _LINES = 100, 60
"""Intervals in which a beam is drawn, and short lines along it, at least 10 and 4 for an element."""


class ExactGroup(ElementGroup):
    """Exact elements, see `tsm.rods`."""

    internal = True
    past_node = 0.0
    slip_sign = 1.0

    @cached_property
    def rods(self) -> Rods:
        """Numerics of the elements."""
        varies = self.model.along.varies[self.elements].any()
        return (VaryingRods if varies else Rods)(self.model, self.dofs, self.elements)

    def forces(self, state: State, contacts: ContactBlock) -> RodBalance:
        """Residual of the elements and of the contacts that cut them."""
        for k, pair in self.model.pairs_of(self):
            if state.touches[k] is None:
                contacts.leave_open(pair)
        balance = self.rods.balance(state)
        contacts.cut(balance.contacts, state.touches)
        return balance

    def tangent(self, state: State, forces: RodBalance, contacts: ContactBlock) -> RodTangent:
        """Tangent of the elements and of the contacts that cut them."""
        tangent = self.rods.linearise(state, forces)
        for part in tangent.cut:
            contacts.cut_element(part, self.dofs[:, part.element])
        return tangent

    def rate(self, state: State, q: Array, contacts: Array) -> Array:
        """Change (9, e) of the forces with the degrees of freedom, and of the rows of the contacts."""
        tangent, x = self.rods.linearise(state, self.rods.balance(state)), q[self.dofs]
        for part in tangent.cut:
            contacts[self.rods.slots(part.pairs)] += part.tangent[OWN:, :OWN] @ x[:, part.element]
        rate: Array = np.einsum("ijn,jn->in", tangent.tangent.reshape(OWN, OWN, -1), x)
        return rate

    def load_rate(self, state: State, contacts: Array) -> Array:
        """Change (9, e) of the forces with the load parameter, and of the rows of the contacts."""
        return self.rods.load_rate(state, contacts)

    def load_work(self, state: State) -> float:
        """Work of the loads along the elements."""
        return self.rods.load_work(state)

    def load_power(self, state: State, tangent: RodTangent, dofs: Array, contacts: Array) -> float:
        """Work of the loads along the elements at rates of the unknowns."""
        return self.rods.load_power(state, tangent, dofs, contacts)

    def pin_rate(
        self, pair: PairModel, _touch: Touch, _state: State, velocity: tuple[float, float]
    ) -> tuple[Array, Array]:
        """Change of the contact's rows as the pin moves; the forces of the element do not change."""
        rows = np.zeros(pair.element_type.contact_unknowns)
        rows[:2] = -np.array(velocity)
        return np.zeros(6), rows

    def traction(self, k: int, _state: State, forces: RodBalance) -> Traction:
        """Force and place of a contact with friction."""
        contact = forces.entry.rubbing[k]
        return Traction(contact.tangential, contact.normal, contact.place)

    def slip_rate(self, k: int, _state: State, tangent: RodTangent, dofs: Array, contacts: Array) -> float:
        """Slip rate of a contact."""
        part = next(part for part in tangent.cut if k in part.pairs)
        own = dofs[self.dofs[:, part.element]]
        return float(
            part.slip[k]
            @ np.concatenate([own, contacts[self.rods.slots(part.pairs)], self.rods.fixed(1.0, 0.0)])
        )

    def energy(self, state: State) -> float:
        """Strain energy of the elements; contacts have none."""
        return self.rods.energy(state)

    def undeformed(self, state: State) -> State:
        """State with the angles of straight elements."""
        return replace(state, profile=undeformed(self.rods, state.touches))

    def with_touches(self, before: State, after: State) -> State:
        """State with its elements cut where its contacts are."""
        return recut(self.rods, before, after)

    def with_change(self, before: State, after: State, tangent: RodTangent, change: Change) -> State:
        """State with its angles inside changed."""
        profile = before.profile
        assert profile is not None, "a model with exact elements has their profile"
        fixed = (change.load, change.residual)
        inside = self.rods.inside(tangent, before, change.dofs, change.contacts, fixed)
        moved = Profile(cuts=profile.cuts, angle=profile.angle + change.factor * inside)
        return replace(after, profile=moved)

    def alike(self, history: list[State]) -> list[State]:
        """The latest states that are cut alike, with as many Gauss nodes as the last."""
        return alike(self.rods, history)

    def turned(self, one: State, other: State, like: State) -> Array:
        """Differences of the angles at the Gauss nodes."""
        begin, end = (angles_at(self.rods, state, like) for state in (one, other))
        return (end - begin).ravel()

    def turning(self, state: State, tangent: RodTangent, dofs: Array, contacts: Array) -> Array:
        """Rates of the angles at the Gauss nodes."""
        return self.rods.inside(tangent, state, dofs, contacts, (1.0, 0.0)).ravel()

    def refined(self, state: State, forces: RodBalance, tolerance: float) -> State | None:
        """State with more Gauss nodes, None where they suffice."""
        return finer(self.rods, state, forces, tolerance)

    def inaccurate(self, forces: RodBalance, tolerance: float) -> bool:
        """Whether the most Gauss nodes do not suffice."""
        return inaccurate(self.rods, forces, tolerance)

    def integration_error(self, forces: RodBalance) -> float:
        """Estimated error of the integration inside the elements."""
        return 0.0 if self.rods.nodes else truncation(self.rods, forces.entry)

    def project(self, pair: PairModel, state: State) -> Projection:
        """Closest point, the last ones found at the same state kept."""
        shape = deflected(self.rods, state)
        closest: dict[int, Projection] = self.rods.memo.closest if self.rods.memo else {}
        if pair.slot not in closest:
            closest[pair.slot] = self._project(pair, state, shape)
        return closest[pair.slot]

    def _project(self, pair: PairModel, state: State, shape: RodShape) -> Projection:
        """Nearest of the points along the axis, and Newton's method from there."""
        model, target, steep = self.model, pair.target, pair.side * pair.steep
        node = np.array(model.node_position(pair, state.q, state.load_parameter))
        first, xi = int(model.place[target.first]), np.linspace(0, 1, _SAMPLES)
        points = (
            np.array([shape.at(first + e, xi * l0).position for e, l0 in enumerate(target.lengths)]) - node
        )
        nearest = np.argmin(np.einsum("emi,emi->em", points, points))
        e, sample = divmod(int(nearest), _SAMPLES)
        arc = float(xi[sample]) * target.lengths[e]
        for _ in range(_STEPS):
            l0 = target.lengths[e]
            inside = min(max(arc, 0.0), l0)
            at = shape.at(first + e, np.array([inside]))
            tangent, bend = tangent_at(self.rods, first + e, inside, at)
            apart = at.position[0] + (arc - inside) * tangent - node
            slope = float(tangent @ tangent) + (float(bend @ apart) if inside == arc else 0.0)
            along = float(apart @ tangent)
            if steep:
                distance = float(np.hypot(*apart))
                slope, along = slope - steep * along / distance, along - steep * distance
            step = along / slope if slope > 0 else 0.0
            arc -= min(max(step, -l0 / _SAMPLES), l0 / _SAMPLES)
            e, place = slide(target.lengths, e, arc / l0)
            arc = place * target.lengths[e]
            if abs(step) < PROJECTED * l0:
                break
        height = float(apart[1] * tangent[0] - apart[0] * tangent[1]) / float(np.hypot(*tangent))
        arc = arc_position(target, target.first + e, place)
        if steep:
            height = math.copysign(float(np.hypot(*apart)), height)
        gap = pair.side * height - pair.side * pair.reach_at(arc)
        return Projection(target.first + e, place, gap, overshoot(target, arc))

    def end(self, pair: PairModel, state: State, *, last: bool) -> tuple[Array, Array]:
        """The ends of the deflected axis."""
        element, arc = (pair.target.last, pair.target.lengths[-1]) if last else (pair.target.first, 0.0)
        place = int(self.model.place[element])
        at = deflected(self.rods, state).at(place, np.array([arc]))
        tangent, _ = tangent_at(self.rods, place, arc, at)
        return at.position[0] - self.model.node_position(pair, state.q, state.load_parameter), tangent

    def direction(self, touch: Touch, _q: Array) -> tuple[float, float]:
        """Direction of the section's normal at the contact."""
        return math.cos(touch.angle), math.sin(touch.angle)

    def curvature(
        self, k: int, touch: Touch, state: State, forces: RodBalance, _push: tuple[float, float]
    ) -> float:
        """Curvature from moment and stretch where the contact cuts the element."""
        profile, place = state.profile, int(self.model.place[touch.element])
        assert profile is not None, "an exact element has a profile"
        s = int(forces.entry.place.first[place]) + dict(profile.cuts)[place].index(k)
        return self.rods.curvature(forces.entry, s, touch)

    def intervals(self, elements: int) -> int:
        """Intervals in which an element is drawn."""
        return max(10, math.ceil(_POINTS / elements))

    def axes(self, beam: BeamModel, state: State, _forces: RodBalance, xi: Array) -> Array:
        """Deflected axes of the elements of a beam, shape (elements, m, 2)."""
        shape, first = deflected(self.rods, state), int(self.model.place[beam.first])
        return np.array([shape.at(first + e, xi * l0).position for e, l0 in enumerate(beam.lengths)])

    def section_axes(self, beam: BeamModel, shape: Array) -> Array:
        """Directions of the sections' normals at both ends of the elements."""
        rods, own = self.rods, self.model.place[beam.first : beam.last + 1]
        natural = np.append(rods.angle0[own], rods.angle1[own[-1]]) if rods.varies else rods.angle0[own[0]]
        angle = natural + shape[:, 2]
        t = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return np.stack([t[:-1], t[1:]])

    def stations(self, beam: BeamModel, state: State, _shape: Array, _section_forces: Array) -> Stations:
        """Short pieces of the segments."""
        axis, first = deflected(self.rods, state), int(self.model.place[beam.first])
        count = max(4, math.ceil(_LINES / beam.beam.elements))
        parts = [pieces(self.rods, axis, first + e, count) for e in range(beam.beam.elements)]
        parts = [part._replace(arc=part.arc + arc) for arc, part in zip(beam.arcs, parts, strict=False)]
        return Stations(*(np.concatenate(column) for column in zip(*parts, strict=True)))

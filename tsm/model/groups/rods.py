"""Exact elements: the rod's equations are integrated from contact to contact.

An element is cut at its contacts. Its unknowns are the nodes' displacements, the internal force n and moment
m at its start, and for every contact the force F, the arc position and the section's angle there; between
cuts the force is n less the contact forces before. Its equations are arrival at the end node and, at every
cut, position and direction of the contact and arrival of the angle. The angles inside the segments are
eliminated (`tsm.elements.rod`) and kept in the state.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from tsm.elements import rod
from tsm.elements.collocation import collocation
from tsm.elements.properties import Array
from tsm.elements.rod import Arrival, Course, Field, Segments
from tsm.elements.varied import STEP
from tsm.model.contact_block import ContactBlock
from tsm.model.groups.base import ElementGroup, GroupForces, GroupTangent
from tsm.model.groups.cut import Cut, CutElement, Section, cut_element, enter, seen
from tsm.model.groups.layout import COLUMNS, FIXED, OWN, ROWS, Layout, layout
from tsm.model.numbering import Numbering
from tsm.model.projection import Projection
from tsm.model.state import Profile, State, Traction, profile_of, touch_of

_UNDEFORMED_ORDER = 24
"""Gauss nodes of an undeformed element."""


class Entry(NamedTuple):
    """Where the segments of a state begin and end."""

    place: Layout  # elements of the segments
    segments: Segments
    field: Field  # the rod's equations in them
    start: Array  # start, end, moment: angles at both ends, moment at the start; shape (s, 1)
    end: Array
    moment: Array
    gain: Array  # moment at the end minus moment at the start; shape (s,)
    vector: Array  # vector from start to end; shape (2, s)
    cuts: dict[int, Cut]  # the contacts, by pair


@dataclass(kw_only=True)
class RodBalance(GroupForces):
    """Residual of the exact elements: forces on node i, arrival at node j, forces on node j."""

    entry: Entry  # the segments
    arrival: Arrival  # their residuals


@dataclass(kw_only=True)
class RodTangent(GroupTangent):
    """Tangent of the exact elements."""

    place: Layout  # elements of the segments
    cut: tuple[CutElement, ...]  # elements with contacts, whose first nine rows and columns are above too
    inner: Array  # derivatives of the angles inside by the inputs of the segments; shape (s, p, i)
    transfer: Array  # derivatives of their outputs, see `rod.Condensed`; shape (s, 4, i)


class Rods(ElementGroup):
    """Equations of the exact elements of a model, r of them. ``dofs`` (9, r) are node i, force and moment, node j."""

    internal = True

    def __init__(self, model: Numbering, number: int, elements: Array) -> None:
        super().__init__(model, number, elements)
        inside = 3 * model.block[elements] + np.arange(3)[:, None]
        self.dofs = np.concatenate([self.dofs[:3], inside, self.dofs[3:]])
        along = model.along
        self.varies, self.nodes = bool(along.varies[elements].any()), model.gauss_nodes
        self.near, self.far = model.coordinates[model.element_nodes[elements].T].transpose(0, 2, 1)
        course = along.course(elements, np.zeros((len(elements), 1)), *np.zeros((2, 2, 0, len(elements))))
        own = (along.start, along.end, along.length, along.curvature)
        self.constants = np.array([*(value[elements] for value in own), *course.flexibility[:, :, 0]])
        self.angles, self.length, self.natural = self.constants[:2], self.constants[2], self.constants[3]
        self.memo: tuple[State, Any, dict[int, Projection]] | None = (
            None  # the shape of a state, and points found on it
        )

    def course(self, owner: Array, arc: Array, load_parameter: Any) -> Course:
        """What varies at arc positions (s, p) within elements (s,), counted over the exact ones."""
        along, elements, t = self.model.along, self.elements[owner], load_parameter.real
        at, rate = (part[:, :, elements] for part in (along.resultants.at(t), along.resultants.rate(t)))
        if load_parameter.imag:
            at = at + 1j * load_parameter.imag * rate
        return along.course(elements, arc / self.length[owner, None], at, rate)

    def undeformed_angle(self, element: Any, arc: Array) -> Any:
        """Angle of the undeformed axis of elements at arc positions within them."""
        return self.angles[0][element] + self.natural[element] * arc

    def section(self, element: int, arc: Any, load_parameter: float) -> Section:
        """Section of an element at an arc position within it."""
        place = np.array([element]), np.array([[arc]])
        course = self.course(*place, load_parameter) if self.varies else None
        flexibility = course.flexibility[:, 0, 0] if course else self.constants[4:, element]
        stretch, shear, bend = flexibility.tolist()
        return Section(stretch, shear, bend, float(self.natural[element]), course)

    def enter(self, state: State) -> Entry:
        """Cut the elements at their contacts and evaluate the rod's equations inside."""
        profile = profile_of(state)
        place = layout(len(self.length), profile.cuts)
        own = place.owner
        q, constants = state.q[self.dofs[:, own]], self.constants[:, own]
        until, begin = constants[2].astype(q.dtype), np.zeros(len(own), q.dtype)
        force, start, end, moment = q[3:5, :, None], q[2] + constants[0], q[8] + constants[1], q[5]
        for s, k in place.cuts:
            touch = touch_of(state, k)
            until[s] = begin[s + 1] = touch.xi * self.length[own[s]]
            end[s] = start[s + 1] = touch.angle
            force[:, s + 1, 0] = force[:, s, 0] - touch.force
        length = until - begin
        segments = Segments(
            flexibility=constants[4:, :, None],
            force=force,
            length=length[:, None],
            angle=profile.angle,
            constant=force,
            owner=own,
            begin=begin[:, None],
            curvature=constants[3, :, None],
        )
        segments = self.placed(segments, state.load_parameter)
        field = rod.field(segments)
        gain, *vector = field.sums * length
        cuts: dict[int, Cut] = {}
        for s, k in place.cuts:
            before = moment[s] + gain[s]
            cuts[k] = self._cut(state, k, s, segments, before)
            moment[s + 1] = before - cuts[k].couple
        start, end, moment = (part[:, None] for part in (start, end, moment))
        return Entry(place, segments, field, start, end, moment, gain, np.array(vector), cuts)

    def placed(self, segments: Segments, load_parameter: float) -> Segments:
        """Segments with what varies along them, from those with the constant part of their forces."""
        if not self.varies:
            return segments
        nodes = segments.table.c
        course = self.course(segments.owner, segments.begin + segments.length * nodes, load_parameter)
        return segments._replace(
            flexibility=course.flexibility, force=segments.constant - course.resultant, course=course
        )

    def _cut(self, state: State, k: int, s: int, segments: Segments, moment: Any) -> Cut:
        """Contact at the end of segment s, with the moment before it."""
        pair, touch = self.model.pairs[k], touch_of(state, k)
        t, before = state.load_parameter, segments.constant[:, s, 0].tolist()
        section = self.section(int(segments.owner[s]), segments.begin[s + 1, 0], t)
        at = (touch.angle, *before, *touch.force, pair.arc_position(touch), moment, t)
        unit = self.model.force_scale / self.model.length
        return Cut(pair, touch, section, at, *seen(pair, section, at, at), unit)

    def forces(self, state: State, contacts: ContactBlock) -> RodBalance:
        """Residual of the elements and of the contacts that cut them."""
        for k, pair in self.pairs:
            if state.touches[k] is None:
                contacts.leave_open(pair)
        entry = self.enter(state)
        arrival = rod.arrival(entry.segments, entry.field, entry.start, entry.moment, entry.end)
        q = state.q[self.dofs]
        first, last = entry.place.first, entry.place.last
        residual = np.empty_like(q)
        residual[0:3] = -q[3:6]
        residual[3:5] = (self.near - self.far) + (q[0:2] - q[6:8]) + entry.vector[:, first]
        residual[5] = arrival.end_residual[last]
        residual[6:8] = entry.segments.constant[:, last, 0]
        if self.varies:
            residual[6:8] -= self._resultant(state)
        residual[8] = entry.moment[last, 0] + entry.gain[last]
        at = self.near + q[:2]
        for s, k in entry.place.cuts:
            cut, element = entry.cuts[k], entry.place.owner[s]
            at[:, element] += entry.vector[:, s]
            (x, y), (cx, cy) = (
                at[:, element],
                self.model.node_position(cut.pair, state.q, state.load_parameter),
            )
            px, py, row = cut.pair.rows(cut.touch.grip, cut.touch.force, cut.here, cut.unit)
            rows = (x - cx + px, y - cy + py, row, arrival.end_residual[s])
            contacts.enter(k, cut.pair, cut.touch.force, rows)
            residual[3:5, element] += entry.vector[:, s + 1]
        inside = float(np.abs(arrival.inside).max())
        return RodBalance(nodal=residual, inside=inside, entry=entry, arrival=arrival)

    def tangent(self, state: State, forces: Any, contacts: ContactBlock) -> RodTangent:
        """Tangent of the elements and of the contacts that cut them."""
        entry = forces.entry
        condensed = rod.condense(entry.segments, entry.field, forces.arrival)
        first = entry.place.first
        tangent = np.empty((len(first), OWN, OWN), dtype=state.q.dtype)
        tangent[:] = FIXED
        transfer = condensed.transfer[first]
        tangent[:, ROWS[:, None], COLUMNS] = transfer[:, :, :5]
        condensed_residual, by_load = np.zeros((2, *forces.nodal.shape))
        condensed_residual[ROWS] = transfer[:, :, 6].T
        if self.varies:
            by_load[ROWS] = transfer[:, :, rod.LOAD].T
        cut = []
        for e, pairs in profile_of(state).cuts:
            part = cut_element(e, {k: entry.cuts[k] for k in pairs}, condensed.transfer[first[e] :])
            own = part.tangent[:OWN]
            tangent[e], by_load[:, e], condensed_residual[:, e] = own[:, :OWN], own[:, -2], own[:, -1]
            enter(part, self, contacts)
            cut.append(part)
        if self.varies:
            by_load[6:8] = -self._resultant(state, rate=True)
        return RodTangent(
            tangent=tangent.reshape(len(first), -1).T, condensed_residual=condensed_residual, by_load=by_load,
            place=entry.place, cut=tuple(cut), inner=condensed.inner, transfer=condensed.transfer,
        )  # fmt: skip

    def inside(
        self, tangent: Any, dofs: Array, contacts: Array, load: float = 1.0, residual: float = 0.0
    ) -> Array:
        """Changes (s, p) of the inner angles with all degrees of freedom, the contacts' unknowns and the load parameter; by default rates.

        ``residual``: 1 to remove the residual inside, too.
        """
        place = tangent.place
        inputs = np.zeros((len(place.owner), tangent.inner.shape[2]))
        inputs[:, :5] = dofs[self.dofs[COLUMNS]][:, place.owner].T
        inputs[:, 6], inputs[:, 8:] = residual, load
        for part in tangent.cut:
            first = place.first[part.element]
            columns = self._columns(part, dofs, contacts, load, residual)
            inputs[first : first + len(part.inputs)] = part.inputs @ columns
        return (tangent.inner @ inputs[:, :, None])[:, :, 0]

    def _columns(self, part: CutElement, dofs: Array, contacts: Array, *others: float) -> Array:
        """Changes of what the columns of a cut element stand for."""
        return np.concatenate([dofs[self.dofs[:, part.element]], contacts[part.slots], others])

    def traction(self, k: int, forces: Any) -> Traction:
        """Force and place of a contact with friction."""
        cut: Cut = forces.entry.cuts[k]
        return cut.pair.traction(cut.touch.force, cut.here)

    def slip_rate(self, k: int, tangent: Any, dofs: Array, contacts: Array) -> float:
        """Slip rate of a contact."""
        part = next(part for part in tangent.cut if k in part.pairs)
        return float(part.slip[k] @ self._columns(part, dofs, contacts, 1.0, 0.0))

    def energy(self, state: State) -> float:
        """Strain energy of the elements; contacts have none."""
        entry = self.enter(state)
        segments, field, (stretch, shear, bend) = entry.segments, entry.field, entry.segments.flexibility
        moment = rod.moments(segments, field, entry.moment)
        density = bend * moment**2 + stretch * field.N**2 + shear * field.q**2
        return float((segments.length * density @ segments.table.w).sum()) / 2

    def _resultant(self, state: State, *, rate: bool = False) -> Array:
        """Resultants (2, r) of the loads along the elements, or their derivatives in the load parameter."""
        resultants, t = self.model.along.resultants, state.load_parameter.real
        return (resultants.rate(t) if rate else resultants.at(t))[:, :, self.elements].sum(axis=1)

    def load_work(self, state: State) -> Any:
        """Work of the loads of a state on the displacements to it: ``[P . u] - int P . (r' - r_0') ds`` with ``P' = q``."""
        entry, own, t = self.enter(state), np.arange(len(self.length)), state.load_parameter.real
        segments, table = entry.segments, collocation(_UNDEFORMED_ORDER)
        arc = segments.begin + segments.length * segments.table.c
        density = (self.course(segments.owner, arc, t).resultant * entry.field.values[1:]).sum(axis=0)
        along = (density @ segments.table.w) @ segments.length[:, 0]
        arc = self.length[:, None] * table.c
        angle = self.undeformed_angle(own[:, None], arc)
        straight = (self.course(own, arc, t).resultant * np.stack([np.cos(angle), np.sin(angle)])).sum(axis=0)
        return (
            (self._resultant(state) * state.q[self.dofs[6:8]]).sum()
            - along
            + (straight @ table.w) @ self.length
        )

    def load_power(self, state: State, tangent: RodTangent, dofs: Array, contacts: Array) -> float:
        """Work of the loads at rates of all unknowns: a complex step of `load_work`, which holds the loads."""
        step, profile = 1j * STEP, profile_of(state)
        touches = tuple(
            touch and pair.moved(touch, (step * contacts[pair.slots]).tolist())
            for pair, touch in zip(self.model.pairs, state.touches, strict=True)
        )
        angle = Profile(cuts=profile.cuts, angle=profile.angle + step * self.inside(tangent, dofs, contacts))
        t: Any = state.load_parameter + step
        moved = replace(state, load_parameter=t, q=state.q + step * dofs, touches=touches, profile=angle)
        return float(self.load_work(moved).imag / STEP)

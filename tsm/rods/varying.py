"""Exact elements with loads along them, natural curvature or taper: what differs from straight and uniform ones."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from tsm.elements import rod, varying
from tsm.elements.collocation import collocation
from tsm.elements.properties import Array
from tsm.elements.rod import Arrival, Condensed, Field, Segments
from tsm.elements.varying import INPUTS, Course, VaryingSegments
from tsm.rods.assembly import Rods, profile_of, touch_of
from tsm.rods.contact_rows import Explicit
from tsm.rods.friction_rows import Rubbing, placed, rubbing
from tsm.rods.layout import CUT, OWN, ROWS, Layout, chain, layout
from tsm.rods.records import Entry, RodBalance, RodTangent, Section
from tsm.state import State, Touch

if TYPE_CHECKING:
    from tsm.model import Model

_ARC, _LOAD = 7, 8
"""Inputs of `tsm.elements.varying`: arc position of the start, load parameter."""
_UNDEFORMED_ORDER = 24
"""Gauss nodes of an undeformed element."""


class VaryingRods(Rods):
    """The exact elements of a model with loads along them, natural curvature or taper."""

    varies: ClassVar[bool] = True

    def __init__(self, model: Model, dofs: Array, exact: Array) -> None:
        super().__init__(model, dofs, exact)
        self.angle0, self.angle1 = model.along.start[exact], model.along.end[exact]

    def field(self, segments: VaryingSegments) -> Field:
        """Evaluate the rod's equations at the Gauss nodes; those of a uniform rod hold with the values there."""
        return rod.field(Segments(segments.flexibility, segments.force, segments.length, segments.angle))

    def arrive(
        self, segments: VaryingSegments, field: Field, start: Array, moment: Array, end: Array
    ) -> Arrival:
        """Residuals of segments, see `varying.arrival`."""
        return varying.arrival(segments, field, start, moment, end)

    def condense(self, segments: VaryingSegments, field: Field, arrived: Arrival, moment: Array) -> Condensed:
        """Eliminate the angles inside, see `varying.condense`."""
        return varying.condense(segments, field, arrived, moment)

    def course(self, owner: Array, arc: Array, load_parameter: float) -> Course:
        """What varies at arc positions (s, p) within elements (s,), counted over the exact ones."""
        along, elements = self.model.along, self.elements[owner]
        resultant = along.resultants_at(load_parameter)[:, :, elements]
        rate = along.resultant_rates(load_parameter)[:, :, elements]
        return along.course(elements, arc / self.length[owner, None], resultant, rate)

    def segments(self, state: State, place: Layout, uniform: Segments) -> VaryingSegments:
        """Segments with what varies along them, from those with the constant part of their forces."""
        begin = np.zeros_like(uniform.length)
        for first, last in zip(place.first, place.last, strict=True):
            for s in range(first, last):
                begin[s + 1] = begin[s] + uniform.length[s]
        return self.placed(place.owner, begin, uniform, state.load_parameter)

    def placed(self, owner: Array, begin: Array, uniform: Segments, load_parameter: float) -> VaryingSegments:
        """Segments that begin at arc positions (s, 1) within elements (s,)."""
        nodes = collocation(uniform.angle.shape[1]).c
        course = self.course(owner, begin + uniform.length * nodes, load_parameter)
        return VaryingSegments(
            flexibility=course.flexibility,
            force=uniform.force - course.resultant,
            length=uniform.length,
            angle=uniform.angle,
            course=course,
            curvature=self.model.along.curvature[self.elements[owner], None],
            constant=uniform.force,
            begin=begin,
            owner=owner,
            at_end=self.course(owner, begin + uniform.length, load_parameter),
        )

    def turning(self, entry: Entry) -> Array:
        """Derivatives (s, p) of the angles at the Gauss nodes in the arc position."""
        turning: Array = super().turning(entry) + entry.segments.curvature
        return turning

    def undeformed_angle(self, element: Any, arc: Array) -> Any:
        """Angle of the undeformed axis of an element at arc positions within it."""
        angle: Array = self.angle0[element] + self.model.along.curvature[self.elements[element]] * arc
        return angle

    def along(self, entry: Entry) -> tuple[Array, Array | None]:
        """Internal force at the starts of the segments, and its derivative at the Gauss nodes."""
        segments = entry.segments
        resultant = self.course(entry.place.owner, segments.begin, entry.load_parameter).resultant
        force: Array = (segments.constant - resultant)[:, :, 0]
        return force, -segments.course.load

    def section(self, element: int, arc: float) -> Section:
        """Section of an element at an arc position within it."""
        course = self.course(np.array([element]), np.array([[arc]]), 0.0)
        stretch, shear, bend = (float(value[0, 0]) for value in course.flexibility)
        return Section(stretch, shear, bend, float(self.model.along.curvature[self.elements[element]]))

    def end_force(self, entry: Entry) -> Array:
        """Internal force (2, r) at the end of every element."""
        segments, last = entry.segments, entry.place.last
        force: Array = segments.constant[:, last, 0] - segments.at_end.resultant[:, last, 0]
        return force

    def curvature(self, entry: Entry, s: int, touch: Touch) -> float:
        """Curvature of the axis at the contact at the end of segment s, from moment, natural curvature and stretch."""
        element = int(entry.place.owner[s])
        section = self.section(element, touch.xi * self.length[element])
        fx, fy = (
            entry.segments.constant[:, s : s + 2, 0].mean(axis=1) - entry.segments.at_end.resultant[:, s, 0]
        )
        axial = fx * np.cos(touch.angle) + fy * np.sin(touch.angle)
        turn = float(entry.moment[s + 1, 0]) * section.bend + section.curvature
        return float(turn / (1 + axial * section.stretch))

    def _rubbing(self, state: State, k: int, segments: Any, s: int, moment: Any) -> Rubbing:
        """Contact with friction at the end of segment s, with the moment before it."""
        pair, touch = self.model.pairs[k], touch_of(state, k)
        bend = segments.at_end.flexibility.bend[s, 0]
        curvature, tangents = float(segments.curvature[s, 0]), self._tangents(state, k, segments, s)
        contact = rubbing(pair, touch.force, tangents, touch.angle, bend, curvature)
        return placed(contact, pair.arc_position(touch), moment)

    def _tangents(self, state: State, k: int, segments: Any, s: int) -> tuple[rod.Tangent, rod.Tangent]:
        """Tangent vectors before and after the contact at the end of segment s."""
        touch, here = touch_of(state, k), segments.at_end
        stretch, shear = here.flexibility.stretch[s, 0], here.flexibility.shear[s, 0]
        before, after = (segments.constant[:, n, 0] - here.resultant[:, s, 0] for n in (s, s + 1))
        one, other = (rod.tangent(stretch, shear, (x, y), touch.angle) for x, y in (before, after))
        return one, other

    def chain(self, count: int) -> tuple[Array, Array, Array]:
        """Constant matrices of an element with `count` cuts; the load parameter has the column before the last."""
        return _chain(count)

    def fixed(self, load: float, constant: float) -> tuple[float, ...]:
        """Last columns of a tangent: load parameter, and what is constant."""
        return (load, constant)

    def explicit(self, state: State, k: int, balance: RodBalance, selectors: Array) -> Explicit:
        """Derivatives of the tangent vectors at a contact by its arc position and by the load parameter."""
        vector, by_load, turn = self.slopes(state, k, balance)
        vector = vector[:, None] * selectors[5]
        vector[:, -2] += by_load
        return Explicit(vector, turn * selectors[5])

    def slopes(self, state: State, k: int, balance: RodBalance) -> tuple[Array, Array, float]:
        """Derivatives of the sum of the tangent vectors at a contact by its arc position and by the load parameter, angle and forces held.

        The third value is the derivative of the mean turn by the arc position, the moment held.
        """
        touch, segments = touch_of(state, k), balance.entry.segments
        element = int(self.model.place[touch.element])
        s = int(balance.entry.place.first[element]) + dict(profile_of(state).cuts)[element].index(k)
        here = segments.at_end.single(s)
        by_arc, by_load = np.zeros((2, 2))
        for n in (s, s + 1):
            force = segments.constant[:, n, 0] - here.resultant[:, 0, 0]
            arc, load = varying.tangent_slope(here, force, touch.angle)
            by_arc, by_load = by_arc + arc, by_load + load
        moment = balance.entry.moment[s + 1, 0]
        if k in balance.entry.rubbing:
            moment = moment + balance.entry.rubbing[k].couple / 2
        return by_arc, by_load, here.slope.bend[0, 0] * moment

    def load_rate(self, state: State, contacts: Array) -> Array:
        """Change of the forces with the load parameter, and of the rows of the contacts."""
        tangent = self.linearise(state, self.balance(state))
        own = np.arange(len(self.length))
        first = layout(len(own), profile_of(state).cuts).first
        rate = np.zeros((OWN, len(own)), dtype=tangent.transfer.dtype)
        rate[ROWS] = tangent.transfer[first, :, _LOAD].T
        for part in tangent.cut:
            rate[:, part.element] = part.tangent[:OWN, -2]
            contacts[self.slots(part.pairs)] += part.tangent[OWN:, -2]
        rate[6:8] = -self.course(own, self.length[:, None], state.load_parameter).resultant_rate[:, :, 0]
        return rate

    def load_work(self, state: State) -> float:
        """Work of the loads along the elements: with ``P' = q`` it is ``[P . u] - int P . (r' - r_0') ds``."""
        entry, q, own = self.enter(state), state.q[self.dofs], np.arange(len(self.length))
        table = collocation(_UNDEFORMED_ORDER)
        resultant = self.course(own, self.length[:, None], state.load_parameter).resultant[:, :, 0]
        work = float((resultant * q[6:8]).sum()) - self._along(entry, entry.field.values[1:])
        arc = self.length[:, None] * table.c
        angle = self.undeformed_angle(own[:, None], arc)
        straight = self.course(own, arc, state.load_parameter).resultant * np.stack(
            [np.cos(angle), np.sin(angle)]
        )
        return work + float((straight.sum(axis=0) @ table.w) @ self.length)

    def _along(self, entry: Entry, values: Array) -> float:
        """Integral of ``P . v`` with values (2, s, p) of v at the Gauss nodes."""
        segments = entry.segments
        density = (segments.course.resultant * values).sum(axis=0) @ collocation(segments.angle.shape[1]).w
        return float(density @ segments.length[:, 0])

    def load_power(self, state: State, tangent: RodTangent, dofs: Array, contacts: Array) -> float:
        """Work of the loads along the elements at rates of the unknowns."""
        entry, own = self.enter(state), np.arange(len(self.length))
        segments, field, table = entry.segments, entry.field, collocation(entry.segments.angle.shape[1])
        inputs = self.inputs(tangent, state, dofs, contacts, (1.0, 0.0))
        inside = (tangent.inner @ inputs[:, :, None])[:, :, 0]
        resultant = self.course(own, self.length[:, None], state.load_parameter).resultant[:, :, 0]
        power = float((resultant * dofs[self.dofs[6:8]]).sum())
        power -= self._along(entry, varying.tangent_rate(segments, field, inside, inputs))
        # the ends of the segments move along the rod
        longer, moved = inputs[:, 5], inputs[:, _ARC, None] + inputs[:, 5, None] * table.c
        tangents = field.values[1:]
        power -= float(((segments.course.resultant * tangents).sum(axis=0) @ table.w) @ longer)
        return power - self._along_load(segments, tangents * moved)

    @staticmethod
    def _along_load(segments: VaryingSegments, values: Array) -> float:
        """Integral of ``q . v`` with values (2, s, p) of v at the Gauss nodes."""
        density: Array = (segments.course.load * values).sum(axis=0) @ collocation(segments.angle.shape[1]).w
        return float(density @ segments.length[:, 0])


@lru_cache(maxsize=16)
def _chain(count: int) -> tuple[Array, Array, Array]:
    """`chain` with the inputs of `tsm.elements.varying`, and with a column for the load parameter."""
    inputs, tangent, selectors = (np.insert(part, -1, 0.0, axis=-1) for part in chain(count))
    inputs = np.concatenate(
        [inputs, np.zeros((count + 1, INPUTS - inputs.shape[1], inputs.shape[2]))], axis=1
    )
    inputs[:, _LOAD, -2] = 1
    for k in range(count):
        inputs[k + 1, _ARC, OWN + CUT * k + 2] = 1
    return inputs, tangent, selectors

"""Residual and tangent of the exact elements: segments between loads, chained and condensed.

An element is cut at its contacts. Its unknowns are the nodes' displacements, the internal force n and moment m at its start, and
for every contact the force F, the arc position and the section's angle there; between cuts the force is n less the contact
forces before. Its equations are arrival at the end node and, at every cut, position and direction of the contact and arrival of
the angle. The angles inside the segments are eliminated (`tsm.elements.rod`) and kept in the state.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from tsm.elements import rod
from tsm.elements.collocation import collocation
from tsm.elements.properties import Array
from tsm.elements.rod import Arrival, Condensed, Field, Flexibility, Segments
from tsm.rods import contact_rows
from tsm.rods.contact_rows import Explicit
from tsm.rods.friction_rows import Rubbing, placed, rubbing
from tsm.rods.layout import COLUMNS, CUT, FIXED, OWN, ROWS, Layout, chain, layout
from tsm.rods.records import CutElement, Entry, Memo, Owned, RodBalance, RodTangent, Section
from tsm.state import Cuts, Profile, State, Touch

if TYPE_CHECKING:
    from tsm.model import Model


_KEPT = 16
"""Divisions into segments whose constants are kept."""


class Rods:
    """The exact elements of a model, straight and uniform ones without loads along them.

    ``dofs`` (9, r): degrees of freedom of the elements. ``exact`` (r,): global numbers of the elements.
    """

    varies: ClassVar[bool] = False

    def __init__(self, model: Model, dofs: Array, exact: Array) -> None:
        self.model, self.dofs, self.elements = model, dofs, exact
        self.nodes = model.gauss_nodes
        nodes = model.element_nodes[exact]
        self.start, self.end = model.coordinates[nodes[:, 0]].T, model.coordinates[nodes[:, 1]].T
        p = model.properties
        self.angle0 = self.angle1 = np.arctan2(p.dy0[exact], p.dx0[exact])
        self.length = p.l0[exact]
        psi = p.Phi[exact] * self.length**2 / 12
        self.flexibility = Flexibility(1 / p.EA[exact], psi / p.EI[exact], 1 / p.EI[exact])
        self._constants: dict[Cuts, Owned] = {}
        self.memo: Memo | None = None

    def enter(self, state: State) -> Entry:
        """Cut the elements at their contacts and evaluate the rod's equations inside."""
        profile = profile_of(state)
        place, dofs, (angle0, angle1), length, flexibility = self._owned(profile.cuts)
        q, length = state.q[dofs], length.copy()
        force, start, end, moment = q[3:5, :, None], q[2] + angle0, q[8] + angle1, q[5]
        for element, pairs in profile.cuts:
            s, behind = int(place.first[element]), 0.0
            for k in pairs:
                touch = touch_of(state, k)
                arc = touch.xi * self.length[element]
                length[s], behind = arc - behind, arc
                end[s] = start[s + 1] = touch.angle
                s += 1
                force[0, s, 0] = force[0, s - 1, 0] - touch.force[0]
                force[1, s, 0] = force[1, s - 1, 0] - touch.force[1]
            length[s] = self.length[element] - behind
        segments = self.segments(state, place, Segments(flexibility, force, length[:, None], profile.angle))
        field = self.field(segments)
        sums = field.sums[:, :, 0] * length
        gain = sums[0]
        rubbed: dict[int, Rubbing] = {}
        for element, pairs in profile.cuts:
            for s, k in enumerate(pairs, int(place.first[element])):
                moment[s + 1] = moment[s] + gain[s]
                if touch_of(state, k).grip is not None:
                    rubbed[k] = self._rubbing(state, k, segments, s, moment[s + 1])
                    moment[s + 1] = moment[s + 1] - rubbed[k].couple
        return Entry(
            place,
            segments,
            field,
            start[:, None],
            end[:, None],
            moment[:, None],
            gain,
            sums[1:],
            rubbed,
            state.load_parameter,
        )

    def field(self, segments: Any) -> Field:
        """Evaluate the rod's equations at the Gauss nodes."""
        return rod.field(segments)

    def arrive(self, segments: Any, field: Field, start: Array, moment: Array, end: Array) -> Arrival:
        """Residuals of segments, see `rod.arrival`."""
        return rod.arrival(segments, field, start, moment, end)

    def condense(self, segments: Any, field: Field, arrived: Arrival, moment: Array) -> Condensed:
        """Eliminate the angles inside, see `rod.condense`."""
        return rod.condense(segments, field, arrived, moment)

    def segments(self, _state: State, _place: Layout, uniform: Segments) -> Any:
        """Segments with what varies along them, from those with the forces at their starts."""
        return uniform

    def turning(self, entry: Entry) -> Array:
        """Derivatives (s, p) of the angles at the Gauss nodes in the arc position."""
        segments, table = entry.segments, collocation(entry.segments.angle.shape[1])
        moment = entry.moment + segments.length * (entry.field.values[0] @ table.once.T)
        turning: Array = segments.flexibility.bend * moment
        return turning

    def undeformed_angle(self, element: Any, _arc: Array) -> Any:
        """Angle of the undeformed axis of elements, counted over the exact ones, at arc positions within them."""
        return self.angle0[element]

    def along(self, entry: Entry) -> tuple[Array, Array | None]:
        """Internal force (2, s) at the starts of the segments, and its derivative (2, s, p) at the Gauss nodes where it varies."""
        return entry.segments.force[:, :, 0], None

    def section(self, element: int, _arc: float) -> Section:
        """Section of an element at an arc position within it."""
        stretch, shear, bend = (float(value[element]) for value in self.flexibility)
        return Section(stretch, shear, bend, 0.0)

    def curvature(self, entry: Entry, s: int, touch: Touch) -> float:
        """Curvature of the axis at the contact at the end of segment s, from moment and stretch."""
        fx, fy = (float(row[s, 0] + row[s + 1, 0]) / 2 for row in entry.segments.force)
        axial = fx * math.cos(touch.angle) + fy * math.sin(touch.angle)
        p = self.model.element[touch.element]
        return float(float(entry.moment[s + 1, 0]) / p.EI / (1 + axial / p.EA))

    def end_force(self, entry: Entry) -> Array:
        """Internal force (2, r) at the end of every element."""
        force: Array = entry.segments.force[:, entry.place.last, 0]
        return force

    def _rubbing(self, state: State, k: int, segments: Any, s: int, moment: Any) -> Rubbing:
        """Contact with friction at the end of segment s, with the moment before it."""
        pair, touch, bend = self.model.pairs[k], touch_of(state, k), segments.flexibility.bend[s, 0]
        contact = rubbing(pair, touch.force, self._tangents(state, k, segments, s), touch.angle, bend)
        return placed(contact, pair.arc_position(touch), moment)

    def _owned(self, cuts: Cuts) -> Owned:
        if cuts not in self._constants:
            if len(self._constants) == _KEPT:
                self._constants.clear()
            place = layout(len(self.length), cuts)
            own = place.owner
            stretch, shear, bend = (value[own, None] for value in self.flexibility)
            flexibility = Flexibility(stretch, shear, bend)
            self._constants[cuts] = Owned(
                place,
                self.dofs[:, own],
                (self.angle0[own], self.angle1[own]),
                self.length[own],
                flexibility,
            )
        return self._constants[cuts]

    def balance(self, state: State) -> RodBalance:
        """Residual at a state."""
        entry = self.enter(state)
        arrival = self.arrive(entry.segments, entry.field, entry.start, entry.moment, entry.end)
        q = state.q[self.dofs]
        first, last = entry.place.first, entry.place.last
        residual = np.empty_like(q)
        residual[0:3] = -q[3:6]
        residual[3:5] = (self.start - self.end) + (q[0:2] - q[6:8]) + entry.vector[:, first]
        residual[5] = arrival.end_residual[last]
        residual[6:8] = self.end_force(entry)
        residual[8] = entry.moment[last, 0] + entry.gain[last]
        contacts: dict[int, list[Any]] = {}
        tangents: dict[int, tuple[rod.Tangent, rod.Tangent]] = {}
        for element, pairs in profile_of(state).cuts:
            s = int(first[element])
            x, y = (self.start[:, element] + q[:2, element]).tolist()
            for k in pairs:
                dx, dy = entry.vector[:, s].tolist()
                x, y = x + dx, y + dy
                tangents[k] = self._tangents(state, k, entry.segments, s)
                pair, touch = self.model.pairs[k], touch_of(state, k)
                cx, cy = self.model.node_position(pair, state.q, state.load_parameter)
                reach = pair.reach_at(pair.arc_position(touch))
                apart = (x - cx, y - cy)
                rows = contact_rows.residual(apart, touch.force, tangents[k], reach, pair.steep)
                if touch.grip is not None:
                    rows[2] = entry.rubbing[k].residual(touch.grip, self.model.stick_stiffness)
                contacts[k] = [*rows, arrival.end_residual[s]]
                residual[3:5, element] += entry.vector[:, s + 1]
                s += 1
        largest = float(np.abs(arrival.inside).max())
        return RodBalance(entry, arrival, residual, contacts, tangents, largest)

    def _tangents(self, state: State, k: int, segments: Any, s: int) -> tuple[rod.Tangent, rod.Tangent]:
        """Tangent vectors before and after the contact at the end of segment s."""
        flexibility = segments.flexibility
        stretch, shear = float(flexibility.stretch[s, 0]), float(flexibility.shear[s, 0])
        angle = touch_of(state, k).angle
        (x, y), (xx, yy) = (segments.force[:, n, 0].tolist() for n in (s, s + 1))
        return rod.tangent(stretch, shear, (x, y), angle), rod.tangent(stretch, shear, (xx, yy), angle)

    def linearise(self, state: State, balance: RodBalance) -> RodTangent:
        """Tangent at a state."""
        entry = balance.entry
        condensed = self.condense(entry.segments, entry.field, balance.arrival, entry.moment)
        first = entry.place.first
        tangent = np.empty((len(first), OWN, OWN), dtype=state.q.dtype)
        tangent[:] = FIXED
        transfer = condensed.transfer[first]
        tangent[:, ROWS[:, None], COLUMNS] = transfer[:, :, :5]
        condensed_residual = np.zeros_like(balance.nodal)
        condensed_residual[ROWS] = transfer[:, :, 6].T
        cut = tuple(
            self._cut(state, e, pairs, balance, condensed.transfer) for e, pairs in profile_of(state).cuts
        )
        for part in cut:
            e = part.element
            tangent[e], condensed_residual[:, e] = part.tangent[:OWN, :OWN], part.tangent[:OWN, -1]
        return RodTangent(
            condensed_residual, tangent.reshape(len(first), -1).T, cut, condensed.inner, condensed.transfer
        )

    def chain(self, count: int) -> tuple[Array, Array, Array]:
        """Constant matrices of an element with `count` cuts, see `layout.chain`."""
        return chain(count)

    def explicit(self, _state: State, _k: int, _balance: RodBalance, _selectors: Array) -> Explicit | None:
        """Derivatives of the tangent vectors at a contact that do not pass through angle and force; None without any."""
        return None

    def _cut(
        self, state: State, element: int, pairs: tuple[int, ...], balance: RodBalance, transfer: Array
    ) -> CutElement:
        first, count = int(balance.entry.place.first[element]), len(pairs)
        inputs, fixed, selectors = self.chain(count)
        inputs, tangent = inputs.astype(transfer.dtype), fixed.astype(transfer.dtype)
        moved, slip = tangent[3:5].copy(), {}
        for k in range(count):
            s, row = first + k, OWN + CUT * k
            out = transfer[s] @ inputs[k]
            inputs[k + 1, 1] = out[1]
            moved += out[2:]
            tangent[row : row + 2] = moved
            pair, touch, tangents = (
                self.model.pairs[pairs[k]],
                touch_of(state, pairs[k]),
                balance.tangents[pairs[k]],
            )
            rows, own = tangent[row : row + 3], self.explicit(state, pairs[k], balance, selectors[k])
            face = pair.reach_at(pair.arc_position(touch)), pair.steep
            contact_rows.differentiate(rows, touch.force, tangents, face, selectors[k], own)
            if touch.grip is not None:
                forms = balance.entry.rubbing[pairs[k]].differentiate(
                    touch.grip, self.model.stick_stiffness, tangents, selectors[k], out[1], own
                )
                rows[2], slip[pairs[k]] = forms.row, forms.slip
                inputs[k + 1, 1] = out[1] - forms.couple
            tangent[row + 3] = out[0]
        out = transfer[first + count] @ inputs[count]
        tangent[3:5] = moved + out[2:]
        tangent[3, 6] = tangent[4, 7] = -1
        tangent[5], tangent[8] = out[0], out[1]
        return CutElement(element, pairs, tangent, inputs, slip)

    def inside(
        self, tangent: RodTangent, state: State, dq: Array, contacts: Array, fixed: tuple[float, float]
    ) -> Array:
        """Change of the inner angles that follows from a change of all other unknowns.

        ``tangent``: at the state. ``state``: configuration before the change. ``dq`` (dofs,): change of the
        displacements and element forces. ``contacts`` (contact unknowns,): change of the contacts' unknowns.
        ``fixed``: change of the load parameter; then 1 to remove the residual inside, 0 to follow a path on
        which it is zero.
        """
        inputs = self.inputs(tangent, state, dq, contacts, fixed)
        change: Array = (tangent.inner @ inputs[:, :, None])[:, :, 0]
        return change

    def inputs(
        self, tangent: RodTangent, state: State, dq: Array, contacts: Array, fixed: tuple[float, float]
    ) -> Array:
        """Change (s, inputs) of the inputs of the segments, see `inside`."""
        place = layout(len(self.length), profile_of(state).cuts)
        x = dq[self.dofs]
        inputs = np.zeros((len(place.owner), tangent.inner.shape[2]))
        inputs[:, :5] = x[COLUMNS][:, place.owner].T
        inputs[:, 6], inputs[:, 8:] = fixed[1], fixed[0]
        for part in tangent.cut:
            slots = self.slots(part.pairs)
            z = np.concatenate([x[:, part.element], contacts[slots], self.fixed(*fixed)])
            first = place.first[part.element]
            inputs[first : first + len(part.inputs)] = part.inputs @ z
        return inputs

    def fixed(self, _load: float, constant: float) -> tuple[float, ...]:
        """Last columns of a tangent: what is no unknown."""
        return (constant,)

    def load_rate(self, state: State, _contacts: Array) -> Array:
        """Change of the forces with the load parameter, none without loads along elements."""
        return np.zeros_like(state.q[self.dofs])

    def load_work(self, _state: State) -> float:
        """Work of loads along elements, of which there are none."""
        return 0.0

    def load_power(self, _state: State, _tangent: RodTangent, _dofs: Array, _contacts: Array) -> float:
        """Power of loads along elements, of which there are none."""
        return 0.0

    def slots(self, pairs: tuple[int, ...]) -> list[int]:
        """Positions of the pairs' unknowns among the contacts' unknowns."""
        return [self.model.pairs[k].slot + i for k in pairs for i in range(CUT)]

    def energy(self, state: State) -> float:
        """Strain energy of the exact elements."""
        entry = self.enter(state)
        segments, field, (stretch, shear, bend) = entry.segments, entry.field, entry.segments.flexibility
        table = collocation(segments.angle.shape[1])
        moment = entry.moment + segments.length * (field.values[0] @ table.once.T)
        density = bend * moment**2 + stretch * field.N**2 + shear * field.q**2
        return float((segments.length * density @ table.w).sum()) / 2


def profile_of(state: State) -> Profile:
    """Angles inside the exact elements of a model that has some."""
    assert state.profile is not None, "a model with exact elements has their profile"
    return state.profile


def touch_of(state: State, k: int) -> Touch:
    """Closed contact of pair k."""
    touch = state.touches[k]
    assert touch is not None, "a cut is a closed contact"
    return touch

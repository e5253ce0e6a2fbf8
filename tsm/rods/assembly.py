"""Residual and tangent of the exact elements: segments between loads, chained and condensed.

An element is cut at its contacts. Its unknowns are the nodes' displacements, the internal force n and moment m at its start, and
for every contact the force F, the arc position and the section's angle there; between cuts the force is n less the contact
forces before. Its equations are arrival at the end node and, at every cut, position and direction of the contact and arrival of
the angle. The angles inside the segments are eliminated (`tsm.elements.rod`) and kept in the state.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tsm.elements import rod
from tsm.elements.collocation import collocation
from tsm.elements.properties import Array
from tsm.elements.rod import INPUTS, Arrival, Field, Flexibility, Segments
from tsm.rods import contact_rows
from tsm.rods.friction_rows import Rubbing, placed, rubbing
from tsm.rods.layout import COLUMNS, CUT, FIXED, OWN, ROWS, Layout, chain, layout
from tsm.state import Cuts, Profile, State, Touch

if TYPE_CHECKING:
    from tsm.model import Model
    from tsm.rods.shape import RodShape


_KEPT = 16
"""Divisions into segments whose constants are kept."""


class Owned(NamedTuple):
    """Constants of the elements, one for every segment.

    Attributes
    ----------
    place : Layout
        The segments.
    dofs : ndarray of int, shape (9, s)
        Degrees of freedom of the elements.
    angle0, length : ndarray, shape (s,)
        Angle of the undeformed elements, and their length.
    flexibility : Flexibility
        Flexibilities of the elements.
    """

    place: Layout
    dofs: Array
    angle0: Array
    length: Array
    flexibility: Flexibility


class Entry(NamedTuple):
    """Where the segments of a state begin and end.

    Attributes
    ----------
    place : Layout
        Elements of the segments.
    segments : rod.Segments
        Force, length and angles inside.
    field : rod.Field
        The rod's equations there.
    start, end, moment : ndarray, shape (s, 1)
        Angles at both ends, moment at the start.
    gain : ndarray, shape (s,)
        Moment at the end minus moment at the start.
    vector : ndarray, shape (2, s)
        Vector from start to end.
    rubbing : dict of Rubbing
        Contacts with friction, by pair.
    """

    place: Layout
    segments: Segments
    field: Field
    start: Array
    end: Array
    moment: Array
    gain: Array
    vector: Array
    rubbing: dict[int, Rubbing]


class RodBalance(NamedTuple):
    """Residual of the exact elements.

    Attributes
    ----------
    entry : Entry
        The segments.
    arrival : rod.Arrival
        Their residuals.
    nodal : ndarray, shape (9, r)
        Forces on node i, arrival at node j, forces on node j.
    contacts : dict of list
        By pair: the rows of position (2), direction and arrival of the angle.
    tangents : dict of tuple
        By pair: the axis' tangent vectors before and after the contact.
    inside : float
        Largest residual inside [rad].
    """

    entry: Entry
    arrival: Arrival
    nodal: Array
    contacts: dict[int, list[Any]]
    tangents: dict[int, tuple[rod.Tangent, rod.Tangent]]
    inside: float

    @property
    def ends(self) -> Array:
        """Forces and moments at both ends of the elements, shape (6, r)."""
        ends: Array = self.nodal[[0, 1, 2, 6, 7, 8]]
        return ends


class CutElement(NamedTuple):
    """Tangent of an element with contacts.

    Attributes
    ----------
    element : int
        Counted over the exact elements.
    pairs : tuple of int
        Its contact pairs in order of arc position.
    tangent : ndarray, shape (9 + 4 k, 10 + 4 k)
        Tangent over the unknowns of the element, then of the contacts. The last column is the contribution of the inner residual.
    inputs : ndarray, shape (k + 1, 7, 10 + 4 k)
        Inputs of the segments by the same unknowns.
    slip : dict of ndarray, shape (10 + 4 k,)
        By pair with friction: its slip rate as a linear form over the same unknowns.
    """

    element: int
    pairs: tuple[int, ...]
    tangent: Array
    inputs: Array
    slip: dict[int, Array]


class RodTangent(NamedTuple):
    """Tangent of the exact elements.

    Attributes
    ----------
    condensed_residual : ndarray, shape (9, r)
        Contribution of the inner residual to the residual after the inner unknowns are eliminated.
    tangent : ndarray, shape (81, r)
        Derivative of the residual, row by row.
    cut : tuple of CutElement
        Tangents of the elements with contacts. The part without contacts is in the arrays above too.
    inner : ndarray, shape (s, p, 7)
        Derivatives of the angles inside by the inputs of the segments.
    transfer : ndarray, shape (s, 4, 7)
        Derivatives of their outputs, see `rod.Condensed`.
    """

    condensed_residual: Array
    tangent: Array
    cut: tuple[CutElement, ...]
    inner: Array
    transfer: Array


class Memo(NamedTuple):
    """Cache of the last deflected axis, with its state and the closest points by pair."""

    state: State
    shape: RodShape
    closest: dict[int, Any]


class Rods:
    """The exact elements of a model.

    Parameters
    ----------
    model : Model
        The structure.
    dofs : ndarray of int, shape (9, r)
        Degrees of freedom of the elements.
    exact : ndarray of int, shape (r,)
        Global numbers of the elements.
    """

    def __init__(self, model: Model, dofs: Array, exact: Array) -> None:
        self.model, self.dofs = model, dofs
        nodes = model.element_nodes[exact]
        self.start, self.end = model.coordinates[nodes[:, 0]].T, model.coordinates[nodes[:, 1]].T
        p = model.properties
        self.angle0 = np.arctan2(p.dy0[exact], p.dx0[exact])
        self.length = p.l0[exact]
        psi = p.Phi[exact] * self.length**2 / 12
        self.flexibility = Flexibility(1 / p.EA[exact], psi / p.EI[exact], 1 / p.EI[exact])
        self._constants: dict[Cuts, Owned] = {}
        self.memo: Memo | None = None

    def enter(self, state: State) -> Entry:
        """Cut the elements at their contacts and evaluate the rod's equations inside."""
        profile = profile_of(state)
        place, dofs, angle0, length, flexibility = self._owned(profile.cuts)
        q, length = state.q[dofs], length.copy()
        force, start, end, moment = q[3:5, :, None], q[2] + angle0, q[8] + angle0, q[5]
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
        segments = Segments(flexibility, force, length[:, None], profile.angle)
        field = rod.field(segments)
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
            place, segments, field, start[:, None], end[:, None], moment[:, None], gain, sums[1:], rubbed
        )

    def _rubbing(self, state: State, k: int, segments: Segments, s: int, moment: Any) -> Rubbing:
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
                place, self.dofs[:, own], self.angle0[own], self.length[own], flexibility
            )
        return self._constants[cuts]

    def balance(self, state: State) -> RodBalance:
        """Residual at a state."""
        entry = self.enter(state)
        arrival = rod.arrival(entry.segments, entry.field, entry.start, entry.moment, entry.end)
        q = state.q[self.dofs]
        first, last = entry.place.first, entry.place.last
        residual = np.empty_like(q)
        residual[0:3] = -q[3:6]
        residual[3:5] = (self.start - self.end) + (q[0:2] - q[6:8]) + entry.vector[:, first]
        residual[5] = arrival.end_residual[last]
        residual[6:8] = entry.segments.force[:, last, 0]
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
                rows = contact_rows.residual((x - cx, y - cy), touch.force, tangents[k], pair.reach)
                if touch.grip is not None:
                    rows[2] = entry.rubbing[k].residual(touch.grip, self.model.stick_stiffness)
                contacts[k] = [*rows, arrival.end_residual[s]]
                residual[3:5, element] += entry.vector[:, s + 1]
                s += 1
        largest = float(np.abs(arrival.inside).max())
        return RodBalance(entry, arrival, residual, contacts, tangents, largest)

    def _tangents(self, state: State, k: int, segments: Segments, s: int) -> tuple[rod.Tangent, rod.Tangent]:
        """Tangent vectors before and after the contact at the end of segment s."""
        flexibility = segments.flexibility
        stretch, shear = float(flexibility.stretch[s, 0]), float(flexibility.shear[s, 0])
        angle = touch_of(state, k).angle
        (x, y), (xx, yy) = (segments.force[:, n, 0].tolist() for n in (s, s + 1))
        return rod.tangent(stretch, shear, (x, y), angle), rod.tangent(stretch, shear, (xx, yy), angle)

    def linearise(self, state: State, balance: RodBalance) -> RodTangent:
        """Tangent at a state."""
        entry = balance.entry
        condensed = rod.condense(entry.segments, entry.field, balance.arrival, entry.moment)
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

    def _cut(
        self, state: State, element: int, pairs: tuple[int, ...], balance: RodBalance, transfer: Array
    ) -> CutElement:
        first, count = int(balance.entry.place.first[element]), len(pairs)
        inputs, fixed, selectors = chain(count)
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
            rows = tangent[row : row + 3]
            contact_rows.differentiate(rows, touch.force, tangents, pair.reach, selectors[k, :5])
            if touch.grip is not None:
                forms = balance.entry.rubbing[pairs[k]].differentiate(
                    touch.grip, self.model.stick_stiffness, tangents, selectors[k], out[1]
                )
                rows[2], slip[pairs[k]] = forms.row, forms.slip
                inputs[k + 1, 1] = out[1] - forms.couple
            tangent[row + 3] = out[0]
        out = transfer[first + count] @ inputs[count]
        tangent[3:5] = moved + out[2:]
        tangent[3, 6] = tangent[4, 7] = -1
        tangent[5], tangent[8] = out[0], out[1]
        return CutElement(element, pairs, tangent, inputs, slip)

    def inside(self, tangent: RodTangent, state: State, dq: Array, contacts: Array, constant: float) -> Array:
        """Change of the inner angles that follows from a change of all other unknowns.

        Parameters
        ----------
        tangent : RodTangent
            At the state.
        state : State
            Where.
        dq : ndarray, shape (dofs,)
            Change of the displacements and element forces.
        contacts : ndarray, shape (contact unknowns,)
            Change of the contacts' unknowns.
        constant : float
            1 to remove the residual inside, 0 to follow a path on which it is zero.
        """
        place = layout(len(self.length), profile_of(state).cuts)
        x = dq[self.dofs]
        inputs = np.zeros((len(place.owner), INPUTS))
        inputs[:, :5] = x[COLUMNS][:, place.owner].T
        inputs[:, 6] = constant
        for part in tangent.cut:
            slots = self.slots(part.pairs)
            z = np.concatenate([x[:, part.element], contacts[slots], [constant]])
            first = place.first[part.element]
            inputs[first : first + len(part.inputs)] = part.inputs @ z
        change: Array = (tangent.inner @ inputs[:, :, None])[:, :, 0]
        return change

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

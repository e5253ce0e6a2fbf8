"""Exact elements in a model: segments between loads, chained and condensed.

An element is cut at its contacts. Its unknowns are the nodes' displacements, the internal force n and moment m at its start, and
for every contact the force F, the arc position and the section's angle there; between cuts the force is n less the contact
forces before. Its equations are arrival at the end node and, at every cut, position and direction of the contact and arrival of
the angle. The angles inside the segments are eliminated (`tsm.elements.rod`) and kept in the state.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tsm.elements import rod
from tsm.elements.collocation import collocation
from tsm.elements.properties import Array
from tsm.elements.rod import INPUTS, Arrival, Field, Flexibility, Segments
from tsm.rod_shape import RodShape, Station, Stations
from tsm.state import Cuts, Profile, State, Touch

if TYPE_CHECKING:
    from tsm.model import Model

OWN = 9
"""Unknowns of an element without contacts: node i (3), force and moment at its start (3), node j (3)."""
START_ORDER = 14
"""Gauss nodes of a straight element."""
MOST_NODES = 96
_AT_ONCE = 4
"""Nodes added at least."""
_SMOOTH = 1e-13
"""Error inside that does not show."""
_FALL = 100.0
"""What the error is expected to fall by with two nodes more."""
CUT = 4
"""Unknowns of a contact: force (2), arc position, angle. Its rows: position (2), direction, arrival of the angle."""
_COLUMNS = np.array([2, 5, 8, 3, 4])
_ROWS = np.array([5, 8, 3, 4])
_FIXED = np.zeros((OWN, OWN))
_FIXED[[0, 1, 2, 3, 4], [3, 4, 5, 6, 7]] = -1
_FIXED[[6, 7, 3, 4], [3, 4, 0, 1]] = 1


class Layout(NamedTuple):
    """Segments of the elements, one after another.

    Attributes
    ----------
    owner : ndarray of int, shape (s,)
        Element of every segment, counted over the exact elements.
    first, last : ndarray of int, shape (r,)
        First and last segment of every element.
    """

    owner: Array
    first: Array
    last: Array


@lru_cache(maxsize=256)
def layout(count: int, cuts: Cuts) -> Layout:
    """Segments of `count` elements with given cuts."""
    segments = np.ones(count, dtype=int)
    for element, pairs in cuts:
        segments[element] += len(pairs)
    last = np.cumsum(segments) - 1
    return Layout(np.repeat(np.arange(count), segments), last - segments + 1, last)


@lru_cache(maxsize=16)
def _chain(count: int) -> tuple[Array, Array, Array]:
    """What is constant in an element with `count` cuts.

    Returns
    -------
    inputs : ndarray, shape (count + 1, 7, unknowns + 1)
        Inputs of the segments by the element's unknowns, the moments at the cuts left open.
    tangent : ndarray, shape (unknowns, unknowns + 1)
        Tangent, all but the rows of arrival and of the contacts.
    selectors : ndarray, shape (count, 5, unknowns + 1)
        Angle, force before and contact force (x, y) of every cut by the unknowns.
    """
    unknowns = OWN + CUT * count
    inputs = np.zeros((count + 1, INPUTS, unknowns + 1))
    inputs[:, 3, 3] = inputs[:, 4, 4] = inputs[:, 6, -1] = 1
    inputs[0, 0, 2] = inputs[0, 1, 5] = inputs[-1, 2, 8] = 1
    selectors = np.zeros((count, 5, unknowns + 1))
    for k in range(count):
        own = OWN + CUT * k
        selectors[k, [0, 3, 4], [own + 3, own, own + 1]] = 1
        selectors[k, 1:3] = inputs[k, 3:5]
        inputs[k + 1 :, 3, own] = inputs[k + 1 :, 4, own + 1] = -1
        inputs[k, 5, own + 2] = inputs[k, 2, own + 3] = inputs[k + 1, 0, own + 3] = 1
        inputs[k + 1, 5, own + 2] = -1
    tangent = np.zeros((unknowns, unknowns + 1))
    tangent[:OWN, :OWN] = _FIXED
    tangent[6:8] = inputs[-1, 3:5]
    tangent[3, 6] = tangent[4, 7] = 0
    return inputs, tangent, selectors


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
        Of the elements.
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
        To which elements they belong.
    at : rod.Segments
        Force, length and angles inside.
    of : rod.Field
        The rod's equations there.
    start, end, moment : ndarray, shape (s, 1)
        Angles at both ends, moment at the start.
    gain : ndarray, shape (s,)
        Moment at the end less that at the start.
    vector : ndarray, shape (2, s)
        From start to end.
    """

    place: Layout
    at: Segments
    of: Field
    start: Array
    end: Array
    moment: Array
    gain: Array
    vector: Array


class RodBalance(NamedTuple):
    """Residual of the exact elements.

    Attributes
    ----------
    entry : Entry
        The segments.
    arrival : rod.Arrival
        Their residuals.
    residual : ndarray, shape (9, r)
        On node i, of the arrival at node j, and on node j.
    contacts : dict of list
        By pair: the rows of position (2), direction and arrival of the angle.
    tangents : dict of tuple
        By pair: the axis' tangent vectors before and after the contact.
    inside : float
        Largest residual inside [rad].
    """

    entry: Entry
    arrival: Arrival
    residual: Array
    contacts: dict[int, list[Any]]
    tangents: dict[int, tuple[rod.Tangent, rod.Tangent]]
    inside: float


class CutElement(NamedTuple):
    """Tangent of an element with contacts.

    Attributes
    ----------
    element : int
        Counted over the exact elements.
    pairs : tuple of int
        Its contact pairs in order of arc position.
    tangent : ndarray, shape (9 + 4 k, 10 + 4 k)
        Over the element's unknowns, then the contacts'; the last column is what the residual inside adds.
    inputs : ndarray, shape (k + 1, 7, 10 + 4 k)
        Inputs of the segments by the same unknowns.
    """

    element: int
    pairs: tuple[int, ...]
    tangent: Array
    inputs: Array


class RodTangent(NamedTuple):
    """Tangent of the exact elements.

    Attributes
    ----------
    carried : ndarray, shape (9, r)
        What the residual inside adds to the residual once it is eliminated.
    tangent : ndarray, shape (81, r)
        Derivative of the residual, row by row.
    cut : tuple of CutElement
        Elements with contacts; what they have in common with the others is in the arrays above too.
    inner : ndarray, shape (s, p, 7)
        Derivatives of the angles inside by the inputs of the segments.
    """

    carried: Array
    tangent: Array
    cut: tuple[CutElement, ...]
    inner: Array


class Rods:
    """The exact elements of a model."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.dofs = model.exact_dofs
        nodes, exact = model.element_nodes[model.exact], model.exact
        self.start, self.end = model.coordinates[nodes[:, 0]].T, model.coordinates[nodes[:, 1]].T
        p = model.properties
        self.angle0 = np.arctan2(p.dy0[exact], p.dx0[exact])
        self.length = p.l0[exact]
        psi = p.Phi[exact] * self.length**2 / 12
        self.flexibility = Flexibility(1 / p.EA[exact], psi / p.EI[exact], 1 / p.EI[exact])
        self._last: tuple[State, RodShape] | None = None
        self._constants: dict[Cuts, Owned] = {}

    def enter(self, state: State) -> Entry:
        """Cut the elements at their contacts and evaluate the rod's equations inside."""
        profile = _profile(state)
        place, dofs, angle0, length, flexibility = self._owned(profile.cuts)
        q, length = state.q[dofs], length.copy()
        force, start, end, moment = q[3:5, :, None], q[2] + angle0, q[8] + angle0, q[5]
        for element, pairs in profile.cuts:
            s, behind = int(place.first[element]), 0.0
            for k in pairs:
                touch = _touch(state, k)
                arc = touch.xi * self.length[element]
                length[s], behind = arc - behind, arc
                end[s] = start[s + 1] = touch.angle
                s += 1
                force[0, s, 0] = force[0, s - 1, 0] - touch.force[0]
                force[1, s, 0] = force[1, s - 1, 0] - touch.force[1]
            length[s] = self.length[element] - behind
        at = Segments(flexibility, force, length[:, None], profile.angle)
        of = rod.field(at)
        sums = of.sums[:, :, 0] * length
        gain = sums[0]
        for element, _ in profile.cuts:
            for s in range(place.first[element], place.last[element]):
                moment[s + 1] = moment[s] + gain[s]
        return Entry(place, at, of, start[:, None], end[:, None], moment[:, None], gain, sums[1:])

    def _owned(self, cuts: Cuts) -> Owned:
        if cuts not in self._constants:
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
        arrival = rod.arrival(entry.at, entry.of, entry.start, entry.moment, entry.end)
        q = state.q[self.dofs]
        first, last = entry.place.first, entry.place.last
        residual = np.empty_like(q)
        residual[0:3] = -q[3:6]
        residual[3:5] = (self.start - self.end) + (q[0:2] - q[6:8]) + entry.vector[:, first]
        residual[5] = arrival.miss[last]
        residual[6:8] = entry.at.force[:, last, 0]
        residual[8] = entry.moment[last, 0] + entry.gain[last]
        contacts: dict[int, list[Any]] = {}
        tangents: dict[int, tuple[rod.Tangent, rod.Tangent]] = {}
        for element, pairs in _profile(state).cuts:
            s = int(first[element])
            x, y = (self.start[:, element] + q[:2, element]).tolist()
            for k in pairs:
                dx, dy = entry.vector[:, s].tolist()
                x, y = x + dx, y + dy
                tangents[k] = self._tangents(state, k, entry, s)
                contacts[k] = [*self._contact(state, k, tangents[k], (x, y)), arrival.miss[s]]
                residual[3:5, element] += entry.vector[:, s + 1]
                s += 1
        largest = float(np.abs(arrival.inside).max())
        return RodBalance(entry, arrival, residual, contacts, tangents, largest)

    def _tangents(self, state: State, k: int, entry: Entry, s: int) -> tuple[rod.Tangent, rod.Tangent]:
        """Tangent vectors before and after the contact at the end of segment s."""
        flexibility = entry.at.flexibility
        stretch, shear = float(flexibility.stretch[s, 0]), float(flexibility.shear[s, 0])
        angle = _touch(state, k).angle
        (x, y), (xx, yy) = (entry.at.force[:, n, 0].tolist() for n in (s, s + 1))
        return rod.tangent(stretch, shear, (x, y), angle), rod.tangent(stretch, shear, (xx, yy), angle)

    def _contact(
        self,
        state: State,
        k: int,
        tangents: tuple[rod.Tangent, rod.Tangent],
        position: tuple[Any, Any],
    ) -> list[Any]:
        """Residual of position and direction of a contact."""
        pair, touch = self.model.pairs[k], _touch(state, k)
        before, after = tangents
        tx, ty = before.vector[0] + after.vector[0], before.vector[1] + after.vector[1]
        cx, cy = self.model.node_position(pair, state.q, state.load_parameter)
        x, y = position[0] - cx, position[1] - cy
        if pair.pair.offset:
            reach = pair.side * pair.pair.offset / (tx * tx + ty * ty) ** 0.5
            x, y = x + reach * ty, y - reach * tx
        return [x, y, touch.force[0] * tx + touch.force[1] * ty]

    def linearise(self, state: State, balance: RodBalance) -> RodTangent:
        """Tangent at a state."""
        entry = balance.entry
        condensed = rod.condense(entry.at, entry.of, balance.arrival, entry.moment)
        first = entry.place.first
        tangent = np.empty((len(first), OWN, OWN), dtype=state.q.dtype)
        tangent[:] = _FIXED
        transfer = condensed.transfer[first]
        tangent[:, _ROWS[:, None], _COLUMNS] = transfer[:, :, :5]
        carried = np.zeros_like(balance.residual)
        carried[_ROWS] = transfer[:, :, 6].T
        cut = tuple(
            self._cut(state, e, pairs, balance, condensed.transfer) for e, pairs in _profile(state).cuts
        )
        for part in cut:
            e = part.element
            tangent[e], carried[:, e] = part.tangent[:OWN, :OWN], part.tangent[:OWN, -1]
        return RodTangent(carried, tangent.reshape(len(first), -1).T, cut, condensed.inner)

    def _cut(
        self, state: State, element: int, pairs: tuple[int, ...], balance: RodBalance, transfer: Array
    ) -> CutElement:
        first, count = int(balance.entry.place.first[element]), len(pairs)
        chain, fixed, selectors = _chain(count)
        inputs, tangent = chain.astype(transfer.dtype), fixed.astype(transfer.dtype)
        moved = tangent[3:5].copy()
        for k in range(count):
            s, row = first + k, OWN + CUT * k
            out = transfer[s] @ inputs[k]
            inputs[k + 1, 1] = out[1]
            moved += out[2:]
            tangent[row : row + 2] = moved
            self._turn(state, pairs[k], balance.tangents[pairs[k]], tangent[row : row + 3], selectors[k])
            tangent[row + 3] = out[0]
        out = transfer[first + count] @ inputs[count]
        tangent[3:5] = moved + out[2:]
        tangent[3, 6] = tangent[4, 7] = -1
        tangent[5], tangent[8] = out[0], out[1]
        return CutElement(element, pairs, tangent, inputs)

    def _turn(
        self,
        state: State,
        k: int,
        tangents: tuple[rod.Tangent, rod.Tangent],
        rows: Array,
        selectors: Array,
    ) -> None:
        """Enter the derivatives of a contact's direction into its rows, and those of its offset."""
        pair, (Fx, Fy) = self.model.pairs[k], _touch(state, k).force
        before, after = tangents
        tx, ty = before.vector[0] + after.vector[0], before.vector[1] + after.vector[1]
        ux, uy = before.turned[0] + after.turned[0], before.turned[1] + after.turned[1]
        (xx, xy, yy), (ax, ay, aa) = before.compliance, after.compliance
        sx, sy, ss = xx + ax, xy + ay, yy + aa
        by = [
            [ux, sx, sy, -ax, -ay],
            [uy, sy, ss, -ay, -aa],
            [
                Fx * ux + Fy * uy,
                Fx * sx + Fy * sy,
                Fx * sy + Fy * ss,
                tx - Fx * ax - Fy * ay,
                ty - Fx * ay - Fy * aa,
            ],
        ]
        if not pair.pair.offset:
            rows[2] = np.array(by[2]) @ selectors
            return
        turned = np.array(by) @ selectors
        rows[2] = turned[2]
        square = tx * tx + ty * ty
        across = (tx * turned[1] - ty * turned[0]) * (pair.side * pair.pair.offset / square**1.5)
        rows[0] += tx * across
        rows[1] += ty * across

    def inside(self, tangent: RodTangent, state: State, dq: Array, own: Array, constant: float) -> Array:
        """Change of the angles inside that belongs to a change of everything else.

        Parameters
        ----------
        tangent : RodTangent
            At the state.
        state : State
            Where.
        dq : ndarray, shape (dofs,)
            Change of the displacements and element forces.
        own : ndarray, shape (contact unknowns,)
            Of the contacts' unknowns.
        constant : float
            1 to remove the residual inside, 0 to follow a path on which it is zero.
        """
        place = layout(len(self.length), _profile(state).cuts)
        x = dq[self.dofs]
        inputs = np.zeros((len(place.owner), INPUTS))
        inputs[:, :5] = x[_COLUMNS][:, place.owner].T
        inputs[:, 6] = constant
        for part in tangent.cut:
            slots = self.slots(part.pairs)
            z = np.concatenate([x[:, part.element], own[slots], [constant]])
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
        at, of, (stretch, shear, bend) = entry.at, entry.of, entry.at.flexibility
        table = collocation(at.angle.shape[1])
        moment = entry.moment + at.length * (of.values[0] @ table.once.T)
        density = bend * moment**2 + stretch * of.N**2 + shear * of.q**2
        return float((at.length * density @ table.w).sum()) / 2

    def undeformed(self, touches: tuple[Touch | None, ...]) -> Profile:
        """Profile of the straight elements."""
        cuts = self.cuts(touches)
        owner = layout(len(self.length), cuts).owner
        return Profile(cuts=cuts, angle=np.repeat(self.angle0[owner][:, None], START_ORDER, axis=1))

    def cuts(self, touches: tuple[Touch | None, ...]) -> Cuts:
        """Where touches cut the elements."""
        found: dict[int, list[tuple[float, int]]] = {}
        for k, (pair, touch) in enumerate(zip(self.model.pairs, touches, strict=True)):
            if touch is not None and pair.cuts:
                found.setdefault(int(self.model.place[touch.element]), []).append((touch.xi, k))
        return tuple((element, tuple(k for _, k in sorted(on))) for element, on in sorted(found.items()))

    def recut(self, state: State, touches: tuple[Touch | None, ...]) -> State:
        """State with other touches, its profile cut where they are; a new touch takes the angle that it finds."""
        cuts = self.cuts(touches)
        if cuts == _profile(state).cuts:
            return replace(state, touches=touches)
        shape, given, q = self.shape(state), list(touches), state.q.copy()
        for element, pairs in cuts:
            for k in pairs:
                old, touch = state.touches[k], _touched(touches[k])
                if old is None:
                    angle = shape.at(element, np.array([touch.xi * self.length[element]])).angle[0]
                    given[k] = replace(touch, angle=float(angle))
                else:
                    self._shift(q, old.element, touch)
        cut = replace(state, q=q, touches=tuple(given))
        return self.sampled(shape, cut, cuts, _profile(state).angle.shape[1])

    def _shift(self, q: Array, before: int, touch: Touch) -> None:
        """Add the force of a contact that passed to another element to the starts that now lie before it, or take it away."""
        first, last = sorted((before, touch.element))
        sign = 1 if touch.element > before else -1
        for element in range(first + 1, last + 1):
            q[self.dofs[3:5, self.model.place[element]]] += sign * np.array(touch.force)

    def alike(self, history: list[State]) -> list[State]:
        """The latest states that are cut alike, with as many Gauss nodes as the last."""
        cuts, order = _profile(history[-1]).cuts, _profile(history[-1]).angle.shape[1]
        found: list[State] = []
        for state in reversed(history):
            if _profile(state).cuts != cuts:
                break
            same = _profile(state).angle.shape[1] == order
            found.insert(0, state if same else self.resampled(state, order))
        return found

    def sampled(self, shape: RodShape, state: State, cuts: Cuts, order: int) -> State:
        """State whose angles inside are taken from a shape."""
        place = layout(len(self.length), cuts)
        angle = np.empty((len(place.owner), order))
        nodes = collocation(order).c
        inside = dict(cuts)
        for element, (first, last) in enumerate(zip(place.first, place.last, strict=True)):
            arcs = [_touch(state, k).xi * self.length[element] for k in inside.get(element, ())]
            ends = np.array([0.0, *arcs, self.length[element]])
            at = ends[:-1, None] + np.diff(ends)[:, None] * nodes
            angle[first : last + 1] = shape.at(element, at.ravel()).angle.reshape(at.shape)
        return replace(state, profile=Profile(cuts=cuts, angle=angle))

    def shape(self, state: State) -> RodShape:
        """Deflected axis, as accurate between the Gauss nodes as at the ends of the segments.

        Inside, a polynomial of p Gauss nodes has order p, at the ends 2p; so it is computed anew with 2p nodes between the same ends.
        """
        if self._last is None or self._last[0] is not state:
            entry = self.enter(state)
            if math.sqrt(self.truncation(entry)) > _SMOOTH:
                entry = self._finer_inside(state)
            self._last = state, self._plain_shape(state, entry)
        return self._last[1]

    def _finer_inside(self, state: State) -> Entry:
        """Segments between the same ends, with twice the Gauss nodes."""
        finer = self.resampled(state, 2 * _profile(state).angle.shape[1])
        entry = self.enter(finer)
        for _ in range(5):
            arrival = rod.arrival(entry.at, entry.of, entry.start, entry.moment, entry.end)
            if np.abs(arrival.inside).max() < _SMOOTH:
                break
            inner = rod.condense(entry.at, entry.of, arrival, entry.moment).inner
            profile = _profile(finer)
            finer = replace(finer, profile=replace(profile, angle=profile.angle + inner[:, :, 6]))
            entry = self.enter(finer)
        return entry

    def finer(self, state: State, balance: RodBalance, accuracy: float) -> State | None:
        """State with more Gauss nodes, None where the error estimate of `truncation` is small enough."""
        order, error = _profile(state).angle.shape[1], self.truncation(balance.entry)
        if error <= accuracy or order == MOST_NODES:
            return None
        more = 2 * math.ceil(math.log(error / accuracy, _FALL)) if math.isfinite(error) else order
        return self.resampled(state, min(order + max(more, _AT_ONCE), 2 * order, MOST_NODES))

    def inaccurate(self, balance: RodBalance, accuracy: float) -> bool:
        """Whether the most Gauss nodes do not suffice."""
        return balance.arrival.bent.shape[1] == MOST_NODES and self.truncation(balance.entry) > accuracy

    def truncation(self, entry: Entry) -> float:
        """Estimated error of the integration, in positions over the longest beam's length and in angles.

        At the ends of a segment the error is the product of two interpolation errors, of the solution and of the influence of an error inside;
        both are measured by the last two Legendre coefficients of moment and tangent vector, and both integrations divide by p.
        """
        at, values = entry.at, entry.of.values
        order = values.shape[2]
        tail = np.abs(values @ collocation(order).legendre[-2:].T).max(axis=2)
        length = np.abs(at.length[:, 0])
        turn = tail[0] * length**2 * at.flexibility.bend[:, 0]
        largest = np.maximum(turn, tail[1:].max(axis=0) * length / self.model.length).max()
        return float(largest / order) ** 2

    def resampled(self, state: State, order: int) -> State:
        """State with another number of Gauss nodes."""
        shape = self._plain_shape(state, self.enter(state))
        return self.sampled(shape, state, _profile(state).cuts, order)

    def pieces(self, state: State, element: int, count: int) -> Stations:
        """Lines along an element, `count` for every segment."""
        shape, found = self.shape(state), []
        for s in range(shape.first[element], shape.last[element] + 1):
            sigma = np.linspace(0, 1, count + 1)
            at = shape.within(s, sigma)
            c, sn = np.cos(at.angle), np.sin(at.angle)
            nx, ny = at.force.T
            forces = np.stack([nx * c + ny * sn, ny * c - nx * sn, at.moment], axis=1)
            arc = shape.arc[s] + sigma * shape.length[s]
            found.append((arc, at.position, at.angle - self.angle0[element], forces))
        pairs = np.arange(count)[:, None] + np.arange(2)
        return Stations(
            *(np.concatenate([part[pairs] for part in column]) for column in zip(*found, strict=True))
        )

    def tangent(self, element: int, at: Station) -> tuple[Array, Array]:
        """Tangent vector r' of the axis at a single station of an element, and its derivative along the arc."""
        stretch, shear, bend = (float(value[element]) for value in self.flexibility)
        x, y = at.force[0].tolist()
        found = rod.tangent(stretch, shear, (x, y), float(at.angle[0]))
        return np.array(found.vector), np.array(found.turned) * (bend * float(at.moment[0]))

    def _plain_shape(self, state: State, entry: Entry) -> RodShape:
        at, of, place = entry.at, entry.of, entry.place
        table = collocation(at.angle.shape[1])
        moment = entry.moment + at.length * (of.values[0] @ table.once.T)
        x, y = self.start[:, place.owner] + state.q[self.dofs[:2]][:, place.owner]
        length = at.length[:, 0]
        arc = np.zeros(len(length))
        for element, _ in _profile(state).cuts:
            for s in range(place.first[element], place.last[element]):
                arc[s + 1] = arc[s] + length[s]
                x[s + 1], y[s + 1] = x[s] + entry.vector[0, s], y[s] + entry.vector[1, s]
        start = np.stack([x, y, entry.start[:, 0], entry.moment[:, 0]])
        rates = np.stack([*of.values[1:], at.flexibility.bend * moment, of.values[0]])
        return RodShape(place.first, place.last, arc, length, at.force[:, :, 0], start, rates)


def _profile(state: State) -> Profile:
    assert state.profile is not None, "a model with exact elements has their profile"
    return state.profile


def _touch(state: State, k: int) -> Touch:
    return _touched(state.touches[k])


def _touched(touch: Touch | None) -> Touch:
    assert touch is not None, "a cut is a closed contact"
    return touch

"""Exact elements in a model: segments between loads, chained and condensed.

An element is cut at its contacts. Its unknowns are the nodes' displacements, the internal force n and moment m at its start, and
for every contact the force F, the arc position and the section's angle there; between cuts the force is n less the contact
forces before. Its equations are arrival at the end node and, at every cut, position and direction of the contact and arrival of
the angle. The angles inside the segments are eliminated (`tsm.elements.rod`) and kept in the state.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tsm.elements import rod
from tsm.elements.collocation import collocation
from tsm.elements.properties import Array
from tsm.elements.rod import INPUTS, Condensed, Field, Flexibility
from tsm.rod_shape import RodShape, Stations
from tsm.state import Cuts, Profile, State, Touch

if TYPE_CHECKING:
    from tsm.model import Model

OWN = 9
"""Unknowns of an element without contacts: node i (3), force and moment at its start (3), node j (3)."""
START_ORDER = 6
"""Gauss nodes of a straight element."""
MOST_NODES = 96
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
def _chain(count: int) -> Array:
    """Inputs of the segments of an element with `count` cuts by its unknowns, the moments at the cuts left open."""
    unknowns = OWN + CUT * count
    inputs = np.zeros((count + 1, INPUTS, unknowns + 1))
    inputs[:, 3, 3] = inputs[:, 4, 4] = inputs[:, 6, -1] = 1
    inputs[0, 0, 2] = inputs[0, 1, 5] = inputs[-1, 2, 8] = 1
    for k in range(count):
        own = OWN + CUT * k
        inputs[k + 1 :, 3, own] = inputs[k + 1 :, 4, own + 1] = -1
        inputs[k, 5, own + 2] = inputs[k, 2, own + 3] = inputs[k + 1, 0, own + 3] = 1
        inputs[k + 1, 5, own + 2] = -1
    return inputs


class CutElement(NamedTuple):
    """Residual and tangent of an element with contacts.

    Attributes
    ----------
    element : int
        Counted over the exact elements.
    pairs : tuple of int
        Its contact pairs in order of arc position.
    residual : ndarray, shape (9 + 4 k,)
        Over the element's unknowns, then the contacts'.
    tangent : ndarray, shape (9 + 4 k, 10 + 4 k)
        Its derivatives; the last column is what the residual inside adds.
    inputs : ndarray, shape (k + 1, 7, 10 + 4 k)
        Inputs of the segments by the same unknowns.
    """

    element: int
    pairs: tuple[int, ...]
    residual: Array
    tangent: Array
    inputs: Array


class Segments(NamedTuple):
    """The segments of a state, evaluated.

    Attributes
    ----------
    place : Layout
        To which elements they belong.
    flexibility : Flexibility
        Of each.
    force : ndarray, shape (2, s, 1)
        Internal force.
    start, end, moment, length : ndarray, shape (s, 1)
        Angles at both ends, moment at the start, undeformed length.
    angle : ndarray, shape (s, p)
        Angles inside.
    at : Field
        The rod's equations there.
    gain : ndarray, shape (s,)
        Moment at the end less that at the start.
    vector : ndarray, shape (2, s)
        From start to end.
    """

    place: Layout
    flexibility: Flexibility
    force: Array
    start: Array
    end: Array
    moment: Array
    length: Array
    angle: Array
    at: Field
    gain: Array
    vector: Array

    def condense(self) -> Condensed:
        """Eliminate the angles inside."""
        return rod.condense(
            collocation(self.angle.shape[1]),
            self.flexibility,
            self.at,
            (self.start, self.moment, self.end),
            self.length,
            self.angle,
        )


class RodSystem(NamedTuple):
    """Residual and tangent of the exact elements.

    Attributes
    ----------
    residual : ndarray, shape (9, r)
        On node i, of the arrival at node j, and on node j.
    carried : ndarray, shape (9, r)
        What the residual inside adds once it is eliminated.
    tangent : ndarray, shape (81, r)
        Derivative of the residual, row by row.
    cut : tuple of CutElement
        Elements with contacts; theirs is in the arrays above too.
    segments : Segments
        What they were evaluated from.
    condensed : Condensed
        The same with their inside eliminated.
    inside : float
        Largest residual inside [rad].
    """

    residual: Array
    carried: Array
    tangent: Array
    cut: tuple[CutElement, ...]
    segments: Segments
    condensed: Condensed
    inside: float


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
        self._last: tuple[State, RodShape] | None = None
        self.flexibility = Flexibility(1 / p.EA[exact], psi / p.EI[exact], 1 / p.EI[exact])

    def evaluate(self, state: State) -> Segments:
        """Cut the elements at their contacts and evaluate the rod's equations inside."""
        profile = _profile(state)
        place = layout(len(self.length), profile.cuts)
        q = state.q[self.dofs][:, place.owner]
        turned = self.angle0[place.owner]
        force, start, end, moment = q[3:5, :, None], q[2] + turned, q[8] + turned, q[5]
        length = self.length[place.owner]
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
        flexibility = Flexibility(*(value[place.owner, None] for value in self.flexibility))
        at = rod.field(collocation(profile.angle.shape[1]), flexibility, force, profile.angle)
        gain, *vector = length * at.sums[:3, :, 0]
        for element, _ in profile.cuts:
            for s in range(place.first[element], place.last[element]):
                moment[s + 1] = moment[s] + gain[s]
        column = (slice(None), None)
        return Segments(
            place=place,
            flexibility=flexibility,
            force=force,
            start=start[column],
            end=end[column],
            moment=moment[column],
            length=length[column],
            angle=profile.angle,
            at=at,
            gain=gain,
            vector=np.array(vector),
        )

    def linearise(self, state: State) -> RodSystem:
        """Residual and tangent at a state."""
        segments = self.evaluate(state)
        condensed, place, q = segments.condense(), segments.place, state.q[self.dofs]
        first, last = place.first, place.last
        residual = np.empty_like(q)
        residual[0:3] = -q[3:6]
        residual[3:5] = (self.start - self.end) + (q[0:2] - q[6:8]) + segments.vector[:, first]
        residual[5] = condensed.miss[last]
        residual[6:8] = segments.force[:, last, 0]
        residual[8] = segments.moment[last, 0] + segments.gain[last]
        tangent = np.empty((len(first), OWN, OWN), dtype=q.dtype)
        tangent[:] = _FIXED
        transfer = condensed.transfer[first]
        tangent[:, _ROWS[:, None], _COLUMNS] = transfer[:, :, :5]
        carried = np.zeros_like(q)
        carried[_ROWS] = transfer[:, :, 6].T
        cuts = _profile(state).cuts
        cut = tuple(self._cut(state, e, pairs, segments, condensed) for e, pairs in cuts)
        for part in cut:
            e = part.element
            residual[3:5, e] = part.residual[3:5]
            tangent[e], carried[:, e] = part.tangent[:OWN, :OWN], part.tangent[:OWN, -1]
        return RodSystem(
            residual=residual,
            carried=carried,
            tangent=tangent.reshape(len(first), -1).T,
            cut=cut,
            segments=segments,
            condensed=condensed,
            inside=float(np.abs(condensed.residual).max()),
        )

    def _cut(
        self,
        state: State,
        element: int,
        pairs: tuple[int, ...],
        segments: Segments,
        condensed: Condensed,
    ) -> CutElement:
        first, count, vectors = int(segments.place.first[element]), len(pairs), segments.vector
        unknowns = OWN + CUT * count
        inputs = _chain(count).astype(vectors.dtype)
        tangent = np.zeros((unknowns, unknowns + 1), dtype=vectors.dtype)
        residual = np.zeros(unknowns, dtype=vectors.dtype)
        position = self.start[:, element] + state.q[self.dofs[:2, element]]
        moved = np.zeros((2, unknowns + 1), dtype=vectors.dtype)
        moved[[0, 1], [0, 1]] = 1
        force = state.q[self.dofs[3:5, element]]
        for k in range(count + 1):
            s = first + k
            out = condensed.transfer[s] @ inputs[k]
            position, moved = position + vectors[:, s], moved + out[2:]
            if k == count:
                break
            inputs[k + 1, 1] = out[1]
            rows = slice(OWN + CUT * k, OWN + CUT * (k + 1))
            contact, by_contact = self._contact(
                state, pairs[k], element, force, position, moved, inputs[k : k + 2]
            )
            residual[rows.start : rows.start + 3], tangent[rows.start : rows.start + 3] = contact, by_contact
            residual[rows.stop - 1], tangent[rows.stop - 1] = condensed.miss[s], out[0]
            force = force - np.array(_touch(state, pairs[k]).force)
        tangent[:3, 3:6] = -np.eye(3)
        tangent[3:5], tangent[5], tangent[8] = moved, out[0], out[1]
        tangent[3, 6] -= 1
        tangent[4, 7] -= 1
        tangent[6:8] = inputs[-1, 3:5]
        residual[3:5] = position - self.end[:, element] - state.q[self.dofs[6:8, element]]
        return CutElement(element, pairs, residual, tangent, inputs)

    def _contact(
        self,
        state: State,
        k: int,
        element: int,
        force: Array,
        position: Array,
        moved: Array,
        inputs: Array,
    ) -> tuple[Array, Array]:
        """Residual (3,) and tangent of position and direction of a contact."""
        pair, touch = self.model.pairs[k], _touch(state, k)
        stretch, shear = (value[element] for value in self.flexibility[:2])
        F = np.array(touch.force)
        before = rod.tangent(stretch, shear, (force[0], force[1]), touch.angle)
        after = rod.tangent(stretch, shear, (force[0] - F[0], force[1] - F[1]), touch.angle)
        t = np.array(before.vector) + np.array(after.vector)
        (xx, xy, yy), (ax, ay, aa) = before.compliance, after.compliance
        turned = np.array(before.turned) + np.array(after.turned)
        by_t = (
            turned[:, None] * inputs[0, 2]
            + np.array([[xx, xy], [xy, yy]]) @ inputs[0, 3:5]
            + np.array([[ax, ay], [ay, aa]]) @ inputs[1, 3:5]
        )
        by_force = inputs[0, 3:5] - inputs[1, 3:5]
        node = self.model.node_position(pair, state.q, state.load_parameter)
        miss, by_miss = position - np.array(node), moved.copy()
        if pair.pair.offset:
            length = np.sqrt(t[0] * t[0] + t[1] * t[1])
            normal = np.array([-t[1], t[0]]) / length
            reach = pair.side * pair.pair.offset
            miss = miss - reach * normal
            by_miss += (reach / length**2) * np.outer(t, normal @ by_t)
        direction = F @ by_t + t @ by_force
        return np.append(miss, F @ t), np.concatenate([by_miss, direction[None]])

    def inside(self, system: RodSystem, state: State, dq: Array, own: Array, constant: float) -> Array:
        """Change of the angles inside that belongs to a change of everything else.

        Parameters
        ----------
        system : RodSystem
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
        for part in system.cut:
            slots = self.slots(part.pairs)
            z = np.concatenate([x[:, part.element], own[slots], [constant]])
            first = place.first[part.element]
            inputs[first : first + len(part.inputs)] = part.inputs @ z
        change: Array = (system.condensed.inner @ inputs[:, :, None])[:, :, 0]
        return change

    def slots(self, pairs: tuple[int, ...]) -> list[int]:
        """Positions of the pairs' unknowns among the contacts' unknowns."""
        return [self.model.pairs[k].slot + i for k in pairs for i in range(CUT)]

    def energy(self, state: State) -> float:
        """Strain energy of the exact elements."""
        segments = self.evaluate(state)
        table, (stretch, shear, bend) = collocation(segments.angle.shape[1]), segments.flexibility
        c, s = np.cos(segments.angle), np.sin(segments.angle)
        nx, ny = segments.force
        N, Q = nx * c + ny * s, ny * c - nx * s
        moment = segments.moment + segments.length * (segments.at.values[0] @ table.once.T)
        density = bend * moment**2 + stretch * N**2 + shear * Q**2
        return float((segments.length * density @ table.w).sum()) / 2

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
        shape, given = self.shape(state), list(touches)
        for element, pairs in cuts:
            for k in pairs:
                touch = touches[k]
                if state.touches[k] is None and touch is not None:
                    angle = shape.at(element, np.array([touch.xi * self.length[element]])).angle[0]
                    given[k] = replace(touch, angle=float(angle))
        return self.sampled(shape, replace(state, touches=tuple(given)), cuts, _profile(state).angle.shape[1])

    def extrapolated(
        self, history: list[State], weights: list[float], state: State, touches: tuple[Touch | None, ...]
    ) -> State:
        """State with other touches whose angles inside are a weighted sum of earlier ones, where all are cut alike."""
        cuts, order = self.cuts(touches), _profile(state).angle.shape[1]
        if any(_profile(earlier).cuts != cuts for earlier in history):
            return self.recut(history[-1], touches)
        angle = np.zeros_like(_profile(state).angle)
        for weight, earlier in zip(weights, history, strict=True):
            alike = _profile(earlier).angle.shape[1] == order
            angle += weight * _profile(earlier if alike else self.resampled(earlier, order)).angle
        return replace(state, touches=touches, profile=Profile(cuts=cuts, angle=angle))

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
            finer = self.resampled(state, 2 * _profile(state).angle.shape[1])
            for _ in range(5):
                condensed = self.evaluate(finer).condense()
                profile = _profile(finer)
                finer = replace(
                    finer, profile=replace(profile, angle=profile.angle + condensed.inner[:, :, 6])
                )
                if np.abs(condensed.residual).max() < 1e-12:
                    break
            self._last = state, self._plain_shape(finer)
        return self._last[1]

    def finer(self, state: State, system: RodSystem, accuracy: float) -> State | None:
        """State with more Gauss nodes, None where the error estimate of `truncation` is small enough."""
        order = system.segments.angle.shape[1]
        error = self.truncation(system.segments)
        if error <= accuracy or order == MOST_NODES or not np.isfinite(error):
            return None
        steps = np.ceil(np.log(error / accuracy) / np.log(_FALL))
        return self.resampled(state, int(min(order + 2 * steps, 2 * order, MOST_NODES)))

    def truncation(self, segments: Segments) -> float:
        """Estimated error of the integration, in positions over the longest beam's length and in angles.

        At the ends of a segment the error is the product of two interpolation errors, of the solution and of the influence of an error inside;
        both are measured by the last two Legendre coefficients of moment and tangent vector, and both integrations divide by p.
        """
        order = segments.angle.shape[1]
        tail = np.abs(segments.at.values[:3] @ collocation(order).legendre[-2:].T).max(axis=2)
        length = np.abs(segments.length[:, 0])
        turn = tail[0] * length**2 * segments.flexibility.bend[:, 0]
        largest = np.maximum(turn, tail[1:].max(axis=0) * length / self.model.length).max()
        return float(largest / order) ** 2

    def resampled(self, state: State, order: int) -> State:
        """State with another number of Gauss nodes."""
        return self.sampled(self._plain_shape(state), state, _profile(state).cuts, order)

    def pieces(self, state: State, element: int, count: int) -> Stations:
        """Lines along an element, `count` for every segment."""
        shape, segments = self.shape(state), self.evaluate(state)
        found = []
        for s in range(segments.place.first[element], segments.place.last[element] + 1):
            sigma = np.linspace(0, 1, count + 1)
            at = shape.within(s, sigma)
            c, sn = np.cos(at.angle), np.sin(at.angle)
            nx, ny = segments.force[:, s, 0]
            forces = np.stack([nx * c + ny * sn, ny * c - nx * sn, at.moment], axis=1)
            arc = shape.arc[s] + sigma * shape.length[s]
            found.append((arc, at.position, at.angle - self.angle0[element], forces))
        pairs = np.arange(count)[:, None] + np.arange(2)
        return Stations(
            *(np.concatenate([part[pairs] for part in column]) for column in zip(*found, strict=True))
        )

    def tangent(self, state: State, segment: int, angle: float, moment: float) -> tuple[Array, Array]:
        """Tangent vector r' of the axis at a section, and its derivative along the arc."""
        force = self.evaluate(state).force[:, segment, 0]
        element = layout(len(self.length), _profile(state).cuts).owner[segment]
        stretch, shear, bend = (float(value[element]) for value in self.flexibility)
        at = rod.tangent(stretch, shear, (force[0], force[1]), angle)
        return np.array(at.vector), np.array(at.turned) * bend * moment

    def _plain_shape(self, state: State) -> RodShape:
        segments = self.evaluate(state)
        table, place = collocation(segments.angle.shape[1]), segments.place
        turning = segments.at.values[0]
        moment = segments.moment + segments.length * (turning @ table.once.T)
        x, y = self.start[:, place.owner] + state.q[self.dofs[:2]][:, place.owner]
        length = segments.length[:, 0]
        arc = np.zeros(len(length))
        for element, _ in _profile(state).cuts:
            for s in range(place.first[element], place.last[element]):
                arc[s + 1] = arc[s] + length[s]
                x[s + 1], y[s + 1] = x[s] + segments.vector[0, s], y[s] + segments.vector[1, s]
        start = np.stack([x, y, segments.start[:, 0], segments.moment[:, 0]])
        along = segments.at.values[1:3]
        rates = np.stack([*along, segments.flexibility.bend * moment, turning])
        return RodShape(place.first, place.last, arc, length, start, rates)


def _profile(state: State) -> Profile:
    assert state.profile is not None, "a model with exact elements has their profile"
    return state.profile


def _touch(state: State, k: int) -> Touch:
    touch = state.touches[k]
    assert touch is not None, "a cut is a closed contact"
    return touch

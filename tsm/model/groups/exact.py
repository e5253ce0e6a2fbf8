"""Exact elements: their state, and the deflected axis."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tsm.elements import rod
from tsm.elements.contact_law import Vector
from tsm.elements.properties import Array
from tsm.elements.varied import STEP
from tsm.model.groups.base import Stations
from tsm.model.groups.layout import layout
from tsm.model.groups.rods import Rods
from tsm.model.groups.shape import deflected, pieces, resampled, truncation
from tsm.model.mesh import BeamModel
from tsm.model.pairs import PairModel
from tsm.model.projection import Projection
from tsm.model.state import State, profile_of

MOST_NODES = 256
"""Largest number of Gauss nodes of a segment."""
_AT_ONCE = 4
"""Least number of nodes that are added."""
_FALL = 100.0
"""Expected ratio of the errors with two nodes more."""
_UNRESOLVED = 1.0
"""Estimated error with a fixed number of nodes at which the mesh is too coarse: the error of a bent
cantilever is then 3e-3. Boundary layers under strong tension exceed it, though their elements hardly turn."""
_SAMPLES = 33
"""Points of an element in the search for the nearest one."""
_POINTS, _LINES = 100, 60
"""Intervals in which a beam is drawn, and short lines along it, at least 10 and 4 for an element."""


class ExactGroup(Rods):
    """The exact elements of a model."""

    def turned(self, one: State, other: State, like: State) -> Array:
        """Differences of the angles at the Gauss nodes."""
        begin, end = (self._angles(state, like) for state in (one, other))
        return (end - begin).ravel()

    def _angles(self, state: State, like: State) -> Array:
        """Angles (s, p) inside at the Gauss nodes of another state, nan in elements that are cut otherwise there."""
        there = profile_of(like)
        here = profile_of(resampled(self, state, there.angle.shape[1]))
        if here.cuts == there.cuts:
            return here.angle
        angle = np.full(there.angle.shape, np.nan)
        (one, two), count = (dict(here.cuts), dict(there.cuts)), len(self.length)
        begin, end = layout(count, here.cuts), layout(count, there.cuts)
        for e in (e for e in range(count) if one.get(e) == two.get(e)):
            angle[end.first[e] : end.last[e] + 1] = here.angle[begin.first[e] : begin.last[e] + 1]
        return angle

    def alike(self, history: list[State]) -> list[State]:
        """The latest states that are cut alike, with as many Gauss nodes as the last."""
        cuts, order = profile_of(history[-1]).cuts, profile_of(history[-1]).angle.shape[1]
        states: list[State] = []
        for state in reversed(history):
            if profile_of(state).cuts != cuts:
                break
            states.insert(0, resampled(self, state, order))
        return states

    def refined(self, state: State, forces: Any, tolerance: float) -> State | None:
        """State with more Gauss nodes, None where the error estimate of `truncation` is small enough, or their number is fixed."""
        if self.nodes is not None:
            return None
        order, error = profile_of(state).angle.shape[1], truncation(self, forces.entry)
        if error <= tolerance or order == MOST_NODES:
            return None
        more = 2 * math.ceil(math.log(error / tolerance, _FALL)) if math.isfinite(error) else order
        return resampled(self, state, min(order + max(more, _AT_ONCE), 2 * order, MOST_NODES))

    def inaccurate(self, forces: Any, tolerance: float) -> bool:
        """Whether the most Gauss nodes do not suffice; with a fixed number, whether the mesh does not resolve the deflected axis."""
        if self.nodes is not None:
            return truncation(self, forces.entry) > _UNRESOLVED
        return forces.arrival.bent.shape[1] == MOST_NODES and truncation(self, forces.entry) > tolerance

    def integration_error(self, forces: Any) -> float:
        """Estimated error of the integration inside the elements."""
        return 0.0 if self.nodes else truncation(self, forces.entry)

    def point(self, element: int, arc: float, state: State) -> tuple[Vector, Vector, Vector]:
        """Point of an element's axis at an arc position, tangent vector r', and its derivative along the arc."""
        place = int(self.model.place[element])
        at, section = deflected(self, state)[0].at(place, np.array([arc])), self.section(place, arc, 0.0)
        turn = section.bend * at.moment[0] + section.curvature
        angle = at.angle[0] + 1j * STEP * turn
        tx, ty = rod.tangent(section.stretch, section.shear, at.force[0].tolist(), angle)
        x, y = at.position[0].tolist()
        return (x, y), (tx.real, ty.real), (tx.imag / STEP, ty.imag / STEP)

    def project(self, pair: PairModel, state: State) -> Projection:
        """Closest point, the last ones found at the same state kept."""
        _, known = deflected(self, state)
        if pair.slot not in known:
            known[pair.slot] = self._project(pair, state)
        return known[pair.slot]

    def _project(self, pair: PairModel, state: State) -> Projection:
        """Nearest of the points along the axis, and Newton's method from there."""
        target, xi = pair.target, np.linspace(0, 1, _SAMPLES)
        node = self.model.node_position(pair, state.q, state.load_parameter)
        points = self.axes(target, state, None, xi) - node
        nearest = np.argmin(np.einsum("emi,emi->em", points, points))
        e, sample = divmod(int(nearest), _SAMPLES)
        return self.closest(pair, state, e, float(xi[sample]) * target.lengths[e])

    def curvature(self, k: int, _state: State, forces: Any, _push: tuple[float, float]) -> float:
        """Curvature from the moment behind the contact, natural curvature and the mean stretch."""
        cut = forces.entry.cuts[k]
        angle, nx, ny, Fx, Fy, _, moment, _ = cut.at
        c, s = math.cos(angle), math.sin(angle)
        axial = (nx - Fx / 2) * c + (ny - Fy / 2) * s
        if cut.section.course is not None:
            Px, Py = cut.section.course.resultant[:, 0, 0]
            axial -= Px * c + Py * s
        turn = (moment - cut.couple) * cut.section.bend + cut.section.curvature
        return float(turn / (1 + axial * cut.section.stretch))

    def intervals(self, elements: int) -> int:
        """Intervals in which an element is drawn."""
        return max(10, math.ceil(_POINTS / elements))

    def axes(self, beam: BeamModel, state: State, _forces: Any, xi: Array) -> Array:
        """Deflected axes of the elements of a beam, shape (elements, m, 2)."""
        (shape, _), first = deflected(self, state), int(self.model.place[beam.first])
        return np.array([shape.at(first + e, xi * l0).position for e, l0 in enumerate(beam.lengths)])

    def section_axes(self, beam: BeamModel, shape: Array) -> Array:
        """Directions of the sections' normals at both ends of the elements."""
        own = self.model.place[beam.first : beam.last + 1]
        angle = np.append(self.angles[0, own], self.angles[1, own[-1]]) + shape[:, 2]
        return np.exp(1j * np.stack([angle[:-1], angle[1:]], axis=1))

    def stations(self, beam: BeamModel, state: State, _shape: Array, _section_forces: Array) -> Stations:
        """Short pieces of the segments."""
        (axis, _), first = deflected(self, state), int(self.model.place[beam.first])
        count = max(4, math.ceil(_LINES / beam.beam.elements))
        parts = [pieces(self, axis, first + e, count) for e in range(beam.beam.elements)]
        parts = [part._replace(arc=part.arc + arc) for arc, part in zip(beam.arcs, parts, strict=False)]
        return Stations(*(np.concatenate(column) for column in zip(*parts, strict=True)))

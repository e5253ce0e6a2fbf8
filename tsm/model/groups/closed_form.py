"""Elements whose forces follow from their nodes' displacements in closed form, and the contacts inside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from tsm.elements import beam as beam_element
from tsm.elements.axis import deflected_axes
from tsm.elements.contact_law import Vector
from tsm.elements.curve import Curve
from tsm.elements.properties import Array, Properties
from tsm.model.contact_block import ContactBlock
from tsm.model.groups.base import ElementGroup, GroupForces, GroupTangent, Stations
from tsm.model.mesh import BeamModel
from tsm.model.pairs import PairModel
from tsm.model.projection import Projection, nearest_chord
from tsm.model.state import State, Touch, touch_of

_POINTS = 10
"""Intervals in which an element is drawn."""


@dataclass(kw_only=True)
class ClosedFormForces(GroupForces):
    """Forces and tangents of elements in closed form, their contacts included."""

    tangent: Array  # derivatives of the forces, row by row; shape (36, e)


class ClosedFormGroup(ElementGroup):
    """Elements in closed form; their contacts follow the contact law of their element type."""

    internal = False

    def forces(self, state: State, contacts: ContactBlock) -> ClosedFormForces:
        """Forces and tangents of elements and contacts."""
        force, tangent = beam_element.response(self.model.coefficients, state.q[self.dofs])
        for k, pair in self.pairs:
            touch = state.touches[k]
            if touch is None:
                contacts.leave_open(pair)
                continue
            place = self.model.place[touch.element]
            gradient, block = pair.law.response(*self._contact(pair, touch, state))
            if pair.slot < 0:
                force[:, place] = tangent[:, place] = 0.0
            force[:, place] += gradient[:6]
            tangent[:, place] += block[:6, :6].ravel()
            contacts.close(k, pair, touch, gradient, block)
        return ClosedFormForces(nodal=force, tangent=tangent)

    def tangent(self, _state: State, forces: Any, _contacts: ContactBlock) -> GroupTangent:
        """Tangent, which is known with the forces."""
        none = np.zeros(self.dofs.shape)
        return GroupTangent(tangent=forces.tangent, condensed_residual=none, by_load=none)

    def energy(self, state: State) -> float:
        """Strain energy of elements and contacts in equilibrium."""
        total = float(beam_element.energy(self.model.coefficients, state.q[self.dofs]).sum())
        for k, pair in self.pairs:
            touch = state.touches[k]
            if touch is not None:
                total += pair.law.energy(*self._contact(pair, touch, state))
                dent = self._dent(pair, state.touches[:k], touch.element, touch.xi)
                total += float(dent @ touch.force)
        return total

    def _contact(self, pair: PairModel, touch: Touch, state: State) -> tuple[Any, ...]:
        """Arguments of the functions of a closed contact, see `ContactLaw`."""
        p, x, (start_x, start_y) = self._at(touch.element, state)
        cx, cy = self.model.node_position(pair, state.q, state.load_parameter)
        return p, x, (start_x - cx, start_y - cy), touch.xi, touch.force, pair.side, pair.pair.offset

    def _at(self, element: int, state: State) -> tuple[Properties, list[float], tuple[float, float]]:
        """Constants and displacements of an element, and the position of its end i."""
        x = state.q[self.model.dofs[:, element]].tolist()
        start_x, start_y = self.model.element_start[element]
        return self.model.element[element], x, (start_x + x[0], start_y + x[1])

    def _dent(self, pair: PairModel, touches: Sequence[Touch | None], element: int, xi: float) -> Array:
        """Deflection (2,) of an element at xi by the forces of contacts on it."""
        cross, total = pair.law.cross, np.zeros(2)
        for touch in touches:
            if cross and touch is not None and touch.element == element:
                total += cross(self.model.element[element], xi, touch.xi)[0] * np.array(touch.force)
        return total

    def point(self, element: int, arc: float, state: State) -> tuple[Vector, Vector, Vector]:
        """Point of the curve, its tangent, and the tangent's derivative."""
        p, x, (start_x, start_y) = self._at(element, state)
        curve, xi = Curve(p, x), arc / p.l0
        (w, dw, ddw), dx, dy = curve.deflection(xi), curve.dx, curve.dy
        position = start_x + xi * dx - w * dy, start_y + xi * dy + w * dx
        tangent, bend = ((dx - dw * dy) / p.l0, (dy + dw * dx) / p.l0), ddw / p.l0**2
        return position, tangent, (-bend * dy, bend * dx)

    def project(self, pair: PairModel, state: State) -> Projection:
        """Closest point. The chords give the owner, and Newton's method on the owner's curve gives the point."""
        target, model = pair.target, self.model
        node = model.node_position(pair, state.q, state.load_parameter)
        owner, xi = nearest_chord(model.positions(target, state.q), node)
        dent = partial(self._dent, pair, state.touches)
        return self.closest(pair, state, owner, xi * target.lengths[owner], dent)

    def curvature(self, k: int, state: State, forces: Any, push: tuple[float, float]) -> float:
        """Curvature from the moment and stretch that the forces at end i and the lever of the contact give."""
        model, pair, touch = self.model, self.model.pairs[k], touch_of(state, k)
        p, x, start = self._at(touch.element, state)
        fx, fy, moment = forces.nodal[:3, model.place[touch.element]].tolist()
        force, chord = complex(fx, fy), complex(p.dx0 + x[3] - x[0], p.dy0 + x[4] - x[1])
        away = complex(*push) or 1j * pair.side * chord
        node = model.node_position(pair, state.q, state.load_parameter)
        lever = complex(*node) - complex(*start) + pair.pair.offset * away / abs(away)
        stretch = -(force * chord.conjugate()).real / (abs(chord) * p.EA)
        return float(((lever.conjugate() * force).imag - moment) / p.EI / (1 + stretch))

    def intervals(self, _elements: int) -> int:
        """Intervals in which an element is drawn."""
        return _POINTS

    def axes(self, beam: BeamModel, state: State, forces: Any, xi: Array) -> Array:
        """Deflected axes of the elements of a beam, shape (elements, m, 2)."""
        model, elements = self.model, slice(beam.first, beam.last + 1)
        x, places = state.q[model.dofs[:, elements]], model.place[elements]
        p = Properties(*(np.asarray(values)[elements] for values in model.properties))
        contacts = [
            (touch.element - beam.first, touch.xi, touch.force)
            for k, pair in self.pairs
            if (touch := state.touches[k]) is not None and pair.target is beam and pair.slot >= 0
        ]
        axes = deflected_axes(p, x, forces.nodal[:, places], contacts, xi)
        starts: Array = np.array(model.element_start[elements]) + x[:2].T
        return starts[:, None] + axes

    def section_axes(self, _beam: BeamModel, shape: Array) -> Array:
        """Directions of the chords, at both ends the same."""
        d = np.diff(shape[:, :2] @ (1, 1j))[:, None]
        return np.repeat(d / np.abs(d), 2, axis=1)

    def stations(self, beam: BeamModel, _state: State, shape: Array, section_forces: Array) -> Stations:
        """The elements."""
        ends: Any = np.arange(len(section_forces))[:, None] + np.arange(2)
        return Stations(np.array(beam.arcs)[ends], shape[ends, :2], shape[ends, 2], section_forces)

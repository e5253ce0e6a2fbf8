"""The interface of element groups, through which the solver uses elements of every kind."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from tsm.elements.contact_law import Vector
from tsm.elements.properties import Array
from tsm.model.numbering import Numbering
from tsm.model.pairs import PairModel
from tsm.model.projection import Projection, arc_position, overshoot, slide
from tsm.model.state import State

_STEPS, _PROJECTED = 30, 1e-14
"""Newton steps of a projection at most, and the step, in lengths of an element, at which the closest point is found."""
_PARTS = 33
"""Longest step, as a part of an element's length."""


@dataclass(kw_only=True)
class GroupForces:
    """Forces of a group of e elements, each with n degrees of freedom, at a configuration."""

    nodal: Array  # residual of the degrees of freedom, those of the nodes first and last; shape (n, e)
    inside: float = 0.0  # largest residual of the unknowns inside the elements [rad]

    @property
    def ends(self) -> Array:
        """Forces and moments at both ends of the elements, shape (6, e)."""
        return self.nodal[[0, 1, 2, -3, -2, -1]]


@dataclass(kw_only=True)
class GroupTangent:
    """Tangent of a group, the unknowns inside its elements eliminated."""

    tangent: Array  # derivative of the residual, row by row; shape (n n, e)
    # contribution of the inner residual to the residual after the inner unknowns are eliminated; shape (n, e)
    condensed_residual: Array
    by_load: (
        Array  # derivative of the residual in the load parameter, by loads along the elements; shape (n, e)
    )


class Stations(NamedTuple):
    """Short lines along a beam. Neighbours share no point: section forces may jump between them."""

    arc: Array  # distance along the undeformed axis; shape (c, 2)
    position: Array  # deformed position; shape (c, 2, 2)
    rotation: Array  # rotation from the undeformed state; shape (c, 2)
    forces: Array  # axial force, shear force and moment; shape (c, 2, 3)


class ElementGroup(ABC):
    """Elements of a model with the same kind of equations: what both kinds share. Each states the following of its own.

    ``forces, tangent``: residual and tangent at a state; those of the contacts are entered in their block.
    ``energy``: strain energy of elements and contacts in equilibrium.
    ``project``: closest point of a deflected beam to a pair's node, with the dents of the contacts that are closed.
    ``curvature``: of the axis at a closed pair, on which a force acts, positive where the beam bends to the left.
    ``axes, intervals``: deflected axes (elements, m, 2) at parts (m,) of the elements, and parts for a picture.
    ``section_axes, stations``: for section forces: unit vectors (elements, 2), complex, at both ends of the elements;
        short lines along a beam.

    ``elements`` (e,) are numbered globally. ``dofs`` (n, e): degrees of freedom of the elements.

    ``number``: number of the group in the model.
    ``pairs``: contact pairs on the elements, with their numbers.
    ``internal``: whether an element has a force and a moment as degrees of freedom, and further unknowns
        inside, which are eliminated.
    """

    internal: ClassVar[bool]

    def __init__(self, model: Numbering, number: int, elements: Array) -> None:
        self.model, self.number, self.elements = model, number, elements
        self.dofs = model.dofs[:, elements]
        self.pairs = [(k, pair) for k, pair in enumerate(model.pairs) if pair.cuts == self.internal]

    @abstractmethod
    def point(self, element: int, arc: float, state: State) -> tuple[Vector, Vector, Vector]:
        """Point of the axis at an arc position in an element, tangent per arc, and its derivative, without dents."""

    def end(self, pair: PairModel, state: State, *, last: bool) -> tuple[Vector, Vector]:
        """Vector from a pair's node to the start of its beam, or to its end if `last`, and a tangent there."""
        target = pair.target
        element, arc = (target.last, target.lengths[-1]) if last else (target.first, 0.0)
        (px, py), tangent, _ = self.point(element, arc, state)
        x, y = self.model.node_position(pair, state.q, state.load_parameter)
        return (px - x, py - y), tangent

    def closest(
        self,
        pair: PairModel,
        state: State,
        e: int,
        arc: float,
        dent: Callable[[int, float], Array] | None = None,
    ) -> Projection:
        """Closest point by Newton's method from an arc position within element e of the pair's beam.

        The axis goes on along its tangents beyond the ends of the beam. ``dent``: displacement (2,) of the
        axis by contacts, at a position on an element.
        """
        target, steep = pair.target, pair.side * pair.steep
        x, y = self.model.node_position(pair, state.q, state.load_parameter)
        for _ in range(_STEPS):
            l0 = target.lengths[e]
            inside = min(max(arc, 0.0), l0)
            (px, py), (tx, ty), (bx, by) = self.point(target.first + e, inside, state)
            px, py = px + (arc - inside) * tx - x, py + (arc - inside) * ty - y
            slope, along = tx * tx + ty * ty, px * tx + py * ty
            if inside == arc:
                slope += bx * px + by * py
            if steep:
                distance = math.hypot(px, py)
                slope, along = slope - steep * along / distance, along - steep * distance
            step = along / slope if slope > 0 else 0.0
            arc -= min(max(step, -l0 / _PARTS), l0 / _PARTS)
            e, place = slide(target.lengths, e, arc / l0)
            arc = place * target.lengths[e]
            if abs(step) < _PROJECTED * l0:
                break
        element = target.first + e
        if dent is not None:
            px, py = np.array([px, py]) + dent(element, place)
        arc = arc_position(target, element, place)
        height = (py * tx - px * ty) / math.hypot(tx, ty)
        if steep:
            height = math.copysign(math.hypot(px, py), height)
        gap = pair.side * (height - pair.reach_at(arc))
        return Projection(element, place, float(gap), overshoot(target, arc))

"""A structure in its numbers, with the element groups through which the solver uses it. Built once; only what it names exists."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from tsm.elements import Integrated
from tsm.elements.contact_law import Vector
from tsm.model.groups import GROUPS, ExactGroup, Group
from tsm.model.mesh import BeamModel
from tsm.model.numbering import Numbering
from tsm.model.pairs import PairModel
from tsm.model.projection import Projection
from tsm.model.state import State, Touch
from tsm.statement.structure import Structure


class Model(Numbering):
    """Numbering and constants of a structure.

    ``groups``: the elements by the way in which they are stated. ``rods``: the exact elements, None without.
    """

    def __init__(self, structure: Structure) -> None:
        super().__init__(structure)
        self.groups: list[Group] = []
        for kind, group in GROUPS.items():
            if len(self.members[kind]):
                self.groups.append(group(self, len(self.groups), self.members[kind]))
        self.rods = next((group for group in self.groups if isinstance(group, ExactGroup)), None)

    def group_of(self, beam: BeamModel) -> Group:
        """Group of a beam's elements."""
        return next(group for group in self.groups if group.internal == isinstance(beam.kind, Integrated))

    def project(self, pair: PairModel, state: State) -> Projection:
        """Closest point of the deflected axis to a pair's node, with the dents of the contacts that are closed."""
        return self.group_of(pair.target).project(pair, state)

    def direction(self, pair: PairModel, touch: Touch, state: State) -> Vector:
        """Direction of the beam at a contact, to which its force is normal: the section's normal, of an element in closed form the chord."""
        if pair.cuts:
            return math.cos(touch.angle), math.sin(touch.angle)
        i, j = self.element_nodes[touch.element]
        dx, dy = self.coordinates[j] - self.coordinates[i] + state.q[3 * j :][:2] - state.q[3 * i :][:2]
        return dx, dy

    @cached_property
    def bandwidth(self) -> int:
        """Largest distance of two coupled banded equations."""
        widest = 0
        springs = [self.springs.dofs] if self.springs else []
        for equations in (self.equation[dofs] for dofs in (*(group.dofs for group in self.groups), *springs)):
            rows = np.where(equations < self.banded, equations, -1)
            least = np.where(rows < 0, self.banded, rows).min(axis=0)
            widest = max(widest, int((rows.max(axis=0) - least).max(initial=0)))
        return widest

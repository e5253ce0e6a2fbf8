"""Numbering: nodes, elements, equations. Built once from a structure; only what it names exists.

Equations come in two parts: the banded part of the beams, numbered to a small bandwidth, and a border of the few
unknowns that couple across it (a contacting beam end, a contact force with its arc position).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tsm.elements import ELEMENTS, ElementType
from tsm.elements.beam import Coefficients
from tsm.elements.properties import Array, Properties
from tsm.structure import Beam, ContactPair, Pin, Structure


@dataclass(frozen=True, kw_only=True)
class BeamModel:
    """A beam's place in the model.

    Attributes
    ----------
    beam : Beam
        What the user stated.
    first : int
        Global number of its first element; its elements follow one another.
    nodes : ndarray of int, shape (elements + 1,)
        Global node numbers from start to end.
    """

    beam: Beam
    first: int
    nodes: Array

    @property
    def last(self) -> int:
        """Global number of its last element."""
        return self.first + self.beam.elements - 1


@dataclass(frozen=True, kw_only=True)
class PairModel:
    """A contact pair's place in the model.

    Attributes
    ----------
    pair : ContactPair
        What the user stated.
    target : BeamModel
        The touched beam.
    element_type : ElementType
        Its element type, which brings the contact response.
    side : float
        +1 where the node comes from the right, -1 from the left.
    pin : Pin or None
        The control node that touches, or None where a beam's end does.
    node : int
        Global number of the beam's end that touches, -1 for a pin.
    slot : int
        Position of its unknowns (force x and y, arc position) in the border, -1 without.
    """

    pair: ContactPair
    target: BeamModel
    element_type: ElementType
    side: float
    pin: Pin | None
    node: int
    slot: int


class Model:
    """Numbering and constants of a structure.

    Attributes
    ----------
    coordinates : ndarray, shape (nodes, 2)
        Undeformed node positions.
    dofs : ndarray of int, shape (6, elements)
        Degrees of freedom of the elements, three per node.
    free : ndarray of int, shape (equations,)
        Degree of freedom of every equation, banded ones first.
    banded : int
        Number of banded equations.
    border : int
        Number of border unknowns: border equations, then the contacts' own unknowns.
    """

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self._place_beams(structure.beams)
        self._prescribe(structure)
        self._place_pairs(structure)
        self._number_equations()
        self.properties = self._properties()
        self.coefficients = self._coefficients()
        longest = max(structure.beams, key=lambda beam: beam.length)
        self.length = longest.length
        self.force_scale = max(beam.section.EI / beam.length**2 for beam in structure.beams)

    def _place_beams(self, beams: tuple[Beam, ...]) -> None:
        self.beams: dict[str, BeamModel] = {}
        coordinates: list[tuple[float, float]] = []
        ends: dict[tuple[float, float], int] = {}
        elements = 0
        for beam in beams:
            nodes = []
            for k in range(beam.elements + 1):
                part = k / beam.elements
                x, y = ((1 - part) * a + part * b for a, b in zip(beam.start, beam.end, strict=True))
                at_end = k in {0, beam.elements}
                node = ends.get((x, y), len(coordinates)) if at_end else len(coordinates)
                if at_end:
                    ends[x, y] = node
                if node == len(coordinates):
                    coordinates.append((x, y))
                nodes.append(node)
            self.beams[beam.name] = BeamModel(beam=beam, first=elements, nodes=np.array(nodes))
            elements += beam.elements
        self.coordinates = np.array(coordinates)
        self.element_nodes = np.concatenate(
            [np.stack([beam.nodes[:-1], beam.nodes[1:]], axis=1) for beam in self.beams.values()]
        )
        self.joined = len(coordinates) < elements + len(beams)
        self.dofs = (3 * self.element_nodes[:, :, None] + np.arange(3)).reshape(-1, 6).T.copy()
        self.element_start = self.coordinates[self.element_nodes[:, 0]].tolist()

    def _prescribe(self, structure: Structure) -> None:
        self.support_node: dict[str, int] = {}
        self.prescribed: dict[int, float] = {}
        for support in structure.supports:
            node = self.end_node(f"{support.beam}.{support.end}")
            self.support_node[f"{support.beam}.{support.end}"] = node
            for k, value in enumerate((support.ux, support.uy, support.rotation)):
                if value is not None:
                    if self.prescribed.get(3 * node + k, value) != value:
                        raise ValueError(
                            f"Support({support.beam}.{support.end}): contradicts another at the joint"
                        )
                    self.prescribed[3 * node + k] = value
        self.fixed = np.array(sorted(self.prescribed), dtype=int)
        self.fixed_values = np.array([self.prescribed[dof] for dof in self.fixed])
        self.load = np.zeros(3 * len(self.coordinates))
        for load in structure.loads:
            node = self.end_node(f"{load.beam}.{load.end}")
            self.load[3 * node : 3 * node + 3] += (*load.force, load.moment)

    def end_node(self, name: str) -> int:
        """Global number of the node at ``"beam.start"`` or ``"beam.end"``."""
        beam, _, end = name.rpartition(".")
        return int(self.beams[beam].nodes[0 if end == "start" else -1])

    def _place_pairs(self, structure: Structure) -> None:
        pins = {pin.name: pin for pin in structure.pins}
        self.pairs: list[PairModel] = []
        slots = 0
        for pair in structure.contacts:
            target = self.beams[pair.beam]
            element_type = ELEMENTS[target.beam.element]
            pin = pins.get(pair.node)
            self.pairs.append(
                PairModel(
                    pair=pair,
                    target=target,
                    element_type=element_type,
                    side=1.0 if pair.side == "right" else -1.0,
                    pin=pin,
                    node=-1 if pin else self.end_node(pair.node),
                    slot=slots if element_type.carries_force else -1,
                )
            )
            slots += 3 if element_type.carries_force else 0
        self.contact_unknowns = slots

    def _number_equations(self) -> None:
        count = 3 * len(self.coordinates)
        bordered = [
            3 * pair.node + k for pair in self.pairs if pair.node >= 0 and pair.slot < 0 for k in range(2)
        ]
        border_dofs = [dof for dof in dict.fromkeys(bordered) if dof not in self.prescribed]
        aside = {*self.prescribed, *border_dofs}
        band_dofs = [
            3 * node + k for node in self._node_order() for k in range(3) if 3 * node + k not in aside
        ]
        self.free = np.array([*band_dofs, *border_dofs], dtype=int)
        self.banded = len(band_dofs)
        self.border_dofs = len(border_dofs)
        self.border = len(border_dofs) + self.contact_unknowns
        self.equations = len(self.free)
        self.dof_count = count
        # fixed degrees of freedom point past the last equation
        self.equation = np.full(count, self.equations)
        self.equation[self.free] = np.arange(self.equations)
        self.element_equations = self.equation[self.dofs]

    def _node_order(self) -> list[int]:
        """Order of the nodes with a small bandwidth; along the beams where none are joined."""
        if not self.joined:
            return list(range(len(self.coordinates)))
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import reverse_cuthill_mckee

        shape = (len(self.coordinates),) * 2
        near = coo_array((np.ones(len(self.element_nodes)), tuple(self.element_nodes.T)), shape=shape)
        order: list[int] = reverse_cuthill_mckee((near + near.T).tocsr(), symmetric_mode=True).tolist()
        return order

    @property
    def unknowns(self) -> int:
        """Number of unknowns with every contact closed."""
        return self.equations + self.contact_unknowns

    @cached_property
    def bandwidth(self) -> int:
        """Largest distance of two coupled banded equations."""
        rows = np.where(self.element_equations < self.banded, self.element_equations, -1)
        least = np.where(rows < 0, self.banded, rows).min(axis=0)
        return int(max((rows.max(axis=0) - least).max(), 0))

    def _properties(self) -> Properties:
        d = np.diff(self.coordinates[self.element_nodes], axis=1)[:, 0]
        repeats = [beam.beam.elements for beam in self.beams.values()]
        l0 = np.repeat([b.beam.length / b.beam.elements for b in self.beams.values()], repeats)
        EA, GA, EI = (
            np.repeat([getattr(b.beam.section, name) for b in self.beams.values()], repeats)
            for name in ("EA", "GA", "EI")
        )
        sheared = np.repeat([ELEMENTS[b.beam.element].sheared for b in self.beams.values()], repeats)
        Phi = np.where(sheared, 12 * EI / (GA * l0**2), 0.0)
        return Properties(dx0=d[:, 0], dy0=d[:, 1], l0=l0, EA=EA, EI=EI, Phi=Phi)

    def _coefficients(self) -> Coefficients:
        parts = []
        for beam in self.beams.values():
            own = Properties(*(column[beam.first : beam.last + 1] for column in self.properties))
            parts.append(ELEMENTS[beam.beam.element].coefficients(own))
        return Coefficients(*(np.concatenate(part, axis=-1) for part in zip(*parts, strict=True)))

    @cached_property
    def element(self) -> list[Properties]:
        """Constants of the single elements, plain numbers."""
        return [
            Properties(*row) for row in zip(*(column.tolist() for column in self.properties), strict=True)
        ]

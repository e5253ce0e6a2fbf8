"""Beams, nodes and elements in their numbers, before anything holds them or touches them."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from tsm.elements import ClosedForm, ElementType, Integrated
from tsm.elements.beam import Coefficients
from tsm.elements.properties import Array, Properties
from tsm.model.along import Along, gauss_nodes, kind_of
from tsm.model.scales import joined_extents, sizes_of
from tsm.statement.beam import Beam, Point
from tsm.statement.structure import Structure


@dataclass(frozen=True, kw_only=True)
class BeamModel:
    """A beam's place in the model."""

    beam: Beam  # what the user stated
    first: int  # global number of its first element; its elements follow one another
    nodes: Array  # global node numbers from start to end; shape (elements + 1,)
    lengths: list[float]  # undeformed lengths of its elements
    arcs: list[float]  # arc positions of its nodes
    kind: ElementType  # type of its elements

    @property
    def last(self) -> int:
        """Global number of its last element."""
        return self.first + self.beam.elements - 1


class Mesh:
    """Beams, nodes and elements of a structure.

    ``coordinates`` (nodes, 2): undeformed node positions. ``dofs`` (6, elements): degrees of freedom of the
        elements' nodes, three per node. ``dof_count``: their number; the force and moment of an exact element are
        three more, numbered after the nodes.
    ``members``: numbers of the elements of each kind of equations. ``closed`` (c,): those in closed form.
    ``place`` (elements,): number of every element within its kind. ``block`` (elements,): number of its own
        three degrees of freedom among all threes, -1 without.
    ``gauss_nodes``: fixed number of Gauss nodes of the elements that contacts cut, None where it follows from
        the accuracy. ``along``: what varies along the elements.
    ``joints``: node of the joint by node of the beam's end behind a hinge, ``links`` (h, 2) the same; they share
        their displacements, the ``slaves`` of the end and the ``masters`` of the joint.
    ``properties``: constants of the elements. ``length, extent, force_scale, least_force``: see `Sizes`.
    """

    def __init__(self, structure: Structure) -> None:
        self.structure, self.stages = structure, structure.stages
        self.along = Along(structure.beams, structure.line_loads, self.stages)
        self._place_beams(structure.beams)
        beams = list(self.beams.values())
        counts = [beam.beam.elements for beam in beams]
        self.gauss_nodes = gauss_nodes([(beam.beam, beam.kind) for beam in beams])
        kinds = [(isinstance(beam.kind, Integrated), beam.kind.sheared) for beam in beams]
        cut, sheared = np.repeat(kinds, counts, axis=0).T
        own, self.closed = np.flatnonzero(cut), np.flatnonzero(~cut)
        self.members: dict[type[ElementType], Array] = {ClosedForm: self.closed, Integrated: own}
        self.place = np.where(cut, cut.cumsum(), (~cut).cumsum()) - 1
        self.block = np.where(cut, len(self.coordinates) + self.place, -1)
        self.dof_count = 3 * (len(self.coordinates) + len(own))
        l0 = np.concatenate([beam.lengths for beam in beams])
        sections = np.array([(b.section.EA, b.section.GA, b.section.EI) for b in structure.beams]).T
        EA, GA, EI = np.repeat(sections, counts, axis=1)
        dx0, dy0 = np.diff(self.coordinates[self.element_nodes], axis=1)[:, 0].T.copy()
        self.properties = Properties(dx0, dy0, l0, EA, EI, np.where(sheared, 12 * EI / (GA * l0**2), 0.0))
        lengths = extents = np.array([beam.length for beam in structure.beams])
        if self.joined:
            starts = np.array([beam.nodes[0] for beam in beams])
            links = np.concatenate([self.element_nodes, self.links])
            extents = joined_extents(links, starts, self.coordinates, lengths)
        self.sizes = sizes_of(lengths, extents, sections[2])
        self.length, self.extent, self.force_scale, self.least_force = self.sizes

    def _place_beams(self, beams: tuple[Beam, ...]) -> None:
        self.beams: dict[str, BeamModel] = {}
        coordinates: list[Point] = []
        ends: dict[Point, int] = {}
        behind: dict[int, Point] = {}
        hinged = {(hinge.beam, hinge.end) for hinge in self.structure.hinges}
        rubbed = {pair.beam for pair in self.structure.contacts if pair.friction}
        elements = 0

        def joint(point: Point) -> int:
            """Node of all ends at a point."""
            if ends.setdefault(point, len(coordinates)) == len(coordinates):
                coordinates.append(point)
            return ends[point]

        for beam in beams:
            nodes = []
            for k, part in enumerate(beam.parts):
                point, end = beam.point(part), {0: "start", beam.elements: "end"}.get(k)
                if end and (beam.name, end) not in hinged:
                    nodes.append(joint(point))
                    continue
                if end:
                    behind[len(coordinates)] = point
                nodes.append(len(coordinates))
                coordinates.append(point)
            arcs = [part * beam.length for part in beam.parts]
            self.beams[beam.name] = BeamModel(
                beam=beam,
                first=elements,
                nodes=np.array(nodes),
                lengths=_lengths(beam, arcs),
                arcs=arcs,
                kind=kind_of(beam, varies=bool(self.along.varies[elements]), rubbed=beam.name in rubbed),
            )
            elements += beam.elements
        # a joint whose ends are all behind hinges is a node of its own
        self.joints = {node: joint(point) for node, point in behind.items()}
        self.links = np.array(list(self.joints.items()), dtype=int).reshape(-1, 2)
        self.slaves, self.masters = (
            (3 * self.links[:, :, None] + np.arange(2)).transpose(1, 0, 2).reshape(2, -1)
        )
        self.coordinates = np.array(coordinates)
        self.element_nodes = np.concatenate(
            [np.stack([beam.nodes[:-1], beam.nodes[1:]], axis=1) for beam in self.beams.values()]
        )
        self.joined = len(coordinates) < elements + len(beams) or bool(behind)
        self.dofs = (3 * self.element_nodes[:, :, None] + np.arange(3)).reshape(-1, 6).T.copy()
        if behind:
            shared = np.arange(3 * len(coordinates))
            shared[self.slaves] = self.masters
            self.dofs = shared[self.dofs]
        self.element_start = self.coordinates[self.element_nodes[:, 0]].tolist()

    @cached_property
    def whole(self) -> bool:
        """Whether every beam is a single exact element, so that no contact passes from element to element."""
        return len(self.block) == len(self.beams) and not len(self.closed)

    @cached_property
    def free_ends(self) -> dict[str, list[tuple[int, bool]]]:
        """By beam, the node of every end that no other beam shares, and whether it is the beam's end or its start."""
        ends = [
            (name, last, self.end_node(f"{name}.{'end' if last else 'start'}"))
            for name in self.beams
            for last in (False, True)
        ]
        shared = Counter(node for *_, node in ends)
        return {
            name: [(node, last) for owner, last, node in ends if owner == name and shared[node] == 1]
            for name in self.beams
        }

    def end_node(self, name: str) -> int:
        """Global number of the node at ``"beam.start"`` or ``"beam.end"``; behind a hinge, of the joint."""
        node = self.own_end_node(name)
        return self.joints.get(node, node)

    def own_end_node(self, name: str) -> int:
        """Global number of the node of a beam's end, behind the hinge where there is one."""
        beam, _, end = name.rpartition(".")
        return int(self.beams[beam].nodes[0 if end == "start" else -1])

    @cached_property
    def coefficients(self) -> Coefficients:
        """Coefficients of the energy of the elements in closed form."""
        parts = [
            beam.kind.coefficients(
                Properties(*(column[beam.first : beam.last + 1] for column in self.properties))
            )
            for beam in self.beams.values()
            if isinstance(beam.kind, ClosedForm)
        ]
        return Coefficients(*(np.concatenate(part, axis=-1) for part in zip(*parts, strict=True)))

    def positions(self, beam: BeamModel, q: Array) -> Array:
        """Current positions (elements + 1, 2) of a beam's nodes."""
        return self.coordinates[beam.nodes] + q.reshape(-1, 3)[beam.nodes, :2]

    @cached_property
    def element(self) -> list[Properties]:
        """Constants of the single elements, plain numbers."""
        return [
            Properties(*row) for row in zip(*(column.tolist() for column in self.properties), strict=True)
        ]


def _lengths(beam: Beam, arcs: list[float]) -> list[float]:
    """Lengths of the elements, of equal ones to the last digit."""
    if not beam.nodes:
        return [beam.length / beam.elements] * beam.elements
    return [b - a for a, b in pairwise(arcs)]

"""Numbering: nodes, elements, equations. Built once from a structure; only what it names exists.

Equations come in two parts: the banded part of the beams, numbered to a small bandwidth, and a border of the few
unknowns that couple across it (a contacting beam end, a contact force with its arc position).
"""

from __future__ import annotations

from collections import Counter
from functools import cached_property
from itertools import pairwise

import numpy as np

from tsm.elements import EXACT, ClosedForm, Integrated
from tsm.elements.beam import Coefficients
from tsm.elements.properties import Array, Properties
from tsm.model.along import Along, gauss_nodes, kind_of
from tsm.model.conditions import dead_loads, held_components, motions, springs_of
from tsm.model.groups import GROUPS, ElementGroup, ExactGroup
from tsm.model.ordering import block_order
from tsm.model.pairs import BeamModel, PairModel
from tsm.model.scales import Sizes, joined_extents, sizes_of, units_of
from tsm.statement.beam import Beam, check, checks
from tsm.statement.stages import Increments
from tsm.statement.structure import Structure

_CONTACT_KINDS = np.arange(6, 10)


class Model:
    """Numbering and constants of a structure.

    ``coordinates`` (nodes, 2): undeformed node positions. ``dofs`` (6, elements): degrees of freedom of the
        elements' nodes, three per node.
    ``groups``: the elements by the way in which they are stated. The force and moment of an exact element are
        three degrees of freedom, numbered after the nodes. ``closed`` (c,): elements in closed form.
    ``place`` (elements,): number of every element within its group. ``block`` (elements,): number of its own
        three degrees of freedom among all threes, -1 without.
    ``free`` (equations,): degree of freedom of every equation, banded ones first. ``banded``: number of these.
    ``border``: number of border unknowns: border equations, then the contacts' own unknowns.
    ``rubbed``: whether a contact has friction.
    ``turns``: load parameters at which a stage ends and another follows, and at which the paths of the pins
        turn; with friction, every corner, since each may reverse a slip.
    ``gauss_nodes``: fixed number of Gauss nodes of the elements that contacts cut, None where it follows from
        the accuracy. ``along``: what varies along the elements.
    ``loads``: dead loads on all degrees of freedom.
    ``supports``: by supported end, the node and the components (3,) that the support holds.
    ``prescribed``: values prescribed at load parameter 1, by degree of freedom. ``fixed``: these degrees of
        freedom, ``motions``: their values, ``moves``: whether one is not zero in some stage.
    ``springs``: springs to the ground and in hinges, None without.
    ``joints``: node of the joint by node of the beam's end behind a hinge; they share their displacements, the
        ``slaves`` of the end and the ``masters`` of the joint.
    ``length, extent, force_scale, least_force``: see `Sizes`. ``units, row_units``: of unknowns and equations.
    """

    def __init__(self, structure: Structure) -> None:
        self.structure, self.stages = structure, structure.stages
        self.along = Along(structure.beams, structure.line_loads, self.stages)
        self._place_beams(structure.beams)
        self.gauss_nodes = gauss_nodes([(beam.beam, beam.kind) for beam in self.beams.values()])
        self._sort_elements()
        self.supports, self.prescribed = held_components(self, structure.supports)
        self.fixed = np.array(sorted(self.prescribed), dtype=int)
        changes = motions(self, structure.supports)
        self.motions, self.moves = Increments(changes[:, self.fixed]), bool(changes.any())
        self.loads = dead_loads(self)
        self.springs = springs_of(self)
        self._place_pairs(structure)
        self._number_equations()
        sections = np.array(
            [[getattr(b.section, name) for b in structure.beams] for name in ("EA", "GA", "EI")]
        )
        l0 = np.concatenate([beam.lengths for beam in self.beams.values()])
        self.properties = self._properties(l0, sections)
        self.sizes = self._sizes(np.array([beam.length for beam in structure.beams]), sections[2])
        self.length, self.extent, self.force_scale, self.least_force = self.sizes
        self.units, self.row_units = (unit[self.kind] for unit in units_of(self.sizes))
        self.rubbed = any(pair.rubs for pair in self.pairs)
        turns = {turn for pin in structure.pins for turn in (pin.corners if self.rubbed else pin.turns)}
        self.turns = tuple(sorted(turns.union(map(float, range(1, self.stages)))))

    def _place_beams(self, beams: tuple[Beam, ...]) -> None:
        self.beams: dict[str, BeamModel] = {}
        coordinates: list[tuple[float, float]] = []
        ends: dict[tuple[float, float], int] = {}
        hinged = {(hinge.beam, hinge.end) for hinge in self.structure.hinges}
        behind: dict[int, tuple[float, float]] = {}
        elements = 0
        for beam in beams:
            nodes = []
            for k, part in enumerate(beam.parts):
                x, y = beam.point(part)
                at_end = k in {0, beam.elements}
                if at_end and (beam.name, "end" if k else "start") in hinged:
                    at_end, behind[len(coordinates)] = False, (x, y)
                node = ends.get((x, y), len(coordinates)) if at_end else len(coordinates)
                if at_end:
                    ends[x, y] = node
                if node == len(coordinates):
                    coordinates.append((x, y))
                nodes.append(node)
            arcs = [part * beam.length for part in beam.parts]
            self.beams[beam.name] = BeamModel(
                beam=beam,
                first=elements,
                nodes=np.array(nodes),
                lengths=_lengths(beam, arcs),
                arcs=arcs,
                kind=kind_of(beam, varies=bool(self.along.varies[elements])),
            )
            elements += beam.elements
        self._place_joints(behind, ends, coordinates)
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

    def _place_joints(
        self,
        behind: dict[int, tuple[float, float]],
        ends: dict[tuple[float, float], int],
        coordinates: list[tuple[float, float]],
    ) -> None:
        """Number the joints of the ends behind hinges; a joint that has no other beam is a node of its own."""
        self.joints: dict[int, int] = {}
        for node, place in behind.items():
            if place not in ends:
                ends[place] = len(coordinates)
                coordinates.append(place)
            self.joints[node] = ends[place]
        pairs = np.array(list(self.joints.items()), dtype=int).reshape(-1, 2)
        self.slaves, self.masters = (3 * pairs[:, :, None] + np.arange(2)).transpose(1, 0, 2).reshape(2, -1)

    def _sort_elements(self) -> None:
        counts = [beam.beam.elements for beam in self.beams.values()]
        self.groups: list[ElementGroup] = []
        self.place, self.block = np.zeros(sum(counts), dtype=int), np.full(sum(counts), -1)
        count = len(self.coordinates)
        for kind, group in GROUPS.items():
            elements = np.flatnonzero(
                np.repeat([isinstance(beam.kind, kind) for beam in self.beams.values()], counts)
            )
            if not len(elements):
                continue
            dofs = self.dofs[:, elements]
            if group.internal:
                self.block[elements] = count + np.arange(len(elements))
                count += len(elements)
                own = 3 * self.block[elements] + np.arange(3)[:, None]
                dofs = np.concatenate([dofs[:3], own, dofs[3:]])
            self.place[elements] = np.arange(len(elements))
            self.groups.append(group(self, len(self.groups), elements, dofs))
        self.closed = np.flatnonzero(self.block < 0)
        self.dof_count = 3 * count

    def _sizes(self, lengths: Array, EI: Array) -> Sizes:
        """Sizes from lengths and bending stiffnesses (beams,) of the beams."""
        if not self.joined:
            return sizes_of(lengths, lengths, EI)
        starts = np.array([beam.nodes[0] for beam in self.beams.values()])
        links = np.array(list(self.joints.items()), dtype=int).reshape(-1, 2)
        nodes = np.concatenate([self.element_nodes, links])
        return sizes_of(lengths, joined_extents(nodes, starts, self.coordinates, lengths), EI)

    @cached_property
    def kind(self) -> Array:
        """Quantity of every unknown, the equations first, then the contacts' unknowns.

        Displacement (0, 1), rotation (2), force (3, 4) and moment (5) of an exact element, contact force (6, 7), arc position (8), angle
        of a contact (9).
        """
        nodal = self.free % 3 + 3 * (self.free >= 3 * len(self.coordinates))
        contacts = [_CONTACT_KINDS[: pair.element_type.contact_unknowns] for pair in self.pairs]
        kind: Array = np.concatenate([nodal, *contacts])
        return kind

    @property
    def stick_stiffness(self) -> float:
        """Force over length, the unit of the rows of stick."""
        return self.force_scale / self.length

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

    def group_of(self, beam: BeamModel) -> ElementGroup:
        """Group of a beam's elements."""
        return next(group for group in self.groups if beam.first in group.elements)

    @cached_property
    def rods(self) -> ExactGroup | None:
        """The exact elements, if any."""
        return next((group for group in self.groups if isinstance(group, ExactGroup)), None)

    def end_node(self, name: str) -> int:
        """Global number of the node at ``"beam.start"`` or ``"beam.end"``; behind a hinge, of the joint."""
        node = self.own_end_node(name)
        return self.joints.get(node, node)

    def own_end_node(self, name: str) -> int:
        """Global number of the node of a beam's end, behind the hinge where there is one."""
        beam, _, end = name.rpartition(".")
        return int(self.beams[beam].nodes[0 if end == "start" else -1])

    def _place_pairs(self, structure: Structure) -> None:
        pins = {pin.name: pin for pin in structure.pins}
        self.pairs: list[PairModel] = []
        slots = 0
        for pair in structure.contacts:
            target = self.beams[pair.beam]
            element_type = target.kind
            pin = pins.get(pair.node)
            of_pair = checks(f"ContactPair({pair.name})", pair)
            rubs = element_type.rubs or not pair.friction
            of_pair("friction", rubs, f'elements "{target.beam.element}" have contacts without friction only')
            envelope = pair.end_offset is None or isinstance(element_type, Integrated)
            of_pair("end_offset", envelope, f'belongs to a beam that tapers or has elements "{EXACT.name}"')
            self.pairs.append(
                PairModel(
                    pair=pair,
                    target=target,
                    element_type=element_type,
                    group=self.group_of(target),
                    side=1.0 if pair.side == "right" else -1.0,
                    pin=pin,
                    node=-1 if pin else self.end_node(pair.node),
                    slot=slots if element_type.contact_unknowns else -1,
                )
            )
            slots += element_type.contact_unknowns
        self.contact_unknowns = slots
        for group in self.groups:
            group.pairs = [(k, pair) for k, pair in enumerate(self.pairs) if pair.group is group]

    def _number_equations(self) -> None:
        bordered = [
            3 * pair.node + k for pair in self.pairs if pair.node >= 0 and pair.slot < 0 for k in range(2)
        ]
        border_dofs = [dof for dof in dict.fromkeys(bordered) if dof not in self.prescribed]
        aside = {*self.prescribed, *border_dofs, *self.slaves.tolist()}
        band_dofs = [
            3 * block + k for block in block_order(self) for k in range(3) if 3 * block + k not in aside
        ]
        self.free = np.array([*band_dofs, *border_dofs], dtype=int)
        self.banded = len(band_dofs)
        held = self.structure.beams[0]
        rule = f"every node is held, and elements {held.element!r} have no unknowns inside"
        rule += f"; take at least 2, or elements {EXACT.name!r}"
        check(self.banded > 0, f"Beam({held.name})", "elements", held.elements, rule)
        self.border_dofs = len(border_dofs)
        self.border = len(border_dofs) + self.contact_unknowns
        self.equations = len(self.free)
        # fixed degrees of freedom point past the last equation
        self.equation = np.full(self.dof_count, self.equations)
        self.equation[self.free] = np.arange(self.equations)
        self.element_equations = self.equation[self.dofs]

    @property
    def unknowns(self) -> int:
        """Number of unknowns with every contact closed."""
        return self.equations + self.contact_unknowns

    @cached_property
    def bandwidth(self) -> int:
        """Largest distance of two coupled banded equations."""
        widest = 0
        springs = self.springs.dofs if self.springs else []
        for equations in (self.equation[dofs] for dofs in (*(group.dofs for group in self.groups), *springs)):
            rows = np.where(equations < self.banded, equations, -1)
            least = np.where(rows < 0, self.banded, rows).min(axis=0)
            widest = max(widest, int((rows.max(axis=0) - least).max(initial=0)))
        return widest

    def _properties(self, l0: Array, sections: Array) -> Properties:
        """Constants of all elements from their lengths (elements,), and EA, GA and EI (3, beams) of the beams."""
        counts = [beam.beam.elements for beam in self.beams.values()]
        EA, GA, EI = np.repeat(sections, counts, axis=1)
        sheared = np.repeat([beam.kind.sheared for beam in self.beams.values()], counts)
        dx0, dy0 = np.diff(self.coordinates[self.element_nodes], axis=1)[:, 0].T.copy()
        return Properties(dx0, dy0, l0, EA, EI, np.where(sheared, 12 * EI / (GA * l0**2), 0.0))

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

    def node_position(self, pair: PairModel, q: Array, load_parameter: float) -> tuple[float, float]:
        """Current position of a pair's contacting node."""
        if pair.pin is not None:
            return pair.pin.position(load_parameter)
        x, y = self.coordinates[pair.node] + q[3 * pair.node : 3 * pair.node + 2]
        return float(x), float(y)

    def positions(self, beam: BeamModel, q: Array) -> Array:
        """Current positions (elements + 1, 2) of a beam's nodes."""
        positions: Array = self.coordinates[beam.nodes] + q.reshape(-1, 3)[beam.nodes, :2]
        return positions

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

"""Equations: what supports hold, what loads and springs add, what touches, and the order of the unknowns.

Equations come in two parts: the banded part of the beams, numbered to a small bandwidth, and a border of the few
unknowns that couple across it (a contacting beam end, a contact force with its arc position).
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from tsm.elements import EXACT, Integrated
from tsm.elements.properties import Array
from tsm.model.mesh import Mesh
from tsm.model.ordering import block_order
from tsm.model.pairs import PairModel
from tsm.model.scales import units_of
from tsm.statement.beam import check, checks
from tsm.statement.springs import Springs
from tsm.statement.stages import Increments
from tsm.statement.structure import Structure

_CONTACT_KINDS = np.arange(6, 10)


class Numbering(Mesh):
    """Conditions and equations of a structure.

    ``free`` (equations,): degree of freedom of every equation. ``banded``: number of banded ones, the first.
    ``border``: number of border unknowns: ``border_dofs`` equations, then the contacts' own.
    ``rubbed``: whether a contact has friction.
    ``turns``: load parameters at which a stage ends and another follows, and at which the paths of the pins
        turn; with friction, every corner, since each may reverse a slip.
    ``loads``: dead loads on all degrees of freedom.
    ``supports``: by supported end, the node and a mask (3,) of the components that no support before it holds.
    ``prescribed``: changes prescribed in every stage, by degree of freedom. ``fixed``: these degrees of
        freedom, ``motions``: their values by stage, ``moves``: whether any is not zero.
    ``springs``: springs to the ground and in hinges, None without.
    ``units, row_units``: of unknowns and equations.
    """

    def __init__(self, structure: Structure) -> None:
        super().__init__(structure)
        self.supports: dict[str, tuple[int, Array]] = {}
        self.prescribed: dict[int, tuple[float, ...]] = {}
        self._hold()
        self.loads, self.springs = self._dead_loads(), self._springs()
        self._place_pairs(structure)
        self._number_equations()
        self.units, self.row_units = (unit[self.kind] for unit in units_of(self.sizes))
        self.rubbed = any(pair.rubs for pair in self.pairs)
        turns = {turn for pin in structure.pins for turn in (pin.corners if self.rubbed else pin.turns)}
        self.turns = tuple(sorted(turns.union(map(float, range(1, self.stages)))))

    def _hold(self) -> None:
        """Collect the supports; the first to hold a component moves it.

        Raises ValueError if two supports at one joint prescribe different values.
        """
        for support in self.structure.supports:
            name, given = f"{support.beam}.{support.end}", (support.ux, support.uy, support.rotation)
            node, held = self.end_node(name), np.array([value is not None for value in given])
            rates, stated = np.zeros((self.stages, 3)), [[value or 0.0 for value in given], *support.onward]
            rates[: len(stated)] = stated
            self.supports[name] = node, held & [3 * node + k not in self.prescribed for k in range(3)]
            for k in np.flatnonzero(held).tolist():
                rate = tuple(rates[:, k].tolist())
                if self.prescribed.setdefault(3 * node + k, rate) != rate:
                    raise ValueError(f"Support({name}): contradicts another at the joint")
        self.fixed = np.array(sorted(self.prescribed), dtype=int)
        changes = np.array([self.prescribed[dof] for dof in sorted(self.prescribed)]).T.reshape(
            self.stages, -1
        )
        self.motions, self.moves = Increments(changes), bool(changes.any())

    def _dead_loads(self) -> Increments:
        """Return the dead loads of all stages on the degrees of freedom."""
        loads = np.zeros((self.stages, self.dof_count))
        for load in self.structure.loads:
            place = self.beams[load.beam]
            node = self.end_node(f"{load.beam}.{load.end}")
            if load.arc is not None:
                node = int(place.nodes[place.beam.node(load.arc) or 0])
            loads[load.stage, 3 * node : 3 * node + 3] += (*load.force, load.moment)
        return Increments(loads)

    def _springs(self) -> Springs | None:
        """Return the springs to the ground and in hinges, None without.

        Raises ValueError if all beams of a joint are hinged to it and nothing else holds its rotation.
        """
        structure = self.structure
        items = [
            (3 * self.end_node(f"{spring.beam}.{spring.end}") + k, -1, stiffness)
            for spring in structure.springs
            for k, stiffness in enumerate((spring.x, spring.y, spring.rotation))
            if stiffness
        ]
        items += [
            (3 * self.joints[node] + 2, 3 * node + 2, hinge.stiffness)
            for hinge in structure.hinges
            if hinge.stiffness
            for node in [self.own_end_node(f"{hinge.beam}.{hinge.end}")]
        ]
        held = {*self.prescribed, *(dof for dof, _, _ in items)}
        for hinge in structure.hinges:
            turn = 3 * self.end_node(f"{hinge.beam}.{hinge.end}") + 2
            if turn not in held and not (self.dofs == turn).any():
                raise ValueError(f"Hinge({hinge.beam}.{hinge.end}): the joint turns freely")
        return Springs(items) if items else None

    def _place_pairs(self, structure: Structure) -> None:
        pins = {pin.name: pin for pin in structure.pins}
        self.pairs: list[PairModel] = []
        slots = 0
        for pair in structure.contacts:
            target = self.beams[pair.beam]
            pin = pins.get(pair.node)
            of_pair = checks(f"ContactPair({pair.name})", pair)
            integrated = isinstance(target.kind, Integrated)
            rule = f'elements "{target.beam.element}" have contacts without friction only'
            of_pair("friction", integrated or not pair.friction, rule)
            suits = integrated or pair.end_offset is None
            of_pair("end_offset", suits, f'belongs to a beam that tapers or has elements "{EXACT.name}"')
            self.pairs.append(
                PairModel(
                    pair=pair,
                    target=target,
                    side=1.0 if pair.side == "right" else -1.0,
                    pin=pin,
                    node=-1 if pin else self.end_node(pair.node),
                    slot=slots if target.kind.contact_unknowns else -1,
                )
            )
            slots += target.kind.contact_unknowns
        self.contact_unknowns = slots

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
        # prescribed ones, slaves, and the ground at the end: past the last equation
        self.equation = np.full(self.dof_count + 1, self.equations)
        self.equation[self.free] = np.arange(self.equations)
        self.element_equations = self.equation[self.dofs]

    @cached_property
    def kind(self) -> Array:
        """Quantity of every unknown, the equations first, then the contacts' unknowns.

        Displacement (0, 1), rotation (2), force (3, 4) and moment (5) of an exact element, contact force (6, 7), arc position (8), angle
        of a contact (9).
        """
        nodal = self.free % 3 + 3 * (self.free >= 3 * len(self.coordinates))
        contacts = [_CONTACT_KINDS[: pair.target.kind.contact_unknowns] for pair in self.pairs]
        return np.concatenate([nodal, *contacts])

    @property
    def unknowns(self) -> int:
        """Number of unknowns with every contact closed."""
        return self.equations + self.contact_unknowns

    def node_position(self, pair: PairModel, q: Array, load_parameter: float) -> tuple[float, float]:
        """Current position of a pair's contacting node."""
        if pair.pin is not None:
            return pair.pin.position(load_parameter)
        x, y = self.coordinates[pair.node] + q[3 * pair.node : 3 * pair.node + 2]
        return float(x), float(y)

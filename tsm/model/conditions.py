"""Supports, dead loads and springs of a structure in the numbering of a model."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tsm.elements.properties import Array
from tsm.statement.springs import Springs
from tsm.statement.stages import Increments

if TYPE_CHECKING:
    from tsm.model.model import Model
    from tsm.statement.structure import Support


def held_components(
    model: Model, supports: tuple[Support, ...]
) -> tuple[dict[str, tuple[int, Array]], dict[int, float]]:
    """Return the node and the components (3,) that each support holds and none before it, and the prescribed values.

    The values are those at load parameter 1, by degree of freedom. Raises ValueError if two supports at one joint
    prescribe different ones.
    """
    held: dict[str, tuple[int, Array]] = {}
    prescribed: dict[int, float] = {}
    for support in supports:
        name = f"{support.beam}.{support.end}"
        node = model.end_node(name)
        motion = (support.ux, support.uy, support.rotation)
        own = np.array([value is not None for value in motion])
        own &= [3 * node + k not in prescribed for k in range(3)]
        held[name] = node, own
        for k, value in enumerate(motion):
            if value is not None:
                if prescribed.get(3 * node + k, value) != value:
                    raise ValueError(f"Support({name}): contradicts another at the joint")
                prescribed[3 * node + k] = value
    return held, prescribed


def motions(model: Model, supports: tuple[Support, ...]) -> Array:
    """Return the changes of the prescribed values in every stage, shape (stages, dofs); of supports at one joint, the first moves it."""
    changes = np.zeros((model.stages, model.dof_count))
    changes[0, model.fixed] = [model.prescribed[dof] for dof in model.fixed]
    for support in supports:
        node, held = model.supports[f"{support.beam}.{support.end}"]
        for stage, motion in enumerate(support.onward, 1):
            changes[stage, 3 * node : 3 * node + 3] += np.where(held, motion, 0.0)
    return changes


def dead_loads(model: Model) -> Increments:
    """Return the dead loads of all stages on the degrees of freedom."""
    loads = np.zeros((model.stages, model.dof_count))
    for load in model.structure.loads:
        place = model.beams[load.beam]
        node = model.end_node(f"{load.beam}.{load.end}")
        if load.arc is not None:
            node = int(place.nodes[place.beam.node(load.arc) or 0])
        loads[load.stage, 3 * node : 3 * node + 3] += (*load.force, load.moment)
    return Increments(loads)


def springs_of(model: Model) -> Springs | None:
    """Return the springs to the ground and in hinges, None without.

    Raises ValueError if all beams of a joint are hinged to it and nothing else holds its rotation.
    """
    structure = model.structure
    ground = [
        (3 * model.end_node(f"{spring.beam}.{spring.end}") + k, stiffness)
        for spring in structure.springs
        for k, stiffness in enumerate((spring.x, spring.y, spring.rotation))
        if stiffness
    ]
    between = [
        (3 * model.joints[node] + 2, 3 * node + 2, hinge.stiffness)
        for hinge in structure.hinges
        if hinge.stiffness
        for node in [model.own_end_node(f"{hinge.beam}.{hinge.end}")]
    ]
    held = {*model.prescribed, *(dof for dof, _ in ground), *(dof for dof, _, _ in between)}
    for hinge in structure.hinges:
        turn = 3 * model.end_node(f"{hinge.beam}.{hinge.end}") + 2
        if turn not in held and not (model.dofs == turn).any():
            raise ValueError(f"Hinge({hinge.beam}.{hinge.end}): the joint turns freely")
    return Springs(ground, between) if ground or between else None

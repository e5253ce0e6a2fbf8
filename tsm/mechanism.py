"""Mechanisms: structures that can move without strain."""

from __future__ import annotations

import math

import numpy as np

from tsm.contact_set import changed
from tsm.elements.properties import Array
from tsm.model import Model
from tsm.path import Point
from tsm.stability import IDLE, loose
from tsm.state import State
from tsm.system import Drive

_LEAST = 1e-9
"""Singular value of the equations of rigid motions, in coordinates over the structure's size, that counts as zero."""


def mechanism(point: Point, drive: Drive) -> bool:
    """Whether a structure can move without strain as a drive begins. A contact without force holds it only if it begins to push."""
    model, state = point.model, point.state
    edge, opened = IDLE * model.force_scale, state
    idle = [
        (k, pair, touch)
        for k, (pair, touch) in enumerate(zip(model.pairs, state.touches, strict=True))
        if touch is not None and pair.slot >= 0 and math.hypot(*touch.force) <= edge
    ]
    for k, *_ in idle:
        opened = changed(model, opened, k, None, armed=True)
    if not (model.joints or _moves(model, opened)):
        return False
    if _free(point):
        return True
    by = point.rates(drive) if idle else None
    if by is None:
        return False
    for k, pair, touch in idle:
        x, y = pair.group.direction(touch, point.state.q)
        fx, fy, *_ = by.contacts[pair.slots]
        if pair.side * (fy * x - fx * y) <= edge:
            state = changed(model, state, k, None, armed=True)
    return state is not point.state and _free(point.with_state(state))


def _free(point: Point) -> bool:
    """Whether beams that are rigid can move, and no load stiffens the motion; the tangent of many slender elements is loose too."""
    return loose(point.newton.assembler, point.state, point.system) and _moves(point.model, point.state)


def _moves(model: Model, state: State) -> bool:
    """Whether the beams, each rigid, can move against supports, hinges, springs and closed contacts."""
    body, before = np.arange(len(model.coordinates)), np.array(-1)
    while not np.array_equal(body, before):
        before = body.copy()
        for beam in model.beams.values():
            body[beam.nodes] = body[beam.nodes].min()
    numbers, body = np.unique(body, return_inverse=True)
    q = state.q[: 3 * len(body)].copy()
    q[model.slaves] = q[model.masters]
    places = model.coordinates + q.reshape(-1, 3)[:, :2]

    def rows(nodes: Array, at: Array) -> Array:
        """Displacements and rotation (n, 3, columns) of the bodies of some nodes at some places, by the bodies' motions."""
        found, n = np.zeros((len(nodes), 3, len(numbers), 3)), np.arange(len(nodes))
        x, y = ((at - places[0]) / model.extent).T
        found[n, :, body[nodes]] = np.eye(3)
        found[n, 0, body[nodes], 2], found[n, 1, body[nodes], 2] = -y, x
        return found.reshape(len(nodes), 3, 3 * len(numbers))

    def held(dofs: Array) -> Array:
        kept: Array = rows(dofs // 3, places[dofs // 3])[np.arange(len(dofs)), dofs % 3]
        return kept

    equations = [held(model.fixed), held(model.slaves) - held(model.masters)]
    if model.springs is not None:
        equations += [held(model.springs.ground), held(model.springs.second) - held(model.springs.first)]
    for pair, touch in zip(model.pairs, state.touches, strict=True):
        if touch is None:
            continue
        at = np.array([model.node_position(pair, state.q, state.load_parameter)])
        moved = rows(model.element_nodes[[touch.element], 0], at)[0, :2]
        if pair.node >= 0:
            moved = moved - rows(np.array([pair.node]), at)[0, :2]
        x, y = pair.group.direction(touch, state.q)
        sticks = touch.grip is not None and not touch.grip.slip
        equations.append(moved if sticks else np.array([[-y, x]]) / math.hypot(x, y) @ moved)
    every = np.concatenate(equations)
    return bool(np.linalg.matrix_rank(every, tol=_LEAST) < every.shape[1])

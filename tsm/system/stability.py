"""Stability: index of an equilibrium and shape of its critical mode.

The energy's Hessian, bordered by the contacts, is a symmetric matrix K::

    [ A   B ]   A: band of the beams
    [ B^T D ]   D: the contacts' forces, arc positions and angles

A contact force is the Lagrange multiplier of a constraint on a position. With m multipliers, the Hessian over
the variations that the closed contacts admit has ``negatives(K) - m`` negative eigenvalues (Haynsworth 1968).
The same holds with a flexibility at the contact.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tsm.elements.properties import Array
from tsm.model.groups import ExactGroup
from tsm.model.groups.layout import OWN
from tsm.model.groups.rods import RodBalance
from tsm.model.groups.variation import modes_at_least, variation
from tsm.model.state import State
from tsm.system.inertia import Symmetric, negatives
from tsm.system.system import Assembler, Linearisation

IDLE = 1e-9
"""Largest force of a closed contact, over ``EI/L^2``, that counts as zero."""
_LOOSE = 100.0
"""Largest singular value of the tangent of a mechanism, in round-offs of its largest entry."""
_TURNS = 4
"""Number of iterations for the null vectors."""
UNDEFINED = -1
"""Index of an equilibrium for which no index is defined."""


def index(assembler: Assembler, state: State, system: Linearisation) -> int:
    """Number of negative eigenvalues of the energy's Hessian over the variations that supports and closed contacts admit.

    A contact that is closed without force admits variations to one side only. The index is then defined only
    if it is the same with the contact open, where the structure is no mechanism.

    The number is a lower bound for an exact element with more than a few hundred modes. It is -1, not
    defined, for a singular tangent, for numbers that are not finite, and for more than 1,500 unknowns whose
    pivots leave the diagonal. It is -1 also for closed contacts of the paper's elements: their force is
    normal to the chord and has no energy, and in slip, whose force has none either. A contact that sticks is
    held at its arc position; on a face the shear strain moves it.
    """
    if any(
        touch is not None and touch.grip is not None and touch.grip.held is None for touch in state.touches
    ):
        return UNDEFINED
    for forces in system.groups:
        if isinstance(forces, RodBalance) and (hidden := modes_at_least(forces)):
            return hidden
    with np.errstate(all="ignore"):
        symmetric = _symmetric(assembler, state, system)
    if symmetric is None:
        return UNDEFINED
    held_there = [
        assembler.model.border_dofs + pair.slot + 2
        for pair, touch in zip(assembler.model.pairs, state.touches, strict=True)
        if touch is not None and touch.grip is not None
    ]
    if held_there:
        symmetric = _freed(symmetric, held_there)
    counted = negatives(symmetric)
    if counted is None:
        return UNDEFINED
    held = counted - symmetric.multipliers
    model = assembler.model
    idle = [
        slot
        for pair, touch in zip(model.pairs, state.touches, strict=True)
        if touch is not None and math.hypot(*touch.force) <= IDLE * model.force_scale
        for slot in range(model.border_dofs + pair.slot, model.border_dofs + pair.slot + 3)
    ]
    if not idle:
        return held
    # a mechanism without its idle contacts has an eigenvalue of zero, whose sign is round-off
    free, moves = _freed(symmetric, idle), (model.kind[: model.banded] < 3) / symmetric.units**2
    stiffest = float((free.band[0, moves > 0] / moves[moves > 0]).max(initial=0.0))
    shift = _LOOSE * float(np.finfo(float).eps) * stiffest * moves
    shifted = (np.concatenate([free.band[:1] + way * shift, free.band[1:]]) for way in (-1, 1))
    expected = held + symmetric.multipliers - 2 * len(idle) // 3
    agreed = all(negatives(free._replace(band=band)) == expected for band in shifted)
    return held if agreed else UNDEFINED


def _freed(symmetric: Symmetric, idle: list[int]) -> Symmetric:
    """Symmetric tangent without some unknowns of the contacts, as the force and arc position of contacts that carry no force."""
    right, corner = symmetric.right.copy(), symmetric.corner.copy()
    right[:, idle] = corner[idle] = corner[:, idle] = 0.0
    corner[idle, idle] = 1.0
    return symmetric._replace(right=right, corner=corner)


def mode(assembler: Assembler, state: State, system: Linearisation) -> tuple[Array, float] | None:
    """Null vector of a tangent near a critical point, and the smallest singular value, which is 0 there.

    The units are longest beams, radians and ``EI/L^2``; in them the vector is 1 at most. A column and a row
    are added to the tangent, which makes it regular. They converge to the null vectors (Govaerts 2000). None
    where the tangent has two null vectors at once, or numbers that are not finite.
    """
    from scipy.sparse.linalg import splu

    columns, rows = _units(assembler, state)
    plain = assembler.whole(system.tangent).multiply(rows[:, None]).multiply(columns).tocoo()
    size = plain.shape[0]
    unit = np.append(np.zeros(size), 1.0)
    x, left = np.random.default_rng(0).standard_normal((2, size)) / np.sqrt(size)
    for _ in range(_TURNS):
        try:
            lu = splu(_bordered(plain, left, x))
        except (RuntimeError, ValueError):
            return None
        (*found, soft), (*found_left, _) = lu.solve(unit), lu.solve(unit, trans="T")
        x, left = np.array(found), np.array(found_left)
        if not (np.isfinite(x).all() and np.isfinite(left).all()):
            return None
        x, left = x / np.linalg.norm(x), left / np.linalg.norm(left)
    return x / x[np.abs(x).argmax()] * columns, abs(float(soft))


def loose(assembler: Assembler, state: State, system: Linearisation) -> bool:
    """Whether the structure can move without strain: the tangent has an eigenvalue that is zero but for round-off."""
    soft = mode(assembler, state, system)
    if soft is None:
        return True
    columns, rows = _units(assembler, state)
    plain = assembler.whole(system.tangent).multiply(rows[:, None]).multiply(columns)
    return soft[1] <= _LOOSE * float(np.finfo(float).eps) * float(abs(plain).max())


def _units(assembler: Assembler, state: State) -> tuple[Array, Array]:
    """Units of the unknowns, and factors of the rows, with which the tangent is dimensionless; an open contact keeps 1 on the diagonal."""
    model = assembler.model
    columns, rows = model.units, 1 / model.row_units
    for pair, touch in zip(model.pairs, state.touches, strict=True):
        if touch is None and pair.slot >= 0:
            start = model.banded + model.border_dofs + pair.slot
            own = slice(start, start + pair.target.kind.contact_unknowns)
            rows[own] = 1 / columns[own]
    return columns, rows


def _bordered(plain: Any, column: Array, row: Array) -> Any:
    from scipy.sparse import block_array, coo_array

    blocks = [[plain, coo_array(column[:, None])], [coo_array(row[None]), None]]
    return block_array(blocks, format="csc")


def _symmetric(assembler: Assembler, state: State, system: Linearisation) -> Symmetric | None:
    """Symmetric tangent, None where the tangent is not symmetric."""
    model, closed = assembler.model, 0
    for pair, touch in zip(model.pairs, state.touches, strict=True):
        if touch is not None:
            if pair.slot < 0:
                return None
            closed += 1
    units = model.units / math.sqrt(model.force_scale * model.length)
    for group, forces in zip(model.groups, system.groups, strict=True):
        if isinstance(group, ExactGroup) and isinstance(forces, RodBalance):
            return _with_variation(assembler, state, system, (group, forces), (units, 2 * closed))
    tangent, beside = system.tangent, units[model.banded :]
    return Symmetric(
        band=tangent.band[:, 2 * assembler.k :].T,
        right=tangent.right[: model.banded] * beside,
        corner=tangent.corner * beside * beside[:, None],
        units=units[: model.banded],
        multipliers=2 * closed,
    )


def _with_variation(
    assembler: Assembler,
    state: State,
    system: Linearisation,
    exact: tuple[ExactGroup, RodBalance],
    symmetric: tuple[Array, int],
) -> Symmetric:
    """Symmetric tangent in which the second variation of exact elements takes the place of their tangent.

    ``symmetric``: units of the unknowns, and how many forces of contacts are unknown.
    """
    model, (group, balance), (units, multipliers) = assembler.model, exact, symmetric
    tangent, border, aside, before = system.tangent, model.border, model.border_dofs, 36 * len(model.closed)
    rods = tangent.groups[group.number]
    second = variation(group, state, balance, rods.transfer)
    moments = [part.moments for part in second.bordered]
    angles = [part.slots.count(-1) - part.moments for part in second.bordered]
    right = np.zeros((model.equations + 1, border + sum(angles) + sum(moments)))
    corner = np.eye(right.shape[1])
    right[:, :border], corner[:border, :border] = tangent.right, tangent.corner
    values = second.tangent.reshape(len(second.tangent), -1).T
    closed = [part.tangent.ravel() for part in tangent.groups[: group.number]]
    flat = np.concatenate([*closed, values.ravel(), assembler.spring_values])
    band = np.bincount(assembler.scatter, flat, assembler.band_size + 1)[:-1].reshape(model.banded, -1)
    if aside:
        there = assembler.scatter_right[before : before + values.size]
        added = np.bincount(there, (values - rods.tangent).ravel(), assembler.size + 1)[:-1]
        right[:, :border] += added.reshape(-1, border)
    spare = border
    for part in second.bordered:
        own = np.array(part.slots) + aside
        new = np.array(part.slots) < 0
        own[new] = spare + np.arange(np.count_nonzero(new))
        spare += int(np.count_nonzero(new))
        right[:, own] = corner[own] = corner[:, own] = 0.0
        right[model.equation[group.dofs[:, part.element], None], own] = part.matrix[:OWN, OWN:]
        corner[own[:, None], own] = part.matrix[OWN:, OWN:]
    for pair, touch in zip(model.pairs, state.touches, strict=True):
        if pair.node >= 0 and pair.cuts and touch is not None:
            for i in range(2):
                right[model.equation[3 * pair.node + i], aside + pair.slot + i] += 1
    if aside:
        corner[:aside] = right[model.banded : model.equations]
        corner[:, :aside] = corner[:aside].T
    # angles inside the elements, and moments
    energy = model.force_scale * model.length
    own_units = [
        [1 / math.sqrt(energy)] * a + [math.sqrt(energy)] * m for a, m in zip(angles, moments, strict=True)
    ]
    beside = np.concatenate([units[model.banded :], *own_units])
    return Symmetric(
        band=band[:, 2 * assembler.k :].T,
        right=right[: model.banded] * beside,
        corner=corner * beside * beside[:, None],
        units=units[: model.banded],
        multipliers=multipliers + sum(moments),
    )

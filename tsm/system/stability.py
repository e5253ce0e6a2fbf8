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

import numpy as np

from tsm.elements.properties import Array
from tsm.model.contact import closed
from tsm.model.groups import ExactGroup
from tsm.model.groups.layout import OWN
from tsm.model.groups.rods import RodBalance
from tsm.model.groups.variation import modes_at_least, variation
from tsm.model.scales import IDLE
from tsm.system.inertia import Symmetric, negatives
from tsm.system.system import Assembler, Linearisation

_EPS = float(np.finfo(float).eps)
_LOOSE = 100.0
"""Largest singular value of the tangent of a mechanism, in round-offs of its largest entry."""
_TURNS = 4
"""Number of iterations for the null vectors."""
UNDEFINED = -1
"""Index of an equilibrium for which no index is defined."""


def index(assembler: Assembler, system: Linearisation) -> int:
    """Number of negative eigenvalues of the energy's Hessian over the variations that supports and closed contacts admit.

    A contact that is closed without force admits variations to one side only. The index is then defined only
    if it is the same with the contact open, where the structure is no mechanism.

    The number is a lower bound for an exact element with more than a few hundred modes. It is -1, not
    defined, for a singular tangent, for numbers that are not finite, and for more than 1,500 unknowns whose
    pivots leave the diagonal. It is -1 also for closed contacts of the paper's elements: their force is
    normal to the chord and has no energy, and in slip, whose force has none either. A contact that sticks
    admits no slip: a round pin rolls, and on a face the shear strain moves the arc position.
    """
    model, aside = assembler.model, assembler.model.border_dofs
    there = [(aside + pair.slot, touch) for _, pair, touch in closed(model, system.state)]
    if any(slot < aside or (touch.grip is not None and touch.grip.held is None) for slot, touch in there):
        return UNDEFINED
    for forces in system.groups:
        if isinstance(forces, RodBalance) and (hidden := modes_at_least(forces)):
            return hidden
    still = [(slot, touch) for slot, touch in there if math.hypot(*touch.force) <= IDLE * model.force_scale]
    symmetric = _symmetric(assembler, system, 2 * len(there))
    symmetric = _freed(symmetric, [slot + 2 for slot, touch in still if touch.grip is not None])
    counted = negatives(symmetric)
    if counted is None:
        return UNDEFINED
    held = counted - symmetric.multipliers
    if not still:
        return held
    # a mechanism without its idle contacts has an eigenvalue of zero, whose sign is round-off
    free = _freed(symmetric, [slot + n for slot, _ in still for n in range(3)])
    moves = (model.kind[: model.banded] < 3) / symmetric.units**2
    stiffest = float((free.band[0, moves > 0] / moves[moves > 0]).max(initial=0.0))
    shift = _LOOSE * _EPS * stiffest * moves
    shifted = (np.concatenate([free.band[:1] + way * shift, free.band[1:]]) for way in (-1, 1))
    agreed = all(negatives(free._replace(band=band)) == counted - 2 * len(still) for band in shifted)
    return held if agreed else UNDEFINED


def _freed(symmetric: Symmetric, idle: list[int]) -> Symmetric:
    """Symmetric tangent without some unknowns of the contacts, as the force and arc position of contacts that carry no force."""
    right, corner = symmetric.right.copy(), symmetric.corner.copy()
    right[:, idle] = corner[idle] = corner[:, idle] = 0.0
    corner[idle, idle] = 1.0
    return symmetric._replace(right=right, corner=corner)


def mode(assembler: Assembler, system: Linearisation) -> tuple[Array, float, float] | None:
    """Null vector of a tangent near a critical point, the smallest singular value, which is 0 there, and the largest entry.

    The units are longest beams, radians and ``EI/L^2``; in them the vector is 1 at most. A column and a row
    are added to the tangent, which makes it regular. They converge to the null vectors (Govaerts 2000). None
    where the tangent has two null vectors at once, or numbers that are not finite.
    """
    from scipy.sparse import block_array, coo_array
    from scipy.sparse.linalg import splu

    model, columns, rows = assembler.model, assembler.model.units, 1 / assembler.model.row_units
    for pair, touch in zip(model.pairs, system.state.touches, strict=True):
        if touch is None and pair.slot >= 0:  # an open contact keeps 1 on the diagonal
            start = model.banded + model.border_dofs + pair.slot
            own = slice(start, start + pair.target.kind.contact_unknowns)
            rows[own] = 1 / columns[own]
    plain = assembler.whole(system.tangent).multiply(rows[:, None]).multiply(columns).tocoo()
    size = plain.shape[0]
    unit = np.append(np.zeros(size), 1.0)
    x, left = np.random.default_rng(0).standard_normal((2, size)) / np.sqrt(size)
    for _ in range(_TURNS):
        blocks = [[plain, coo_array(left[:, None])], [coo_array(x[None]), None]]
        try:
            lu = splu(block_array(blocks, format="csc"))
        except (RuntimeError, ValueError):
            return None
        (*found, soft), (*found_left, _) = lu.solve(unit), lu.solve(unit, trans="T")
        x, left = np.array(found), np.array(found_left)
        if not (np.isfinite(x).all() and np.isfinite(left).all()):
            return None
        x, left = x / np.linalg.norm(x), left / np.linalg.norm(left)
    return x / x[np.abs(x).argmax()] * columns, abs(float(soft)), float(abs(plain).max())


def softness(assembler: Assembler, system: Linearisation) -> float:
    """Smallest singular value of the tangent over its largest entry; 0 where it is round-off: the structure can move without strain."""
    soft = mode(assembler, system)
    return 0.0 if soft is None or soft[1] <= _LOOSE * _EPS * soft[2] else soft[1] / soft[2]


def _symmetric(assembler: Assembler, system: Linearisation, multipliers: int) -> Symmetric:
    """Symmetric tangent, in which the second variation of exact elements takes the place of their tangent; so many forces are unknown."""
    model, tangent = assembler.model, system.tangent
    energy = math.sqrt(model.force_scale * model.length)
    units, band, right, corner = model.units / energy, tangent.band, tangent.right, tangent.corner
    own_units = units[model.banded :]
    if model.rods is not None:
        band, right, corner, kinds = _with_variation(assembler, system, model.rods)
        own_units = np.concatenate([own_units, np.where(kinds, energy, 1 / energy)])
        multipliers += int(kinds.sum())
    return Symmetric(
        band=band[:, 2 * assembler.k :].T,
        right=right[: model.banded] * own_units,
        corner=corner * own_units * own_units[:, None],
        units=units[: model.banded],
        multipliers=multipliers,
    )


def _with_variation(
    assembler: Assembler, system: Linearisation, group: ExactGroup
) -> tuple[Array, Array, Array, Array]:
    """Band, border columns and corner with the second variation of exact elements, and which of their own unknowns in the border are moments."""
    model, tangent, state = assembler.model, system.tangent, system.state
    border, aside, before = model.border, model.border_dofs, 36 * len(model.closed)
    rods, balance = tangent.groups[group.number], system.groups[group.number]
    assert isinstance(balance, RodBalance), "the forces of exact elements"
    second = variation(group, state, balance, rods.transfer)
    kinds: list[bool] = []
    places = []
    for part in second.bordered:
        first = border + len(kinds)
        own_count = len(part.matrix) - OWN - len(part.slots)
        kinds += [n >= own_count - part.moments for n in range(own_count)]
        places.append([*(slot + aside for slot in part.slots), *range(first, border + len(kinds))])
    size = border + len(kinds)
    right, corner = np.zeros((model.equations + 1, size)), np.eye(size)
    right[:, :border], corner[:border, :border] = tangent.right, tangent.corner
    values = second.tangent.reshape(len(second.tangent), -1).T
    others = [part.tangent.ravel() for part in tangent.groups[: group.number]]
    flat = np.concatenate([*others, values.ravel(), assembler.spring_values])
    band = np.bincount(assembler.scatter, flat, assembler.band_size + 1)[:-1].reshape(model.banded, -1)
    if aside:
        there = assembler.scatter_right[before : before + values.size]
        added = np.bincount(there, (values - rods.tangent).ravel(), assembler.size + 1)[:-1]
        right[:, :border] += added.reshape(-1, border)
    for own, part in zip(places, second.bordered, strict=True):
        right[:, own] = corner[own] = corner[:, own] = 0.0
        right[np.ix_(model.equation[group.dofs[:, part.element]], own)] = part.matrix[:OWN, OWN:]
        corner[np.ix_(own, own)] = part.matrix[OWN:, OWN:]
    for _, pair, _ in closed(model, state):
        if pair.node >= 0 and pair.cuts:
            for i in range(2):
                right[model.equation[3 * pair.node + i], aside + pair.slot + i] += 1
    if aside:
        corner[:aside] = right[model.banded : model.equations]
        corner[:, :aside] = corner[:aside].T
    return band, right, corner, np.array(kinds, dtype=bool)

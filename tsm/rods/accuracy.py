"""Error estimate of the integration inside exact elements, and its refinement."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from tsm.elements.collocation import collocation
from tsm.rods.assembly import Rods, profile_of
from tsm.rods.profile import resampled
from tsm.rods.records import Entry, Memo, RodBalance
from tsm.rods.shape import RodShape, plain_shape
from tsm.state import State

MOST_NODES = 256
"""Largest number of Gauss nodes of a segment."""
_AT_ONCE = 4
"""Least number of nodes that are added."""
_FALL = 100.0
"""Expected ratio of the errors with two nodes more."""
_SMOOTH = 1e-13
"""Error of an inner polynomial that counts as round-off."""


_UNRESOLVED = 1.0
"""Estimated error with a fixed number of nodes at which the mesh is too coarse: the error of a bent cantilever is then 3e-3. Boundary layers
under strong tension exceed it, though their elements hardly turn."""


def truncation(rods: Rods, entry: Entry) -> float:
    """Estimated error of the integration, in positions over the longest beam's length and in angles.

    At the ends of a segment the error is the product of two interpolation errors, of the solution and of the influence of an error inside;
    both are measured by the last two Legendre coefficients of moment and tangent vector, and both integrations divide by p.
    """
    segments, values = entry.segments, entry.field.values
    order = values.shape[2]
    last = collocation(order).legendre[-2:].T
    tail = np.abs(values @ last).max(axis=2)
    length = np.abs(segments.length[:, 0])
    turn = tail[0] * length**2 * segments.flexibility.bend.max(axis=1)
    if rods.varies:
        turn = np.maximum(turn, np.abs(rods.turning(entry) @ last).max(axis=1) * length)
    largest = np.maximum(turn, tail[1:].max(axis=0) * length / rods.model.length).max()
    return float(largest / order) ** 2


def finer(rods: Rods, state: State, balance: RodBalance, tolerance: float) -> State | None:
    """State with more Gauss nodes, None where the error estimate of `truncation` is small enough, or their number is fixed."""
    if rods.nodes is not None:
        return None
    order, error = profile_of(state).angle.shape[1], truncation(rods, balance.entry)
    if error <= tolerance or order == MOST_NODES:
        return None
    more = 2 * math.ceil(math.log(error / tolerance, _FALL)) if math.isfinite(error) else order
    return resampled(rods, state, min(order + max(more, _AT_ONCE), 2 * order, MOST_NODES))


def inaccurate(rods: Rods, balance: RodBalance, tolerance: float) -> bool:
    """Whether the most Gauss nodes do not suffice; with a fixed number, whether the mesh does not resolve the deflected axis."""
    if rods.nodes is not None:
        return truncation(rods, balance.entry) > _UNRESOLVED
    return balance.arrival.bent.shape[1] == MOST_NODES and truncation(rods, balance.entry) > tolerance


def deflected(rods: Rods, state: State) -> RodShape:
    """Deflected axis, as accurate between the Gauss nodes as at the ends of the segments.

    With p Gauss nodes the ends of a segment have order 2p, but the polynomial between them has order p. The polynomial is therefore
    computed again with 2p nodes between the same ends.
    """
    if rods.memo is None or rods.memo.state is not state:
        entry = rods.enter(state)
        if math.sqrt(truncation(rods, entry)) > _SMOOTH:
            entry = _finer_inside(rods, state)
        rods.memo = Memo(state, plain_shape(rods, state, entry), {})
    return rods.memo.shape


def _finer_inside(rods: Rods, state: State) -> Entry:
    """Segments between the same ends, with twice the Gauss nodes."""
    finer = resampled(rods, state, 2 * profile_of(state).angle.shape[1])
    entry = rods.enter(finer)
    for _ in range(5):
        arrival = rods.arrive(entry.segments, entry.field, entry.start, entry.moment, entry.end)
        if np.abs(arrival.inside).max() < _SMOOTH:
            break
        inner = rods.condense(entry.segments, entry.field, arrival, entry.moment).inner
        profile = profile_of(finer)
        finer = replace(finer, profile=replace(profile, angle=profile.angle + inner[:, :, 6]))
        entry = rods.enter(finer)
    return entry

"""Second variation of exact elements: a symmetric tangent, in which no mode inside an element is hidden.

Between two loads the force n is constant and the positions follow from it, so a segment of length h adds ::

    n . (r_j - r_i) + G,   G(phi_i, phi_j, n, h) = ext over phi(s) of  int EI phi'^2/2 - N - N^2/2EA - Q^2/2GA ds

and a contact ``- F . (r + reach nu - x_c)``. The modes of a segment whose angles are held at both ends, under constant n, are those of
``EI eta'' = f_phi eta``: none where ``- f_phi h^2/EI < pi^2`` everywhere (Sturm). Longer segments are divided, so every mode
shows in the matrix; each component of n and F takes one negative eigenvalue of it, and the rest is the index. The rows of
`tsm.rods.assembly` say the same in another form, which is not symmetric.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tsm.elements import rod
from tsm.elements.collocation import collocation
from tsm.elements.properties import Array
from tsm.rods.assembly import RodBalance, Rods, profile_of, touch_of
from tsm.rods.layout import OWN
from tsm.rods.shape import plain_shape
from tsm.state import State

_LONGEST = 7.0
"""Largest ``- f_phi h^2/EI`` of a segment that is not divided; its first mode lies at ``pi^2``."""
_PIECE = math.pi / 2
"""Root of the same in the pieces of a divided segment."""
_SHORT = 1e-4
"""Segments shorter than this part of their element keep their moment as an unknown: nothing is divided by their length."""
_HELD = np.array([0, 2, 3, 4, 5])
"""Inputs of a segment that G depends on: angles at both ends, force, length."""
_NODAL = np.array([2, 8, 3, 4])
"""The same, the length left out, among the nine degrees of freedom of an element."""
_PULL = np.zeros((OWN, OWN))
"""Derivatives of ``n . (r_j - r_i)``, and a unit for the moment, which has been eliminated."""
_PULL[[3, 4, 6, 7], [6, 7, 3, 4]] = 1
_PULL[[3, 4, 0, 1], [0, 1, 3, 4]] = -1
_PULL[5, 5] = 1
_NODES = np.array([0, 1, 2, 6, 7, 8])


class Bordered(NamedTuple):
    """Element with contacts, or with modes inside.

    Attributes
    ----------
    element : int
        Counted over the exact elements.
    matrix : ndarray, shape (9 + b, 9 + b)
        Over the element's degrees of freedom, then what it has in the border.
    slots : list of int
        Positions of the latter among the contacts' unknowns, -1 for the angles and moments that are the element's own.
    moments : int
        How many of the latter are moments; they are the last.
    """

    element: int
    matrix: Array
    slots: list[int]
    moments: int


class Variation(NamedTuple):
    """Symmetric tangent of the exact elements, their forces and moments eliminated.

    Attributes
    ----------
    tangent : ndarray, shape (r, 9, 9)
        Over the degrees of freedom of the elements, with units for force and moment.
    bordered : tuple of Bordered
        Elements that have more unknowns; their first nine are in `tangent` too.
    """

    tangent: Array
    bordered: tuple[Bordered, ...]


class _Pieces(NamedTuple):
    """Segments, divided where modes could hide: p pieces of s segments.

    Attributes
    ----------
    counts : ndarray of int, shape (s,)
        Pieces of every segment.
    short : ndarray of bool, shape (p,)
        Those that keep their moment.
    hessian : ndarray, shape (p, 5, 5)
        Of G; of short pieces unused.
    with_moment : ndarray, shape (p, 6, 6)
        The same with the moment at the start as the last unknown; of other pieces unused.
    """

    counts: Array
    short: Array
    hessian: Array
    with_moment: Array


def variation(rods: Rods, state: State, balance: RodBalance) -> Variation:
    """Second variation at a state in equilibrium.

    Parameters
    ----------
    rods : Rods
        The exact elements.
    state : State
        In equilibrium.
    balance : RodBalance
        Their residual there.
    """
    pieces = _pieces(rods, state, balance)
    place, cuts = balance.entry.place, dict(profile_of(state).cuts)
    first = np.concatenate([[0], np.cumsum(pieces.counts)])
    at = first[place.first]
    tangent = _plain(pieces.hessian[at])
    many = first[place.last + 1] - at > 1
    bordered = tuple(
        _bordered(rods, state, balance, pieces, int(e), cuts.get(int(e), ())) for e in np.flatnonzero(many)
    )
    for part in bordered:
        tangent[part.element] = part.matrix[:OWN, :OWN]
    return Variation(tangent, bordered)


def _plain(hessian: Array) -> Array:
    """Tangents (r, 9, 9) of elements of one piece, their force eliminated."""
    tangent = np.empty((len(hessian), OWN, OWN))
    tangent[:] = _PULL
    tangent[:, _NODAL[:, None], _NODAL] += hessian[:, :4, :4]
    return _without_force(tangent)


def _without_force(tangent: Array) -> Array:
    """Eliminate the rows 3 and 4 of matrices (..., n, n); a unit matrix takes their place."""
    of_force = tangent[..., 3:5, :].copy()
    of_force[..., 3:5] = 0.0
    solved = np.linalg.solve(tangent[..., 3:5, 3:5], of_force)
    tangent = tangent - np.swapaxes(of_force, -1, -2) @ solved
    tangent[..., 3:5, :] = tangent[..., :, 3:5] = 0.0
    tangent[..., [3, 4], [3, 4]] = 1.0
    return tangent


def _pieces(rods: Rods, state: State, balance: RodBalance) -> _Pieces:
    entry = balance.entry
    at, of, start, moment, end = entry.at, entry.of, entry.start, entry.moment, entry.end
    arrival, gain = balance.arrival, entry.gain
    length = at.length[:, 0]
    falling = (of.gq * of.q - of.N * of.turn).max(axis=1) * length * length * at.flexibility.bend[:, 0]
    count = np.ones(len(length), dtype=int)
    if falling.max() > _LONGEST:
        long = falling > _LONGEST
        count[long] = np.ceil(np.sqrt(falling[long]) / _PIECE).astype(int)
        at, start, moment, end = _divided(rods, state, balance, count)
        of = rod.field(at)
        arrival, gain = rod.arrival(at, of, start, moment, end), of.sums[0, :, 0] * at.length[:, 0]
    transfer = rod.condense(at, of, arrival, moment).transfer
    bent = (moment[:, 0] + gain) * at.flexibility.bend[:, 0]
    short = np.abs(at.length[:, 0]) < _SHORT * rods.length[np.repeat(entry.place.owner, count)]
    hessian, with_moment = np.zeros((len(short), 5, 5)), np.zeros((len(short), 6, 6))
    hessian[~short] = _hessian(transfer[~short], bent[~short])
    if short.any():
        with_moment[short] = _hessian_with_moment(transfer[short], bent[short])
    return _Pieces(count, short, hessian, with_moment)


def _divided(
    rods: Rods, state: State, balance: RodBalance, count: Array
) -> tuple[rod.Segments, Array, Array, Array]:
    """Equal pieces of the segments, with their angles and moments at the ends."""
    entry, own = balance.entry, np.repeat(np.arange(len(count)), count)
    shape, nodes = plain_shape(rods, state, entry), collocation(entry.at.angle.shape[1]).c
    inside, ends = [], []
    for s, parts in enumerate(count.tolist()):
        sigma = (np.arange(parts)[:, None] + nodes) / parts
        inside.append(shape.within(s, sigma.ravel()).angle.reshape(sigma.shape))
        at = shape.within(s, np.arange(parts + 1) / parts)
        ends.append(np.stack([at.angle[:-1], at.moment[:-1], at.angle[1:]], axis=1))
    flexibility = rod.Flexibility(*(value[own] for value in entry.at.flexibility))
    length = entry.at.length[own] / count[own, None]
    segments = rod.Segments(flexibility, entry.at.force[:, own], length, np.concatenate(inside))
    start, moment, end = np.concatenate(ends).T[:, :, None]
    return segments, start, moment, end


def _hessian(transfer: Array, bent: Array) -> Array:
    """Hessians of G (s, 5, 5): the moment at the start is that with which the angle arrives; ``dG/dh = - m^2/2EI - ...`` at the end."""
    by = transfer[:, :, _HELD]
    moment = -by[:, 0] / transfer[:, 0, 1, None]
    arriving = by[:, 1:] + transfer[:, 1:, 1, None] * moment[:, None, :]
    hessian = np.empty((len(by), 5, 5))
    hessian[:, 0], hessian[:, 1] = -moment, arriving[:, 0]
    hessian[:, 2:4] = -arriving[:, 1:]
    hessian[:, 4, :4] = hessian[:, :4, 4]
    hessian[:, 4, 4] = -bent * hessian[:, 1, 4]
    return (hessian + np.swapaxes(hessian, 1, 2)) / 2


def _hessian_with_moment(transfer: Array, bent: Array) -> Array:
    """Hessians (s, 6, 6) of ``G* (m, phi_j, n, h) - m phi_i``, whose extremum in m is G; regular at ``h = 0``."""
    by = transfer[:, :, [2, 3, 4, 5, 1]]
    angle = -by[:, 0] / transfer[:, 0, 0, None]
    arriving = by[:, 1:] + transfer[:, 1:, 0, None] * angle[:, None, :]
    hessian = np.zeros((len(by), 6, 6))
    hessian[:, 0, 5] = hessian[:, 5, 0] = -1
    hessian[:, 1, 1:], hessian[:, 5, 1:] = arriving[:, 0], angle
    hessian[:, 2:4, 1:] = -arriving[:, 1:]
    hessian[:, 4, [1, 2, 3, 5]] = hessian[:, [1, 2, 3, 5], 4]
    hessian[:, 4, 4] = -bent * hessian[:, 1, 4]
    return (hessian + np.swapaxes(hessian, 1, 2)) / 2


def _bordered(
    rods: Rods, state: State, balance: RodBalance, pieces: _Pieces, element: int, pairs: tuple[int, ...]
) -> Bordered:
    """Matrix of an element of several pieces; its stations are the contacts and where a segment is divided."""
    place, model = balance.entry.place, rods.model
    first, last = int(place.first[element]), int(place.last[element])
    counts = pieces.counts[first : last + 1].tolist()
    begin = int(pieces.counts[:first].sum())
    short = pieces.short[begin : begin + sum(counts)].tolist()
    size = OWN + 4 * len(pairs) + sum(counts) - len(counts) + sum(short)
    matrix = np.zeros((size, size))
    matrix[:OWN, :OWN] = _PULL
    rows = np.eye(size)
    slots = [slot for k in pairs for slot in range(model.pairs[k].slot, model.pairs[k].slot + 4)]
    slots += [-1] * (size - OWN - len(slots))
    force, angle, piece = rows[3:5].copy(), rows[2], begin
    own_angle = OWN + 4 * len(pairs)
    own_moment = size - sum(short)
    for segment, count in enumerate(counts):
        own, ahead = OWN + 4 * segment, segment < len(pairs)
        length = (rows[own + 2] if ahead else 0.0) - (rows[own - 2] if segment else 0.0)
        for part in range(count):
            arriving = rows[own + 3] if ahead else rows[8]
            if part < count - 1:
                arriving, own_angle = rows[own_angle], own_angle + 1
            inputs = [angle, arriving, *force, np.zeros(size) + length / count]
            of = pieces.hessian[piece]
            if pieces.short[piece]:
                inputs, of = [*inputs, rows[own_moment]], pieces.with_moment[piece]
                own_moment += 1
            by = np.array(inputs)
            matrix += by.T @ of @ by
            angle, piece = arriving, piece + 1
        if ahead:
            k, pull = pairs[segment], slice(own, own + 2)
            matrix[pull, 6:8] -= np.eye(2)
            matrix[6:8, pull] -= np.eye(2)
            if model.pairs[k].reach:
                selectors = np.array([rows[own + 3], *force, *rows[pull]])
                matrix += _surface(
                    touch_of(state, k).force, balance.tangents[k], model.pairs[k].reach, selectors
                )
            force -= rows[pull]
    return Bordered(element, _without_force(matrix), slots, sum(short))


def _surface(
    force: tuple[float, float], tangents: tuple[rod.Tangent, rod.Tangent], reach: float, selectors: Array
) -> Array:
    """Second derivatives of ``- reach F . nu``, nu across the sum of the tangent vectors, where F is parallel to nu.

    With beta the angle of that sum and tau its direction, ``d nu = tau d beta`` and ``d^2 nu = tau d^2 beta - nu d beta^2``.
    """
    before, after = tangents
    tx, ty = before.vector[0] + after.vector[0], before.vector[1] + after.vector[1]
    (xx, xy, yy), (ax, ay, aa) = before.compliance, after.compliance
    turned_x = [before.turned[0] + after.turned[0], xx + ax, xy + ay, -ax, -ay]
    turned_y = [before.turned[1] + after.turned[1], xy + ay, yy + aa, -ay, -aa]
    size = math.hypot(tx, ty)
    turn = (tx * np.array(turned_y) - ty * np.array(turned_x)) / size**2 @ selectors
    along = np.array([tx, ty]) / size @ selectors[3:]
    across = (force[0] * ty - force[1] * tx) / size
    both = np.outer(along, turn)
    surface: Array = -reach * (both + both.T - across * np.outer(turn, turn))
    return surface

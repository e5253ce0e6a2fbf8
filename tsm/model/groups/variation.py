"""Second variation of exact elements: a symmetric tangent, in which no mode inside an element is hidden.

Between two loads the force n is constant and the positions follow from it, so a segment of length h adds ::

    n . (r_j - r_i) + G,   G(phi_i, phi_j, n, h) = ext over phi(s) of  int EI phi'^2/2 - N - N^2/2EA - Q^2/2GA ds

and a contact ``- F . (r + reach nu - x_c)``. The modes of a segment whose angles are held at both ends, under
constant n, solve ``EI eta'' = f_phi eta``: none where ``- f_phi h^2/EI < pi^2`` everywhere (Sturm). Longer
segments are divided, so every mode shows in the matrix; each component of n and F takes one negative
eigenvalue of it, and the rest is the index. The rows of `tsm.model.groups.exact` say the same in another form,
which is not symmetric.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from tsm.elements import rod
from tsm.elements.properties import Array
from tsm.elements.rod import Segments
from tsm.elements.varied import STEP
from tsm.model.groups.cut import Cut
from tsm.model.groups.layout import COLUMNS, CUT, OWN, chain
from tsm.model.groups.rods import Entry, RodBalance, Rods
from tsm.model.groups.shape import Station, plain_shape
from tsm.model.scales import IDLE
from tsm.model.state import State, profile_of

_LONGEST = 7.0
"""Largest ``- f_phi h^2/EI`` of a segment that is not divided; its first mode lies at ``pi^2``."""
_PIECE = math.pi / 2
"""Largest ``sqrt(- f_phi h^2/EI)`` of the pieces of a divided segment."""
_MOST = 300
"""Largest number of pieces of all segments; beyond it the modes are counted by a bound."""
_SHORT = 1e-4
"""Length over the element's below which a segment keeps its moment as an unknown, to avoid a division by a length near zero or negative."""
_PULL = np.zeros((OWN, OWN))
"""Derivatives of ``n . (r_j - r_i)``, and a unit for the moment, which has been eliminated."""
_PULL[[3, 4, 6, 7], [6, 7, 3, 4]] = 1
_PULL[[3, 4, 0, 1], [0, 1, 3, 4]] = -1
_PULL[5, 5] = 1


class Bordered(NamedTuple):
    """Element with contacts, or with modes inside."""

    element: int  # counted over the exact elements
    # tangent over the element's degrees of freedom, then over the element's unknowns in the border; shape
    # (9 + b, 9 + b)
    matrix: Array
    # positions of the first of the latter among the contacts' unknowns; the others are its own
    slots: list[int]
    moments: int  # how many of these are moments or forces, the last; the others are angles


class Variation(NamedTuple):
    """Symmetric tangent of the exact elements, their forces and moments eliminated."""

    # over the degrees of freedom of the elements, with units for force and moment; shape (r, 9, 9)
    tangent: Array
    bordered: tuple[Bordered, ...]  # elements that have more unknowns; their first nine are in `tangent` too


class _Pieces(NamedTuple):
    """Segments, divided where modes could hide: p pieces of s segments."""

    counts: Array  # pieces of every segment; shape (s,)
    short: Array  # those that keep their moment; shape (p,)
    # second derivatives of G over the inputs of `rod` without what is constant; the
    # moment is an input of short pieces only; shape (p, 6, 6) or (p, 7, 7)
    hessian: Array

    @property
    def divided(self) -> bool:
        """Whether any segment is."""
        return len(self.short) > len(self.counts)


def modes_at_least(balance: RodBalance) -> int:
    """Modes of the segments between held angles, by Sturm's comparison with the least of the falling coefficient; 0 where few pieces do.

    A segment pressed so hard that it takes more than `_MOST` pieces has this many negative eigenvalues at
    least, less those that the arrival of its end takes away.
    """
    segments, field = balance.entry.segments, balance.entry.field
    falling = -field.slope * _square(segments)
    most = np.sqrt(np.maximum(falling.max(axis=1), 0.0)) / _PIECE
    if not most.sum() > _MOST:
        return 0
    return int((np.sqrt(np.maximum(falling.min(axis=1), 0.0)) / math.pi).sum())


def _square(segments: Segments) -> Array:
    """``h^2/EI``, by which a falling coefficient is multiplied; where EI varies it is ``(int ds/EI)^2 EI``, of shape (s, p)."""
    length, bend = segments.length, segments.flexibility[2]
    square: Array = length * length * bend
    if bend.shape[1] > 1:
        square *= ((bend @ segments.table.w)[:, None] / bend) ** 2
    return square


def variation(group: Rods, state: State, balance: RodBalance, transfer: Array | None = None) -> Variation:
    """Second variation at a state in equilibrium, from the transfer of the segments where it is known."""
    pieces = _pieces(group, state, balance, transfer)
    place, pairs = balance.entry.place, dict(profile_of(state).cuts)
    divided = {int(place.owner[s]) for s in np.flatnonzero(pieces.counts > 1)} if pieces.divided else set()
    many = sorted(divided.union(pairs))
    tangent = np.empty((len(place.first), OWN, OWN))
    if len(many) < len(tangent):
        tangent[:], begin = _PULL, np.cumsum(pieces.counts) - pieces.counts
        tangent[:, COLUMNS[:, None], COLUMNS] += pieces.hessian[begin[place.first], :5, :5]
        tangent = _without_force(tangent)
    bordered = tuple(_bordered(group, balance, pieces, e, pairs.get(e, ())) for e in many)
    for part in bordered:
        tangent[part.element] = part.matrix[:OWN, :OWN]
    return Variation(tangent, bordered)


def _without_force(tangent: Array) -> Array:
    """Eliminate the rows 3 and 4 of matrices (..., n, n); a unit matrix takes their place."""
    of_force = tangent[..., 3:5, :].copy()
    xx, xy, yy = of_force[..., 0, 3], of_force[..., 0, 4], of_force[..., 1, 4]
    adjoint = np.empty_like(of_force[..., 3:5])
    adjoint[..., 0, 0], adjoint[..., 1, 1] = yy, xx
    adjoint[..., 0, 1] = adjoint[..., 1, 0] = -xy
    adjoint /= (xx * yy - xy * xy)[..., None, None]
    of_force[..., 3:5] = 0.0
    tangent = tangent - np.swapaxes(of_force, -1, -2) @ (adjoint @ of_force)
    tangent[..., 3:5, :] = tangent[..., :, 3:5] = 0.0
    tangent[..., 3, 3] = tangent[..., 4, 4] = 1.0
    return tangent


def _pieces(group: Rods, state: State, balance: RodBalance, transfer: Array | None) -> _Pieces:
    entry = balance.entry
    segments, field, start, moment, end = entry.segments, entry.field, entry.start, entry.moment, entry.end
    whole = group.length[entry.place.owner]
    falling = (-field.slope * _square(segments)).max(axis=1)
    counts = np.ones(len(whole), dtype=int)
    if falling.max() > _LONGEST:
        long = falling > _LONGEST
        counts[long] = np.ceil(np.sqrt(falling[long]) / _PIECE).astype(int)
        segments, start, moment, end = _divided(group, state, entry, counts)
        field, transfer, whole = rod.field(segments), None, np.repeat(whole, counts)
    if transfer is None:
        transfer = rod.condense(segments, field, rod.arrival(segments, field, start, moment, end)).transfer
    length = segments.length[:, 0]
    ends = np.concatenate([start, end, moment, moment + field.sums[0][:, None] * segments.length], axis=1).T
    short = length < _SHORT * whole
    hessian = _hessians(group, segments, ends, transfer, state.load_parameter, eliminated=1)
    if short.any():
        own = _hessians(group, segments, ends, transfer, state.load_parameter, eliminated=0)
        hessian[short] = own[short]
    return _Pieces(counts, short, hessian)


def _divided(group: Rods, state: State, entry: Entry, count: Array) -> tuple[Segments, Array, Array, Array]:
    """Equal pieces of the segments, with their angles and moments at the ends."""
    whole, own = entry.segments, np.repeat(np.arange(len(count)), count)
    part, parts = np.arange(len(own)) - (np.cumsum(count) - count)[own], count[own, None]
    shape = plain_shape(group, state, entry)

    def at(places: Array) -> Station:
        """Stations at places (m,) of every piece."""
        return shape.within(np.repeat(own, len(places)), ((part[:, None] + places) / parts).ravel())

    start, end, length = at(np.zeros(1)), at(np.ones(1)), whole.length[own] / parts
    segments = Segments(
        flexibility=whole.flexibility[:, own],
        force=whole.constant[:, own],
        length=length,
        angle=at(whole.table.c).angle.reshape(len(own), -1),
        constant=whole.constant[:, own],
        owner=whole.owner[own],
        begin=whole.begin[own] + part[:, None] * length,
        curvature=whole.curvature[own],
    )
    placed = group.placed(segments, state.load_parameter)
    return placed, start.angle[:, None], start.moment[:, None], end.angle[:, None]


def _hessians(
    group: Rods,
    segments: Segments,
    ends: Array,
    transfer: Array,
    load_parameter: float,
    eliminated: int,
) -> Array:
    """Hessians of G over the inputs of segments, (s, 6, 6), or (s, 7, 7) with the arc position of the start where a course varies.

    ``ends`` (4, s): angles, then moments, at both ends. ``eliminated``: 1 where the moment at the start is
    that with which the angle arrives; 0 for the Hessian of ``G*(m, phi_j, n, h) - m phi_i``, whose extremum
    in m is G, with the moment as an input; it is regular at ``h = 0``. With ``H = m^2/2EI + k0 m + N +
    N^2/2EA + Q^2/2GA`` it is ``dG/dh = - H(a + h)`` and ``dG/da = H(a) - H(a + h)``. Along the arc H changes
    with what it has at both ends, and explicitly by ``(1/EI)' m^2/2 + (1/EA)' N^2/2 + (1/GA)' Q^2/2 - q .
    r'``.
    """
    course, by = segments.course, transfer[:, :, [0, 1, 2, 3, 4, 5, *([rod.ARC] if segments.course else [])]]
    given = by[:, 0] / -by[:, 0, eliminated, None]
    if not eliminated:
        given[:, 0] = 0.0
    arriving = by[:, 1:] + by[:, 1:, eliminated, None] * given[:, None, :]
    hessian = np.zeros((len(by), by.shape[2], by.shape[2]))
    hessian[:, 1 - eliminated] = -given if eliminated else given
    hessian[:, 2], hessian[:, 3:5] = arriving[:, 0], -arriving[:, 1:]
    hessian[:, :, eliminated] = 0.0
    if not eliminated:
        hessian[:, 0, 1] = hessian[:, 1, 0] = -1.0
    hessian[:, 5:, :5] = hessian[:, :5, 5:].transpose(0, 2, 1)
    if course is None:
        hessian[:, 5, 5] = -ends[3] * segments.flexibility[2, :, 0] * hessian[:, 2, 5]
        return hessian
    arcs = np.concatenate([segments.begin, segments.begin + segments.length], axis=1)
    course = group.course(segments.owner, arcs, load_parameter)
    angles, moments, force = ends[:2].T, ends[2:].T, segments.constant - course.resultant
    stretch, shear, bend = course.flexibility
    e, u, b = course.flexibility + 1j * STEP * course.slope
    c, s, (nx, ny) = np.cos(angles), np.sin(angles), force - 1j * STEP * course.load
    N, Q = nx * c + ny * s, ny * c - nx * s
    own = (b * moments**2 / 2 + N + e * N**2 / 2 + u * Q**2 / 2).imag / STEP
    N, Q = N.real, Q.real
    turn = bend * moments + segments.curvature
    change = Q[:, 0] * (1 + (stretch - shear) * N)[:, 0] if not eliminated else turn[:, 0]
    hessian[:, 5, 5] = -turn[:, 1] * hessian[:, 2, 5] - own[:, 1]
    hessian[:, 5, 6] = hessian[:, 6, 5] = -turn[:, 1] * hessian[:, 2, 6] - own[:, 1]
    hessian[:, 6, 6] = change * given[:, 6] + own[:, 0] + hessian[:, 5, 6]
    return hessian


def _bordered(
    group: Rods, balance: RodBalance, pieces: _Pieces, element: int, pairs: tuple[int, ...]
) -> Bordered:
    """Matrix of an element of several pieces; its stations are the contacts and where a segment is divided."""
    place, model = balance.entry.place, group.model
    first, last = int(place.first[element]), int(place.last[element])
    counts = tuple(pieces.counts[first : last + 1].tolist())
    begin = int(pieces.counts[:first].sum())
    own = slice(begin, begin + sum(counts))
    short = tuple(pieces.short[own].tolist())
    fixed, inputs, directions = _stations(counts, short, pieces.hessian.shape[1])
    matrix = fixed + (inputs.transpose(0, 2, 1) @ (pieces.hessian[own] @ inputs)).sum(axis=0)
    # linear forms of what does not slip where contacts stick: constraints, each with a force of its own
    slips: list[Array] = []
    for n, k in enumerate(pairs):
        cut = balance.entry.cuts[k]
        if model.pairs[k].reach:
            matrix += _surface(cut, directions[n])
        if cut.touch.grip is not None and math.hypot(*cut.touch.force) > IDLE * model.force_scale:
            slips.append(cut.derivatives[4] @ directions[n])
            slips[-1][OWN + CUT * n + 2] += cut.pair.place(cut.here).stretch
    if slips:
        matrix = np.block([[matrix, np.transpose(slips)], [np.array(slips), np.zeros((len(slips),) * 2)]])
    slots = [slot for k in pairs for slot in range(model.pairs[k].slot, model.pairs[k].slot + CUT)]
    return Bordered(element, _without_force(matrix), slots, sum(short) + len(slips))


@lru_cache(maxsize=64)
def _stations(counts: tuple[int, ...], short: tuple[bool, ...], width: int) -> tuple[Array, Array, Array]:
    """Constant matrices of an element whose segments have `counts` pieces, which may be short.

    Returns ``fixed`` (n, n), second derivatives of ``n . (r_j - r_i) - sum F . (r_j - x_c)``;
    ``inputs`` (pieces, width, n), inputs of the pieces by the element's unknowns; only short pieces have a
    moment. The seventh is the arc position of the start; ``directions`` (contacts, 8, n), angle, force
    before, contact force, arc position, and zeros of every contact by the same.
    """
    whole, _, selectors = (part[..., :-2] for part in chain(len(counts) - 1))
    size, part = whole.shape[2], np.concatenate([np.arange(count) for count in counts])
    inside = np.flatnonzero(part)
    own = np.eye(size + len(inside) + sum(short))
    fixed, inputs = np.zeros_like(own), np.zeros((len(part), width, len(own)))
    directions = np.zeros((*selectors.shape[:2], len(own)))
    directions[..., :size] = selectors
    fixed[:OWN, :OWN] = _PULL
    for k in range(OWN, size, CUT):
        fixed[[k, k + 1, 6, 7], [6, 7, k, k + 1]] -= 1
    inputs[..., :size] = np.repeat(whole[:, [0, 1, 2, 3, 4, 5, rod.ARC][:width]], counts, axis=0)
    inputs[:, 5] /= np.repeat(counts, counts)[:, None]
    inputs[:, 6:] += part[:, None, None] * inputs[:, 5:6]
    inputs[inside, 0] = inputs[inside - 1, 2] = own[size : size + len(inside)]
    inputs[:, 1] = 0
    inputs[np.array(short), 1] = own[size + len(inside) :]
    return fixed, inputs, directions


def _surface(cut: Cut, selectors: Array) -> Array:
    """Second derivatives of ``- reach F . nu``, where F is parallel to nu, the normal of the surface, to the right of the beam.

    With beta the angle of its direction tau, ``d nu = tau d beta`` and ``d^2 nu = tau d^2 beta - nu d
    beta^2``.
    """
    pair, force, reach = cut.pair, np.array(cut.touch.force), cut.pair.reach_at(cut.here.arc)
    normal, along = np.array(pair.face(cut.here))
    along /= np.hypot(*along)
    turn = along @ cut.derivatives[:2] @ selectors / reach
    both = reach * np.outer(along @ selectors[3:5], turn)
    both += pair.steep * np.outer(normal @ selectors[3:5], selectors[5])
    return reach * (normal @ force) * np.outer(turn, turn) - both - both.T

"""Second variation of exact elements: a symmetric tangent, in which no mode inside an element is hidden.

Between two loads the force n is constant and the positions follow from it, so a segment of length h adds ::

    n . (r_j - r_i) + G,   G(phi_i, phi_j, n, h) = ext over phi(s) of  int EI phi'^2/2 - N - N^2/2EA - Q^2/2GA ds

and a contact ``- F . (r + reach nu - x_c)``. The modes of a segment whose angles are held at both ends, under constant n, solve
``EI eta'' = f_phi eta``: none where ``- f_phi h^2/EI < pi^2`` everywhere (Sturm). Longer segments are divided, so every mode
shows in the matrix; each component of n and F takes one negative eigenvalue of it, and the rest is the index. The rows of
`tsm.rods.assembly` say the same in another form, which is not symmetric.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from tsm.elements import rod
from tsm.elements.collocation import collocation
from tsm.elements.properties import Array
from tsm.rods.assembly import Rods, profile_of, touch_of
from tsm.rods.contact_rows import Explicit, by_selectors, leaning, turned
from tsm.rods.layout import COLUMNS, CUT, OWN
from tsm.rods.records import RodBalance
from tsm.rods.shape import plain_shape
from tsm.rods.varying import VaryingRods
from tsm.rods.varying_variation import hessians
from tsm.state import State

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
    # positions of the latter among the contacts' unknowns, -1 for the angles and moments that are the
    # element's own
    slots: list[int]
    moments: int  # how many of the latter are moments; they are the last


class Variation(NamedTuple):
    """Symmetric tangent of the exact elements, their forces and moments eliminated."""

    # over the degrees of freedom of the elements, with units for force and moment; shape (r, 9, 9)
    tangent: Array
    bordered: tuple[Bordered, ...]  # elements that have more unknowns; their first nine are in `tangent` too


class _Pieces(NamedTuple):
    """Segments, divided where modes could hide: p pieces of s segments."""

    counts: Array  # pieces of every segment; shape (s,)
    short: Array  # those that keep their moment; shape (p,)
    # second derivatives of G over the inputs of `rod`, or of `varying`, without what is constant; the
    # moment is an input of short pieces only; shape (p, 6, 6) or (p, 7, 7)
    hessian: Array

    @property
    def divided(self) -> bool:
        """Whether any segment is."""
        return len(self.short) > len(self.counts)


def modes_at_least(balance: RodBalance) -> int:
    """Modes of the segments between held angles, by Sturm's comparison with the least of the falling coefficient; 0 where few pieces do.

    A segment pressed so hard that it takes more than `_MOST` pieces has this many negative eigenvalues at least, less those that the
    arrival of its end takes away.
    """
    segments, field = balance.entry.segments, balance.entry.field
    falling = (field.gq * field.q - field.N * field.turn) * _square(segments)
    most = np.sqrt(np.maximum(falling.max(axis=1), 0.0)) / _PIECE
    if not most.sum() > _MOST:
        return 0
    return int((np.sqrt(np.maximum(falling.min(axis=1), 0.0)) / math.pi).sum())


def _square(segments: Any) -> Array:
    """``h^2/EI``, by which a falling coefficient is multiplied; where EI varies it is ``(int ds/EI)^2 EI``, of shape (s, p)."""
    length, bend = segments.length, segments.flexibility.bend
    square: Array = length * length * bend
    if bend.shape[1] > 1:
        square *= ((bend @ collocation(bend.shape[1]).w)[:, None] / bend) ** 2
    return square


def variation(rods: Rods, state: State, balance: RodBalance, transfer: Array | None = None) -> Variation:
    """Second variation at a state in equilibrium.

    ``balance``: their residual there. ``transfer`` (s, 4, 7), optional: transfer of the segments, see
    `rod.Condensed`, where it is known.
    """
    pieces = _pieces(rods, state, balance, transfer)
    place, pairs = balance.entry.place, dict(profile_of(state).cuts)
    begin = np.cumsum(pieces.counts) - pieces.counts
    divided = {int(place.owner[s]) for s in np.flatnonzero(pieces.counts > 1)} if pieces.divided else set()
    many = sorted(divided.union(pairs))
    tangent = np.empty((len(place.first), OWN, OWN))
    if len(many) < len(tangent):
        tangent[:] = _PULL
        tangent[:, COLUMNS[:, None], COLUMNS] += pieces.hessian[begin[place.first], :5, :5]
        tangent = _without_force(tangent)
    bordered = tuple(_bordered(rods, state, balance, pieces, e, pairs.get(e, ())) for e in many)
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
    tangent[..., [3, 4], [3, 4]] = 1.0
    return tangent


def _pieces(rods: Rods, state: State, balance: RodBalance, transfer: Array | None) -> _Pieces:
    entry = balance.entry
    segments, field, start, moment, end = entry.segments, entry.field, entry.start, entry.moment, entry.end
    arrival, gain = balance.arrival, entry.gain
    length, whole = segments.length[:, 0], rods.length[entry.place.owner]
    falling = ((field.gq * field.q - field.N * field.turn) * _square(segments)).max(axis=1)
    counts = np.ones(len(length), dtype=int)
    if falling.max() > _LONGEST:
        long = falling > _LONGEST
        counts[long] = np.ceil(np.sqrt(falling[long]) / _PIECE).astype(int)
        segments, start, moment, end = _divided(rods, state, balance, counts)
        field, transfer = rods.field(segments), None
        length, whole = segments.length[:, 0], np.repeat(whole, counts)
        arrival, gain = rods.arrive(segments, field, start, moment, end), field.sums[0, :, 0] * length
    if transfer is None:
        transfer = rods.condense(segments, field, arrival, moment).transfer
    short = length < _SHORT * whole
    if isinstance(rods, VaryingRods):
        moments = np.stack([moment[:, 0], moment[:, 0] + gain])
        ends = np.stack([np.stack([start[:, 0], end[:, 0]]), moments])
        hessian, with_moment = hessians(rods, segments, ends, transfer, state.load_parameter)
        hessian[short] = with_moment[short]
        return _Pieces(counts, short, hessian)
    bent = (moment[:, 0] + gain) * segments.flexibility.bend[:, 0]
    hessian = _hessian(transfer, bent)
    if short.any():
        hessian[short] = _hessian_with_moment(transfer[short], bent[short])
    return _Pieces(counts, short, hessian)


def _divided(rods: Rods, state: State, balance: RodBalance, count: Array) -> tuple[Any, Array, Array, Array]:
    """Equal pieces of the segments, with their angles and moments at the ends."""
    entry, own = balance.entry, np.repeat(np.arange(len(count)), count)
    shape, nodes = plain_shape(rods, state, entry), collocation(entry.segments.angle.shape[1]).c
    inside, ends = [], []
    for s, parts in enumerate(count.tolist()):
        sigma = (np.arange(parts)[:, None] + nodes) / parts
        inside.append(shape.within(s, sigma.ravel()).angle.reshape(sigma.shape))
        at = shape.within(s, np.arange(parts + 1) / parts)
        ends.append(np.stack([at.angle[:-1], at.moment[:-1], at.angle[1:]], axis=1))
    flexibility = rod.Flexibility(*(value[own] for value in entry.segments.flexibility))
    length = entry.segments.length[own] / count[own, None]
    segments: Any = rod.Segments(flexibility, entry.segments.force[:, own], length, np.concatenate(inside))
    if isinstance(rods, VaryingRods):
        part = np.arange(len(own)) - (np.cumsum(count) - count)[own]
        begin = entry.segments.begin[own] + part[:, None] * length
        segments = segments._replace(force=entry.segments.constant[:, own])
        segments = rods.placed(entry.segments.owner[own], begin, segments, state.load_parameter)
    start, moment, end = np.concatenate(ends).T[:, :, None]
    return segments, start, moment, end


def _hessian(transfer: Array, bent: Array) -> Array:
    """Hessians of G (s, 6, 6) over the inputs of segments: the moment at the start is that with which the angle arrives.

    The second derivative in the length follows from ``dG/dh = - m^2/2EI - N - N^2/2EA - Q^2/2GA`` at the end.
    """
    with np.errstate(all="ignore"):
        moment = transfer[:, 0, :6] / -transfer[:, 0, 1, None]
        arriving = transfer[:, 1:, :6] + transfer[:, 1:, 1, None] * moment[:, None, :]
    hessian = np.empty((len(transfer), 6, 6))
    hessian[:, 0], hessian[:, 2] = -moment, arriving[:, 0]
    np.negative(arriving[:, 1:], out=hessian[:, 3:5])
    hessian[:, 1] = hessian[:, :, 1] = 0.0
    hessian[:, 5, :5] = hessian[:, :5, 5]
    hessian[:, 5, 5] = -bent * hessian[:, 2, 5]
    return hessian


def _hessian_with_moment(transfer: Array, bent: Array) -> Array:
    """Hessians of ``G*(m, phi_j, n, h) - m phi_i``, whose extremum in m is G, with the moment as an input; regular at ``h = 0``."""
    angle = transfer[:, 0, :6] / -transfer[:, 0, 0, None]
    angle[:, 0] = 0.0
    arriving = transfer[:, 1:, :6] + transfer[:, 1:, 0, None] * angle[:, None, :]
    hessian = np.zeros((len(transfer), 6, 6))
    hessian[:, 1], hessian[:, 2], hessian[:, 3:5] = angle, arriving[:, 0], -arriving[:, 1:]
    hessian[:, :, 0] = 0.0
    hessian[:, 0, 1] = hessian[:, 1, 0] = -1.0
    hessian[:, 5, :5] = hessian[:, :5, 5]
    hessian[:, 5, 5] = -bent * hessian[:, 2, 5]
    return hessian


def _bordered(
    rods: Rods, state: State, balance: RodBalance, pieces: _Pieces, element: int, pairs: tuple[int, ...]
) -> Bordered:
    """Matrix of an element of several pieces; its stations are the contacts and where a segment is divided."""
    place, model = balance.entry.place, rods.model
    first, last = int(place.first[element]), int(place.last[element])
    counts = tuple(pieces.counts[first : last + 1].tolist())
    begin = int(pieces.counts[:first].sum())
    own = slice(begin, begin + sum(counts))
    short = tuple(pieces.short[own].tolist())
    fixed, inputs, directions = _stations(counts, short, pieces.hessian.shape[1])
    matrix = fixed + (inputs.transpose(0, 2, 1) @ (pieces.hessian[own] @ inputs)).sum(axis=0)
    for n, k in enumerate(pairs):
        pair, touch = model.pairs[k], touch_of(state, k)
        if pair.reach:
            arc = rods.slopes(state, k, balance)[0] if isinstance(rods, VaryingRods) else None
            face = pair.reach_at(pair.arc_position(touch)), pair.steep
            matrix += _surface(touch.force, balance.tangents[k], face, directions[n], arc)
    slots = [slot for k in pairs for slot in range(model.pairs[k].slot, model.pairs[k].slot + CUT)]
    slots += [-1] * (len(matrix) - OWN - len(slots))
    return Bordered(element, _without_force(matrix), slots, sum(short))


@lru_cache(maxsize=64)
def _stations(counts: tuple[int, ...], short: tuple[bool, ...], width: int) -> tuple[Array, Array, Array]:
    """Constant matrices of an element whose segments have `counts` pieces, which may be short.

    Returns ``fixed`` (n, n), second derivatives of ``n . (r_j - r_i) - sum F . (r_j - x_c)``;
    ``inputs`` (pieces, width, n), inputs of the pieces by the element's unknowns; only short pieces have a
    moment. The seventh is the arc position of the start; ``directions`` (contacts, 6, n), angle, force
    before, contact force and arc position of every contact by the same.
    """
    contacts, pieces = len(counts) - 1, sum(counts)
    own_angle = OWN + CUT * contacts
    own_moment = own_angle + pieces - len(counts)
    rows = np.eye(own_moment + sum(short))
    fixed, inputs = np.zeros_like(rows), np.zeros((pieces, width, len(rows)))
    fixed[:OWN, :OWN] = _PULL
    directions = np.zeros((contacts, 6, len(rows)))
    force, angle, arc, piece = rows[3:5].copy(), rows[2], np.zeros(len(rows)), 0
    for segment, count in enumerate(counts):
        own, ahead = OWN + CUT * segment, segment < contacts
        ends = rows[own + 2] if ahead else np.zeros(len(rows))
        for part in range(count):
            arriving = rows[own_angle] if part < count - 1 else rows[own + 3] if ahead else rows[8]
            own_angle += part < count - 1
            inputs[piece, [0, 2, 3, 4, 5]] = [angle, arriving, *force, (ends - arc) / count]
            inputs[piece, 6:] = arc + (ends - arc) * (part / count)
            if short[piece]:
                inputs[piece, 1] = rows[own_moment]
                own_moment += 1
            angle, piece = arriving, piece + 1
        arc = ends
        if ahead:
            fixed[[own, own + 1, 6, 7], [6, 7, own, own + 1]] -= 1
            directions[segment] = [rows[own + 3], *force, *rows[own : own + 3]]
            force -= rows[own : own + 2]
    return fixed, inputs, directions


def _surface(
    force: tuple[float, float],
    tangents: tuple[rod.Tangent, rod.Tangent],
    face: tuple[float, float],
    selectors: Array,
    by_arc: Array | None,
) -> Array:
    """Second derivatives of ``- reach F . nu``, where F is parallel to nu, the normal to the right of the sum of the tangent vectors.

    With beta the angle of the sum and tau its direction, ``d nu = tau d beta`` and ``d^2 nu = tau d^2 beta - nu d beta^2``. Where the
    offset changes along the beam, nu is the normal of the face and leans from the normal of the axis.
    """
    reach, steep = face
    if steep:
        explicit = None if by_arc is None else Explicit(np.outer(by_arc, selectors[5]), selectors[5])
        leant, F = leaning(tangents, steep), np.array(force)
        turn = turned(leant, by_selectors(tangents, selectors[:5], explicit))
        both = reach * np.outer(leant.along @ selectors[3:5], turn)
        both += steep * np.outer(leant.normal @ selectors[3:5], selectors[5])
        envelope: Array = reach * (leant.normal @ F) * np.outer(turn, turn) - both - both.T
        return envelope
    before, after = tangents
    tx, ty = before.vector[0] + after.vector[0], before.vector[1] + after.vector[1]
    (xx, xy, yy), (ax, ay, aa) = before.compliance, after.compliance
    turned_x = [before.turned[0] + after.turned[0], xx + ax, xy + ay, -ax, -ay]
    turned_y = [before.turned[1] + after.turned[1], xy + ay, yy + aa, -ay, -aa]
    size = math.hypot(tx, ty)
    turn = (tx * np.array(turned_y) - ty * np.array(turned_x)) / size**2 @ selectors[:5]
    if by_arc is not None:
        turn = turn + (tx * by_arc[1] - ty * by_arc[0]) / size**2 * selectors[5]
    along = np.array([tx, ty]) / size @ selectors[3:5]
    across = (force[0] * ty - force[1] * tx) / size
    both = np.outer(along, turn)
    surface: Array = -reach * (both + both.T - across * np.outer(turn, turn))
    return surface

"""Constants of many structures of one topology: what `Model` and `Newton` hold of each, the structure as last axis."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tsm.elements import ELEMENTS, ClosedForm
from tsm.elements.beam import Coefficients
from tsm.elements.properties import Array, Properties
from tsm.model import Model
from tsm.newton import ROUND_OFF as NOISE
from tsm.newton import SHARP
from tsm.structure import Structure


class Paths(NamedTuple):
    """Paths of the control nodes of p pairs, all with the corners of the longest; those of beam ends stay empty.

    Attributes
    ----------
    corner : ndarray, shape (p, corners, 2, N)
        Corners.
    leg : ndarray, shape (p, corners - 1, N)
        Lengths of the legs.
    last : ndarray of bool, shape (p, corners - 1, N)
        Whether a leg is the path's last.
    """

    corner: Array
    leg: Array
    last: Array

    def position(self, k: int, t: Array, which: Array) -> Array:
        """Positions of pair k's control node in some structures at their load parameters, shape (2, m)."""
        left = t * self.leg[k][:, which].sum(axis=0)
        found = np.zeros((2, len(t)))
        todo = np.ones(len(t), dtype=bool)
        for c in range(self.leg.shape[1]):
            leg, last = self.leg[k, c, which], self.last[k, c, which]
            a, b = self.corner[k, c][:, which], self.corner[k, c + 1][:, which]
            here = todo & ((left <= leg) | last)
            found = np.where(here, a + left / leg * (b - a), found)
            todo &= ~here
            left = left - leg
        return found


class Numbers(NamedTuple):
    """Constants of N structures with n nodes, e elements, p pairs, and u unknowns (equations, then contact unknowns).

    Attributes
    ----------
    coordinates : ndarray, shape (n, 2, N)
        Undeformed node positions.
    properties, coefficients
        Constants of the elements, arrays of shape (..., e, N).
    arc : ndarray, shape (e, N)
        Arc position of the elements' starts.
    span : ndarray, shape (p, N)
        Length of the pair's beam.
    side, offset : ndarray, shape (p, N)
        Sign of the contact's side, and distance of its surface from the axis.
    paths : Paths
        Of the pins.
    length, force : ndarray, shape (N,)
        Longest beam and largest ``EI/L^2``: the units of the norm.
    noise : ndarray, shape (N,)
        Round-off of the residual.
    """

    coordinates: Array
    properties: Properties
    coefficients: Coefficients
    arc: Array
    span: Array
    side: Array
    offset: Array
    paths: Paths
    length: Array
    force: Array
    noise: Array


def collect_numbers(structures: Sequence[Structure], model: Model) -> Numbers:
    """Constants of structures that are numbered as a model."""
    table = np.array(
        [
            [(*b.start, *b.end, b.length, b.section.EA, b.section.GA, b.section.EI) for b in s.beams]
            for s in structures
        ]
    ).transpose(1, 2, 0)
    coordinates = np.empty((len(model.coordinates), 2, len(structures)))
    arcs, lengths = [], []
    for n, (place, beam) in enumerate(zip(model.beams.values(), table, strict=True)):
        parts = np.array([s.beams[n].parts for s in structures]).T
        coordinates[place.nodes] = (1 - parts[:, None]) * beam[:2] + parts[:, None] * beam[2:4]
        arc = parts * beam[4]
        # equal elements to the last digit, as in `Model`
        equal = [not s.beams[n].nodes for s in structures]
        lengths.append(np.where(equal, beam[4] / (len(parts) - 1), np.diff(arc, axis=0)))
        arcs.append(arc[:-1])
    l0 = np.concatenate(lengths)
    properties = _properties(model, coordinates, l0, table)
    length = table[:, 4].max(axis=0)
    force = (table[:, 7] / table[:, 4] ** 2).max(axis=0)
    EA, EI = properties.EA, properties.EI
    noise = NOISE * (EA * length / l0 + EI / l0**2).max(axis=0) / force
    blur = NOISE * np.abs(coordinates).max(axis=(0, 1)) / (SHARP * length)
    beams = [list(model.beams).index(pair.pair.beam) for pair in model.pairs]
    sides = [[1.0 if pair.side == "right" else -1.0 for pair in s.contacts] for s in structures]
    offsets = [[pair.offset for pair in s.contacts] for s in structures]
    return Numbers(
        coordinates=coordinates,
        properties=properties,
        coefficients=_coefficients(model, properties),
        arc=np.concatenate(arcs),
        span=table[beams, 4],
        side=np.array(sides).T.copy(),
        offset=np.array(offsets, dtype=float).T.copy(),
        paths=_paths(structures, model),
        length=length,
        force=force,
        noise=np.maximum(noise, blur),
    )


def _properties(model: Model, coordinates: Array, l0: Array, table: Array) -> Properties:
    """Constants of the elements from l0 and the table of the beams, of shape (beams, 8, N)."""
    counts = [place.beam.elements for place in model.beams.values()]
    EA, GA, EI = (np.repeat(table[:, column], counts, axis=0) for column in (5, 6, 7))
    kinds = [ELEMENTS[place.beam.element] for place in model.beams.values()]
    sheared = np.repeat([kind.sheared for kind in kinds], counts)
    d = coordinates[model.element_nodes[:, 1]] - coordinates[model.element_nodes[:, 0]]
    Phi = np.where(sheared[:, None], 12 * EI / (GA * l0**2), 0.0)
    return Properties(dx0=d[:, 0].copy(), dy0=d[:, 1].copy(), l0=l0, EA=EA, EI=EI, Phi=Phi)


def _coefficients(model: Model, properties: Properties) -> Coefficients:
    parts = []
    for place in model.beams.values():
        kind = ELEMENTS[place.beam.element]
        assert isinstance(kind, ClosedForm), "the elements are in closed form"
        own = slice(place.first, place.last + 1)
        parts.append(kind.coefficients(Properties(*(column[own] for column in properties))))
    return Coefficients(*(np.concatenate(part, axis=-2) for part in zip(*parts, strict=True)))


def _paths(structures: Sequence[Structure], model: Model) -> Paths:
    names = [pair.pin.name if pair.pin else None for pair in model.pairs]
    place = {pin.name: n for n, pin in enumerate(model.structure.pins)}
    longest = max((len(pin.path) for s in structures for pin in s.pins), default=2)
    corner = np.zeros((len(names), longest, 2, len(structures)))
    last = np.zeros((len(names), longest - 1, len(structures)), dtype=bool)
    for k, name in enumerate(names):
        if name is None:
            continue
        for n, structure in enumerate(structures):
            path = structure.pins[place[name]].path
            corner[k, :, :, n] = (*path, *([path[-1]] * (longest - len(path))))
            last[k, len(path) - 2, n] = True
    return Paths(corner, np.hypot(*np.diff(corner, axis=1).transpose(2, 0, 1, 3)), last)


def some(tree: Any, which: Array) -> Any:
    """Take some structures of a record of arrays."""
    if isinstance(tree, np.ndarray):
        return np.ascontiguousarray(tree[..., which])
    return type(tree)(*(some(part, which) for part in tree))

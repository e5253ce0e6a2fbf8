"""Constants of `Model` and `Newton` for many structures of one topology, the structure as last axis."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tsm.elements.beam import Coefficients
from tsm.elements.properties import Array, Properties
from tsm.model import Model
from tsm.scaling import Scales, scales_of
from tsm.sizes import Sizes
from tsm.structure import Structure


class Paths(NamedTuple):
    """Paths of the control nodes of p pairs, all with as many corners as the longest; the path of a beam's end stays empty.

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
        position = np.zeros((2, len(t)))
        todo = np.ones(len(t), dtype=bool)
        for c in range(self.leg.shape[1]):
            leg, last = self.leg[k, c, which], self.last[k, c, which]
            a, b = self.corner[k, c][:, which], self.corner[k, c + 1][:, which]
            here = todo & ((left <= leg) | last)
            position = np.where(here, a + left / leg * (b - a), position)
            todo &= ~here
            left = left - leg
        return position


class BatchConstants(NamedTuple):
    """Constants of N structures with n nodes, e elements and p pairs.

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
        Paths of the pins.
    sizes : Sizes
        Lengths and forces of the structures, each of shape (N,).
    scales : Scales
        Scales of residuals and steps, of shape (unknowns, N), and round-off.
    """

    coordinates: Array
    properties: Properties
    coefficients: Coefficients
    arc: Array
    span: Array
    side: Array
    offset: Array
    paths: Paths
    sizes: Sizes
    scales: Scales


def constants_of(structures: Sequence[Structure], model: Model) -> BatchConstants:
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
    properties = model.properties_of(coordinates, l0, table[:, 5:].transpose(1, 0, 2))
    sizes = model.sizes_of(coordinates, table[:, 4], table[:, 7])
    beams = [list(model.beams).index(pair.pair.beam) for pair in model.pairs]
    sides = [[1.0 if pair.side == "right" else -1.0 for pair in s.contacts] for s in structures]
    offsets = [[pair.offset for pair in s.contacts] for s in structures]
    return BatchConstants(
        coordinates=coordinates,
        properties=properties,
        coefficients=model.coefficients_of(properties),
        arc=np.concatenate(arcs),
        span=table[beams, 4],
        side=np.array(sides).T.copy(),
        offset=np.array(offsets, dtype=float).T.copy(),
        paths=_paths(structures, model),
        sizes=sizes,
        scales=scales_of(model, coordinates, properties, sizes),
    )


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


def take(tree: Any, which: Array) -> Any:
    """Take some structures of a record of arrays."""
    if isinstance(tree, np.ndarray):
        return np.ascontiguousarray(tree[..., which])
    return type(tree)(*(take(part, which) for part in tree))

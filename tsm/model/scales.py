"""Characteristic sizes of a structure, and the units and scales of its unknowns and equations that follow from them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tsm.elements.properties import Array

IDLE = 1e-9
"""Largest force of a closed contact, over ``EI/L^2``, that counts as zero."""
ROUND_OFF = 4 * float(np.finfo(float).eps)
SHARP = 1e-3
"""Scale of positions over the length. Positions are solved to a thousandth of the relative residual of forces. A stiff contact needs
this accuracy, and it has no cost."""
TURN, WAY = 0.7, 0.3
"""Largest step: rotation [rad], and displacement in parts of the structure's extent."""


class Sizes(NamedTuple):
    """Sizes of a structure."""

    length: float  # length, extent: length of the longest beam, and of the largest structure of joined beams
    extent: float
    # force_scale, least_force: largest ``EI/L^2`` of a beam. `force_scale` has the length of the beam for
    # L, `least_force` the extent of its structure: the forces of a long frame of short beams may be that small
    force_scale: float
    least_force: float


def sizes_of(lengths: Array, extents: Array, EI: Array) -> Sizes:
    """Sizes from lengths, extents and bending stiffnesses of the beams, each of shape (beams,)."""
    largest = lengths.max(), extents.max(), (EI / lengths**2).max(), (EI / extents**2).max()
    return Sizes(*map(float, largest))


def joined_extents(element_nodes: Array, starts: Array, coordinates: Array, lengths: Array) -> Array:
    """Extents of the structures of joined beams, a bound on the displacements of their ends.

    The extent is the diagonal of the structure, or the length of its longest beam if that is larger.

    ``element_nodes`` (elements, 2): nodes of the elements. ``starts`` (beams,): first nodes of the beams.
    ``coordinates`` (nodes, 2): undeformed node positions. ``lengths`` (beams,): lengths of the beams.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    i, j = element_nodes.T
    near = coo_array((np.ones(len(i)), (i, j)), shape=(len(coordinates),) * 2)
    count, part = connected_components(near, directed=False)
    least, most = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(least, part, coordinates)
    np.maximum.at(most, part, coordinates)
    return np.maximum(lengths, np.hypot(*(most - least).T)[part[starts]])


def units_of(sizes: Sizes) -> tuple[Array, Array]:
    """Units of the unknowns and of the equations, by `Model.kind`: from the longest beam and the largest ``EI/L^2``."""
    L, F = sizes.length, sizes.force_scale
    unknowns = np.array([L, L, 1.0, F, F, F * L, F, F, L, 1.0])
    return unknowns, np.array([F, F, F * L, L, L, 1.0, L, L, F, 1.0])


def largest(values: Array, scale: Array) -> float:
    """Largest scaled value, the norm of a residual or the size of a step."""
    return float(np.abs(values * scale).max(initial=0.0))

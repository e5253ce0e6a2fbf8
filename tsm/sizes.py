"""Characteristic lengths and forces of a structure, from which all scales are made."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tsm.elements.properties import Array


class Sizes(NamedTuple):
    """Sizes of a structure, or of many in the last axis."""

    # length, extent: length of the longest beam, and of the largest structure of joined beams; shape (...)
    length: Array
    extent: Array
    # force_scale, least_force: largest ``EI/L^2`` of a beam. `force_scale` has the length of the beam for
    # L, `least_force` the extent of its structure: the forces of a long frame of short beams may be that
    # small; shape (...)
    force_scale: Array
    least_force: Array


def sizes_of(lengths: Array, extents: Array, EI: Array) -> Sizes:
    """Sizes from lengths, extents and bending stiffnesses of the beams, each of shape (beams, ...)."""
    forces, least_forces = EI / lengths**2, EI / extents**2
    return Sizes(lengths.max(axis=0), extents.max(axis=0), forces.max(axis=0), least_forces.max(axis=0))


def joined_extents(element_nodes: Array, starts: Array, coordinates: Array, lengths: Array) -> Array:
    """Extents of the structures of joined beams, a bound on the displacements of their ends.

    The extent is the diagonal of the structure, or the length of its longest beam if that is larger.

    ``element_nodes`` (elements, 2): nodes of the elements. ``starts`` (beams,): first nodes of the beams.
    ``coordinates`` (nodes, 2, ...): undeformed node positions. ``lengths`` (beams, ...): lengths of the
    beams.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    i, j = element_nodes.T
    near = coo_array((np.ones(len(i)), (i, j)), shape=(len(coordinates),) * 2)
    count, part = connected_components(near, directed=False)
    least = np.full((count, *coordinates.shape[1:]), np.inf)
    most = -least
    np.minimum.at(least, part, coordinates)
    np.maximum.at(most, part, coordinates)
    diagonals = np.hypot(*np.moveaxis(most - least, 1, 0))
    extents: Array = np.maximum(lengths, diagonals[part[starts]])
    return extents

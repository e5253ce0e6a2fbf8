"""Segments of exact elements: each is cut at its contacts."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from tsm.elements.properties import Array
from tsm.elements.rod import ARC, INPUTS, LOAD
from tsm.model.state import Cuts

OWN = 9
"""Unknowns of an element without contacts: node i (3), force and moment at its start (3), node j (3)."""
CUT = 4
"""Unknowns of a contact: force (2), arc position, angle. Its rows: position (2), direction, arrival of the angle."""
COLUMNS = np.array([2, 5, 8, 3, 4])
"""Unknowns of an element that are the first five inputs of its only segment."""
ROWS = np.array([5, 8, 3, 4])
"""Rows of an element that are the four outputs of its only segment."""
FIXED = np.zeros((OWN, OWN))
"""Constant entries of the tangent of an element."""
FIXED[[0, 1, 2, 3, 4], [3, 4, 5, 6, 7]] = -1
FIXED[[6, 7, 3, 4], [3, 4, 0, 1]] = 1


class Layout(NamedTuple):
    """Segments of the elements, one after another."""

    owner: Array  # element of every segment, counted over the exact elements; shape (s,)
    first: Array  # first, last: first and last segment of every element; shape (r,)
    last: Array
    cuts: tuple[tuple[int, int], ...]  # segment that ends at a contact, and the contact's pair; in order


@lru_cache(maxsize=256)
def layout(count: int, cuts: Cuts) -> Layout:
    """Segments of `count` elements with given cuts."""
    segments = np.ones(count, dtype=int)
    for element, pairs in cuts:
        segments[element] += len(pairs)
    last = np.cumsum(segments) - 1
    first = last - segments + 1
    flat = tuple((s, k) for element, pairs in cuts for s, k in enumerate(pairs, int(first[element])))
    return Layout(np.repeat(np.arange(count), segments), first, last, flat)


@lru_cache(maxsize=16)
def chain(count: int) -> tuple[Array, Array, Array]:
    """Constant matrices of an element with `count` cuts.

    The last two of n columns are the load parameter, and the constant 1 for the inner residual. Returns
    ``inputs`` (count + 1, 9, n), inputs of the segments by the element's unknowns, the moments at the cuts
    left open; ``tangent`` (unknowns, n), all but the rows of arrival and of the contacts; ``selectors``
    (count, 8, n), angle, force before (x, y), contact force (x, y), arc position, moment before, left open,
    and load parameter of every cut.
    """
    unknowns = OWN + CUT * count
    inputs = np.zeros((count + 1, INPUTS, unknowns + 2))
    inputs[:, 3, 3] = inputs[:, 4, 4] = inputs[:, 6, -1] = inputs[:, LOAD, -2] = 1
    inputs[0, 0, 2] = inputs[0, 1, 5] = inputs[-1, 2, 8] = 1
    selectors = np.zeros((count, 8, unknowns + 2))
    selectors[:, 7, -2] = 1
    for k in range(count):
        own = OWN + CUT * k
        selectors[k, [0, 3, 4, 5], [own + 3, own, own + 1, own + 2]] = 1
        selectors[k, 1:3] = inputs[k, 3:5]
        inputs[k + 1 :, 3, own] = inputs[k + 1 :, 4, own + 1] = -1
        inputs[k, 5, own + 2] = inputs[k, 2, own + 3] = inputs[k + 1, 0, own + 3] = 1
        inputs[k + 1, 5, own + 2], inputs[k + 1, ARC, own + 2] = -1, 1
    tangent = np.zeros((unknowns, unknowns + 2))
    tangent[:OWN, :OWN] = FIXED
    tangent[6:8] = inputs[-1, 3:5]
    tangent[3, 6] = tangent[4, 7] = 0
    return inputs, tangent, selectors

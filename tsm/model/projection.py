"""Places along a beam: arc positions, hand-over from element to element, projection on chords."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tsm.elements.properties import Array
from tsm.model.mesh import BeamModel

AT_NODE = 1e-9
"""Part of an element's length that a contact may lie past its end: at a node, round-off would send it back and forth for ever."""


class Projection(NamedTuple):
    """Closest point of a beam's deflected axis to a node."""

    element: int  # global number of the owner
    xi: float  # position on it
    gap: float  # distance from the contact surface to the node, positive on the stated side
    # how far the closest point lies beyond the beam's ends, along the axis [length]; 0 within
    overshoot: float


def arc_position(target: BeamModel, element: int, xi: float) -> float:
    """Distance along the undeformed axis from the beam's start."""
    k = element - target.first
    return (1.0 - xi) * target.arcs[k] + xi * target.arcs[k + 1]


def overshoot(target: BeamModel, arc: float) -> float:
    """How far an arc position lies outside the beam."""
    return max(arc - target.beam.length, -arc, 0.0)


def slide(lengths: Sequence[float], k: int, xi: float, past: float = 0.0) -> tuple[int, float]:
    """Hand a position that left element k of a beam by more than a part of its length over to the neighbour.

    ``lengths``: undeformed lengths of the beam's elements. ``past``: part of the length by which a position
    may lie past a node.
    """
    if not math.isfinite(xi):
        return k, xi
    while xi > 1.0 + past and k < len(lengths) - 1:
        xi, k = (xi - 1.0) * (lengths[k] / lengths[k + 1]), k + 1
    while xi < -past and k > 0:
        xi, k = 1.0 + xi * (lengths[k] / lengths[k - 1]), k - 1
    return k, xi


def nearest_chord(positions: Array, node: tuple[float, float]) -> tuple[int, float]:
    """Chord, between positions (nodes, 2), that is nearest to a node, and the position of its projection on it."""
    d = np.diff(positions, axis=0)
    r = np.array(node) - positions[:-1]
    xi = np.einsum("ij,ij->i", d, r) / np.einsum("ij,ij->i", d, d)
    apart = r - np.clip(xi, 0.0, 1.0)[:, None] * d
    owner = int(np.argmin(np.einsum("ij,ij->i", apart, apart)))
    return owner, float(xi[owner])

"""Second variation of segments with loads along them, natural curvature or taper; see `tsm.rods.variation`.

With ``H = m^2/2EI + k0 m + N + N^2/2EA + Q^2/2GA`` the functional of a segment from a to ``a + h`` has ``dG/dh = - H(a + h)`` and
``dG/da = H(a) - H(a + h)``. Along the arc H changes with what it has at both ends, and explicitly by
``(1/EI)' m^2/2 + (1/EA)' N^2/2 + (1/GA)' Q^2/2 - q . r'``.
"""

from __future__ import annotations

import numpy as np

from tsm.elements.properties import Array
from tsm.elements.varying import VaryingSegments
from tsm.rods.varying import VaryingRods

_COLUMNS = [0, 1, 2, 3, 4, 5, 7]
"""Inputs of the segments over which the Hessian is taken."""


def hessians(
    rods: VaryingRods, segments: VaryingSegments, ends: Array, transfer: Array, load_parameter: float
) -> tuple[Array, Array]:
    """Hessians of G (s, 7, 7) over angle, moment and angle at the ends, force, length and arc position of the start.

    ``segments``: segments in equilibrium. ``ends`` (2, 2, s): angles, then moments, at both ends.
    ``transfer`` (s, 4, 9): transfer of the segments. Returns two: with the moment with which the angle
    arrives, as `variation._hessian`; with the moment as an input, for short segments.
    """
    arcs = np.concatenate([segments.begin, segments.begin + segments.length], axis=1)
    course = rods.course(segments.owner, arcs, load_parameter)
    (nx, ny), angles, moments = segments.constant - course.resultant, ends[0].T, ends[1].T
    c, s = np.cos(angles), np.sin(angles)
    N, Q, (stretch, shear, bend) = nx * c + ny * s, ny * c - nx * s, course.flexibility
    f = -Q * (1 + (stretch - shear) * N)
    along, across = 1 + stretch * N, shear * Q
    qx, qy = course.load
    (e, u, b) = course.slope
    own = (b * moments**2 + e * N**2 + u * Q**2) / 2
    own -= qx * (along * c - across * s) + qy * (along * s + across * c)
    turn = bend * moments + segments.curvature
    by = transfer[:, :, _COLUMNS]
    with np.errstate(all="ignore"):
        moment = by[:, 0] / -by[:, 0, 1, None]
        arriving = by[:, 1:] + by[:, 1:, 1, None] * moment[:, None, :]
    long = np.empty((len(by), 7, 7))
    long[:, 0], long[:, 2], long[:, 3:5] = -moment, arriving[:, 0], -arriving[:, 1:]
    long[:, 1] = long[:, :, 1] = 0.0
    _with_arcs(long, turn[:, 1], own, turn[:, 0] * moment[:, 6])
    with np.errstate(all="ignore"):
        angle = by[:, 0] / -by[:, 0, 0, None]
        angle[:, 0] = 0.0
        arriving = by[:, 1:] + by[:, 1:, 0, None] * angle[:, None, :]
    short = np.zeros_like(long)
    short[:, 1], short[:, 2], short[:, 3:5] = angle, arriving[:, 0], -arriving[:, 1:]
    short[:, :, 0] = 0.0
    short[:, 0, 1] = short[:, 1, 0] = -1.0
    _with_arcs(short, turn[:, 1], own, -f[:, 0] * angle[:, 6])
    return long, short


def _with_arcs(hessian: Array, turn: Array, own: Array, begin: Array) -> None:
    """Enter the rows of length and arc position; `begin` is the change of H at the start with the arc position, without the explicit part."""
    hessian[:, 5:7, :5] = hessian[:, :5, 5:7].transpose(0, 2, 1)
    hessian[:, 5, 5] = -turn * hessian[:, 2, 5] - own[:, 1]
    hessian[:, 5, 6] = hessian[:, 6, 5] = -turn * hessian[:, 2, 6] - own[:, 1]
    hessian[:, 6, 6] = begin + own[:, 0] + hessian[:, 5, 6]

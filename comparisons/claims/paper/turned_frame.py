"""The cantilever contact element in a frame that turns with its clamped section, whatever the rotation."""
# `tsm` evaluates [P] (7) from the deformations of the chord, to first order in the rotations; in exact
# arithmetic that is the simply supported element. Here the frame lies along the section at end i, with the
# directions t and n; with r from end i to the node and d to end j, [Y_j, Y_c, M_j] = K(a) [n.d, n.r, theta_j
# - theta_i] at a = t.r, with the corrected matrix of (7).

from typing import Any

import numpy as np

from tsm.elements import cantilever
from tsm.elements.chord_contact import INSIDE
from tsm.elements.properties import Array, Properties

NAME = "euler-bernoulli-cantilever, turned frame"


def frame(p: Properties, x: Array) -> tuple[Array, Array]:
    """Return the directions along and across the section at end i, each of shape (2,)."""
    c, s = np.cos(x[2]), np.sin(x[2])
    t = np.array([c * p.dx0 - s * p.dy0, s * p.dx0 + c * p.dy0]) / p.l0
    return t, np.array([-t[1], t[0]])


def contact(p: Properties, x: Array, lever: Any) -> tuple[Array, Array]:
    """Forces on element and touching node (8), with ``lever = x_i - x_c``, and K (3, 3)."""
    t, n = frame(p, x)
    d, r = np.array([p.dx0, p.dy0]) + (x[3:5] - x[:2]), -np.asarray(lever)
    xi = min(max(t @ r / p.l0, INSIDE), 1 - INSIDE)
    K, _ = cantilever.euler_bernoulli(p, xi)
    Yj, Yc, Mj = K @ np.array([n @ d, n @ r, x[5] - x[2]])
    length = np.sqrt(d @ d)
    du = d - np.array([p.dx0, p.dy0])
    elongation = (2 * (p.dx0 * du[0] + p.dy0 * du[1]) + du @ du) / (length + p.l0)
    N = p.EA / p.l0 * elongation * d / length
    force = np.zeros(8, dtype=K.dtype)
    force[:2] = -N - (Yj + Yc) * n
    force[2] = -Yj * (t @ d) - Yc * (t @ r) - Mj
    force[3:5] = N + Yj * n
    force[5] = Mj
    force[6:] = Yc * n
    return force, K

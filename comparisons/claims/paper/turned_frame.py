"""The cantilever contact element in a frame that turns with its clamped section, whatever the rotation.

`tsm` evaluates [P] (7) from the deformations of the chord, to first order in the rotations; in exact arithmetic that is the simply
supported element. Here nothing is taken from the chord. The frame lies along the section at end i, at the angle ``alpha + theta_i``,
with the directions t and n. With r from end i to the contacting node and d to end j the deformations are ::

    y_j = n . d,    y_c = n . r,    theta = theta_j - theta_i,    a = t . r

and ``[Y_j, Y_c, M_j] = K(a) [y_j, y_c, theta]`` with the corrected matrix of (7). The elongation is the elongation of the chord. Nodal forces are
``U = J S`` with J the transposed derivative of the deformations at constant a.
"""

from typing import Any

import numpy as np

from tsm.elements.kinds.paper import INSIDE, cantilever
from tsm.elements.properties import Array, Properties

NAME = "euler-bernoulli-cantilever, turned frame"


def frame(p: Properties, x: Array) -> tuple[Array, Array]:
    """Return the directions along and across the section at end i, each of shape (2,)."""
    c, s = np.cos(x[2]), np.sin(x[2])
    t = np.array([c * p.dx0 - s * p.dy0, s * p.dx0 + c * p.dy0]) / p.l0
    return t, np.array([-t[1], t[0]])


def contact(p: Properties, x: Array, lever: Any) -> tuple[Array, Array]:
    """Forces on the element (6) and on the node that touches it (2), the gradient of the energy at constant a, and K, shape (3, 3).

    `x` are the element's displacements, shape (6,); `lever` is ``x_i - x_c``, from the contacting node to end i.
    """
    t, n = frame(p, x)
    d, r = np.array([p.dx0, p.dy0]) + (x[3:5] - x[:2]), -np.asarray(lever)
    xi = min(max(t @ r / p.l0, INSIDE), 1 - INSIDE)
    K = cantilever(p, xi)
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

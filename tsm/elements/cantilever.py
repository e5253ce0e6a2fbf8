"""The cantilever basic system of the paper's second contact element.

The element is clamped at end i. Its frame has x along the tangent at end i and y across it. The element edge forces
``[Y_j, Y_c, M_j]`` belong to the deflections y_j of end j and y_c of the contact point and to the rotation of end j, all measured
from the tangent at end i ([P] (7), Fig. 4). [P] prints no J. To first order in the rotations, this frame is the frame of the chord
turned by theta_i, so that ::

    [y_j, y_c, theta_j]_cantilever = T [theta_i, theta_j, y_c]_chord,    T = [[-l0, 0, 0], [-a, 0, 1], [-1, 1, 0]]

and ``S = T^T K T v``. In exact arithmetic this is the element of [P] (5); only the round-off differs. Transformation and stiffness are
therefore applied one after the other, as the basic system states them, and not multiplied out.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tsm.elements.chord_contact import ElementForce, Stiffness
from tsm.elements.properties import Array, Properties


def clamped(stiffness: Stiffness) -> ElementForce:
    """Element force equation of a matrix over ``[y_j, y_c, theta_j]``."""

    def element_force(p: Properties, xi: Any, deformation: Array) -> tuple[Array, Array, Array]:
        K, dK = stiffness(p, xi)
        T = transformation(p, xi)
        cantilever = T @ deformation
        S = K @ cantilever
        # T depends on a in the one entry -a
        slope = (dK @ cantilever - K[:, 1] * deformation[0]) @ T
        slope[0] -= S[1]
        return S @ T, T.T @ K @ T, slope

    return element_force


def transformation(p: Properties, xi: Any) -> Array:
    """Matrix that takes the deformations of the beam simply supported on the chord to the deformations of the cantilever."""
    return np.array([[-p.l0, 0, 0], [-xi * p.l0, 0, 1], [-1, 1, 0]])


def euler_bernoulli(p: Properties, xi: Any) -> tuple[Array, Array]:
    """Matrix of [P] (7)-(8), corrected, over ``[y_j, y_c, theta_j]`` and its derivative in a.

    The brackets of [P] (7) times ``k_b = 3 EI/(l a^3 b^3)``, with ``-a^2 l (a + 3b)`` for Y_j-y_c and
    ``+a^2 b l^2`` for Y_c-theta_j. The shear number of the element is not read.
    """
    l0, k = p.l0, 3 * p.EI
    a, b = xi * l0, (1 - xi) * l0
    jc = -(a + 3 * b) / (a * b**3)
    jt = -(a + 2 * b) / (l0 * b * b)
    ct = l0 / (a * b * b)
    K = np.array(
        [
            [(a + 4 * b) / (l0 * b**3), jc, jt],
            [jc, l0**3 / (a * b) ** 3, ct],
            [jt, ct, (3 * a + 4 * b) / (3 * l0 * b)],
        ]
    )
    djc = -3 * (a * a + 2 * a * b - b * b) / (a * a * b**4)
    djt = -(2 * a + 3 * b) / (l0 * b**3)
    dct = l0 * (2 * a - b) / (a * a * b**3)
    dK = np.array(
        [
            [3 * (a + 3 * b) / (l0 * b**4), djc, djt],
            [djc, 3 * l0**3 * (a - b) / (a * b) ** 4, dct],
            [djt, dct, 1 / (b * b)],
        ]
    )
    return k * K, k * dK

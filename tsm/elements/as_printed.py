"""The paper's matrices with their misprints, to see what they do. They are wrong: see tsm/elements/errata.md.

Each is the corrected matrix except for the misprinted entries, which mix dimensions: what these elements
do depends on the unit of length. Lengths on the chord are measured as in the corrected elements, as parts of l0, so
that the misprints are the only difference.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tsm.elements import cantilever, chord_contact
from tsm.elements.properties import Array, Properties


def euler_bernoulli(p: Properties, xi: Any) -> tuple[Array, Array]:
    """Matrix of [P] (5)-(6) and its derivative: ``(9 l0^2 - a^2 b^2)/(a^2 b^2) k_a`` for M_i-theta_j."""
    K, dK = chord_contact.euler_bernoulli(p, xi)
    l0, a, b = p.l0, xi * p.l0, (1 - xi) * p.l0
    K[0, 1] = K[1, 0] = (9 * l0 * l0 / (a * b) ** 2 - 1) * p.EI / l0
    dK[0, 1] = dK[1, 0] = 18 * l0 * (a - b) / (a * b) ** 3 * p.EI
    return K, dK


def euler_bernoulli_cantilever(p: Properties, xi: Any) -> tuple[Array, Array]:
    """Matrix of [P] (7)-(8) and its derivative: ``k_b = 3 EI/(a^3 b^3)``, ``-a^2 b`` for Y_c-theta_j.

    Without the ``1/l`` that k_b lacks, Y_j-y_c is right as printed, Y_c-theta_j has the wrong sign and lacks a length, and
    the others have a length too much.
    """
    K, dK = cantilever.euler_bernoulli(p, xi)
    misprint = np.array([[p.l0, 1, p.l0], [1, p.l0, -1 / p.l0], [p.l0, -1 / p.l0, p.l0]])
    return misprint * K, misprint * dK


def timoshenko(p: Properties, xi: Any) -> tuple[Array, Array]:
    """Matrix of [P] (9)-(12) and its derivative: ``(9 (l0^2 - b Psi) - Omega) k_c`` for M_i-theta_j."""
    K, dK = chord_contact.timoshenko(p, xi)
    l0, a, b = p.l0, xi * p.l0, (1 - xi) * p.l0
    Psi = p.Phi * l0 * l0 / 12
    omega = (a * b) ** 2 + 3 * Psi * (l0 * l0 + a * b) + 36 * Psi * Psi
    domega = (2 * a * b + 3 * Psi) * (b - a)
    printed, k = 9 * (l0 * l0 - b * Psi), p.EI / (l0 * omega)
    K[0, 1] = K[1, 0] = (printed - omega) * k
    dK[0, 1] = dK[1, 0] = (9 * Psi - printed * domega / omega) * k
    return K, dK

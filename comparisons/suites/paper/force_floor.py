"""The least unbalanced force of a contact element beside a node, by round-off, over l_i/l."""
# An element and its node are put into a state with a given contact force in extended precision, which is then
# rounded to double precision; what the forces differ by, no iteration in double precision goes below but by
# chance. To expect is a contact stiffness times the last bit of a coordinate: 3 EI/b^3 (Euler-Bernoulli) or
# GA/b (Timoshenko, b below sqrt(psi)); with the force as an unknown nothing is multiplied. The reference has
# the same amplification with a last bit 2000 times smaller (x86).

from typing import Any

import numpy as np

from tsm.elements import CLOSED_FORM, ClosedForm, beam
from tsm.elements.kinds.paper import INSIDE, cantilever
from tsm.elements.properties import Array, Properties

TURNED = "euler-bernoulli-cantilever, turned frame"
"""The cantilever contact element in a frame that turns with its clamped section, whatever the rotation."""
# `tsm` evaluates [P] (7) from the deformations of the chord, to first order in the rotations; in exact
# arithmetic that is the simply supported element. Here the frame lies along the section at end i, with the
# directions t and n; with r from end i to the node and d to end j, [Y_j, Y_c, M_j] = K(a) [n.d, n.r, theta_j
# - theta_i] at a = t.r, with the corrected matrix of (7).


def _frame(p: Properties, x: Array) -> tuple[Array, Array]:
    """Return the directions along and across the section at end i, each of shape (2,)."""
    c, s = np.cos(x[2]), np.sin(x[2])
    t = np.array([c * p.dx0 - s * p.dy0, s * p.dx0 + c * p.dy0]) / p.l0
    return t, np.array([-t[1], t[0]])


def _turned(p: Properties, x: Array, lever: Any) -> tuple[Array, Array]:
    """Forces on element and touching node (8), with ``lever = x_i - x_c``, and K (3, 3)."""
    t, n = _frame(p, x)
    d, r = np.array([p.dx0, p.dy0]) + (x[3:5] - x[:2]), -np.asarray(lever)
    xi = min(max(t @ r / p.l0, INSIDE), 1 - INSIDE)
    K = cantilever(p, xi)
    Yj, Yc, Mj = K @ np.array([n @ d, n @ r, x[5] - x[2]])
    length = np.sqrt(d @ d)
    du = d - np.array([p.dx0, p.dy0])
    elongation = (2 * (p.dx0 * du[0] + p.dy0 * du[1]) + du @ du) / (length + p.l0)
    N = p.EA / p.l0 * elongation * d / length
    turning = -Yj * (t @ d) - Yc * (t @ r) - Mj
    return np.concatenate([-N - (Yj + Yc) * n, [turning], N + Yj * n, [Mj], Yc * n]), K


_Extended = np.longdouble
_ELEMENTS = 10  # of the beam, over whose length the element lies anywhere


def force_floor(*, element: str, end: str, psi: float, ratio: float, samples: int) -> float:
    """Return the unbalanced force [EI/L^2] that round-off leaves before the start or end of an element, the median over random states."""
    kind = None if element == TURNED else CLOSED_FORM[element]
    if np.finfo(_Extended).eps > 1e-3 * np.finfo(float).eps:
        raise ValueError("numpy.longdouble: this platform's is no wider than double precision")
    rng = np.random.default_rng(0)
    xi = _Extended(ratio) if end == "start" else 1 - _Extended(ratio)
    return float(np.median([_sample(kind, xi, psi, rng) for _ in range(samples)]))


def _sample(kind: ClosedForm | None, xi: Any, psi: float, rng: np.random.Generator) -> float:
    """Floor at one random state of an element with ``l0 = EI = 1``, ``EA = 3 GA`` as of a solid section."""
    angle = rng.uniform(0, 2 * np.pi)
    p = Properties(np.cos(angle), np.sin(angle), 1.0, 3 / psi, 1.0, 12 * psi)
    p = p if kind is None else kind.constants(p)
    start, contact_force = _ELEMENTS * rng.uniform(-1, 1, 2), 1 / _ELEMENTS**2
    # rigid motion, end rotations about 0.05 from the chord and a strain about 1e-3
    turn, stretch = rng.uniform(-2, 2), 1 + 1e-3 * rng.normal()
    c, s = stretch * np.cos(turn), stretch * np.sin(turn)
    shift = rng.normal(size=2)
    moved = shift + np.array([c * p.dx0 - s * p.dy0 - p.dx0, s * p.dx0 + c * p.dy0 - p.dy0])
    theta_i, theta_j = turn + 0.05 * rng.normal(size=2)
    x = np.array([*shift, theta_i, *moved, theta_j]).astype(_Extended)
    carried = kind is not None and kind.contact_unknowns > 0

    def contact(x: Array, node: Array, xi: Any, force: Array) -> tuple[Array, Array]:
        """Gradient of the contact's energy, and its tangent; of the turned frame the stiffnesses of its deformations."""
        lever = start + x[:2] - node
        if kind is None:
            return _turned(p, x, lever)
        return kind.contact.response(p, x, lever, xi, force, 1.0, 0.0)

    def forces(*state: Any) -> Array:
        """Forces on element and node, and the contact's equation of direction where it has one."""
        gradient, _ = contact(*state)
        if kind is None or not carried:
            return gradient
        column = Properties(*(np.array([value]) for value in p))
        own, _ = beam.response(kind.coefficients(column), state[0][:, None])
        return np.concatenate([gradient[:6] + own[:, 0], gradient[6:8], gradient[10:]])

    # the contact force is an unknown, or it follows from the deflection: the node moves across the chord, or the section at end i
    d = _frame(p, x)[0] if kind is None else np.array([p.dx0, p.dy0]) + (x[3:5] - x[:2])
    n = np.array([-d[1], d[0]]) / np.sqrt(d @ d)
    node, force = start + x[:2] + xi * d, contact_force * n
    for _ in range(0 if carried else 3):
        found, tangent = contact(x, node, xi, force)
        stiffness = tangent[1, 1] if kind is None else n @ tangent[6:8, 6:8] @ n
        node = node + n * (contact_force - found[6:8] @ n) / stiffness
    state = x, node, xi, force
    rounded = (np.asarray(part).astype(float) for part in state)
    error = np.abs(forces(*rounded) - forces(*state)) / contact_force
    error[[2, 5]] /= _ELEMENTS
    return float(error.max())

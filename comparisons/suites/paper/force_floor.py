"""The least unbalanced force of a contact element beside a node, by round-off, over l_i/l."""
# An element and its node are put into a state with a given contact force in extended precision, which is then
# rounded to double precision; what the forces differ by, no iteration in double precision goes below but by
# chance. To expect is a contact stiffness times the last bit of a coordinate: 3 EI/b^3 (Euler-Bernoulli) or
# GA/b (Timoshenko, b below sqrt(Psi)); with the force as an unknown nothing is multiplied. The reference has
# the same amplification with a last bit 2000 times smaller (x86).

from __future__ import annotations

from typing import Any, Literal, NamedTuple

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
    force = np.zeros(8, dtype=K.dtype)
    force[:2] = -N - (Yj + Yc) * n
    force[2] = -Yj * (t @ d) - Yc * (t @ r) - Mj
    force[3:5] = N + Yj * n
    force[5] = Mj
    force[6:] = Yc * n
    return force, K


_Extended = np.longdouble
_SIDE, _OFFSET = 1.0, 0.0


class _State(NamedTuple):
    """Element displacements (6), node position (2), arc fraction and force (2), all rounded together."""

    x: Array
    node: Array
    xi: Any
    force: Array


class _Element(NamedTuple):
    """An element beside its node; `kind` is None for the turned frame."""

    kind: ClosedForm | None
    p: Properties
    start: Array
    contact_force: float

    def contact(self, state: _State) -> tuple[Array, Array]:
        """Gradient of the contact's energy, and its tangent; of the turned frame the stiffnesses of its deformations."""
        lever = self.start + state.x[:2] - state.node
        if self.kind is None:
            return _turned(self.p, state.x, lever)
        return self.kind.contact.response(self.p, state.x, lever, state.xi, state.force, _SIDE, _OFFSET)

    def forces(self, state: _State) -> Array:
        """Forces on element and node, and the contact's equation of direction where it has one."""
        gradient, _ = self.contact(state)
        if self.kind is None or not self.kind.contact_unknowns:
            return gradient
        column = Properties(*(np.array([value]) for value in self.p))
        own, _ = beam.response(self.kind.coefficients(column), state.x[:, None])
        return np.concatenate([gradient[:6] + own[:, 0], gradient[6:8], gradient[10:]])


def force_floor(
    element: str,
    ratio: float,
    end: Literal["start", "end"] = "start",
    Psi: float = 9.0,
    *,
    elements: int = 10,
    samples: int = 50,
) -> float:
    """Return the unbalanced force [EI/L^2] that round-off leaves, the median over random states."""
    kind = CLOSED_FORM.get(element)
    if (kind is None and element != TURNED) or not 0 <= ratio <= 1:
        raise ValueError(
            f"element = {element!r}, ratio = {ratio!r}: no element with a closed form and part of its length"
        )
    if np.finfo(_Extended).eps > 1e-3 * np.finfo(float).eps:
        raise ValueError("numpy.longdouble: this platform's is no wider than double precision")
    rng = np.random.default_rng(0)
    xi = _Extended(ratio) if end == "start" else 1 - _Extended(ratio)
    return float(np.median([_sample(kind, xi, Psi, elements, rng) for _ in range(samples)]))


def _sample(kind: ClosedForm | None, xi: Any, Psi: float, elements: int, rng: np.random.Generator) -> float:
    """Floor at one random state of an element with ``l0 = EI = 1``, ``EA = 3 GA`` as of a solid section."""
    angle = rng.uniform(0, 2 * np.pi)
    p = Properties(np.cos(angle), np.sin(angle), 1.0, 3 / Psi, 1.0, 12 * Psi)
    p = p if kind is None else kind.constants(p)
    element = _Element(kind, p, elements * rng.uniform(-1, 1, 2), 1 / elements**2)
    # rigid motion, end rotations about 0.05 from the chord and a strain about 1e-3
    turn, stretch = rng.uniform(-2, 2), 1 + 1e-3 * rng.normal()
    c, s = stretch * np.cos(turn), stretch * np.sin(turn)
    shift = rng.normal(size=2)
    moved = shift + np.array([c * p.dx0 - s * p.dy0 - p.dx0, s * p.dx0 + c * p.dy0 - p.dy0])
    theta_i, theta_j = turn + 0.05 * rng.normal(size=2)
    x = np.array([*shift, theta_i, *moved, theta_j]).astype(_Extended)
    state = (_carried if kind is not None and kind.contact_unknowns else _deflected)(element, x, xi)
    rounded = _State(*(np.asarray(part).astype(float) for part in state))
    error = np.abs(element.forces(rounded) - element.forces(state)) / element.contact_force
    error[[2, 5]] /= elements
    return float(error.max())


def _deflected(element: _Element, x: Array, xi: Any) -> _State:
    """State whose contact force follows from the deflection: the node moves across the chord, or the section at end i, until it is as stated."""
    p, turned = element.p, element.kind is None
    d = _frame(p, x)[0] if turned else np.array([p.dx0, p.dy0]) + (x[3:5] - x[:2])
    n = np.array([-d[1], d[0]]) / (1.0 if turned else np.sqrt(d @ d))
    node = element.start + x[:2] + xi * d
    for _ in range(1 if turned else 3):
        force, tangent = element.contact(_State(x, node, xi, np.zeros(2)))
        stiffness = tangent[1, 1] if turned else n @ tangent[6:8, 6:8] @ n
        node = node + n * (element.contact_force - force[6:8] @ n) / stiffness
    return _State(x, node, xi, np.zeros(2))


def _carried(element: _Element, x: Array, xi: Any) -> _State:
    """State whose contact force is an unknown: the force in the direction it must have, the node where it must be."""
    unloaded = _State(x, element.start + x[:2], xi, np.zeros(2, dtype=_Extended))
    _, tangent = element.contact(unloaded)
    along = -tangent[10, 8:10] * element.p.l0
    speed = np.sqrt(along @ along)
    t = along / speed
    n = np.array([-t[1], t[0]])
    # F . p' + C' F.F/2 = 0, C' from what is left of it at F = n
    gradient, _ = element.contact(unloaded._replace(force=n))
    sine = gradient[10] * element.p.l0 * element.contact_force / speed
    force = element.contact_force * (n * np.sqrt(1 - sine * sine) + sine * t)
    gradient, _ = element.contact(unloaded._replace(force=force))
    return _State(x, unloaded.node - gradient[8:10], xi, force)

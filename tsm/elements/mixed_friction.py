"""Coulomb friction in the contact law whose force and arc position are unknowns.

Friction acts at a face at the distance h from the axis. Its force F on the beam, with the components F_t
along the mean tangent T of the loaded centre line and ``F_n = side F.n >= 0`` across it, is on the axis the
force F and the couple ``M = side h F_t``, which acts on the section. The element's response to both at xi,
its ends held, is ::

    r     = p(xi) + C F_n n + A F_t t + K M n           point of the axis
    theta = phi(xi) - gamma + K F_n + R M               rotation of the section
    E     = (C F_n^2 + A F_t^2 + R M^2)/2 + K F_n M     strain energy

Here n and t are the normal and tangent of the unloaded curve p, which has the slope angle phi and the shear
strain gamma; C is the compliance of `mixed_contact`, and with ``z = xi (1 - xi)`` ::

    A = z l0/EA,    K = l0^2/(2 EI (1 + Phi)) z^2 (1 - 2 xi),    R = l0/(EI (1 + Phi)) z (1 + Phi - 3 z)

Without friction a force has no component along the beam, and ``C F`` is the same as ``C F_n n``. The nodal
loads are ``F . dp/dx + M dtheta/dx + dE/dx``, and the mean tangent is ``T = dp/ds + (dC/ds F_n n + ..)/2 + M
rho n``, with the slope rho that a unit couple makes. These parts are such that ``F . T + M theta' = d(F . p +
M theta + E)/ds``. So the work of the node less the nodal work and the change of E is F_t times the slip of
`tsm.model.pairs`: what friction dissipates.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from tsm.elements.contact_law import Friction, Here, Vector
from tsm.elements.curve import Curve
from tsm.elements.mixed_contact import LEVER, REDUCE, compliance
from tsm.elements.properties import Array, Properties, chord_rotation
from tsm.elements.varied import derivatives, plain, varied

_ITERATIONS = 50
_LAST = 1e-15
"""Relative change at which an iteration ends."""


class Loaded(NamedTuple):
    """An element under the force and couple of a contact; arrays (8,), see `varied`."""

    here: Here
    force: Vector  # force F on the beam
    place: Vector  # point r of the axis from the element's end i
    nodal: tuple[Any, ...]  # loads on chord and end rotations
    energy: Any  # strain energy E by the contact


def response(loaded: Loaded, lever: Vector, rows: tuple[Any, Any, Any], l0: float) -> tuple[Array, Array]:
    """Residual (11,) and its derivative, see `Friction`; ``rows``: vector from axis to surface, and the last row."""
    (rx, ry), (px, py, last) = loaded.place, rows
    stacked = np.array([*(-load for load in loaded.nodal), -rx - px, -ry - py, last])
    force = plain(loaded.force)
    at_node = np.array([*-force, 0, 0, 0, 0, *force, *(-part for part in lever), 0])
    return plain(stacked) @ REDUCE + at_node, REDUCE.T @ by_arc(stacked, l0) @ REDUCE - LEVER


def by_arc(values: Any, l0: float) -> Array:
    """Derivatives (..., 7) with the arc position in place of xi."""
    rates = derivatives(values)
    rates[..., 6] /= l0
    return rates


@lru_cache(maxsize=16)
def load(p: Properties, x: tuple[Any, ...], xi: Any, force: Vector, lever: float, start: float) -> Loaded:
    """The element, whose end i has the arc position `start`, under a contact's force and couple, see the module's text.

    Solution, margins and energies ask for the same one in turn. The derivatives with the arc position take
    the axes n and t of the unloaded curve with them, which turn by its curvature.
    """
    dx, dy, theta_i, theta_j, Fx, Fy, part = varied((x[3] - x[0], x[4] - x[1], x[2], x[5], *force, xi))
    curve, l0 = Curve(p, (0.0, 0.0, theta_i, dx, dy, theta_j)), p.l0
    dx, dy = curve.dx, curve.dy
    w, (wx, wy, wi, wj, slope) = curve.deflection_slope(part)
    phi, (*phi_x, bend) = curve.slope_angle(part)
    gamma, gamma_x = curve.shear_strain, curve.shear_strain_slope()
    slope, bend = slope / l0, bend / l0
    c, s = np.cos(phi), np.sin(phi)
    N, S = Fy * c - Fx * s, Fx * c + Fy * s
    a = _flexibility(p, part)
    turned = (a.C - a.A) * bend
    along, across = (a.A_s * S - turned * N) / 2, (a.C_s * N - turned * S) / 2
    free = (
        dx / l0 - slope * dy + along * c - across * s,
        dy / l0 + slope * dx + along * s + across * c,
    )
    along, across = -a.K * bend, a.rho
    sloped = (along * c - across * s, along * s + across * c)
    M, T = _couple((Fx, Fy), free, sloped, lever)
    Tx, Ty = T
    along, across = a.A * S, a.C * N + a.K * M
    arm, by_phi = Fy * dx - Fx * dy, N * along - S * across
    nodal = (part * Fx + arm * wx + w * Fy, part * Fy + arm * wy - w * Fx, arm * wi, arm * wj)
    kink = chord_rotation(Ty * c - Tx * s, Tx * c + Ty * s)
    return Loaded(
        here=Here(
            arc=start + part * l0,
            tangent=T,
            shear=gamma + kink - a.K * N - a.R * M,
            direction=phi + kink,
            turn=bend + a.kappa * N + a.R_s * M / 2,
        ),
        force=(Fx, Fy),
        place=(part * dx - w * dy + along * c - across * s, part * dy + w * dx + along * s + across * c),
        nodal=tuple(
            load + (by_phi + M) * turn - M * strain
            for load, turn, strain in zip(nodal, phi_x, gamma_x, strict=True)
        ),
        energy=(a.C * N * N + a.A * S * S + a.R * M * M) / 2 + a.K * N * M,
    )


class Flexibility(NamedTuple):
    """What a unit force and couple at a point of a held element do there, over seven variables."""

    C: Any  # C, C_s: deflection by a force across the element, and its derivative in the arc position
    C_s: Any
    A: Any  # A, A_s: displacement by a force along the element, and its derivative
    A_s: Any
    K: Any  # deflection by a couple, rotation by a force
    R: Any  # R, R_s: rotation by a couple, and its derivative
    R_s: Any
    rho: Any  # slope of the centre line by a couple, ``R`` and the shear strain
    kappa: Any  # curvature by a force, so that ``dK/ds = rho + kappa``


def _flexibility(p: Properties, xi: Any) -> Flexibility:
    l0, Phi = p.l0, p.Phi
    C, dC, *_ = compliance(p, xi)
    z, dz = xi * (1 - xi), (1 - 2 * xi) / l0
    soft = l0 / (p.EI * (1 + Phi))
    return Flexibility(
        C=C,
        C_s=dC / l0,
        A=l0 / p.EA * z,
        A_s=l0 / p.EA * dz,
        K=soft * l0**2 / 2 * z * z * dz,
        R=soft * z * (1 + Phi - 3 * z),
        R_s=soft * dz * (1 + Phi - 6 * z),
        rho=soft * z * (1 + Phi / 2 - 3 * z),
        kappa=-soft / 2 * z * (Phi + 4 * z),
    )


def _couple(force: Vector, free: Vector, sloped: Vector, lever: float) -> tuple[Any, Vector]:
    """Couple ``M = lever F . T/|T|`` and the mean tangent ``T = free + M sloped``, by Newton's method.

    A step more than the numbers need gives the derivatives those of the solution.
    """
    M = np.zeros_like(free[0])
    if not lever:
        return M, free
    for _ in range(_ITERATIONS):
        step = _couple_step(M, force, free, sloped, lever)
        M = M + step
        if (np.abs(step) <= _LAST * np.abs(M)).all():
            break
    M = M + _couple_step(M, force, free, sloped, lever)
    return M, (free[0] + M * sloped[0], free[1] + M * sloped[1])


def _couple_step(M: Any, force: Vector, free: Vector, sloped: Vector, lever: float) -> Any:
    """Step of Newton's method for the couple."""
    (Fx, Fy), (slope_x, slope_y) = force, sloped
    Tx, Ty = free[0] + M * slope_x, free[1] + M * slope_y
    square = Tx * Tx + Ty * Ty
    size = np.sqrt(square)
    along, across = Fx * Tx + Fy * Ty, Fy * Tx - Fx * Ty
    turn = (slope_y * Tx - slope_x * Ty) / square
    return (along * lever / size - M) / (1 - across * lever / size * turn)


FRICTION = Friction(load=load, response=response, slip=by_arc)
"""Friction of the contact law whose force and arc position are unknowns."""

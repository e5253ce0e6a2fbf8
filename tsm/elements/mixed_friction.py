"""Coulomb friction in the contact law whose force and arc position are unknowns.

Friction acts at a face at the distance h from the axis. Its force F on the beam, with the components F_t along the mean tangent T of the
loaded centre line and ``F_n = side F.n >= 0`` across it, is on the axis the force F and the couple ``M = side h F_t``, which acts on the
section. The element's response to both at xi, its ends held, is ::

    r     = p(xi) + C F_n n + A F_t t + K M n           point of the axis
    theta = phi(xi) - gamma + K F_n + R M               rotation of the section
    E     = (C F_n^2 + A F_t^2 + R M^2)/2 + K F_n M     strain energy

Here n and t are the normal and tangent of the unloaded curve p, which has the slope angle phi and the shear strain gamma; C is the
compliance of `mixed_contact`, and with ``z = xi (1 - xi)`` ::

    A = z l0/EA,    K = l0^2/(2 EI (1 + Phi)) z^2 (1 - 2 xi),    R = l0/(EI (1 + Phi)) z (1 + Phi - 3 z)

Without friction a force has no component along the beam, and ``C F`` is the same as ``C F_n n``. The rows are

- the nodal loads ``F . dp/dx + M dtheta/dx + dE/dx``;
- the node at ``r - side offset n(T)``, the offset being h and the radius of a round pin;
- in slip ``F_t = sigma mu F_n``, which is ``F . T = c (T_x F_y - T_y F_x)`` with the lean ``c = sigma mu side``;
- in stick ``(A_s + A_s*)/2 (s - s*) + side h (psi - psi*) + side radius (phi - phi*) = 0``, where psi = phi - theta is the shear angle,
  ``A_s = |T| + side h theta'`` the length of the face per arc position, and * the value in the held place, see `tsm.energy`.

The mean tangent is ``T = dp/ds + (dC/ds F_n n + ..)/2 + M rho n``, with the slope rho that a unit couple makes. These parts are such that
``F . T + M theta' = d(F . p + M theta + E)/ds``. So the work of the node less the nodal work and the change of E is F_t times the slip,
whose rate is ``A_s ds/dt + side h dpsi/dt + side radius dphi/dt``: what friction dissipates.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from tsm.elements.contact_law import Friction, Rub, Surface
from tsm.elements.curve import Curve
from tsm.elements.mixed_contact import LEVER, REDUCE, compliance, cross_compliance
from tsm.elements.properties import Array, Properties, chord_rotation, unwind
from tsm.elements.varied import derivatives, plain, varied

_ITERATIONS = 50
_LAST = 1e-15
"""Relative change at which an iteration ends."""


Pair = tuple[Any, Any]


class Loaded(NamedTuple):
    """An element under the force and couple of a contact; arrays (8,), see `varied`."""

    xi: Any  # position
    force: Pair  # force F on the beam
    tangent: Pair  # mean tangent T, per undeformed length
    stretch: Any  # |T|
    place: Pair  # point r of the axis from the element's end i
    nodal: tuple[Any, ...]  # loads on chord and end rotations
    energy: Any  # strain energy E by the contact
    curvature: Any  # theta', per undeformed length
    shear: Any  # psi, the angle from the section's normal to T
    slope: Any  # phi, the angle of T


def response(
    p: Properties, x: Any, lever: Any, xi: Any, force: Any, surface: Surface, rub: Rub
) -> tuple[Array, Array]:
    """Residual of a contact with friction and its derivative.

    ``surface``: side and offset of the contact. ``rub``: state of the friction. Returns ``residual`` (11,),
    rows of element (6), node (2), force (2) and arc position; ``tangent`` (11, 11), its derivative, not
    symmetric.
    """
    beam = _loaded(p, tuple(x), xi, tuple(force), surface.side * rub.face)
    (Fx, Fy), (Tx, Ty), (rx, ry) = beam.force, beam.tangent, beam.place
    reach = surface.side * surface.offset
    if reach:
        rx, ry = rx + reach * (Ty / beam.stretch), ry - reach * (Tx / beam.stretch)
    if rub.held is None:
        last = rub.lean * (Fy * Tx - Fx * Ty) - Fx * Tx - Fy * Ty
    else:
        last = rub.unit * _crept(beam, p.l0, surface.side, rub)
    rows = np.array([*(-load for load in beam.nodal), -rx, -ry, last])
    at_node = np.array([*(-part for part in force), 0, 0, 0, 0, *force, *(-part for part in lever), 0])
    tangent = REDUCE.T @ _by_arc(rows, p.l0) @ REDUCE - LEVER
    return plain(rows) @ REDUCE + at_node, tangent


def _by_arc(values: Any, l0: float) -> Array:
    """Derivatives with the arc position in place of xi."""
    rates = derivatives(values)
    rates[..., 6] /= l0
    return rates


def split(p: Properties, x: Any, xi: Any, force: Any, surface: Surface, rub: Rub) -> tuple[Any, Any, Any]:
    """Force along the beam, force across it, positive where the contact pushes, and arc position from the element's start."""
    beam = _loaded(p, tuple(x), xi, tuple(force), surface.side * rub.face)
    (Fx, Fy), (Tx, Ty), size = force, *_tilted(beam, rub)
    return (Fx * Tx + Fy * Ty) / size, surface.side * (Fy * Tx - Fx * Ty) / size, xi * p.l0


def slip(p: Properties, x: Any, xi: Any, force: Any, surface: Surface, rub: Rub) -> Array:
    """Slip rate as a linear form over the eleven unknowns: the force F_t on it is the power that friction dissipates."""
    beam = _loaded(p, tuple(x), xi, tuple(force), surface.side * rub.face)
    form = _by_arc(surface.side * (rub.face * beam.shear + rub.radius * beam.slope), p.l0)
    form[6] += _tilted(beam, rub)[1] + surface.side * rub.face * plain(beam.curvature)
    rate: Array = form @ REDUCE
    return rate


def tilt(p: Properties, xi: Any, eta: Any) -> Any:
    """Change of the mean tangent at xi by a unit force at eta, per undeformed length, in the direction of the force."""
    return cross_compliance(p, xi, eta)[1] / p.l0


def hold(p: Properties, x: Any, xi: Any, force: Any, surface: Surface, rub: Rub) -> Rub:
    """State of the friction where a stick begins, here and now."""
    beam = _loaded(p, tuple(x), xi, tuple(force), surface.side * rub.face)
    path, shear, slope = plain(
        [beam.stretch + surface.side * rub.face * beam.curvature, beam.shear, beam.slope]
    )
    return rub._replace(lean=0.0, held=xi * p.l0, path=path, shear=shear, slope=slope)


def energy(p: Properties, x: Any, _lever: Any, xi: Any, force: Any, surface: Surface, rub: Rub) -> Any:
    """Contribution of the contact to the strain energy."""
    return plain(_loaded(p, tuple(x), xi, tuple(force), surface.side * rub.face).energy)


def crossing(
    p: Properties, xi: tuple[Any, Any], first: Any, second: Any, rubs: tuple[Rub, Rub]
) -> tuple[Array, Array]:
    """Coupling of two contacts on one element, as `mixed_contact.crossing`, with friction.

    The third row of a contact in slip has the slope of the other contact's dent across its leaning force
    ``F' = (F_x - c F_y, F_y + c F_x)``; in stick it has none. The couples on a face do not dent the element at the other contact here,
    and the force along the beam dents it as if it were across.
    """
    C, dx, de, dxx, dxe, dee = cross_compliance(p, *xi)
    l0 = p.l0
    forces = (first, second)
    slope, bend = (dx / l0, de / l0), ((dxx, dxe), (dxe, dee))
    residual = np.zeros(6, dtype=np.result_type(C, *first, *second))
    tangent = np.zeros((6, 6), dtype=residual.dtype)
    for own, other in ((0, 1), (1, 0)):
        row, column = 3 * own, 3 * other
        (Fx, Fy), (Gx, Gy) = forces[own], forces[other]
        residual[row : row + 2] = -C * Gx, -C * Gy
        tangent[[row, row + 1], [column, column + 1]] = -C
        for k in range(2):
            tangent[row : row + 2, 3 * k + 2] = -slope[k] * Gx, -slope[k] * Gy
        if rubs[own].held is not None:
            continue
        c = rubs[own].lean
        dot = (Fx - c * Fy) * Gx + (Fy + c * Fx) * Gy
        residual[row + 2] = -slope[own] * dot
        tangent[row + 2, row : row + 2] = -slope[own] * (Gx + c * Gy), -slope[own] * (Gy - c * Gx)
        tangent[row + 2, column : column + 2] = -slope[own] * (Fx - c * Fy), -slope[own] * (Fy + c * Fx)
        for k in range(2):
            tangent[row + 2, 3 * k + 2] = -bend[own][k] * dot / l0**2
    return residual, tangent


def _tilted(beam: Loaded, rub: Rub) -> tuple[tuple[Any, Any], Any]:
    """Mean tangent with the deflection by other contacts on the element, and its length."""
    Tx, Ty = (part + more for part, more in zip(plain(beam.tangent), rub.tilt, strict=True))
    return (Tx, Ty), np.sqrt(Tx * Tx + Ty * Ty)


def _crept(beam: Loaded, l0: float, side: float, rub: Rub) -> Any:
    """Path of the face along the node since the stick began."""
    crept = beam.xi * l0 - rub.held
    if not rub.face and not rub.radius:
        return crept
    path = beam.stretch + side * rub.face * beam.curvature
    rolled = side * (rub.face * (beam.shear - rub.shear) + rub.radius * unwind(beam.slope - rub.slope))
    return (path + rub.path) / 2 * crept + rolled


@lru_cache(maxsize=16)
def _loaded(p: Properties, x: tuple[Any, ...], xi: Any, force: tuple[Any, Any], lever: float) -> Loaded:
    """The element under a contact's force and couple, see the module's text.

    Solution, margins and energies ask for the same one in turn. The derivatives with the arc position take the axes n and t of the unloaded curve with them, which turn by its curvature.
    """
    moved, part, (Fx, Fy) = varied(x, xi, force)
    curve, l0 = Curve(p, moved), p.l0
    dx, dy = curve.dx, curve.dy
    w, (wx, wy, wi, wj, slope) = curve.deflection_jet(part)[:2]
    phi, (*phi_x, bend) = curve.slope_angle_jet(part)[:2]
    gamma, (*gamma_x, _) = curve.shear_strain_jet()[:2]
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
        xi=part,
        force=(Fx, Fy),
        tangent=T,
        stretch=np.sqrt(Tx * Tx + Ty * Ty),
        place=(part * dx - w * dy + along * c - across * s, part * dy + w * dx + along * s + across * c),
        nodal=tuple(
            load + (by_phi + M) * turn - M * strain
            for load, turn, strain in zip(nodal, phi_x, gamma_x, strict=True)
        ),
        energy=(a.C * N * N + a.A * S * S + a.R * M * M) / 2 + a.K * N * M,
        curvature=bend + a.kappa * N + a.R_s * M / 2,
        shear=gamma + kink - a.K * N - a.R * M,
        slope=phi + kink,
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


def _couple(force: Pair, free: Pair, sloped: Pair, lever: float) -> tuple[Any, Pair]:
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


def _couple_step(M: Any, force: Pair, free: Pair, sloped: Pair, lever: float) -> Any:
    """Step of Newton's method for the couple."""
    (Fx, Fy), (slope_x, slope_y) = force, sloped
    Tx, Ty = free[0] + M * slope_x, free[1] + M * slope_y
    square = Tx * Tx + Ty * Ty
    size = np.sqrt(square)
    along, across = Fx * Tx + Fy * Ty, Fy * Tx - Fx * Ty
    turn = (slope_y * Tx - slope_x * Ty) / square
    return (along * lever / size - M) / (1 - across * lever / size * turn)


FRICTION = Friction(
    response=response, split=split, slip=slip, hold=hold, energy=energy, crossing=crossing, tilt=tilt
)
"""Friction of the contact law whose force and arc position are unknowns."""

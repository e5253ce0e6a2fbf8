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
  ``A_s = |T| + side h theta'`` the length of the face per arc position, and * the value at the beginning of the stick.

The mean tangent is ``T = dp/ds + (dC/ds F_n n + ..)/2 + M rho n``, with the slope rho that a unit couple makes. These parts are such that
``F . T + M theta' = d(F . p + M theta + E)/ds``. So the work of the node less the nodal work and the change of E is F_t times the slip,
whose rate is ``A_s ds/dt + side h dpsi/dt + side radius dphi/dt``: what friction dissipates.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tsm.elements.contact_law import Friction, Rub, Surface
from tsm.elements.curve import Curve, Jet
from tsm.elements.dual import Dual
from tsm.elements.mixed_contact import LEVER, REDUCE, compliance, cross_compliance
from tsm.elements.properties import Array, Properties, chord_rotation, unwind

ARC = 10
"""Row and column of the arc position."""
_ITERATIONS = 50
_LAST = 1e-15
"""Relative change at which an iteration ends."""
_SYMMETRIC = [[min(a, b) * (9 - min(a, b)) // 2 + max(a, b) for b in range(5)] for a in range(5)]
"""Entry of a `Jet`'s hessian at row and column."""


Pair = tuple[Dual, Dual]


class Loaded(NamedTuple):
    """An element under the force and couple of a contact, over ``dx, dy, theta_i, theta_j, F_x, F_y, xi``.

    Attributes
    ----------
    force : tuple of 2 Dual
        Force F on the beam.
    tangent : tuple of 2 Dual
        Mean tangent T, per undeformed length.
    stretch : Dual
        |T|.
    place : tuple of 2 Dual
        Point r of the axis from the element's end i.
    nodal : tuple of 4 Dual
        Loads on chord and end rotations.
    energy : Dual
        Strain energy E by the contact.
    curvature : Dual
        theta', per undeformed length.
    shear : Dual
        psi, the angle from the section's normal to T.
    slope : Dual
        phi, the angle of T.
    """

    force: tuple[Dual, Dual]
    tangent: tuple[Dual, Dual]
    stretch: Dual
    place: tuple[Dual, Dual]
    nodal: tuple[Dual, ...]
    energy: Dual
    curvature: Dual
    shear: Dual
    slope: Dual


def response(
    p: Properties, x: Any, lever: Any, xi: Any, force: Any, surface: Surface, rub: Rub
) -> tuple[Array, Array]:
    """Residual of a contact with friction and its derivative.

    Parameters
    ----------
    p, x, lever, xi, force
        As for `ContactLaw.response`.
    surface : Surface
        Side and offset of the contact.
    rub : Rub
        State of the friction.

    Returns
    -------
    residual : ndarray, shape (11,)
        Rows of element (6), node (2), force (2) and arc position.
    tangent : ndarray, shape (11, 11)
        Its derivative, not symmetric.
    """
    beam = _loaded(p, x, xi, force, surface.side, rub)
    (Fx, Fy), (Tx, Ty), (rx, ry) = beam.force, beam.tangent, beam.place
    reach = surface.side * surface.offset
    if reach:
        rx, ry = rx + reach * (Ty / beam.stretch), ry - reach * (Tx / beam.stretch)
    if rub.held is None:
        last = rub.lean * (Fy * Tx - Fx * Ty) - Fx * Tx - Fy * Ty
    else:
        last = rub.unit * _crept(beam, xi * p.l0, surface.side, rub)
    rows = (*(-load for load in beam.nodal), -rx, -ry, last)
    residual = np.array([row.value for row in rows]) @ REDUCE
    tangent = REDUCE.T @ np.array([row.gradient for row in rows]) @ REDUCE - LEVER
    residual[[0, 1]] -= force
    residual[[6, 7]] += force
    residual[[8, 9]] -= lever
    return residual, tangent


def split(p: Properties, x: Any, xi: Any, force: Any, surface: Surface, rub: Rub) -> tuple[Any, Any, Any]:
    """Force along the beam, force across it, positive where the contact pushes, and arc position from the element's start."""
    beam = _loaded(p, x, xi, force, surface.side, rub)
    (Fx, Fy), (Tx, Ty), size = force, *_tilted(beam, rub)
    return (Fx * Tx + Fy * Ty) / size, surface.side * (Fy * Tx - Fx * Ty) / size, xi * p.l0


def slip(p: Properties, x: Any, xi: Any, force: Any, surface: Surface, rub: Rub) -> Array:
    """Slip rate as a linear form over the eleven unknowns: the force F_t on it is the power that friction dissipates."""
    beam = _loaded(p, x, xi, force, surface.side, rub)
    form = surface.side * (rub.face * beam.shear.gradient + rub.radius * beam.slope.gradient)
    form[6] += _tilted(beam, rub)[1] + surface.side * rub.face * beam.curvature.value
    rate: Array = form @ REDUCE
    return rate


def tilt(p: Properties, xi: Any, eta: Any) -> Any:
    """Change of the mean tangent at xi by a unit force at eta, per undeformed length, in the direction of the force."""
    return cross_compliance(p, xi, eta)[1] / p.l0


def hold(p: Properties, x: Any, xi: Any, force: Any, surface: Surface, rub: Rub) -> Rub:
    """State of the friction where a stick begins, here and now."""
    beam = _loaded(p, x, xi, force, surface.side, rub)
    path = beam.stretch.value + surface.side * rub.face * beam.curvature.value
    return rub._replace(lean=0.0, held=xi * p.l0, path=path, shear=beam.shear.value, slope=beam.slope.value)


def energy(p: Properties, x: Any, _lever: Any, xi: Any, force: Any, surface: Surface, rub: Rub) -> Any:
    """Contribution of the contact to the strain energy."""
    return _loaded(p, x, xi, force, surface.side, rub).energy.value


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
    Tx, Ty = (part.value + more for part, more in zip(beam.tangent, rub.tilt, strict=True))
    return (Tx, Ty), np.sqrt(Tx * Tx + Ty * Ty)


def _crept(beam: Loaded, arc: Any, side: float, rub: Rub) -> Dual:
    """Path of the face along the node since the stick began."""
    crept = Dual(arc - rub.held, np.eye(7)[6])
    if not rub.face and not rub.radius:
        return crept
    path = beam.stretch + side * rub.face * beam.curvature
    turned = Dual(unwind(beam.slope.value - rub.slope), beam.slope.gradient)
    rolled: Dual = side * (rub.face * (beam.shear - rub.shear) + rub.radius * turned)
    return (path + rub.path) / 2 * crept + rolled


def _loaded(p: Properties, x: Any, xi: Any, force: Any, side: float, rub: Rub) -> Loaded:
    curve, l0 = Curve(p, x), p.l0
    dx, dy, Fx, Fy, arc = (
        Dual(value, row)
        for value, row in zip((curve.dx, curve.dy, *force, xi * l0), np.eye(7)[[0, 1, 4, 5, 6]], strict=True)
    )
    part = arc / l0
    w, (wx, wy, wi, wj, ws) = _lifted(curve.deflection_jet(xi), l0)
    phi, (*phi_x, bend) = _lifted(curve.slope_angle_jet(xi), l0)
    gamma, gamma_x = _lifted(curve.shear_strain_jet(), l0)
    c, s = phi.cos(), phi.sin()
    N, S = Fy * c - Fx * s, Fx * c + Fy * s
    C, dC, ddC, _ = compliance(p, xi)
    C, dC = Dual(C, dC / l0 * arc.gradient), Dual(dC / l0, ddC / l0**2 * arc.gradient)
    z, dz = part * (1 - part), (1 - 2 * part) / l0
    A, dA = l0 / p.EA * z, l0 / p.EA * dz
    excess = (C - A) * bend
    # mean tangent without the couple, and the slope that a unit couple makes
    along, across = dA * S - excess * N, dC * N - excess * S
    tangent = (
        dx / l0 - ws * dy + (along * c - across * s) / 2,
        dy / l0 + ws * dx + (along * s + across * c) / 2,
    )
    softness = l0 / (p.EI * (1 + p.Phi))
    K = (softness * l0**2 / 2) * z * z * dz
    R = softness * z * (1 + p.Phi - 3 * z)
    rho = softness * z * (1 + p.Phi / 2 - 3 * z)
    across, along = rho, -K * bend
    sloped = (along * c - across * s, along * s + across * c)
    M = _couple((Fx, Fy), tangent, sloped, side * rub.face)
    tangent = (tangent[0] + M * sloped[0], tangent[1] + M * sloped[1])
    across, along = C * N + K * M, A * S
    a, by_phi = Fy * dx - Fx * dy, -S * ((C - A) * N + K * M)
    nodal = [part * Fx + a * wx + w * Fy, part * Fy + a * wy - w * Fx, a * wi, a * wj]
    nodal = [load + by_phi * turn for load, turn in zip(nodal, phi_x, strict=True)]
    if rub.face:
        nodal = [
            load + M * (turn - strain) for load, turn, strain in zip(nodal, phi_x, gamma_x[:4], strict=True)
        ]
    kink = _angle(tangent[1] * c - tangent[0] * s, tangent[0] * c + tangent[1] * s)
    return Loaded(
        force=(Fx, Fy),
        tangent=tangent,
        stretch=(tangent[0] * tangent[0] + tangent[1] * tangent[1]).sqrt(),
        place=(part * dx - w * dy + along * c - across * s, part * dy + w * dx + along * s + across * c),
        nodal=tuple(nodal),
        energy=(C * N * N + A * S * S + R * M * M) / 2 + K * N * M,
        curvature=bend - softness / 2 * z * (p.Phi + 4 * z) * N + softness / 2 * dz * (1 + p.Phi - 6 * z) * M,
        shear=gamma + kink - K * N - R * M,
        slope=phi + kink,
    )


def _lifted(jet: Jet, l0: Any) -> tuple[Dual, list[Dual]]:
    """Value and first derivatives of a `Jet`, with the arc position in place of xi."""
    scale = np.array([1.0, 1.0, 1.0, 1.0, 1 / l0])
    spread = np.zeros((5, 7))
    spread[range(5), [0, 1, 2, 3, 6]] = scale
    gradient, hessian = np.array(jet.gradient), np.array(jet.hessian)[_SYMMETRIC]
    first = zip(scale * gradient, (scale[:, None] * hessian) @ spread, strict=True)
    return Dual(jet.value, gradient @ spread), [Dual(value, row) for value, row in first]


def _couple(force: Pair, tangent: Pair, sloped: Pair, lever: float) -> Dual:
    """Couple ``M = lever F . T/|T|`` with the mean tangent ``T + M sloped``."""
    M = Dual(0.0, np.zeros(7))
    if not lever:
        return M
    for _ in range(_ITERATIONS):
        Tx, Ty = tangent[0] + M * sloped[0], tangent[1] + M * sloped[1]
        size = (Tx * Tx + Ty * Ty).sqrt()
        along = lever * (force[0] * Tx + force[1] * Ty) / size
        across = lever * (force[1] * Tx - force[0] * Ty) / size
        turn = (sloped[1] * Tx - sloped[0] * Ty) / (size * size)
        step = (along - M) / (1 - across * turn)
        M = M + step
        if abs(step.value) <= _LAST * abs(M.value):
            break
    return M


def _angle(cross: Dual, dot: Dual) -> Dual:
    """Angle of a vector from its components across and along a direction."""
    rate = (dot.value * cross.gradient - cross.value * dot.gradient) / (cross.value**2 + dot.value**2)
    return Dual(chord_rotation(cross.value, dot.value), rate)


FRICTION = Friction(
    response=response, split=split, slip=slip, hold=hold, energy=energy, crossing=crossing, tilt=tilt
)
"""Friction of the contact law whose force and arc position are unknowns."""

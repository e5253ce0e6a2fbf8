"""Coulomb friction in the contact law whose force and arc position are unknowns.

Let T be the mean of the two tangents of the deflected centre line at the contact, per undeformed length, n its left normal and F the
force on the beam. The components of F are ::

    F_t = F . T/|T|,    F_n = side (T_x F_y - T_y F_x)/|T| >= 0

Friction exchanges the third row of the law, ``F . T = 0``:

- in slip for ``F_t = sigma mu F_n``, which is ``F' . T = 0`` with ``F' = (F_x - c F_y, F_y + c F_x)`` and the lean ``c = sigma mu side``;
  sigma is the sign of the slip rate;
- in stick for ``s = s*``, the arc position at which the stick began.

The tangent is symmetric in neither.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tsm.elements.contact_law import Friction, Rub, Surface
from tsm.elements.curve import Curve
from tsm.elements.mixed_contact import compliance, cross_compliance
from tsm.elements.mixed_contact import energy as frictionless_energy
from tsm.elements.mixed_contact import response as frictionless
from tsm.elements.properties import Array, Properties

ARC = 10
"""Row and column of the arc position."""


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
    residual, tangent = frictionless(p, x, lever, xi, force, *surface)
    if rub.held is None:
        Fx, Fy = force
        leaning = (Fx - rub.lean * Fy, Fy + rub.lean * Fx)
        T, dT = _mean_tangent(p, x, xi, force)
        residual[ARC] = -(leaning[0] * T[0] + leaning[1] * T[1])
        tangent[ARC] = -(leaning[0] * dT[0] + leaning[1] * dT[1])
        tangent[ARC, 8] -= T[0] + rub.lean * T[1]
        tangent[ARC, 9] -= T[1] - rub.lean * T[0]
    else:
        residual[ARC] = rub.unit * (xi * p.l0 - rub.held)
        tangent[ARC] = 0.0
        tangent[ARC, ARC] = rub.unit
    return residual, tangent


def split(p: Properties, x: Any, xi: Any, force: Any, surface: Surface, _rub: Rub) -> tuple[Any, Any, Any]:
    """Tangential and normal force, positive where the contact pushes, and the travel from the element's start."""
    (Tx, Ty), _ = _mean_tangent(p, x, xi, force)
    size = np.sqrt(Tx * Tx + Ty * Ty)
    Fx, Fy = force
    return (Fx * Tx + Fy * Ty) / size, surface.side * (Fy * Tx - Fx * Ty) / size, xi * p.l0


def direction(p: Properties, x: Any, xi: Any, force: Any, _surface: Surface, _rub: Rub) -> Any:
    """Angle of the mean tangent from the x axis."""
    (Tx, Ty), _ = _mean_tangent(p, x, xi, force)
    return np.arctan2(Ty, Tx)


def slip(p: Properties, x: Any, xi: Any, force: Any, _surface: Surface, _rub: Rub) -> Array:
    """Slip rate as a linear form over the eleven unknowns: the force F_t on it is the power that friction dissipates."""
    (Tx, Ty), _ = _mean_tangent(p, x, xi, force)
    form = np.zeros(11, dtype=np.result_type(Tx, float))
    form[ARC] = np.sqrt(Tx * Tx + Ty * Ty)
    return form


def energy(p: Properties, x: Any, lever: Any, xi: Any, force: Any, surface: Surface, _rub: Rub) -> float:
    """Contribution of the contact to the strain energy in equilibrium, as `ContactLaw.energy`."""
    return frictionless_energy(p, x, lever, xi, force, *surface)


def crossing(
    p: Properties, xi: tuple[Any, Any], first: Any, second: Any, rubs: tuple[Rub, Rub]
) -> tuple[Array, Array]:
    """Coupling of two contacts on one element, as `mixed_contact.crossing`, with friction.

    The third row of a contact in slip has the slope of the other contact's dent across its leaning force ``F'``; in stick it has none.
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


def _mean_tangent(p: Properties, x: Any, xi: Any, force: Any) -> tuple[tuple[Any, Any], Array]:
    """Mean tangent of the loaded centre line per undeformed length, and its derivative (2, 11)."""
    curve = Curve(p, x)
    dx, dy, l0, (Fx, Fy) = curve.dx, curve.dy, p.l0, force
    _, dC, ddC, _ = compliance(p, xi)
    _, (*_, ws), (_, _, _, _, hxs, _, _, _, hys, _, _, his, _, hjs, hss) = curve.deflection_jet(xi)
    T = ((dx - ws * dy + dC * Fx / 2) / l0, (dy + ws * dx + dC * Fy / 2) / l0)
    across = np.array([hxs, hys, his, hjs, 0.0, 0.0, hss / l0]) / l0
    reduced = np.array([-dy * across, dx * across])
    reduced[0, 0] += 1 / l0
    reduced[0, 1] -= ws / l0
    reduced[1, 0] += ws / l0
    reduced[1, 1] += 1 / l0
    reduced[0, 4] = reduced[1, 5] = dC / (2 * l0)
    reduced[:, 6] += ddC / (2 * l0 * l0) * np.array([Fx, Fy])
    full = np.zeros((2, 11), dtype=reduced.dtype)
    full[:, [0, 1]], full[:, [3, 4]] = -reduced[:, :2], reduced[:, :2]
    full[:, [2, 5, 8, 9, 10]] = reduced[:, 2:]
    return T, full


FRICTION = Friction(
    response=response, split=split, direction=direction, slip=slip, energy=energy, crossing=crossing
)
"""Friction of the contact law whose force and arc position are unknowns."""

"""The equations of a Reissner rod, clamped at one end, under a pin with Coulomb friction.

The clamp is at the origin and the undeformed rod lies along +x. The unknowns `z = (F_x, F_y, m_0, s)` are the force of the pin on the
rod, the moment of the section at the clamp and the arc position of the contact. Between clamp and contact the rod carries the constant
force F; the tail is free of load. The units are those of `comparisons.exact.section`.

With the derivatives `r'_-, r'_+` of the axis before and behind the contact, let `a t = (r'_- + r'_+)/2` with the unit vector t at the
angle phi and its left normal n. The force has the components `F_t = F . t` and `F_n = F . n`. A pin of radius R that does not turn touches
the face at the distance h from the axis, where the couple `h F_t` acts on the rotation theta of the section. Three equations are the
position of the pin and the moment at the contact. The power of the pin less the rate of the stored energy is `F_t v` with the slip rate

    v = A ds/dt + d(roll)/dt,   A = a + h (theta'_- + theta'_+)/2,   roll = h (phi - theta) + R phi

In slip `F_t = sigma mu F_n`, where sigma is the sign of v; without friction `F_t = 0`. In stick v = 0 all along, and v is the rate of no
quantity: with the values `*` at an earlier place of the stick

    (A + A*)/2 (s - s*) + roll - roll* = c,   dc/dt = (A'(s - s*) - (A - A*) s')/2

The trapezium on the left is exact, c = 0, where A is constant or roll is.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from comparisons.exact.section import COMPLEX_STEP, Array, Flexibility, Section, integrate, tangent
from comparisons.frozen import Value

Real = NDArray[np.float64]
_LARGEST_CORRECTION, _CONVERGED = 0.1, 3e-8
_ROUND_OFF, _NOISE = 1e-14, 1e-5
"""A residual at round-off, and the correction that it may leave where the equations are stiff."""
_SINGULAR = 1e13


class Contact(NamedTuple):
    """Residual (..., 3) of three equations, components of the force, and the terms A and roll of the slip rate, (...)."""

    residual: Array
    tangential: Array
    normal: Array
    factor: Array
    roll: Array


class Phase(NamedTuple):
    """Slip of a sense, or stick, whose sense is 0, since a load parameter; an earlier place of a stick, and c from there on."""

    sense: int
    since: float
    place: "Linear | None" = None
    area: Polynomial = Polynomial([0.0])


class Linear(NamedTuple):
    """Contact and the residual (4,) of all equations at unknowns (4,), with their derivatives, unknowns on their last axis."""

    z: Real
    residual: Real
    matrix: Real
    here: Contact
    slope: Contact

    @property
    def slip(self) -> Real:
        """Derivatives (4,) of the slip."""
        return np.asarray(self.slope.roll + np.array([0.0, 0.0, 0.0, self.here.factor]))

    def rates(self, velocity: Real, *, stick: bool) -> Real | None:
        """Rates of the unknowns (4,) at a velocity of the pin (2,); None where they are not determined."""
        matrix = np.vstack([self.matrix[:3], self.slip]) if stick else self.matrix
        return _solved(matrix, np.array([*velocity, 0.0, 0.0]))


@np.errstate(all="ignore")
def _solved(matrix: Real, right: Real, largest: float = _SINGULAR) -> Real | None:
    """Solution of equations that are scaled: beside the clamp they are as small as powers of the arc position; None where they are singular."""
    columns = np.abs(matrix).max(axis=0)
    rows = np.abs(matrix / columns).max(axis=1)
    plain = matrix / columns / rows[:, None]
    if not (np.all(np.isfinite(plain)) and np.linalg.cond(plain) < largest):
        return None
    return np.asarray(np.linalg.solve(plain, right / rows) / columns)


class Cantilever(Value):
    """A rod under a pin: flexibility, distance h of the face from the axis, radius R of the pin, coefficient of friction."""

    flexibility: Flexibility
    face: float = 0.0
    radius: float = 0.0
    friction: float = 0.0

    @property
    def reach(self) -> float:
        """Distance of the pin's centre from the axis."""
        return self.face + self.radius

    def sections(self, z: Array, fractions: Real | None = None) -> Section:
        """Section at the contact for unknowns (..., 4), or sections (k,) at fractions (k,) of the loaded part."""
        Fx, Fy, moment, s = np.moveaxis(np.asarray(z), -1, 0)
        zero = np.zeros_like(s)
        return integrate(Section(zero, zero, zero, moment), (Fx, Fy), s, self.flexibility, fractions)

    def contact(self, z: Array, pin: Real) -> Contact:
        """Contact at unknowns (..., 4)."""
        end, (Fx, Fy) = self.sections(z), np.moveaxis(z[..., :2], -1, 0)
        c, d = np.cos(end.theta), np.sin(end.theta)
        before = tangent(end.theta, (Fx, Fy), self.flexibility)
        bx, by = (before[0] + c) / 2.0, (before[1] + d) / 2.0
        a = np.sqrt(bx**2 + by**2)
        tx, ty = bx / a, by / a
        shear = np.arctan((by * c - bx * d) / (bx * c + by * d))
        tangential = Fx * tx + Fy * ty
        couple = self.face * tangential
        x, y = end.x + self.reach * ty - pin[0], end.y - self.reach * tx - pin[1]
        return Contact(
            residual=np.stack([x, y, end.moment - couple], axis=-1),
            tangential=tangential,
            normal=Fy * tx - Fx * ty,
            factor=a + self.face * couple / 2.0,
            roll=self.face * shear + self.radius * (end.theta + shear),
        )

    def linearise(self, z: Real, pin: Real, phase: Phase, t: float) -> Linear:
        """Equations of a phase and their derivatives at unknowns (4,) and a load parameter."""
        table = z + 1j * COMPLEX_STEP * np.eye(4)
        found = self.contact(table, pin)
        last = found.tangential - phase.sense * self.friction * found.normal
        if not phase.sense and phase.place is not None:
            arc, before = phase.place.z[3], phase.place.here
            mean = (found.factor + before.factor) / 2.0
            last = mean * (table[:, 3] - arc) + found.roll - before.roll - phase.area(t)
        rows = np.column_stack([found.residual, last])
        here, slope = (
            Contact(*part) for part in zip(*((f[0].real, f.imag / COMPLEX_STEP) for f in found), strict=True)
        )
        return Linear(z, rows[0].real, rows.imag.T / COMPLEX_STEP, here, slope)

    @np.errstate(all="ignore")
    def solve(self, z: Real, pin: Real, phase: Phase, t: float) -> tuple[Linear | None, int]:
        """Equilibrium from nearby unknowns by Newton's method, None without convergence, and the iterations."""
        last = _LARGEST_CORRECTION
        for count in range(1, 15):
            linear = self.linearise(z, pin, phase, t)
            change = _solved(linear.matrix, -linear.residual, np.inf) if z[3] > 0.0 else None
            if change is None:
                break
            size = float(np.max(np.abs(change) / (1.0 + np.abs(z))))
            z = z + change
            if size < (_NOISE if np.max(np.abs(linear.residual)) < _ROUND_OFF else _CONVERGED):
                return self.linearise(z, pin, phase, t), count
            if not size <= last:
                break
            last = size / 2.0
        return None, count

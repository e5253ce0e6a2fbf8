"""Coulomb friction at a contact of a rod: the third row of the contact, and the slip rate.

On a rod with the derivatives `r'_-, r'_+` of the axis before and behind the contact, let `a t = (r'_- + r'_+)/2` with the unit
vector t at the angle phi and its left normal n. The force F on the rod has the components `F_t = F . t` and `F_n = side F . n`,
with side = 1 for a pin on the right of the rod and -1 on its left. A pin of radius R that does not turn touches the face at the
distance h from the axis. The couple `side h F_t` acts on the rotation theta of the section. The power of the pin less the rate
of the stored energy is `F_t v` with the slip rate

    v = A ds/dt + d(roll)/dt,   A = a + side h (theta'_- + theta'_+)/2,   roll = side (h (phi - theta) + R phi)

In slip `F_t = sigma mu F_n`, where sigma is the sign of v. In stick v = 0 all along, and v is the rate of no quantity: with the
values `*` at an earlier place of the stick

    (A + A*)/2 (s - s*) + roll - roll* = c,   dc/dt = (A'(s - s*) - (A - A*) s')/2

The trapezium on the left is exact, c = 0, where A is constant or roll is.
"""

from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from comparisons.exact.reissner import COMPLEX_STEP

Array = NDArray[Any]  # real or complex: derivatives are complex steps
Real = NDArray[np.float64]


class Contact(NamedTuple):
    """Residual of all rows but the last (..., n - 1), force (..., 2), its components and the terms of the slip rate, (...).

    `cone` (..., 2) has the components tangential and normal of the force, or of its direction where the unknowns have one, so
    that the slip row is regular without force.
    """

    residual: Array
    cone: Array
    force: Array
    tangential: Array
    normal: Array
    arc: Array
    factor: Array
    roll: Array


class Observed(NamedTuple):
    """Force (2,), clamp moment, stored energy, position (2,) and rotation of the axis at the contact."""

    force: Real
    clamp_moment: float
    energy: float
    position: Real
    rotation: float


class Equations(Protocol):
    """A dimensionless cantilever under a pin, with n unknowns z and the residual of the pin's position in its first two rows."""

    @property
    def reach(self) -> float:
        """Distance of the pin's point from the axis."""

    @property
    def side(self) -> int:
        """1 for a pin on the right of the rod, -1 on its left."""

    def contact(self, z: Array, pin: Real) -> Contact:
        """Residual and quantities of the contact at unknowns (..., n)."""

    def exists(self, z: Real) -> bool:
        """Whether unknowns (n,) state a rod that presses on the pin, or all but presses."""

    def touching(self, x: float, sense: int, friction: float) -> Real:
        """Unknowns (n,) of the straight rod with a pin at x."""

    def observe(self, z: Real) -> Observed:
        """Return what is reported of unknowns (n,)."""


@dataclass(frozen=True, kw_only=True)
class Phase:
    """Slip of a sense, or stick, whose sense is 0, since a load parameter, with an earlier place of a stick and c from there on."""

    sense: int
    since: float
    start: Contact | None = None
    area: Polynomial = field(default_factory=lambda: Polynomial([0.0]))

    def at(self, t: float) -> "Phase":
        """Phase whose row has the value of c at a load parameter."""
        if self.start is None:
            return self
        return replace(self, start=self.start._replace(roll=self.start.roll + self.area(t)))


class Linear(NamedTuple):
    """Equations at real unknowns (n,): residual (n,), tangent (n, n), contact, and derivatives (n,) of forces and slip."""

    residual: Real
    tangent: Real
    contact: Contact
    tangential: Real
    normal: Real
    slip: Real

    def rates(self, velocity: Real) -> Real:
        """Rates of the unknowns (n,) at a velocity of the pin (2,)."""
        right = np.zeros(len(self.residual))
        right[:2] = velocity
        return np.asarray(np.linalg.solve(self.tangent, right), dtype=np.float64)


def third_row(contact: Contact, phase: Phase, friction: float) -> Array:
    """Residual of the slip row or the stick row."""
    if phase.sense:
        return np.asarray(contact.cone[..., 0] - phase.sense * friction * contact.cone[..., 1])
    assert phase.start is not None
    mean = (contact.factor + phase.start.factor) / 2.0
    return np.asarray(mean * (contact.arc - phase.start.arc) + contact.roll - phase.start.roll)


def linearise(equations: Equations, z: Real, pin: Real, phase: Phase, friction: float) -> Linear:
    """Equations and their derivatives at real unknowns (n,)."""
    contact = equations.contact(z + 1j * COMPLEX_STEP * np.eye(len(z)), pin)
    row = third_row(contact, phase, friction)
    whole = np.column_stack([contact.residual, row])
    here = Contact(*(field[0].real for field in contact))
    tangential, normal, arc, roll = (
        field.imag / COMPLEX_STEP for field in (contact.tangential, contact.normal, contact.arc, contact.roll)
    )
    return Linear(
        residual=whole[0].real,
        tangent=whole.imag.T / COMPLEX_STEP,
        contact=here,
        tangential=tangential,
        normal=normal,
        slip=here.factor * arc + roll,
    )


def margins(linear: Linear, rates: Real, phase: Phase, friction: float) -> Real:
    """Return what is positive while a phase lasts, shape (3,): slip rate or distance from the cone, normal force, rest of the rod.

    Without friction the sense of the slip does not matter.
    """
    contact = linear.contact
    first = float(phase.sense * (linear.slip @ rates)) if friction else 1.0
    if not phase.sense:
        first = float(friction * contact.normal - abs(contact.tangential))
    return np.array([first, contact.normal, 1.0 - contact.arc])

"""A clamped Reissner rod under one contact force with any direction, right or wrong, by shooting."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import root

from comparisons.scene import BeamSpec

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Shot:
    """A clamped rod up to its contact, in the frame of the clamp with x along the undeformed rod.

    Attributes
    ----------
    beam : BeamSpec
        The rod.
    force : ndarray, shape (2,)
        The contact force, which is the internal force from the clamp to the contact.
    moment : float
        Internal moment at the clamp.
    arc : float
        Arc position of the contact.
    line : callable
        ``line(s)``: x, y, rotation and moment at an arc length up to `arc`.
    """

    beam: BeamSpec
    force: Array
    moment: float
    arc: float
    line: Callable[[float], Array]

    @property
    def angle(self) -> float:
        """Rotation of the section at the contact and of the tail."""
        return float(self.line(self.arc)[2])

    @property
    def tail(self) -> Array:
        """Tangent of the tail."""
        return np.array([np.cos(self.angle), np.sin(self.angle)])

    @property
    def loaded(self) -> Array:
        """Tangent of the loaded side at the contact."""
        return tangent(self.beam, self.force, self.angle)

    @property
    def mean(self) -> Array:
        """Mean of the two tangents at the contact."""
        return (self.loaded + self.tail) / 2.0

    def rotation(self, arc: float) -> float:
        """Rotation of any section."""
        return float(self.line(min(arc, self.arc))[2])

    def position(self, arc: float) -> Array:
        """Position of any section, on the straight tail too."""
        return self.line(min(arc, self.arc))[:2] + max(arc - self.arc, 0.0) * self.tail

    def node(self, elements: int, number: int) -> float:
        """Arc length of the first or second (0, 1) node of the element in contact, of equally long ones."""
        length = self.beam.length / elements
        return length * (min(int(self.arc / length), elements - 1) + number)


def tangent(beam: BeamSpec, n: Array, angle: float) -> Array:
    """Return ``r' = (1 + N/EA) d1 + (Q/GA) d2``."""
    d1, d2 = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    return np.asarray((1.0 + n @ d1 / beam.EA) * d1 + n @ d2 / beam.GA * d2)


def shoot(beam: BeamSpec, force: Array, moment: float, arc: float) -> Shot:
    """Integrate ``theta' = m/EI``, ``r'`` and ``m' = -r' x n`` from the clamp to the contact."""

    def slope(_: float, state: Array) -> Array:
        x, y = tangent(beam, force, state[2])
        return np.array([x, y, state[3] / beam.EI, y * force[0] - x * force[1]])

    found = solve_ivp(
        slope, (0.0, arc), [0.0, 0.0, 0.0, moment], method="DOP853", rtol=1e-12, atol=1e-15, dense_output=True
    )
    return Shot(beam=beam, force=force, moment=moment, arc=arc, line=found.sol)


def rod_with_direction(
    beam: BeamSpec,
    touched: Array,
    start: Shot,
    direction: Callable[[Shot], Array],
    lever: Callable[[Shot], float],
) -> Shot:
    """Return the equilibrium with the contact's point of the axis at `touched` and a contact force normal to ``direction(shot)``.

    Parameters
    ----------
    beam : BeamSpec
        The rod.
    touched : ndarray, shape (2,)
        Where the contact is.
    start : Shot
        First guess.
    direction : callable
        The tangent that the force is normal to.
    lever : callable
        Distance of the force from the point of the axis, along the tangent of the tail: the moment there is ``F lever``.
    """
    F, L = beam.EI / beam.length**2, beam.length

    def residual(z: Array) -> Array:
        shot = shoot(beam, z[:2] * F, float(z[2]) * F * L, float(z[3]) * L)
        x, y, _, m = shot.line(shot.arc)
        way = direction(shot)
        size = float(np.hypot(*shot.force))
        return np.array(
            [
                (x - touched[0]) / L,
                (y - touched[1]) / L,
                (m - size * lever(shot)) / (F * L),
                shot.force @ way / size / float(np.hypot(*way)),
            ]
        )

    first = np.array([*start.force / F, start.moment / (F * L), start.arc / L])
    found = root(residual, first, tol=1e-12)
    assert np.abs(residual(found.x)).max() < 1e-10, found.message
    return shoot(beam, found.x[:2] * F, float(found.x[2]) * F * L, float(found.x[3]) * L)

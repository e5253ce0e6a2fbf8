"""A Reissner rod, clamped at the origin along +x, whose tip is hinged to a point that moves along a path.

The internal force n is constant, and the moment vanishes at the tip:

    theta(s) = int_0^s m,   m(s) = int_s^1 r' x n,   r' = (1 + N/EA) d1 + (Q/GA) d2,   N = n.d1,  Q = n.d2

with lengths in units of the rod's length, forces in EI/L^2 and moments in EI/L. The unknowns are m at Gauss points, where both
integrals are matrices, and n. The equations are the two integrals and `int_0^1 (r' - e1) = tip - e1`, the stationarity conditions of

    Pi(m, n) = 1/2 int m^2 - int (N + N^2/2 EA + Q^2/2 GA) + n.tip

The energy is a maximum in n for every m. A state is stable at a fixed tip if this maximum is a minimum in m: if and only if the
Hessian has exactly two negative eigenvalues. A taut rod bends in a layer `1/sqrt(n)` at the clamp, where the points are denser.

A compressed rod buckles sideways within a thousandth of its length, which a long step could pass over. Therefore a step is shortened
until the prediction along the tangent to the path is small. It is halved unless the first correction is small, every later one is
at most half the one before, and the Hessian at every iterate belongs to a stable state.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike, NDArray

# integrals of Legendre polynomials, as the exact answers of the product take them
from comparisons.exact.section import integrals

Array = NDArray[np.float64]

POINTS = 64
SMALLEST_STEP = 1e-14
"""Relative to the completed fraction of a piece of the path, or to 1e-12 if larger."""
PREDICTION, CORRECTION = 0.1, 0.05
"""A rotation [rad] or a relative change of the force."""


class Tied(NamedTuple):
    """States at `s` positions of the tip, nan without a stable equilibrium that is connected with the straight rod.

    Force on the tip (s, 2), moment of the clamp on the rod, rotation of the tip, Newton iterations since the position before, and
    rotations at Gauss points (s, n).
    """

    force: Array
    clamp_moment: Array
    tip_rotation: Array
    iterations: Array
    rotations: Array


class Rod(NamedTuple):
    """Flexibilities `EI/(EA L^2)` and `EI/(GA L^2)`, weights (n,) and integrals from the clamp (n, n)."""

    stretch: float
    shear: float
    weights: Array
    left: Array

    def equations(self, z: Array, displacement: Array) -> tuple[Array, Array, float]:
        """Gradient (n + 2,) and Hessian of the energy at moments and force, and the moment at the clamp."""
        a, b, n = self.stretch, self.shear, len(self.weights)
        theta, force, w = self.left @ z[:n], z[n:], self.weights
        d1 = np.stack([np.cos(theta), np.sin(theta)], axis=1)
        d2 = np.stack([-d1[:, 1], d1[:, 0]], axis=1)
        N, Q = d1 @ force, d2 @ force
        stretch = 1.0 + (a - b) * N
        turn = np.stack([-2.0 * np.sin(theta / 2.0) ** 2, d1[:, 1]], axis=1)
        strain = turn + (a * N)[:, None] * d1 + (b * Q)[:, None] * d2
        turned = ((a - b) * Q)[:, None] * d1 + stretch[:, None] * d2
        by_force = a * d1[:, :, None] * d1[:, None, :] + b * d2[:, :, None] * d2[:, None, :]
        gradient, hessian = np.empty(n + 2), np.empty((n + 2, n + 2))
        gradient[:n] = w * z[:n] - self.left.T @ (w * Q * stretch)
        gradient[n:] = displacement - w @ strain
        hessian[:n, :n] = np.diag(w) - (self.left.T * (w * ((a - b) * Q**2 - N * stretch))) @ self.left
        hessian[:n, n:] = -self.left.T @ (w[:, None] * turned)
        hessian[n:, :n] = hessian[:n, n:].T
        hessian[n:, n:] = -np.tensordot(w, by_force, 1)
        return gradient, hessian, float(w @ (Q * stretch))

    def size(self, change: Array, z: Array) -> float:
        """Largest change of a rotation [rad], or relative change of the force if larger."""
        turned = np.abs(self.left @ change[:-2]).max()
        return float(max(turned, np.hypot(*change[-2:]) / (1.0 + np.hypot(*z[-2:]))))

    def corrected(self, z: Array, displacement: Array) -> tuple[Array | None, int]:
        """Unknowns from nearby ones, None if the step is rejected, and iterations."""
        allowed = CORRECTION
        for iteration in range(1, 13):
            gradient, hessian, _ = self.equations(z, displacement)
            if not stable(hessian):
                break
            change = -np.linalg.solve(hessian, gradient)
            size = self.size(change, z)
            if not size <= allowed:
                break
            z, allowed = z + change, size / 2.0
            if size < 1e-11:
                return z, iteration
        return None, iteration

    def advanced(self, z: Array, start: Array, end: Array) -> tuple[Array | None, int]:
        """Unknowns at the end of a straight piece of the path, None if not reached, and iterations."""
        done, step, spent = 0.0, 1.0, 0
        right = np.append(np.zeros(len(z) - 2), start - end)
        while done < 1.0:
            hessian = self.equations(z, start + done * (end - start))[1]
            if step < SMALLEST_STEP * max(done, 1e-12) or not stable(hessian):
                return None, spent
            tangent = np.linalg.solve(hessian, right)
            step = min(step, PREDICTION / max(self.size(tangent, z), PREDICTION))
            following = done + step if step < 1.0 - done else 1.0
            found, iterations = self.corrected(
                z + (following - done) * tangent, start + following * (end - start)
            )
            spent += iterations
            if found is None:
                step = (following - done) / 2.0
            else:
                z, done, step = found, following, 2.0 * step
        return z, spent


def stable(hessian: Array) -> bool:
    """Whether a Hessian belongs to a stable state; rows are scaled, since EA and EI differ by orders of magnitude."""
    largest = np.abs(hessian).max(axis=1)
    if not np.all(np.isfinite(hessian)) or largest.min() == 0.0:
        return False
    scale = 1.0 / np.sqrt(largest)
    values = np.linalg.eigvalsh(scale[:, None] * hessian * scale)
    return bool(values[1] < 0.0 < values[2])


def rod_of(stretch: float, shear: float) -> Rod:
    """Return a rod whose points `s = (exp(g xi) - 1)/(exp(g) - 1)` resolve the layer of a rod stretched to twice its length."""
    g = float(np.log1p(min(stretch**-0.5, 1e6) / 12.0))
    x, w = legendre.leggauss(POINTS)
    density = g * np.exp(g * (x + 1.0) / 2.0) / np.expm1(g)
    return Rod(stretch, shear, w / 2.0 * density, integrals(x, POINTS) * density)


def rod_with_tied_tip(points: ArrayLike, *, EA: float, GA: float, EI: float, length: float = 1.0) -> Tied:
    """Return the equilibria at the vertices (s, 2) of the tip's path, which starts at the undeformed tip `(length, 0)`."""
    rod, unit = rod_of(EI / length**2 / EA, EI / length**2 / GA), EI / length**2
    displacements = np.asarray(points, dtype=np.float64) / length - [1.0, 0.0]
    states: list[Array | None] = [np.zeros(POINTS + 2)]
    iterations = [0]
    for start, end in pairwise(displacements):
        state, spent = (None, 0) if states[-1] is None else rod.advanced(states[-1], start, end)
        states.append(state)
        iterations.append(spent)
    z = np.array([np.full(POINTS + 2, np.nan) if state is None else state for state in states])
    moments = [rod.equations(*pair)[2] for pair in zip(z, displacements, strict=True)]
    return Tied(
        force=unit * z[:, -2:],
        clamp_moment=-unit * length * np.array(moments),
        tip_rotation=z[:, :-2] @ rod.weights,
        iterations=np.array(iterations),
        rotations=z[:, :-2] @ rod.left.T,
    )

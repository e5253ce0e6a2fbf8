"""A clamped Reissner rod with loads along it, natural curvature, taper and a pin, by shooting. It shares no code with the package."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import root

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Rod:
    """A rod of rectangular section, clamped at the origin, with its undeformed axis a circular arc.

    The axis has a length, an angle at the clamp, and turns to the left up to the tip. Height and width are those at clamp and tip, linear
    between; the shear factor is 5/6. A load is the force per length (2,) over the arc length over the length, and where it begins and
    ends, over the length. At the tip there is a dead force and moment.
    """

    length: float = 1.0
    direction: float = 0.0
    turn: float = 0.0
    height: tuple[float, float]
    width: tuple[float, float]
    youngs_modulus: float
    shear_modulus: float
    loads: tuple[tuple[Callable[[float], Array], float, float], ...] = ()
    tip: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def stiffness(self, s):
        """EA, GA, EI."""
        x = s / self.length
        h, b = (a + (c - a) * x for a, c in (self.height, self.width))
        E, G = self.youngs_modulus, self.shear_modulus
        return E * b * h, 5 / 6 * G * b * h, E * b * h**3 / 12

    def slope(self, s, z):
        """Derivatives of x, y, angle, moment and force (2)."""
        EA, GA, EI = self.stiffness(s)
        c, sn = math.cos(z[2]), math.sin(z[2])
        N, Q = z[4] * c + z[5] * sn, z[5] * c - z[4] * sn
        x, y = (1 + N / EA) * c - Q / GA * sn, (1 + N / EA) * sn + Q / GA * c
        x_load = y_load = 0.0
        for load, begin, end in self.loads:
            if begin <= s / self.length <= end:
                px, py = load(s / self.length)
                x_load, y_load = x_load + px, y_load + py
        # m' = - r' x n
        turn = z[3] / EI + self.turn / self.length
        return np.array([x, y, turn, y * z[4] - x * z[5], -x_load, -y_load])

    def carry(self, z, begin, end):
        """State at one arc position from the state at another; no interval has the end of a load inside."""
        ends = sorted({self.length * part for _, a, b in self.loads for part in (a, b)})
        stops = [begin, *(stop for stop in ends if begin < stop < end), end]
        for a, b in pairwise(stops):
            if b > a:
                inside = math.nextafter(a, b), math.nextafter(b, a)
                z = solve_ivp(self.slope, inside, z, method="DOP853", rtol=3e-14, atol=1e-15).y[:, -1]
        return z

    def tangent(self, s, z):
        return self.slope(s, z)[:2]


@dataclass(frozen=True, kw_only=True)
class Shot:
    """Equilibrium: force and moment at the clamp, tip (x, y, angle), and with a pin its force on the rod and the arc position."""

    clamp: Array
    tip: Array
    force: Array
    arc: float


def free(rod, guess):
    """Equilibrium without a pin, from a guess of force and moment at the clamp."""

    def end(clamp):
        return rod.carry(np.array([0.0, 0.0, rod.direction, clamp[2], *clamp[:2]]), 0.0, rod.length)

    clamp = _solved(lambda z: end(z)[[4, 5, 3]] - np.array(rod.tip), guess)
    return Shot(clamp=clamp, tip=end(clamp)[:3], force=np.zeros(2), arc=math.nan)


def pinned(rod, pin, reach, guess):
    """Equilibrium with a pin at a distance from the axis, given at clamp and tip and linear between.

    The distance to the pin, less the distance that is given, is zero and stationary along the rod. `guess` has force and moment at the
    clamp, force of the pin on the rod, arc position.
    """
    rise = (reach[1] - reach[0]) / rod.length

    def ends(z):
        before = rod.carry(np.array([0.0, 0.0, rod.direction, z[2], *z[:2]]), 0.0, z[5])
        after = before - np.array([0, 0, 0, 0, z[3], z[4]])
        return before, after, rod.carry(after, z[5], rod.length)

    def residual(z):
        before, after, tip = ends(z)
        mean = rod.tangent(z[5], before) + rod.tangent(z[5], after)
        away = -z[3:5] / np.hypot(*z[3:5])
        surface = before[:2] + (reach[0] + rise * z[5]) * away
        return np.array([*(tip[[4, 5, 3]] - np.array(rod.tip)), *(surface - pin), away @ mean / 2 + rise])

    z = _solved(residual, guess)
    return Shot(clamp=z[:3], tip=ends(z)[2][:3], force=z[3:5], arc=float(z[5]))


def _solved(residual, guess):
    found = root(residual, guess, tol=1e-13)
    z = np.asarray(found.x)
    # two steps of Newton's method by central differences
    for _ in range(2):
        columns = [(residual(z + d) - residual(z - d)) / 2e-5 for d in 1e-5 * np.eye(len(z))]
        z = z - np.linalg.solve(np.array(columns).T, residual(z))
    assert np.abs(residual(z)).max() < 1e-11, np.abs(residual(z)).max()
    return z

"""Reissner's rods by a Runge-Kutta method: what every exact answer must agree with. It shares no code with the packages."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import root

Array = NDArray[np.float64]
RIGID = {"EA": np.inf, "GA": np.inf, "EI": 1.0}
KS = {"EA": 8.4, "GA": 5.0 / 6.0 * 8.4 / 2.6, "EI": 2.8e-4}
"""Section of the cantilever of Konyukhov and Schweizerhof, whose length is 1."""


def ks_pins(t: Sequence[float] | Array, offset: float = 0.0) -> Array:
    """Return places (s, 2) of their pin."""
    t = np.asarray(t)
    return np.stack([1.0 - t, 2.0 * t / np.pi - offset], axis=1)


def rates(
    z: Array, EA: float, GA: float, EI: float, turn: float = 0.0, load: Sequence[float] = (0.0, 0.0)
) -> list[float]:
    """Return derivatives by arc length of x, y, angle, moment, force (2) and strain energy: `m' = - r' x n`."""
    _, _, theta, moment, nx, ny, _ = z
    c, s = math.cos(theta), math.sin(theta)
    N, Q = nx * c + ny * s, ny * c - nx * s
    dx, dy = (1.0 + N / EA) * c - Q / GA * s, (1.0 + N / EA) * s + Q / GA * c
    energy = (N**2 / EA + Q**2 / GA + moment**2 / EI) / 2.0
    return [dx, dy, moment / EI + turn, dy * nx - dx * ny, -load[0], -load[1], energy]


def shot(
    force: Sequence[float] | Array, start: Sequence[float], length: float, *, EA: float, GA: float, EI: float
) -> tuple[Array, Array]:
    """Return `x, y, theta, m` and the strain energy (5,) after a length, from `x, y, theta, m`, and the strained tangent (2,) there."""
    moment = min(abs(start[3]) or 1.0, 1.0)
    scale = 1e-15 * np.array([1.0, 1.0, 1.0, moment, 1.0, 1.0, moment])
    begin = [*start, *force, 0.0]
    end = solve_ivp(lambda _, z: rates(z, EA, GA, EI), (0.0, length), begin, method="DOP853", rtol=1e-13, atol=scale).y[:, -1]  # fmt: skip
    return end[[0, 1, 2, 3, 6]], np.array(rates(end, EA, GA, EI)[:2])


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

    def slope(self, s: float, z: Array) -> list[float]:
        """Return the `rates` at an arc position."""
        x = s / self.length
        h, b = (a + (c - a) * x for a, c in (self.height, self.width))
        E, G = self.youngs_modulus, self.shear_modulus
        load = sum((at(x) for at, begin, end in self.loads if begin <= x <= end), np.zeros(2))
        return rates(z, E * b * h, 5 / 6 * G * b * h, E * b * h**3 / 12, self.turn / self.length, load)

    def carry(self, z: Array, begin: float, end: float) -> Array:
        """Return the state at one arc position from the state at another; no interval has the end of a load inside."""
        ends = sorted({self.length * part for _, a, b in self.loads for part in (a, b)})
        for a, b in pairwise([begin, *(stop for stop in ends if begin < stop < end), end]):
            if b > a:
                inside = math.nextafter(a, b), math.nextafter(b, a)
                z = solve_ivp(self.slope, inside, z, method="DOP853", rtol=3e-14, atol=1e-15).y[:, -1]
        return z

    def clamped(self, clamp: Array, end: float) -> Array:
        """Return the state at an arc position from force and moment at the clamp."""
        nx, ny, moment = clamp
        return self.carry(np.array([0.0, 0.0, self.direction, moment, nx, ny, 0.0]), 0.0, end)

    def at_tip(self, z: Array) -> Array:
        """Return force and moment there, less those given."""
        return z[[4, 5, 3]] - np.array(self.tip)


@dataclass(frozen=True, kw_only=True)
class Shot:
    """Equilibrium: force and moment at the clamp, tip (x, y, angle), and with a pin its force on the rod and the arc position."""

    clamp: Array
    tip: Array
    force: Array
    arc: float


def free(rod: Rod, guess: Array) -> Shot:
    """Return the equilibrium without a pin, from a guess of force and moment at the clamp."""
    clamp = _solved(lambda z: rod.at_tip(rod.clamped(z, rod.length)), guess)
    return Shot(clamp=clamp, tip=rod.clamped(clamp, rod.length)[:3], force=np.zeros(2), arc=math.nan)


def pinned(rod: Rod, pin: Array, reach: tuple[float, float], guess: Array) -> Shot:
    """Return the equilibrium with a pin at a distance from the axis, given at clamp and tip and linear between.

    The distance to the pin, less the distance that is given, is zero and stationary along the rod. `guess` has force and moment at the
    clamp, force of the pin on the rod, arc position.
    """
    rise = (reach[1] - reach[0]) / rod.length

    def ends(z: Array) -> tuple[Array, Array, Array]:
        before = rod.clamped(z[:3], z[5])
        after = before - np.array([0, 0, 0, 0, z[3], z[4], 0])
        return before, after, rod.carry(after, z[5], rod.length)

    def residual(z: Array) -> Array:
        before, after, tip = ends(z)
        mean = np.add(rod.slope(z[5], before)[:2], rod.slope(z[5], after)[:2]) / 2.0
        away = -z[3:5] / np.hypot(*z[3:5])
        surface = before[:2] + (reach[0] + rise * z[5]) * away
        return np.array([*rod.at_tip(tip), *(surface - pin), away @ mean + rise])

    z = _solved(residual, guess)
    return Shot(clamp=z[:3], tip=ends(z)[2][:3], force=z[3:5], arc=float(z[5]))


def tied(tip: Array, guess: Array, **section: float) -> Array:
    """Return moment and force (3,) at the clamp of a straight rod of length 1 whose tip is hinged to a place, from a guess of them."""
    end = lambda z: shot(z[1:], [0.0, 0.0, 0.0, z[0]], 1.0, **section)[0]  # noqa: E731
    return _solved(lambda z: end(z)[[0, 1, 3]] - [*tip, 0.0], guess)


def _solved(residual: Callable[[Array], Array], guess: Array) -> Array:
    z = np.asarray(root(residual, guess, tol=1e-13).x)
    # two steps of Newton's method by central differences
    for _ in range(2):
        columns = [(residual(z + d) - residual(z - d)) / 2e-5 for d in 1e-5 * np.eye(len(z))]
        z = z - np.linalg.solve(np.array(columns).T, residual(z))
    assert np.abs(residual(z)).max() < 1e-11, np.abs(residual(z)).max()
    return z

"""A Reissner cantilever under a pin with friction, by shooting: the reference of the friction's tests.

From the contact at s to the clamp the internal force is the contact force F, and beyond the contact the rod is free. The pin
touches along the mean of both tangents, ``t ~ r'_- + r'_+``, from the right, ``F = N n + T t``. It touches the axis, or a face
at the distance `lever` from it.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

from tests.fem_reference.conftest import NU, B, E

EA, GA, EI = E * B * 0.02, 5 / 6 * E / (2 * (1 + NU)) * B * 0.02, E * B * 0.02**3 / 12


@dataclass(frozen=True)
class Touch:
    """Components of the contact force along normal and tangent [N], arc position [m] and section angle at the contact."""

    N: float
    T: float
    s: float
    angle: float

    @property
    def force(self):
        return float(np.hypot(self.N, self.T))


def _strained(force, angle):
    """Derivative ``r'`` under the internal ``force``, as a complex number."""
    local = force * np.exp(-1j * angle)
    return np.exp(1j * angle) * (1 + local.real / EA + 1j * local.imag / GA)


def _frame(at):
    """Contact force and unit tangent, as complex numbers."""
    tangent = _strained(0.0, at.angle)
    for _ in range(20):  # the tangent depends on the force by a strain
        force = (1j * at.N + at.T) * tangent / abs(tangent)
        tangent = _strained(force, at.angle) + np.exp(1j * at.angle)
    return force, tangent / abs(tangent)


def _misses(at, pin, lever=0.0, radius=0.0):
    """Position, and angle, of the rod's start relative to the clamp."""
    force, tangent = _frame(at)
    touched = pin + radius * 1j * tangent
    axis = touched + lever * 1j * tangent

    def slope(_, y):
        moment = ((touched - (y[0] + 1j * y[1])).conjugate() * force).imag
        r1 = _strained(force, y[2])
        return [-r1.real, -r1.imag, -moment / EI]

    start = [axis.real, axis.imag, at.angle]
    return solve_ivp(slope, (0, at.s), start, rtol=1e-11, atol=1e-13, method="DOP853").y[:, -1]


def slipping(pin, mu, guess, **touch):
    """Equilibrium with the pin at a complex position and ``T = mu N``; mu has the sign of the slip."""
    scale = guess.N

    def equations(x):
        return _misses(Touch(N=x[0] * scale, T=mu * x[0] * scale, s=x[1], angle=x[2]), pin, **touch)

    found = root(equations, [1.0, guess.s, guess.angle], tol=1e-12)
    assert np.abs(found.fun).max() < 1e-9
    N = float(found.x[0]) * scale
    return Touch(N=N, T=mu * N, s=float(found.x[1]), angle=float(found.x[2]))


def sticking(pin, s, guess):
    """Equilibrium with the pin at a complex position and the arc position s."""
    scale = guess.N

    def equations(x):
        return _misses(Touch(N=x[0] * scale, T=x[1] * scale, s=s, angle=x[2]), pin)

    found = root(equations, [1.0, guess.T / scale, guess.angle], tol=1e-12)
    assert np.abs(found.fun).max() < 1e-9
    return Touch(N=float(found.x[0]) * scale, T=float(found.x[1]) * scale, s=s, angle=float(found.x[2]))


def ks_path(mu, stick, load_parameters):
    """Equilibria on the path of the KS scene, whose pin slips towards the clamp, sticks from ``stick[0]`` to ``stick[1]``, and slips back."""
    touches, last = {}, Touch(N=3 * EI * 0.05, T=0.0, s=0.97, angle=0.05)
    steps = np.unique(np.concatenate([np.linspace(0.04, 1, 25), load_parameters, stick if mu else []]))
    rest = 0.0
    for t in steps[steps >= 0.04]:
        pin = (1 - t) + 2j / np.pi * t
        if mu and stick[0] < t <= stick[1]:
            last = sticking(pin, rest, last)
        else:
            last = slipping(pin, -mu if t <= stick[0] else mu, last)
            rest = last.s
        touches[float(t)] = last
    return [touches[float(t)] for t in load_parameters]

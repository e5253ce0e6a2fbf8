"""The numbers of ``ks_rod.toml`` by shooting: ``python -m tests.reference.ks_rod`` prints the file.

The rod is integrated from the clamp by an explicit Runge-Kutta method of order eight (SciPy's DOP853), in dimensional quantities, and shot at the
pin. Nothing of `comparisons`, `tsm` or `fem_reference` is used.

With the force F at the section, N and Q along and across it, ``x' = (1 + N/EA) cos theta - Q/GA sin theta``,
``y' = (1 + N/EA) sin theta + Q/GA cos theta``, ``theta' = M/EI`` and ``M' = F_x y' - F_y x'``. Unknown are the clamp's moment, F and the arc
position s of the pin; known are ``M(s) = 0``, the pin's place ``r(s) - d F/|F|`` at the distance d from the axis, and a force
normal to the mean of the tangents before and behind it.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

STORED = Path(__file__).with_suffix(".toml")
E, H = 2.1e4, 0.02
EA, EI = E * H**2, E * H**4 / 12
GA = 5 / 6 * E / 2.6 * H**2
TIMES = (0.1, 0.25, 0.5, 0.75, 1.0)
OFFSETS = {"axis": 0.0, "face": H / 2}


def strains(theta, force):
    """Derivatives x' and y' of the centre line."""
    c, s = np.cos(theta), np.sin(theta)
    stretch, shear = 1 + (force @ [c, s]) / EA, (force @ [-s, c]) / GA
    return stretch * c - shear * s, stretch * s + shear * c


def shot(moment, force, arc):
    """Return x, y, theta and M at the pin."""

    def slope(_, y):
        dx, dy = strains(y[2], force)
        return [dx, dy, y[3] / EI, force[0] * dy - force[1] * dx]

    start = [0.0, 0.0, 0.0, moment]
    scale = np.array([1.0, 1.0, 1.0, EI])
    return solve_ivp(slope, (0.0, arc), start, method="DOP853", rtol=3e-14, atol=1e-15 * scale).y[:, -1]


def misses(z, pin, offset):
    """What the four conditions miss, dimensionless; z is M L/EI, F L^2/EI and s/L."""
    force = EI * z[1:3]
    x, y, theta, moment = shot(EI * z[0], force, z[3])
    unit = force / np.hypot(*force)
    before, behind = np.array(strains(theta, force)), np.array([np.cos(theta), np.sin(theta)])
    return [*(np.array([x, y]) - offset * unit - pin), moment / EI, float(unit @ (before + behind))]


def path(offset, last=TIMES[-1]):
    """Return contact forces [N] and arc positions [m] at `TIMES` up to the last, each found from the one before in small steps."""
    z = np.array([3 * 0.005, 0.0, 3 * 0.005, 0.995])  # a small lift of the tip
    forces, arcs = [], []
    for t in 0.005 * np.arange(1, round(last / 0.005) + 1):
        pin = np.array([1 - t, t * 2 / np.pi - offset])
        found = root(misses, z, args=(pin, offset), tol=1e-14)
        assert np.abs(misses(found.x, pin, offset)).max() < 1e-11, (t, found.message)
        z = found.x
        if np.abs(np.array(TIMES) - t).min() < 1e-9:
            forces.append(float(EI * np.hypot(*z[1:3])))
            arcs.append(float(z[3]))
    return forces, arcs


def text():
    """Return the file."""
    lines = [
        "# Konyukhov-Schweizerhof cantilever as a Reissner rod, kappa = 5/6, G = E/2.6, pin from (1, -offset) by (-1, 2/pi).",
        "# Contact force [N] and arc position [m] by shooting, by python -m tests.reference.ks_rod; a second source for what",
        "# comparisons.exact computes.",
    ]
    for name, offset in OFFSETS.items():
        forces, arcs = path(offset)
        lines += [
            f"{'' if name == 'axis' else chr(10)}[{name}]",
            f"offset = {offset}",
            f"load_parameter = {list(TIMES)}",
            f"force = [{', '.join(f'{value:.12e}' for value in forces)}]",
            f"arc_position = [{', '.join(f'{value:.10f}' for value in arcs)}]",
        ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(text())

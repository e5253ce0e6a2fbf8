"""Frames without branches under one dead load: Reissner rods, joined rigidly, by shooting at prescribed deflections.

All rods have the same section. A rod has the angle `a` of its undeformed axis, the rotation theta of its sections, the section axes
`d1 = (cos(a + theta), sin(a + theta))` and `d2` to the left of d1, and the internal force n:

    theta' = m/EI,   r' = (1 + n.d1/EA) d1 + (n.d2/GA) d2,   m' = -r' x n

n is constant, except that it changes by `-P d` at the joint with the load `P d`. The four unknowns are n and the moment (at a hinge the
rotation) at the first support, and P. The four equations prescribe the position of the last support, its rotation (at a hinge the
moment) and the deflection of the loaded joint along d. With a prescribed deflection, limit points of the load are regular points.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

# the equations of one rod, which the exact answers of the product share
from comparisons.exact.section import Array, Flexibility, Section, integrate
from comparisons.scene import Scene, load_scene
from tests.oracles.newton import State, advanced


@dataclass(frozen=True, kw_only=True)
class Frame:
    """Joints from support to support, the index of the loaded one, the load's direction, and the section of all rods."""

    joints: tuple[tuple[float, float], ...]
    loaded: int
    clamped: bool
    EA: float
    GA: float
    EI: float
    direction: tuple[float, float] = (0.0, -1.0)

    @property
    def size(self) -> float:
        """Length of all rods. The equations have the units `size` and `EI/size^2`."""
        return float(np.hypot(*np.diff(self.joints, axis=0).T).sum())

    @property
    def unit(self) -> float:
        """Unit of force."""
        return self.EI / self.size**2

    def residual(self, unknowns: Array, deflection: float) -> Array:
        """Residual (4, c) of the four equations for columns of unknowns (4, c)."""
        start, nx, ny, load = unknowns
        joints, zero = np.array(self.joints) / self.size, np.zeros_like(start)
        rods = np.diff(joints, axis=0)
        flexibility = Flexibility(stretch=self.unit / self.EA, shear=self.unit / self.GA)
        rotation, moment = (zero, start) if self.clamped else (start, zero)
        section, excess = Section(joints[0, 0] + zero, joints[0, 1] + zero, rotation, moment), zero
        for k, (rod, angle) in enumerate(zip(rods, np.arctan2(*rods.T[::-1]), strict=True)):
            section = section._replace(theta=section.theta + angle)
            section = integrate(section, (nx, ny), np.hypot(*rod) + zero, flexibility)
            section = section._replace(theta=section.theta - angle)
            if k + 1 == self.loaded:
                (dx, dy), (x, y) = self.direction, joints[k + 1]
                excess = (section.x - x) * dx + (section.y - y) * dy - deflection
                nx, ny = nx - load * dx, ny - load * dy
        last = section.theta if self.clamped else section.moment
        return np.stack([section.x - joints[-1, 0], section.y - joints[-1, 1], last, excess])

    def follow(self, deflections: Sequence[float]) -> list[State]:
        """States at increasing deflections."""
        path = [advanced(self.residual, (0.0, np.zeros(4), np.zeros(4)), 0.0)]
        for deflection in deflections:
            path.append(advanced(self.residual, path[-1], float(deflection) / self.size))
        return path[1:]

    def load(self, deflections: Sequence[float]) -> Array:
        """Load P at increasing deflections of the loaded joint along the load."""
        return np.array([unknowns[3] for _, unknowns, _ in self.follow(deflections)]) * self.unit

    def roots(
        self, deflections: Sequence[float], value: Callable[[Array, Array], float]
    ) -> list[tuple[float, float]]:
        """Deflection and load where a function of unknowns and rates vanishes between two deflections."""
        found = []
        for one, other in pairwise(self.follow(deflections)):
            if value(*one[1:]) * value(*other[1:]) < 0.0:
                at = lambda d, one=one: value(*advanced(self.residual, one, d)[1:])  # noqa: E731
                d = float(brentq(at, one[0], other[0], xtol=1e-13))
                found.append((d * self.size, float(advanced(self.residual, one, d)[1][3]) * self.unit))
        return found

    def limits(self, deflections: Sequence[float]) -> list[float]:
        """Loads at the limit points on the way."""
        return [load for _, load in self.roots(deflections, lambda _, rates: rates[3])]


def frame_of(scene: Scene, *, end: str, direction: tuple[float, float] = (0.0, -1.0)) -> Frame:
    """Return the frame of a scene, loaded where a beam of this name ends."""
    first = scene.beams[0]
    return Frame(
        joints=(first.start, *(beam.end for beam in scene.beams)),
        loaded=1 + [beam.name for beam in scene.beams].index(end),
        direction=direction,
        clamped=bool(first.clamped),
        EA=first.EA,
        GA=first.GA,
        EI=first.EI,
    )


def lee() -> Frame:
    """Return Lee's frame, in kN and cm."""
    return frame_of(load_scene("lees-frame"), end="near")


def toggle() -> Frame:
    """Return Williams' toggle, in lb and in."""
    return frame_of(load_scene("williams-toggle"), end="left")


def lee_limit() -> float:
    """Return `P L^2/EI` at the limit point of Lee's frame."""
    (load,) = lee().limits(np.linspace(6.0, 54.0, 9))
    return load * 120.0**2 / lee().EI


def toggle_limits() -> list[float]:
    """Return the greatest load of Williams' toggle and the least one after it [lb]."""
    return toggle().limits(np.linspace(0.05, 0.5, 10))


def portal_sway() -> float:
    """Return the displacement of the portal frame's loaded corner [mm]."""
    scene = load_scene("portal-frame")
    frame, whole = frame_of(scene, end="left", direction=(1.0, 0.0)), scene.loads[0].force[0]
    ((aside, _),) = frame.roots(np.linspace(25.0, 125.0, 5), lambda z, _: z[3] - whole / frame.unit)
    return aside

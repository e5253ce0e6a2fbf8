"""A chain of rigidly joined Reissner rods between two supports under one dead load, for frames that snap through.

All rods have the same section. A rod has the angle `a` of its undeformed axis, the rotation theta of its sections, the section axes
`d1 = (cos(a + theta), sin(a + theta))` and `d2` to the left of d1, and the internal force n:

    theta' = m/EI,   r' = (1 + n.d1/EA) d1 + (n.d2/GA) d2,   m' = -r' x n

n is constant, except that it changes by `-P d` at the joint with the load `P d`, d a unit vector. The equations are solved by shooting. They
are integrated from the first support to the last by spectral collocation. The four unknowns are n and the moment (at a hinge the
rotation) at the first support, and P. The four equations prescribe the position of the last support, its rotation (at a hinge
the moment) and the deflection of the loaded joint along d. With a prescribed deflection, limit points of the load are regular points.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from comparisons.exact.checks import require_positive, require_stiffness
from comparisons.exact.reissner import COMPLEX_STEP, Flexibility
from comparisons.exact.section import Section, integrate

Array = NDArray[Any]  # real or complex: derivatives are complex steps


@dataclass(frozen=True, kw_only=True)
class Chain:
    """A frame without branches.

    Attributes
    ----------
    joints : tuple of (float, float)
        Positions from the first support to the last.
    loaded : int
        Index of the loaded joint.
    direction : (float, float)
        Unit vector d of the load, downwards by default.
    clamped : bool
        Whether both supports are clamped; otherwise they are hinges.
    EA, GA, EI : float
        Stiffnesses of all rods; `inf` is rigid.

    Raises
    ------
    ValueError
        If a stiffness is not positive, the loaded joint is a support, or the direction is no unit vector.
    """

    joints: tuple[tuple[float, float], ...]
    loaded: int
    clamped: bool
    EA: float
    GA: float
    EI: float
    direction: tuple[float, float] = (0.0, -1.0)

    def __post_init__(self) -> None:
        require_positive(EI=self.EI)
        require_stiffness(EA=self.EA, GA=self.GA)
        if not 0 < self.loaded < len(self.joints) - 1:
            raise ValueError(f"loaded = {self.loaded}: must be a joint between the supports")
        if abs(math.hypot(*self.direction) - 1.0) > 1e-12:
            raise ValueError(f"direction = {self.direction}: must be a unit vector")

    @property
    def size(self) -> float:
        """Total length of the rods. The equations have the units `size` of length and `EI/size^2` of force."""
        return float(np.hypot(*np.diff(self.joints, axis=0).T).sum())


def load_path(chain: Chain, deflections: ArrayLike) -> NDArray[np.float64]:
    """Return the load P at increasing deflections of the loaded joint along the load, shape (s,).

    Raises
    ------
    ArithmeticError
        If shooting does not converge; smaller steps of the deflection may help.

    Examples
    --------
    >>> beam = Chain(joints=((0, 0), (0.5, 0), (1, 0)), loaded=1, clamped=True, EA=1e4, GA=np.inf, EI=1.0)
    >>> round(float(load_path(beam, [1e-5])[0] / 1e-5), 3)  # 192 EI/L^3
    192.0
    """
    unknowns: Array = np.zeros(4)
    path: list[Array] = []
    for deflection in np.asarray(deflections, dtype=np.float64):
        predicted = 2.0 * path[-1] - path[-2] if len(path) > 1 else unknowns
        unknowns = _equilibrium(chain, predicted, float(deflection) / chain.size)
        path.append(unknowns)
    return np.array(path).reshape(-1, 4)[:, 3] * chain.EI / chain.size**2


def _equilibrium(chain: Chain, unknowns: Array, deflection: float) -> Array:
    """Return the unknowns (4,) at a deflection in units of `size`, by Newton's method from nearby ones."""
    for _ in range(30):
        steps = unknowns[:, None] + 1j * COMPLEX_STEP * np.eye(4)
        matrix = _end_residual(chain, steps, deflection).imag / COMPLEX_STEP
        change = np.linalg.solve(matrix, -_end_residual(chain, unknowns[:, None] + 0j, deflection).real[:, 0])
        unknowns = unknowns + change
        if np.abs(change).max() <= 1e-11 * (1.0 + np.abs(unknowns).max()):
            return unknowns
        if not np.isfinite(change).all():
            break
    raise ArithmeticError(f"no equilibrium at the deflection {deflection * chain.size:g}")


@np.errstate(invalid="ignore", over="ignore")
def _end_residual(chain: Chain, unknowns: Array, deflection: float) -> Array:
    """Residual (4, c) of the four equations for columns of unknowns (4, c), in units of `size` and EI."""
    start, nx, ny, load = unknowns
    joints, zero = np.array(chain.joints) / chain.size, np.zeros_like(start)
    rods = np.diff(joints, axis=0)
    angles = np.arctan2(*rods.T[::-1])
    scale = chain.EI / chain.size**2
    flexibility = Flexibility(stretch=scale / chain.EA, shear=scale / chain.GA)
    rotation, moment = (zero, start) if chain.clamped else (start, zero)
    section = Section(joints[0, 0] + zero, joints[0, 1] + zero, rotation, moment)
    excess = zero
    for k, (rod, angle) in enumerate(zip(rods, angles, strict=True)):
        start_of_rod = section._replace(theta=section.theta + angle)
        section = integrate(start_of_rod, (nx, ny), np.hypot(*rod) + zero, flexibility)
        section = section._replace(theta=section.theta - angle)
        if k + 1 == chain.loaded:
            dx, dy = chain.direction
            x, y = joints[k + 1]
            excess = (section.x - x) * dx + (section.y - y) * dy - deflection
            nx, ny = nx - load * dx, ny - load * dy
    last = section.theta if chain.clamped else section.moment
    return np.stack([section.x - joints[-1, 0], section.y - joints[-1, 1], last, excess])

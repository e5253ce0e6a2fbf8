"""A chain of Reissner rods from support to support under one dead load: frames that snap through.

Rods of one section are rigidly joined. Along each, with the angle `a` of its undeformed axis and the rotation theta of its sections,
`d1 = (cos(a + theta), sin(a + theta))`, `d2` to the left of it and the internal force n:

    theta' = m/EI,   r' = (1 + n.d1/EA) d1 + (n.d2/GA) d2,   m' = -r' x n

n is constant but for the joint that carries the load `(0, -P)`, where it grows by `(0, P)`. Shooting: from the first support the equations are
integrated to the last, by spectral collocation. What is not known there, n and the moment (or the rotation, of a hinge), and P are the four unknowns; the last support's
place, its rotation (or moment) and the prescribed deflection of the loaded joint are the four equations. The deflection is prescribed and
the load follows, so that limit points of the load are ordinary points.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from comparisons.exact.checks import require_positive
from comparisons.exact.reissner import COMPLEX_STEP, Flexibility
from comparisons.exact.section import Section, integrate

Array = NDArray[Any]  # real or complex: derivatives are complex steps


@dataclass(frozen=True, kw_only=True)
class Chain:
    """A frame without branches.

    Attributes
    ----------
    joints : tuple of (float, float)
        From support to support.
    loaded : int
        Number of the joint that is pressed down.
    clamped : bool
        Whether both supports are clamps; else they are hinges.
    EA, GA, EI : float
        Stiffnesses of all rods; `inf` is rigid.

    Raises
    ------
    ValueError
        If a stiffness is not positive, or the loaded joint is a support.
    """

    joints: tuple[tuple[float, float], ...]
    loaded: int
    clamped: bool
    EA: float
    GA: float
    EI: float

    def __post_init__(self) -> None:
        require_positive(EI=self.EI)
        for name, value in (("EA", self.EA), ("GA", self.GA)):
            if not value > 0.0:
                raise ValueError(f"{name} = {value}: must be positive")
        if not 0 < self.loaded < len(self.joints) - 1:
            raise ValueError(f"loaded = {self.loaded}: must be a joint between the supports")

    @property
    def size(self) -> float:
        """Length of all rods: the unit of lengths in the equations, EI/size^2 that of forces."""
        return float(np.hypot(*np.diff(self.joints, axis=0).T).sum())


def load_path(chain: Chain, deflections: ArrayLike) -> NDArray[np.float64]:
    """Return the load P at increasing deflections of the loaded joint, shape (s,).

    Raises
    ------
    ArithmeticError
        If shooting finds no equilibrium; smaller steps of the deflection may.

    Examples
    --------
    >>> beam = Chain(joints=((0, 0), (0.5, 0), (1, 0)), loaded=1, clamped=True, EA=1e4, GA=np.inf, EI=1.0)
    >>> round(float(load_path(beam, [1e-5])[0] / 1e-5), 3)  # 192 EI/L^3
    192.0
    """
    unknowns: Array = np.zeros(4)
    found: list[Array] = []
    for deflection in np.asarray(deflections, dtype=np.float64):
        ahead = 2.0 * found[-1] - found[-2] if len(found) > 1 else unknowns
        unknowns = _equilibrium(chain, ahead, float(deflection) / chain.size)
        found.append(unknowns)
    return np.array(found).reshape(-1, 4)[:, 3] * chain.EI / chain.size**2


def _equilibrium(chain: Chain, unknowns: Array, deflection: float) -> Array:
    for _ in range(30):
        steps = unknowns[:, None] + 1j * COMPLEX_STEP * np.eye(4)
        matrix = _misses(chain, steps, deflection).imag / COMPLEX_STEP
        change = np.linalg.solve(matrix, -_misses(chain, unknowns[:, None] + 0j, deflection).real[:, 0])
        unknowns = unknowns + change
        if np.abs(change).max() <= 1e-11 * (1.0 + np.abs(unknowns).max()):
            return unknowns
        if not np.isfinite(change).all():
            break
    raise ArithmeticError(f"no equilibrium at the deflection {deflection * chain.size:g}")


@np.errstate(invalid="ignore", over="ignore")
def _misses(chain: Chain, unknowns: Array, deflection: float) -> Array:
    """What the four equations miss at columns of unknowns (4, c), in units of size and EI; shape (4, c)."""
    start, nx, ny, load = unknowns
    joints, nothing = np.array(chain.joints) / chain.size, np.zeros_like(start)
    rods = np.diff(joints, axis=0)
    angles = np.arctan2(*rods.T[::-1])
    scale = chain.EI / chain.size**2
    flexibility = Flexibility(stretch=scale / chain.EA, shear=scale / chain.GA)
    rotation, moment = (nothing, start) if chain.clamped else (start, nothing)
    at = Section(joints[0, 0] + nothing, joints[0, 1] + nothing, rotation, moment)
    missed = nothing
    for k, (rod, angle) in enumerate(zip(rods, angles, strict=True)):
        turned = at._replace(theta=at.theta + angle)
        at = integrate(turned, (nx, ny), np.hypot(*rod) + nothing, flexibility)
        at = at._replace(theta=at.theta - angle)
        if k + 1 == chain.loaded:
            missed = at.y - joints[k + 1, 1] + deflection
            ny = ny + load
    last = at.theta if chain.clamped else at.moment
    return np.stack([at.x - joints[-1, 0], at.y - joints[-1, 1], last, missed])

"""Two cantilevers in contact: a pin pushes the first rod, whose tip pushes the second.

Both rods have the same section and length, are clamped at x = 0 and lie along +x, the first at y = 0 and the second at y = spacing.
The pin moves from (pin_x, 0) along +y, so that its depth is y. In the coupled stage both contacts are closed. It begins when the
first rod's tip touches the second rod. The second rod is a single rod under a pin, solved by the quadratures of
`comparisons.exact.reissner` with the unknowns `(q, ell)`. The first rod carries the force n from its clamp to the pin and minus
the tip force T from the pin to its tip. Its equations are integrated by spectral collocation. With the force `P = n + T` of the
pin and its arc position s, the six unknowns `q, ell, m(0), n_x, n_y, s` satisfy

    r(s) = pin,   P.(r'_- + r'_+) = 0,   m(L) = 0,   r(L) = point of the second rod under the tip
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from comparisons.exact.checks import require_positive
from comparisons.exact.reissner import COMPLEX_STEP, Flexibility, loaded_part, normal, position
from comparisons.exact.rod import RodPath, rod_under_pin
from comparisons.exact.section import Section, integrate, tangent

Array = NDArray[Any]

_SMALLEST_STEP = 1e-9


@dataclass(frozen=True, kw_only=True)
class CoupledPath:
    """States of the coupled stage at `s` depths of the pin; nan at depths outside this stage.

    Attributes
    ----------
    depth : ndarray, shape (s,)
        Depth of the pin.
    pin_force, tip_force : ndarray, shape (s, 2)
        Force of the pin on the first rod, and of the first rod's tip on the second.
    pin_arc, tip_arc : ndarray, shape (s,)
        Arc position of the pin on the first rod, and of the tip on the second.
    clamp_moments : ndarray, shape (s, 2)
        Moments of the clamps on the first and the second rod, positive from x towards y.
    tip : ndarray, shape (s, 2)
        Tip of the first rod.
    touch_depth : float
        Depth of the pin at which the first rod's tip touches the second rod.
    end_depth : float
        Depth at which the stage ends, even if it is beyond the requested depths.
    end : str
        Event that ends the stage: "pin at the tip" (the pin leaves the first rod), "tip released" (no force on the second rod),
        "tip slipped" (off the second rod), or "lost" (no equilibrium beyond `end_depth`).
    """

    depth: NDArray[np.float64]
    pin_force: NDArray[np.float64]
    tip_force: NDArray[np.float64]
    pin_arc: NDArray[np.float64]
    tip_arc: NDArray[np.float64]
    clamp_moments: NDArray[np.float64]
    tip: NDArray[np.float64]
    touch_depth: float
    end_depth: float
    end: str


class _Pair(NamedTuple):
    """Dimensionless scene."""

    flexibility: Flexibility
    pin_x: float
    spacing: float

    @np.errstate(divide="ignore", invalid="ignore", over="ignore")
    def residual(self, z: Array, depth: float) -> Array:
        """Residual (..., 6) of the six equations at the unknowns `z` (6, ...)."""
        q, ell, moment, nx, ny, s = (np.asarray(value, dtype=np.complex128) for value in z)
        second = loaded_part(q, ell, self.flexibility)
        under_tip = position(second)
        Tx, Ty = np.moveaxis(second.force[..., None] * normal(second), -1, 0)
        zero = np.zeros_like(s)
        pin = integrate(Section(zero, zero, zero, moment), (nx, ny), s, self.flexibility)
        tip = integrate(pin, (-Tx, -Ty), 1.0 - s, self.flexibility)
        before = tangent(pin.theta, (nx, ny), self.flexibility)
        after = tangent(pin.theta, (-Tx, -Ty), self.flexibility)
        slide = (nx + Tx) * (before[0] + after[0]) + (ny + Ty) * (before[1] + after[1])
        gap = tip.x - under_tip[..., 0], tip.y - under_tip[..., 1] - self.spacing
        return np.stack([pin.x - self.pin_x, pin.y - depth, slide, tip.moment, *gap], axis=-1)

    def solve(self, z: Array, depth: float) -> Array | None:
        """Unknowns at a depth, from nearby ones; None unless Newton's corrections decrease monotonically from below 1."""
        last = 1.0
        for _ in range(12):
            steps = z[:, None] + 1j * COMPLEX_STEP * np.eye(6)
            matrix = self.residual(steps, depth).imag.T / COMPLEX_STEP
            if not np.all(np.isfinite(matrix)) or np.linalg.det(matrix) == 0.0:
                return None
            change = np.linalg.solve(matrix, -self.residual(z, depth).real)
            size = float(np.max(np.abs(change)))
            if not size <= last:
                return None
            z = z + change
            if size < 1e-10:
                return z
            last = size / 2.0
        return None

    def margins(self, z: Array) -> dict[str, float]:
        """Margins of the events that end the stage, positive before the event."""
        tip_arc = float(loaded_part(z[0], z[1], self.flexibility).arc.real)
        return {"pin at the tip": 1.0 - z[5], "tip released": z[0], "tip slipped": 1.0 - tip_arc}


def _touch(single: Callable[[float], RodPath], spacing: float) -> float:
    """Depth at which the first rod's tip touches the second rod."""

    def excess(depth: float) -> float:
        return float(single(depth).tip[-1, 1]) - spacing

    slip_off = single(spacing).slip_off
    deepest = spacing * (1.0 if np.isnan(slip_off) else slip_off - 1e-9)
    if not excess(deepest) > 0.0:
        raise ValueError(f"spacing = {spacing} length: the first rod's tip must reach the second rod")
    return float(brentq(excess, 0.0, deepest, xtol=1e-15))


def _advance(pair: _Pair, z: Array, depth: float, target: float) -> tuple[Array, float, str]:
    """Unknowns at the target, or at the end of the stage before it, with the depth and the event."""
    step = target - depth
    while depth < target:
        following = target if depth + step >= target else depth + step
        trial = pair.solve(z, following)
        if trial is None:
            step /= 2.0
            if step < _SMALLEST_STEP:
                return z, depth, "lost"
            continue
        ends = [
            _locate(pair, z, (depth, following), event)
            for event, value in pair.margins(trial).items()
            if value < 0.0
        ]
        if ends:
            end_depth, event = min(ends)
            return z, end_depth, event
        z, depth = trial, following
    return z, depth, ""


def _locate(pair: _Pair, z: Array, bracket: tuple[float, float], event: str) -> tuple[float, str]:
    """Depth of an event between two depths."""

    def margin(depth: float) -> float:
        trial = pair.solve(z, depth)
        return np.nan if trial is None else pair.margins(trial)[event]

    return float(brentq(margin, *bracket, xtol=1e-14)), event


def coupled_rods(
    depths: ArrayLike, *, pin_x: float, spacing: float, EA: float, GA: float, EI: float, length: float
) -> CoupledPath:
    """Follow the two rods through the coupled stage.

    Parameters
    ----------
    depths : array_like, shape (s,)
        Increasing depths of the pin.
    pin_x : float
        Distance of the pin's path from the clamps.
    spacing : float
        Distance of the rods.
    EA, GA, EI, length : float
        Stiffnesses and length of each rod, as in `comparisons.exact.rod.rod_under_pin`.

    Returns
    -------
    CoupledPath

    Raises
    ------
    ValueError
        If the depths do not increase, or the first rod's tip does not reach the second rod.

    Examples
    --------
    >>> path = coupled_rods([0.31], pin_x=0.8, spacing=0.2, EA=6e3, GA=2142.6, EI=0.44, length=1.0)
    >>> round(path.touch_depth, 6), path.end, round(path.end_depth, 6)
    (0.149786, 'pin at the tip', 0.537111)
    """
    depths = np.asarray(depths, dtype=np.float64)
    require_positive(pin_x=pin_x, spacing=spacing, EI=EI, length=length)
    if depths.ndim != 1 or not np.all(np.isfinite(depths)) or np.any(np.diff(depths) <= 0.0):
        raise ValueError(f"depths, shape {depths.shape}: must be finite, one-dimensional and increasing")
    if pin_x >= length:
        raise ValueError(f"pin_x = {pin_x}: must be less than length = {length}")
    scaled = {"EA": EA * length**2 / EI, "GA": GA * length**2 / EI, "EI": 1.0, "length": 1.0}
    x = pin_x / length

    def single(depth: float) -> RodPath:
        return rod_under_pin([[x, 0.0], [x, depth]], **scaled)

    start = _touch(single, spacing / length)
    first = single(start)
    pair = _Pair(first.flexibility, x, spacing / length)
    z = np.array(
        [
            0.0,
            first.tip[1, 0] / np.sqrt(np.pi),
            -first.clamp_moment[1],
            *first.force[1],
            first.arc_position[1],
        ]
    )
    depth, end, rows = start, "", []
    for target in depths / length:
        if target >= start and not end:
            z, depth, end = _advance(pair, z, depth, float(target))
        rows.append(z if target >= start and not end else np.full(6, np.nan))
    while not end:
        z, depth, end = _advance(pair, z, depth, depth + 0.05)
    return _collect(pair, depths, np.array(rows).reshape(-1, 6), (start, depth, end), EI, length)


def _collect(
    pair: _Pair, depths: Array, rows: Array, stage: tuple[float, float, str], EI: float, length: float
) -> CoupledPath:
    """Return the path in the units of the input."""
    second = loaded_part(rows[:, 0], rows[:, 1], pair.flexibility)
    tip_force = (second.force[:, None] * normal(second)).real
    return CoupledPath(
        depth=depths,
        pin_force=EI / length**2 * (rows[:, 3:5] + tip_force),
        tip_force=EI / length**2 * tip_force,
        pin_arc=length * rows[:, 5],
        tip_arc=length * second.arc.real,
        clamp_moments=-EI / length * np.column_stack([rows[:, 2], (second.force * second.along).real]),
        tip=length * (position(second).real + np.array([0.0, pair.spacing])),
        touch_depth=length * stage[0],
        end_depth=length * stage[1],
        end=stage[2],
    )

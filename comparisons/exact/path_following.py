"""Equilibrium of a dimensionless rod along the path of a pin, with touch, release and slip-off.

At the position `p` of the pin the unknowns `z = (q, ell)` of `comparisons.exact.reissner` satisfy `r(z) - offset f(z) = p`. Here r
is the point of the axis under the pin and f the direction of the contact force. Newton's method with complex-step derivatives
starts from the last position. A step along the path is accepted only if the corrections decrease monotonically from a small
first one, and halved otherwise, so that the solution stays on the branch from the straight rod.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from comparisons.exact.outcome import Outcome
from comparisons.exact.reissner import COMPLEX_STEP, Flexibility, loaded_part, normal, position

Array = NDArray[np.float64]

_TOUCH = 1e-12  # distance, in lengths of the rod, below which the pin touches
_SMALLEST_STEP = 1e-9
_MOST_ITERATIONS = 3000  # on a straight piece; more are spent only near a position without equilibrium


class State(NamedTuple):
    """Contact state and unknowns at one position of the pin."""

    outcome: Outcome
    unknowns: Array = np.full(2, np.nan)


class Rod(NamedTuple):
    """Dimensionless rod and offset."""

    flexibility: Flexibility
    offset: float

    def residual(self, z: NDArray[np.complex128] | Array, pin: Array) -> NDArray[np.complex128]:
        """Residual (..., 2) of the pin's position at the unknowns `z` (2, ...)."""
        part = loaded_part(z[0], z[1], self.flexibility)
        return np.asarray(position(part) - self.offset * normal(part) - pin, dtype=np.complex128)

    def jacobian(self, z: Array) -> Array:
        """Differentiate `residual` by complex steps, shape (2, 2)."""
        steps = z[:, None] + 1j * COMPLEX_STEP * np.eye(2)
        return np.asarray(self.residual(steps, np.zeros(2)).imag.T / COMPLEX_STEP, dtype=np.float64)

    def arc(self, z: Array) -> float:
        """Arc position of the contact."""
        return float(loaded_part(z[0], z[1], self.flexibility).arc.real)


def newton(rod: Rod, z: Array, pin: Array) -> tuple[Array, int, bool]:
    """Unknowns at a position of the pin from nearby ones, iterations, and whether the corrections were accepted."""
    last = 0.5
    for iteration in range(1, 13):
        residual = rod.residual(z, pin)
        matrix = rod.jacobian(z)
        if not (
            np.all(np.isfinite(matrix))
            and np.all(np.abs(residual.imag) < 1e-9)
            and np.linalg.det(matrix) != 0.0
        ):
            return z, iteration, False
        change = np.linalg.solve(matrix, -residual.real)
        size = float(max(abs(change[0]), abs(change[1] / z[1])))
        if not size <= last:
            return z, iteration, False
        z = z + change
        if size < 1e-10:
            return z, iteration, True
        last = size / 2.0
    return z, iteration, False


def _touch(outcome: Outcome, start: Array, end: Array, offset: float) -> float | None:
    """Fraction of a piece of the path at which the pin touches the straight rod from below; None without touch.

    A pin that slid along the surface without force also touches when it moves upwards.
    """
    gap_start, gap_end = -(start[1] + offset), -(end[1] + offset)
    along = outcome is Outcome.OPEN and abs(gap_start) <= _TOUCH and gap_end < -_TOUCH
    if not along and (gap_start <= _TOUCH or gap_end > _TOUCH):
        return None
    fraction = 0.0 if along else min(gap_start / (gap_start - gap_end), 1.0)
    x = start[0] + fraction * (end[0] - start[0])
    return float(fraction) if 0.0 < x <= 1.0 + _TOUCH else None


def _touching(x: float) -> State:
    """State of contact without force at `x`."""
    return State(Outcome.CONTACT, np.array([0.0, min(x, 1.0) / np.sqrt(np.pi)]))


def first_state(rod: Rod, pin: Array) -> State:
    """State at the first position of the pin."""
    x, gap = pin[0], -(pin[1] + rod.offset)
    if gap > _TOUCH or x > 1.0 + _TOUCH:
        return State(Outcome.OPEN)
    if gap < -_TOUCH or x <= 0.0:
        raise ValueError(
            f"points[0] = {pin} length: the path must start below the rod, on its surface or beyond its tip"
        )
    return _touching(x)


def advance(rod: Rod, state: State, start: Array, end: Array) -> tuple[State, int, float]:
    """State at the end of a straight piece of the path, Newton iterations, and the fraction of slip-off or nan."""
    done, step, spent, slip = 0.0, 1.0, 0, np.nan
    while done < 1.0:
        here = start + done * (end - start)
        if state.outcome in (Outcome.OPEN, Outcome.SLIPPED):
            touch = _touch(state.outcome, here, end, rod.offset)
            if touch is None:
                below = end[1] + rod.offset < -_TOUCH
                state = State(Outcome.OPEN) if below else state
                break
            done = 1.0 if touch == 1.0 else done + touch * (1.0 - done)
            state = _touching(float((start + done * (end - start))[0]))
            continue
        if state.outcome is not Outcome.CONTACT:
            break
        following = min(done + step, 1.0)
        height, height_end = here[1] + rod.offset, end[1] + rod.offset
        if height_end < -_TOUCH:
            if height <= _TOUCH:
                state = State(Outcome.OPEN)
                continue
            following = min(following, done + (1.0 - done) * height / (height - height_end))
        pin = start + following * (end - start)
        z, iterations, converged = newton(rod, state.unknowns, pin)
        spent += iterations
        if not converged:
            step /= 2.0
            if step < _SMALLEST_STEP or spent > _MOST_ITERATIONS:
                return State(Outcome.LOST), spent, slip
            continue
        if rod.arc(z) > 1.0 + _TOUCH:
            slip = _slip_off(rod, state.unknowns, z, (done, following), (start, end))
            state, done = State(Outcome.SLIPPED), slip
            continue
        state, done, step = State(Outcome.CONTACT, z), following, 2.0 * step
    return state, spent, slip


def _slip_off(
    rod: Rod, z_before: Array, z_after: Array, bracket: tuple[float, float], piece: tuple[Array, Array]
) -> float:
    """Fraction of the piece at which the arc position equals the length."""

    def excess(fraction: float) -> float:
        share = (fraction - bracket[0]) / (bracket[1] - bracket[0])
        guess = z_before + share * (z_after - z_before)
        return rod.arc(newton(rod, guess, piece[0] + fraction * (piece[1] - piece[0]))[0]) - 1.0

    if rod.arc(z_before) >= 1.0:
        return bracket[0]
    return float(brentq(excess, *bracket, xtol=1e-15))

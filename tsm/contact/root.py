"""The root finder of all events on the path: contact events, crossings, limit points and bifurcations."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

_EVALUATIONS = 80

Answer = TypeVar("Answer")


def find_root(
    evaluate: Callable[[float], tuple[float, Answer]],
    before: tuple[float, float],
    after: tuple[float, float],
    *,
    small: float,
    apart: float,
) -> Answer | None:
    """Find where a function changes its sign, by inverse quadratic interpolation or bisection (Chandrupatla 1997).

    ``evaluate``: value of the function, and data that belong to it. ``before, after``: argument and value on
    both sides of the root, of opposite signs. ``small``: absolute value that counts as zero. ``apart``: width of
    the bracket at which the search ends for a function that jumps. Returns the data at the root, or just past a
    jump; None where no evaluation was past it.
    """
    (other, g), (last, f) = before, after  # the root lies between them
    sign = 1.0 if g > 0 else -1.0
    past: Answer | None = None
    part = f / (f - g)
    for _ in range(_EVALUATIONS):
        least = min(apart / 2 / abs(other - last), 0.5)
        at = last + min(max(part, least), 1 - least) * (other - last)
        value, answer = evaluate(at)
        if abs(value) <= small:
            return answer
        if sign * value < 0:
            past = answer
        if (value > 0) == (f > 0):
            third, h = last, f
        else:
            third, h, other, g = other, g, last, f
        last, f = at, value
        if abs(last - other) < apart and past is not None:
            return past
        x, y = (last - other) / (third - other), (f - g) / (h - g)
        part = 1 / 2
        if y**2 < x and (1 - y) ** 2 < 1 - x:
            part = f / (g - f) * h / (g - h) + (third - last) / (other - last) * f / (h - f) * g / (h - g)
    return past

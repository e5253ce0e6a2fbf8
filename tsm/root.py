"""The root finder of all events on the path: contact events, crossings, limit points and bifurcations."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

_EVALUATIONS = 80

Answer = TypeVar("Answer")


def find_root(
    evaluate: Callable[[float], tuple[float, Answer] | None],
    before: tuple[float, float],
    after: tuple[float, float],
    *,
    small: float,
    apart: float,
) -> Answer | None:
    """Find where a function changes its sign, by false position (Illinois) with a bisection every third time.

    ``evaluate``: value of the function, and data that belong to it; None where it has no value. ``before, after``:
    argument and value on both sides of the root, of opposite signs. ``small``: absolute value that counts as zero.
    ``apart``: width of the bracket at which the search ends for a function that jumps. Returns the data at the root,
    or just past a jump; None where the function has no value.
    """
    (t0, y0), (t1, y1) = before, after
    sign = 1.0 if y0 > 0 else -1.0
    past: Answer | None = None
    for count in range(_EVALUATIONS):
        t = (t0 + t1) / 2 if count % 3 == 2 else t0 + (t1 - t0) * y0 / (y0 - y1)
        sample = evaluate(t)
        if sample is None:
            return None
        y, answer = sample
        if abs(y) <= small:
            return answer
        if sign * y > 0:
            t0, y0, y1 = t, y, y1 / 2
        else:
            t1, y1, y0, past = t, y, y0 / 2, answer
        if abs(t1 - t0) < apart and past is not None:
            return past
    return past

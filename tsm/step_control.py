"""Control of the load steps. Steps grow while the path is followed and are cut back where an attempt fails."""

from __future__ import annotations

from bisect import bisect_left, bisect_right

from tsm.path import FOLLOWED
from tsm.settings import Settings
from tsm.status import Status

NEAR = 1e-9
"""Distance in the load parameter below which a corner of a pin's path coincides with a prescribed load parameter."""
_SAFE = 0.8
"""Safety factor: next step over the step that the tangents would still allow."""
_SHORTEST = 0.1
"""Shortest part of a refused step that is tried next."""
_NAMED = {
    Status.NOT_FINITE,
    Status.SINGULAR_TANGENT,
    Status.INACCURATE,
    Status.TWO_CONTACTS,
    Status.PING_PONG,
    Status.JAMMED,
}
"""Failures that are reported by their own status instead of the general status of a step at its floor."""


def ends(load_parameters: list[float], turns: tuple[float, ...], begin: float) -> list[float]:
    """Load parameters at which a step must end: the prescribed ones, and the turns of pin paths after `begin` before the last of them.

    A turn near a prescribed one is left out, unless a stage begins there.
    """
    ahead = turns[bisect_right(turns, begin + NEAR) : bisect_left(turns, load_parameters[-1])]
    places = [bisect_left(load_parameters, turn - NEAR) for turn in ahead]
    apart = [t for t, n in zip(ahead, places, strict=True) if load_parameters[n] > t + NEAR]
    begins = [t for t in ahead if t == round(t) and t not in load_parameters]
    return sorted({*load_parameters, *apart, *begins})


def allowed(unexplained: float) -> float:
    """Return the fraction of a step that its tangents would explain; `unexplained` is the fraction that they do not explain."""
    return _SAFE * FOLLOWED / max(unexplained, 1e-9)


class StepControl:
    """Length of the next load step.

    ``step``: longest next step of the load parameter.
    ``failure``: why the last attempt failed.
    ``part``: part of the failed step that is tried next.
    """

    def __init__(self, settings: Settings, failure: Status) -> None:
        self.smallest = settings.smallest_step
        self.step, self.failure, self.part = 1.0, failure, 1 / 2

    def fail(self, status: Status, part: float = 1 / 2) -> Status:
        """Give up an attempt; the fraction `part` of its step is tried next."""
        self.failure, self.part = status, min(max(part, _SHORTEST), 1 / 2)
        return status

    def refuse(self, part: float = 1 / 2) -> Status:
        """Give up a step that is too long, whatever was found at its end."""
        return self.fail(Status.ITERATION_LIMIT, part)

    def cut_back(self, left: float) -> bool:
        """Shorten the step, of which `left` was tried at most; return whether it is at its floor."""
        self.step = min(self.step, left) * self.part
        return self.step < self.smallest

    def grow(self, taken: float, fitting: float) -> None:
        """Lengthen the step after one that was taken and could have been `fitting` times as long."""
        self.step = min(max(min(2.0, fitting) * taken, self.step if fitting >= 1 else 0.0), 1.0)

    def verdict(self, folds: bool) -> Status:
        """Status that explains why no step succeeds; `folds` if the speed of the path shows a limit point."""
        if self.failure in _NAMED or self.smallest > 0.5:
            return self.failure
        return Status.LIMIT_POINT if folds else Status.CUTBACK_FLOOR

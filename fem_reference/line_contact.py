"""Where contact with a round pin ceases to be at one point."""

from dataclasses import replace

from fem_reference.active_set import equilibrium
from fem_reference.model import Model
from fem_reference.settings import Settings
from fem_reference.state import State, Touch
from fem_reference.status import Status
from fem_reference.track import KEPT, Accepted, accept, predict, vanishing

_SEARCH = 40
_CLOSE = 1e-4
"""Relative distance to the event at which its place is extrapolated."""
_TIGHT = 0.05
"""Clearance below which contact along a line is looked for."""
_FAR = 20.0
"""Steps ahead of the last one within which a root is looked for."""


def clearance(touch: Touch) -> float:
    """``1 - R kappa`` of a closed contact: positive while the curve bends less than the pin, one for a sharp pin.

    ``kappa = s n . r'' / |r'|^2`` is the curvature of the contact curve towards the pin, s the side.
    """
    at = touch.projection
    return 1.0 - touch.pair.radius * touch.pair.contact.sign * float(at.bend / at.stretch**2)


def tightest(at: State) -> tuple[int, float] | None:
    """Number of the closed contact with a round pin that has least clearance, and its clearance; None if there is none."""
    found = [
        (clearance(touch), number)
        for number, touch in enumerate(at.touches)
        if touch.closed and touch.pair.radius > 0
    ]
    return min(found)[::-1] if found else None


def line_contact(
    model: Model, states: tuple[Accepted, ...], settings: Settings
) -> tuple[float, int, Accepted] | None:
    """Load parameter at which the clearance of a pair vanishes, the pair, and the last state; None if it is not ahead.

    Beyond it the closest point is not one, and Newton's method converges from ever less far: the event is approached from
    below, half of the distance at a time, and extrapolated from the last three states.
    """
    last = tightest(states[-1].at)
    if len(states) < 2 or last is None or last[1] > _TIGHT:
        return None
    pair, track = last[0], states
    if not all(one.at.touches[pair].closed for one in states[-2:]):
        return None
    for _ in range(_SEARCH):
        found = [(clearance(one.at.touches[pair]), one.at.t) for one in track[-2:]]
        (c1, t1), (c2, t2) = found
        if not 0 < c2 < c1:
            return None
        root = t2 + c2 * (t2 - t1) / (c1 - c2)
        if root - t2 > _FAR * (t2 - t1):
            return None
        following = None if root - t2 <= _CLOSE * t2 else _next(model, track, root, settings)
        if following is None:
            values = [(clearance(one.at.touches[pair]), one.at.t) for one in track]
            return (vanishing(values), pair, track[-1]) if root - t2 <= _NEARLY * t2 else None
        track = (*track, following)[-KEPT:]
    return None


_NEARLY = 1e-2
"""Relative distance to the event that is good enough where no state closer to it was found."""


_QUICK = 10
"""Iterations within which a state of the search has to be found."""


def _next(model: Model, states: tuple[Accepted, ...], root: float, settings: Settings) -> Accepted | None:
    """State half way to the root, or less far; None if there is none."""
    last, part = states[-1], 0.5
    settings = replace(settings, max_iterations=min(settings.max_iterations, _QUICK))
    for _ in range(4):
        t = last.at.t + part * (root - last.at.t)
        attempt = equilibrium(model, predict(model, states, t, 1), settings)
        if attempt.status is Status.CONVERGED:
            found = accept(model, attempt.state, settings)
            if found is not None and found.closed == last.closed:
                return found
        part /= 2
    return None

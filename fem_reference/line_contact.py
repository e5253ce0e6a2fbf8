"""The event at which contact with a round pin changes from a point to a line."""

from dataclasses import replace

from fem_reference.model import Model
from fem_reference.settings import Settings
from fem_reference.state import State
from fem_reference.touch import Touch
from fem_reference.track import TRACK_LENGTH, Accepted, accepted_state, root_by_inverse_interpolation

_MAX_STEPS = 40
_CLOSE = 1e-4
"""Relative distance of the load parameter from the event below which the event is extrapolated."""
_CLOSE_ENOUGH = 1e-2
"""Relative distance below which the event is extrapolated if no closer state converges."""
_CLEARANCE_LIMIT = 0.05
"""Clearance below which the event is searched."""
_SEARCH_RANGE = 20.0
"""Largest distance of an estimated event from the last state, in lengths of the last step."""
_MAX_ITERATIONS = 10
"""Largest number of Newton iterations for a state of the search."""


def clearance(touch: Touch) -> float:
    """Clearance ``1 - R kappa`` of a closed contact, positive while the strip is less curved than the pin.

    ``kappa = s n . r'' / |r'|^2`` is the curvature of the contact curve towards the pin on the side s.
    """
    state = touch.projection
    return 1.0 - touch.pair.radius * touch.pair.contact.sign * float(state.bend / state.stretch**2)


def least_clearance(state: State) -> tuple[int, float] | None:
    """Index and clearance of the closed contact with a round pin that has the least clearance; None without one."""
    clearances = [
        (clearance(touch), number)
        for number, touch in enumerate(state.touches)
        if touch.closed and touch.pair.radius > 0
    ]
    return min(clearances)[::-1] if clearances else None


def line_contact(
    model: Model, states: tuple[Accepted, ...], settings: Settings
) -> tuple[float, int, Accepted] | None:
    """Load parameter at which the clearance of a pair vanishes, the pair, and the last state; None without an event.

    Beyond the event the closest point is not unique, and near it Newton's method needs short steps. The search therefore
    halves the distance from below and extrapolates the event from the last three states.
    """
    last = least_clearance(states[-1].state)
    if len(states) < 2 or last is None or last[1] > _CLEARANCE_LIMIT:
        return None
    pair, track = last[0], states
    if not all(accepted.state.touches[pair].closed for accepted in states[-2:]):
        return None
    for _ in range(_MAX_STEPS):
        (c1, t1), (c2, t2) = (
            (clearance(accepted.state.touches[pair]), accepted.state.t) for accepted in track[-2:]
        )
        if not 0 < c2 < c1:
            return None
        root = t2 + c2 * (t2 - t1) / (c1 - c2)
        if root - t2 > _SEARCH_RANGE * (t2 - t1):
            return None
        following = None if root - t2 <= _CLOSE * t2 else _closer_state(model, track, root, settings)
        if following is None:
            values = [(clearance(accepted.state.touches[pair]), accepted.state.t) for accepted in track]
            return (
                (root_by_inverse_interpolation(values), pair, track[-1])
                if root - t2 <= _CLOSE_ENOUGH * t2
                else None
            )
        track = (*track, following)[-TRACK_LENGTH:]
    return None


def _closer_state(
    model: Model, states: tuple[Accepted, ...], root: float, settings: Settings
) -> Accepted | None:
    """Converged state at most half way to the root; None if no attempt converges."""
    last, part = states[-1], 0.5
    settings = replace(settings, max_iterations=min(settings.max_iterations, _MAX_ITERATIONS))
    for _ in range(4):
        t = last.state.t + part * (root - last.state.t)
        accepted = accepted_state(model, states, t, settings)
        if accepted is not None and accepted.state.contact_set == last.state.contact_set:
            return accepted
        part /= 2
    return None

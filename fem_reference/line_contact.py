"""Where contact with a round pin ceases to be at one point."""

from fem_reference.active_set import equilibrium
from fem_reference.model import Model
from fem_reference.settings import Settings
from fem_reference.state import State, Touch
from fem_reference.status import Status
from fem_reference.track import Accepted, accept, predict

_SEARCH = 40
_PRECISION = 1e-10
_SHORT_OF = 0.1
"""Part of the way to the predicted event that is left at every step of the search: it is approached from one side."""


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

    Beyond it the closest point is not one, so the root is approached from below, each time to a tenth of the distance.
    """
    last = tightest(states[-1].at)
    if len(states) < 2 or last is None:
        return None
    pair = last[0]
    before, after = states[-2:]
    if not before.at.touches[pair].closed:
        return None
    for _ in range(_SEARCH):
        (t1, c1), (t2, c2) = ((one.at.t, clearance(one.at.touches[pair])) for one in (before, after))
        if c2 >= c1:
            return None
        root = t2 + c2 * (t2 - t1) / (c1 - c2)
        if abs(root - t2) <= _PRECISION * t2:
            return root, pair, after
        if root - t2 > _FAR * (t2 - t1):
            return None
        following = _next(model, (before, after), root, settings)
        if following is None or clearance(following.at.touches[pair]) <= 0:
            return None
        before, after = after, following
    return None


_FAR = 20.0
"""Steps ahead of the last one within which a root is looked for."""


def _next(model: Model, states: tuple[Accepted, ...], root: float, settings: Settings) -> Accepted | None:
    """State short of the root; halfway back as long as there is none."""
    last, left = states[-1], _SHORT_OF
    for _ in range(6):
        t = last.at.t + (1 - left) * (root - last.at.t)
        attempt = equilibrium(model, predict(model, states, t, settings.predictor_order), settings)
        if attempt.status is Status.CONVERGED:
            found = accept(model, attempt.state, settings)
            if found is not None and found.closed == last.closed:
                return found
        left = (1 + left) / 2
    return None

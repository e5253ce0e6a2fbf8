"""Critical points of a path: where the energy's Hessian has a null vector."""

from dataclasses import dataclass, replace

import numpy as np

from fem_reference.active_set import equilibrium
from fem_reference.arrays import Floats
from fem_reference.model import Model
from fem_reference.newton import judge, moved
from fem_reference.settings import Settings
from fem_reference.state import State, residual, state
from fem_reference.status import Status
from fem_reference.tangent import Tangent, linearise
from fem_reference.track import Accepted, accept, predict, vanishing

LIMIT, BIFURCATION = "limit point", "bifurcation"
_SEARCH = 60
_PRECISION = 1e-10
"""Largest change of a located load parameter or amplitude, relative, that ends a search."""
_REACH = 0.05
"""Displacement, relative to the length, root mean square, within which a limit point is looked for."""
_CLOSE = 1e-5
"""Relative distance of a bifurcation's load parameter within which no state is looked for."""
_FIRST_AMPLITUDE = 1e-2
"""Displacement along the mode with which a branch is entered, relative to the length."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CriticalPoint:
    """A point where stability changes.

    Parameters
    ----------
    kind
        ``"limit point"``: the load has a component along the null vector, and no equilibrium near lies beyond;
        ``"bifurcation"``: it has none, and branches cross.
    load_parameter
        Where it is.
    mode
        The null vector, by strip: displacements ``(m, 2)`` of the section means in the global frame, the largest
        component 1.
    """

    kind: str
    load_parameter: float
    mode: dict[str, Floats]


@dataclass(frozen=True, kw_only=True, eq=False)
class Located:
    """A critical point with what is needed to go on: the state closest to it and the null vector ``(n, 2)``."""

    point: CriticalPoint
    near: Accepted
    vector: Floats


def bifurcation(model: Model, a: Accepted, b: Accepted, settings: Settings) -> Located | None:
    """Locate the change of index between two states of one branch; None if what lies between is not on it.

    Halves until the index changes by one, then chords of the eigenvalue that vanishes. Closer than `_CLOSE` the rate along
    the null vector is round-off: the root is that of the polynomial through the last states.
    """
    low, high = a, b
    values: list[tuple[float, float]] = []
    root = 0.5 * (low.at.t + high.at.t)
    while high.at.t - low.at.t > _PRECISION * high.at.t and len(values) < _SEARCH:
        t = min(max(root, low.at.t), high.at.t)
        middle = _between(model, low, high, t, settings)
        if middle is None:
            return None
        value, _ = smallest(model, middle.tangent)
        single = abs(high.index - low.index) == 1 and (value > 0) == (middle.index == min(a.index, b.index))
        values = [*values, (value, t)] if single else []
        low, high = (middle, high) if middle.index == low.index else (low, middle)
        last, root = root, vanishing(values[-4:]) if len(values) > 1 else 0.5 * (low.at.t + high.at.t)
        if len(values) > 2 and abs(root - last) <= _CLOSE * root:
            break
    near = low if root - low.at.t <= high.at.t - root else high
    _, vector = smallest(model, near.tangent)
    return Located(point=_point(model, BIFURCATION, root, vector), near=near, vector=vector)


def _between(model: Model, a: Accepted, b: Accepted, t: float, settings: Settings) -> Accepted | None:
    """State between two others that departs little from their chord; None if there is none.

    Rates are no measure here: next to a critical point they are round-off along the null vector.
    """
    attempt = equilibrium(model, predict(model, (a,), t, 1), settings)
    found = accept(model, attempt.state, settings) if attempt.status is Status.CONVERGED else None
    if found is None or found.closed != a.closed:
        return None
    d = b.at.u - a.at.u
    off = found.at.u - a.at.u - (t - a.at.t) / (b.at.t - a.at.t) * d
    near = np.linalg.norm(off) <= settings.largest_departure * np.linalg.norm(d) + noise(model, settings)
    return found if near else None


def noise(model: Model, settings: Settings) -> float:
    """Displacements below this are within Newton's tolerance [m]."""
    return 10 * settings.tolerance * model.length


def limit_point(model: Model, a: Accepted, step: float, settings: Settings) -> Located | None:
    """Search for a maximum of the load parameter beyond a state, from ``step`` on; None if there is none near.

    The path goes on with its displacement along the last rate as parameter, ``c . (u - u_a) = delta``, and the load
    parameter among the unknowns; ``dt/ddelta = 1 / (c . v)`` vanishes at the limit.
    """
    rate = a.rate(a.at.t, a.at.t + settings.min_step).u
    size = float(np.linalg.norm(rate))
    if not (np.isfinite(size) and size > 0):
        return None
    c, delta = rate / size, size * step
    low, high = _Turn(delta=0.0, slope=1 / size, at=a.at), None
    while high is None:
        if delta > _REACH * model.length * np.sqrt(model.nodes):
            return None
        found = _turn(model, low.at, a.at.u, c, delta, settings)
        if found is None:
            return None
        low, high, delta = (found, None, 2 * delta) if found.slope > 0 else (low, found, delta)
    for _ in range(_SEARCH):
        width = high.delta - low.delta
        chord = low.delta - low.slope * width / (high.slope - low.slope)
        inner = min(max(chord, low.delta + 0.02 * width), high.delta - 0.02 * width)
        found = _turn(model, low.at, a.at.u, c, inner, settings)
        if found is None:
            return None
        low, high = (found, high) if found.slope > 0 else (low, found)
        if abs(found.slope) <= _PRECISION / size or width <= 1e-6 * high.delta:
            break
    near = accept(model, min(low, high, key=lambda turn: abs(turn.slope)).at, settings)
    if near is None:
        return None
    _, vector = smallest(model, near.tangent)
    # Where the load has no component along the null vector, the rate has none either.
    limit = abs(float(np.sum(vector * c))) > 0.5
    return Located(point=_point(model, LIMIT, near.at.t, vector), near=near, vector=vector) if limit else None


def release(model: Model, a: Accepted, settings: Settings) -> CriticalPoint | None:
    """Name the limit at which a contact is about to open and leaves an unstable state; None if none does.

    No eigenvalue passes zero there: the opening contact frees a direction. The mode is that of the free state.
    """
    rate = a.rate(a.at.t, a.at.t + settings.min_step)
    forces = iter(rate.forces)
    for number, touch in enumerate(a.at.touches):
        if not touch.closed or touch.force + _STEPS_LEFT * settings.min_step * float(next(forces)) > 0:
            continue
        conditions = list(a.at.conditions)
        conditions[number] = touch.condition.opened(armed=True)
        free = accept(model, state(model, a.at.u, a.at.t, tuple(conditions)), settings)
        if free is not None and free.index > max(a.index, 0):
            return _point(model, LIMIT, a.at.t, smallest(model, free.tangent)[1])
    return None


_STEPS_LEFT = 20
"""Smallest steps within which a contact has to open if the path ends for that reason."""


@dataclass(frozen=True, kw_only=True, eq=False)
class _Turn:
    """A state on the way round a limit point: its displacement along the rate, ``dt/ddelta`` there, and itself."""

    delta: float
    slope: float
    at: State


def _turn(
    model: Model, guess: State, origin: Floats, c: Floats, delta: float, settings: Settings
) -> _Turn | None:
    found = _along(model, guess, origin, c, delta, settings)
    tangent = None if found is None else linearise(model, found)
    rate = None if tangent is None or found is None else tangent.rate(found.t, found.t + settings.min_step)
    speed = 0.0 if rate is None else float(np.sum(c * rate.u))
    return None if found is None or speed == 0 else _Turn(delta=delta, slope=1 / speed, at=found)


def _along(
    model: Model, guess: State, origin: Floats, c: Floats, delta: float, settings: Settings
) -> State | None:
    """Equilibrium with ``c . (u - origin) = delta`` and the contacts of the guess; its load parameter is found.

    Needs no small steps: Newton's method with the load parameter among the unknowns. None if it does not converge, the set
    of closed contacts would change, or a contact leaves its strip.
    """
    at = guess
    for _ in range(settings.max_iterations):
        R = model.expansion.T @ residual(model, at).ravel()
        status, _ = judge(model, at, R, settings)
        missing = delta - float(np.sum(c * (at.u - origin)))
        if status is Status.CONVERGED and abs(missing) <= noise(model, settings):
            return at if _same_set(model, at) else None
        if status not in (Status.CONVERGED, Status.ITERATION_LIMIT):
            return None
        tangent = linearise(model, at)
        step = None if tangent is None else tangent.correction(R)
        rate = None if tangent is None else tangent.rate(at.t, at.t + settings.min_step)
        if step is None or rate is None:
            return None
        along = float(np.sum(c * rate.u))
        if along == 0:
            return None
        dt = (missing - float(np.sum(c * step.u))) / along
        both = replace(step, u=step.u + dt * rate.u, forces=step.forces + dt * rate.forces)
        at = moved(model, replace(at, t=at.t + dt), both, 1.0)
    return None


def _same_set(model: Model, at: State) -> bool:
    """Whether no closed contact pulls or is beyond an end, and no open one is penetrated."""
    return all(
        touch.force >= 0 and touch.projection.inside
        if touch.closed
        else not touch.condition.armed or touch.shown_gap >= -model.length_round_off
        for touch in at.touches
    )


def smallest(model: Model, tangent: Tangent) -> tuple[float, Floats]:
    """Eigenvalue of the Hessian that is nearest to zero and its vector ``(n, 2)``, of norm 1, by inverse iteration."""
    x = np.random.default_rng(0).standard_normal(model.unknowns)
    value = np.nan
    for _ in range(_SEARCH):
        x = x / np.linalg.norm(x)
        y = tangent.inverse(x)
        if y is None or not np.all(np.isfinite(y)):
            break
        last, value = value, 1 / float(x @ y)
        x = y
        if abs(value - last) <= 1e-9 * abs(value):
            break
    vector = tangent.expanded(x)
    return value, np.asarray(vector / np.linalg.norm(vector))


def _point(model: Model, kind: str, t: float, vector: Floats) -> CriticalPoint:
    """Name a critical point; its mode is that of the section means."""
    mode = {
        body.strip.name: (body.mesh.sections @ vector[part]) @ body.strip.frame.T
        for body, part in model.each()
    }
    entries = np.concatenate([part.ravel() for part in mode.values()])
    largest = entries[np.argmax(np.abs(entries))]
    return CriticalPoint(
        kind=kind, load_parameter=float(t), mode={name: part / largest for name, part in mode.items()}
    )


def stable_branch(model: Model, located: Located, limit: float, settings: Settings) -> Accepted | None:
    """State on a stable branch that leaves a bifurcation, at a load parameter below ``limit``; None if there is none.

    Both signs of the mode are tried with ever smaller amplitudes, along which the load parameter is found. Of two stable
    branches the one with less energy at a common load parameter is taken, of equal ones the mode's own sign.
    """
    t, found = located.point.load_parameter, list[Accepted]()
    unit = located.vector / np.sqrt(np.mean(located.vector**2))
    for sign in (1.0, -1.0):
        amplitude = _FIRST_AMPLITUDE * model.length
        for _ in range(_SEARCH // 4):
            entered = _on_branch(model, located, sign * amplitude * unit, settings)
            if entered is not None and t < entered.at.t < limit and entered.index == 0:
                found.append(entered)
                break
            amplitude /= 2
    if len(found) == 2:
        common = max(one.at.t for one in found)
        found = [_carried(model, one, common, settings) for one in found]
        energies = [potential(model, one.at) for one in found]
        margin = settings.tolerance * max(map(abs, energies))
        return found[1] if energies[1] < energies[0] - margin else found[0]
    return found[0] if found else None


def _carried(model: Model, one: Accepted, t: float, settings: Settings) -> Accepted:
    """Return the same branch at a load parameter close by."""
    attempt = equilibrium(model, predict(model, (one,), t, 1), settings)
    found = accept(model, attempt.state, settings) if attempt.status is Status.CONVERGED else None
    return one if found is None else found


def _on_branch(model: Model, located: Located, offset: Floats, settings: Settings) -> Accepted | None:
    near = located.near.at
    c = offset / np.linalg.norm(offset)
    guess = state(model, near.u + offset, near.t, near.conditions)
    found = _along(model, guess, near.u, c, float(np.linalg.norm(offset)), settings)
    return None if found is None else accept(model, found, settings)


def potential(model: Model, at: State) -> float:
    """Energy of the strips and the contacts' springs less the potential of the end loads [J]."""
    springs = sum(touch.pair.penalty * touch.gap**2 / 2 for touch in at.closed)
    return model.strain_energy(at.u) + springs - at.t * float(np.sum(model.load * at.u))

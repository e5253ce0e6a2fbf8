"""Critical points of a path, at which the energy's Hessian is singular, and branches that leave them."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from fem_reference.active_set import revised
from fem_reference.arrays import Floats
from fem_reference.model import Model
from fem_reference.newton import check_convergence, updated
from fem_reference.settings import Settings
from fem_reference.stages import amount
from fem_reference.state import State, build_state, contact_energy, residual, spring_energy
from fem_reference.status import Status
from fem_reference.tangent import Tangent, linearise
from fem_reference.track import Accepted, accept, accepted_state

LIMIT, BIFURCATION = "limit point", "bifurcation"
_MAX_ITERATIONS = 60
_PRECISION = 1e-10
"""Largest relative change of a load parameter or amplitude at the end of a search."""
_LOCATED = 1e-9
"""Relative error of a bifurcation's load parameter."""
_VANISHING = 1e-5
"""Part of the eigenvalue at the ends of a search that counts as zero at its root."""
_LARGEST_DISPLACEMENT = 0.05
"""Largest root mean square displacement in the search for a limit point, relative to the length."""
_FIRST_AMPLITUDE = 1e-2
"""First displacement along the mode in the search for a branch, relative to the length."""
_EQUAL = 1e-6
"""Relative difference of two energies that is round-off: of mirrored branches 4e-8 is measured."""
_NOT_SMALL = 0.1
"""Part of a mode's largest displacement across the strips that decides on its side."""
_OPENING_STEPS = 20
"""Number of smallest steps within which a contact must open if its opening ends the path."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CriticalPoint:
    """A point of the path at which stability changes.

    Parameters
    ----------
    kind
        ``"limit point"``: the load has a component along the null vector, and there is no adjacent equilibrium beyond.
        ``"bifurcation"``: the load has no such component, and branches intersect.
    load_parameter
        Load parameter of the point.
    mode
        Null vector by strip: displacements ``(m, 2)`` of the section means in the global frame, with the largest
        component 1.
    """

    kind: str
    load_parameter: float
    mode: dict[str, Floats]


@dataclass(frozen=True, kw_only=True, eq=False)
class Located:
    """A critical point with the nearest accepted state and the null vector ``(n, 2)``."""

    point: CriticalPoint
    near: Accepted
    vector: Floats


def bifurcation(model: Model, a: Accepted, b: Accepted, settings: Settings) -> Located | None:
    """Locate a bifurcation between two states with different indices; None if they are on different branches.

    The root of the eigenvalue nearest to zero by Brent's method. Where it has one sign at both states, no eigenvalue passes zero between them,
    and where it does not vanish at the root, the branch changes there.
    """
    met: dict[float, Accepted] = {a.state.t: a, b.state.t: b}

    def value(t: float) -> float:
        if t not in met:
            middle = _between(model, a, b, t, settings)
            if middle is None:
                raise _ElsewhereError
            met[t] = middle
        return smallest_eigenpair(model, met[t].tangent)[0]

    low, high = a.state.t, b.state.t
    ends = value(low), value(high)
    if ends[0] * ends[1] >= 0:
        return None
    try:
        root = float(brentq(value, low, high, rtol=_LOCATED))
    except _ElsewhereError:
        return None
    near = met[min(met, key=lambda t: abs(t - root))]
    least, vector = smallest_eigenpair(model, near.tangent)
    if abs(least) > _VANISHING * max(map(abs, ends)):
        return None
    return Located(point=_point(model, BIFURCATION, root, vector), near=near, vector=vector)


class _ElsewhereError(Exception):
    """A state between is on another branch."""


def _between(model: Model, a: Accepted, b: Accepted, t: float, settings: Settings) -> Accepted | None:
    """Equilibrium between two states that departs little from their chord; None without one.

    The tangents are unsuitable here: near a critical point their component along the null vector is round-off.
    """
    middle = accepted_state(model, (a,), t, settings)
    if middle is None or middle.state.contact_set != a.state.contact_set:
        return None
    d = b.state.u - a.state.u
    off = middle.state.u - a.state.u - (t - a.state.t) / (b.state.t - a.state.t) * d
    allowed = settings.largest_departure * np.linalg.norm(d) + displacement_tolerance(model, settings)
    return middle if np.linalg.norm(off) <= allowed else None


def displacement_tolerance(model: Model, settings: Settings) -> float:
    """Displacement [m] below which differences of two states are within Newton's tolerance."""
    return 10 * settings.tolerance * model.length


def limit_point(model: Model, a: Accepted, step: float, settings: Settings) -> Located | None:
    """Search for a maximum of the load parameter beyond a state, starting with ``step``; None without one nearby.

    The path is continued by displacement control: the displacement along the last rate is prescribed,
    ``c . (u - u_a) = delta``, and the load parameter is an unknown. ``dt/ddelta = 1 / (c . v)`` vanishes at the limit.
    """
    rate = a.rate(a.state.t, a.state.t + settings.min_step).u
    size = float(np.linalg.norm(rate))
    if not (np.isfinite(size) and size > 0):
        return None
    c, delta = rate / size, size * step
    low, high = _FoldState(delta=0.0, slope=1 / size, state=a.state), None
    while high is None:
        if delta > _LARGEST_DISPLACEMENT * model.length * np.sqrt(model.nodes):
            return None
        following = _fold_state(model, low.state, a.state.u, c, delta, settings)
        if following is None:
            return None
        if following.slope > 0:
            low, delta = following, 2 * delta
        else:
            high = following
    for _ in range(_MAX_ITERATIONS):
        width = high.delta - low.delta
        chord = low.delta - low.slope * width / (high.slope - low.slope)
        inner = min(max(chord, low.delta + 0.02 * width), high.delta - 0.02 * width)
        middle = _fold_state(model, low.state, a.state.u, c, inner, settings)
        if middle is None:
            return None
        low, high = (middle, high) if middle.slope > 0 else (low, middle)
        if abs(middle.slope) <= _PRECISION / size or width <= 1e-6 * high.delta:
            break
    near = accept(model, min(low, high, key=lambda fold: abs(fold.slope)).state, settings)
    if near is None:
        return None
    _, vector = smallest_eigenpair(model, near.tangent)
    # At a bifurcation the load and thus the rate have no component along the null vector.
    limit = abs(float(np.sum(vector * c))) > 0.5
    return (
        Located(point=_point(model, LIMIT, near.state.t, vector), near=near, vector=vector) if limit else None
    )


def opening_limit(model: Model, a: Accepted, settings: Settings) -> CriticalPoint | None:
    """Limit point at which a contact is about to open and leaves an unstable state; None without one.

    No eigenvalue passes zero there, since the open contact releases a displacement. The mode is the unstable mode without
    this contact.
    """
    rate = a.rate(a.state.t, a.state.t + settings.min_step)
    forces = iter(rate.forces)
    for number, touch in enumerate(a.state.touches):
        if not touch.closed or touch.force + _OPENING_STEPS * settings.min_step * float(next(forces)) > 0:
            continue
        conditions = list(a.state.conditions)
        conditions[number] = touch.condition.opened(armed=True)
        opened = build_state(model, a.state.u, a.state.t, tuple(conditions), a.state.tie_forces)
        free = accept(model, opened, settings)
        if free is not None and free.index > max(a.index, 0):
            return _point(model, LIMIT, a.state.t, smallest_eigenpair(model, free.tangent)[1])
    return None


@dataclass(frozen=True, kw_only=True, eq=False)
class _FoldState:
    """A state near a limit point, with its displacement delta [m] along the rate and the slope ``dt/ddelta``."""

    delta: float
    slope: float
    state: State


def _fold_state(
    model: Model, guess: State, origin: Floats, c: Floats, delta: float, settings: Settings
) -> _FoldState | None:
    """Equilibrium at a prescribed displacement with its slope; None if it does not converge."""
    state = _displacement_controlled(model, guess, origin, c, delta, settings)
    tangent = None if state is None else linearise(model, state)
    rate = None if tangent is None or state is None else tangent.rate(state.t, state.t + settings.min_step)
    speed = 0.0 if rate is None else float(np.sum(c * rate.u))
    return None if state is None or speed == 0 else _FoldState(delta=delta, slope=1 / speed, state=state)


def _displacement_controlled(
    model: Model, guess: State, origin: Floats, c: Floats, delta: float, settings: Settings
) -> State | None:
    """Equilibrium with ``c . (u - origin) = delta`` and the contact set of the guess.

    Newton's method with the load parameter as an additional unknown. None if it does not converge, if the set of closed
    contacts would change, or if a contact leaves its strip.
    """
    state = guess
    for _ in range(settings.max_iterations):
        R = model.restriction @ residual(model, state).ravel()
        status, _ = check_convergence(model, state, R, settings)
        missing = delta - float(np.sum(c * (state.u - origin)))
        if status is Status.CONVERGED and abs(missing) <= displacement_tolerance(model, settings):
            return state if _contact_set_holds(model, state, settings) else None
        if status not in (Status.CONVERGED, Status.ITERATION_LIMIT):
            return None
        tangent = linearise(model, state)
        step = None if tangent is None else tangent.correction(R)
        rate = None if tangent is None else tangent.rate(state.t, state.t + settings.min_step)
        if step is None or rate is None:
            return None
        along = float(np.sum(c * rate.u))
        dt = (missing - float(np.sum(c * step.u))) / along if along else np.inf
        if not np.isfinite(dt):
            return None
        correction = replace(step, u=step.u + dt * rate.u, forces=step.forces + dt * rate.forces)
        state = updated(model, replace(state, t=state.t + dt), correction, 1.0)
    return None


def _contact_set_holds(model: Model, state: State, settings: Settings) -> bool:
    """Whether closed contacts lie on their strips, and no contact closes, opens, sticks or slips otherwise."""
    inside = all(touch.projection.inside for touch in state.closed)
    return inside and revised(model, state, settings).contact_set == state.contact_set


def smallest_eigenpair(model: Model, tangent: Tangent) -> tuple[float, Floats]:
    """Eigenvalue of the Hessian nearest to zero and its unit eigenvector ``(n, 2)``, by inverse iteration."""
    x = np.random.default_rng(0).standard_normal(model.unknowns)
    value = np.nan
    for _ in range(_MAX_ITERATIONS):
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
    """Return a critical point with the mode of the section means."""
    mode = {
        body.strip.name: (body.mesh.sections @ vector[part]) @ body.strip.frame.T
        for body, part in model.bodies_and_nodes()
    }
    entries = np.concatenate([part.ravel() for part in mode.values()])
    largest = entries[np.argmax(np.abs(entries))]
    return CriticalPoint(
        kind=kind, load_parameter=float(t), mode={name: part / largest for name, part in mode.items()}
    )


def stable_branch(model: Model, located: Located, limit: float, settings: Settings) -> Accepted | None:
    """State on a stable branch from a bifurcation, at a load parameter below ``limit``; None without one.

    Equilibrium is sought at prescribed amplitudes of the mode, with both signs and successively halved. Of two stable
    branches the one with lower energy at a common load parameter is returned; with equal energies, the one on which the strips
    turn to the left, see `_side`.
    """
    t, entries = located.point.load_parameter, list[Accepted]()
    unit = _side(model, located) * located.vector / np.sqrt(np.mean(located.vector**2))
    for sign in (1.0, -1.0):
        amplitude = _FIRST_AMPLITUDE * model.length
        for _ in range(_MAX_ITERATIONS // 4):
            entered = _on_branch(model, located, sign * amplitude * unit, settings)
            if entered is not None and t < entered.state.t < limit and entered.index == 0:
                entries.append(entered)
                break
            amplitude /= 2
    if len(entries) == 2:
        common = max(entry.state.t for entry in entries)
        entries = [accepted_state(model, (entry,), common, settings) or entry for entry in entries]
        energies = [potential(model, entry.state, located.near.state) for entry in entries]
        margin = _EQUAL * max(map(abs, energies))
        return entries[1] if energies[1] < energies[0] - margin else entries[0]
    return entries[0] if entries else None


def _side(model: Model, located: Located) -> float:
    """Sign with which the first displacement across a strip that is not small is to the left, strip by strip from start to end."""
    left = []
    for body, part in model.bodies_and_nodes():
        axis = body.mesh.sections @ (body.mesh.nodes + located.near.state.u[part])
        moved = body.mesh.sections @ located.vector[part]
        x, y = np.gradient(axis, axis=0).T
        left.append((x * moved[:, 1] - y * moved[:, 0]) / np.hypot(x, y))
    across = np.concatenate(left)
    first = np.argmax(np.abs(across) > _NOT_SMALL * np.abs(across).max())
    return 1.0 if across[first] >= 0 else -1.0


def _on_branch(model: Model, located: Located, offset: Floats, settings: Settings) -> Accepted | None:
    """Equilibrium whose displacement from the bifurcation along ``offset`` ``(n, 2)`` is its norm; None without one."""
    near = located.near.state
    c = offset / np.linalg.norm(offset)
    guess = build_state(model, near.u + offset, near.t, near.conditions, near.tie_forces)
    state = _displacement_controlled(model, guess, near.u, c, float(np.linalg.norm(offset)), settings)
    return None if state is None else accept(model, state, settings)


def potential(model: Model, state: State, near: State) -> float:
    """Total potential energy: strain energy, energy of contacts and springs, minus the work of the dead loads [J].

    Dead moments do work on the rotation from the state ``near``, which is less than half a turn away.
    """
    turns = [
        float(np.remainder(pose.rotation - other.rotation + np.pi, 2 * np.pi) - np.pi)
        for pose, other in zip(state.poses, near.poses, strict=True)
    ]
    work = float(np.sum(amount(model.loads, state.t) * state.u)) + float(
        amount(model.moments, state.t) @ turns
    )
    stored = model.strain_energy(state.u) + contact_energy(state) + spring_energy(model, state)
    return stored - work

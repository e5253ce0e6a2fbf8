"""Critical points of a path, at which the energy's Hessian is singular, and branches that leave them."""

from dataclasses import dataclass

import numpy as np

from fem_reference.path.track import LARGEST_DEPARTURE, Accepted, accept, root, state_at
from fem_reference.statement.arrays import Floats
from fem_reference.statement.loads import amount
from fem_reference.statement.status import Status
from fem_reference.system.newton import Control, displacement_tolerance, iterate, revised
from fem_reference.system.state import State, stored_energy
from fem_reference.system.system import linearise

LIMIT, BIFURCATION = "limit point", "bifurcation"
_MAX_ITERATIONS = 60
_LOCATED = 1e-9
"""Relative error of the place of a critical point."""
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


def bifurcation(a: Accepted, b: Accepted) -> Accepted | None:
    """State at a bifurcation between two states with different indices; None if they are on different branches."""
    ends = [smallest_eigenpair(at)[0] for at in (a, b)]
    if not ends[0] * ends[1] < 0:
        return None

    def evaluate(t: float, _: Accepted) -> tuple[float, Accepted] | None:
        at = b if t == b.t else _between(a, b, t)
        return None if at is None else (float(np.sign(ends[0])) * smallest_eigenpair(at)[0], at)

    found = root(evaluate, (a.t, abs(ends[0]), a), b.t, _LOCATED * (b.t - a.t))
    assert found is not None, "the eigenvalue has the other sign at the end"
    near = found[1]
    vanished = abs(smallest_eigenpair(near)[0]) <= _VANISHING * max(map(abs, ends))
    return near if vanished else None


def _between(a: Accepted, b: Accepted, t: float) -> Accepted | None:
    """Equilibrium between two states that departs little from their chord; None without one."""
    middle = state_at(a, t)
    if middle is None or middle.state.contact_set != a.state.contact_set:
        return None
    d = b.state.u - a.state.u
    # near a critical point the tangents are unsuitable: their component along the null vector is round-off
    off = middle.state.u - a.state.u - (t - a.t) / (b.t - a.t) * d
    allowed = LARGEST_DEPARTURE * np.linalg.norm(d) + displacement_tolerance(a.state)
    return middle if np.linalg.norm(off) <= allowed else None


def limit_point(a: Accepted, step: float) -> CriticalPoint | None:
    """Maximum of the load parameter beyond a state, searched from ``step`` along its rate; None without one nearby."""
    model = a.state.model
    rate = a.rate(a.t, a.t + model.settings.min_step).u
    size = float(np.linalg.norm(rate))
    if not (np.isfinite(size) and size > 0):
        return None
    # c . (u - u_a) = delta is prescribed, and dt/ddelta = 1 / (c . v) vanishes at the limit
    c = rate / size

    def evaluate(delta: float, near: State) -> tuple[float, State] | None:
        state = displacement_controlled(near, Control(origin=a.state.u, c=c, delta=delta))
        tangent = state and linearise(state)
        if not (state and tangent):
            return None
        rate = tangent.rate(state.t, state.t + model.settings.min_step)
        speed = float(np.sum(c * rate.u)) if rate else 0.0
        return (1 / speed, state) if speed else None

    low, delta = (0.0, 1 / size, a.state), size * step
    while True:
        following = evaluate(delta, low[2])
        if following is None or delta > _LARGEST_DISPLACEMENT * model.length * np.sqrt(model.nodes):
            return None
        if following[0] <= 0:
            break
        low, delta = (delta, *following), 2 * delta
    found = root(evaluate, low, delta, 1e-6 * delta)
    near = found and accept(found[1])
    # at a bifurcation the load and thus the rate have no component along the null vector
    limit = near and abs(float(np.sum(smallest_eigenpair(near)[1] * c))) > 0.5
    return critical_point(near, LIMIT) if near and limit else None


def opening_limit(a: Accepted) -> CriticalPoint | None:
    """Limit point at which a contact opens, sets a displacement free and leaves an unstable state; None without one."""
    step = a.state.model.settings.min_step
    forces = iter(a.rate(a.t, a.t + step).forces)
    for number, touch in enumerate(a.state.touches):
        if not touch.closed or touch.force + _OPENING_STEPS * step * float(next(forces)) > 0:
            continue
        touches = list(a.state.touches)
        touches[number] = touch.opened()
        free = accept(a.state.touching(touches))
        if free is not None and free.index > max(a.index, 0):
            return critical_point(free, LIMIT)
    return None


def displacement_controlled(guess: State, control: Control) -> State | None:
    """Equilibrium at a prescribed displacement with the contact set of the guess, none of it off its strip; None without one."""
    attempt = iterate(guess, control)
    state = attempt.state
    held = attempt.status is Status.CONVERGED and all(touch.at.inside for touch in state.closed)
    return state if held and revised(state).contact_set == state.contact_set else None


def smallest_eigenpair(at: Accepted) -> tuple[float, Floats]:
    """Eigenvalue of the Hessian nearest to zero and its unit eigenvector ``(n, 2)``, by inverse iteration."""
    model = at.state.model
    x, value = np.random.default_rng(0).standard_normal(model.unknowns), np.nan
    for _ in range(_MAX_ITERATIONS):
        x = x / np.linalg.norm(x)
        y = at.tangent.inverse(x)
        if y is None or not np.all(np.isfinite(y)):
            break
        last, value = value, 1 / float(x @ y)
        x = y
        if abs(value - last) <= 1e-9 * abs(value):
            break
    vector = model.displacements(x)
    return value, vector / np.linalg.norm(vector)


def critical_point(near: Accepted, kind: str) -> CriticalPoint:
    """Return a critical point at a state, with the mode of the section means."""
    vector = smallest_eigenpair(near)[1]
    mode = {body.strip.name: body.mesh.sections @ vector[body.part] for body in near.state.model.bodies}
    entries = np.concatenate([part.ravel() for part in mode.values()])
    largest = entries[np.argmax(np.abs(entries))]
    scaled = {name: part / largest for name, part in mode.items()}
    return CriticalPoint(kind=kind, load_parameter=near.t, mode=scaled)


def stable_branch(near: Accepted, limit: float) -> Accepted | None:
    """Stable branch of lower energy from a bifurcation, before ``limit``; of equal ones, that to the left; None without."""
    entries, vector, state = list[Accepted](), smallest_eigenpair(near)[1], near.state
    unit = _side(state, vector) * vector / np.sqrt(np.mean(vector**2))
    for sign in (1.0, -1.0):
        for halvings in range(_MAX_ITERATIONS // 4):
            offset = sign * _FIRST_AMPLITUDE * state.model.length / 2**halvings * unit
            size = float(np.linalg.norm(offset))
            control = Control(origin=state.u, c=offset / size, delta=size)
            found = displacement_controlled(state.moved(state.u + offset, near.t), control)
            entered = found and accept(found)
            if entered and near.t < entered.t < limit and entered.index == 0:
                entries.append(entered)
                break
    if len(entries) == 2:
        common = max(entry.t for entry in entries)
        entries = [state_at(entry, common) or entry for entry in entries]
        energies = [potential(entry.state, state) for entry in entries]
        if energies[1] < energies[0] - _EQUAL * max(map(abs, energies)):
            return entries[1]
    return entries[0] if entries else None


def _side(state: State, vector: Floats) -> float:
    """Sign with which the first displacement across a strip that is not small is to the left, strip by strip from start to end."""
    left = []
    for body in state.model.bodies:
        axis = body.mesh.sections @ (body.mesh.nodes + state.u[body.part]) @ (1, 1j)
        moved = body.mesh.sections @ vector[body.part] @ (1, 1j)
        along = np.gradient(axis)
        left.append((along.conj() * moved).imag / np.abs(along))
    across = np.concatenate(left)
    first = np.argmax(np.abs(across) > _NOT_SMALL * np.abs(across).max())
    return 1.0 if across[first] >= 0 else -1.0


def potential(state: State, near: State) -> float:
    """Total potential energy; dead moments work on the turn from the state ``near``, less than half a turn away [J]."""
    model, poses = state.model, zip(state.poses, near.poses, strict=True)
    turns = [np.angle(np.exp(1j * (pose.motion[2] - other.motion[2]))) for pose, other in poses]
    work = np.sum(amount(model.loads, state.t) * state.u) + amount(model.moments, state.t) @ np.array(turns)
    springs = np.array([tie.flexibility for tie in model.ties]) @ state.tie_forces**2 / 2
    return float(sum(stored_energy(state)) + springs - work)

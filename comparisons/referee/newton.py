"""The search for the exact equilibrium of a scene's rods near an answer, by Newton's method on elements that are halved."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from comparisons.answer import Array, Ints
from comparisons.referee.elements import AMPLITUDE, GAUSS, VALUES, Mesh, mesh_of
from comparisons.referee.equations import scales
from comparisons.referee.grip import Grip
from comparisons.referee.guess import SHORTEST, AnswerState, Seen, first_guess, put
from comparisons.referee.layout import Layout, lay_out
from comparisons.referee.rod import largest
from comparisons.referee.state import Equilibrium, SearchStatus
from comparisons.scene import Scene

_RESOLVED = 3e-14
"""Largest amplitude of the last two bubbles of a resolved element [rad]."""
_ITERATIONS, _ROUNDS, _HOLDING = 40, 12, 6
_NEAR = 0.01
"""Largest differences of forces, over the largest force, and of arc positions between an answer and the equilibrium near it."""
_LARGEST_ROTATION = 0.5
"""Largest change of a rotation in one iteration [rad]."""
_STIFFNESS_RATIO = 1e10
"""Largest ratio of the beams' EI/L^2; beyond it the forces in the most flexible beam are lost in round-off."""
_ROUND_OFF = 1e-10
"""Correction below which a correction that no longer decreases is round-off."""
_LAST_PLACES = 10.0 * float(np.finfo(float).eps)
"""Round-off of a force over EA, since forces follow from stretches."""
_MOST_ELEMENTS = 400
"""Largest number of elements of a part."""
_FIT = np.asarray(np.linalg.pinv(VALUES[:, 2:]), dtype=np.float64)
_FIT_LOW = np.zeros_like(_FIT)
_FIT_LOW[:4] = np.linalg.pinv(VALUES[:, 2:6])
"""From values at the Gauss points to all bubbles, and to the lowest ones, since an answer's rotations are inaccurate."""
_PLACES = np.append((GAUSS + 1.0) / 2.0, [0.0, 1.0])


def equilibrium(scene: Scene, answer: AnswerState) -> Equilibrium:
    """Return the exact equilibrium of `scene` near an answer.

    The force in a rod between ends, joints and contacts is constant but for the load along the rod. The rotation is a polynomial of
    degree 16 on elements that are halved until its last terms are round-off. Newton's method with the exact Hessian starts from the
    answer.

    Examples
    --------
    >>> from comparisons.models import solve
    >>> from comparisons.referee import equilibrium, answer_state
    >>> from comparisons.scene import load_scene
    >>> scene = load_scene("ks-cantilever")
    >>> exact = equilibrium(scene, answer_state(solve(scene, "tsm"), scene, -1))
    >>> f"{exact.contacts['pin->cantilever'].push:.12e}", exact.index
    ('2.288274307175e-03', 0)
    """
    layout = lay_out(scene, answer.load_parameter, answer.arcs, answer.grips)
    z, seen = first_guess(layout, answer)
    reason = _reason_not_to_judge(layout, z)
    if reason:
        return replace(undeformed(layout), status=SearchStatus.NOT_JUDGED, reason=reason)
    start = _seen(layout, z, seen, _FIT_LOW)
    best = correct(start, _ITERATIONS)
    # arc positions of contacts and forces of parts are more accurate in an answer than rotations
    for held in (layout.arcs, np.array(sorted({*layout.arcs, *layout.forces}), dtype=int)):
        if _is_near(z, best):
            break
        other = correct(_rotations_corrected(start, held), _ITERATIONS)
        if best.status is SearchStatus.NO_EQUILIBRIUM or _is_near(z, other):
            best = other
    return best


def switched(now: Equilibrium, arcs: Mapping[str, float], grips: Mapping[str, Grip], t: float) -> Equilibrium:
    """Return the equilibrium next to another one at load parameter t, with contacts at the arc positions `arcs`, held by `grips`."""
    layout, before = lay_out(now.scene, t, arcs, grips), now.layout
    z = np.zeros(layout.unknowns)
    z[layout.arcs] = [arcs[pair] / layout.length for pair in layout.touches]

    def seen(beam: str, s: Array) -> tuple[Array, Array]:
        there = now.shape(beam, s * layout.length)
        return there.position, there.rotation

    put(layout, z, seen)
    ends = before.extents(now.z)[:, 1]
    for part, extent in zip(layout.parts, layout.extents(z), strict=True):
        own = [(end, old) for old, end in zip(before.parts, ends, strict=True) if old.beam == part.beam]
        # behind a contact at the tip, a part without length is of the last one
        old = next((old for end, old in own if end > extent.mean()), own[-1][1])
        z[part.force : part.force + 2] = old.constant(now.z)[:, 0]
    return correct(_seen(layout, z, seen, _FIT), _ITERATIONS)


def undeformed(layout: Layout) -> Equilibrium:
    """Return the guess that nothing moves."""
    return _seen(layout, np.zeros(layout.unknowns), lambda _, s: (s, 0.0 * s), _FIT)


def _is_near(z: Array, found: Equilibrium) -> bool:
    """Whether an equilibrium was found with nearly the forces and arc positions of the answer."""
    arcs, forces = found.layout.arcs, found.layout.forces
    size = largest(z[forces])
    apart = np.abs(found.z[: len(z)] - z)
    close = apart[forces].max(initial=0.0) <= _NEAR * size and apart[arcs].max(initial=0.0) <= _NEAR
    return found.found and bool(close)


def correct(guess: Equilibrium, iterations: int) -> Equilibrium:
    """Return the equilibrium near a guess, by some iterations on each mesh; elements that do not resolve the rotation are halved."""
    spent, layout = 0, guess.layout
    for _ in range(_ROUNDS):
        found = _newton(guess, iterations)
        spent += found.iterations
        coarse = found.tails > _RESOLVED
        if not found.found or not coarse.any():
            return replace(found, iterations=spent)
        grids = [
            np.sort(np.append(grid, ((grid[:-1] + grid[1:]) / 2.0)[coarse[found.mesh.part == k]]))
            for k, grid in enumerate(found.mesh.grids)
        ]
        if max(map(len, grids)) > _MOST_ELEMENTS:
            break
        finer = mesh_of(layout, grids)
        guess = _fitted(finer, found.z[: layout.unknowns], lambda *at, now=found: now.located(*at)[2], _FIT)
    return replace(found, status=SearchStatus.NOT_RESOLVED, iterations=spent)


def _rotations_corrected(guess: Equilibrium, held: Ints) -> Equilibrium:
    """Correct the rotations while the unknowns `held` keep the values of the answer."""
    # the first correction of inaccurate rotations could move a contact beyond an end, or lead to another equilibrium near GA EA/(EA - GA)
    for _ in range(_HOLDING):
        change = newton_step(guess, held)
        if not np.isfinite(change).all():
            break
        turn = largest(change[guess.layout.unknowns :])
        guess = guess.plus(min(1.0, _LARGEST_ROTATION / max(turn, 1e-300)) * change)
    return guess


def _reason_not_to_judge(layout: Layout, z: Array) -> str:
    """Return the reason why the first guess cannot be corrected; empty if it can."""
    stiffness = [beam.EI / beam.length**2 for beam in layout.scene.beams]
    if not np.all(np.isfinite(z)):
        return "the answer is not finite"
    if max(stiffness) > _STIFFNESS_RATIO * min(stiffness):
        return f"the stiffest beam is {max(stiffness) / min(stiffness):.1g} times as stiff as the most flexible one"
    for part, extent in zip(layout.parts, np.diff(layout.extents(z)), strict=True):
        if extent <= SHORTEST:
            return f'two contacts on beam "{part.beam}", or a contact and an end, are at one place or beyond the end'
    return ""


def _first_grids(layout: Layout, z: Array) -> list[Array]:
    """About one element for 1.5 of the length sqrt(EI/n) over which the deflection varies, at most 50."""
    EA, GA, EI = layout.softest(z)
    n = np.hypot(*z[layout.forces].reshape(-1, 2).T)
    rate = np.sqrt(n * (1.0 + n * np.abs(1.0 / EA - 1.0 / GA)) / EI)
    counts = np.clip(np.ceil(np.diff(layout.extents(z))[:, 0] * rate / 1.5), 1, 50)
    return [np.linspace(0.0, 1.0, int(count) + 1) for count in counts]


def _seen(layout: Layout, z: Array, seen: Seen, fit: Array) -> Equilibrium:
    """Return the guess with the rotations of the beams that are seen; z are the unknowns without the rotations inside the parts."""

    def turned(part: Ints, x: Array) -> Array:
        first, last = np.moveaxis(layout.extents(z)[part], -1, 0)
        arcs = zip(part[:, 0], first + (last - first) * x, strict=True)
        return np.array([seen(layout.parts[k].beam, s)[1] for k, s in arcs])

    return _fitted(mesh_of(layout, _first_grids(layout, z)), z, turned, fit)


def _fitted(mesh: Mesh, z: Array, turned: Callable[[Ints, Array], Array], fit: Array) -> Equilibrium:
    """Return the guess with the rotations at fractions (e, g + 2) of the parts (e, 1): Gauss points and ends of the elements."""
    rotation = turned(mesh.part[:, None], mesh.start[:, None] + mesh.share[:, None] * _PLACES)
    inside = rotation[mesh.local[:, 0] >= len(z), -2]
    bubbles = (rotation[:, :-2] - rotation[:, -2:] @ VALUES[:, :2].T) @ fit.T
    return Equilibrium(mesh=mesh, z=np.concatenate([z, inside, bubbles.ravel()]))


def _newton(now: Equilibrium, iterations: int) -> Equilibrium:
    """Iterate until the corrections are round-off."""
    layout, last, error = now.layout, np.inf, np.inf
    least = _LAST_PLACES / _ROUND_OFF * layout.softest(now.z)[:2].max()
    turning = np.append(np.ones(now.mesh.unknowns), np.tile(AMPLITUDE, len(now.mesh.part)))
    turning[layout.forces] = turning[layout.moving] = 0.0
    status, reason = SearchStatus.NO_EQUILIBRIUM, ""
    for iteration in range(1, iterations + 1):  # noqa: B007, the number of the last one is told
        error = np.inf
        if np.diff(layout.extents(now.z)).min() <= 0.0:
            reason = "two contacts on a beam, or a contact and an end, come to one place"
            break
        change = newton_step(now)
        if np.isnan(change).all():
            reason = "the equations are singular"
            break
        turn, moved = largest(turning * change), largest(change[layout.moving])
        scale, forced = (largest(x[layout.forces]) for x in (now.z, change))
        size = max(turn, moved, forced / (scale + 1e-6 + least))
        error = max(turn, moved, forced / (scale + 1e-6))
        part = min(1.0, _LARGEST_ROTATION / max(turn, 1e-300), _damping(layout, now.z, change))
        now = now.plus(part * change)
        if not np.isfinite(size):
            break
        if part == 1.0 and (size < 1e-15 or (size < _ROUND_OFF and size >= 0.25 * last)):
            status = SearchStatus.FOUND
            break
        last = size if part == 1.0 else np.inf
    return replace(now, status=status, reason=reason, iterations=iteration, correction=error)


def newton_step(guess: Equilibrium, held: Ints | None = None) -> Array:
    """Newton correction with the unknowns `held` fixed; nan if singular."""
    system, none = guess.system, np.full_like(guess.z, np.nan)
    hessian, gradient = system.hessian, system.gradient
    if held is not None:
        hessian, gradient = hessian.copy(), gradient.copy()
        hessian[held], hessian[:, held], gradient[held] = 0.0, 0.0, 0.0
        hessian[held, held] = 1.0
    if not np.all(np.isfinite(hessian)) or not np.all(np.any(hessian, axis=1)):
        return none
    # EI, EA and forces differ by orders of magnitude
    scale = scales(hessian)
    try:
        change: Array = -scale * np.linalg.solve(scale[:, None] * hessian * scale, scale * gradient)
    except np.linalg.LinAlgError:
        return none
    moved = np.append(change, 0.0 * guess.layout.given)[guess.mesh.local]
    return np.append(change, -(system.shift + np.einsum("eij,ej->ei", system.lever, moved)))


def _damping(layout: Layout, z: Array, change: Array) -> float:
    """Largest fraction of a change that leaves a third of the length of every part."""
    before = np.diff(layout.extents(z))
    less = before - np.diff(layout.extents(z + change))
    return float(np.min(2.0 / 3.0 * before / np.maximum(less, 2.0 / 3.0 * before)))

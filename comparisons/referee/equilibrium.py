"""The search for the exact equilibrium of a scene's rods near an answer."""

from dataclasses import dataclass, field, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.elements import AMPLITUDE, DEGREE, GAUSS, VALUES, Mesh, mesh_of, rotations, shapes
from comparisons.referee.equations import System, assemble
from comparisons.referee.layout import Layout
from comparisons.referee.numbering import lay_out
from comparisons.referee.start import SHORTEST, AnswerState, Rotations, first_guess
from comparisons.scene import Scene

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

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
_AT_ONE_PLACE = "two contacts on a beam, or a contact and an end, come to one place"
DENSE = 300
"""Number of unknowns up to which matrices are solved as full ones."""
_MOST_ELEMENTS = 400
"""Largest number of elements of a part."""
_LOW, _ALL = np.linalg.pinv(VALUES[:, 2:6]), np.linalg.pinv(VALUES[:, 2:])
"""From values at the Gauss points to the lowest bubbles, and to all."""


class SearchStatus(Enum):
    """Outcome of the search for an equilibrium; the value is the message for the user."""

    FOUND = "the exact equilibrium was found"
    NO_EQUILIBRIUM = "no equilibrium was found near the answer"
    NOT_RESOLVED = "the deflection has layers that are not resolved"
    NOT_JUDGED = "the scene or the arrangement of its contacts is beyond double precision"


@dataclass(frozen=True, kw_only=True, eq=False)
class Solution:
    """Result of Newton's method in the units of `layout`, with the last equations and the last correction over the unknowns."""

    status: SearchStatus
    reason: str
    """Reason of a search without success."""
    layout: Layout
    mesh: Mesh
    z: Array
    bubbles: Array
    """Coefficients (e, p - 1) of the bubbles."""
    system: System | None = field(repr=False)
    iterations: int
    correction: float


def solve(scene: Scene, answer: AnswerState) -> Solution:
    """Return the equilibrium near an answer, on a mesh that resolves it."""
    layout = lay_out(scene, answer.load_parameter, answer.arcs, answer.grips)
    z, turns = first_guess(layout, answer)
    reason = _reason_not_to_judge(layout, z)
    if reason:
        mesh = mesh_of(layout, [np.array([0.0, 1.0]) for _ in layout.parts])
        return Solution(
            status=SearchStatus.NOT_JUDGED, reason=reason, layout=layout, mesh=mesh, z=z,
            bubbles=np.zeros((0, DEGREE - 1)), system=None, iterations=0, correction=np.inf,
        )  # fmt: skip
    mesh = mesh_of(layout, _first_grids(layout, z))
    start = _fitted(layout, mesh, z, turns)
    best = correct(layout, mesh, *start, _ITERATIONS)
    # arc positions of contacts and forces of parts are more accurate in an answer than rotations
    for held in (layout.arcs, np.union1d(layout.arcs, layout.forces)):
        if _is_near(z, best):
            break
        other = correct(layout, mesh, *_rotations_corrected(layout, mesh, *start, held), _ITERATIONS)
        if best.status is SearchStatus.NO_EQUILIBRIUM or _is_near(z, other):
            best = other
    return best


def _is_near(z: Array, solution: Solution) -> bool:
    """Whether an equilibrium was found with nearly the forces and arc positions of the answer."""
    arcs, forces = solution.layout.arcs, solution.layout.forces
    size = float(np.abs(z[forces]).max(initial=0.0))
    apart = np.abs(solution.z[: len(z)] - z)
    close = apart[forces].max(initial=0.0) <= _NEAR * size and apart[arcs].max(initial=0.0) <= _NEAR
    return solution.status is SearchStatus.FOUND and bool(close)


def correct(layout: Layout, mesh: Mesh, z: Array, bubbles: Array, iterations: int) -> Solution:
    """Return the equilibrium near given unknowns; elements that do not resolve the rotation are halved.

    At most `iterations` Newton iterations are made on each mesh.
    """
    spent = 0
    for _ in range(_ROUNDS):
        found = _newton(layout, mesh, z, bubbles, iterations)
        spent += found.iterations
        coarse = tails(found.bubbles) > _RESOLVED
        if found.status is not SearchStatus.FOUND or not coarse.any():
            return replace(found, iterations=spent)
        grids = _refined(mesh, coarse)
        if max(map(len, grids)) > _MOST_ELEMENTS:
            break
        z, bubbles, mesh = _transferred(layout, mesh, found.z, found.bubbles, grids)
    return replace(found, status=SearchStatus.NOT_RESOLVED, iterations=spent)


def _rotations_corrected(
    layout: Layout, mesh: Mesh, z: Array, bubbles: Array, held: Ints
) -> tuple[Array, Array]:
    """Correct the rotations while the unknowns `held` keep the values of the answer.

    Otherwise the first correction of inaccurate rotations could move a contact beyond an end. With a tension near GA EA/(EA - GA)
    the rotations are so sensitive that the first correction could lead to another equilibrium.
    """
    for _ in range(_HOLDING):
        system = assemble(layout, mesh, z, bubbles)
        change = _step(system, held)
        if change is None:
            break
        inside = _inside(system, mesh, change)
        turn = max(float(np.abs(change[layout.unknowns :]).max(initial=0.0)), float(np.abs(inside).max()))
        part = min(1.0, _LARGEST_ROTATION / max(turn, 1e-300))
        z, bubbles = z + part * change, bubbles + part * inside
    return z, bubbles


def _reason_not_to_judge(layout: Layout, z: Array) -> str:
    """Return the reason why the first guess cannot be corrected; empty if it can."""
    if not np.all(np.isfinite(z)):
        return "the answer is not finite"
    stiffness = [beam.EI / beam.length**2 for beam in layout.scene.beams]
    if max(stiffness) > _STIFFNESS_RATIO * min(stiffness):
        return f"the stiffest beam is {max(stiffness) / min(stiffness):.1g} times as stiff as the most flexible one"
    for part in layout.parts:
        if part.extent(z) <= SHORTEST:
            beam = layout.scene.beams[part.beam].name
            return (
                f'two contacts on beam "{beam}", or a contact and an end, are at one place or beyond the end'
            )
    return ""


def _first_grids(layout: Layout, z: Array) -> list[Array]:
    """About one element for 1.5 of the length sqrt(EI/n) over which the deflection varies, at most 50."""
    grids = []
    for part in layout.parts:
        n = float(np.hypot(*part.constant(z)))
        EI, stretch, shear = part.rod.greatest
        rate = np.sqrt(n * (1.0 + n * abs(stretch - shear)) / EI)
        count = int(np.clip(np.ceil(part.extent(z) * rate / 1.5), 1, 50))
        grids.append(np.linspace(0.0, 1.0, count + 1))
    return grids


def _fitted(layout: Layout, mesh: Mesh, z: Array, turns: list[Rotations]) -> tuple[Array, Array]:
    """Return the unknowns and bubbles of the first guess; only the lowest bubbles, since an answer's rotations are inaccurate."""
    whole = np.concatenate([z, np.zeros(mesh.unknowns - len(z))])
    bubbles = np.zeros((len(mesh.part), DEGREE - 1))
    for e, number in enumerate(mesh.part):
        part = layout.parts[number]
        start = part.ends(z)[0] + mesh.start[e] * part.extent(z)
        places = start + mesh.share[e] * part.extent(z) * np.append((GAUSS + 1.0) / 2.0, [0.0, 1.0])
        there = turns[part.beam].angle(places)
        if mesh.vertices[mesh.first[e]] >= len(z):
            whole[mesh.vertices[mesh.first[e]]] = there[-2]
        bubbles[e, :4] = _LOW @ (there[:-2] - VALUES[:, :2] @ there[-2:])
    return whole, bubbles


def _newton(layout: Layout, mesh: Mesh, z: Array, bubbles: Array, iterations: int) -> Solution:
    """Iterate until the corrections are round-off."""
    last, size, error = np.inf, np.inf, np.inf
    most = [part.rod.greatest for part in layout.parts]
    least = _LAST_PLACES / (_ROUND_OFF * min(min(stretch, shear or np.inf) for _, stretch, shear in most))
    forces, turning, moving = layout.forces, np.ones(mesh.unknowns, bool), np.zeros(mesh.unknowns, bool)
    moving[layout.arcs] = True
    moving[[k for item in layout.stations for k in item.place.unknown if k >= 0]] = True
    turning[forces] = turning[moving] = False
    status, reason, system = SearchStatus.NO_EQUILIBRIUM, SearchStatus.NO_EQUILIBRIUM.value, None
    for iteration in range(1, iterations + 1):  # noqa: B007, the number of the last one is told
        system, error = None, np.inf
        if np.diff(layout.extents(z)).min() <= 0.0:
            reason = _AT_ONE_PLACE
            break
        system = assemble(layout, mesh, z, bubbles)
        change = _step(system)
        if change is None:
            reason = "the equations are singular"
            break
        inside = _inside(system, mesh, change)
        turn = max(float(np.abs(change[turning]).max(initial=0.0)), float((np.abs(inside) * AMPLITUDE).max()))
        moved = float(np.abs(change[moving]).max(initial=0.0))
        scale, forced = float(np.abs(z[forces]).max()) + 1e-6, float(np.abs(change[forces]).max())
        size, error = max(turn, moved, forced / (scale + least)), max(turn, moved, forced / scale)
        part = min(1.0, _LARGEST_ROTATION / max(turn, 1e-300), _damping(layout, z, change))
        z, bubbles = z + part * change, bubbles + part * inside
        if not np.isfinite(size):
            break
        if part == 1.0 and (size < 1e-15 or (size < _ROUND_OFF and size >= 0.25 * last)):
            status, reason, system = SearchStatus.FOUND, "", assemble(layout, mesh, z, bubbles)
            break
        last = size if part == 1.0 else np.inf
    return Solution(
        status=status, reason=reason, layout=layout, mesh=mesh, z=z, bubbles=bubbles, system=system,
        iterations=iteration, correction=error,
    )  # fmt: skip


def newton_step(layout: Layout, mesh: Mesh, z: Array, bubbles: Array) -> tuple[Array, Array]:
    """Return the first Newton correction; zero if the equations are singular."""
    system = assemble(layout, mesh, z, bubbles)
    change = _step(system)
    if change is None:
        return np.zeros_like(z), np.zeros_like(bubbles)
    return change, _inside(system, mesh, change)


def _inside(system: System, mesh: Mesh, change: Array) -> Array:
    """Change of the bubbles that belongs to a change of the other unknowns."""
    moved = np.append(change, 0.0)[mesh.local]
    return np.asarray(-(system.shift + np.einsum("eij,ej->ei", system.lever, moved)))


def _step(system: System, held: Ints | None = None) -> Array | None:
    """Newton correction with the unknowns `held` fixed; None if singular.

    Rows and columns are scaled, since EI, EA and forces differ by orders of magnitude.
    """
    hessian, gradient = system.hessian, system.gradient
    if held is not None and len(held):
        hessian, gradient = hessian.copy(), gradient.copy()
        hessian[held], hessian[:, held], gradient[held] = 0.0, 0.0, 0.0
        hessian[held, held] = 1.0
    row, column = np.nonzero(hessian)
    entry = hessian[row, column]
    if not np.all(np.isfinite(entry)) or len(np.unique(row)) < len(hessian):
        return None
    scale = scales(row, column, entry)
    right = scale * gradient
    try:
        if len(hessian) <= DENSE:
            return np.asarray(-scale * np.linalg.solve(scale[:, None] * hessian * scale, right))
        from scipy.sparse import coo_array
        from scipy.sparse.linalg import splu

        factors = splu(coo_array((scale[row] * entry * scale[column], (row, column))).tocsc())
        return np.asarray(-scale * factors.solve(right))
    except (np.linalg.LinAlgError, RuntimeError):
        return None


def scales(row: NDArray[np.int64], column: NDArray[np.int64], entry: Array) -> Array:
    """Return factors of rows and columns with which the largest entry of every row is about one."""
    scale, size = np.ones(int(row[-1]) + 1), np.abs(entry)
    for _ in range(3):
        largest = np.zeros(len(scale))
        np.maximum.at(largest, row, scale[row] * size * scale[column])
        scale = scale / np.sqrt(largest)
    return scale


def _damping(layout: Layout, z: Array, change: Array) -> float:
    """Largest fraction of a change that leaves a third of the length of every part."""
    before = np.diff(layout.extents(z))
    less = before - np.diff(layout.extents(z + change))
    return float(np.min(2.0 / 3.0 * before / np.maximum(less, 2.0 / 3.0 * before)))


def tails(bubbles: Array) -> Array:
    """Largest amplitude of the last two bubbles of every element."""
    return np.asarray((np.abs(bubbles) * AMPLITUDE)[:, -2:].max(axis=1))


def _refined(mesh: Mesh, coarse: NDArray[np.bool_]) -> list[Array]:
    """Grids of the parts with the coarse elements halved."""
    grids = []
    for number in range(int(mesh.part.max()) + 1):
        inside = mesh.part == number
        start, share, split = mesh.start[inside], mesh.share[inside], coarse[inside]
        grids.append(np.sort(np.concatenate([start, (start + share / 2.0)[split], [1.0]])))
    return grids


def _transferred(
    layout: Layout, mesh: Mesh, z: Array, bubbles: Array, grids: list[Array]
) -> tuple[Array, Array, Mesh]:
    """Return the unknowns of the same rotations on halved elements."""
    finer = mesh_of(layout, grids)
    whole = np.concatenate([z[: layout.unknowns], np.zeros(finer.unknowns - layout.unknowns)])
    coefficients = rotations(mesh, z, bubbles)
    inside = np.zeros((len(finer.part), DEGREE - 1))
    for e, number in enumerate(finer.part):
        elements = np.flatnonzero(mesh.part == number)
        middle = finer.start[e] + finer.share[e] / 2.0
        old = elements[np.searchsorted(mesh.start[elements], middle, side="right") - 1]
        if finer.start[e] == mesh.start[old] and finer.share[e] == mesh.share[old]:
            inside[e] = bubbles[old]
            ends = coefficients[old, :2]
        else:
            points = finer.start[e] + finer.share[e] * np.append((GAUSS + 1.0) / 2.0, [0.0, 1.0])
            xi = 2.0 * (points - mesh.start[old]) / mesh.share[old] - 1.0
            there = shapes(xi)[0] @ coefficients[old]
            ends = there[-2:]
            inside[e] = _ALL @ (there[:-2] - VALUES[:, :2] @ ends)
        if finer.vertices[finer.first[e]] >= layout.unknowns:
            whole[finer.vertices[finer.first[e]]] = ends[0]
    return whole, inside, finer

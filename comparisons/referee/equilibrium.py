"""The search for the exact equilibrium of a scene's rods near an answer."""

from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.basis import AMPLITUDE, DEGREE, GAUSS, VALUES, shapes
from comparisons.referee.elements import Mesh, mesh_of, properties, rotations
from comparisons.referee.equations import System, assemble
from comparisons.referee.layout import Layout, lay_out
from comparisons.referee.start import SHORTEST, AnswerState, Rotations, first_guess
from comparisons.scene import Scene

Array = NDArray[np.float64]

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
_NONE = np.zeros(0, dtype=np.int64)
_MOST_ELEMENTS = 400
"""Largest number of elements of a part."""


class SearchStatus(Enum):
    """Outcome of the search for an equilibrium; the value is the message for the user."""

    FOUND = "the exact equilibrium was found"
    NO_EQUILIBRIUM = "no equilibrium was found near the answer"
    NOT_RESOLVED = "the deflection has layers that are not resolved"
    NOT_JUDGED = "the scene or the arrangement of its contacts is beyond double precision"


@dataclass(frozen=True, kw_only=True, eq=False)
class Solution:
    """Result of Newton's method in the units of `Layout`.

    Attributes
    ----------
    status : SearchStatus
        Outcome of the search.
    reason : str
        Reason of a search without success.
    layout, mesh
        Layout and mesh of the unknowns.
    z, bubbles : ndarray
        Unknowns of layout and mesh, and coefficients of the bubbles (e, p - 1).
    system : System
        The last equations.
    iterations : int
        Total number of Newton iterations.
    correction : float
        The last correction relative to the unknowns.
    tail : float
        Largest amplitude of the last two bubbles of an element.
    """

    status: SearchStatus
    reason: str
    layout: Layout
    mesh: Mesh
    z: Array
    bubbles: Array
    system: System | None = field(repr=False)
    iterations: int
    correction: float
    tail: float


def solve(scene: Scene, answer: AnswerState) -> Solution:
    """Return the equilibrium near an answer, on a mesh that resolves it."""
    layout = lay_out(scene, answer.load_parameter, answer.arcs, answer.grips)
    z, turns = first_guess(layout, answer)
    reason = _reason_not_to_judge(layout, z)
    if reason:
        mesh = mesh_of(layout, [np.array([0.0, 1.0]) for _ in layout.parts])
        return Solution(
            status=SearchStatus.NOT_JUDGED,
            reason=reason,
            layout=layout,
            mesh=mesh,
            z=z,
            bubbles=np.zeros((0, DEGREE - 1)),
            system=None,
            iterations=0,
            correction=np.inf,
            tail=np.inf,
        )
    mesh = mesh_of(layout, _first_grids(layout, z))
    start = _fitted(layout, mesh, z, turns)
    best = correct(layout, mesh, *start, _ITERATIONS)
    arcs, forces = _stated(layout)
    for held in (arcs, np.union1d(arcs, forces)):
        if _is_near(layout, z, best):
            break
        other = correct(layout, mesh, *_rotations_corrected(layout, mesh, *start, held), _ITERATIONS)
        if best.status is SearchStatus.NO_EQUILIBRIUM or _is_near(layout, z, other):
            best = other
    return best


def _stated(layout: Layout) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Unknowns that are more accurate in an answer than rotations: arc positions of contacts, and forces of parts."""
    arcs = np.array([touch.arc for touch in layout.touches], dtype=np.int64)
    return arcs, np.unique([k for part in layout.parts for k in (part.force, part.force + 1)])


def _is_near(layout: Layout, z: Array, solution: Solution) -> bool:
    """Whether an equilibrium was found with nearly the forces and arc positions of the answer."""
    arcs, forces = _stated(layout)
    size = float(np.abs(z[forces]).max(initial=0.0))
    apart = np.abs(solution.z[: len(z)] - z)
    close = apart[forces].max(initial=0.0) <= _NEAR * size and apart[arcs].max(initial=0.0) <= _NEAR
    return solution.status is SearchStatus.FOUND and bool(close)


def correct(layout: Layout, mesh: Mesh, z: Array, bubbles: Array, iterations: int) -> Solution:
    """Return the equilibrium near given unknowns; elements that do not resolve the rotation are halved.

    At most `iterations` Newton iterations are made on each mesh.
    """
    spent, reason = 0, ""
    for _ in range(_ROUNDS):
        newton = _newton(layout, mesh, z, bubbles, iterations)
        spent += newton.iterations
        tails = _tails(newton.bubbles)
        coarse = tails > _RESOLVED
        grids = _refined(mesh, coarse)
        done = not newton.converged or not coarse.any()
        if done or max(map(len, grids)) > _MOST_ELEMENTS:
            break
        z, bubbles, mesh = _transferred(layout, mesh, newton.z, newton.bubbles, grids)
    status = SearchStatus.NOT_RESOLVED if newton.converged and not done else SearchStatus.FOUND
    status, reason = (status, "") if newton.converged else (SearchStatus.NO_EQUILIBRIUM, newton.reason)
    return Solution(
        status=status,
        reason=reason,
        layout=layout,
        mesh=mesh,
        z=newton.z,
        bubbles=newton.bubbles,
        system=newton.system,
        iterations=spent,
        correction=newton.correction,
        tail=float(tails.max()),
    )


def _rotations_corrected(
    layout: Layout, mesh: Mesh, z: Array, bubbles: Array, held: NDArray[np.int64]
) -> tuple[Array, Array]:
    """Correct the rotations while the unknowns `held` keep the values of the answer.

    Otherwise the first correction of inaccurate rotations could move a contact beyond an end. With a tension near GA EA/(EA - GA)
    the rotations are so sensitive that the first correction could lead to another equilibrium.
    """
    rods = properties(layout, mesh)
    for _ in range(_HOLDING):
        system = assemble(layout, mesh, rods, z, bubbles)
        change = _step(system, held)
        if change is None:
            break
        inside = _inside(system, change)
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
        if layout.extent(z, part) <= SHORTEST:
            beam = layout.scene.beams[part.beam].name
            return (
                f'two contacts on beam "{beam}", or a contact and an end, are at one place or beyond the end'
            )
    return ""


def _first_grids(layout: Layout, z: Array) -> list[Array]:
    """About one element for 1.5 of the length sqrt(EI/n) over which the deflection varies, at most 50."""
    grids = []
    for part in layout.parts:
        n = float(np.hypot(*z[part.force : part.force + 2]))
        EI, stretch, shear = part.rod.greatest
        rate = np.sqrt(n * (1.0 + n * abs(stretch - shear)) / EI)
        count = int(np.clip(np.ceil(layout.extent(z, part) * rate / 1.5), 1, 50))
        grids.append(np.linspace(0.0, 1.0, count + 1))
    return grids


def _fitted(layout: Layout, mesh: Mesh, z: Array, turns: list[Rotations]) -> tuple[Array, Array]:
    """Return the unknowns and bubbles of the first guess; only the lowest bubbles, since an answer's rotations are inaccurate."""
    whole = np.concatenate([z, np.zeros(mesh.unknowns - len(z))])
    bubbles = np.zeros((len(mesh.part), DEGREE - 1))
    for e, number in enumerate(mesh.part):
        part = layout.parts[number]
        first, extent = layout.arc(z, part.first, part), layout.extent(z, part)
        start, size = first + mesh.start[e] * extent, mesh.share[e] * extent
        if mesh.vertices[mesh.first[e]] >= len(z):
            whole[mesh.vertices[mesh.first[e]]] = turns[part.beam].angle(start)
        ends = [turns[part.beam].angle(start), turns[part.beam].angle(start + size)]
        there = turns[part.beam].angle(start + size * (GAUSS + 1.0) / 2.0)
        bubbles[e, :4] = _LOW @ (there - VALUES[:, :2] @ ends)
    return whole, bubbles


_LOW = np.linalg.pinv(VALUES[:, 2:6])


class _Newton(NamedTuple):
    z: Array
    bubbles: Array
    system: System | None
    converged: bool
    reason: str
    iterations: int
    correction: float


def _newton(layout: Layout, mesh: Mesh, z: Array, bubbles: Array, iterations: int) -> _Newton:
    """Iterate until the corrections are round-off."""
    rods, last, size, error = properties(layout, mesh), np.inf, np.inf, np.inf
    most = [part.rod.greatest for part in layout.parts]
    least = _LAST_PLACES / (_ROUND_OFF * min(min(stretch, shear or np.inf) for _, stretch, shear in most))
    arcs = np.array([touch.arc for touch in layout.touches], dtype=np.int64)
    forces = np.array([k for part in layout.parts for k in (part.force, part.force + 1)])
    turning = np.ones(mesh.unknowns, dtype=bool)
    for k in [*arcs, *forces, *(k for item in layout.stations for k in item.place.unknown if k >= 0)]:
        turning[k] = False
    reason = SearchStatus.NO_EQUILIBRIUM.value
    for iteration in range(1, iterations + 1):
        if min(layout.extent(z, item) for item in layout.parts) <= 0.0:
            return _Newton(z, bubbles, None, False, _AT_ONE_PLACE, iteration, np.inf)
        system = assemble(layout, mesh, rods, z, bubbles)
        change = _step(system)
        if change is None:
            return _Newton(z, bubbles, system, False, "the equations are singular", iteration, np.inf)
        inside = _inside(system, change)
        turn = max(float(np.abs(change[turning]).max(initial=0.0)), float((np.abs(inside) * AMPLITUDE).max()))
        moved = float(np.abs(change[~turning & ~np.isin(np.arange(mesh.unknowns), forces)]).max(initial=0.0))
        scale = float(np.abs(z[forces]).max()) + 1e-6
        forced = float(np.abs(change[forces]).max())
        size, error = max(turn, moved, forced / (scale + least)), max(turn, moved, forced / scale)
        part = min(1.0, _LARGEST_ROTATION / max(turn, 1e-300), _damping(layout, z, change))
        z, bubbles = z + part * change, bubbles + part * inside
        if not np.isfinite(size):
            return _Newton(z, bubbles, system, False, reason, iteration, error)
        if part == 1.0 and (size < 1e-15 or (size < _ROUND_OFF and size >= 0.25 * last)):
            return _Newton(z, bubbles, assemble(layout, mesh, rods, z, bubbles), True, "", iteration, error)
        last = size if part == 1.0 else np.inf
    return _Newton(z, bubbles, system, False, reason, iterations, error)


def newton_step(layout: Layout, mesh: Mesh, z: Array, bubbles: Array) -> tuple[Array, Array]:
    """Return the first Newton correction; zero if the equations are singular."""
    system = assemble(layout, mesh, properties(layout, mesh), z, bubbles)
    change = _step(system)
    return (np.zeros_like(z), np.zeros_like(bubbles)) if change is None else (change, _inside(system, change))


def _inside(system: System, change: Array) -> Array:
    """Change of the bubbles that belongs to a change of the other unknowns."""
    return np.asarray(
        -(system.shift + np.einsum("eij,ej->ei", system.lever, _element_changes(system, change)))
    )


def _element_changes(system: System, change: Array) -> Array:
    """Changes (e, 5 or 6) of the unknowns of every element."""
    local = system.sign * np.append(change, 0.0)[system.local]
    return np.column_stack([local[:, :4], local[:, 4] + local[:, 5], local[:, 6:]])


def _step(system: System, held: NDArray[np.int64] = _NONE) -> Array | None:
    """Newton correction with the unknowns `held` fixed; None if singular.

    Rows and columns are scaled, since EI, EA and forces differ by orders of magnitude.
    """
    hessian, gradient = system.hessian, system.gradient
    if len(held):
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
    part = 1.0
    for item in layout.parts:
        before = layout.extent(z, item)
        less = before - layout.extent(z + change, item)
        if less > 2.0 / 3.0 * before:
            part = min(part, 2.0 / 3.0 * before / less)
    return part


def _tails(bubbles: Array) -> Array:
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


_ALL = np.linalg.pinv(VALUES[:, 2:])

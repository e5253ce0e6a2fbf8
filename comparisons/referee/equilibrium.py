"""The exact equilibrium of a scene's rods next to a given answer: the referee."""

from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.basis import AMPLITUDE, DEGREE, GAUSS, VALUES, shapes
from comparisons.referee.equations import Mesh, System, assemble, mesh_of, properties, rotations
from comparisons.referee.layout import Layout, lay_out
from comparisons.referee.start import Given, Rotations, first_guess
from comparisons.scene import Scene

Array = NDArray[np.float64]

_RESOLVED = 3e-14
"""Largest of an element's last two terms of the rotation [rad]."""
_ITERATIONS, _ROUNDS, _HOLDING = 40, 12, 6
_ROUGHLY = 0.01
"""Differences of forces, over the largest, and of arc positions between an answer and the equilibrium next to it."""
_LARGEST = 0.5
"""Largest change of a rotation in an iteration [rad]."""
_CONTRAST = 1e10
"""Largest ratio of the beams' EI/L^2: the forces of the most flexible one are round-off of the others'."""
_SETTLED = 1e-10
"""Largest correction that is round-off where it does not fall."""
_LAST_PLACES = 10.0 * float(np.finfo(float).eps)
"""Correction of a force, over EA, that is round-off: forces follow from stretches."""
_AT_ONE_PLACE = "two contacts on a beam, or a contact and an end, come to one place"
_NONE = np.zeros(0, dtype=np.int64)
_MOST = 400
"""Most elements of a part."""


class Found(Enum):
    """How the search for an equilibrium ends."""

    FOUND = "the exact equilibrium was found"
    NO_EQUILIBRIUM = "no equilibrium was found near the answer"
    NOT_RESOLVED = "the deflection has layers that are not resolved"
    NOT_JUDGED = "the scene or the arrangement of its contacts is beyond double precision"


@dataclass(frozen=True, kw_only=True, eq=False)
class Solution:
    """What Newton's method ends with; units of `Layout`.

    Attributes
    ----------
    found : Found
        How the search ended.
    reason : str
        Of a search without success.
    layout, mesh
        What the unknowns belong to.
    z, bubbles : ndarray
        Unknowns, and those inside the elements.
    system : System
        The last equations.
    iterations : int
        Spent in all.
    correction : float
        The last correction relative to the unknowns: round-off.
    tail : float
        Largest of the elements' last terms of the rotation.
    """

    found: Found
    reason: str
    layout: Layout
    mesh: Mesh
    z: Array
    bubbles: Array
    system: System | None = field(repr=False)
    iterations: int
    correction: float
    tail: float


def solve(scene: Scene, given: Given) -> Solution:
    """Return the equilibrium next to `given`, on a mesh that resolves it."""
    layout = lay_out(scene, given.load_parameter, given.arcs)
    z, turns = first_guess(layout, given)
    reason = _misplaced(layout, z)
    if reason:
        mesh = mesh_of(layout, [np.array([0.0, 1.0]) for _ in layout.parts])
        return Solution(
            found=Found.NOT_JUDGED,
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
        found = correct(layout, mesh, *_settled(layout, mesh, *start, held), _ITERATIONS)
        if best.found is Found.NO_EQUILIBRIUM or _is_near(layout, z, found):
            best = found
    return best


def _stated(layout: Layout) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Unknowns that an answer states better than its rotations: the contacts' arc positions, and the forces of the parts."""
    arcs = np.array([touch.arc for touch in layout.touches], dtype=np.int64)
    return arcs, np.unique([k for part in layout.parts for k in (part.force, part.force + 1)])


def _is_near(layout: Layout, z: Array, found: Solution) -> bool:
    """Whether an equilibrium was found whose forces and arc positions are roughly the answer's."""
    arcs, forces = _stated(layout)
    size = float(np.abs(z[forces]).max(initial=0.0))
    apart = np.abs(found.z[: len(z)] - z)
    close = apart[forces].max(initial=0.0) <= _ROUGHLY * size and apart[arcs].max(initial=0.0) <= _ROUGHLY
    return found.found is Found.FOUND and bool(close)


def correct(layout: Layout, mesh: Mesh, z: Array, bubbles: Array, iterations: int) -> Solution:
    """Return the equilibrium next to unknowns on a mesh, which is halved where it does not resolve the rotation.

    At most `iterations` of Newton's method are spent on each mesh; of none at all, the state is taken as it is.
    """
    spent, reason = 0, ""
    for _ in range(_ROUNDS):
        newton = _newton(layout, mesh, z, bubbles, iterations)
        spent += newton.iterations
        tails = _tails(newton.bubbles)
        coarse = tails > _RESOLVED
        grids = _refined(mesh, coarse)
        done = not newton.converged or not coarse.any()
        if done or max(map(len, grids)) > _MOST:
            break
        z, bubbles, mesh = _carried(layout, mesh, newton.z, newton.bubbles, grids)
    found = Found.NOT_RESOLVED if newton.converged and not done else Found.FOUND
    found, reason = (found, "") if newton.converged else (Found.NO_EQUILIBRIUM, newton.reason)
    return Solution(
        found=found,
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


def _settled(
    layout: Layout, mesh: Mesh, z: Array, bubbles: Array, held: NDArray[np.int64]
) -> tuple[Array, Array]:
    """Settle the rotations while the unknowns `held` keep the answer's values.

    Where a contact is next to an end, the first correction of rough rotations would move it beyond. Where tension is near
    GA EA/(EA - GA), rotations react so strongly that it may lead to another equilibrium.
    """
    made = properties(layout, mesh)
    for _ in range(_HOLDING):
        system = assemble(layout, mesh, made, z, bubbles)
        change = _step(system, held)
        if change is None:
            break
        inside = _inside(system, change)
        turn = max(float(np.abs(change[layout.unknowns :]).max(initial=0.0)), float(np.abs(inside).max()))
        part = min(1.0, _LARGEST / max(turn, 1e-300))
        z, bubbles = z + part * change, bubbles + part * inside
    return z, bubbles


def _misplaced(layout: Layout, z: Array) -> str:
    if not np.all(np.isfinite(z)):
        return "the answer is not finite"
    stiffness = [beam.EI / beam.length**2 for beam in layout.scene.beams]
    if max(stiffness) > _CONTRAST * min(stiffness):
        return f"the stiffest beam is {max(stiffness) / min(stiffness):.1g} times as stiff as the most flexible one"
    for part in layout.parts:
        if layout.extent(z, part) <= 1e-9:
            beam = layout.scene.beams[part.beam].name
            return (
                f'two contacts on beam "{beam}", or a contact and an end, are at one place or beyond the end'
            )
    return ""


def _first_grids(layout: Layout, z: Array) -> list[Array]:
    """About one element for 1.5 of the length sqrt(EI/n') over which the deflection changes, 50 at most."""
    grids = []
    for part in layout.parts:
        n = float(np.hypot(*z[part.force : part.force + 2]))
        rate = np.sqrt(n * (1.0 + n * abs(part.stretch - part.shear)) / part.EI)
        count = int(np.clip(np.ceil(layout.extent(z, part) * rate / 1.5), 1, 50))
        grids.append(np.linspace(0.0, 1.0, count + 1))
    return grids


def _fitted(layout: Layout, mesh: Mesh, z: Array, turns: list[Rotations]) -> tuple[Array, Array]:
    """Add the rotations between stations; the lowest terms only, since those of an answer are rough."""
    whole = np.concatenate([z, np.zeros(mesh.unknowns - len(z))])
    bubbles = np.zeros((len(mesh.part), DEGREE - 1))
    for e, number in enumerate(mesh.part):
        part = layout.parts[number]
        first, extent = layout.arc(z, part.first, part), layout.extent(z, part)
        start, size = first + mesh.start[e] * extent, mesh.share[e] * extent
        if mesh.vertices[mesh.first[e]] >= len(z):
            whole[mesh.vertices[mesh.first[e]]] = turns[part.beam].at(start)
        ends = [turns[part.beam].at(start), turns[part.beam].at(start + size)]
        there = turns[part.beam].at(start + size * (GAUSS + 1.0) / 2.0)
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
    """Correct until the corrections are round-off."""
    made, last, size, error = properties(layout, mesh), np.inf, np.inf, np.inf
    least = _LAST_PLACES / (_SETTLED * min(min(part.stretch, part.shear or np.inf) for part in layout.parts))
    arcs = np.array([touch.arc for touch in layout.touches], dtype=np.int64)
    forces = np.array([k for part in layout.parts for k in (part.force, part.force + 1)])
    turning = np.ones(mesh.unknowns, dtype=bool)
    for k in [*arcs, *forces, *(k for item in layout.stations for k in item.place.unknown if k >= 0)]:
        turning[k] = False
    reason = Found.NO_EQUILIBRIUM.value
    for iteration in range(1, iterations + 1):
        if min(layout.extent(z, item) for item in layout.parts) <= 0.0:
            return _Newton(z, bubbles, None, False, _AT_ONE_PLACE, iteration, np.inf)
        system = assemble(layout, mesh, made, z, bubbles)
        change = _step(system)
        if change is None:
            return _Newton(z, bubbles, system, False, "the equations are singular", iteration, np.inf)
        inside = _inside(system, change)
        turn = max(float(np.abs(change[turning]).max(initial=0.0)), float((np.abs(inside) * AMPLITUDE).max()))
        moved = float(np.abs(change[~turning & ~np.isin(np.arange(mesh.unknowns), forces)]).max(initial=0.0))
        scale = float(np.abs(z[forces]).max()) + 1e-6
        forced = float(np.abs(change[forces]).max())
        size, error = max(turn, moved, forced / (scale + least)), max(turn, moved, forced / scale)
        part = min(1.0, _LARGEST / max(turn, 1e-300), _kept(layout, z, change))
        z, bubbles = z + part * change, bubbles + part * inside
        if not np.isfinite(size):
            return _Newton(z, bubbles, system, False, reason, iteration, error)
        if part == 1.0 and (size < 1e-15 or (size < _SETTLED and size >= 0.25 * last)):
            return _Newton(z, bubbles, assemble(layout, mesh, made, z, bubbles), True, "", iteration, error)
        last = size if part == 1.0 else np.inf
    return _Newton(z, bubbles, system, False, reason, iterations, error)


def newton_step(layout: Layout, mesh: Mesh, z: Array, bubbles: Array) -> tuple[Array, Array]:
    """Return the first change of Newton's method, zero where the equations are singular."""
    system = assemble(layout, mesh, properties(layout, mesh), z, bubbles)
    change = _step(system)
    return (np.zeros_like(z), np.zeros_like(bubbles)) if change is None else (change, _inside(system, change))


def _inside(system: System, change: Array) -> Array:
    """Change of the bubbles with that of the other unknowns."""
    return np.asarray(-(system.shift + np.einsum("eij,ej->ei", system.lever, _own(system, change))))


def _own(system: System, change: Array) -> Array:
    """Changes (e, 5) of the elements' own unknowns."""
    local = system.sign * np.append(change, 0.0)[system.local]
    return np.column_stack([local[:, :4], local[:, 4] + local[:, 5]])


def _step(system: System, held: NDArray[np.int64] = _NONE) -> Array | None:
    """Newton's change, zero of what is held; rows and columns are scaled, since EI, EA and forces are far apart."""
    hessian, gradient = system.hessian.copy(), system.gradient.copy()
    hessian[held], hessian[:, held], gradient[held] = 0.0, 0.0, 0.0
    hessian[held, held] = 1.0
    if not np.all(np.isfinite(hessian)) or np.any(np.abs(hessian).max(axis=1, initial=0.0) == 0.0):
        return None
    scale = scales(hessian)
    try:
        return np.asarray(-scale * np.linalg.solve(scale[:, None] * hessian * scale, scale * gradient))
    except np.linalg.LinAlgError:
        return None


def scales(matrix: Array) -> Array:
    """Return factors of rows and columns that make the largest entry of each about one."""
    scale = np.ones(len(matrix))
    size = np.abs(matrix)
    for _ in range(3):
        largest = (scale[:, None] * size * scale).max(axis=1)
        scale = scale / np.sqrt(np.where(largest > 0.0, largest, 1.0))
    return scale


def _kept(layout: Layout, z: Array, change: Array) -> float:
    """Largest part of a change that leaves a third of every part's extent."""
    part = 1.0
    for item in layout.parts:
        before = layout.extent(z, item)
        less = before - layout.extent(z + change, item)
        if less > 2.0 / 3.0 * before:
            part = min(part, 2.0 / 3.0 * before / less)
    return part


def _tails(bubbles: Array) -> Array:
    return np.asarray((np.abs(bubbles) * AMPLITUDE)[:, -2:].max(axis=1))


def _refined(mesh: Mesh, coarse: NDArray[np.bool_]) -> list[Array]:
    """Grids of the parts with the coarse elements halved."""
    grids = []
    for number in range(int(mesh.part.max()) + 1):
        own = mesh.part == number
        start, share, split = mesh.start[own], mesh.share[own], coarse[own]
        grids.append(np.sort(np.concatenate([start, (start + share / 2.0)[split], [1.0]])))
    return grids


def _carried(
    layout: Layout, mesh: Mesh, z: Array, bubbles: Array, grids: list[Array]
) -> tuple[Array, Array, Mesh]:
    """Unknowns on halved elements, the same functions."""
    finer = mesh_of(layout, grids)
    whole = np.concatenate([z[: layout.unknowns], np.zeros(finer.unknowns - layout.unknowns)])
    coefficients = rotations(mesh, z, bubbles)
    inside = np.zeros((len(finer.part), DEGREE - 1))
    for e, number in enumerate(finer.part):
        own = np.flatnonzero(mesh.part == number)
        middle = finer.start[e] + finer.share[e] / 2.0
        old = own[np.searchsorted(mesh.start[own], middle, side="right") - 1]
        if finer.start[e] == mesh.start[old] and finer.share[e] == mesh.share[old]:
            inside[e] = bubbles[old]
            ends = coefficients[old, :2]
        else:
            at = (
                2.0
                * (
                    finer.start[e]
                    + finer.share[e] * np.append((GAUSS + 1.0) / 2.0, [0.0, 1.0])
                    - mesh.start[old]
                )
                / mesh.share[old]
                - 1.0
            )
            there = shapes(at)[0] @ coefficients[old]
            ends = there[-2:]
            inside[e] = _ALL @ (there[:-2] - VALUES[:, :2] @ ends)
        if finer.vertices[finer.first[e]] >= layout.unknowns:
            whole[finer.vertices[finer.first[e]]] = ends[0]
    return whole, inside, finer


_ALL = np.linalg.pinv(VALUES[:, 2:])

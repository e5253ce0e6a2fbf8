"""Critical points of the equilibrium path, where the tangent is singular and a mode needs no force; mechanisms.

At a limit point the load parameter is stationary along the path, and this branch has no equilibrium beyond.
At a bifurcation point the path goes on, unstable, and another branch crosses it; it is located as the root of
the tangent's smallest singular value, which is smooth there with the sign that the index gives it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from operator import itemgetter

import numpy as np

from tsm.contact.contact_set import changed
from tsm.contact.root import find_root
from tsm.elements.properties import Array
from tsm.model.contact import closed
from tsm.model.model import Model
from tsm.model.scales import IDLE
from tsm.model.state import State
from tsm.statement.status import RefusedError
from tsm.system.equilibrium import Equilibrium
from tsm.system.stability import mode, softness
from tsm.system.system import Drive

_LOCATED = 1e-13
"""Tolerance of the search: width of the bracket of the critical load parameter, and the singular value over that at the ends of the step."""
_BESIDE = 1e-6
"""Singular value, over that at the ends of the step, of a point that stands for a bifurcation where no nearer one is found. An imperfect
bifurcation has no such point: its path turns off before."""
_LEAST = 1e-9
"""Singular value of the equations of rigid motions, in coordinates over the structure's size, that counts as zero."""
_SHIFT = 1e-6
"""Amplitude of the mode in the difference quotient that gives its shape along the axis."""
_NOT_SMALL = 0.1
"""Part of a mode's largest displacement across the axes that decides on its sign."""


class CriticalKind(StrEnum):
    """Kind of a critical point."""

    LIMIT_POINT = "limit point"
    BIFURCATION = "bifurcation"


@dataclass(frozen=True, kw_only=True, eq=False)
class CriticalPoint:
    """A located critical point of the equilibrium path.

    Attributes
    ----------
    kind : CriticalKind
        Limit point or bifurcation.
    load_parameter : float
        Load parameter of the point.
    mode : dict of ndarray, shape (m, 2)
        Displacements of the beams' axes in the buckling mode, at the stations of `Result.axis_line`; the
        largest is 1.
    """

    kind: CriticalKind
    load_parameter: float
    mode: dict[str, Array]


def locate_bifurcation(
    before: Equilibrium, after: Equilibrium, solve: Callable[[float], Equilibrium]
) -> Equilibrium:
    """Locate a bifurcation, the point with a singular tangent on a path that goes on.

    The index shows the side of the bifurcation, and the smallest singular value measures the distance to it. Raises
    RefusedError where the path is not found.

    ``before, after``: ends of a step between which the index changes. ``solve``: point of the path at a load
    parameter.
    """
    nearest = before, softness(before.newton.assembler, before.system)

    def evaluate(point: Equilibrium) -> tuple[float, Equilibrium]:
        nonlocal nearest
        size = softness(point.newton.assembler, point.system)
        nearest = min(nearest, (point, size), key=itemgetter(1))
        return size if point.index == before.index else -size, point

    ends = (before.t, nearest[1]), (after.t, evaluate(after)[0])
    apart, largest = _LOCATED * max(1.0, after.t), max(abs(g) for _, g in ends)
    small = _LOCATED * largest
    if nearest[1] <= small:
        return nearest[0]
    try:
        root = find_root(lambda t: evaluate(solve(t).sharpened()), *ends, small=small, apart=apart)
    except RefusedError:
        # beside a singular tangent, the residual that Newton's method leaves is a large motion along the mode
        root = nearest[0] if nearest[1] <= _BESIDE * largest else None
    if root is None:
        raise RefusedError
    return root


def critical_point(kind: CriticalKind, point: Equilibrium, load_parameter: float) -> CriticalPoint:
    """Critical point with the mode of the tangent at a point beside it."""
    shape = mode_shape(point)
    shapes = {} if shape is None else shape[1]
    return CriticalPoint(kind=kind, load_parameter=load_parameter, mode=shapes)


def mode_shape(point: Equilibrium) -> tuple[Array, dict[str, Array]] | None:
    """Buckling mode near a critical point, of the sign with which it begins to the left: see `_side`.

    Returns the change of the unknowns that moves some point of an axis by 1, and the displacements (m, 2) of
    the axes; None without a single mode.
    """
    newton = point.newton
    soft = mode(newton.assembler, point.system)
    if soft is None:
        return None
    moved = point.with_state(newton.update(point.state, soft[0] * _SHIFT, point.system))
    axes = {beam: point.axis_line(beam)[1] for beam in point.model.beams}
    shapes = {beam: moved.axis_line(beam)[1] - axis for beam, axis in axes.items()}
    most = max(float(np.abs(shape).max()) for shape in shapes.values()) or 1.0
    most *= _side(np.concatenate([_leftwards(axes[beam], shape) for beam, shape in shapes.items()]))
    return soft[0] * (_SHIFT / most), {beam: shape / most for beam, shape in shapes.items()}


def _leftwards(axis: Array, shape: Array) -> Array:
    """Displacements to the left of an axis that is followed from start to end."""
    x, y = np.gradient(axis, axis=0).T
    return (x * shape[:, 1] - y * shape[:, 0]) / np.hypot(x, y)


def _side(left: Array) -> float:
    """Sign of the first displacement, beam by beam from start to end, that is not small.

    It does not depend on the frame of reference, the elements or round-off.
    """
    first = np.argmax(np.abs(left) > _NOT_SMALL * np.abs(left).max())
    return 1.0 if left[first] >= 0 else -1.0


def mechanism(point: Equilibrium, drive: Drive) -> bool:
    """Whether a structure can move without strain as a drive begins. A contact without force holds it only if it begins to push."""
    model, state = point.model, point.state
    edge, opened = IDLE * model.force_scale, state
    there = closed(model, state)
    idle = [item for item in there if item[1].slot >= 0 and math.hypot(*item[2].force) <= edge]
    for k, *_ in idle:
        opened = changed(model, opened, k, None, armed=True)
    if not (model.joints or _moves(model, opened)):
        return False
    if _free(point):
        return True
    by = point.rates(drive) if idle else None
    if by is None:
        return False
    for k, pair, touch in idle:
        x, y = model.direction(pair, touch, point.state)
        fx, fy, *_ = by.contacts[pair.slots]
        if pair.side * (fy * x - fx * y) <= edge:
            state = changed(model, state, k, None, armed=True)
    return state is not point.state and _free(point.with_state(state))


def _free(point: Equilibrium) -> bool:
    """Whether beams that are rigid can move, and no load stiffens the motion; the tangent of many slender elements is loose too."""
    return not softness(point.newton.assembler, point.system) and _moves(point.model, point.state)


def _moves(model: Model, state: State) -> bool:
    """Whether the beams, each rigid, can move against supports, hinges, springs and closed contacts."""
    body, before = np.arange(len(model.coordinates)), np.array(-1)
    while not np.array_equal(body, before):
        before = body.copy()
        for beam in model.beams.values():
            body[beam.nodes] = body[beam.nodes].min()
    numbers, body = np.unique(body, return_inverse=True)
    q = state.q[: 3 * len(body)].copy()
    q[model.slaves] = q[model.masters]
    places = model.coordinates + q.reshape(-1, 3)[:, :2]

    def rows(nodes: Array, at: Array) -> Array:
        """Displacements and rotations (3 n, columns) of the bodies of n nodes at some places, by the bodies' motions."""
        found, n = np.zeros((len(nodes), 3, len(numbers), 3)), np.arange(len(nodes))
        x, y = ((at - places[0]) / model.extent).T
        found[n, :, body[nodes]] = np.eye(3)
        found[n, 0, body[nodes], 2], found[n, 1, body[nodes], 2] = -y, x
        return found.reshape(3 * len(nodes), -1)

    held = rows(np.arange(len(body)), places)
    equations = [held[model.fixed], held[model.slaves] - held[model.masters]]
    if model.springs is not None:
        equations.append(model.springs.stretch(held))
    for _, pair, touch in closed(model, state):
        at = np.array([model.node_position(pair, state.q, state.load_parameter)])
        moved = rows(model.element_nodes[[touch.element], 0], at)[:2]
        if pair.node >= 0:
            moved = moved - rows(np.array([pair.node]), at)[:2]
        x, y = model.direction(pair, touch, state)
        sticks = touch.grip is not None and not touch.grip.slip
        equations.append(moved if sticks else np.array([[-y, x]]) / math.hypot(x, y) @ moved)
    every = np.concatenate(equations)
    return bool(np.linalg.matrix_rank(every, tol=_LEAST) < every.shape[1])

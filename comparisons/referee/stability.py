"""The index of an equilibrium: number of negative eigenvalues of the Hessian on the admissible variations."""

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.grip import rows
from comparisons.referee.layout import NONE
from comparisons.referee.newton import DENSE, Solution, entries, scales

Array = NDArray[np.float64]


def index_of(solution: Solution) -> int:
    """Return the index of an equilibrium.

    The energy is a maximum in the two force components of every part, whose block of the Hessian is negative definite. By
    Haynsworth's formula ``index = negatives(K) - 2 parts``, where the negatives of the elements' condensed blocks count too. The
    normal of a contact with offset is normal to the mean of the two tangents, so that the angle phi is not an independent variation.
    With friction the equations have no potential and no index: it is -1.
    """
    if solution.layout.grips:
        return -1
    system = solution.system
    held, reduced = _directions(solution), system.hessian
    if held is not None:
        reduced = held.T @ reduced @ held
    scale = scales(*entries(reduced))
    inside = np.linalg.eigvalsh(system.blocks)
    negatives = _negatives(scale[:, None] * reduced * scale) + int((inside < 0.0).sum())
    return negatives - 2 * len(solution.layout.parts)


def _negatives(matrix: Array) -> int:
    """Number of negative eigenvalues; of large matrices by Sylvester's law of inertia from ``L D L^T``."""
    if len(matrix) <= DENSE:
        return int((np.linalg.eigvalsh(matrix) < 0.0).sum())
    from scipy.linalg import ldl

    pivots = ldl(matrix)[1]
    # a block of two pivots has one eigenvalue of either sign
    blocks = np.diag(pivots, 1) != 0.0
    single = ~(np.append(blocks, False) | np.append(False, blocks))
    return int((np.diag(pivots)[single] < 0.0).sum() + blocks.sum())


def orientation_of(solution: Solution) -> int:
    """Return the sign of the determinant of the equations, with friction too; where it changes, a path passes a critical point."""
    system = solution.system
    signs = [np.linalg.slogdet(system.hessian)[0], *np.linalg.slogdet(system.blocks)[0]]
    return int(np.prod(np.sign(signs)))


def _directions(solution: Solution) -> Array | None:
    """Admissible variations as columns, None if all are; the angles phi follow with the directions of the faces."""
    turned = [touch for touch in solution.layout.touches if touch.angle != NONE]
    if not turned:
        return None
    free = np.eye(solution.mesh.unknowns)
    for touch in turned:
        numbers, *_, derivatives = rows(solution.layout, touch, solution.z, 0.0)
        change = np.zeros(len(free) + 1)
        np.add.at(change, numbers, derivatives[2])
        free[touch.angle] = -change[:-1] / change[touch.angle]
    return np.delete(free, [touch.angle for touch in turned], axis=1)

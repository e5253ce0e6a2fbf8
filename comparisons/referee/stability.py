"""The index of an equilibrium: number of negative eigenvalues of the Hessian on the admissible variations."""

import numpy as np
from numpy.typing import NDArray

from comparisons.referee.elements import fields
from comparisons.referee.equilibrium import DENSE, Solution, scales
from comparisons.referee.layout import Part, normal
from comparisons.referee.stations import NONE

Array = NDArray[np.float64]


def index_of(solution: Solution) -> int:
    """Return the index of an equilibrium.

    The energy is a maximum in the two force components of every part, whose block of the Hessian is negative definite. By
    Haynsworth's formula ``index = negatives(K) - 2 parts``, where the negatives of the elements' condensed blocks count too. The
    normal of a contact with offset is normal to the mean of the two tangents, so that the angle phi is not an independent variation.
    With friction the equations have no potential and no index: it is -1.
    """
    if solution.layout.rubs:
        return -1
    system = solution.system
    assert system is not None, "an equilibrium has its equations"
    held, reduced = _directions(solution), system.hessian
    if held is not None:
        reduced = held.T @ reduced @ held
    row, column = np.nonzero(reduced)
    scale = scales(row, column, reduced[row, column])
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
    assert system is not None, "an equilibrium has its equations"
    signs = [np.linalg.slogdet(system.hessian)[0], *np.linalg.slogdet(system.blocks)[0]]
    return int(np.prod(np.sign(signs)))


def _directions(solution: Solution) -> Array | None:
    """Admissible variations as columns, None if all are; the angles phi follow with ``nu . d(r'_- + r'_+) / |r'_- + r'_+|``."""
    layout, z = solution.layout, solution.z
    if all(touch.angle == NONE for touch in layout.touches):
        return None
    size = solution.mesh.unknowns
    free = np.eye(size)
    angles = []
    for number, station in enumerate(layout.stations):
        if station.touch == NONE or layout.touches[station.touch].angle == NONE:
            continue
        angle = layout.touches[station.touch].angle
        angles.append(angle)
        turned, forced, whole, moved = np.zeros(2), [], np.zeros(2), np.zeros(2)
        for part in (item for item in layout.parts if number in (item.first, item.last)):
            theta, s = float(z[station.rotation_unknown]), layout.arc(z, number, part)
            _, a, c = part.rod.flexibility(s)
            n = part.local(z[part.force : part.force + 2], s)
            here = fields(np.array(theta), n, a, c)
            d1 = np.array([np.cos(theta), np.sin(theta)])
            d2 = np.array([-d1[1], d1[0]])
            whole += here.tangent + np.array([1.0, 0.0])
            turned += d2 * (1.0 + here.N * (a - c)) + d1 * here.Q * (a - c)
            flexible = a * np.outer(d1, d1) + c * np.outer(d2, d2)
            forced.append((part.force, flexible if part.rod.turn == 0.0 else flexible @ _rotation(part, s)))
            if not part.rod.uniform:
                moved += flexible @ part.rod.steepness(part.piece, n, s) + part.rod.softening(s) @ [
                    here.N * d1,
                    here.Q * d2,
                ]
        across = np.array([-whole[1], whole[0]]) / (whole @ whole)
        if layout.touches[station.touch].slope:
            nu = part.rod.frame(s).T @ normal(float(z[angle]))
            across = nu / (whole @ [nu[1], -nu[0]])
        row = np.zeros(size)
        row[station.rotation_unknown] = across @ turned
        for force, by_force in forced:
            row[force : force + 2] = across @ by_force
        row[layout.touches[station.touch].arc] = across @ moved + part.rod.curvature
        free[angle] = row
    return np.delete(free, angles, axis=1)


def _rotation(part: Part, s: float) -> Array:
    """Rotation from the frame of the chord to that of the undeformed tangent."""
    return np.asarray((part.axes.T @ part.rod.frame(s)).T)

r"""Mean displacement and rotation of an end section, and the ties that hold or join end sections.

A section inside a strip that bears a moment has them too, with the shape functions integrated over its height.

With the consistent weights ``w_j = integral N_j dy / h`` and ``v_j = integral N_j (y - y_m) dy`` of the edge's shape
functions, an end has the mean displacement ``sum w_j u_j`` and the first moment ``m = c sum v_j x_j``, where c makes
``|m| = L`` at rest. Its rotation is the angle of m from m at rest, with the derivatives

    d theta / d m = (-m_y, m_x) / |m|^2,
    d2 theta / d m2 = [[2 m_x m_y, m_y^2 - m_x^2], [m_y^2 - m_x^2, -2 m_x m_y]] / |m|^4.

A force on the mean displacement is a uniform traction, a moment on the rotation a traction linear in y. A tie makes a
component of the motion equal to a prescribed one, or to the same component of another end. Its multiplier is the force
or moment of the tie on the end.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix, identity, kron

from fem_reference.contact.contact import Carrier
from fem_reference.solid.mesh import Discretisation, edge_weights, section_points
from fem_reference.statement.arrays import Floats
from fem_reference.statement.loads import amount
from fem_reference.statement.strip import Strip

COLUMNS = 4
"""Number of columns of an end section: components x and y of the mean displacement, and of the first moment m."""
ROTATION = 2
"""Number of the rotation among the components of a motion."""


@dataclass(frozen=True, kw_only=True, eq=False)
class EndSection:
    """An end section of the discrete model, or a section inside a strip that bears a moment."""

    node: str  # name of the end, ``"strip.end"``, or of the section inside, ``"strip at 0.5"``
    strip: str  # name of the strip
    arc: float  # axial coordinate of a section with a moment [m]; nan for others
    carrier: Carrier  # mean position, relative to the model's origin, and first moment m
    height: float  # height of the section [m]
    anchor_stiffness: float  # stiffness of the anchor's springs at this end; zero without an anchor [N/m]

    def pose(self, u: Floats) -> "Pose":
        """Motion of the section at the nodal displacements ``u`` ``(n, 2)``."""
        rest, (position, m) = self.carrier.reference, self.carrier.points(u)
        x, y = rest[1]
        rotation = np.arctan2(x * m[1] - y * m[0], x * m[0] + y * m[1])
        return Pose(position=position, motion=np.append(position - rest[0], rotation), first_moment=m)


@dataclass(frozen=True, kw_only=True, eq=False)
class Pose:
    """Motion of an end section."""

    position: Floats  # mean position ``(2,)``, relative to the model's origin [m]
    motion: Floats  # mean displacements x and y [m], rotation from the undeformed section in (-pi, pi] [rad]
    first_moment: Floats  # first moment m ``(2,)`` [m]

    @property
    def gradient(self) -> Floats:
        """Derivatives ``(4, 3)`` of the motion with respect to mean displacement and first moment."""
        x, y = self.first_moment
        gradient = np.eye(COLUMNS, 3)
        gradient[2:, ROTATION] = np.array([-y, x]) / (x * x + y * y)
        return gradient

    @property
    def curvature(self) -> Floats:
        """Second derivatives ``(4, 4)`` of the rotation with respect to mean displacement and first moment."""
        x, y = self.first_moment
        curvature = np.zeros((COLUMNS, COLUMNS))
        curvature[2:, 2:] = np.array([[2 * x * y, y * y - x * x], [y * y - x * x, -2 * x * y]])
        return curvature / (x * x + y * y) ** 2


@dataclass(frozen=True, kw_only=True)
class Tie:
    """A component of an end's motion: prescribed, or tied to that of another end, rigidly or by a spring."""

    section: int  # number of the end section
    component: int  # x, y or rotation
    other: int | None = None  # number of the other end section; None if the component is prescribed
    rates: tuple[float, ...] = (0.0,)  # change of the prescribed motion in every stage [m or rad]
    flexibility: float = 0.0  # the inverse of a spring's stiffness; zero for a rigid tie

    def residual(self, poses: tuple[Pose, ...], t: float, force: float) -> float:
        """Motion less the prescribed one or the other end's, plus the flexibility times the ``force``; an angle is in [-pi, pi] [m or rad]."""
        target = amount(self.rates, t) if self.other is None else poses[self.other].motion[self.component]
        difference = float(poses[self.section].motion[self.component] - target + self.flexibility * force)
        turns = self.component == ROTATION
        return float(np.remainder(difference + np.pi, 2 * np.pi) - np.pi) if turns else difference


def end_rows(strip: Strip, mesh: Discretisation, end: str) -> tuple[csr_matrix, float]:
    """Weights ``(2, n)`` of a strip's nodes in mean displacement and first moment of an end, and the end's height."""
    edge = mesh.edges[end]
    y = mesh.places[edge, 1]
    weights = edge_weights(strip.element, y)
    moments = edge_weights(strip.element, y, y - weights @ y)
    return _rows(strip, y, weights, moments, identity(len(mesh.nodes), format="csr")[edge]), float(np.ptp(y))


def inner_rows(strip: Strip, mesh: Discretisation, at: float) -> tuple[csr_matrix, float]:
    """Weights like `end_rows` of the section at the part ``at`` of a strip's length, and its height."""
    points, shares, heights = section_points(strip, mesh.places, mesh.edges, np.array([at * strip.length]))
    y = points[:, 1]
    return _rows(strip, y, shares, shares * (y - shares @ y), mesh.basis.probes(points.T)), float(heights[0])


def _rows(strip: Strip, y: Floats, weights: Floats, moments: Floats, nodes: csr_matrix) -> csr_matrix:
    """Weights of mean displacement and first moment, the latter L at rest, from those of points at ``y`` that the ``nodes`` ``(p, n)`` carry."""
    return csr_matrix(np.stack([weights, moments * (strip.length / (moments @ y))]) @ nodes)


def anchor(strip: Strip, mesh: Discretisation, expansion: csr_matrix) -> csr_matrix:
    """Stiffness ``(m, m)`` of springs `anchor_stiffness` on mean displacement and first moment of the start."""
    columns = expansion.T @ kron(end_rows(strip, mesh, "start")[0], np.eye(2)).T
    return csr_matrix(anchor_stiffness(strip) * columns @ columns.T)


def anchor_stiffness(strip: Strip) -> float:
    """Stiffness ``E I / L^3`` of the anchor's springs [N/m], by which a strip without a clamp is regular."""
    return strip.bending_stiffness / strip.length**3

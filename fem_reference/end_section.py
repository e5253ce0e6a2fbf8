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
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.arrays import Array, Floats
from fem_reference.mesh import Discretisation, edge_moments, edge_weights
from fem_reference.sampling import SECTION_LAYERS, sample, section_points
from fem_reference.stages import amount
from fem_reference.strip import Strip

COLUMNS = 4
"""Number of columns of an end section: components x and y of the mean displacement, and of the first moment m."""
ROTATION = 2
"""Number of the rotation among the components of a motion."""


@dataclass(frozen=True, kw_only=True, eq=False)
class EndSection:
    """An end section of the discrete model, or a section inside a strip that bears a moment."""

    node: str  # name of the end, ``"strip.end"``, or of the section inside, ``"strip at 0.5"``
    # undeformed mean position ``(2,)`` in the global frame, relative to the model's origin [m]
    position: Floats
    # weights ``(2, n)`` of all nodes of the model in the mean displacement and in the first moment
    rows: csr_matrix
    first_moment: Floats  # first moment m at rest ``(2,)``, in the global frame [m]
    frame: Floats  # rotation ``(2, 2)`` from the strip's frame to the global frame
    height: float  # height of the section [m]
    # stiffness of the anchor's springs at this end, see `fem_reference.body.Body`; zero without an anchor
    # [N/m]
    anchor_stiffness: float

    @property
    def columns(self) -> Floats:
        """Derivatives ``(2 n, 4)`` of mean displacement and first moment with respect to the nodal displacements."""
        rows = self.rows.toarray()
        return np.stack(
            [np.outer(row, axis).ravel() for row in rows for axis in self.frame], axis=-1
        )  # a row of the frame is a global axis in the strip's frame

    def pose(self, u: Array) -> "Pose":
        """Motion of the section at the nodal displacements ``u`` ``(n, 2)``."""
        displacement, change = (self.rows @ u) @ self.frame.T
        return Pose(
            displacement=displacement, first_moment=self.first_moment + change, rest=self.first_moment
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class Pose:
    """Motion of an end section."""

    displacement: Array  # mean displacement ``(2,)`` in the global frame [m]
    first_moment: Array  # first_moment, rest: first moment m ``(2,)``, deformed and at rest [m]
    rest: Floats

    @property
    def rotation(self) -> float:
        """Rotation from the undeformed section, in (-pi, pi] [rad]."""
        (x, y), (a, b) = self.rest, self.first_moment
        return float(np.arctan2(x * b - y * a, x * a + y * b))

    @property
    def motion(self) -> tuple[Any, Any, float]:
        """Displacements x and y [m] and rotation [rad]."""
        return self.displacement[0], self.displacement[1], self.rotation

    @property
    def gradient(self) -> Array:
        """Derivatives ``(4, 3)`` of the motion with respect to mean displacement and first moment."""
        x, y = self.first_moment
        gradient = np.zeros((COLUMNS, 3), dtype=self.first_moment.dtype)
        gradient[0, 0] = gradient[1, 1] = 1.0
        gradient[2:, ROTATION] = np.array([-y, x]) / (x * x + y * y)
        return gradient

    @property
    def curvature(self) -> Array:
        """Second derivatives ``(4, 4)`` of the rotation with respect to mean displacement and first moment."""
        x, y = self.first_moment
        curvature = np.zeros((COLUMNS, COLUMNS), dtype=self.first_moment.dtype)
        curvature[2:, 2:] = np.array([[2 * x * y, y * y - x * x], [y * y - x * x, -2 * x * y]])
        curvature /= (x * x + y * y) ** 2
        return curvature


@dataclass(frozen=True, kw_only=True)
class Tie:
    """A component of an end's motion: prescribed, or tied to that of another end, rigidly or by a spring."""

    section: int  # section, component: number of the end section, and of the component: x, y or rotation
    component: int
    other: int | None = None  # number of the other end section; None if the component is prescribed
    rates: tuple[float, ...] = (0.0,)  # change of the prescribed motion in every stage [m or rad]
    # difference of the motions over the force against it, the inverse of a spring's stiffness; zero for a
    # rigid tie
    flexibility: float = 0.0

    @property
    def grounded(self) -> bool:
        """Whether the tie is a spring to the ground."""
        return self.other is None and self.flexibility > 0

    def residual(self, poses: tuple[Pose, ...], t: float, force: Any) -> float:
        """Motion less the prescribed one or the other end's, plus the flexibility times the ``force``; an angle is in [-pi, pi] [m or rad]."""
        target = amount(self.rates, t) if self.other is None else poses[self.other].motion[self.component]
        difference = float(poses[self.section].motion[self.component] - target + self.flexibility * force)
        return (
            float(np.remainder(difference + np.pi, 2 * np.pi) - np.pi)
            if self.component == ROTATION
            else difference
        )


def end_rows(strip: Strip, mesh: Discretisation, end: str) -> tuple[csr_matrix, float]:
    """Weights ``(2, n)`` of a strip's nodes in mean displacement and first moment of an end, and the end's height."""
    edge = mesh.edges[end]
    y = mesh.places[edge, 1]
    weights = edge_weights(strip.element, y)
    moments = edge_moments(strip.element, y - weights @ y)
    moments = moments * (strip.length / (moments @ y))
    rows = csr_matrix(
        (np.concatenate([weights, moments]), (np.repeat([0, 1], edge.size), np.tile(edge, 2))),
        shape=(2, len(mesh.nodes)),
    )
    return rows, float(y[-1] - y[0])


def inner_rows(strip: Strip, mesh: Discretisation, at: float) -> tuple[csr_matrix, float]:
    """Weights like `end_rows` of the section at the part ``at`` of a strip's length, and its height."""
    layers = strip.mesh[1] if strip.mesh_file is None else SECTION_LAYERS
    station = np.array([at * strip.length])
    points, shares, heights = section_points(mesh.places, mesh.edges, station, layers)
    y = points[:, 1]
    moments = shares * (y - shares @ y)
    moments = moments * (strip.length / (moments @ y))
    rows = csr_matrix(np.stack([shares, moments])) @ sample(mesh, points).rows(len(mesh.nodes))
    return rows, float(heights[0])


def anchor(strip: Strip, mesh: Discretisation, expansion: csr_matrix, end: str) -> csr_matrix:
    """Stiffness ``(m, m)`` of springs `anchor_stiffness` on mean displacement and first moment of an end."""
    rows, _ = end_rows(strip, mesh, end)
    both = csr_matrix(np.kron(rows[:, mesh.edges[end]].toarray(), np.eye(2)))
    dofs = (2 * mesh.edges[end][:, None] + np.arange(2)).ravel()
    columns = expansion[dofs].T @ both.T
    return csr_matrix(anchor_stiffness(strip) * columns @ columns.T)


def anchor_stiffness(strip: Strip) -> float:
    """Stiffness ``E I / L^3`` of the anchor's springs [N/m], by which a strip without a clamp is regular."""
    return strip.bending_stiffness / strip.length**3

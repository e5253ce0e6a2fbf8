r"""Contact of a node, which is a pin or another strip's end, with the contact curve of a strip.

The closest point satisfies ``(r - x_c) . r' = 0``. The gap there is ``g = s n . (x_c - r) - R`` with the left normal n of
the curve, the side s and the radius R of the pin. The contact force ``lam = -eps g`` is an unknown of its own; the penalty
energy ``eps g^2 / 2`` becomes

    Pi = -lam g - lam^2 / (2 eps).

With ``W = d(r - x_c)/du`` at a fixed zeta, ``W' = dr'/du``, unit tangent t, ``rho = |r'|``, ``d = n . (r - x_c)``,
``k = n . r''`` and ``D = rho^2 + d k``, elimination of zeta by the stationarity condition gives the derivatives of the gap
and thus the force and the symmetric tangent on both strips:

    dg/du   = -s W^T n
    d2g/du2 = -s (k W^T t t^T W - rho (W^T t n^T W' + W'^T n t^T W) - d W'^T n n^T W') / D.

Neither depends on R. Nothing is divided by the gap, so that the second derivative holds at ``d = 0`` too. Elimination of lam
gives the tangent of the penalty method for a pin of any radius ::

    eps (dg/du dg/du^T + g d2g/du2) = eps (W^T W - c c^T / D - R d2g/du2),    c = W^T r' + W'^T (r - x_c).

With lam as an unknown, an iterate with a large gap has no spurious force ``eps g``, and a stiff eps causes no round-off. An
augmented Lagrangian step replaces lam by ``lam - lam_0`` in the second term; lam_0 is the previous contact force.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.arrays import Array, Floats
from fem_reference.curve import ContactCurve, Projection, project
from fem_reference.problem import Contact, Pin


@dataclass(frozen=True, kw_only=True, eq=False)
class Carrier:
    """Points whose positions are weighted means of the nodes of a strip."""

    # undeformed positions relative to the model's origin, in the global frame's directions, ``(m, 2)`` [m]
    reference: Floats
    rows: csr_matrix  # weights ``(m, n)`` of all nodes of the model
    # rotation ``(2, 2)`` from the strip's frame, the frame of the displacements, to the global frame
    frame: Floats

    @cached_property
    def transposed(self) -> csr_matrix:
        """Transposed weights ``(n, m)``."""
        return csr_matrix(self.rows.T)

    def points(self, u: Array) -> Array:
        """Positions ``(m, 2)`` at the nodal displacements ``u`` ``(n, 2)``."""
        positions: Array = self.reference + (self.rows @ u) @ self.frame.T
        return positions

    def nodal_forces(self, weights: Array, forces: Array) -> Array:
        """Nodal forces ``(n, 2, c)`` of global ``forces`` ``(c, 2)`` that act on the points with ``weights`` ``(c, m)``."""
        nodal: Array = (self.transposed @ weights.T)[:, None] * (forces @ self.frame).T
        return nodal


@dataclass(frozen=True, kw_only=True, eq=False)
class Pair:
    """A contact between a node and the curve of a strip in the discrete model."""

    contact: Contact  # input data of the contact
    curve: ContactCurve  # curve, carrier: curve of the touched strip and its points
    carrier: Carrier
    node: Pin | Carrier  # the pin, or the point at the end of another strip
    penalty: float  # contact stiffness eps [N/m]
    # indices of the touched strip and, if the node is an end, of the strip with this end
    strips: tuple[int, ...]
    # corners of the free ends of the touched strip, ordered upwards, if the node or the strip is not a
    # point or a line there
    ends: dict[str, Carrier]
    # origin of all positions ``(2,)`` [m], at the first strip, so that a distant scene loses no digits
    origin: Floats

    @property
    def name(self) -> str:
        """Name of the contact."""
        return self.contact.name

    @property
    def radius(self) -> float:
        """Radius of the pin; zero for an end [m]."""
        return self.node.radius if isinstance(self.node, Pin) else 0.0

    def position(self, u: Array, t: float) -> Array:
        """Position ``(2,)`` of the node at the load parameter ``t``, relative to the origin."""
        if isinstance(self.node, Pin):
            return self.node.position(t) - self.origin
        end: Array = self.node.points(u)[0]
        return end

    def project(self, u: Array, t: float) -> Projection:
        """Project the node on the curve at the nodal displacements ``u`` ``(n, 2)``."""
        return project(self.curve, self.carrier.points(u), self.position(u, t))

    def gap(self, projection: Projection) -> Any:
        """``g = s n . (x_c - r) - R``, negative in penetration [m]."""
        return self.contact.sign * projection.distance - self.radius

    def gap_derivatives(self, projection: Projection) -> tuple[Array, Array]:
        """First and second derivative of the gap with respect to the nodal displacements.

        Returns ``U``, columns ``dg/du``, ``W^T t`` and ``W'^T n``; ``H``, ``d2g/du2 = U H U^T`` [1/m]; the
        first row and column vanish.
        """
        s, d = self.contact.sign, -projection.distance
        directions = np.stack([-s * projection.normal, projection.tangent, projection.normal])
        U = self.carrier.nodal_forces(projection.basis[[0, 0, 1]], directions)
        if isinstance(self.node, Carrier):
            U[..., :2] -= self.node.nodal_forces(np.ones((2, 1)), directions[:2])
        H = np.array(
            [[0.0, 0.0, 0.0], [0.0, projection.bend, -projection.stretch], [0.0, -projection.stretch, -d]]
        )
        return U.reshape(-1, 3), -s * H / (projection.stretch**2 + d * projection.bend)

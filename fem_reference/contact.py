r"""Contact of a node, a pin or another strip's end, with a curve carried by a strip.

At the closest point, ``(r - x_c) . r' = 0``, the gap is ``g = s n . (x_c - r) - R`` with the curve's left normal n, side s
and the pin's radius R. A penalty ``eps g^2 / 2`` is, with the contact force ``lam = -eps g`` kept as a variable,

    Pi = -lam g - lam^2 / (2 eps).

With ``W = d(r - x_c)/du`` at a fixed zeta, ``W' = dr'/du``, unit tangent t, ``rho = |r'|``, ``d = n . (r - x_c)``,
``k = n . r''`` and ``D = rho^2 + d k``, elimination of zeta by its own stationarity gives both derivatives of the gap,
hence force and symmetric tangent on both strips:

    dg/du   = -s W^T n
    d2g/du2 = -s (k W^T t t^T W - rho (W^T t n^T W' + W'^T n t^T W) - d W'^T n n^T W') / D.

Neither depends on R. The second holds at ``d = 0`` too, since nothing is divided by the gap. Eliminating lam as well would leave
the tangent of the penalty alone, for a pin of any radius ::

    eps (dg/du dg/du^T + g d2g/du2) = eps (W^T W - c c^T / D - R d2g/du2),    c = W^T r' + W'^T (r - x_c).

Keeping lam spares Newton's method the force ``eps g`` of an iterate that is not yet in place, and the round-off of a stiff
eps. An augmented Lagrangian step replaces lam by ``lam - lam_0`` in the second term, lam_0 being the force found before.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.arrays import Array, Floats
from fem_reference.curve import Curve, Projection, project
from fem_reference.problem import Contact, Pin


@dataclass(frozen=True, kw_only=True, eq=False)
class Carrier:
    """Points whose positions are weighted means of a strip's nodes.

    Parameters
    ----------
    reference
        Undeformed positions relative to the model's origin, in the global frame's directions, ``(m, 2)`` [m].
    rows
        Weights of all nodes of the model, ``(m, n)``.
    frame
        Rotation ``(2, 2)`` from the strip's frame, in which displacements are given, to the global one.
    """

    reference: Floats
    rows: csr_matrix
    frame: Floats

    def points(self, u: Array) -> Array:
        """Positions ``(m, 2)`` with the nodal displacements ``u`` ``(n, 2)``."""
        moved: Array = self.reference + (self.rows @ u) @ self.frame.T
        return moved

    def pull(self, weights: Array, vector: Array) -> Array:
        """Nodal vectors ``(n, 2)`` of ``vector`` acting on the weighted sum ``weights`` ``(m,)`` of the points."""
        pulled: Array = np.multiply.outer(self.rows.T @ weights, vector @ self.frame)
        return pulled


@dataclass(frozen=True, kw_only=True, eq=False)
class Pair:
    """A contact ready to be evaluated.

    Parameters
    ----------
    contact
        What was asked for.
    curve, carrier
        The touched curve and the positions of its points.
    node
        The pin, or the carrier of the touching end.
    penalty
        Contact stiffness eps [N/m].
    strips
        Numbers of the strips that take part: the touched one, and that of the touching end.
    origin
        The model's origin, which positions are relative to, ``(2,)`` [m]: no digits are lost far from that of the scene.
    """

    contact: Contact
    curve: Curve
    carrier: Carrier
    node: Pin | Carrier
    penalty: float
    strips: tuple[int, ...]
    origin: Floats

    @property
    def name(self) -> str:
        """Name of the pair."""
        return self.contact.name

    @property
    def radius(self) -> float:
        """Radius of the pin, zero for an end [m]."""
        return self.node.radius if isinstance(self.node, Pin) else 0.0

    def position(self, u: Array, t: float) -> Array:
        """Position ``(2,)`` of the node at the load parameter ``t``, relative to the origin."""
        if isinstance(self.node, Pin):
            return self.node.position(t) - self.origin
        end: Array = self.node.points(u)[0]
        return end

    def project(self, u: Array, t: float) -> Projection:
        """Project the node on the curve deformed by ``u`` ``(n, 2)``."""
        return project(self.curve, self.carrier.points(u), self.position(u, t))

    def gap(self, at: Projection) -> Any:
        """``g = s n . (x_c - r) - R``, negative in penetration [m]."""
        return self.contact.sign * at.distance - self.radius

    def gap_derivatives(self, at: Projection) -> tuple[Array, Array]:
        """First and second derivative of the gap with respect to the nodal displacements.

        Returns
        -------
        U : (2 n, 3)
            Columns ``dg/du``, ``W^T t`` and ``W'^T n``.
        H : (3, 3)
            ``d2g/du2 = U H U^T`` [1/m]; the first row and column vanish.
        """
        s, d = self.contact.sign, -at.distance
        first, second = self._relative(at, -s * at.normal), self._relative(at, at.tangent)
        U = np.stack([first, second, self.carrier.pull(at.basis[1], at.normal)], axis=-1)
        H = np.array([[0.0, 0.0, 0.0], [0.0, at.bend, -at.stretch], [0.0, -at.stretch, -d]])
        return U.reshape(-1, 3), -s * H / (at.stretch**2 + d * at.bend)

    def _relative(self, at: Projection, vector: Array) -> Array:
        """``W^T vector``: on the curve, and with the opposite sign on the touching end."""
        pulled = self.carrier.pull(at.basis[0], vector)
        return pulled if isinstance(self.node, Pin) else pulled - self.node.pull(np.ones(1), vector)

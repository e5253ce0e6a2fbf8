r"""Contact of a node, which is a pin or another strip's end, with the contact curve of a strip.

The node is at x_c, the curve at ``r(zeta)``; a prime is a derivative by zeta. The closest point satisfies ``(r - x_c) . r' = 0``.
The gap there is ``g = s n . (x_c - r) - R`` with the left normal n of the curve, the side s and the radius R of the pin.
The contact force ``lam = -eps g`` is an unknown of its own; the penalty energy ``eps g^2 / 2`` becomes

    Pi = -lam g - lam^2 / (2 eps).

The derivatives by the displacements u use ``W = d(r - x_c)/du`` at a fixed zeta, ``W' = dr'/du``, the unit tangent t,
``rho = |r'|``, ``d = n . (r - x_c)``, ``k = n . r''`` and ``D = rho^2 + d k``. Zeta follows u by the condition of the closest
point. Hence the derivatives of the gap, which give the force and the symmetric tangent on both strips:

    dg/du   = -s W^T n
    d2g/du2 = -s (k W^T t t^T W - rho (W^T t n^T W' + W'^T n t^T W) - d W'^T n n^T W') / D.

Neither depends on R. Nothing is divided by d, so that both hold at ``d = 0`` too. Elimination of lam gives the tangent of the
penalty method for a pin of any radius ::

    eps (dg/du dg/du^T + g d2g/du2) = eps (W^T W - c c^T / D - R d2g/du2),    c = W^T r' + W'^T (r - x_c).

With lam as an unknown, an iterate with a large gap has no spurious force ``eps g``, and a stiff eps causes no round-off. An
augmented Lagrangian step replaces lam by ``lam - lam_0`` in the second term; lam_0 is the previous contact force.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.contact.curve import ContactCurve, Projection, project
from fem_reference.statement.arrays import Floats
from fem_reference.statement.problem import Contact, Pin


@dataclass(frozen=True, kw_only=True, eq=False)
class Carrier:
    """Points that a strip carries: weighted means of its nodes' positions. With weights of sum zero, first moments of a section."""

    reference: Floats  # undeformed, relative to the model's origin, ``(m, 2)`` [m]
    rows: csr_matrix  # weights ``(m, n)`` of the model's nodes
    transposed: csr_matrix  # the same, ``(n, m)``

    def points(self, u: Floats) -> Floats:
        """Positions ``(m, 2)`` at the nodal displacements ``u`` ``(n, 2)``."""
        return self.reference + self.rows @ u

    def columns(self, weights: Floats, directions: Floats) -> Floats:
        """Nodal forces ``(2 n, c)`` of the unit forces ``directions`` ``(c, 2)`` on the points with ``weights`` ``(c, m)``."""
        shares = self.transposed @ weights.T
        return (shares[:, None] * directions.T).reshape(-1, len(directions))


@dataclass(frozen=True, kw_only=True, eq=False)
class Pair:
    """A contact between a node and the curve of a strip in the discrete model."""

    contact: Contact  # input data of the contact
    curve: ContactCurve  # curve of the touched strip
    carrier: Carrier  # the points of the curve
    node: Pin | Carrier  # the pin, or the mean position of another strip's end
    penalty: float  # contact stiffness eps [N/m]
    length: float  # length of the touched strip [m]
    # names of the touched strip and, if the node is an end, of the strip that it ends
    strips: tuple[str, ...]
    # the two corners, lower one first, of every end of the touched strip that the node can meet
    ends: dict[str, Carrier]
    # start ``(2,)`` of the first strip, from which positions count: a distant scene loses no digits [m]
    origin: Floats

    @property
    def radius(self) -> float:
        """Radius of the pin; zero for an end [m]."""
        return self.node.radius if isinstance(self.node, Pin) else 0.0

    def position(self, u: Floats, t: float) -> Floats:
        """Position ``(2,)`` of the node at the load parameter ``t``, relative to the origin."""
        if isinstance(self.node, Pin):
            return self.node.position(t) - self.origin
        return self.node.points(u)[0]

    def project(self, u: Floats, t: float) -> Projection:
        """Project the node on the curve at the nodal displacements ``u`` ``(n, 2)``."""
        return project(self.curve, self.carrier.points(u), self.position(u, t))

    def gap(self, at: Projection) -> float:
        """``g = s n . (x_c - r) - R``, negative in penetration [m]."""
        return self.contact.sign * at.distance - self.radius


@dataclass(frozen=True, kw_only=True, eq=False)
class Touch:
    """A contact in a state: the projection of its node, and the variables that do not follow from the displacements."""

    pair: Pair
    at: Projection
    closed: bool = False  # whether the contact is active
    armed: bool = (
        True  # whether it may close. A node that has gone round an end may not until it is back on its side
    )
    force: float = 0.0  # contact force lam, positive in compression; zero if open [N]
    multiplier: float = 0.0  # multiplier lam_0 of the augmented Lagrangian; zero for the penalty method [N]
    direction: int = 0  # 1 or -1 where the node slips along the tangent or against it; 0 where it sticks
    tangential: float = 0.0  # tangential force T on the strip along t; zero if open [N]
    begin: Projection | None = (
        None  # projection in the last accepted state, from which slip counts; None without friction
    )
    slipped: float = 0.0  # sum of the slips up to the last accepted state [m]
    dissipated: float = 0.0  # energy dissipated up to the last accepted state [J]

    @property
    def rubs(self) -> bool:
        """Whether the contact is closed and has friction."""
        return self.closed and self.begin is not None

    @property
    def augmented(self) -> bool:
        """Whether augmented Lagrangian steps remove the penetration of the closed contact."""
        return self.closed and self.pair.contact.penetration is not None

    @property
    def largest_tangential(self) -> float:
        """Radius ``mu lam`` of the friction cone [N]."""
        return self.pair.contact.friction * self.force

    def opened(self, *, armed: bool = True) -> "Touch":
        """Return the contact after opening."""
        return replace(
            self, closed=False, armed=armed, force=0.0, multiplier=0.0, direction=0, tangential=0.0
        )

    @cached_property
    def gap(self) -> float:
        """Signed distance of the node from the contact curve or its continuation beyond an end [m]."""
        return self.pair.gap(self.at)

    @property
    def reported_gap(self) -> float:
        """Gap; for a node beyond an end of the strip the distance from this end [m]."""
        return self.gap if self.at.inside else self.at.end_distance - self.pair.radius

    @property
    def gap_residual(self) -> float:
        """Residual ``g + (lam - lam_0) / eps`` of the contact equation [m]."""
        return self.gap + (self.force - self.multiplier) / self.pair.penalty

    @property
    def vector(self) -> Floats:
        """Force ``-s lam n + T t`` ``(2,)`` of the node on the strip, in the global frame [N]."""
        normal = self.pair.contact.sign * self.force * self.at.normal
        return self.tangential * self.at.tangent - normal

    @cached_property
    def columns(self) -> Floats:
        """Columns ``U`` ``(2 n, 4)``: ``dg/du``, ``W^T t``, ``W'^T n``, ``W'^T t``; only friction needs the last one."""
        pair, t, n = self.pair, self.at.tangent, self.at.normal
        basis = pair.curve.basis(self.at.zeta)[[0, 0, 1, 1]]
        directions = np.stack([-pair.contact.sign * n, t, n, t])
        U = pair.carrier.columns(basis, directions)
        if isinstance(pair.node, Carrier):
            U[:, :2] -= pair.node.columns(np.ones((2, 1)), directions[:2])
        return U

    @property
    def curvature(self) -> Floats:
        """Matrix H ``(4, 4)`` of the gap's second derivative ``U H U^T`` [1/m]."""
        at, H = self.at, np.zeros((4, 4))
        H[1, 1], H[2, 2] = at.bend, at.distance
        H[1, 2] = H[2, 1] = -at.stretch
        return -self.pair.contact.sign * H / (at.stretch**2 - at.distance * at.bend)

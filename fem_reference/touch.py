"""A contact in a state: its variables, its projection, and the residuals and the stiffness that follow from them."""

from dataclasses import dataclass

from fem_reference.arrays import Floats
from fem_reference.contact import Pair
from fem_reference.curve import Projection
from fem_reference.friction import Friction, force_curvature, slip_increment, slip_residual


@dataclass(frozen=True, kw_only=True)
class Condition:
    """Variables of a contact that do not follow from the displacements."""

    closed: bool = False  # whether the contact is active
    # whether the contact may close. It may not after its node left the strip over an end, until the node
    # has returned to its side
    armed: bool = True
    force: float = 0.0  # contact force lam, positive in compression; zero if open [N]
    multiplier: float = 0.0  # multiplier lam_0 of the augmented Lagrangian; zero for the penalty method [N]
    friction: Friction | None = None  # friction of the contact, open or closed; None without friction

    def opened(self, *, armed: bool) -> "Condition":
        """Return the condition of the contact after opening."""
        friction = None if self.friction is None else self.friction.opened()
        return Condition(closed=False, armed=armed, friction=friction)


@dataclass(frozen=True, kw_only=True, eq=False)
class Touch:
    """A contact in a state.

    Parameters
    ----------
    pair, condition
        The contact and its condition.
    projection
        Projection of the node on the contact curve.
    slopes, curvature
        Factors ``U (2 n, 3)`` and ``H (3, 3)`` of the gap's derivatives, see `fem_reference.contact`. With friction U has a
        fourth column, see `fem_reference.friction`.
    """

    pair: Pair
    condition: Condition
    projection: Projection
    slopes: Floats
    curvature: Floats

    @property
    def closed(self) -> bool:
        """Whether the contact is active."""
        return self.condition.closed

    @property
    def force(self) -> float:
        """Contact force lam [N]."""
        return self.condition.force

    @property
    def gap(self) -> float:
        """Signed distance of the node from the contact curve or its continuation beyond an end [m]."""
        return float(self.pair.gap(self.projection))

    @property
    def reported_gap(self) -> float:
        """Gap; for a node beyond an end of the strip the distance from this end [m]."""
        end_gap = self.projection.end_distance - self.pair.radius
        return self.gap if self.projection.inside else float(end_gap)

    @property
    def gap_residual(self) -> float:
        """Residual ``g + (lam - lam_0) / eps`` of the contact equation; zero if open [m]."""
        added = self.force - self.condition.multiplier
        return self.gap + added / self.pair.penalty if self.closed else 0.0

    @property
    def friction(self) -> Friction | None:
        """Friction of the contact if it is closed; None without friction."""
        return self.condition.friction if self.closed else None

    @property
    def tangential_force(self) -> float:
        """Tangential force T on the strip along the tangent [N]."""
        return 0.0 if self.friction is None else self.friction.force

    @property
    def slip(self) -> float:
        """Slip since the last accepted state, also where the contact is open; zero without friction [m]."""
        friction = self.condition.friction
        return 0.0 if friction is None else float(slip_increment(self.pair, self.projection, friction))

    @property
    def slip_residual(self) -> float:
        """Residual of the friction's equation, see `fem_reference.friction.slip_residual`; zero without friction."""
        if self.friction is None:
            return 0.0
        return slip_residual(self.pair, self.projection, self.friction, self.force)

    @property
    def stiffness(self) -> Floats:
        """Derivative of the contact force in the columns: ``lam H``, and ``T G`` of friction, ``(3, 3)`` or ``(4, 4)``."""
        normal = self.force * self.curvature
        if self.friction is None:
            return normal
        both = self.friction.force * force_curvature(self.pair, self.projection)
        both[: len(normal), : len(normal)] += normal
        return both

"""Tolerances and limits of the solution."""

from dataclasses import dataclass

from fem_reference.checks import require, require_choice

BRANCHES = ("stop", "stable", "primary")


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Tolerances and limits of the solution.

    Parameters
    ----------
    tolerance
        Largest accepted nodal residual, relative to the largest of the contact forces, the end loads and ``E I / L^2``.
        The round-off of a nodal force is added.
    max_iterations
        Largest number of Newton iterations with one set of closed contacts. Near a buckling load 30 are needed, because a
        large bending correction also stretches the strip and changes the sign of its lateral stiffness.
    largest_growth
        A correction is halved if the next correction exceeds it by this factor. A factor near one also rejects corrections that
        converge.
    max_contact_changes
        Largest number of changes of the set of closed contacts in one attempt.
    max_augmentations
        Largest number of augmented Lagrangian steps in one attempt.
    max_penetration
        Largest accepted penetration, relative to the strip's length.
    min_step
        Smallest step of the load parameter.
    max_attempts
        Largest number of attempts between two requested load parameters. The double beam needs 82 from 0 to 1.
    first_step
        First step of the load parameter, unless the first requested load parameter is smaller.
    largest_departure
        Largest accepted distance of a step from the tangents at its ends, relative to the step's length.
    branch
        Continuation at a bifurcation. ``"stop"``: the path ends; ``"stable"``: it continues on the stable branch of lower
        energy; ``"primary"``: it continues on the same branch, whose index counts the unstable modes. At a limit
        point every path ends.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    tolerance: float = 1e-9
    max_iterations: int = 40
    largest_growth: float = 5.0
    max_contact_changes: int = 6
    max_augmentations: int = 12
    max_penetration: float = 1e-3
    min_step: float = 1e-6
    max_attempts: int = 100
    first_step: float = 0.1
    largest_departure: float = 1 / 3
    branch: str = "stop"

    def __post_init__(self) -> None:
        for field in ("tolerance", "max_penetration", "min_step", "first_step", "largest_departure"):
            require(self, field, 0 < getattr(self, field) < 1, "must lie strictly between 0 and 1")
        require(self, "largest_growth", self.largest_growth >= 1, "must be at least 1")
        least = {"max_iterations": 1, "max_contact_changes": 0, "max_augmentations": 0, "max_attempts": 1}
        for field, low in least.items():
            value = getattr(self, field)
            rule = f"must be a whole number, >= {low}"
            require(self, field, isinstance(value, int) and value >= low, rule)
        require_choice(self, "branch", BRANCHES)

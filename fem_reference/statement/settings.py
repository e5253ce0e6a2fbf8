"""Tolerances and limits of the solution."""

from dataclasses import dataclass

from fem_reference.statement.checks import require, require_choice

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
        Largest number of Newton iterations with one set of closed contacts. Near a buckling load 30 are needed.
    min_step
        Smallest step of the load parameter.
    max_attempts
        Largest number of attempts between two requested load parameters. The double beam needs 82 from 0 to 1.
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
    min_step: float = 1e-6
    max_attempts: int = 100
    branch: str = "stop"

    def __post_init__(self) -> None:
        for field in ("tolerance", "min_step"):
            require(self, field, 0 < getattr(self, field) < 1, "must lie strictly between 0 and 1")
        for field in ("max_iterations", "max_attempts"):
            value = getattr(self, field)
            require(self, field, isinstance(value, int) and value >= 1, "must be a whole number, >= 1")
        require_choice(self, "branch", BRANCHES)

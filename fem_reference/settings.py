"""How a problem is solved."""

from dataclasses import dataclass

BRANCHES = ("stop", "stable", "primary")


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Tolerances and limits of the solution.

    Parameters
    ----------
    tolerance
        Largest nodal residual accepted, relative to the larger of contact force and ``E I / L^2``; the round-off of
        a nodal force is added.
    max_iterations
        Newton iterations with one set of closed contacts. Next to a buckling load 30 are needed: bending that overshoots into
        stretch changes the sign of what resists it.
    largest_growth, smallest_damping
        A correction that the next one exceeds by this factor is halved, down to this part of it. Bending that overshoots
        into stretch makes a good correction's successor grow too: a factor near one costs more than it saves.
    max_contact_changes
        Changes of the set of closed contacts in one attempt.
    max_augmentations
        Augmented Lagrangian steps in one attempt.
    max_penetration
        Largest penetration accepted, relative to the strip's length.
    balance_tolerance
        Largest accepted mismatch of clamp reactions and contact forces, relative as above.
    min_step
        Smallest step of the load parameter.
    max_attempts
        Steps tried between two load parameters. The double beam takes 82 where one step is asked for.
    predictor_order
        Degree of the polynomial in the load parameter that extrapolates accepted states and their rates, at most 5.
    first_step
        First step of the load parameter, unless the first load parameter is smaller.
    largest_departure
        Largest distance of a step from the tangents at its ends, relative to its length, that is accepted.
    branch
        What happens at a critical point. ``"stop"``: the path ends there by name; ``"stable"``: at a bifurcation it turns to
        the stable branch of less energy; ``"primary"``: it goes on where the rate does, and the index says what is unstable.
        At a limit point no path goes on with the load parameter: it ends.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    tolerance: float = 1e-9
    max_iterations: int = 40
    largest_growth: float = 5.0
    smallest_damping: float = 1 / 64
    max_contact_changes: int = 6
    max_augmentations: int = 12
    max_penetration: float = 1e-3
    balance_tolerance: float = 1e-6
    min_step: float = 1e-6
    max_attempts: int = 100
    predictor_order: int = 3
    first_step: float = 0.1
    largest_departure: float = 1 / 3
    branch: str = "stop"

    def __post_init__(self) -> None:
        for field in (
            "tolerance",
            "smallest_damping",
            "max_penetration",
            "balance_tolerance",
            "min_step",
            "first_step",
            "largest_departure",
        ):
            value = getattr(self, field)
            if not 0 < value < 1:
                raise ValueError(f"Settings.{field} = {value!r}: must lie strictly between 0 and 1")
        if not self.largest_growth >= 1:
            raise ValueError(f"Settings.largest_growth = {self.largest_growth!r}: must be at least 1")
        for field, low in (
            ("max_iterations", 1),
            ("max_contact_changes", 0),
            ("max_augmentations", 0),
            ("max_attempts", 1),
            ("predictor_order", 0),
        ):
            value = getattr(self, field)
            if not isinstance(value, int) or value < low:
                raise ValueError(f"Settings.{field} = {value!r}: must be a whole number, >= {low}")
        if self.branch not in BRANCHES:
            raise ValueError(
                f"Settings.branch = {self.branch!r}: must be one of {', '.join(map(repr, BRANCHES))}"
            )

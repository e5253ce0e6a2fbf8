"""How a problem is solved."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Tolerances and limits of the solution.

    Parameters
    ----------
    tolerance
        Largest nodal residual accepted, relative to the larger of contact force and ``E I / L^2``; the round-off of
        a nodal force is added.
    max_iterations
        Newton iterations in one attempt.
    max_contact_changes
        Changes between open and closed in one attempt.
    balance_tolerance
        Largest accepted mismatch of clamp reaction and contact force, relative as above.
    min_step
        Smallest step of the load parameter.
    predictor_order
        Degree of the polynomial in the load parameter that extrapolates accepted states.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    tolerance: float = 1e-9
    max_iterations: int = 12
    max_contact_changes: int = 4
    balance_tolerance: float = 1e-6
    min_step: float = 1e-6
    predictor_order: int = 3

    def __post_init__(self) -> None:
        for field in ("tolerance", "balance_tolerance", "min_step"):
            value = getattr(self, field)
            if not 0 < value < 1:
                raise ValueError(f"Settings.{field} = {value!r}: must lie strictly between 0 and 1")
        for field, low in (("max_iterations", 1), ("max_contact_changes", 0), ("predictor_order", 0)):
            value = getattr(self, field)
            if not isinstance(value, int) or value < low:
                raise ValueError(f"Settings.{field} = {value!r}: must be a whole number, >= {low}")

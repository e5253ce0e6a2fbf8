"""Checks of the input of the exact solutions."""

import math


def require_positive(*, infinite: bool = False, **values: float) -> None:
    """Raise `ValueError` naming the first value that is not positive, and finite unless it may be infinite."""
    for name, value in values.items():
        if not (value > 0.0 and (infinite or math.isfinite(value))):
            raise ValueError(f"{name} = {value}: must be positive{'' if infinite else ' and finite'}")


def require_not_negative(**values: float) -> None:
    """Raise `ValueError` naming the first value that is negative or not finite."""
    for name, value in values.items():
        if not (math.isfinite(value) and value >= 0.0):
            raise ValueError(f"{name} = {value}: must be finite and not negative")

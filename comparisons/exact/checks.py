"""Rules that the input of the exact answers keeps."""

import math


def require_positive(**values: float) -> None:
    """Raise `ValueError` naming the first value that is not positive and finite."""
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0.0):
            raise ValueError(f"{name} = {value}: must be positive and finite")

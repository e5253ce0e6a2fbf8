"""Checks of input data. An error message is one line with owner, field, value and rule."""

from collections.abc import Iterable
from math import inf, isfinite

Point = tuple[float, float]


def require(condition: bool, owner: str, field: str, value: object, rule: str) -> None:
    """Raise a ``ValueError`` with the value and the rule unless ``condition`` holds."""
    if not condition:
        raise ValueError(f"{owner}.{field} = {value!r}: {rule}")


def require_positive(owner: str, field: str, value: float) -> None:
    """Require a positive finite number."""
    require(isfinite(value) and value > 0, owner, field, value, "must be positive and finite")


def require_finite(owner: str, field: str, value: tuple[float, ...], count: int, least: float = -inf) -> None:
    """Require ``count`` finite numbers, none below ``least``."""
    fits = len(value) == count and all(isfinite(part) and part >= least for part in value)
    rule = f"must be {('one', 'two', 'three')[count - 1]} finite number" + "s" * (count > 1)
    require(fits, owner, field, value, rule + (", none negative" if least == 0 else ""))


def require_choice(owner: str, field: str, value: object, options: tuple[object, ...]) -> None:
    """Require one of ``options``."""
    require(value in options, owner, field, value, f"must be one of {', '.join(map(repr, options))}")


def require_distinct(owner: str, field: str, names: Iterable[object]) -> None:
    """Require that no name appears twice."""
    seen: set[object] = set()
    for name in names:
        require(name not in seen, owner, field, name, "must not appear twice")
        seen.add(name)

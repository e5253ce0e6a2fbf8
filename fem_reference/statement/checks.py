"""Checks of input data. An error message is one line with owner, field, value and rule."""

from collections.abc import Iterable
from math import inf, isfinite
from typing import Any

Point = tuple[float, float]
_OWN = object()


def require(record: Any, field: str, condition: bool, rule: str, value: object = _OWN) -> None:
    """Raise a ``ValueError`` unless ``condition`` holds, with the rule and the field's value or another one."""
    if not condition:
        names = [getattr(record, key, None) for key in ("name", "node", "ends", "strip")]
        known = [f"({name!r})" for name in names if isinstance(name, str | tuple)]
        owner = type(record).__name__ + (known[0] if known else "")
        raise ValueError(f"{owner}.{field} = {getattr(record, field) if value is _OWN else value!r}: {rule}")


def require_positive(record: Any, *fields: str) -> None:
    """Require positive finite numbers, or None."""
    for field in fields:
        value = getattr(record, field)
        fits = value is None or (isfinite(value) and value > 0)
        require(record, field, fits, "must be positive and finite")


def require_finite(
    record: Any, field: str, values: Iterable[float], count: int = 1, least: float = -inf
) -> None:
    """Require ``count`` finite numbers, none below ``least``."""
    found = tuple(values)
    fits = len(found) == count and all(isfinite(part) and part >= least for part in found)
    rule = f"must be {('one', 'two', 'three')[count - 1]} finite number" + "s" * (count > 1)
    require(record, field, fits, rule + ", none negative" * (least == 0), found if count > 1 else found[0])


def require_choice(record: Any, field: str, options: tuple[object, ...]) -> None:
    """Require one of ``options``."""
    rule = f"must be one of {', '.join(map(repr, options))}"
    require(record, field, getattr(record, field) in options, rule)


def require_distinct(record: Any, field: str, names: Iterable[object]) -> None:
    """Require that no name appears twice."""
    seen: set[object] = set()
    for name in names:
        require(record, field, name not in seen, "must not appear twice", name)
        seen.add(name)

"""Rules for single values of a scene. A rule returns the value in its stored form, or raises an error with its sentence.

A record names the rule of a field in the field's type, ``Annotated[float, positive]``; `comparisons.scene.record` applies them.
"""

import math
from collections.abc import Callable, Collection
from dataclasses import dataclass, fields
from functools import cache
from itertools import pairwise
from typing import Annotated, get_args, get_type_hints

from comparisons.scene.values import toml_value

Point = tuple[float, float]
Rule = Callable[[object], object]


LARGEST = 1e50
"""Largest magnitude of a number: squares, products and quotients of such numbers stay in floating-point range."""
RANGE = (1e-100, 1e100)
"""Range of positive quantities: moduli, dimensions of sections, stiffnesses."""
MOST_FRICTION = 100.0
"""Largest coefficient of friction; the force then leans 89.4 degrees."""


class RuleError(ValueError):
    """The sentence of a rule that a value breaks."""


class FieldError(ValueError):
    """A mistake: a value of a record breaks a rule, ``KEY = VALUE: RULE`` in one line.

    Parameters
    ----------
    key : str
        The field, with its place in the scene where that is known (``beam[0].height``).
    value : object
        The value found; `MISSING` where there is none.
    rule : str
        The sentence that the value breaks.
    """

    def __init__(self, key: str, value: object, rule: str) -> None:
        super().__init__(f"{key} = {shown(value)}: {rule}")
        self.key, self.value, self.rule = key, value, rule

    @property
    def mistakes(self) -> "tuple[FieldError, ...]":
        """Every single mistake."""
        return (self,)

    def within(self, prefix: str) -> "FieldError":
        """Return the same error with `prefix` before every key."""
        return FieldError(prefix + self.key, self.value, self.rule)


class RecordError(FieldError):
    """Several mistakes, each in one line; `key`, `value` and `rule` are those of the first.

    Parameters
    ----------
    mistakes : collection of FieldError
        At least one.
    """

    def __init__(self, mistakes: Collection[FieldError]) -> None:
        self._mistakes = tuple(mistakes)
        first = self._mistakes[0]
        super().__init__(first.key, first.value, first.rule)
        self.args = ("\n".join(map(str, self._mistakes)),)

    @property
    def mistakes(self) -> tuple[FieldError, ...]:
        """Every single mistake."""
        return self._mistakes

    def within(self, prefix: str) -> FieldError:
        """Return the same error with `prefix` before every key."""
        return RecordError([mistake.within(prefix) for mistake in self._mistakes])


class Missing:
    """The value of a key that is not there."""


MISSING = Missing()


def shown(value: object) -> str:
    """Return `value` as it would stand in a TOML file, in one line of at most 60 characters."""
    try:
        text = "(missing)" if value is MISSING else " ".join(toml_value(value).split())
    except RecursionError:
        text = "(nested too deeply)"
    return text if len(text) <= 60 else text[:57] + "..."


@cache
def field_rules(kind: type) -> dict[str, Rule]:
    """Return the rule of every field, the first annotation of its type."""
    own = {item.name for item in fields(kind)}
    hints = ((name, hint) for name, hint in get_type_hints(kind, include_extras=True).items() if name in own)
    return {
        name: next(part for part in (hint, *get_args(hint)) if hasattr(part, "__metadata__")).__metadata__[0]
        for name, hint in hints
    }


def number(value: object, largest: float = LARGEST) -> float:
    """Accept a finite number of at most 1e50 in size; a truth value is not a number."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise RuleError("must be a number")
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not math.isfinite(result):
        raise RuleError("must be a finite number")
    if abs(result) > largest:
        raise RuleError(f"must be at most {largest:g} in size")
    return result


def positive(value: object) -> float:
    """Accept a number above zero, from 1e-100 to 1e100."""
    result = number(value, math.inf)
    if result <= 0.0:
        raise RuleError("must be positive")
    if not RANGE[0] <= result <= RANGE[1]:
        raise RuleError(f"must lie between {RANGE[0]:g} and {RANGE[1]:g}")
    return result


def not_negative(value: object) -> float:
    """Accept zero, or a positive number."""
    result = number(value, math.inf)
    if result < 0.0:
        raise RuleError("must not be negative")
    return positive(result) if result else 0.0


def dimension(value: object) -> float | tuple[float, float]:
    """Accept a positive number, or two that state a dimension at the start and at the end of a beam."""
    if not isinstance(value, list | tuple):
        return positive(value)
    if len(value) != 2:
        raise RuleError("must be a number, or two numbers [at the start, at the end]")
    start, end = positive(value[0]), positive(value[1])
    return start if start == end else (start, end)


def turn(value: object) -> float:
    """Accept the angle by which an arc turns, less than a whole turn."""
    result = number(value)
    if not abs(result) < 2.0 * math.pi:
        raise RuleError("must be less than 2 pi in size, an angle in rad")
    return result


def span(value: object) -> tuple[float, float]:
    """Accept two fractions of a beam that rise."""
    a, b = point(value)
    if not 0.0 <= a < b <= 1.0:
        raise RuleError("must be two fractions of the length that rise from 0 to 1")
    return a, b


def stiffnesses(value: object) -> Point:
    """Accept two numbers [x, y], neither negative."""
    x, y = point(value)
    return not_negative(x), not_negative(y)


def friction(value: object) -> float:
    """Accept a coefficient of friction, between 0 and 100."""
    result = number(value)
    if not 0.0 <= result <= MOST_FRICTION:
        raise RuleError(f"must lie between 0 and {MOST_FRICTION:g}")
    return result


def fraction(value: object) -> float:
    """Accept a number between zero and one."""
    result = number(value)
    if not 0.0 < result < 1.0:
        raise RuleError("must lie between 0 and 1")
    return result


def poissons_ratio(value: object) -> float:
    """Accept Poisson's ratio of an isotropic solid, between -1 and 1/2."""
    result = number(value)
    if not -1.0 < result < 0.5:
        raise RuleError("must lie between -1 and 0.5, both excluded")
    return result


def whole_number(value: object, largest: int = 100_000) -> int:
    """Accept a whole number from 1 to `largest`, 100,000 if not stated."""
    if isinstance(value, bool) or not isinstance(value, int):
        raise RuleError("must be a whole number")
    if not 1 <= value <= largest:
        raise RuleError(f"must lie between 1 and {largest}")
    return value


def sequence(value: object) -> tuple[object, ...]:
    """Accept a list, kept as a tuple."""
    if not isinstance(value, list | tuple):
        raise RuleError("must be a list")
    return tuple(value)


def parts(value: object) -> tuple[float, ...]:
    """Accept numbers that rise between 0 and 1."""
    items = tuple(number(item) for item in sequence(value))
    if not all(a < b for a, b in pairwise((0.0, *items, 1.0))):
        raise RuleError("must rise between 0 and 1, both excluded")
    return items


def mesh(value: object) -> tuple[int, int]:
    """Accept the numbers of elements along and across a solid strip."""
    items = sequence(value)
    if len(items) != 2:
        raise RuleError("must be [elements along, elements across]")
    along, across = (whole_number(item, 100_000) for item in items)
    return along, across


def mesh_text(value: object) -> tuple[int, int]:
    """Accept the numbers of elements along and across as ``50x2``."""
    along, separator, across = value.partition("x") if isinstance(value, str) else ("", "", "")
    if not separator or not (along + across).isdecimal():
        raise RuleError("must be NXxNY, as 50x2")
    return mesh((int(along), int(across)))


def point(value: object) -> Point:
    """Accept a point or vector [x, y] of the plane."""
    if isinstance(value, list | tuple) and len(value) == 3:
        raise RuleError("must be two numbers [x, y], a third dimension is not modelled")
    if not isinstance(value, list | tuple) or len(value) != 2:
        raise RuleError("must be two numbers [x, y]")
    x, y = (number(item) for item in value)
    return x, y


def further_points(value: object) -> tuple[Point, ...]:
    """Accept at least one point, no two consecutive ones equal."""
    points = tuple(point(item) for item in sequence(value))
    if not points:
        raise RuleError("must have at least one point")
    if any(a == b for a, b in pairwise(points)):
        raise RuleError("must move: two consecutive points are equal")
    return points


def polyline(value: object) -> tuple[Point, ...]:
    """Accept at least two points, no two consecutive ones equal."""
    points = further_points(value)
    if len(points) < 2:
        raise RuleError("must have at least two points")
    return points


def text(value: object) -> str:
    """Accept a printable text that is not empty."""
    if not isinstance(value, str):
        raise RuleError("must be a text")
    if not value.strip() or not value.isprintable():
        raise RuleError("must be a printable text, not empty")
    return value


def name(value: object) -> str:
    """Accept a name that can stand in a reference (``upper.end``, ``pin->cantilever``) and in a file name."""
    result = text(value)
    if not all(c.isalnum() or c in "-_" for c in result):
        raise RuleError("must consist of letters, digits, '-' and '_'")
    return result


def units(value: object) -> str:
    """Accept the unit of force and the unit of length, as ``N, m``."""
    result = text(value)
    if len(result.split(",")) != 2 or not all(part.strip() for part in result.split(",")):
        raise RuleError('must be the units of force and of length, as "N, m"')
    return result


def truth(value: object) -> bool:
    """Accept true or false."""
    if not isinstance(value, bool):
        raise RuleError("must be true or false")
    return value


@dataclass(frozen=True)
class Choice:
    """The rule: one of `options`."""

    options: tuple[str, ...]

    def __call__(self, value: object) -> str:
        """Accept an option."""
        if not isinstance(value, str) or value not in self.options:
            raise RuleError("must be one of " + ", ".join(f'"{option}"' for option in self.options))
        return value


@dataclass(frozen=True)
class Subset:
    """The rule: some of `options`, each once."""

    options: tuple[str, ...]

    def __call__(self, value: object) -> tuple[str, ...]:
        """Accept a list of options."""
        items = sequence(value)
        wanted = ", ".join(f'"{option}"' for option in self.options)
        if not items or any(item not in self.options for item in items) or len(set(items)) != len(items):
            raise RuleError(f"must be a list of some of {wanted}, each once")
        return tuple(str(item) for item in items)


def choice(*options: str) -> Choice:
    """Return the rule: one of `options`."""
    return Choice(options)


def subset(*options: str) -> Subset:
    """Return the rule: some of `options`, each once."""
    return Subset(options)


def ends(value: object) -> tuple[str, ...]:
    """Accept no, one or both ends of a beam."""
    if sequence(value) in ((), ("start",), ("end",), ("start", "end"), ("end", "start")):
        return tuple(str(item) for item in sequence(value))
    raise RuleError('must be [], ["start"], ["end"] or ["start", "end"]')


def records(kind: type, at_least: int = 0) -> Rule:
    """Return the rule: a list of records of one kind."""

    def rule(value: object) -> tuple[object, ...]:
        items = sequence(value)
        if len(items) < at_least or not all(isinstance(item, kind) for item in items):
            raise RuleError(
                f"must be {'at least one' if at_least else 'records of the kind'} {kind.__name__}"
            )
        return items

    return rule


Number = Annotated[float, number]
Positive = Annotated[float, positive]
Friction = Annotated[float, friction]
Count = Annotated[int, whole_number]
NotNegative = Annotated[float, not_negative]
Dimension = Annotated[float | tuple[float, float], dimension]
Vector = Annotated[Point, point]
Name = Annotated[str, name]
End = Annotated[str, choice("start", "end")]

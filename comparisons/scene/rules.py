"""Rules for single values of a scene, and the mistakes that they state.

A rule is a value: called, it returns the stored form of a value or raises its sentence; `accepts` says it in words and `schema` in JSON
Schema.
"""

import dataclasses
import math
import operator
from collections.abc import Callable, Collection, Iterator, Mapping
from itertools import pairwise
from typing import Any, Generic, TypeVar

from comparisons.scene.values import toml_value

Point = tuple[float, float]
Rule = Callable[[object], object]
T_co = TypeVar("T_co", covariant=True)

LARGEST = 1e50
"""Largest magnitude of a number: squares, products and quotients of such numbers stay in floating-point range."""
RANGE = (1e-100, 1e100)
"""Range of positive quantities: moduli, dimensions of sections, stiffnesses."""
MOST = 1000
"""Number of mistakes from which the reader of a file looks for no more."""
MISSING: Any = dataclasses.MISSING
"""The value of a key that is not there."""
UNREADABLE: Any = object()
"""The value of a key that is stated, and wrong in a way that is reported elsewhere."""


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
    """Several mistakes, each in one line, the first one's key, value and rule; `found` has the values that are right."""

    def __init__(self, mistakes: Collection[FieldError], found: Any = None) -> None:
        self._mistakes, self.found = tuple(mistakes), found
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


Mistakes = Iterator[FieldError]


def shown(value: object) -> str:
    """Return `value` as it would stand in a TOML file, in one line of at most 60 characters."""
    try:
        text = "(missing)" if value is MISSING else " ".join(toml_value(value).split())
    except RecursionError:
        text = "(nested too deeply)"
    return text if len(text) <= 60 else text[:57] + "..."


class ValueRule(Generic[T_co]):
    """A rule as a value: it reads a value, says what it accepts, and has its JSON Schema."""

    def __init__(self, read: Callable[[object], T_co], accepts: str, schema: Mapping[str, Any]) -> None:
        self._read, self.accepts, self.schema = read, accepts, schema

    def __call__(self, value: object) -> T_co:
        """Return the stored form of `value`, or raise `RuleError`."""
        return self._read(value)


def rule(**schema: Any) -> Callable[[Callable[[object], T_co]], ValueRule[T_co]]:
    """Make a rule of a function, whose docstring is ``Accept ...``."""
    return lambda read: ValueRule(
        read, (read.__doc__ or "").removeprefix("Accept ").removesuffix("."), schema
    )


COMPARED: dict[str, Callable[[float, float], bool]] = {
    "minimum": operator.ge,
    "maximum": operator.le,
    "exclusiveMinimum": operator.gt,
    "exclusiveMaximum": operator.lt,
}
"""Limits of a number by their names in JSON Schema."""


def limited(accepts: str, refusal: str = "", *, scaled: bool = False, **limits: float) -> ValueRule[float]:
    """Return the rule: a finite number within `limits`, else `refusal`; `scaled`, its range is `RANGE` or zero."""
    least, most = RANGE if scaled else (0.0, LARGEST)

    def read(value: object) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise RuleError("must be a number")
        if not all(COMPARED[name](value, limit) for name, limit in limits.items()):
            raise RuleError(refusal)
        if value and not least <= abs(value) <= most:
            raise RuleError(f"must be a finite number, from {least:g} to {most:g} in size")
        return abs(float(value)) if scaled else float(value)

    return ValueRule(read, accepts, {"type": "number", **limits})


number = limited("a finite number of at most 1e50 in size; a truth value is not a number")
positive = limited(
    "a number above zero, from 1e-100 to 1e100", "must be positive", scaled=True, exclusiveMinimum=0
)
not_negative = limited("zero, or a positive number", "must not be negative", scaled=True, minimum=0)
turn = limited(
    "the angle by which an arc turns, less than a whole turn",
    "must be less than 2 pi in size, an angle in rad",
    exclusiveMinimum=-2.0 * math.pi,
    exclusiveMaximum=2.0 * math.pi,
)
friction = limited(
    "a coefficient of friction, between 0 and 100", "must lie between 0 and 100", minimum=0, maximum=100.0
)
fraction = limited(
    "a number between zero and one", "must lie between 0 and 1", exclusiveMinimum=0, exclusiveMaximum=1
)
poissons_ratio = limited(
    "Poisson's ratio of an isotropic solid, between -1 and 1/2",
    "must lie between -1 and 0.5, both excluded",
    exclusiveMinimum=-1,
    exclusiveMaximum=0.5,
)


def whole(largest: int = 100_000) -> ValueRule[int]:
    """Return the rule: a whole number from 1 to `largest`."""

    def read(value: object) -> int:
        if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= largest:
            raise RuleError(f"must be a whole number from 1 to {largest}")
        return value

    schema = {"type": "integer", "minimum": 1, "maximum": largest}
    return ValueRule(read, f"a whole number from 1 to {largest:,}", schema)


whole_number = whole()


def sequence(value: object) -> tuple[object, ...]:
    """Return a list as a tuple."""
    if not isinstance(value, list | tuple):
        raise RuleError("must be a list")
    return tuple(value)


def several(
    accepts: str, refusal: str, item: ValueRule[Any], right: Callable[[Any], bool], **schema: Any
) -> ValueRule[tuple[Any, ...]]:
    """Return the rule: a list of items which are `right` together, else `refusal`."""

    def read(value: object) -> tuple[Any, ...]:
        found = tuple(map(item, sequence(value)))
        if not right(found):
            raise RuleError(refusal)
        return found

    return ValueRule(read, accepts, {"type": "array", "items": item.schema, **schema})


def pair(item: ValueRule[Any]) -> dict[str, Any]:
    """Return the schema of two items."""
    return {"type": "array", "items": item.schema, "minItems": 2, "maxItems": 2}


@rule(anyOf=[positive.schema, pair(positive)])
def dimension(value: object) -> float | tuple[float, float]:
    """Accept a positive number, or two that state a dimension at the start and at the end of a beam."""
    if not isinstance(value, list | tuple):
        return positive(value)
    if len(value) != 2:
        raise RuleError("must be a number, or two numbers [at the start, at the end]")
    start, end = positive(value[0]), positive(value[1])
    return start if start == end else (start, end)


@rule(**pair(number))
def point(value: object) -> Point:
    """Accept a point or vector [x, y] of the plane."""
    if not isinstance(value, list | tuple) or len(value) != 2:
        raise RuleError("must be two numbers [x, y], a third dimension is not modelled")
    return number(value[0]), number(value[1])


@rule(**{**pair(number), "items": {"type": "number", "minimum": 0, "maximum": 1}})
def span(value: object) -> Point:
    """Accept two fractions of a beam that rise."""
    a, b = point(value)
    if not 0.0 <= a < b <= 1.0:
        raise RuleError("must be two fractions of the length that rise from 0 to 1")
    return a, b


@rule(**pair(not_negative))
def stiffnesses(value: object) -> Point:
    """Accept two numbers [x, y], neither negative."""
    x, y = point(value)
    return not_negative(x), not_negative(y)


parts = several(
    "numbers that rise between 0 and 1",
    "must rise between 0 and 1, both excluded",
    number,
    lambda found: all(a < b for a, b in pairwise((0.0, *found, 1.0))),
    items=fraction.schema,
)
mesh = several(
    "the numbers of elements along and across a solid strip",
    "must be [elements along, elements across]",
    whole_number,
    lambda found: len(found) == 2,
    **pair(whole_number),
)


def mesh_text(value: object) -> tuple[int, ...]:
    """Accept the numbers of elements along and across as ``50x2``."""
    along, separator, across = value.partition("x") if isinstance(value, str) else ("", "", "")
    if not separator or not (along + across).isdecimal():
        raise RuleError("must be NXxNY, as 50x2")
    return mesh((int(along), int(across)))


def polyline(at_least: int) -> ValueRule[tuple[Point, ...]]:
    """Return the rule: points, no two consecutive ones equal."""
    return several(
        f"at least {at_least} points, no two consecutive ones equal",
        f"must list {at_least} or more points, no two consecutive ones equal",
        point,
        lambda found: len(found) >= at_least and all(a != b for a, b in pairwise(found)),
        minItems=at_least,
    )


@rule(type="string", minLength=1)
def text(value: object) -> str:
    """Accept a printable text that is not empty."""
    if not isinstance(value, str) or not value.strip() or not value.isprintable():
        raise RuleError("must be a printable text, not empty")
    return value


@rule(type="string", pattern=r"^[\w-]+$")
def name(value: object) -> str:
    """Accept a name that can stand in a reference (``upper.end``, ``pin->cantilever``) and in a file name."""
    result = text(value)
    if not all(c.isalnum() or c in "-_" for c in result):
        raise RuleError("must consist of letters, digits, '-' and '_'")
    return result


@rule(type="string", pattern="^[^,]*[^, ][^,]*,[^,]*[^, ][^,]*$")
def units(value: object) -> str:
    """Accept the unit of force and the unit of length, as ``N, m``."""
    result = text(value)
    if len(result.split(",")) != 2 or not all(part.strip() for part in result.split(",")):
        raise RuleError('must be the units of force and of length, as "N, m"')
    return result


@rule(type="boolean")
def truth(value: object) -> bool:
    """Accept true or false."""
    if not isinstance(value, bool):
        raise RuleError("must be true or false")
    return value


def _options(options: tuple[str, ...], quote: str = '"') -> str:
    return ", ".join(f"{quote}{option}{quote[::-1]}" for option in options)


def choice(*options: str) -> ValueRule[str]:
    """Return the rule: one of `options`."""

    def read(value: object) -> str:
        if not isinstance(value, str) or value not in options:
            raise RuleError(f"must be one of {_options(options)}")
        return value

    return ValueRule(read, "one of " + _options(options, '``"'), {"enum": list(options)})


def subset(*options: str, at_least: int = 0) -> ValueRule[tuple[str, ...]]:
    """Return the rule: some of `options`, each once."""
    return several(
        "a list of some of " + _options(options, '``"'),
        f"must be a list of some of {_options(options)}, each once",
        choice(*options),
        lambda found: at_least <= len(found) == len(set(found)),
        uniqueItems=True,
        minItems=at_least,
    )


class Records(ValueRule[tuple[Any, ...]]):
    """The rule: a list of tables ``[[name]]``, each of which states a record of one kind, or of such records."""

    def __init__(self, name: str, kind: type, at_least: int = 0) -> None:
        self.name, self.kind = name, kind
        super().__init__(self._records, f"a list of {kind.__name__}", {"type": "array", "minItems": at_least})

    def _records(self, value: object) -> tuple[Any, ...]:
        kinds = (self.kind, dict)
        if not isinstance(value, list | tuple) or not all(isinstance(item, kinds) for item in value):
            raise RuleError(f"must be a list of tables, [[{self.name}]]")
        if len(value) < self.schema["minItems"]:
            raise RuleError(f"must have at least one table, [[{self.name}]]")
        found: list[Any] = []
        mistakes: list[FieldError] = []
        for i, item in enumerate(value):
            try:
                found.append(self.kind(**item) if isinstance(item, dict) else item)
            except RecordError as error:
                mistakes += (mistake.within(f"{self.name}[{i}].") for mistake in error.mistakes)
                found.append(error.found)
            if len(mistakes) > MOST:
                raise RecordError(mistakes, UNREADABLE)
        if mistakes:
            raise RecordError(mistakes, tuple(found))
        return tuple(found)

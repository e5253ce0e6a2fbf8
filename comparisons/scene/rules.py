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
LIST = {"type": "array", "minItems": 1}
"""Schema of a list of tables."""
MISSING: Any = dataclasses.MISSING
"""The value of a key that is not there."""


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
    """Several mistakes, each in one line, the first one's key, value and rule; `record` has the values that are right."""

    def __init__(self, mistakes: Collection[FieldError], record: Any = None) -> None:
        self._mistakes, self.record = tuple(mistakes), record
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
    """A rule as a value: it reads a value, says what it accepts, and has its JSON Schema; of a list of records, their `kind`."""

    def __init__(
        self,
        read: Callable[[object], T_co],
        accepts: str,
        schema: Mapping[str, Any],
        kind: type | None = None,
    ) -> None:
        self._read, self.accepts, self.schema, self.kind = read, accepts, schema, kind

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
    largest = math.inf if scaled else LARGEST

    def read(value: object) -> float:
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
        if not all(COMPARED[name](result, limit) for name, limit in limits.items()):
            raise RuleError(refusal)
        if scaled and result and not RANGE[0] <= result <= RANGE[1]:
            raise RuleError(f"must lie between {RANGE[0]:g} and {RANGE[1]:g}")
        return abs(result) if scaled else result

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
        if isinstance(value, bool) or not isinstance(value, int):
            raise RuleError("must be a whole number")
        if not 1 <= value <= largest:
            raise RuleError(f"must lie between 1 and {largest}")
        return value

    schema = {"type": "integer", "minimum": 1, "maximum": largest}
    return ValueRule(read, f"a whole number from 1 to {largest:,}", schema)


whole_number = whole()


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
    if isinstance(value, list | tuple) and len(value) == 3:
        raise RuleError("must be two numbers [x, y], a third dimension is not modelled")
    if not isinstance(value, list | tuple) or len(value) != 2:
        raise RuleError("must be two numbers [x, y]")
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


def sequence(value: object) -> tuple[object, ...]:
    """Return a list as a tuple."""
    if not isinstance(value, list | tuple):
        raise RuleError("must be a list")
    return tuple(value)


@rule(type="array", items=fraction.schema)
def parts(value: object) -> tuple[float, ...]:
    """Accept numbers that rise between 0 and 1."""
    items = tuple(map(number, sequence(value)))
    if not all(a < b for a, b in pairwise((0.0, *items, 1.0))):
        raise RuleError("must rise between 0 and 1, both excluded")
    return items


@rule(**pair(whole_number))
def mesh(value: object) -> tuple[int, int]:
    """Accept the numbers of elements along and across a solid strip."""
    items = sequence(value)
    if len(items) != 2:
        raise RuleError("must be [elements along, elements across]")
    return whole_number(items[0]), whole_number(items[1])


def mesh_text(value: object) -> tuple[int, int]:
    """Accept the numbers of elements along and across as ``50x2``."""
    along, separator, across = value.partition("x") if isinstance(value, str) else ("", "", "")
    if not separator or not (along + across).isdecimal():
        raise RuleError("must be NXxNY, as 50x2")
    return mesh((int(along), int(across)))


@rule(type="array", items=point.schema, minItems=1)
def further_points(value: object) -> tuple[Point, ...]:
    """Accept at least one point, no two consecutive ones equal."""
    points = tuple(map(point, sequence(value)))
    if not points:
        raise RuleError("must have at least one point")
    if any(a == b for a, b in pairwise(points)):
        raise RuleError("must move: two consecutive points are equal")
    return points


@rule(type="array", items=point.schema, minItems=2)
def polyline(value: object) -> tuple[Point, ...]:
    """Accept at least two points, no two consecutive ones equal."""
    points = further_points(value)
    if len(points) < 2:
        raise RuleError("must have at least two points")
    return points


@rule(type="string", minLength=1)
def text(value: object) -> str:
    """Accept a printable text that is not empty."""
    if not isinstance(value, str):
        raise RuleError("must be a text")
    if not value.strip() or not value.isprintable():
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


def subset(*options: str) -> ValueRule[tuple[str, ...]]:
    """Return the rule: some of `options`, each once."""

    def read(value: object) -> tuple[str, ...]:
        items = sequence(value)
        if not items or any(item not in options for item in items) or len(set(items)) != len(items):
            raise RuleError(f"must be a list of some of {_options(options)}, each once")
        return tuple(map(str, items))

    schema = {"type": "array", "items": {"enum": list(options)}, "uniqueItems": True, "minItems": 1}
    return ValueRule(read, "a list of some of " + _options(options, '``"'), schema)


@rule(type="array", items={"enum": ["start", "end"]}, uniqueItems=True)
def ends(value: object) -> tuple[str, ...]:
    """Accept no, one or both ends of a beam."""
    if sequence(value) in ((), ("start",), ("end",), ("start", "end"), ("end", "start")):
        return tuple(map(str, sequence(value)))
    raise RuleError('must be [], ["start"], ["end"] or ["start", "end"]')


def records(kind: type, at_least: int = 0) -> ValueRule[tuple[Any, ...]]:
    """Return the rule: a list of records of one kind."""
    wanted = "at least one" if at_least else "records of the kind"

    def read(value: object) -> tuple[object, ...]:
        items = sequence(value)
        if len(items) < at_least or not all(isinstance(item, kind) for item in items):
            raise RuleError(f"must be {wanted} {kind.__name__}")
        return items

    return ValueRule(read, f"a list of {kind.__name__}", LIST, kind)

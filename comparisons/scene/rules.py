"""Rules for single values of a scene, and the mistakes that they state.

A rule is a value: called, it returns the stored form of a value, or raises its sentence, "must be" before what it accepts.
"""

import dataclasses
import math
import operator
from collections.abc import Callable, Collection, Iterator, Sequence
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
        self.mistakes: tuple[FieldError, ...] = (self,)
        """Every single mistake."""

    def within(self, prefix: str) -> "FieldError":
        """Return the same error with `prefix` before every key."""
        return FieldError(prefix + self.key, self.value, self.rule)


class RecordError(FieldError):
    """Several mistakes, each in one line, the first one's key, value and rule; `found` has the values that are right."""

    def __init__(self, mistakes: Collection[FieldError], found: Any = None) -> None:
        first = next(iter(mistakes))
        super().__init__(first.key, first.value, first.rule)
        self.args = ("\n".join(map(str, mistakes)),)
        self.mistakes, self.found = tuple(mistakes), found

    def within(self, prefix: str) -> FieldError:
        """Return the same error with `prefix` before every key."""
        return RecordError([mistake.within(prefix) for mistake in self.mistakes])


Mistakes = Iterator[FieldError]


def shown(value: object) -> str:
    """Return `value` as it would stand in a TOML file, in one line of at most 60 characters."""
    try:
        text = "(missing)" if value is MISSING else " ".join(toml_value(value).split())
    except RecursionError:
        text = "(nested too deeply)"
    return text if len(text) <= 60 else text[:57] + "..."


class ValueRule(Generic[T_co]):
    """A rule as a value: what it accepts in words, whether a value is right, the form in which it is stored, and the JSON Schema."""

    def __init__(
        self, accepts: str, right: Callable[[Any], object], stored: Callable[[Any], T_co], **schema: Any
    ) -> None:
        self.accepts, self.right, self.stored, self.schema = accepts, right, stored, schema

    def __call__(self, value: object) -> T_co:
        """Return the stored form of `value`, or raise `RuleError`."""
        if not self.right(value):
            raise RuleError(f"must be {self.accepts}")
        return self.stored(value)


COMPARED: dict[str, Callable[[float, float], bool]] = {
    "minimum": operator.ge,
    "maximum": operator.le,
    "exclusiveMinimum": operator.gt,
    "exclusiveMaximum": operator.lt,
}
"""Limits of a number by their names in JSON Schema."""


def limited(accepts: str, *, scaled: bool = False, **limits: float) -> ValueRule[float]:
    """Return the rule: a finite number within `limits`; `scaled`, it is zero or within `RANGE`."""
    least, most = RANGE if scaled else (0.0, LARGEST)

    def right(value: Any) -> bool:
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if not is_number or not all(COMPARED[name](value, limit) for name, limit in limits.items()):
            return False
        return not value or least <= abs(value) <= most

    return ValueRule(
        accepts, right, lambda value: abs(float(value)) if scaled else float(value), type="number", **limits
    )


number = limited("a finite number of at most 1e50 in size")
positive = limited("a positive number, from 1e-100 to 1e100", scaled=True, exclusiveMinimum=0)
not_negative = limited("zero, or a positive number from 1e-100 to 1e100", scaled=True, minimum=0)
TURN = 2.0 * math.pi
turn = limited("an angle in rad of less than 2 pi in size", exclusiveMinimum=-TURN, exclusiveMaximum=TURN)
friction = limited("a coefficient between 0 and 100", minimum=0, maximum=100.0)
fraction = limited("a number between 0 and 1", exclusiveMinimum=0, exclusiveMaximum=1)
poissons_ratio = limited(
    "a number between -1 and 0.5, both excluded", exclusiveMinimum=-1, exclusiveMaximum=0.5
)


def whole(largest: int = 100_000) -> ValueRule[int]:
    """Return the rule: a whole number from 1 to `largest`."""

    def right(value: Any) -> bool:
        return isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= largest

    return ValueRule(
        f"a whole number from 1 to {largest}", right, int, type="integer", minimum=1, maximum=largest
    )


whole_number = whole()


def several(
    accepts: str, item: ValueRule[Any], right: Callable[[Sequence[Any]], object], **schema: Any
) -> ValueRule[Any]:
    """Return the rule: a list of items that are `right` together."""
    return ValueRule(
        accepts,
        lambda value: isinstance(value, list | tuple) and all(map(item.right, value)) and right(value),
        lambda value: tuple(map(item.stored, value)),
        **{"type": "array", "items": item.schema, **schema},
    )


def two(
    accepts: str,
    item: ValueRule[Any],
    right: Callable[[Any, Any], object] = lambda a, b: True,  # noqa: ARG005
    **schema: Any,
) -> ValueRule[Any]:
    """Return the rule: a list of two items that are `right` together."""
    return several(
        accepts, item, lambda pair: len(pair) == 2 and right(*pair), minItems=2, maxItems=2, **schema
    )


def polyline(at_least: int) -> ValueRule[Any]:
    """Return the rule: points, no two consecutive ones equal."""
    return several(
        f"a list of {at_least} or more points [x, y], no two consecutive ones equal",
        point,
        lambda points: len(points) >= at_least and all(a != b for a, b in pairwise(map(tuple, points))),
        minItems=at_least,
    )


sequence = ValueRule("a list", lambda value: isinstance(value, list | tuple), tuple[object, ...])
point = two("two numbers [x, y], a third dimension is not modelled", number)
stiffnesses = two("two numbers [x, y], neither negative", not_negative)
span = two(
    "two fractions of the length that rise from 0 to 1",
    number,
    lambda a, b: 0.0 <= a < b <= 1.0,
    items={"type": "number", "minimum": 0, "maximum": 1},
)
mesh = two("[elements along, elements across]", whole_number)
parts = several(
    "a list of numbers that rise between 0 and 1, both excluded",
    number,
    lambda parts: all(a < b for a, b in pairwise((0.0, *parts, 1.0))),
    items=fraction.schema,
)
_ends = two("", positive)


def _dimension(value: Any) -> float | tuple[float, float]:
    """Return a number, or two where they differ."""
    if not _ends.right(value):
        return positive.stored(value)
    start, end = _ends.stored(value)
    return start if start == end else (start, end)


dimension = ValueRule(
    "a positive number, or two [at the start, at the end]",
    lambda value: positive.right(value) or _ends.right(value),
    _dimension,
    anyOf=[positive.schema, _ends.schema],
)


def mesh_text(value: object) -> tuple[int, int]:
    """Accept the numbers of elements along and across as ``50x2``."""
    along, separator, across = value.partition("x") if isinstance(value, str) else ("", "", "")
    if not separator or not (along + across).isdecimal():
        raise RuleError("must be NXxNY, as 50x2")
    found: tuple[int, int] = mesh((int(along), int(across)))
    return found


text = ValueRule(
    "a printable text, not empty",
    lambda value: isinstance(value, str) and value.strip() and value.isprintable(),
    str,
    type="string",
    minLength=1,
)
name = ValueRule(
    "a name of letters, digits, '-' and '_'",
    lambda value: text.right(value) and all(c.isalnum() or c in "-_" for c in value),
    str,
    type="string",
    pattern=r"^[\w-]+$",
)
units = ValueRule(
    'the units of force and of length, as "N, m"',
    lambda value: text.right(value) and [bool(part.strip()) for part in value.split(",")] == [True, True],
    str,
    type="string",
    pattern="^[^,]*[^, ][^,]*,[^,]*[^, ][^,]*$",
)
truth = ValueRule("true or false", lambda value: isinstance(value, bool), bool, type="boolean")


def choice(*options: str) -> ValueRule[str]:
    """Return the rule: one of `options`."""
    listed = ", ".join(map(shown, options))
    return ValueRule(
        f"one of {listed}",
        lambda value: isinstance(value, str) and value in options,
        str,
        enum=list(options),
    )


def subset(*options: str, at_least: int = 0) -> ValueRule[Any]:
    """Return the rule: some of `options`, each once."""
    return several(
        f"a list of some of {', '.join(map(shown, options))}, each once",
        choice(*options),
        lambda items: at_least <= len(items) == len(set(items)),
        uniqueItems=True,
        minItems=at_least,
    )


class Records(ValueRule[tuple[Any, ...]]):
    """The rule: a list of tables ``[[name]]``, each of which states a record of one kind, or of such records."""

    def __init__(self, name: str, kind: type, at_least: int = 0) -> None:
        self.name, self.kind = name, kind
        super().__init__(
            f"a list of tables, [[{name}]]",
            lambda value: (
                isinstance(value, list | tuple)
                and len(value) >= at_least
                and all(isinstance(item, (kind, dict)) for item in value)
            ),
            self._read,
            type="array",
            minItems=at_least,
        )

    def _read(self, value: Sequence[Any]) -> tuple[Any, ...]:
        """Return the records; raise all mistakes of the tables."""
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

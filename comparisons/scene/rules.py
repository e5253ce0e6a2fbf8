"""Rules for single values of a scene, and the mistakes that they state.

A rule is a value: called, it returns the stored form of a value, or raises its sentence, "must be" before what it accepts.
"""

import dataclasses
import math
import operator
import re
from collections.abc import Callable, Collection, Iterator, Sequence
from itertools import pairwise
from typing import Any

Point = tuple[float, float]
Rule = Callable[[object], object]
Test = Callable[[Any], object]

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
        first, *_ = mistakes
        super().__init__(first.key, first.value, first.rule)
        self.args = ("\n".join(map(str, mistakes)),)
        self.mistakes, self.found = tuple(mistakes), found

    def within(self, prefix: str) -> FieldError:
        """Return the same error with `prefix` before every key."""
        return RecordError([mistake.within(prefix) for mistake in self.mistakes])


Mistakes = Iterator[FieldError]


def toml_value(value: object) -> str:
    """Return `value` as TOML writes it in one line."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return '"' + "".join(c if c.isprintable() else f"\\U{ord(c):08x}" for c in escaped) + '"'
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {toml_value(item)}" for key, item in value.items()) + "}"
    return str(value)


def shown(value: object) -> str:
    """Return `value` as it would stand in a TOML file, in one line of at most 60 characters."""
    try:
        text = "(missing)" if value is MISSING else " ".join(toml_value(value).split())
    except RecursionError:
        text = "(nested too deeply)"
    return text if len(text) <= 60 else text[:57] + "..."


class ValueRule:
    """A rule as a value: what it accepts in words, whether a value is right, its stored form (itself), and the JSON Schema."""

    def __init__(
        self, accepts: str, right: Test, stored: Callable[[Any], Any] = lambda value: value, **schema: Any
    ) -> None:
        self.accepts, self.right, self.stored, self.schema = accepts, right, stored, schema

    def __call__(self, value: object) -> Any:
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


def limited(accepts: str, form: type[float] = float, *, scaled: bool = False, **limits: float) -> ValueRule:
    """Return the rule: a finite number within `limits`, a whole one in the form int; `scaled`, zero or within `RANGE`."""
    least, most = RANGE if scaled else (0.0, LARGEST)

    def right(value: Any) -> bool:
        is_number = isinstance(value, int | form) and not isinstance(value, bool)
        within = is_number and all(COMPARED[name](value, limit) for name, limit in limits.items())
        return within and (not value or least <= abs(value) <= most)

    name = "integer" if form is int else "number"
    return ValueRule(accepts, right, lambda value: form(value) or form(), type=name, **limits)


def whole(largest: int = 100_000) -> ValueRule:
    """Return the rule: a whole number from 1 to `largest`."""
    return limited(f"a whole number from 1 to {largest}", int, minimum=1, maximum=largest)


TURN = 2.0 * math.pi
number = limited("a finite number of at most 1e50 in size")
positive = limited("a positive number, from 1e-100 to 1e100", scaled=True, exclusiveMinimum=0)
not_negative = limited("zero, or a positive number from 1e-100 to 1e100", scaled=True, minimum=0)
turn = limited("an angle in rad of less than 2 pi in size", exclusiveMinimum=-TURN, exclusiveMaximum=TURN)
friction = limited("a coefficient between 0 and 100", minimum=0, maximum=100.0)
fraction = limited("a number between 0 and 1", exclusiveMinimum=0, exclusiveMaximum=1)
poissons_ratio = limited(
    "a number between -1 and 0.5, both excluded", exclusiveMinimum=-1, exclusiveMaximum=0.5
)
whole_number = whole()


def always(_: object) -> bool:
    """Accept everything."""
    return True


def several(
    accepts: str, item: ValueRule, least: int = 0, most: float = math.inf, right: Test = always, **schema: Any
) -> ValueRule:
    """Return the rule: a list of `least` to `most` items that are `right` together."""
    sizes = {"minItems": least} if math.isinf(most) else {"minItems": least, "maxItems": most}

    def all_right(value: Any) -> object:
        fits = isinstance(value, list | tuple) and least <= len(value) <= most
        return fits and all(map(item.right, value)) and right(value)

    def stored(value: Any) -> Any:
        return tuple(map(item.stored, value))

    return ValueRule(accepts, all_right, stored, **{"type": "array", "items": item.schema, **sizes, **schema})


def rising(values: Sequence[float]) -> bool:
    """Whether each number is larger than the one before it."""
    return all(a < b for a, b in pairwise(values))


point = several("two numbers [x, y], a third dimension is not modelled", number, 2, 2)
stiffnesses = several("two numbers [x, y], neither negative", not_negative, 2, 2)
span = several(
    "two fractions of the length that rise from 0 to 1",
    *(limited("", minimum=0, maximum=1), 2, 2),
    rising,
)
mesh = several("[elements along, elements across]", whole_number, 2, 2)
parts = several(
    "a list of numbers that rise between 0 and 1, both excluded",
    fraction,
    right=rising,
)


def polyline(at_least: int) -> ValueRule:
    """Return the rule: points, no two consecutive ones equal."""
    return several(
        f"a list of {at_least} or more points [x, y], no two consecutive ones equal",
        point,
        at_least,
        right=lambda points: all(a != b for a, b in pairwise(map(tuple, points))),
    )


_ends = several("", positive, 2, 2)


def _dimension(value: Any) -> float | tuple[float, float]:
    """Return a number, or two where they differ."""
    start, end = _ends.stored(value) if _ends.right(value) else (positive.stored(value),) * 2
    return start if start == end else (start, end)


dimension = ValueRule(
    "a positive number, or two [at the start, at the end]",
    lambda value: positive.right(value) or _ends.right(value),
    _dimension,
    anyOf=[positive.schema, _ends.schema],
)


def mesh_text(value: object) -> tuple[int, int]:
    """Accept the numbers of elements along and across as ``50x2``."""
    if not re.fullmatch(r"[0-9]+x[0-9]+", str(value)):
        raise RuleError("must be NXxNY, as 50x2")
    found: tuple[int, int] = mesh(tuple(map(int, str(value).split("x"))))
    return found


def worded(accepts: str, pattern: str) -> ValueRule:
    """Return the rule: a printable text with a regular expression in it."""
    return ValueRule(
        accepts,
        lambda value: isinstance(value, str) and value.isprintable() and re.search(pattern, value),
        type="string",
        pattern=pattern,
    )


text = worded("a printable text, not empty", r"\S")
name = worded("a name of letters, digits, '-' and '_'", r"^[\w-]+$")
units = worded('the units of force and of length, as "N, m"', "^[^,]*[^, ][^,]*,[^,]*[^, ][^,]*$")
truth = ValueRule("true or false", lambda value: isinstance(value, bool), type="boolean")
sequence = ValueRule("a list", lambda value: isinstance(value, list | tuple), tuple[object, ...])


def choice(*options: str) -> ValueRule:
    """Return the rule: one of `options`."""
    accepts = f"one of {', '.join(map(shown, options))}"
    return ValueRule(accepts, lambda value: isinstance(value, str) and value in options, enum=list(options))


def subset(*options: str, at_least: int = 0) -> ValueRule:
    """Return the rule: some of `options`, each once."""
    accepts = f"a list of some of {', '.join(map(shown, options))}, each once"
    each_once = lambda items: len(items) == len(set(items))  # noqa: E731
    return several(accepts, choice(*options), at_least, right=each_once, uniqueItems=True)


class Records(ValueRule):
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

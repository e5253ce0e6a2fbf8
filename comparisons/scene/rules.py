"""Rules for single values of a scene, and the mistakes that they state.

A rule is a value: called, it returns the stored form of a value, or raises a `FieldError`, "must be" before what it accepts.
"""

import dataclasses
import math
import re
from collections.abc import Callable, Collection, Iterator, Sequence
from itertools import pairwise
from operator import ge, gt, le, lt
from typing import Any

Point = tuple[float, float]
Rule = Callable[[object], object]
Test = Callable[[Any], object]
Schema = dict[str, Any]

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


class FieldError(ValueError):
    """A mistake: a value of a record breaks a rule, ``KEY = VALUE: RULE`` in one line.

    Parameters
    ----------
    key : str
        The field, with its place in the scene where that is known (``beam[0].height``); a rule does not know it.
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
        self.found: Any = UNREADABLE
        """What is right nevertheless, of a value with parts."""

    def within(self, prefix: str) -> "RecordError":
        """Return the same mistakes with `prefix` before every key."""
        return RecordError([FieldError(prefix + one.key, one.value, one.rule) for one in self.mistakes])


class RecordError(FieldError):
    """Several mistakes, each in one line, the first one's key, value and rule."""

    def __init__(self, mistakes: Collection[FieldError], found: Any = UNREADABLE) -> None:
        first, *_ = mistakes
        super().__init__(first.key, first.value, first.rule)
        self.args = ("\n".join(map(str, mistakes)),)
        self.mistakes, self.found = tuple(mistakes), found


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


TYPES: dict[str, Any] = {
    "number": int | float,
    "integer": int,
    "string": str,
    "array": list | tuple,
}
LIMITS = {"minimum": ge, "maximum": le, "exclusiveMinimum": gt, "exclusiveMaximum": lt}
"""Types and limits of values by their names in JSON Schema; a truth value is no number."""


def fits(value: Any, schema: Schema) -> bool:
    """Whether a value obeys a JSON Schema, of the words that stand in this module; a text is printable."""
    if "anyOf" in schema:
        return any(fits(value, one) for one in schema["anyOf"])
    kind = schema["type"]
    if not isinstance(value, TYPES.get(kind, object)) or isinstance(value, bool) != (kind == "boolean"):
        return False
    if kind == "array":
        sized = schema["minItems"] <= len(value) <= schema.get("maxItems", math.inf)
        return sized and all(fits(item, schema["items"]) for item in value)
    if kind == "string":
        found = re.search(schema.get("pattern", ""), value)
        return value.isprintable() and bool(found) and value in schema.get("enum", (value,))
    return all(LIMITS[word](value, limit) for word, limit in schema.items() if word in LIMITS)


def stored(value: Any, schema: Schema) -> Any:
    """Return a value in the form in which a record has it: a list as a tuple, a number as a float."""
    if isinstance(value, list | tuple):
        return tuple(stored(item, schema["items"]) for item in value)
    return float(value) or 0.0 if schema["type"] == "number" else value


class ValueRule:
    """A rule as a value: what it accepts in words, its JSON Schema, what that cannot say, and its form of a value."""

    def __init__(
        self, accepts: str, schema: Schema, also: Test = lambda _: True, form: Test | None = None
    ) -> None:
        self.accepts, self.schema, self.also = accepts, schema, also
        self.form = form or (lambda value: stored(value, schema))

    def __call__(self, value: object) -> Any:
        """Return the stored form of `value`, or raise `FieldError`."""
        if not (fits(value, self.schema) and self.also(value)):
            raise FieldError("", value, f"must be {self.accepts}")
        return self.form(value)


def within(least: float, most: float, kind: str = "number") -> Schema:
    """Return the schema of numbers from `least` to `most`."""
    return {"type": kind, "minimum": least, "maximum": most}


def between(least: float, most: float) -> Schema:
    """Return the schema of numbers larger than `least` and smaller than `most`."""
    return {"type": "number", "exclusiveMinimum": least, "exclusiveMaximum": most}


def several(item: Schema, least: int = 0, most: int | None = None) -> Schema:
    """Return the schema of lists with `least` to `most` items."""
    sizes = {"minItems": least} if most is None else {"minItems": least, "maxItems": most}
    return {"type": "array", "items": item, **sizes}


def worded(pattern: str) -> Schema:
    """Return the schema of texts with a regular expression in them."""
    return {"type": "string", "pattern": pattern}


def rising(values: Sequence[float]) -> bool:
    """Whether each number is larger than the one before it."""
    return all(a < b for a, b in pairwise(values))


TURN = 2.0 * math.pi
NUMBER, SCALED, ZERO_OR_SCALED = within(-LARGEST, LARGEST), within(*RANGE), within(0, RANGE[1])
POINT, PAIR = several(NUMBER, 2, 2), several(SCALED, 2, 2)


def _scaled(*sizes: float) -> bool:
    """Whether each size is zero or large enough."""
    return all(not size or size >= RANGE[0] for size in sizes)


def _dimension(size: Any) -> float | tuple[float, float]:
    """Return a number, or two where they differ."""
    start, end = stored(size, PAIR) if isinstance(size, list | tuple) else (float(size), float(size))
    return start if start == end else (start, end)


number = ValueRule("a finite number of at most 1e50 in size", NUMBER)
positive = ValueRule("a positive number, from 1e-100 to 1e100", SCALED)
not_negative = ValueRule("zero, or a positive number from 1e-100 to 1e100", ZERO_OR_SCALED, _scaled)
turn = ValueRule("an angle in rad of less than 2 pi in size", between(-TURN, TURN))
friction = ValueRule("a coefficient between 0 and 100", within(0, 100.0))
fraction = ValueRule("a number between 0 and 1", between(0, 1))
poissons_ratio = ValueRule("a number between -1 and 0.5, both excluded", between(-1, 0.5))
point = ValueRule("two numbers [x, y], a third dimension is not modelled", POINT)
stiffnesses = ValueRule(
    "two numbers [x, y], neither negative", several(ZERO_OR_SCALED, 2, 2), lambda pair: _scaled(*pair)
)
span = ValueRule("two fractions of the length that rise from 0 to 1", several(within(0, 1), 2, 2), rising)
parts = ValueRule(
    "a list of numbers that rise between 0 and 1, both excluded", several(between(0, 1)), rising
)
dimension = ValueRule(
    "a positive number, or two [at the start, at the end]", {"anyOf": [SCALED, PAIR]}, form=_dimension
)
text = ValueRule("a printable text, not empty", worded(r"\S"))
name = ValueRule("a name of letters, digits, '-' and '_'", worded(r"^[\w-]+$"))
units = ValueRule('the units of force and of length, as "N, m"', worded("^[^,]*[^, ][^,]*,[^,]*[^, ][^,]*$"))
truth = ValueRule("true or false", {"type": "boolean"})


def whole(largest: int = 100_000) -> ValueRule:
    """Return the rule: a whole number from 1 to `largest`."""
    return ValueRule(f"a whole number from 1 to {largest}", within(1, largest, "integer"))


whole_number = whole()
mesh = ValueRule("[elements along, elements across]", several(whole_number.schema, 2, 2))


def mesh_text(value: object) -> Any:
    """Accept the numbers of elements along and across as ``50x2``."""
    if not re.fullmatch(r"[0-9]{1,9}x[0-9]{1,9}", str(value)):
        raise FieldError("", value, "must be NXxNY, as 50x2")
    try:
        return mesh(tuple(map(int, str(value).split("x"))))
    except FieldError as error:
        raise FieldError("", value, error.rule) from None


def polyline(at_least: int) -> ValueRule:
    """Return the rule: points, no two consecutive ones equal."""
    return ValueRule(
        f"a list of {at_least} or more points [x, y], no two consecutive ones equal",
        several(POINT, at_least),
        lambda points: all(a != b for a, b in pairwise(map(tuple, points))),
    )


def choice(*options: str) -> ValueRule:
    """Return the rule: one of `options`."""
    schema = {"type": "string", "enum": list(options)}
    return ValueRule(f"one of {', '.join(map(shown, options))}", schema)


def subset(*options: str, at_least: int = 0) -> ValueRule:
    """Return the rule: some of `options`, each once."""
    schema = {**several(choice(*options).schema, at_least), "uniqueItems": True}
    accepts = f"a list of some of {', '.join(map(shown, options))}, each once"
    return ValueRule(accepts, schema, lambda items: len(items) == len(set(items)))


class Records(ValueRule):
    """The rule: a list of tables ``[[name]]``, each of which states a record of one kind, or of such records."""

    def __init__(self, name: str, kind: type, at_least: int = 0) -> None:
        self.name, self.kind = name, kind
        super().__init__(
            f"a list of tables, [[{name}]]",
            several({"type": "object"}, at_least),
            lambda value: all(isinstance(item, (kind, dict)) for item in value),
            self._read,
        )

    def _read(self, value: Sequence[Any]) -> tuple[Any, ...]:
        """Return the records; raise all mistakes of the tables."""
        found: list[Any] = []
        mistakes: list[FieldError] = []
        for i, item in enumerate(value):
            try:
                found.append(self.kind(**item) if isinstance(item, dict) else item)
            except RecordError as error:
                mistakes += error.within(f"[{i}].").mistakes
                found.append(error.found)
            if len(mistakes) > MOST:
                raise RecordError(mistakes)
        if mistakes:
            raise RecordError(mistakes, tuple(found))
        return tuple(found)

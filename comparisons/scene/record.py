"""Base of the records of a scene. A key is declared once: its rule, its meaning and its default.

A record collects the mistakes of its values and of its own rules and raises them together. A rule between several values reads them as
attributes. Where a value is itself wrong, reading it raises `Unjudged`, and the rule is not judged: one mistake gives one line.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import field
from typing import TYPE_CHECKING, Any, ClassVar, dataclass_transform

from comparisons.frozen import Value
from comparisons.scene.rules import MISSING, FieldError, Mistakes, RecordError, Records, ValueRule
from comparisons.scene.tables import stated, table_values

RAISES = "\nRaises\n------\nFieldError\n    With all mistakes, each in one line: field, value and rule."


class Unjudged(KeyError):  # noqa: N818 - no error of the user: the value is reported where it stands
    """A rule reads a value that is itself wrong, or a record that is not there, so it cannot be judged."""


def key(rule: ValueRule, meaning: str) -> Any:
    """Declare a key that must be given by its rule and its meaning with the unit."""
    return optional(rule, meaning, MISSING)


def optional(rule: ValueRule, meaning: str, default: Any = None) -> Any:
    """Declare a key that may be left out by its rule, its meaning with the unit, and its default."""
    return field(default=default, metadata={"rule": rule, "meaning": meaning})


def listed(name: str, kind: type["Record"], meaning: str) -> Any:
    """Declare tables ``[[name]]``, each of which states a record of a kind; there may be none."""
    return optional(Records(name, kind), meaning, ())


@dataclass_transform(kw_only_default=True, frozen_default=True, field_specifiers=(key,))
class Record(Value):
    """Immutable, hashable values that obey the rules of their keys, and those between them, `obeys`.

    Raises FieldError at construction, with all mistakes.
    """

    obeys: ClassVar[tuple[Callable[[Any], Mistakes], ...]] = ()
    rules: ClassVar[dict[str, ValueRule]]
    """The rules of its keys."""
    _free: ClassVar[dict[str, Any]]

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        said = {name: item.metadata for name, item in cls._fields.items()}
        cls.rules = {name: one["rule"] for name, one in said.items()}
        cls._free = {name: item.default for name, item in cls._fields.items() if item.default is not MISSING}
        for name in said.keys() & vars(cls).keys():
            delattr(cls, name)  # so that a value which is wrong is not there
        rows = (f"{name} : {one['rule'].accepts}\n    {one['meaning']}" for name, one in said.items())
        own = (cls.__doc__ or "").replace("\n    ", "\n").rstrip()
        cls.__doc__ = "\n".join([own, "\nParameters\n----------", *rows, RAISES])

    def __init__(self, /, **given: Any) -> None:
        free, rules = self._free, self.rules
        given = {k: value for k, value in given.items() if value is not None or free.get(k, 0) is not None}
        values, mistakes = table_values(given, rules, [name for name in rules if name not in free])
        there = stated(given, rules)
        vars(self).update({name: value for name, value in free.items() if name not in there}, **values)
        self._settle()
        for own in self.obeys:
            with suppress(Unjudged):
                mistakes.extend(own(self))
            for mistake in mistakes:
                vars(self).pop(mistake.key, None)
        if mistakes:
            raise RecordError(mistakes, self)

    def has(self, *names: str) -> bool:
        """Whether none of the named values is wrong."""
        return vars(self).keys() >= set(names)

    def records(self, name: str) -> tuple[Any, ...]:
        """Return the records that a value lists; none where it is wrong."""
        return tuple(vars(self).get(name, ()))

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """Refuse a value that is wrong."""
            if name in self.rules:
                raise Unjudged(name)
            raise AttributeError(f"{type(self).__name__} has no attribute {name}")


def lists_of(kind: type[Record]) -> dict[str, type[Record]]:
    """Return the kinds of records that the fields of a record list, by field."""
    return {name: rule.kind for name, rule in kind.rules.items() if isinstance(rule, Records)}


def refused(key: str, sentence: str, when: Callable[[Any], object]) -> Callable[[Record], Mistakes]:
    """Return the rule between the values of a record: where `when` is true of it, the value of `key` is a mistake."""

    def judged(record: Record) -> Mistakes:
        if when(record):
            yield FieldError(key, getattr(record, key) or MISSING, sentence)

    return judged


def one_of(*groups: tuple[str, ...]) -> Callable[[Record], Mistakes]:
    """Return the rule: exactly one of the `groups` of keys is given, with all its keys; None means not given."""
    wanted = " or ".join(" and ".join(group) for group in groups)

    def judged(record: Record) -> Mistakes:
        there = {item for group in groups for item in group if vars(record).get(item, MISSING) is not None}
        present = [group for group in groups if there & {*group}]
        if not present:
            yield FieldError(groups[0][0], MISSING, f"give {wanted}")
        elif len(present) > 1:
            extra = next(item for item in present[1] if item in there)
            yield FieldError(extra, getattr(record, extra), f"give either {wanted}, not both")
        else:
            rule = f"must be given, {' and '.join(present[0])} belong together"
            yield from (FieldError(item, MISSING, rule) for item in present[0] if item not in there)

    return judged

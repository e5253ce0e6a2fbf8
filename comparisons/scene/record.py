"""Base of the records of a scene. A key is declared once: its rule, its meaning and its default.

A record collects the mistakes of its values and of its own rules and raises them together. A rule between several values reads them as
attributes. Where a value is itself wrong, reading it raises `Unjudged`, and the rule is not judged: one mistake gives one line.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import Field, field, fields
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar, dataclass_transform

from comparisons.frozen import Value
from comparisons.scene.rules import MISSING, FieldError, Mistakes, RecordError, Records, ValueRule
from comparisons.scene.tables import stated, table_values

R = TypeVar("R", bound="Record")
RAISES = "Raises\n------\nFieldError\n    With all mistakes, each in one line: field, value and rule."


class Unjudged(KeyError):  # noqa: N818 - no error of the user: the value is reported where it stands
    """A rule reads a value that is itself wrong, or a record that is not there, so it cannot be judged."""


def key(rule: ValueRule, meaning: str) -> Any:
    """Declare a key that must be given by its rule and its meaning with the unit."""
    return field(metadata={"rule": rule, "meaning": meaning})


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
    _rules: ClassVar[dict[str, ValueRule]]
    _free: ClassVar[dict[str, Any]]

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        declared = cls._fields.values()
        cls._rules = {item.name: rule_of(item) for item in declared}
        cls._free = {item.name: item.default for item in declared if item.default is not MISSING}
        for name in cls._rules.keys() & vars(cls).keys():
            delattr(cls, name)  # so that a value which is wrong is not there
        rows = (f"{item.name} : {rule_of(item).accepts}\n    {item.metadata['meaning']}" for item in declared)
        said = (cls.__doc__ or "").replace("\n    ", "\n").rstrip()
        cls.__doc__ = "\n".join([said, "\nParameters\n----------", *rows, f"\n{RAISES}"])

    def __init__(self, /, **given: Any) -> None:
        free, rules = self._free, self._rules
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
        records: tuple[Any, ...] = vars(self).get(name, ())
        return records

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """Refuse a value that is wrong."""
            if name in self._rules:
                raise Unjudged(name)
            raise AttributeError(f"{type(self).__name__} has no attribute {name}")


def rule_of(item: Field[Any]) -> ValueRule:
    """Return the rule of a field."""
    rule: ValueRule = item.metadata["rule"]
    return rule


def lists_of(kind: type[Record]) -> dict[str, type[Record]]:
    """Return the kinds of records that the fields of a record list, by field."""
    rules = ((item.name, rule_of(item)) for item in fields(kind))
    return {name: rule.kind for name, rule in rules if isinstance(rule, Records)}


def copied(record: R, **attributes: object) -> R:
    """Return a copy of a record, wrong values included, with further attributes that are no keys."""
    copy = object.__new__(type(record))
    own = {name: value for name, value in vars(record).items() if name in record._rules}  # noqa: SLF001
    vars(copy).update(own, **attributes)
    return copy


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
        given = [[item for item in group if vars(record).get(item, MISSING) is not None] for group in groups]
        present = [k for k, some in enumerate(given) if some]
        if not present:
            yield FieldError(groups[0][0], MISSING, f"give {wanted}")
        elif len(present) > 1:
            extra = given[present[1]][0]
            yield FieldError(extra, getattr(record, extra), f"give either {wanted}, not both")
        else:
            group = groups[present[0]]
            rule = f"must be given, {' and '.join(group)} belong together"
            yield from (FieldError(item, MISSING, rule) for item in group if item not in given[present[0]])

    return judged

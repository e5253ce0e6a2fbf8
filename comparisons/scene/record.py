"""Base of the records of a scene. A key is declared once: its rule, its meaning and its default.

A record collects the mistakes of its values and of its own rules and raises them together. A rule between several values reads them as
attributes. Where a value is itself wrong, reading it raises `Unjudged`, and the rule is not judged: one mistake gives one line.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import Field, FrozenInstanceError, dataclass, field, fields
from inspect import cleandoc
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar, dataclass_transform

from comparisons.scene.rules import MISSING, FieldError, Mistakes, RecordError, RuleError, ValueRule

R = TypeVar("R", bound="Record")
RAISES = "\nRaises\n------\nFieldError\n    With all mistakes, each in one line: field, value and rule."
UNREADABLE: Any = object()
"""The value of a key that is stated, and wrong in a way that is reported elsewhere."""


class Unjudged(KeyError):  # noqa: N818 - no error of the user: the value is reported where it stands
    """A rule reads a value that is itself wrong, or a record that is not there, so it cannot be judged."""


def key(rule: ValueRule[Any], meaning: str) -> Any:
    """Declare a key that must be given by its rule and its meaning with the unit."""
    return field(metadata={"rule": rule, "meaning": meaning})


def optional(rule: ValueRule[Any], meaning: str, default: Any = None) -> Any:
    """Declare a key that may be left out by its rule, its meaning with the unit, and its default."""
    return field(default=default, metadata={"rule": rule, "meaning": meaning})


@dataclass_transform(kw_only_default=True, frozen_default=True, field_specifiers=(key,))
class Record:
    """Immutable, hashable values that obey the rules of their keys and the record's own rules.

    Raises
    ------
    FieldError
        At construction, with all mistakes.
    """

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    _defaults: ClassVar[dict[str, Any]]

    def __init_subclass__(cls) -> None:
        dataclass(init=False, repr=False, eq=False, match_args=False)(cls)
        cls._defaults = {item.name: item.default for item in fields(cls)}
        for name in cls._defaults.keys() & vars(cls).keys():
            delattr(cls, name)  # so that a value which is wrong is not there
        rows = (
            f"{item.name} : {rule_of(item).accepts}\n    {item.metadata['meaning']}" for item in fields(cls)
        )
        cls.__doc__ = "\n".join([cleandoc(cls.__doc__ or ""), "\nParameters\n----------", *rows, RAISES])

    def __init__(self, **given: Any) -> None:
        if unknown := given.keys() - self._defaults.keys():
            raise TypeError(f"{type(self).__name__} has no key {min(unknown)}")
        mistakes = []
        for item in fields(self):
            value = given.get(item.name, item.default)
            if value is None and item.default is None:
                vars(self)[item.name] = None
            elif value is MISSING:
                mistakes.append(FieldError(item.name, value, "must be given"))
            elif value is not UNREADABLE:
                try:
                    vars(self)[item.name] = rule_of(item)(value)
                except RuleError as error:
                    mistakes.append(FieldError(item.name, value, str(error)))
        self._settle()
        for rule in self._own_rules():
            with suppress(Unjudged):
                mistakes.extend(rule)
            for mistake in mistakes:
                vars(self).pop(mistake.key, None)
        if mistakes:
            raise RecordError(mistakes, self)

    def _settle(self) -> None:
        """Put values that depend on others into their final form."""

    def _own_rules(self) -> Iterable[Mistakes]:
        """Return the rules between the values of the record; each yields its mistakes."""
        return ()

    def has(self, *names: str) -> bool:
        """Whether none of the named values is wrong."""
        return vars(self).keys() >= set(names)

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """Refuse a value that is wrong."""
            if name in self._defaults:
                raise Unjudged(name)
            raise AttributeError(f"{type(self).__name__} has no attribute {name}")

    def __setattr__(self, name: str, value: object) -> None:
        raise FrozenInstanceError(f"cannot assign to field {name!r}")

    def __delattr__(self, name: str) -> None:
        raise FrozenInstanceError(f"cannot delete field {name!r}")

    def _values(self) -> tuple[Any, ...]:
        return tuple(vars(self)[name] for name in self._defaults)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Record) or type(self) is not type(other):
            return NotImplemented
        return self._values() == other._values()

    def __hash__(self) -> int:
        return hash(self._values())

    def __repr__(self) -> str:
        values = ", ".join(f"{name}={vars(self).get(name)!r}" for name in self._defaults)
        return f"{type(self).__name__}({values})"


def keys_of(kind: type[Record]) -> set[str]:
    """Return the keys of a record."""
    return {item.name for item in fields(kind)}


def rule_of(item: Field[Any]) -> ValueRule[Any]:
    """Return the rule of a field."""
    rule: ValueRule[Any] = item.metadata["rule"]
    return rule


def lists_of(kind: type[Record]) -> dict[str, type[Record]]:
    """Return the kinds of records that the fields of a record list, by field."""
    return {item.name: record for item in fields(kind) if (record := rule_of(item).kind) is not None}


def copied(record: R, **attributes: object) -> R:
    """Return a copy of a record, wrong values included, with further attributes that are no keys."""
    copy = object.__new__(type(record))
    vars(copy).update({name: value for name, value in vars(record).items() if name in record._defaults})  # noqa: SLF001
    vars(copy).update(attributes)
    return copy


def exactly_one_of(record: Record, *groups: tuple[str, ...]) -> Mistakes:
    """Yield a mistake unless exactly one of the `groups` of fields is given, with all its fields; None means not given."""
    given = {name for group in groups for name in group if vars(record).get(name, MISSING) is not None}
    wanted = " or ".join(" and ".join(group) for group in groups)
    present = [group for group in groups if given.intersection(group)]
    if not present:
        yield FieldError(groups[0][0], MISSING, f"give {wanted}")
    elif len(present) > 1:
        extra = next(item for item in present[1] if item in given)
        yield FieldError(extra, getattr(record, extra), f"give either {wanted}, not both")
    else:
        for item in present[0]:
            if item not in given:
                yield FieldError(item, MISSING, f"must be given, {' and '.join(present[0])} belong together")

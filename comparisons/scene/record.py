"""Base of the records of a scene. A record collects the mistakes of its values and of its own rules and raises them together.

A rule between several values reads them as attributes. Where a value is itself wrong, reading it raises `Unjudged`, and the rule
is not judged: one mistake gives one line.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import fields
from functools import cache
from typing import Any, TypeVar

from comparisons.scene.rules import MISSING, FieldError, RecordError, RuleError, field_rules

R = TypeVar("R", bound="Record")


class Unjudged(KeyError):  # noqa: N818 - no error of the user: the value is reported where it stands
    """A rule reads a value that is itself wrong, or a record that is not there, so it cannot be judged."""


class Record:
    """Values that obey the rules of their fields and the record's own rules.

    Raises
    ------
    FieldError
        At construction, with all mistakes.
    """

    def settle(self) -> None:
        """Put values that depend on others into their final form."""

    def own_rules(self) -> Iterable[Iterator[FieldError]]:
        """Return the rules between the values of the record; each yields its mistakes."""
        return ()

    def __post_init__(self) -> None:
        if wrong_values(type(self), vars(self)) or not self._is_right():
            raise RecordError(examined(type(self), vars(self))[1])

    def _is_right(self) -> bool:
        try:
            self.settle()
            return not any(True for rule in self.own_rules() for _ in rule)
        except Unjudged:
            return False


class Partial:
    """A record some of whose fields are wrong: reading one of them raises `Unjudged`."""

    def __getattribute__(self, name: str) -> Any:
        """Return an attribute."""
        if name in object.__getattribute__(self, "__dict__").get("_wrong", ()):
            raise Unjudged(name)
        return object.__getattribute__(self, name)


def examined(kind: type[R], given: dict[str, Any], wrong: Collection[str] = ()) -> tuple[R, list[FieldError]]:
    """Return the record of the values `given`, without checks, and its mistakes; the fields `wrong` are known to be wrong."""
    mistakes = wrong_values(kind, given, wrong)
    record = _partial(kind, given, {*wrong, *(mistake.key for mistake in mistakes)})
    with suppress(Unjudged):
        record.settle()
    for rule in record.own_rules():
        with suppress(Unjudged):
            mistakes.extend(rule)
        vars(record)["_wrong"].update(mistake.key for mistake in mistakes)
    return record, mistakes


def wrong_values(kind: type, given: dict[str, Any], leave: Collection[str] = ()) -> list[FieldError]:
    """Return the mistakes of the values `given` for the fields of a record, and put the right ones into their stored form.

    Fields in `leave` are not looked at.
    """
    mistakes = []
    rules = field_rules(kind)
    for item in fields(kind):
        if item.name in leave or (given[item.name] is None and item.default is None):
            continue
        try:
            given[item.name] = rules[item.name](given[item.name])
        except RuleError as error:
            mistakes.append(FieldError(item.name, given[item.name], str(error)))
    return mistakes


def _partial(kind: type[R], given: Mapping[str, Any], wrong: set[str]) -> R:
    """Return a record without checks, some of whose fields are wrong: reading one of them raises `Unjudged`."""
    own: type[R] = kind if issubclass(kind, Partial) else _partial_kind(kind)  # type: ignore[arg-type]  # a class is hashable
    return _bare(own, {**given, "_wrong": wrong})


def copied(record: R, *wrong: str, **changes: object) -> R:
    """Return a copy of a record without checks, with changed attributes and more fields that are wrong."""
    names = {item.name for item in fields(record)}  # type: ignore[arg-type]  # every record is a dataclass
    given = {name: value for name, value in vars(record).items() if name in names} | changes
    wrong = (*wrong, *vars(record).get("_wrong", ()))
    return _partial(type(record), given, set(wrong)) if wrong else _bare(type(record), given)


def _bare(kind: type[R], given: Mapping[str, Any]) -> R:
    record = object.__new__(kind)
    vars(record).update(given)
    return record


@cache
def _partial_kind(kind: type) -> type:
    return type(kind.__name__, (Partial, kind), {})


def right(record: Record, *names: str) -> bool:
    """Whether none of the named fields of a record is wrong."""
    wrong: Collection[str] = vars(record).get("_wrong", ())
    return not any(name in wrong for name in names)


def exactly_one_of(record: Record, *groups: tuple[str, ...]) -> Iterator[FieldError]:
    """Yield a mistake unless exactly one of the `groups` of fields is given, with all its fields; None means not given."""
    given = vars(record)
    wanted = " or ".join(" and ".join(group) for group in groups)
    present = [group for group in groups if any(given[item] is not None for item in group)]
    if not present:
        yield FieldError(groups[0][0], MISSING, f"give {wanted}")
    elif len(present) > 1:
        extra = next(item for item in present[1] if given[item] is not None)
        yield FieldError(extra, getattr(record, extra), f"give either {wanted}, not both")
    else:
        for item in present[0]:
            if given[item] is None:
                yield FieldError(item, MISSING, f"must be given, {' and '.join(present[0])} belong together")

"""Reader of TOML input files: it checks the keys and lists the mistakes in the order of the file, each in one line."""

import re
import tomllib
from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import islice
from typing import Any

from comparisons.files import read_regular
from comparisons.scene.rules import MISSING, MOST, UNREADABLE, FieldError, RecordError, Rule, shown

LARGEST_FILE = 16_000_000
"""Largest size of an input file [byte]."""
DEEPEST = 50
"""Largest number of parts of a dotted key; the time to parse a key rises with the square of this number."""
_DEEP = re.compile(rf"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){{{DEEPEST}}}""")


class InputError(ValueError):
    """An input file that cannot be read, ``FILE: KEY = VALUE: RULE`` in one line for every mistake.

    Parameters
    ----------
    source : str
        The file.
    reason : str or FieldError
        What is wrong with the file, or its mistakes.

    Attributes
    ----------
    mistakes : tuple of FieldError
        The mistakes in the file's order; none if the file cannot be read at all.
    """

    def __init__(self, source: str, reason: str | FieldError) -> None:
        self.mistakes = reason.mistakes if isinstance(reason, FieldError) else ()
        lines = (f"{source}: {item}" for item in self.mistakes or (reason,))
        super().__init__("\n".join(" ".join(line.split()) for line in lines))


def read_text(path: str, absent: str = "no such file") -> str:
    """Return the text of the regular file `path`, of 16 MB at most; the error says `absent` where there is none."""
    try:
        return read_regular(path, LARGEST_FILE).decode("utf-8")
    except FileNotFoundError:
        raise InputError(path, absent) from None
    except UnicodeDecodeError as error:
        raise InputError(path, f"must be UTF-8 text, byte {error.start} is not") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(path, f"cannot be read: {reason}") from None


def read_tables(text: str, source: str) -> dict[str, Any]:
    """Return the tables of the TOML `text`; `source` names it in errors."""
    if _DEEP.search(text):
        raise InputError(source, f"must be valid TOML: a key has more than {DEEPEST} parts")
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(source, f"must be valid TOML: {error}") from None


def misnamed(table: Mapping[str, Any], known: Collection[str]) -> dict[str, str | None]:
    """Return the unknown keys of a table, each with the known key that it means by another name or misspelt."""
    unknown = list(islice((key for key in table if key not in known), MOST))
    if not unknown:
        return {}
    from comparisons.scene.words import meant  # its tables only for a file with a mistake

    return {key: meant(key, known) for key in unknown}


def stated(table: Mapping[str, Any], known: Collection[str]) -> set[str | None]:
    """Return the keys of a table, and the known ones that are there by another name."""
    return {*table, *misnamed(table, known).values()}


def check_keys(
    table: Mapping[str, Any], known: Collection[str], required: Iterable[str] = ()
) -> Iterator[FieldError]:
    """Yield the keys of `table` that are not known, and the keys that are required and not there."""
    others = misnamed(table, known)
    for key in others:
        from comparisons.scene.words import hint

        rule = f"unknown key, {hint(key, known)}"
        yield FieldError(key if key.isprintable() else repr(key), table[key], rule)
    there = {*table, *others.values()}
    yield from (FieldError(key, MISSING, "must be given") for key in required if key not in there)


def check_table(tables: dict[str, Any], name: str) -> Iterator[FieldError]:
    """Yield a mistake if the value called `name` is there and is no table."""
    if name in tables and not isinstance(tables[name], dict):
        yield FieldError(name, tables[name], f"must be a table, [{name}]")


def check_tables(tables: dict[str, Any], name: str) -> Iterator[FieldError]:
    """Yield a mistake if the value called `name` is there and is no list of tables."""
    found = tables.get(name, [{}])
    if not isinstance(found, list) or not found or not all(isinstance(item, dict) for item in found):
        yield FieldError(name, found, f"must be a list of tables, [[{name}]]")


def head_values(
    tables: dict[str, Any], name: str, rules: Mapping[str, Rule], required: Iterable[str]
) -> tuple[dict[str, Any], list[FieldError]]:
    """Return the right values of the table called `name` in their stored form, and its mistakes."""
    mistakes = list(check_table(tables, name))
    if mistakes or name not in tables:
        return {}, mistakes
    values, mistakes = table_values(tables[name], rules, required)
    return values, [mistake.within(f"{name}.") for mistake in mistakes]


def table_values(
    table: Mapping[str, Any], rules: Mapping[str, Rule], required: Iterable[str]
) -> tuple[dict[str, Any], list[FieldError]]:
    """Return the right values of a table in their stored form, and its mistakes."""
    mistakes = list(check_keys(table, rules, required))
    values = {}
    for key in (key for key in table if key in rules and table[key] is not UNREADABLE):
        try:
            values[key] = rules[key](table[key])
        except FieldError as error:
            mistakes += error.within(getattr(rules[key], "name", key)).mistakes
            values |= {} if error.found is UNREADABLE else {key: error.found}
    return values, mistakes


def refuse(source: str, mistakes: Collection[FieldError], tables: dict[str, Any]) -> None:
    """Raise the mistakes, if any, in the order in which their keys stand in a file of `tables`, one for a value."""
    if mistakes:
        raise InputError(source, RecordError(_in_order(mistakes, tables)))


def _in_order(mistakes: Iterable[FieldError], tables: dict[str, Any]) -> list[FieldError]:
    """Sort mistakes; a missing key stands at the end of its table, and tables of one kind that stand apart stand together."""
    ranks = {key: rank for rank, key in enumerate(_keys(tables))}

    def rank(mistake: FieldError) -> int:
        return ranks.get(mistake.key, ranks.get(mistake.key.rpartition(".")[0] + ".", len(ranks)))

    first: dict[tuple[str, str], FieldError] = {}
    for mistake in sorted(mistakes, key=rank):
        first.setdefault((mistake.key, shown(mistake.value)), mistake)
    return list(first.values())


def _keys(table: dict[str, Any], path: str = "") -> Iterator[str]:
    """Yield the keys of a table and of the tables in it, as ``beam[0].name``, then the path of the table, at which it ends."""
    for key, value in table.items():
        yield f"{path}{key}"
        if isinstance(value, dict):
            yield from _keys(value, f"{path}{key}.")
        for i, item in enumerate(value if isinstance(value, list) else ()):
            if isinstance(item, dict):
                yield from _keys(item, f"{path}{key}[{i}].")
    yield path

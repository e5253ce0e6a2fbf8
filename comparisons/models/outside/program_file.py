"""Program files: a program of others, with its command and limits, as TOML."""

from pathlib import Path
from typing import Any

from comparisons.models.outside.child import Limits
from comparisons.models.outside.program import Program
from comparisons.models.outside.source import COLOUR, Command
from comparisons.scene import rules
from comparisons.scene.rules import FieldError, Rule, RuleError
from comparisons.scene.tables import InputError, check_keys, read_tables, read_text


class ProgramFileError(InputError):
    """A program file that cannot be read."""


def read_program(path: Path) -> Program:
    """Return the program that the TOML file `path` states in its table ``[program]``.

    The keys are ``name`` and ``command`` (a list of the program and its arguments), and, if wanted, ``label``, ``seconds`` (limit on
    time, 600), ``memory`` (limit in MB, 4000), ``elements`` (a list of numbers of elements), ``colour``. The program runs in the
    folder of the file.

    Raises
    ------
    ProgramFileError
        One line: file, key, value and rule.
    """
    source = str(path)
    tables = read_tables(read_text(source, "no such file", ProgramFileError), source, ProgramFileError)
    try:
        given = _checked(tables)
    except FieldError as error:
        raise ProgramFileError(source, str(error)) from None
    return Program(
        Command(
            name=given["name"],
            label=given.get("label", ""),
            command=given["command"],
            folder=path.resolve().parent,
            limits=Limits(seconds=given.get("seconds", 600.0), memory=1e6 * given.get("memory", 4000.0)),
            elements=given.get("elements", ()),
            colour=given.get("colour", COLOUR),
        )
    )


def _words(value: object) -> tuple[str, ...]:
    items = rules.sequence(value)
    if not items:
        raise RuleError("must have a program")
    return tuple(rules.text(item) for item in items)


def _counts(value: object) -> tuple[int, ...]:
    return tuple(rules.whole_number(item) for item in rules.sequence(value))


def _colour(value: object) -> str:
    text = rules.text(value)
    if len(text) != 7 or text[0] != "#" or not all(c in "0123456789abcdefABCDEF" for c in text[1:]):
        raise RuleError("must be a colour, as #AA3377")
    return text


RULES: dict[str, Rule] = {
    "name": rules.name,
    "command": _words,
    "label": rules.text,
    "seconds": rules.positive,
    "memory": rules.positive,
    "elements": _counts,
    "colour": _colour,
}
"""The keys of a program file with the rules of their values."""


def _checked(tables: dict[str, Any]) -> dict[str, Any]:
    """Return the values of the table ``[program]`` in their stored form."""
    check_keys(tables, ("program",), required=("program",))
    table = tables["program"]
    if not isinstance(table, dict):
        raise FieldError("program", table, "must be a table, [program]")
    try:
        check_keys(table, RULES, required=("name", "command"))
        found = {}
        for key, value in table.items():
            try:
                found[key] = RULES[key](value)
            except RuleError as error:
                raise FieldError(key, value, str(error)) from None
    except FieldError as error:
        raise error.within("program.") from None
    return found

"""Program files: a program of others, with its command and limits, as TOML."""

from pathlib import Path

from comparisons.models.outside.child import Limits
from comparisons.models.outside.program import Program
from comparisons.models.outside.source import COLOUR, Command
from comparisons.scene import rules
from comparisons.scene.rules import RecordError, Rule, RuleError
from comparisons.scene.tables import InputError, check_keys, head_values, in_order, read_tables, read_text


class ProgramFileError(InputError):
    """A program file that cannot be read."""


def read_program(path: Path) -> Program:
    """Return the program that the TOML file `path` states in its table ``[program]``.

    The keys are ``name`` and ``command`` (a list of the program and its arguments), and, if wanted, ``label``, ``seconds`` (limit on
    time, 600), ``memory`` (limit in MB, 4000), ``environment`` (a list of further variables that it gets), ``elements`` (a list of numbers of
    elements), ``colour``, ``continuum`` (whether it computes a two-dimensional body). The program runs in
    the folder of the file.

    Raises
    ------
    ProgramFileError
        All mistakes in the order of the file, each in one line: file, key, value and rule.
    """
    source = str(path)
    text = read_text(source, "no such file", ProgramFileError)
    tables = read_tables(text, source, ProgramFileError)
    given, mistakes = head_values(tables, "program", RULES, required=("name", "command"))
    mistakes += check_keys(tables, ("program",), required=("program",))
    if mistakes:
        raise ProgramFileError(source, RecordError(in_order(mistakes, text, tables)))
    return Program(
        Command(
            name=given["name"],
            label=given.get("label", ""),
            command=given["command"],
            folder=path.resolve().parent,
            limits=Limits(
                seconds=given.get("seconds", 600.0),
                memory=1e6 * given.get("memory", 4000.0),
                environment=given.get("environment", ()),
            ),
            elements=given.get("elements", ()),
            colour=given.get("colour", COLOUR),
            continuum=given.get("continuum", False),
        )
    )


def _words(value: object) -> tuple[str, ...]:
    if not rules.sequence(value):
        raise RuleError("must have a program")
    return _texts(value)


def _texts(value: object) -> tuple[str, ...]:
    return tuple(rules.text(item) for item in rules.sequence(value))


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
    "environment": _texts,
    "elements": _counts,
    "colour": _colour,
    "continuum": rules.truth,
}
"""The keys of a program file with the rules of their values."""

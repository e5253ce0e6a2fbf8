"""The models from outside this package: adapters, entry points of other packages, and program files."""

from __future__ import annotations

import re
import sys
from collections.abc import Container
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from comparisons.extras import install
from comparisons.models.base import Model
from comparisons.models.options import ModelError
from comparisons.models.outside.program import Command, Program
from comparisons.scene import rules
from comparisons.scene.rules import RecordError, Rule, RuleError
from comparisons.scene.tables import InputError, check_keys, head_values, in_order, read_tables, read_text

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

SUFFIX = ".toml"
"""Suffix of a program file."""
RUN = (
    f"import runpy, sys; sys.path.insert(0, {str(Path(__file__).parents[3])!r}); "
    "runpy.run_module({!r}, run_name='__main__')"
)
"""What runs an adapter, which is a module of this package."""
ADAPTERS: dict[str, Program] = {
    name: Program(
        Command(
            name=name, label=label, command=(sys.executable, "-c", RUN.format(module)), folder=Path.cwd(),
            elements=(10, 20, 40, 80), colour=colour, requires=requires, needs=needs, module=module,
            continuum=continuum,
        )
    )
    for name, label, colour, requires, needs, continuum in (
        ("calculix", "CalculiX", "#117733", "ccx", "Debian's calculix-ccx is needed: there is no program ccx", True),
        ("exudyn", "Exudyn", "#999933", "exudyn", f"exudyn is needed: {install('exudyn')}", False),
        ("felupe", "FElupe", "#DDCC77", "felupe", f"felupe is needed: {install('felupe')}", True),
        ("opensees", "OpenSees", "#882255", "openseespy", f"openseespy is needed: {install('openseespy')}, and Debian's libblas3", False),
    )
    for module in [f"{__package__}.adapters.{name}"]
}  # fmt: skip
"""The adapters of this package by name: label, colour, what it requires, how to install that, and whether it computes a two-dimensional body."""
_USED: dict[str, Model] = {}
"""The models from outside that this process has used, by name."""


def outside(name: str, taken: Container[str] = ()) -> Model | None:
    """Return a model that is none of this package; None if there is no such model.

    The name is that of a program file ``NAME.toml``, of one read before, of an adapter, or of an entry point. A `ProgramFileError` is
    raised if the file cannot be read or states a name in `taken`, a `ModelError` if an entry point yields no model.
    """
    if not known(name):
        return None
    model = read_program(Path(name)) if name.endswith(SUFFIX) else ADAPTERS.get(name) or _USED.get(name)
    model = model or loaded(offered()[name], Model)
    if model.name in taken:
        raise ProgramFileError(name, f'program.name = "{model.name}": must not be the name of a model')
    _USED[model.name] = model
    return model


def known(name: str) -> bool:
    """Whether a name may be one of a model from outside; nothing is read or imported."""
    return name.endswith(SUFFIX) or name in _USED or name in ADAPTERS or name in offered()


def used() -> tuple[Model, ...]:
    """Return the models from outside that this process has used."""
    return tuple(_USED.values())


@cache
def offered(group: str = "crossval.models") -> dict[str, EntryPoint]:
    """Return the entry points by which installed packages offer models, or another group, by their names; nothing is imported."""
    from importlib.metadata import entry_points

    return {point.name: point for point in entry_points(group=group)}


def loaded(point: EntryPoint, kind: type[Any]) -> Any:
    """Return what an entry point yields; raise `ModelError` unless it is an object of a type that has the entry point's name."""
    where = f"entry point {point.name} = {point.value}"
    try:
        found = point.load()
    except Exception as error:
        raise ModelError(f"{where}: {type(error).__name__}: {error}") from error
    if not isinstance(found, kind) or found.name != point.name:
        raise ModelError(
            f"{where}: must be {'an' if kind is not Model else 'a'} {kind.__name__} of this name"
        )
    return found


class ProgramFileError(InputError):
    """A program file that cannot be read."""


def read_program(path: Path) -> Program:
    """Return the program that the TOML file `path` states in its table ``[program]`` by the keys of `RULES`; it runs in the file's folder.

    ``docs/how-to/program.md`` has the keys. A `ProgramFileError` has all mistakes in the order of the file.
    """
    source = str(path)
    text = read_text(source, "no such file", ProgramFileError)
    tables = read_tables(text, source, ProgramFileError)
    given, mistakes = head_values(tables, "program", RULES, required=("name", "command"))
    mistakes += check_keys(tables, ("program",), required=("program",))
    if mistakes:
        raise ProgramFileError(source, RecordError(in_order(mistakes, tables)))
    return Program(Command(folder=path.resolve().parent, **given))


def _each(rule: Rule) -> Rule:
    return lambda value: tuple(rule(item) for item in rules.sequence(value))


def _words(value: object) -> object:
    if not rules.sequence(value):
        raise RuleError("must have a program")
    return _each(rules.text)(value)


def _colour(value: object) -> str:
    text: str = rules.text(value)
    if not re.fullmatch("#[0-9a-fA-F]{6}", text):
        raise RuleError("must be a colour, as #AA3377")
    return text


RULES: dict[str, Rule] = {
    "name": rules.name,
    "command": _words,
    "label": rules.text,
    "seconds": rules.positive,
    "memory": rules.positive,
    "environment": _each(rules.text),
    "elements": _each(rules.whole_number),
    "colour": _colour,
    "continuum": rules.truth,
}
"""The keys of a program file with the rules of their values."""

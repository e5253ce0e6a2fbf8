"""The models from outside this package: adapters, entry points of other packages, and program files."""

from __future__ import annotations

import sys
from collections.abc import Container
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.extras import install
from comparisons.models.base import Model
from comparisons.models.options import ModelError
from comparisons.models.outside.child import Limits
from comparisons.models.outside.program import Command, Program
from comparisons.scene import rules
from comparisons.scene.rules import RecordError, Rule, RuleError
from comparisons.scene.tables import InputError, check_keys, head_values, in_order, read_tables, read_text

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

GROUP = "crossval.models"
"""Group of the entry points by which other packages offer their models."""
SUFFIX = ".toml"
"""Suffix of a program file."""
ROOT = Path(__file__).parents[3]
"""Folder of this package, from which the adapters are imported."""
OF_ADAPTERS = {
    "calculix": (
        "CalculiX",
        "#117733",
        "ccx",
        "Debian's calculix-ccx is needed: there is no program ccx",
        True,
    ),
    "exudyn": ("Exudyn", "#999933", "exudyn", f"exudyn is needed: {install('exudyn')}", False),
    "felupe": ("FElupe", "#DDCC77", "felupe", f"felupe is needed: {install('felupe')}", True),
    "opensees": (
        "OpenSees",
        "#882255",
        "openseespy",
        f"openseespy is needed: {install('openseespy')}, and Debian's libblas3",
        False,
    ),
}
"""Label, colour, what it requires, how to install that, and whether it computes a two-dimensional body, by the adapter's module."""


def _adapter(name: str) -> Program:
    """Return the program of an adapter, which is the module of its name in `comparisons.models.outside.adapters`."""
    module, (label, colour, requires, needs, continuum) = f"{__package__}.adapters.{name}", OF_ADAPTERS[name]
    run = f"import runpy, sys; sys.path.insert(0, {str(ROOT)!r}); runpy.run_module({module!r}, run_name='__main__')"
    return Program(
        Command(
            name=name, label=label, command=(sys.executable, "-c", run), folder=Path.cwd(),
            elements=(10, 20, 40, 80), colour=colour, requires=requires, needs=needs, module=module,
            continuum=continuum,
        )
    )  # fmt: skip


ADAPTERS: dict[str, Program] = {name: _adapter(name) for name in OF_ADAPTERS}
"""The adapters of this package by name."""
_USED: dict[str, Model] = {}
"""The models from outside that this process has used, by name."""


def outside(name: str, taken: Container[str] = ()) -> Model | None:
    """Return a model that is none of this package; None if there is no such model.

    Parameters
    ----------
    name : str
        A program file ``NAME.toml``, the name of a program file read before, an adapter, or an entry point.
    taken : container of str
        Names that a program file must not state.

    Raises
    ------
    ProgramFileError
        If the file cannot be read, or states a name in `taken`.
    ModelError
        If an entry point yields no model.
    """
    if not known(name):
        return None
    model = read_program(Path(name)) if name.endswith(SUFFIX) else ADAPTERS.get(name) or _USED.get(name)
    model = model or _loaded(offered()[name])
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
def offered() -> dict[str, EntryPoint]:
    """Return the entry points by which installed packages offer models, by the models' names; nothing of the packages is imported."""
    from importlib.metadata import entry_points

    return {point.name: point for point in entry_points(group=GROUP)}


def _loaded(point: EntryPoint) -> Model:
    """Return the model that an entry point yields."""
    try:
        model = point.load()
    except Exception as error:
        raise ModelError(
            f"entry point {point.name} = {point.value}: {type(error).__name__}: {error}"
        ) from error
    if not isinstance(model, Model) or model.name != point.name:
        raise ModelError(f"entry point {point.name} = {point.value}: must be a Model of this name")
    return model


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
        raise ProgramFileError(source, RecordError(in_order(mistakes, tables)))
    limits = {name: given.pop(name) for name in ("seconds", "memory", "environment") if name in given}
    if "memory" in limits:
        limits["memory"] *= 1e6
    return Program(Command(folder=path.resolve().parent, limits=Limits(**limits), **given))


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

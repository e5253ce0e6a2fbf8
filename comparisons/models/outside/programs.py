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
from comparisons.models.outside.program import Program
from comparisons.models.outside.program_file import ProgramFileError, read_program
from comparisons.models.outside.source import Command

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

GROUP = "crossval.models"
"""Group of the entry points by which other packages offer their models."""
SUFFIX = ".toml"
"""Suffix of a program file."""
SOLIDS = ("calculix", "felupe")
"""The adapters of programs that compute two-dimensional bodies."""
ROOT = Path(__file__).parents[3]
"""Folder of this package, from which the adapters are imported."""


def _adapter(name: str, label: str, colour: str, requires: str, needs: str) -> Program:
    """Return the program of an adapter, which is the module of its name in `comparisons.models.outside.adapters`."""
    module = f"comparisons.models.outside.adapters.{name}"
    run = f"import runpy, sys; sys.path.insert(0, {str(ROOT)!r}); runpy.run_module({module!r}, run_name='__main__')"
    return Program(
        Command(
            name=name, label=label, command=(sys.executable, "-c", run), folder=Path.cwd(),
            elements=(10, 20, 40, 80), colour=colour, requires=requires, needs=needs, module=module,
            continuum=name in SOLIDS,
        )
    )  # fmt: skip


ADAPTERS: dict[str, Program] = {
    program.name: program
    for program in (
        _adapter(
            "calculix",
            "CalculiX",
            "#117733",
            "ccx",
            "Debian's calculix-ccx is needed: there is no program ccx",
        ),
        _adapter("exudyn", "Exudyn", "#999933", "exudyn", f"exudyn is needed: {install('exudyn')}"),
        _adapter("felupe", "FElupe", "#DDCC77", "felupe", f"felupe is needed: {install('felupe')}"),
        _adapter(
            "opensees",
            "OpenSees",
            "#882255",
            "openseespy",
            f"openseespy is needed: {install('openseespy')}, and Debian's libblas3",
        ),
    )
}
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
    if name.endswith(SUFFIX):
        model: Model | None = read_program(Path(name))
    else:
        model = (
            ADAPTERS.get(name) or _USED.get(name) or (_loaded(offered()[name]) if name in offered() else None)
        )
    if model is None:
        return None
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

"""The programs of others that are known: program files that were read."""

from collections.abc import Container
from pathlib import Path

from comparisons.models.base import Model
from comparisons.models.outside.program_file import ProgramFileError, read_program

SUFFIX = ".toml"
"""Suffix of a program file."""
_READ: dict[str, Model] = {}
"""Models of the program files read by this process, by name."""


def outside(name: str, taken: Container[str] = ()) -> Model | None:
    """Return the model of a program file ``NAME.toml``, or of one read before by its name; None if there is none.

    Raises
    ------
    ProgramFileError
        If the file cannot be read, or states a name in `taken`.
    """
    if not name.endswith(SUFFIX):
        return _READ.get(name)
    program = read_program(Path(name))
    if program.name in taken:
        raise ProgramFileError(name, f'program.name = "{program.name}": must not be the name of a model')
    _READ[program.name] = program
    return program


def read_before() -> tuple[Model, ...]:
    """Return the models of the program files that this process has read."""
    return tuple(_READ.values())

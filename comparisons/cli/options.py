"""What the commands make of their arguments: options of a model, where cases run, files to write."""

import argparse
import sys
from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.files import OutputError, result_file, write_text
from comparisons.models.model import ModelError, Options

if TYPE_CHECKING:
    from comparisons.suite.workers import Workers


def refuse(given: argparse.Namespace, names: Iterable[str], rule: str) -> None:
    """Raise ModelError for the first of some arguments that is given."""
    for name in (name for name in names if getattr(given, name)):
        words = {"others": "--with", "of": "SCENE"}
        raise ModelError(f"{words.get(name, '--' + name.replace('_', '-'))}: {rule}")


def chosen(given: argparse.Namespace) -> Options:
    """Return the options that were given."""
    return Options(**{name: getattr(given, name, None) for name in Options.__dataclass_fields__})


def workers(given: argparse.Namespace, number: int | None = None) -> "Workers":
    """Return where the cases run, by default `number` processes or one for each core."""
    from comparisons.suite.workers import cluster, local

    where = given.workers or number
    return partial(cluster, where) if isinstance(where, str) else partial(local, where)


STANDARD = Path("-")
"""Standard output, as a file to write JSON to."""
VTK = (".pvd", ".vtm", ".vtu", ".vtk")
"""The ends of VTK files, which are several and take a folder."""


def outputs(names: Sequence[str], *kinds: str) -> list[tuple[str, Path]]:
    """Return the files to write, tried out, each with its kind, the end of its name; a folder has the kind ``""``.

    Raises OutputError for a file of another kind, or one that cannot be written or is not this program's.
    """
    ends = f"must end in {', '.join(filter(None, kinds))}"
    rule = f"{ends}, or be a folder that is there, for VTK files" if "" in kinds else ends
    found = []
    for name, path in zip(names, map(Path, names), strict=True):
        kind = ".json" if path == STANDARD else "" if path.is_dir() else path.suffix
        if kind in VTK and "" in kinds:
            raise OutputError(
                f"{name}: VTK files go into a folder that is there: mkdir {path.stem}, then --out {path.stem}"
            )
        if kind not in kinds or not name:
            raise OutputError(f"{name or '--out'}: {rule}")
        found.append((kind, result_file(path) if kind and path != STANDARD else path))
    return found


def write(path: Path, text: str) -> None:
    """Write a text to a file, or to standard output."""
    if path == STANDARD:
        sys.stdout.write(text)
    else:
        write_text(path, text)

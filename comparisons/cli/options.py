"""The options of the models as arguments of commands."""

import argparse
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from comparisons.cli import values
from comparisons.models import MODELS
from comparisons.models.options import BRANCHES, Options
from comparisons.models.outside.programs import ADAPTERS, known

if TYPE_CHECKING:
    from comparisons.cases.workers import Workers

ARGUMENTS: dict[str, tuple[dict[str, Any], str]] = {
    "elements": ({"type": values.count, "metavar": "N"}, "elements of every beam"),
    "element": ({"metavar": "ELEMENT"}, "type of the elements"),
    "integration_tolerance": (
        {"type": values.part, "metavar": "X"},
        "error allowed to the integration inside exact elements (1e-9)",
    ),
    "mesh": ({"type": values.mesh, "metavar": "NXxNY"}, "elements along and across"),
    "branch": (
        {"choices": BRANCHES},
        "at a critical point stop (the default), turn to the stable branch, or go on along the primary one, unstable",
    ),
}
"""How each field of `Options` is read, and what it is."""


def argument(name: str) -> str:
    """Return the argument of a field of `Options`, as ``--integration-tolerance``."""
    return "--" + name.replace("_", "-")


class ModelNames:
    """The values of ``--model``: the models of this package, programs of others, and program files, which are read only when they are used."""

    def __iter__(self) -> Iterator[str]:
        """Iterate over the models and adapters of this package."""
        return iter((*MODELS, *ADAPTERS))

    def __contains__(self, name: object) -> bool:
        """Whether a name is known, or is the name of a file that may state a program."""
        return name in MODELS or known(str(name))


def add_options(parser: argparse.ArgumentParser, *names: str) -> None:
    """Add the named options to a command; their help says which models have them."""
    for name in names:
        how, what = ARGUMENTS[name]
        owners = ", ".join(model.name for model in MODELS.values() if name in model.options)
        parser.add_argument(argument(name), help=f"{owners}: {what}", **how)


def add_others(parser: argparse.ArgumentParser) -> None:
    """Add ``--with`` to a command that asks several models."""
    parser.add_argument(
        "--with",
        dest="others",
        action="append",
        default=[],
        choices=ModelNames(),
        metavar="MODEL",
        help="a program of others as well, any number of them: its name, or a program file NAME.toml",
    )


def add_workers(parser: argparse.ArgumentParser) -> None:
    """Add where cases run to a command that has many."""
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--workers",
        type=values.count,
        metavar="N",
        help="processes (one for each core; 1 where seconds are measured: cases side by side slow each other down)",
    )
    where.add_argument("--cluster", metavar="ADDRESS", help="the scheduler of a Dask cluster")


def workers(given: argparse.Namespace, number: int | None = None) -> "Workers":
    """Return where the cases run: ``--cluster``, or ``--workers`` processes, by default `number` of them or one for each core."""
    from comparisons.cases.workers import cluster, local

    return local(given.workers or number) if given.cluster is None else cluster(given.cluster)


def chosen(given: argparse.Namespace) -> Options:
    """Return the options that were given."""
    return Options(**{name: getattr(given, name, None) for name in ARGUMENTS})

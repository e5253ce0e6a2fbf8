"""The commands and their arguments: each argument is declared once, and a command names those that it has."""

import argparse
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from comparisons.files import OutputError, result_file, write_text
from comparisons.models import MODELS, TSM
from comparisons.models.options import BRANCHES, ModelError, Options
from comparisons.models.outside.programs import ADAPTERS, known
from comparisons.scene import rules
from comparisons.scene.rules import Rule, RuleError

if TYPE_CHECKING:
    from comparisons.cases.workers import Workers


class ModelNames:
    """The values of ``--model``: the models of this package, programs of others, and program files, which are read only when they are used."""

    def __iter__(self) -> Iterator[str]:
        """Iterate over the models and adapters of this package."""
        return iter((*MODELS, *ADAPTERS))

    def __contains__(self, name: object) -> bool:
        """Whether a name is known, or is the name of a file that may state a program."""
        return name in MODELS or known(str(name))


class Quantities:
    """The names of the quantities, which are imported where they are asked for; those of the path with `path`."""

    def __init__(self, *, path: bool) -> None:
        self.path = path

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names."""
        from comparisons.quantities import names

        return iter(names(path=self.path))

    def __str__(self) -> str:
        return ", ".join(self)


QUANTITIES = {"--accuracy": Quantities(path=False), "--max-error": Quantities(path=True)}
"""The quantities that an argument names."""


def checked(rule: Rule, read: Callable[[str], object] = str) -> Callable[[str], Any]:
    """Return the type of an argument whose value obeys a rule of the scene."""

    def value(text: str) -> Any:
        try:
            return rule(read(text))
        except ValueError as error:
            reason = error if isinstance(error, RuleError) else "must be a number"
            raise argparse.ArgumentTypeError(f"{text}: {reason}") from None

    return value


def bound(names: Quantities, rule: Rule, default: str = "") -> Callable[[str], tuple[str, float]]:
    """Return the type of an argument ``QUANTITY=X`` with one of some names; without a name it is `default`."""

    def value(text: str) -> tuple[str, float]:
        name = text.rpartition("=")[0] or default
        if name not in names:
            raise argparse.ArgumentTypeError(f"{text}: must be QUANTITY=X, one of {names}")
        return name, checked(rule, lambda text: float(text.rpartition("=")[2]))(text)

    return value


def _of(option: str, meaning: str) -> str:
    """Return the help of a field of `Options`, with the models that have it."""
    return f"{', '.join(model.name for model in MODELS.values() if option in model.options)}: {meaning}"


PART = {"type": checked(rules.fraction, float), "metavar": "X"}
COUNT = {"type": checked(rules.whole_number, int), "metavar": "N"}
FOLDER = {"type": Path, "metavar": "FOLDER"}
SWITCH = {"action": "store_true"}
MANY = {"action": "append", "default": []}
_REST = "at a critical point stop (the default), turn to the stable branch, or go on along the primary one, unstable"
_SHARED = (
    "processes (one for each core; 1 where seconds are measured: cases side by side slow each other down)"
)
_HELD = "load parameters to hold against the exact equilibrium: the last of every stage and those beside events (the default), all, none"
_CHOSEN = "choose model and resolution for this relative error of the force, or of another quantity, in place of elements and meshes: "
_WITH = "a program of others as well, any number of them: its name, or a program file NAME.toml"
ARGUMENTS: dict[str, tuple[str, dict[str, Any]]] = {
    "scene": ("a built-in scene or a TOML file", {"metavar": "SCENE"}),
    "scenes": ("built-in scenes or TOML files; all: every built-in one", {"nargs": "+", "metavar": "SCENE"}),
    "answer": ("what solve --out wrote, or a scene that tsm solves", {"metavar": "RESPONSE.json|SCENE"}),
    "what": ("a scene, or a folder of VTK files of `compare` or `solve --out`", {"metavar": "SCENE|FOLDER"}),
    "suite": ("a study file, or a suite", {"metavar": "NAME|FILE.toml"}),
    "of": (
        "trade: the scene; manual, cards: these problems only",
        {"nargs": "*", "metavar": "SCENE|PROBLEM"},
    ),
    "name": ("of the scene; the file is NAME.toml", {"metavar": "NAME"}),
    "--like": ("a built-in scene to start from", {"metavar": "SCENE"}),
    "--schema": ("print the JSON Schema of scene files, for editors", SWITCH),
    "--scene": ("of a response, where it is not a built-in one", {"metavar": "SCENE"}),
    "--model": (f"the model that solves ({TSM.name})", {"choices": ModelNames()}),
    "--with": (_WITH, {**MANY, "dest": "others", "choices": ModelNames(), "metavar": "MODEL"}),
    "--against": ("bounds: the model to measure against (rod)", {"choices": ModelNames()}),
    "--elements": (_of("elements", "elements of every beam"), COUNT),
    "--element": (_of("element", "type of the elements"), {"metavar": "ELEMENT"}),
    "--integration-tolerance": (
        _of("integration_tolerance", "error allowed to the integration inside exact elements (1e-9)"),
        PART,
    ),
    "--mesh": (
        _of("mesh", "elements along and across"),
        {"type": checked(rules.mesh_text), "metavar": "NXxNY"},
    ),
    "--branch": (_of("branch", _REST), {"choices": BRANCHES}),
    "--accuracy": (
        _CHOSEN + "%(quantities)s",
        {"type": bound(QUANTITIES["--accuracy"], rules.fraction, "force"), "metavar": "[QUANTITY=]X"},
    ),
    "--max-error": (
        "a bound, any number of them: %(quantities)s",
        {**MANY, "type": bound(QUANTITIES["--max-error"], rules.positive), "metavar": "QUANTITY=X"},
    ),
    "--certify": (_HELD, {"choices": ("last", "all", "none"), "default": "last"}),
    "--allowance": ("largest relative distance from the exact equilibrium (.05)", PART),
    "--scale": (
        "enlarge the deformation, and say so in the picture (1)",
        {"type": checked(rules.positive, float), "default": 1.0, "metavar": "FACTOR"},
    ),
    "--out=FILE": ("", {**MANY, "metavar": "FILE"}),
    "--out": ("folder of the results (out/NAME)", FOLDER),
    "--junit": ("write the bounds, or every answer of the manual, as JUnit XML", {"metavar": "FILE"}),
    "--quick": ("fewer or coarse settings", SWITCH),
    "--workers": (_SHARED, COUNT),
    "--cluster": ("the scheduler of a Dask cluster, instead of --workers", {"metavar": "ADDRESS"}),
    "--quiet": ("tell of no progress", SWITCH),
}
"""The help of every argument, and how it is read."""


class Command(NamedTuple):
    """A command: what it is for, what runs it, and the names of its arguments, in words; `own` is their help where it is another."""

    name: str
    help: str
    run: Callable[[argparse.Namespace], int]
    arguments: str
    own: Mapping[str, str] = {}
    description: str = ""
    epilog: str = ""

    def add_to(self, commands: Any) -> None:
        """Add the command to the subparsers of the parser."""
        parser = commands.add_parser(
            self.name, help=self.help, description=self.description, epilog=self.epilog
        )
        for name in self.arguments.split():
            meaning, reading = ARGUMENTS[name]
            action = parser.add_argument(name.partition("=")[0], help=self.own.get(name, meaning), **reading)
            vars(action)["quantities"] = QUANTITIES.get(name)
        parser.set_defaults(run=self.run)


def argument(name: str) -> str:
    """Return the argument of a field of `Options`, as ``--integration-tolerance``."""
    return "--" + name.replace("_", "-")


def chosen(given: argparse.Namespace) -> Options:
    """Return the options that were given."""
    return Options(**{name: getattr(given, name, None) for name in Options.__dataclass_fields__})


def workers(given: argparse.Namespace, number: int | None = None) -> "Workers":
    """Return where the cases run: ``--cluster``, or ``--workers`` processes, by default `number` of them or one for each core."""
    from comparisons.cases.workers import cluster, local

    if given.workers and given.cluster:
        raise ModelError("--cluster: is not allowed with argument --workers")
    return local(given.workers or number) if given.cluster is None else cluster(given.cluster)


STANDARD = Path("-")
"""Standard output, as a file to write JSON to."""


def outputs(names: Sequence[str], *kinds: str) -> list[tuple[str, Path]]:
    """Return the files to write, tried out, each with its kind, the end of its name; a folder has the kind ``""``.

    Raises OutputError for a file of another kind, or one that cannot be written or is not this program's.
    """
    found = []
    for name in names:
        path = Path(name)
        kind = ".json" if path == STANDARD else "" if path.is_dir() else path.suffix
        if kind not in kinds:
            raise OutputError(f"{name}: must end in {', '.join(filter(None, kinds))}")
        found.append((kind, result_file(path) if kind and path != STANDARD else path))
    return found


def write(path: Path, text: str) -> None:
    """Write a text to a file, or to standard output."""
    if path == STANDARD:
        sys.stdout.write(text)
    else:
        write_text(path, text)

"""The commands and their arguments: each argument is declared once, and a command names those that it has."""

import argparse
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from comparisons.files import OutputError, result_file, write_text
from comparisons.models import MODELS, TSM
from comparisons.models.options import BRANCHES, Options
from comparisons.models.outside.programs import ADAPTERS, known
from comparisons.scene import rules
from comparisons.scene.rules import Rule, RuleError

if TYPE_CHECKING:
    from comparisons.cases.workers import Workers


class Names:
    """Names that are looked up where they are asked for, and whether a name is one of them."""

    def __init__(self, listed: Callable[[], Iterable[str]], known: Callable[[str], bool]) -> None:
        self.listed, self.known = listed, known

    def __iter__(self) -> Iterator[str]:
        return iter(self.listed())

    def __contains__(self, name: str) -> bool:
        return name in self.listed() or self.known(name)

    def __str__(self) -> str:
        return ", ".join(self)


def _quantities(*, path: bool) -> Names:
    """Return the names of the quantities, or of those of the path."""

    def listed() -> Iterable[str]:
        from comparisons.quantities import names

        return names(path=path)

    return Names(listed, lambda _: False)


MODEL_NAMES = Names(lambda: (*MODELS, *ADAPTERS), known)
"""The models of this package, programs of others, and program files, which are read only when they are used."""
QUANTITIES = {"--accuracy": _quantities(path=False), "--max-error": _quantities(path=True)}
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


def bound(names: Names, rule: Rule, default: str = "") -> Callable[[str], tuple[str, float]]:
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


def _workers(text: str) -> int | str:
    """Return a number of processes, or an address, which has letters."""
    found: int | str = text if any(map(str.isalpha, text)) else checked(rules.whole_number, int)(text)
    return found


PART = {"type": checked(rules.fraction, float), "metavar": "X"}
COUNT = {"type": checked(rules.whole_number, int), "metavar": "N"}
SWITCH = {"action": "store_true"}
MANY = {"action": "append", "default": []}
_REST = "at a critical point stop (the default), turn to the stable branch, or go on along the primary one, unstable"
_SHARED = (
    "processes (one for each core; 1 where seconds are measured: cases side by side slow each other down), or the scheduler "
    "of a Dask cluster, as tcp://127.0.0.1:8786"
)
_HELD = "load parameters to hold against the exact equilibrium: the last of every stage and those beside events (the default), all, none"
_CHOSEN = "choose model and resolution for this relative error of the force, or of another quantity, in place of elements and meshes: "
_WITH = "a program of others as well, any number of them: its name, or a program file NAME.toml"
_WITHIN = "error allowed to the integration inside exact elements (1e-9)"
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
    "--model": (f"the model that solves ({TSM.name})", {"choices": MODEL_NAMES}),
    "--with": (_WITH, {**MANY, "dest": "others", "choices": MODEL_NAMES, "metavar": "MODEL"}),
    "--against": ("bounds: the model to measure against (rod)", {"choices": MODEL_NAMES}),
    "--elements": (_of("elements", "elements of every beam"), COUNT),
    "--element": (_of("element", "type of the elements"), {"metavar": "ELEMENT"}),
    "--integration-tolerance": (_of("integration_tolerance", _WITHIN), PART),
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
    "--out": ("folder of the results (out/NAME)", {"type": Path, "metavar": "FOLDER"}),
    "--quick": ("fewer or coarse settings", SWITCH),
    "--workers": (_SHARED, {"type": _workers, "metavar": "N|ADDRESS"}),
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
        texts = {"help": self.help, "description": self.description, "epilog": self.epilog}
        parser = commands.add_parser(self.name, **texts)
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
    """Return where the cases run, by default `number` processes or one for each core."""
    from comparisons.cases.workers import cluster, local

    return cluster(given.workers) if isinstance(given.workers, str) else local(given.workers or number)


STANDARD = Path("-")
"""Standard output, as a file to write JSON to."""


def outputs(names: Sequence[str], *kinds: str) -> list[tuple[str, Path]]:
    """Return the files to write, tried out, each with its kind, the end of its name; a folder has the kind ``""``.

    Raises OutputError for a file of another kind, or one that cannot be written or is not this program's.
    """
    found = []
    for name, path in zip(names, map(Path, names), strict=True):
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

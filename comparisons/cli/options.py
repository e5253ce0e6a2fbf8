"""The arguments of the commands: their words are in ``commands.toml``, here is how they are read."""

import argparse
import sys
import tomllib
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from comparisons.files import OutputError, result_file, write_text
from comparisons.models import MODELS
from comparisons.models.model import BRANCHES, ModelError, Options
from comparisons.scene import rules
from comparisons.scene.rules import Rule, RuleError
from comparisons.suites.names import SUITES

if TYPE_CHECKING:
    from comparisons.suite.workers import Workers


class Listed:
    """Names for a help, which are looked up where it is asked for."""

    def __init__(self, names: Callable[[], Iterable[str]]) -> None:
        self.names = names

    def __str__(self) -> str:
        return ", ".join(self.names())


def _models() -> Iterable[str]:
    from comparisons.models.outside.programs import ADAPTERS

    return (*MODELS, *ADAPTERS)


def _quantities(*, path: bool) -> Iterable[str]:
    from comparisons.answer.quantities import names

    return names(path=path)


LISTED = {
    "--model": Listed(_models),
    "--accuracy": Listed(partial(_quantities, path=False)),
    "--max-error": Listed(partial(_quantities, path=True)),
}
"""The names that an argument takes."""


def obeying(rule: Rule, text: str, whole: str = "") -> Any:
    """Return the number or word that obeys a rule of the scene; it is a part of the argument `whole`."""
    word: object = text
    for form in (float, int):
        with suppress(ValueError):
            word = form(text)
    try:
        return rule(word)
    except RuleError as error:
        raise argparse.ArgumentTypeError(f"{whole or text}: {error}") from None


def _bound(argument: str, rule: Rule, default: str, text: str) -> tuple[str, float]:
    """Return what ``QUANTITY=X`` states, one of the quantities of an argument; without one it is `default`."""
    name, _, value = text.rpartition("=")
    if (name or default) not in LISTED[argument].names():
        raise argparse.ArgumentTypeError(f"{text}: must be QUANTITY=X, one of {LISTED[argument]}")
    return name or default, obeying(rule, value, text)


def _workers(text: str) -> int | str:
    """Return a number of processes, or an address, which has letters."""
    return text if any(map(str.isalpha, text)) else int(obeying(rules.whole_number, text))


STATED = tomllib.loads(Path(__file__).with_name("commands.toml").read_text(encoding="utf-8"))
"""The commands and their arguments, in words."""
TYPES: dict[str, Callable[[str], object]] = {
    "--accuracy": partial(_bound, "--accuracy", rules.fraction, "force"),
    "--max-error": partial(_bound, "--max-error", rules.positive, ""),
    "--branch": partial(obeying, rules.choice(*BRANCHES)),
    "--workers": _workers,
    "--out": Path,
}
"""How the text of an argument is read that has no rule."""


def add_command(commands: Any, name: str) -> None:
    """Add a command to the subparsers of the parser."""
    stated = STATED["command"][name]
    parser = commands.add_parser(name, **{key: stated.get(key) for key in ("help", "description", "epilog")})
    for argument in stated["arguments"].split():
        reading = {**STATED["argument"][argument]}
        reading["help"] = stated.get("own", {}).get(argument, reading.get("help"))
        rule = reading.pop("rule", None)
        if rule or argument in TYPES:
            reading["type"] = TYPES.get(argument) or partial(obeying, getattr(rules, rule))
        action = parser.add_argument(argument.partition("=")[0], **reading)
        models = ", ".join(model.name for model in MODELS.values() if action.dest in model.options)
        vars(action).update(models=models, names=LISTED.get(argument), suites=", ".join(SUITES))
    parser.set_defaults(command=name)


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

    return cluster(given.workers) if isinstance(given.workers, str) else local(given.workers or number)


STANDARD = Path("-")
"""Standard output, as a file to write JSON to."""


def outputs(names: Sequence[str], *kinds: str) -> list[tuple[str, Path]]:
    """Return the files to write, tried out, each with its kind, the end of its name; a folder has the kind ``""``.

    Raises OutputError for a file of another kind, or one that cannot be written or is not this program's.
    """
    ends = f"must end in {', '.join(filter(None, kinds))}"
    rule = f"{ends}, or be a folder that is there, for VTK files" if "" in kinds else ends
    found = []
    for name, path in zip(names, map(Path, names), strict=True):
        kind = ".json" if path == STANDARD else "" if path.is_dir() else path.suffix
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

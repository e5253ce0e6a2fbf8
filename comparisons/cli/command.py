"""The command itself: its arguments, whose words are in ``commands.toml``, and one line and an exit status for whatever goes wrong."""

import argparse
import os
import signal
import sys
import threading
import tomllib
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager, redirect_stderr, suppress
from functools import partial
from importlib import import_module
from pathlib import Path
from textwrap import fill
from typing import Any, NoReturn, TextIO

from comparisons.extras import EXTRAS, install
from comparisons.files import OutputError, filled, printable
from comparisons.scene import FieldError, InputError, rules
from comparisons.scene.rules import Rule
from comparisons.suites.names import SUITES

DONE, WRONG, BAD_INPUT, STOPPED, INTERRUPTED = 0, 1, 2, 3, 130
STATED = tomllib.loads(Path(__file__).with_name("commands.toml").read_text(encoding="utf-8"))
"""The commands and their arguments, in words."""
GONE: dict[str, str] = STATED["gone"]
"""Commands and options of earlier versions, and what does their work."""
NEEDED = ("numpy", "scipy", "scikit-fem", "meshio", "matplotlib", "jinja2")
"""Libraries that no command does without."""
OWN = ("comparisons", "tsm", "fem_reference")
"""Packages whose absence is a bug and no missing library."""


def main(arguments: list[str] | None = None) -> int:
    """Run the command and return its exit status: 0 done, 1 a wrong answer, 2 bad input, 3 a solution that stopped."""
    first, *more = (sys.argv[1:] if arguments is None else arguments) or [""]
    words = (first, *(word.partition("=")[0] for word in more if word.startswith("-")))
    with ExitStack() as streams:
        if sys.stderr is None:  # closed: messages are discarded
            nowhere = streams.enter_context(Path(os.devnull).open("w"))
            streams.enter_context(redirect_stderr(nowhere))
        if sys.stdout is None:
            return told("output: standard output is closed", BAD_INPUT)
        for word in (word for word in words if word in GONE):
            kind = "an option" if word.startswith("-") else "a command"
            return told(f"{word}: is no longer {kind}, see {GONE[word]}", BAD_INPUT)
        return _version() if words == ("--version",) else _run(arguments)


def _run(arguments: list[str] | None) -> int:
    status: int
    given = command_parser().parse_args(arguments)
    try:
        with _ended_as_a_whole():
            status = import_module(f"comparisons.cli.{given.command}").run(given)
        sys.stdout.flush()
    except InputError as error:
        for line in str(error).split("\n"):
            status = told(line, BAD_INPUT)
    except BrokenPipeError:
        # whoever read the output has had enough
        _drop_output()
        status = DONE
    except OSError as error:
        status = told(f"{error.filename or 'output'}: {error.strerror}", BAD_INPUT)
        _drop_output()
    except ImportError as error:
        missing = error.name or str(error).strip().partition("\n")[0]
        if missing.startswith(OWN):
            raise
        status = told(f"{missing}: cannot be imported, {install(missing)}", BAD_INPUT)
    except KeyboardInterrupt:
        status = told("interrupted", INTERRUPTED)
    except _refusals() as error:  # whose names may have line ends
        ran = getattr(error, "status", None)
        status = told(error, STOPPED if ran and ran.name != "NOT_STARTED" else BAD_INPUT)
    return status


def _refusals() -> tuple[type[Exception], ...]:
    """Return the errors of files, models and programs of others; the rooms of the last two are not imported before something fails."""
    from comparisons.models.model import ModelError
    from comparisons.models.outside.child import ProgramError

    return OutputError, ModelError, ProgramError


def report(line: str, stream: TextIO | None = None, indent: int = 2) -> None:
    """Print a line to standard error or another stream, on a terminal in lines that fit it, with all but the first one indented."""
    stream, text = stream or sys.stderr, printable(line)
    if stream.isatty():
        text = "\n".join(filled(text, rest=" " * indent))
    print(text, file=stream, flush=True)


def told(reason: object, status: int) -> int:
    """Report a reason, and return an exit status."""
    report(f"crossval: {reason}")
    return status


@contextmanager
def _ended_as_a_whole() -> Iterator[None]:
    """Let SIGTERM and SIGHUP end the command by an exception: temporary files and the processes of programs are removed."""
    main = threading.current_thread() is threading.main_thread()
    names = ("SIGTERM", "SIGHUP") if main else ()
    ends = [one for one in signal.Signals if one.name in names and signal.getsignal(one) is signal.SIG_DFL]
    for number in ends:
        signal.signal(number, lambda number, _: sys.exit(128 + number))
    try:
        yield
    finally:
        for number in ends:
            signal.signal(number, signal.SIG_DFL)


def _drop_output() -> None:
    """Spare the interpreter a last flush that fails."""
    with suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _version() -> int:
    """Print the version, and the version of every library and program, or how the missing one is had."""
    import shutil
    from importlib import metadata

    def found(name: str) -> str | None:
        with suppress(metadata.PackageNotFoundError):
            return metadata.version(name)
        return None

    rows = [("python", sys.version.partition(" ")[0], ""), *((name, found(name), "") for name in NEEDED)]
    rows += ((name, found(name), f"missing, extra {extra}: {use}") for name, (extra, use) in EXTRAS.items())
    ccx = "missing, Debian's calculix-ccx: --model calculix, crossval run peers"
    rows.append(("ccx", shutil.which("ccx"), ccx))
    print(f"crossval {metadata.version('tsm-crossval')}")
    for name, state, absent in rows:
        mark = "ok" if state else "-" if absent else "MISSING"
        print(f"{mark:8s}{name:14s} {state or absent or 'missing'}")
    return DONE if all(state or absent for _, state, absent in rows) else WRONG


class Listed:
    """Names for a help, which are looked up where it is asked for."""

    def __init__(self, names: Callable[[], Iterable[str]]) -> None:
        self.names = names

    def __str__(self) -> str:
        return ", ".join(self.names())


def _models(option: str = "") -> Iterable[str]:
    """Return the names of all models and programs, or of the models that have an option."""
    from comparisons.models import MODELS
    from comparisons.models.outside.programs import ADAPTERS

    if option:
        return (model.name for model in MODELS.values() if option in model.options)
    return (*MODELS, *ADAPTERS)


def _quantities(*without: str) -> Iterable[str]:
    from comparisons.answer.quantities import names

    return names(*without)


LISTED = {
    "--model": Listed(_models),
    "--accuracy": Listed(partial(_quantities, "path")),
    "--max-error": Listed(_quantities),
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
    except FieldError as error:
        raise argparse.ArgumentTypeError(f"{whole or text}: {error.rule}") from None


def _bound(argument: str, rule: Rule, default: str, text: str) -> tuple[str, float]:
    """Return what ``QUANTITY=X`` states, one of the quantities of an argument; without one it is `default`."""
    name, _, value = text.rpartition("=")
    if (name or default) not in LISTED[argument].names():
        raise argparse.ArgumentTypeError(f"{text}: must be QUANTITY=X, one of {LISTED[argument]}")
    return name or default, obeying(rule, value, text)


def _branch(text: str) -> Any:
    """Return a way to go on at a critical point."""
    from comparisons.models.model import BRANCHES

    return obeying(rules.choice(*BRANCHES), text)


def _workers(text: str) -> int | str:
    """Return a number of processes, or an address, which has letters."""
    return text if any(map(str.isalpha, text)) else int(obeying(rules.whole_number, text))


TYPES: dict[str, Callable[[str], object]] = {
    "--accuracy": partial(_bound, "--accuracy", rules.fraction, "force"),
    "--max-error": partial(_bound, "--max-error", rules.positive, ""),
    "--branch": _branch,
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
        vars(action).update(models=Listed(partial(_models, action.dest)), names=LISTED.get(argument))
    parser.set_defaults(command=name)


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are reported as all others, after the usage."""

    def error(self, message: str) -> NoReturn:
        self.print_usage(sys.stderr)
        report(f"{self.prog}: error: {message}")
        raise SystemExit(BAD_INPUT)


def command_parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command."""
    parser = _Parser(
        prog="crossval",
        description="Contact of beams: tangent stiffness method, 2D solid elements and exact answers on one scene.",
        epilog=STATED["command"]["solve"]["epilog"],
    )
    looked_up = "print the version, and which libraries and programs are here"
    parser.add_argument("--version", action="store_true", help=looked_up)
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for name in STATED["command"]:
        add_command(commands, name)
    suites, run = (f"  {name:10s}  {what}" for name, what in SUITES.items()), commands.choices["run"]
    run.formatter_class = argparse.RawDescriptionHelpFormatter
    run.epilog = "\n".join(
        ["what there is to run:", *suites, "", fill(" ".join(str(run.epilog).split()), 79)]
    )
    return parser

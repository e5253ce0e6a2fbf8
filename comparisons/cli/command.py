"""The command itself: its arguments, and one line and an exit status for whatever goes wrong."""

import argparse
import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, redirect_stderr, suppress
from importlib import import_module
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, NoReturn

from comparisons.cli.options import STATED, add_command
from comparisons.cli.screen import BAD_INPUT, DONE, INTERRUPTED, STOPPED, WRONG, report
from comparisons.extras import EXTRAS, install
from comparisons.files import OutputError, printable
from comparisons.models.model import ModelError
from comparisons.scene import InputError
from comparisons.suites.names import SUITES

if TYPE_CHECKING:
    from comparisons.models.outside.child import ProgramError

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
            return _told("output: standard output is closed", BAD_INPUT)
        for word in (word for word in words if word in GONE):
            kind = "an option" if word.startswith("-") else "a command"
            return _told(f"{word}: is no longer {kind}, see {GONE[word]}", BAD_INPUT)
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
            status = _told(line, BAD_INPUT)
    except (ModelError, OutputError) as error:  # whose names may have line ends
        status = _told(error, BAD_INPUT)
    except BrokenPipeError:
        # whoever read the output has had enough
        _drop_output()
        status = DONE
    except OSError as error:
        status = _told(f"{error.filename or 'output'}: {error.strerror}", BAD_INPUT)
        _drop_output()
    except ImportError as error:
        missing = error.name or str(error).strip().partition("\n")[0]
        if missing.startswith(OWN):
            raise
        status = _told(f"{missing}: cannot be imported, {install(missing)}", BAD_INPUT)
    except KeyboardInterrupt:
        status = _told("interrupted", INTERRUPTED)
    except _program_error() as error:
        status = _told(error, BAD_INPUT if error.status.name == "NOT_STARTED" else STOPPED)
    return status


def _program_error() -> "type[ProgramError]":
    """Return the error of a program of others, whose room is not imported before something fails."""
    from comparisons.models.outside.child import ProgramError

    return ProgramError


@contextmanager
def _ended_as_a_whole() -> Iterator[None]:
    """Let SIGTERM and SIGHUP end the command by an exception: temporary files and the processes of programs are removed."""
    main = threading.current_thread() is threading.main_thread()
    ends = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if main and hasattr(signal, name)]
    ends = [number for number in ends if signal.getsignal(number) is signal.SIG_DFL]
    for number in ends:
        signal.signal(number, lambda number, _: sys.exit(128 + number))
    try:
        yield
    finally:
        for number in ends:
            signal.signal(number, signal.SIG_DFL)


def _told(reason: object, status: int) -> int:
    report(f"crossval: {reason}")
    return status


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
    rows += (
        (name, found(name), f"missing, extra {extra.name}: {extra.use}") for name, extra in EXTRAS.items()
    )
    rows.append(
        ("ccx", shutil.which("ccx"), "missing, Debian's calculix-ccx: --model calculix, crossval run peers")
    )
    print(f"crossval {metadata.version('tsm-crossval')}")
    for name, state, absent in rows:
        mark = "ok" if state else "-" if absent else "MISSING"
        print(f"{mark:8s}{name:14s} {state or absent or 'missing'}")
    return DONE if all(state or absent for _, state, absent in rows) else WRONG


class _Parser(argparse.ArgumentParser):
    """A parser whose errors show arguments that a terminal would obey as escapes."""

    def error(self, message: str) -> NoReturn:
        super().error(printable(message))


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

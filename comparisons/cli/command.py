"""The command itself: its arguments, and one line and an exit status for whatever goes wrong."""

import argparse
import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, redirect_stderr, suppress
from pathlib import Path
from typing import NoReturn

from comparisons.cli import certify, compare, run, scene_files, solve, view
from comparisons.cli.options import STATED, add_command
from comparisons.cli.screen import BAD_INPUT, DONE, INTERRUPTED, STOPPED, WRONG, report
from comparisons.extras import EXTRAS, install
from comparisons.files import OutputError, printable
from comparisons.models.options import ModelError
from comparisons.models.outside.child import ProgramError, ProgramStatus
from comparisons.scene import InputError

COMMANDS = {
    "scenes": scene_files.run_scenes,
    "new": scene_files.run_new,
    "check": scene_files.run_check,
    "solve": solve.run,
    "compare": compare.run,
    "certify": certify.run,
    "run": run.run,
    "view": view.run,
}
"""What runs each command, in the order of the help."""
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
            status = given.run(given)
        sys.stdout.flush()
    except InputError as error:
        for line in str(error).split("\n"):
            status = _told(line, BAD_INPUT)
    except (ModelError, OutputError) as error:
        status = _told(error, BAD_INPUT)
    except ProgramError as error:
        status = _told(error, BAD_INPUT if error.status is ProgramStatus.NOT_STARTED else STOPPED)
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
    return status


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

    from comparisons.report.render import renders

    def found(name: str) -> str | None:
        with suppress(metadata.PackageNotFoundError):
            return metadata.version(name)
        return None

    uses = {name: f"missing, extra {extra.name}: {extra.use}" for name, extra in EXTRAS.items()}
    uses["ccx"] = "missing, Debian's calculix-ccx: --model calculix, crossval run peers"
    uses["OpenGL"] = "missing: no picture of stressed bodies, by compare and view"
    states: dict[str, str | None] = {"python": ".".join(map(str, sys.version_info[:3]))}
    states |= {name: found(name) for name in (*NEEDED, *EXTRAS)}
    states |= {"ccx": shutil.which("ccx"), "OpenGL": "off-screen rendering works" if renders() else None}
    print(f"crossval {metadata.version('tsm-crossval')}")
    for name, state in states.items():
        mark = "ok" if state else "-" if name in uses else "MISSING"
        print(f"{mark:8s}{name:14s} {state or uses.get(name, 'missing')}")
    return DONE if all(states[name] for name in NEEDED) else WRONG


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
    for name, function in COMMANDS.items():
        add_command(commands, name, function, suites=", ".join(run.SUITES))
    commands.choices["run"].description = "; ".join(f"{name}: {one.what}" for name, one in run.SUITES.items())
    return parser

"""The command itself: its arguments, and one line and an exit status for whatever goes wrong."""

import argparse
import os
import sys
from importlib import metadata

from comparisons.cli import (
    compare,
    doctor,
    extremes,
    gate,
    manual,
    reproduce,
    results,
    scene_files,
    solve,
    study,
    trade,
    view,
)
from comparisons.cli.outcome import BAD_INPUT, DONE, EPILOG, INTERRUPTED, STOPPED
from comparisons.files import OutputError
from comparisons.options import ModelError
from comparisons.peers.ccx import CalculixError
from comparisons.scene import InputError

COMMANDS = (
    scene_files,
    solve,
    compare,
    view,
    gate,
    reproduce,
    trade,
    study,
    results,
    manual,
    extremes,
    doctor,
)
"""The modules of the commands, in the order of the help: each adds its own to the parser."""


def main(arguments: list[str] | None = None) -> int:
    """Run the command and return its exit status: 0 done, 1 a wrong answer, 2 bad input, 3 a solution that stopped."""
    given = command_parser().parse_args(arguments)
    try:
        status: int = given.run(given)
    except (InputError, ModelError, OutputError) as error:
        print(f"crossval: {error}", file=sys.stderr)
        return BAD_INPUT
    except CalculixError as error:
        print(f"crossval: {error}", file=sys.stderr)
        return BAD_INPUT if error.printed is None else STOPPED
    except BrokenPipeError:
        # whoever read the output has had enough; spare the interpreter its last flush
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except OSError as error:
        print(f"crossval: {error.filename or 'output'}: {error.strerror}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("crossval: interrupted", file=sys.stderr)
        return INTERRUPTED
    return status


def command_parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command."""
    parser = argparse.ArgumentParser(
        prog="crossval",
        description="Contact of beams: tangent stiffness method, 2D solid elements and exact answers on one scene.",
        epilog=EPILOG,
    )
    parser.add_argument("--version", action="version", version=f"crossval {metadata.version('tsm-crossval')}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for module in COMMANDS:
        module.add_to(commands)
    return parser

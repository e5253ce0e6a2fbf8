"""``crossval completion``: what lets a shell complete the command."""

import sys
from typing import TYPE_CHECKING

from comparisons.cli.outcome import DONE

if TYPE_CHECKING:
    import argparse

    from comparisons.cli.outcome import Commands

SHELLS = ("bash", "zsh", "tcsh")


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    completion = commands.add_parser(
        "completion",
        help="print what lets a shell complete the command",
        description="bash: crossval completion bash > ~/.local/share/bash-completion/completions/crossval",
    )
    completion.add_argument("shell", choices=SHELLS)
    completion.set_defaults(run=run)


def run(given: "argparse.Namespace") -> int:
    """Print the script."""
    import shtab

    sys.stdout.write(shtab.complete(given.parser, given.shell) + "\n")
    return DONE

"""``crossval completion``: what lets a shell complete the command."""

import argparse
import re
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from comparisons.claims.solid.questions import QUESTIONS
from comparisons.cli.outcome import DONE
from comparisons.scene import built_in_scenes

if TYPE_CHECKING:
    from comparisons.cli.outcome import Commands

SHELLS = ("bash", "zsh", "tcsh")
FILES = {
    "SCENE": ("toml",),
    "SCENE|DIR": ("toml",),
    "RESPONSE.json|SCENE": ("json", "toml"),
    "FILE|QUESTION": ("toml",),
    "FILE": ("",),
    "DIR": (),
}
"""Suffixes of the files that a value may name, all files where a suffix is empty, by the value's name in the help; folders come besides."""


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    completion = commands.add_parser(
        "completion",
        help="print what lets a shell complete the command",
        description="bash: crossval completion bash > ~/.local/share/bash-completion/completions/crossval",
    )
    completion.add_argument("shell", choices=SHELLS)
    completion.set_defaults(run=run)


def run(given: argparse.Namespace) -> int:
    """Print the script."""
    import shtab

    words = _words()
    for action in arguments(given.parser):
        if action.choices is None and action.metavar in {*words, *FILES}:
            name = str(action.metavar)
            action.complete = _completion(name, words.get(name, ()))  # type: ignore[attr-defined]  # for shtab
    sys.stdout.write(shtab.complete(given.parser, given.shell) + "\n")
    return DONE


def arguments(parser: argparse.ArgumentParser) -> Iterator[argparse.Action]:
    """Yield the arguments of a command and of its subcommands."""
    for action in parser._actions:  # noqa: SLF001 - argparse has no public list
        if isinstance(action, argparse._SubParsersAction):  # noqa: SLF001 - it has no public name
            for command in action.choices.values():
                yield from arguments(command)
        else:
            yield action


def _words() -> dict[str, tuple[str, ...]]:
    """Return the words that a value may be, by its name in the help."""
    from comparisons.claims.manual.problems import PROBLEMS
    from tsm import ELEMENTS

    scenes = tuple(built_in_scenes())
    return {
        "SCENE": scenes,
        "SCENE|DIR": scenes,
        "RESPONSE.json|SCENE": scenes,
        "FILE|QUESTION": tuple(QUESTIONS),
        "ELEMENT": tuple(ELEMENTS),
        "PROBLEM": tuple(PROBLEMS),
    }


def _completion(name: str, words: tuple[str, ...]) -> dict[str, Any]:
    """Return what completes a value in every shell: its words, its files and folders."""
    function = "_crossval_" + re.sub(r"\W", "_", name)
    listed, suffixes = " ".join(words), FILES.get(name)
    bash = [f'compgen -W "{listed}" -- "$1"'] if words else []
    bash += [
        f"""compgen -f -X '!*{suffix and "." + suffix}' -- "$1" """.rstrip() for suffix in suffixes or ()
    ]
    zsh = [f"'words:{name.lower()}:({listed})'"] if words else []
    if suffixes is not None:
        bash.append('compgen -d -- "$1"')
        pattern = f' -g "*.({"|".join(suffixes)})"' if all(suffixes) else ""
        zsh.append(f"'files:file:_files{pattern if suffixes else ' -/'}'")
    tcsh = f"({listed})" if words else "f" if suffixes else "d"
    preamble = {
        "bash": "\n".join([f"{function}() {{", *(f"  {line}" for line in bash), "}"]),
        "zsh": f"{function}() {{\n  _alternative {' '.join(zsh)}\n}}",
    }
    return {"bash": function, "zsh": function, "tcsh": tcsh, "preamble": preamble}

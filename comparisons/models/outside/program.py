"""A program of others as a model: the resolved scene goes to its standard input, a response comes from its standard output."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from importlib.util import find_spec
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.models.base import Model, Style
from comparisons.models.options import ModelError, Options
from comparisons.models.outside.child import Limits, found, run

if TYPE_CHECKING:
    from comparisons.models.progress import Watch
    from comparisons.response import Response
    from comparisons.scene import Scene

COLOUR = "#AA3377"
"""Default colour of a program's lines."""


@dataclass(frozen=True, kw_only=True)
class Command:
    """How a program is run.

    Parameters
    ----------
    name : str
        Name of the model.
    label : str
        Name in figures and texts.
    command : tuple of str
        The program and its arguments. A program with a separator in its path is relative to `folder`.
    folder : Path
        Working directory of the program.
    limits : Limits
        Limits on time and memory.
    elements : tuple of int
        Numbers of elements along a beam that comparisons of cost run; empty if the program chooses its resolution itself.
    colour : str
        Colour of its lines, in hexadecimal digits.
    requires : str
        Python module or program without which `command` cannot run; by default the program of `command`.
    needs : str
        Sentence on how to install what is required.
    """

    name: str
    label: str
    command: tuple[str, ...]
    folder: Path
    limits: Limits = field(default_factory=Limits)
    elements: tuple[int, ...] = ()
    colour: str = COLOUR
    requires: str = ""
    needs: str = ""


class Program(Model):
    """A program of others, in a child process.

    Parameters
    ----------
    command : Command
        How it is run.
    """

    def __init__(self, command: Command) -> None:
        self.command = command
        self.name, self.label = command.name, command.label
        self.options = ("elements",) if command.elements else ()

    @property
    def identity(self) -> str:
        """Name of the program, and a digest of its command and of the files among the words of its command."""
        import hashlib
        import json

        words = [self.command.folder / word for word in self.command.command]
        files = [hashlib.sha256(path.read_bytes()).hexdigest() for path in words if path.is_file()]
        content = json.dumps([self.command.command, files])
        return f"{self.name} {hashlib.sha256(content.encode()).hexdigest()}"

    def missing(self) -> str | None:
        """Return what must be installed to run the program; None if it can be found."""
        program = self.command.requires or self.command.command[0]
        there = found(program, self.command.folder) or (self.command.requires and find_spec(program))
        return None if there else self.command.needs or f"there is no program {program}"

    def refusal(self, scene: Scene) -> str | None:
        """Return why the program cannot state `scene`: it is asked with the scene and no load parameters."""
        return self.missing() or _refusal(self.command, scene)

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:
        """Return the response to `scene`, not yet checked. Its status names what failed if there is none."""
        from comparisons.models.outside.answer import answer, silent
        from comparisons.models.outside.request import request
        from comparisons.models.outside.status import ProgramError

        del watch
        missing = self.missing()
        if missing is not None:
            raise ModelError(missing)
        try:
            text = request(scene, options, scene.times)
            output, seconds = run(self.command.command, self.command.folder, text, self.command.limits)
            return answer(output, scene, self.name, seconds)
        except ProgramError as error:
            return silent(
                scene, self.name, error.status.name, str(error), reported_success=error.reported_success
            )

    def styles(self) -> dict[str, Style]:
        """Return one style."""
        return {self.label: Style(colour=self.command.colour, marker="D")}

    def run_label(self, options: Options) -> str:
        """Return the label of one run, as ``mine, 20 elements``."""
        count = options.elements
        return self.label if count is None else f"{self.label}, {count} element{'s' if count > 1 else ''}"

    def setting(self, scene: Scene, options: Options) -> str:
        """Return the numbers of elements; empty if the program chooses its resolution itself."""
        counts = {options.elements or beam.elements for beam in scene.beams} if self.options else set()
        return "+".join(map(str, sorted(counts)))

    def resolution(self, options: Options) -> float:
        """Return the number of elements of a beam; nan where the scene or the program gives the number."""
        return nan if options.elements is None else float(options.elements)

    def resolutions(self, *, quick: bool) -> tuple[Options, ...]:
        """Return the program's numbers of elements; the first two if quick."""
        counts = self.command.elements[: 2 if quick else None]
        return tuple(Options(elements=count) for count in counts) or (Options(),)


@lru_cache(maxsize=256)
def _refusal(command: Command, scene: Scene) -> str | None:
    """Return why a program refuses a scene; a program that fails without load parameters does not refuse it."""
    from comparisons.models.outside.answer import refusal
    from comparisons.models.outside.request import request
    from comparisons.models.outside.status import ProgramError

    try:
        output, _ = run(command.command, command.folder, request(scene, Options(), ()), command.limits)
    except ProgramError:
        return None
    return refusal(output)

"""A program of others as a model: it gets the resolved scene as JSON text and returns a response as JSON text."""

from __future__ import annotations

import hashlib
import json
import sys
from abc import ABC, abstractmethod
from contextlib import redirect_stdout
from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from comparisons.models.base import Model, Style
from comparisons.models.options import ModelError, Options
from comparisons.models.outside.child import ProgramError, ProgramStatus, found, run
from comparisons.scene.keys import PROGRAMS

if TYPE_CHECKING:
    from comparisons.models.outside.adapters.exchange import Refusal, States
    from comparisons.models.progress import Watch
    from comparisons.response import Response
    from comparisons.scene import Scene


@dataclass(frozen=True, kw_only=True)
class Source(ABC):
    """What reads the text of a resolved scene and writes the text of a response."""

    name: str
    """Name of the model."""
    label: str = ""
    """Name in figures and texts; the name of the model if empty."""
    elements: tuple[int, ...] = ()
    """Numbers of elements along a beam that comparisons of cost run; empty if the program chooses its resolution itself."""
    colour: str = "#AA3377"
    """Colour of its lines, in hexadecimal digits."""
    continuum: bool = False
    """Whether it computes a two-dimensional body."""

    @abstractmethod
    def digest(self) -> str:
        """Return a digest of what its answers depend on."""

    def missing(self) -> str | None:
        """Return what must be installed; None if it can be found."""
        return None

    @abstractmethod
    def refused(self, text: str) -> str | None:
        """Return why a scene without load parameters is refused, None if it is not; a program that fails does not refuse it."""

    @abstractmethod
    def ask(self, text: str) -> tuple[bytes, float]:
        """Return the answer to a scene and the wall time [s]; raise `ProgramError` if there is none."""


@dataclass(frozen=True, kw_only=True)
class Command(Source):
    """A command in a child process: the resolved scene goes to its standard input, a response comes from its standard output."""

    command: tuple[str, ...]
    """The program and its arguments. A program with a separator in its path is relative to `folder`."""
    folder: Path
    """Working directory of the program."""
    seconds: float = 600.0
    """Limit on the wall time [s]."""
    memory: float = 4000.0
    """Limit on the resident memory of the program and all its child processes [MB], on Linux."""
    environment: tuple[str, ...] = ()
    """Variables of the environment that it gets beside the usual ones."""
    requires: str = ""
    """Python module or program without which `command` cannot run, by default its program."""
    needs: str = ""
    """How to install what it requires."""
    module: str = ""
    """Python module whose function ``refusal(scene)`` says what the command refuses; without one, the command itself is asked."""

    def digest(self) -> str:
        """Return a digest of the command and of the files among its words."""
        files = [_digest(self.folder / word) for word in self.command]
        return hashlib.sha256(json.dumps([self.command, files]).encode()).hexdigest()

    def missing(self) -> str | None:
        """Return what must be installed to run the command; None if it can be found."""
        program = self.requires or self.command[0]
        there = found(program, self.folder) or (self.requires and find_spec(program))
        return None if there else self.needs or f"there is no program {program}"

    def refused(self, text: str) -> str | None:
        """Return what the module or the command says."""
        from comparisons.models.outside.answer import refusal

        if self.module:
            reason: str | None = import_module(self.module).refusal(json.loads(text))
            return reason
        try:
            return refusal(self.ask(text)[0])
        except ProgramError:
            return None

    def ask(self, text: str) -> tuple[bytes, float]:
        """Run the command."""
        return run(self.command, self.folder, text, self.seconds, self.memory, self.environment)


@dataclass(frozen=True, kw_only=True)
class Functions(Source):
    """Functions in this process, as `comparisons.models.outside.adapters.exchange.serve` takes them."""

    refusal: Refusal  # ``refusal(scene)``: why the program cannot state the scene, None if it can
    # ``states(scene, histories)``: adds the states to `histories` and yields the load parameter of each
    states: States

    def digest(self) -> str:
        """Return a digest of the file that defines the states."""
        return _digest(Path(self.states.__code__.co_filename))

    def refused(self, text: str) -> str | None:
        """Return what the function says."""
        return self.refusal(json.loads(text))

    def ask(self, text: str) -> tuple[bytes, float]:
        """Call the functions. If one raises, the status of the response names the exception. What they print goes to standard error."""
        from comparisons.models.outside.adapters.exchange import answered

        began = perf_counter()
        try:
            with redirect_stdout(sys.stderr):
                data = answered(json.loads(text), self.refusal, self.states)
            output = json.dumps(data).encode()
        except Exception as error:
            raise ProgramError(ProgramStatus.CRASHED, f"{type(error).__name__}: {error}") from error
        return output, perf_counter() - began


def _digest(file: Path) -> str:
    """Return a digest of a file, empty if there is none."""
    return hashlib.sha256(file.read_bytes()).hexdigest() if file.is_file() else ""


class Program(Model):
    """A program of others.

    ``source``: how it is asked: a `Command`, which runs in a child process, or `Functions`, which run in this
    one.
    """

    keys = PROGRAMS

    def __init__(self, source: Source) -> None:
        self.source = source
        self.name, self.label = source.name, source.label or source.name
        self.continuum = source.continuum
        self.options = ("elements",) if source.elements else ()
        self.missing = source.missing

    @property
    def identity(self) -> str:
        """Name of the program, and a digest of what its answers depend on."""
        return f"{self.name} {self.source.digest()}"

    def refusal(self, scene: Scene) -> str | None:
        """Return why the program cannot state the scene, or what is missing to run it."""
        return self.unstated(scene) or _refusal(self.source, scene) or self.missing()

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:
        """Return the response to `scene`, not yet checked. Its status names what failed if there is none."""
        from comparisons.models.outside.answer import answer, silent
        from comparisons.models.outside.request import request

        del watch
        missing = self.missing()
        if missing is not None:
            raise ModelError(missing)
        try:
            output, seconds = self.source.ask(request(scene, options, scene.times))
            return answer(output, scene, self.name, seconds)
        except ProgramError as error:
            success = error.reported_success
            return silent(scene, self.name, error.status.name, str(error), reported_success=success)

    def styles(self) -> dict[str, Style]:
        """Return one style."""
        return {self.label: Style(colour=self.source.colour, marker="D")}

    def setting(self, scene: Scene, options: Options) -> str:
        """Return the numbers of elements; empty if the program chooses its resolution itself."""
        counts = {options.elements or beam.divisions for beam in scene.beams} if self.options else set()
        return "+".join(map(str, sorted(counts)))

    def resolutions(self, *, quick: bool) -> tuple[Options, ...]:
        """Return the program's numbers of elements; the first two if quick."""
        counts = self.source.elements[: 2 if quick else None]
        return tuple(Options(elements=count) for count in counts) or (Options(),)


@lru_cache(maxsize=256)
def _refusal(source: Source, scene: Scene) -> str | None:
    """Return why a program refuses a scene."""
    from comparisons.models.outside.request import request

    return source.refused(request(scene, Options(), ()))

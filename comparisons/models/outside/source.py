"""How a program of others is asked: its command in a child process, or its functions in this process."""

from __future__ import annotations

import hashlib
import json
import sys
from abc import ABC, abstractmethod
from contextlib import redirect_stdout
from dataclasses import dataclass, field
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from comparisons.models.outside.child import Limits, found, run
from comparisons.models.outside.status import ProgramError, ProgramStatus

if TYPE_CHECKING:
    from comparisons.models.outside.adapters.exchange import Refusal, States

COLOUR = "#AA3377"
"""Default colour of a program's lines."""


@dataclass(frozen=True, kw_only=True)
class Source(ABC):
    """What reads the text of a resolved scene and writes the text of a response.

    Parameters
    ----------
    name : str
        Name of the model.
    label : str
        Name in figures and texts; the name of the model if empty.
    elements : tuple of int
        Numbers of elements along a beam that comparisons of cost run; empty if the program chooses its resolution itself.
    colour : str
        Colour of its lines, in hexadecimal digits.
    continuum : bool
        Whether it computes a two-dimensional body.
    """

    name: str
    label: str = ""
    elements: tuple[int, ...] = ()
    colour: str = COLOUR
    continuum: bool = False

    @abstractmethod
    def digest(self) -> str:
        """Return a digest of what its answers depend on."""

    @abstractmethod
    def missing(self) -> str | None:
        """Return what must be installed; None if it can be found."""

    @abstractmethod
    def refused(self, text: str) -> str | None:
        """Return why a scene without load parameters is refused, None if it is not; a program that fails does not refuse it."""

    @abstractmethod
    def ask(self, text: str) -> tuple[bytes, float]:
        """Return the answer to a scene and the wall time [s].

        Raises
        ------
        ProgramError
            If there is no answer.
        """


@dataclass(frozen=True, kw_only=True)
class Command(Source):
    """A command in a child process: the resolved scene goes to its standard input, a response comes from its standard output.

    Parameters
    ----------
    command : tuple of str
        The program and its arguments. A program with a separator in its path is relative to `folder`.
    folder : Path
        Working directory of the program.
    limits : Limits
        Limits on time and memory.
    requires : str
        Python module or program without which `command` cannot run; by default the program of `command`.
    needs : str
        Sentence on how to install what is required.
    module : str
        Python module whose function ``refusal(scene)`` says what the command refuses; without one, the command itself is asked.
    """

    command: tuple[str, ...]
    folder: Path
    limits: Limits = field(default_factory=Limits)
    requires: str = ""
    needs: str = ""
    module: str = ""

    def digest(self) -> str:
        """Return a digest of the command and of the files among its words."""
        words = [self.folder / word for word in self.command]
        files = [hashlib.sha256(path.read_bytes()).hexdigest() for path in words if path.is_file()]
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
        return run(self.command, self.folder, text, self.limits)


@dataclass(frozen=True, kw_only=True)
class Functions(Source):
    """Functions in this process, as `comparisons.models.outside.adapters.exchange.serve` takes them.

    Parameters
    ----------
    refusal : callable
        ``refusal(scene)``: why the program cannot state the scene, None if it can.
    states : callable
        ``states(scene, histories)``: adds the states to `histories` and yields the load parameter of each.
    """

    refusal: Refusal
    states: States

    def digest(self) -> str:
        """Return a digest of the file that defines the states."""
        file = Path(self.states.__code__.co_filename)
        return hashlib.sha256(file.read_bytes() if file.is_file() else b"").hexdigest()

    def missing(self) -> str | None:
        """Return None: a package that offers functions is installed."""
        return None

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

"""A program as a child process with limits on time, memory and output."""

import os
import shutil
import signal
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

from comparisons.files import printable
from comparisons.models.outside.status import ProgramError, ProgramStatus

LARGEST_OUTPUT = 200_000_000
"""Largest size of what a program writes [byte]."""
TAIL = 300
"""Characters of a program's messages that are shown."""
FIRST_LOOK, LAST_LOOK = 0.002, 0.1
"""Shortest and longest time between two looks at a running program [s]."""


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Limits of a program with all its child processes.

    Parameters
    ----------
    seconds : float
        Wall time [s].
    memory : float
        Resident memory [byte].
    """

    seconds: float = 600.0
    memory: float = 4e9


def found(program: str, folder: Path) -> str | None:
    """Return the path of a program: a name on the path, or a path relative to `folder`; None if there is none."""
    own = folder / program
    return shutil.which(program if own.name == program else str(own))


def run(command: Sequence[str], folder: Path, text: str, limits: Limits) -> tuple[bytes, float]:
    """Run a command in `folder` with `text` as its standard input; return its standard output and the wall time [s].

    The program and all its child processes have ended on return.

    Raises
    ------
    ProgramError
        If the program does not start, exceeds a limit or fails.
    """
    program = found(command[0], folder)
    if program is None:
        raise ProgramError(ProgramStatus.NOT_STARTED, f"there is no program {command[0]}")
    with tempfile.TemporaryDirectory(prefix="crossval-") as place:
        given, out, err = (Path(place) / name for name in ("stdin", "stdout", "stderr"))
        given.write_text(text, encoding="utf-8")
        began = perf_counter()
        with given.open("rb") as stdin, out.open("wb") as stdout, err.open("wb") as stderr:
            code = _finished(
                [program, *command[1:]],
                {"cwd": folder, "stdin": stdin, "stdout": stdout, "stderr": stderr},
                (out, err),
                limits,
            )
        seconds = perf_counter() - began
        if code:
            words = _tail(err) or _tail(out) or "no message"
            raise ProgramError(ProgramStatus.CRASHED, f"{_ending(code)}: {words}")
        return out.read_bytes(), seconds


def _finished(command: list[str], streams: dict[str, Any], written: tuple[Path, ...], limits: Limits) -> int:
    """Return the exit status of a command that keeps its limits."""
    import psutil

    try:
        process = psutil.Popen(command, **streams)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise ProgramError(ProgramStatus.NOT_STARTED, f"{command[0]}: {reason}") from None
    began, look, family = perf_counter(), FIRST_LOOK, {process}
    try:
        while True:
            try:
                return int(process.wait(timeout=look))
            except psutil.TimeoutExpired:
                look = min(2.0 * look, LAST_LOOK)
            if perf_counter() - began > limits.seconds:
                raise ProgramError(ProgramStatus.TIMED_OUT, f"ran longer than {limits.seconds:g} s")
            family.update(_descendants(process))
            if sum(map(_memory, family)) > limits.memory:
                raise ProgramError(
                    ProgramStatus.OUT_OF_MEMORY, f"took more than {limits.memory / 1e6:g} MB of memory"
                )
            if sum(path.stat().st_size for path in written) > LARGEST_OUTPUT:
                raise ProgramError(
                    ProgramStatus.TOO_MUCH_OUTPUT, f"wrote more than {LARGEST_OUTPUT / 1e6:g} MB"
                )
    finally:
        _end(process, family)


def _descendants(process: Any) -> list[Any]:
    """Return the child processes of a process, and their child processes."""
    import psutil

    try:
        return list(process.children(recursive=True))
    except psutil.Error:
        return []


def _memory(process: Any) -> int:
    """Return the resident memory of a process [byte], zero if it has ended."""
    import psutil

    try:
        return int(process.memory_info().rss)
    except psutil.Error:
        return 0


def _end(process: Any, family: set[Any]) -> None:
    """End a process and its child processes, and wait for their end."""
    import psutil

    family = family | set(_descendants(process))
    for member in family:
        try:
            member.kill()
        except psutil.Error:
            continue
    psutil.wait_procs(family, timeout=10.0)


def _ending(code: int) -> str:
    if code > 0 or os.name == "nt":
        return f"ended with exit status {code}"
    return f"was ended by {signal.Signals(-code).name}"


def _tail(path: Path) -> str:
    """Return the last words of a file in one line."""
    with path.open("rb") as file:
        file.seek(max(path.stat().st_size - 4 * TAIL, 0))
        words = " ".join(file.read().decode("utf-8", errors="replace").split())
    return printable(words[-TAIL:])

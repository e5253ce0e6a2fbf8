"""A program as a child process with a short environment and limits on time, memory and output, of which no process is left."""

import os
import shutil
import signal
import sys
from collections.abc import Container, Iterable, Sequence
from contextlib import ExitStack, suppress
from enum import Enum
from os import getpid, kill, waitpid
from pathlib import Path
from tempfile import TemporaryFile
from time import perf_counter, sleep
from typing import IO, Any

from comparisons.files import one_line, printable

MB, LARGEST_OUTPUT = 1e6, 200.0
"""A megabyte [byte], and the largest size of what a program writes [MB]."""
TAIL = 300
"""Characters of a program's messages that are shown."""
FIRST_LOOK, LAST_LOOK = 0.002, 0.1
"""Shortest and longest time between two looks at a running program [s]."""
ENVIRONMENT = (
    "PATH", "HOME", "LANG", "LC_ALL", "TZ", "TMPDIR", "LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "PYTHONPATH", "VIRTUAL_ENV",
    "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "SYSTEMROOT", "PATHEXT", "TEMP", "TMP", "USERPROFILE",
)  # fmt: skip
"""Variables of the environment that every program gets; the last five are those of Windows."""
LINUX = sys.platform == "linux"
ADOPT = 36
"""PR_SET_CHILD_SUBREAPER: a process becomes the parent of its descendants whose own parents have ended."""
ROUNDS = 5000
"""How often the processes that a program leaves behind are looked for and ended."""
KILL = 9


class ProgramStatus(Enum):
    """How the run of another program failed; the value is the meaning."""

    NOT_STARTED = "the program cannot be started"
    CRASHED = "the program ended with an exit status other than 0, or by a signal"
    TIMED_OUT = "the program ran longer than its limit and was ended"
    OUT_OF_MEMORY = "the program took more memory than its limit and was ended"
    TOO_MUCH_OUTPUT = "the program wrote more than 200 MB and was ended"
    INVALID_JSON = "the output is not JSON, or it is cut off"
    INVALID_RESPONSE = "the output is JSON, but no response to the scene: a key, a name or a shape is wrong"
    NOT_FINITE = "a number of the response is missing or not finite"


class ProgramError(Exception):
    """The run of another program gave no answer: what failed, and whether the program stated success all the same."""

    def __init__(self, status: ProgramStatus, message: str, *, reported_success: bool = False) -> None:
        super().__init__(one_line(message))
        self.status, self.reported_success = status, reported_success


def found(program: str, folder: Path) -> str | None:
    """Return the path of a program: a name on the path, or a path relative to `folder`; None if there is none."""
    own = folder / program
    return shutil.which(program if own.name == program else str(own))


def run(
    command: Sequence[str],
    folder: Path,
    text: str,
    seconds: float,
    memory: float,
    more: Iterable[str] = (),
    **set_to: str,
) -> bytes:
    """Run a command in `folder` with `text` as its standard input; return its standard output.

    Its limits are wall time [s] and, on Linux, resident memory [MB] with all its child processes, which have ended on return. It gets
    `more` variables of the environment, and those that are `set_to` a value. `ProgramError` names what failed.
    """
    program = found(command[0], folder)
    if program is None:
        raise ProgramError(ProgramStatus.NOT_STARTED, f"there is no program {command[0]}")
    env = {name: os.environ[name] for name in (*ENVIRONMENT, *more) if name in os.environ} | set_to
    with TemporaryFile() as given, TemporaryFile() as out, TemporaryFile() as err:
        given.write(text.encode())
        given.seek(0)
        how = {"cwd": folder, "env": env, "stdin": given, "stdout": out, "stderr": err}
        code = _finished([program, *command[1:]], how, seconds, memory)
        if code:
            ended = f"ended with exit status {code}"
            if code < 0 and os.name != "nt":
                ended = f"was ended by {signal.Signals(-code).name}"
            words = _tail(err) or _tail(out) or "no message"
            raise ProgramError(ProgramStatus.CRASHED, f"{ended}: {words}")
        out.seek(0)
        return out.read()


def _finished(command: list[str], how: dict[str, Any], seconds: float, memory: float) -> int:
    """Return the exit status of a command that keeps its limits."""
    import subprocess

    others, written = set(_family()), (how["stdout"], how["stderr"])
    with ExitStack() as after:
        _adopt(1)
        after.callback(_adopt, 0)
        try:
            process = subprocess.Popen(command, start_new_session=True, **how)  # noqa: S603 the program that the user names
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise ProgramError(ProgramStatus.NOT_STARTED, f"{command[0]}: {reason}") from None
        after.callback(_end, process, others)
        began, look = perf_counter(), FIRST_LOOK
        while True:
            with suppress(subprocess.TimeoutExpired):
                return int(process.wait(timeout=look))
            look = min(2.0 * look, LAST_LOOK)
            taken = sum(_family(others).values()) / MB
            size = sum(os.fstat(file.fileno()).st_size for file in written) / MB
            for status, used, most, words in (
                (ProgramStatus.TIMED_OUT, perf_counter() - began, seconds, "ran longer than {:g} s"),
                (ProgramStatus.OUT_OF_MEMORY, taken, memory, "took more than {:g} MB of memory"),
                (ProgramStatus.TOO_MUCH_OUTPUT, size, LARGEST_OUTPUT, "wrote more than {:g} MB"),
            ):
                if used > most:
                    raise ProgramError(status, words.format(most))


def _adopt(adopts: int) -> None:
    """Make this process the parent of descendants that lose theirs, where the system can (Linux); 0 ends it."""
    if LINUX:
        import ctypes  # 2 ms that only a program needs

        ctypes.CDLL(None).prctl(ADOPT, adopts, 0, 0, 0)


def _family(others: Container[int] = ()) -> dict[int, int]:
    """Return the resident memory [byte], by process, of programs and what they start; none without ``/proc``.

    A program is a child in another session than this process, and none of `others`.
    """
    every = {}
    for file in Path("/proc").glob("[0-9]*/stat") if LINUX else ():
        with suppress(OSError):
            parent, _, session, *values = file.read_text(errors="replace").rpartition(") ")[2].split()[1:]
            every[int(file.parent.name)] = int(parent), int(session), int(values[17])
    found = {
        pid
        for pid, (parent, session, _) in every.items()
        if parent == getpid() and session != every[parent][1] and pid not in others
    }
    while more := {pid for pid, (parent, *_) in every.items() if parent in found} - found:
        found |= more
    return {pid: every[pid][2] * os.sysconf("SC_PAGE_SIZE") for pid in found}


def _end(process: Any, others: Container[int]) -> None:
    """End whatever a program has started, and wait for its end; an ended process leaves its children to this one."""
    if LINUX:
        process.kill()
        for _ in range(ROUNDS):
            process.poll()
            family = _family(others)
            for pid in family:
                with suppress(ProcessLookupError, PermissionError):
                    kill(pid, KILL)
                if pid != process.pid:
                    with suppress(ChildProcessError):
                        waitpid(pid, os.WNOHANG)
            if not family and not _family(others):  # not while a parent ended during the look
                return
            sleep(FIRST_LOOK)
    elif os.name == "nt":
        import subprocess

        subprocess.run(["taskkill", "/T", "/F", "/PID", str(process.pid)], capture_output=True, check=False)  # noqa: S603, S607
    else:
        with suppress(ProcessLookupError, PermissionError):
            getattr(os, "killpg", kill)(process.pid, KILL)
    process.wait()


def _tail(file: IO[bytes]) -> str:
    """Return the last words of a file in one line."""
    file.seek(max(file.seek(0, os.SEEK_END) - 4 * TAIL, 0))
    words = " ".join(file.read().decode("utf-8", errors="replace").split())
    return printable(words[-TAIL:])

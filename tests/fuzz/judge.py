"""Runs one scene file through the command and says whether it ended as the documentation promises."""

import faulthandler
import io
import os
import re
import signal
import tempfile
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from time import process_time

from comparisons.cli import main

LIMIT = 60.0
"""Processor seconds from which a run hangs, ten times that by the clock; the slowest takes some 5 on a quiet machine, and up to six times
as long on a busy one."""
OWN_STDERR = os.dup(2)
"""Where the stack of a process goes that is deaf to the limit."""
NAMED = re.compile(r"crossval: ([A-Z_]+): .+\n")
"""The one line of a solution that stopped."""
REFUSED = re.compile(r"(crossval: .+\n)+")
"""The lines of an input that is refused, one for every mistake."""


class Hang(BaseException):
    """A run took longer than allowed; nothing catches it on the way."""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """How a run ended, ``done``, ``refused``, ``stopped NAME`` or otherwise, what is wrong with that, and processor seconds."""

    kind: str
    wrong: str | None
    seconds: float


def judged(arguments: list[str], limit: float = LIMIT) -> Outcome:
    """Run ``crossval`` with `arguments` in this process; warnings are errors."""
    out, err = io.StringIO(), io.StringIO()
    began = process_time()
    status: int | None = None
    raised = ""
    with tempfile.TemporaryFile() as direct:
        try:
            with (
                time_limit(limit),
                redirect_stdout(out),
                redirect_stderr(err),
                _descriptor(2, direct.fileno()),
                warnings.catch_warnings(),
            ):
                warnings.simplefilter("error")
                status = main(arguments)
        except Hang:
            raised = f"hangs for {limit:g} s"
        except BaseException:  # noqa: BLE001 - whatever it is, a user would see it as a traceback
            raised = traceback.format_exc()
        direct.seek(0)
        printed = err.getvalue() + direct.read().decode(errors="replace")
    kind, wrong = ("raised", raised) if raised else _verdict(status, out.getvalue(), printed)
    return Outcome(kind=kind, wrong=wrong, seconds=process_time() - began)


def _verdict(status: int | None, out: str, err: str) -> tuple[str, str | None]:
    named = NAMED.fullmatch(err)
    if status == 0 and not err:
        return "done", None
    if status == 2 and not out and REFUSED.fullmatch(err):
        return "refused", None
    if status == 3 and named:
        return f"stopped {named[1]}", None
    return f"status {status}", f"status {status}, stdout {out!r}, stderr {err!r}"


@contextmanager
def time_limit(limit: float) -> Iterator[None]:
    """Raise `Hang` in the block after `limit` processor seconds; end the process, with its stack, if it is deaf to that."""

    def ring(*_: object) -> None:
        raise Hang

    before = signal.signal(signal.SIGPROF, ring)
    signal.setitimer(signal.ITIMER_PROF, limit)
    faulthandler.dump_traceback_later(10 * limit, exit=True, file=OWN_STDERR)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        faulthandler.cancel_dump_traceback_later()
        signal.signal(signal.SIGPROF, before)


@contextmanager
def _descriptor(number: int, other: int) -> Iterator[None]:
    """Let file descriptor `number` be `other` in the block: libraries in C print there."""
    kept = os.dup(number)
    os.dup2(other, number)
    try:
        yield
    finally:
        os.dup2(kept, number)
        os.close(kept)


def solved(file: Path, model: str, *options: str, limit: float = LIMIT) -> tuple[Outcome, Path]:
    """Solve the scene `file` and return the outcome and the JSON file, which is there unless the scene was refused."""
    result = file.with_suffix(".json")
    result.unlink(missing_ok=True)
    return judged(["solve", str(file), "--model", model, *options, "--json", str(result)], limit), result

"""Run scene files through the command, and say whether each ended as the documentation promises."""

import faulthandler
import io
import os
import re
import signal
import tempfile
import traceback
import warnings
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass, field
from pathlib import Path

import tsm
from comparisons.cli import main

LIMIT = 180.0
"""Processor seconds from which a run hangs, ten times that by the clock; the slowest takes 14 on a quiet machine, and up to six times
as long on a busy one."""
OWN_STDERR = os.dup(2)
"""Where the stack of a process goes that is deaf to the limit."""
NAMED = re.compile(r"crossval: ([A-Z_]+): .+\n")
"""The one line of a solution that stopped."""
REFUSED = re.compile(r"(crossval: .+\n)+")
"""The lines of an input that is refused, one for every mistake."""
MODELS = ("rod", "elastica", "solid", "solid", *(f"tsm --element {name}" for name in tsm.ELEMENTS))


class Hang(BaseException):
    """A run took longer than allowed; nothing catches it on the way."""


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


def judged(arguments: list[str]) -> tuple[str, str | None]:
    """How ``crossval`` with `arguments` ends, ``done``, ``refused``, ``stopped NAME`` or otherwise, and what is wrong with that; warnings are errors."""
    out, err, status = io.StringIO(), io.StringIO(), None
    with tempfile.TemporaryFile() as direct:
        try:
            with time_limit(LIMIT), redirect_stdout(out), redirect_stderr(err), _descriptor(2, direct.fileno()), warnings.catch_warnings():  # fmt: skip
                warnings.simplefilter("error")
                status = main(arguments)
        except Hang:
            return "raised", f"hangs for {LIMIT:g} s"
        except BaseException:  # noqa: BLE001 - whatever it is, a user would see it as a traceback
            return "raised", traceback.format_exc()
        direct.seek(0)
        printed = err.getvalue() + direct.read().decode(errors="replace")
    if status == 0 and not printed:
        return "done", None
    if status == 2 and not out.getvalue() and REFUSED.fullmatch(printed):
        return "refused", None
    if status == 3 and (named := NAMED.fullmatch(printed)):
        return f"stopped {named[1]}", None
    return f"status {status}", f"status {status}, stdout {out.getvalue()!r}, stderr {printed!r}"


@dataclass(frozen=True, kw_only=True)
class Tally:
    """How some files ended: number by model and outcome, and what is wrong with which file."""

    kinds: Counter[tuple[str, str]] = field(default_factory=Counter)
    wrong: list[tuple[str, str, bytes]] = field(default_factory=list)


def tally(number: int, first: int) -> Tally:
    """Solve `number` different fuzzed files, each with one model, drawn from the seed `first`."""
    from hypothesis import HealthCheck, Phase, assume, given, seed, settings
    from hypothesis import strategies as st

    from tests.fuzz.broken import files, is_small

    found, seen = Tally(), set[tuple[str, bytes]]()

    @settings(max_examples=number, database=None, deadline=None, phases=[Phase.generate], suppress_health_check=list(HealthCheck))  # fmt: skip
    @seed(first)
    @given(files, st.sampled_from(MODELS))
    def run(data: bytes, model: str) -> None:
        assume(is_small(data) and (model, data) not in seen)
        seen.add((model, data))
        file.write_bytes(data)
        kind, wrong = judged(
            ["solve", str(file), "--model", *model.split(), "--out", str(file.with_suffix(".json"))]
        )
        file.with_suffix(".json").unlink(missing_ok=True)
        found.kinds[model.partition(" ")[0], kind] += 1
        if wrong is not None:
            found.wrong.append((model, wrong, data))

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.toml"
        run()
    return found

"""Progress of a sweep: a progress line on a terminal, lines at milestones elsewhere."""

import math
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

from comparisons.cases.run import Progress, Tally
from comparisons.models.progress import REDRAW, bar

MILESTONES = 10


def shown(stream: TextIO | None = None, *, quiet: bool = False) -> Progress:
    """Return what shows progress on `stream`, standard error if not given; nothing if `quiet`."""
    stream = stream or sys.stderr
    if quiet:
        return _nothing
    return _bar(stream) if stream.isatty() else _milestones(stream)


@contextmanager
def line_ended(stream: TextIO | None = None) -> Iterator[None]:
    """End the progress line when an exception interrupts it, so that the message starts on a new line."""
    stream = stream or sys.stderr
    try:
        yield
    except BaseException:
        if stream.isatty():
            stream.write("\n")
        raise


def line(tally: Tally) -> str:
    """Return ``12 of 40 cases done, 1 failed, 2:05 left``."""
    left = f", {clock(tally.left)} left" if math.isfinite(tally.left) and tally.done < tally.total else ""
    return f"{tally.done} of {tally.total} cases done, {tally.failed} failed{left}"


def clock(seconds: float) -> str:
    """Return a time as ``2:05`` or ``1:02:05``."""
    minutes, rest = divmod(math.ceil(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"


def _nothing(_: Tally) -> None:
    """Show nothing."""


def _bar(stream: TextIO) -> Progress:
    drawn = -math.inf

    def show(tally: Tally) -> None:
        nonlocal drawn
        last = tally.done == tally.total
        if not last and tally.seconds - drawn < REDRAW:
            return
        drawn = tally.seconds
        end = "\n" if last else ""
        stream.write(f"\r{bar(tally.done / max(tally.total, 1))} {line(tally)}\x1b[K{end}")
        stream.flush()

    return show


def _milestones(stream: TextIO) -> Progress:
    written = -1

    def show(tally: Tally) -> None:
        nonlocal written
        reached = MILESTONES * tally.done // max(tally.total, 1)
        if reached != written:
            written = reached
            stream.write(line(tally) + "\n")
            stream.flush()

    return show

"""Progress of a sweep for a person: a bar on a terminal, lines at milestones elsewhere."""

import math
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

from comparisons.sweep.run import Progress, Tally

WIDTH = 30
REDRAW = 0.1
"""Seconds between two pictures of the bar."""
MILESTONES = 10


def shown(stream: TextIO | None = None, *, quiet: bool = False) -> Progress:
    """Return what shows progress on `stream`, standard error if not given."""
    stream = stream or sys.stderr
    return _bar(stream) if stream.isatty() and not quiet else _milestones(stream)


@contextmanager
def line_ended(stream: TextIO | None = None) -> Iterator[None]:
    """End the line of a bar that an exception cuts short, for the message that follows."""
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


def _bar(stream: TextIO) -> Progress:
    drawn = -math.inf

    def show(tally: Tally) -> None:
        nonlocal drawn
        last = tally.done == tally.total
        if not last and tally.seconds - drawn < REDRAW:
            return
        drawn = tally.seconds
        filled = WIDTH * tally.done // max(tally.total, 1)
        end = "\n" if last else ""
        stream.write(f"\r[{'#' * filled}{'.' * (WIDTH - filled)}] {line(tally)}\x1b[K{end}")
        stream.flush()

    return show


def _milestones(stream: TextIO) -> Progress:
    told = -1

    def show(tally: Tally) -> None:
        nonlocal told
        reached = MILESTONES * tally.done // max(tally.total, 1)
        if reached != told:
            told = reached
            stream.write(line(tally) + "\n")
            stream.flush()

    return show

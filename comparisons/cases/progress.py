"""Progress of a sweep on standard error: a progress line on a terminal, lines at milestones elsewhere."""

import math
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

from comparisons.cases.case import Case
from comparisons.cases.run import Progress, Results, Tally, run
from comparisons.cases.workers import Workers
from comparisons.models.progress import REDRAW, bar

MILESTONES = 10
Runner = Callable[[Iterable[Case]], Results]
"""Measures cases."""


@contextmanager
def running(folder: Path, workers: Workers, *, quiet: bool = False, **how: Any) -> Iterator[Runner]:
    """Give what runs cases on some workers, keeps their results in a folder, and shows its progress; `how` is that of `measure`."""
    with shown(quiet=quiet) as progress:
        yield partial(run, folder=folder, workers=workers, progress=progress, **how)


@contextmanager
def shown(*, quiet: bool = False) -> Iterator[Progress]:
    """Give what shows progress, nothing if `quiet`; an exception ends the line, so that its message starts on a new one."""
    stream, terminal = sys.stderr, sys.stderr.isatty()
    last = -math.inf

    def show(tally: Tally) -> None:
        nonlocal last
        now = tally.seconds if terminal else MILESTONES * tally.done // tally.total
        if now == last or (terminal and tally.done < tally.total and now - last < REDRAW):
            return
        last = now
        end = "\n" if tally.done == tally.total else ""
        drawn = f"\r{bar(tally.done / tally.total)} {line(tally)}\x1b[K{end}"
        stream.write(drawn if terminal else line(tally) + "\n")
        stream.flush()

    try:
        yield (lambda _: None) if quiet else show
    except BaseException:
        if terminal:
            stream.write("\n")
        raise


def line(tally: Tally) -> str:
    """Return ``12 of 40 cases done, 1 failed, 1:02:05 left``."""
    text = f"{tally.done} of {tally.total} cases done, {tally.failed} failed"
    if math.isnan(tally.left) or tally.done == tally.total:
        return text
    minutes, seconds = divmod(math.ceil(tally.left), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{text}, {f'{hours}:{minutes:02}' if hours else minutes}:{seconds:02} left"

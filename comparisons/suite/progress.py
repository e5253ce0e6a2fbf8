"""Progress of a sweep on standard error: a progress line on a terminal, lines at milestones elsewhere."""

import sys
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from math import ceil, inf
from pathlib import Path
from time import monotonic
from typing import Any

from comparisons.models.model import REDRAW, bar
from comparisons.suite.case import Case
from comparisons.suite.measure import Row
from comparisons.suite.run import Results, run
from comparisons.suite.workers import Workers

MILESTONES = 10
Runner = Callable[[Iterable[Case]], Results]
"""Measures cases."""


@contextmanager
def running(folder: Path, workers: Workers, *, quiet: bool, **how: Any) -> Iterator[Runner]:
    """Give what runs cases on some workers, keeps their results in a folder, and shows its progress; `how` is that of `measure`.

    An exception ends the line of progress, so that its message starts on a new one.
    """
    stream, terminal = sys.stderr, sys.stderr.isatty()
    began, first, last = monotonic(), 0, -inf

    def show(total: int, rows: Collection[Row]) -> None:
        nonlocal first, last
        done = len(rows)
        seconds, first = monotonic() - began, first if last > -inf else done
        now = seconds if terminal else MILESTONES * done // total
        if quiet or now == last or (terminal and done < total and now - last < REDRAW):
            return
        failed, last = sum(not row.response.completed for row in rows), now
        text = f"{done} of {total} cases done, {failed} failed"
        if first < done < total:
            minutes, left = divmod(ceil(seconds / (done - first) * (total - done)), 60)
            hours, minutes = divmod(minutes, 60)
            text += f", {f'{hours}:{minutes:02}' if hours else minutes}:{left:02} left"
        end = "\n" if done == total else ""
        stream.write(f"\r{bar(done / total)} {text}\x1b[K{end}" if terminal else f"{text}\n")
        stream.flush()

    try:
        yield partial(run, folder=folder, workers=workers, progress=show, **how)
    except BaseException:
        if terminal:
            stream.write("\n")
        raise

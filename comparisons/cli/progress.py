"""Lines and bars: what is being done, and how far it is."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from shutil import get_terminal_size
from time import monotonic
from typing import TextIO

from comparisons.models.progress import REDRAW, Count, Reached, Watch, bar, uncounted, unwatched

PATIENCE = 2.0
"""Seconds that a work takes without a bar."""


@contextmanager
def watching(label: str, *, quiet: bool = False, stream: TextIO | None = None) -> Iterator[Watch]:
    """Yield a `Watch` that draws a progress line for one solution, and clear the line afterwards; without a terminal nothing is drawn.

    The line shows the load parameter, the Newton iterations so far and the elements in contact.
    """
    stream = stream or sys.stderr
    if quiet or not stream.isatty():
        yield unwatched
        return
    drawn, iterations = 0.0, 0

    def show(reached: Reached) -> None:
        nonlocal drawn, iterations
        iterations += reached.iterations
        if monotonic() - drawn < REDRAW:
            return
        drawn = monotonic()
        t = reached.load_parameter
        parts = [f"t = {t:.4f}", f"{iterations} iterations", *reached.contacts]
        line = f"{label} {bar(t)} {', '.join(parts)}"
        stream.write(f"\r{line[: get_terminal_size().columns - 1]}\x1b[K")
        stream.flush()

    try:
        yield show
    finally:
        stream.write("\r\x1b[K")
        stream.flush()


@contextmanager
def staging(label: str, *, quiet: bool = False, stream: TextIO | None = None) -> Iterator[Count]:
    """Write the line of a stage of the work, and yield a `Count`, which draws a bar below on a terminal; the bar is cleared afterwards.

    The bar appears after `PATIENCE` seconds.
    """
    stream = stream or sys.stderr
    if quiet:
        yield uncounted
        return
    stream.write(f"{label}\n")
    stream.flush()
    began = drawn = monotonic()

    def show(done: int, parts: int) -> None:
        nonlocal drawn
        now = monotonic()
        if now - began < PATIENCE or now - drawn < REDRAW:
            return
        drawn = now
        stream.write(f"\r{bar(done / parts)} {done} of {parts}\x1b[K")
        stream.flush()

    if not stream.isatty():
        yield uncounted
        return
    try:
        yield show
    finally:
        stream.write("\r\x1b[K")
        stream.flush()

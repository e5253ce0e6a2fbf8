"""Lines and bars: what is being done, and how far it is."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from shutil import get_terminal_size
from time import monotonic
from typing import TextIO

from comparisons.models.progress import REDRAW, Count, Reached, Watch, bar

PATIENCE = 2.0
"""Seconds that a work takes without a bar."""


@contextmanager
def _line(*, quiet: bool, stream: TextIO) -> Iterator[Callable[[str], None]]:
    """Yield what draws a line on a terminal in place of the line before; the line is cleared afterwards. Elsewhere nothing is drawn."""
    drawn, shown = 0.0, not quiet and stream.isatty()

    def draw(text: str) -> None:
        nonlocal drawn
        if shown and monotonic() - drawn >= REDRAW:
            drawn = monotonic()
            stream.write(f"\r{text[: get_terminal_size().columns - 1]}\x1b[K")
            stream.flush()

    try:
        yield draw
    finally:
        if shown:
            stream.write("\r\x1b[K")
            stream.flush()


@contextmanager
def watching(label: str, *, quiet: bool = False, stream: TextIO | None = None) -> Iterator[Watch]:
    """Yield a `Watch` whose line shows the load parameter of one solution, the Newton iterations so far and the elements in contact."""
    iterations = 0

    def show(reached: Reached) -> None:
        nonlocal iterations
        iterations += reached.iterations
        t = reached.load_parameter
        draw(f"{label} {bar(t)} {', '.join((f't = {t:.4f}', f'{iterations} iterations', *reached.contacts))}")

    with _line(quiet=quiet, stream=stream or sys.stderr) as draw:
        yield show


@contextmanager
def staging(label: str, *, quiet: bool = False, stream: TextIO | None = None) -> Iterator[Count]:
    """Write the line of a stage of the work, and yield a `Count`, which draws a bar below after `PATIENCE` seconds."""
    stream = stream or sys.stderr
    if not quiet:
        print(label, file=stream, flush=True)
    began = monotonic()

    def show(done: int, parts: int) -> None:
        if monotonic() - began >= PATIENCE:
            draw(f"{bar(done / parts)} {done} of {parts}")

    with _line(quiet=quiet, stream=stream) as draw:
        yield show

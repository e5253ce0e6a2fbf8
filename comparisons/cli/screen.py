"""What a command says: bars on standard error, files, and the solutions that stopped."""

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from shutil import get_terminal_size
from time import monotonic
from typing import TYPE_CHECKING

from comparisons.answer import Response
from comparisons.cli.command import DONE, STOPPED, WRONG, report, told
from comparisons.models.model import REDRAW, Count, Reached, Watch, bar
from comparisons.scene import Scene

if TYPE_CHECKING:
    from pathlib import Path

    from comparisons.suites.found import Found

PATIENCE = 2.0
"""Seconds that a work takes without a bar."""


def teller(*, quiet: bool) -> Callable[[str], None]:
    """Return what reports a line of progress."""
    return (lambda _: None) if quiet else report


def ended(files: Iterable[object], reasons: Iterable[str] = (), status: int = STOPPED) -> int:
    """Name the files, and what is wrong; return the exit status."""
    print("files:", *(f"  {path}" for path in files), sep="\n")
    return max((told(reason, status) for reason in reasons), default=DONE)


def shown(found: "Found", folder: "Path") -> int:
    """Write what a suite found to a folder, print it, in bold what a terminal may have so, and return the exit status."""
    files = found.write(folder)
    brief = found.brief.text(bold=sys.stdout.isatty() and not os.environ.get("NO_COLOR"))
    print(*filter(None, (brief, found.text)), sep="\n\n", end="\n\n")
    for line in found.remarks:
        told(line, DONE)
    return ended(files, found.wrong or found.stopped, WRONG if found.wrong else STOPPED)


def exit_status(scene: Scene, responses: Iterable[tuple[str, Response]]) -> int:
    """Name every solution that stopped, by its label, and what was reached; return the exit status."""
    stopped = (f"{label}{response.stop(scene)}" for label, response in responses if not response.completed)
    return max((told(reason, STOPPED) for reason in stopped), default=DONE)


@contextmanager
def _line(*, quiet: bool) -> Iterator[Callable[[str], None]]:
    """Yield what draws a line on a terminal in place of the line before; the line is cleared afterwards. Elsewhere nothing is drawn."""
    drawn, shown = 0.0, not quiet and sys.stderr.isatty()

    def draw(text: str) -> None:
        nonlocal drawn
        if shown and monotonic() - drawn >= REDRAW:
            drawn = monotonic()
            print(f"\r{text[: get_terminal_size().columns - 1]}\x1b[K", end="", file=sys.stderr, flush=True)

    try:
        yield draw
    finally:
        if shown:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)


@contextmanager
def watching(label: str, *, quiet: bool = False) -> Iterator[Watch]:
    """Yield a `Watch` whose line shows the load parameter of one solution, the Newton iterations so far and the elements in contact."""
    iterations = 0

    def show(reached: Reached) -> None:
        nonlocal iterations
        iterations += reached.iterations
        t = reached.load_parameter
        draw(f"{label} {bar(t)} {', '.join((f't = {t:.4f}', f'{iterations} iterations', *reached.contacts))}")

    with _line(quiet=quiet) as draw:
        yield show


@contextmanager
def staging(label: str, *, quiet: bool = False) -> Iterator[Count]:
    """Write the line of a stage of the work, and yield a `Count`, which draws a bar below after `PATIENCE` seconds."""
    began = monotonic()
    if not quiet:
        report(label)

    def show(done: int, parts: int) -> None:
        if monotonic() - began >= PATIENCE:
            draw(f"{bar(done / parts)} {done} of {parts}")

    with _line(quiet=quiet) as draw:
        yield show

"""Run the cases of a sweep on an executor. One JSON file a case, named by its key, holds its result."""

from collections.abc import Callable, Collection, Iterable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, wait
from itertools import islice
from pathlib import Path
from typing import Any

from comparisons.files import OutputError, interrupts_held, staging, writable_folder
from comparisons.suite.case import Case
from comparisons.suite.measure import Row, measure, unmeasured
from comparisons.suite.workers import Workers, WorkersError

WORKER_LOST = "WORKER_LOST"
"""The status of a case whose worker died, and died again when the case was tried alone."""
ERROR = "ERROR"
"""The status of a case that raised an exception, which no model should."""
UNSETTLED = (WORKER_LOST, ERROR)
"""Statuses that come from the machine or from a bug and not from the case; the next run repeats the case."""
Results = dict[Case, Row]
"""The row of every case."""


def run(
    cases: Iterable[Case],
    folder: Path,
    workers: Workers,
    *,
    progress: Callable[[int, Collection[Row]], None] = lambda *_: None,
    **how: Any,
) -> Results:
    """Measure all `cases` that have no result in `folder`, in their order; return the results of all, equal cases once.

    A result is kept as soon as it is there, and a run may be ended at any point. A case whose worker dies is tried once more,
    alone. If its worker dies again, the case is recorded as ``WORKER_LOST``. A case that raises is recorded as ``ERROR``.
    `how` are arguments of `measure`. `progress` takes the number of cases and the rows that are there, at the start and after each case.

    Raises OutputError if a result cannot be written, or read. Raises WorkersError if the cluster is gone.
    """
    writable_folder(folder)
    every = {case.key: case for case in cases}
    done = {key: row for key, case in every.items() if (row := recorded(case, folder / f"{key}.json"))}
    suspects: list[str] = []
    under_way: dict[Future[Row], str] = {}

    def keep(key: str, row: Row) -> None:
        file = folder / f"{key}.json"
        # under a temporary name, and not in the folder's list of files
        with staging(folder, file) as aside:
            (aside / file.name).write_text(row.to_json(), encoding="utf-8")
            (aside / file.name).replace(file)
        done[key] = row
        progress(len(every), done.values())

    while True:
        # every case that was under way when a worker died is suspect, and is tried alone
        alone = [key for key in suspects if key not in done]
        waiting = iter(alone or [key for key in every if key not in done])
        try:
            with workers() as (executor, width):
                progress(len(every), done.values())
                while True:
                    for key in islice(waiting, (1 if alone else width) - len(under_way)):
                        with interrupts_held():
                            under_way[executor.submit(solve, key, every[key], **how)] = key
                    if not under_way:
                        break
                    for future in wait(under_way, return_when=FIRST_COMPLETED).done:
                        keep(under_way[future], outcome(future, every[under_way[future]]))
                        del under_way[future]
        except BrokenExecutor:
            suspects = suspects if alone else list(under_way.values())
            lost = "its worker died twice, the second time with this case alone: memory ran out, or a library crashed"
            for key in under_way.values() if alone else ():
                keep(key, unmeasured(every[key], WORKER_LOST, lost))
            under_way.clear()
        if len(done) == len(every):
            return {case: done[key] for key, case in every.items()}


def recorded(case: Case, file: Path) -> Row | None:
    """Return the settled result in a file, None without one; `OutputError` if it cannot be read."""
    try:
        found = Row.from_json(case, file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except OSError as error:
        raise OutputError(f"{file}: cannot be read: {error.strerror or error}") from None
    except (ValueError, LookupError, TypeError, AttributeError):
        raise OutputError(f"{file}: is damaged: delete it, and the case is solved again") from None
    return None if found.response.status in UNSETTLED else found


def solve(key: str, case: Case, **how: Any) -> Row:
    """Measure `case` in a worker; raise if the worker has another version or other mesh files than the key."""
    if case.key != key:
        raise RuntimeError("the worker has another version of this package, or of a mesh file")
    return measure(case, **how)


def outcome(future: Future[Row], case: Case) -> Row:
    """Return what a future holds, exceptions of its case as a row."""
    try:
        return future.result()
    except BrokenExecutor:
        raise
    except CancelledError:
        raise WorkersError("cluster", "is gone; what has been finished is kept") from None
    except Exception as error:  # noqa: BLE001 - one case must not stop the others, and it is listed
        return unmeasured(case, ERROR, " ".join(f"{type(error).__name__}: {error}".split()))

"""Run the cases of a sweep on an executor. One JSON file a case, named by its key, holds its result."""

import math
import os
from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from itertools import islice
from pathlib import Path
from time import monotonic
from typing import Any, NamedTuple

from comparisons.cases.case import Case
from comparisons.cases.measure import Measurement, measure, unmeasured
from comparisons.cases.workers import Workers, WorkersError
from comparisons.files import OutputError, interrupts_held, writable_folder

BEAT = 5.0
"""Seconds between two reports of the progress while no case ends."""
COMPLETED = "COMPLETED"
"""The status of a completed and checked solution."""
WORKER_LOST = "WORKER_LOST"
"""The status of a case whose worker died, and died again when the case was tried alone."""
ERROR = "ERROR"
"""The status of a case that raised an exception, which no model should."""
UNSETTLED = (WORKER_LOST, ERROR)
"""Statuses that come from the machine or from a bug and not from the case; the next run repeats the case."""
Results = dict[Case, Measurement]
"""The measurement of every case."""


class Tally(NamedTuple):
    """How far a sweep has come; `failed` results have no completed and checked solution, and `left` is nan before the first [s]."""

    total: int
    done: int
    failed: int
    seconds: float
    left: float


Progress = Callable[[Tally], None]
"""Called after each finished case, and every few seconds."""


def run(
    cases: Iterable[Case],
    folder: Path,
    workers: Workers,
    *,
    repeats: int = 3,
    process: bool = False,
    progress: Progress = lambda _: None,
) -> Results:
    """Measure all `cases` that have no result in `folder`, in their order; return the results of all, equal cases once.

    A result is kept as soon as it is there, and a run may be ended at any point. A case whose worker dies is tried once more,
    alone. If its worker dies again, the case is recorded as ``WORKER_LOST``. A case that raises is recorded as ``ERROR``.
    `repeats` and `process` are those of `measure`.

    Raises OutputError if a result cannot be written, or read. Raises WorkersError if the cluster is gone.
    """
    writable_folder(folder)
    sweep = _Sweep({case.key: case for case in cases}, folder, progress)
    while len(sweep.done) < len(sweep.cases):
        try:
            with workers.start() as executor:
                sweep.work(executor, workers, repeats=repeats, process=process)
        except BrokenExecutor as error:
            sweep.suspect(str(error))
    return {case: sweep.done[key] for key, case in sweep.cases.items()}


class _Sweep:
    """The state of a run: what is done, waits, is under way, and what may have ended its worker."""

    def __init__(self, cases: dict[str, Case], folder: Path, progress: Progress) -> None:
        self.cases, self.folder, self.progress = cases, folder, progress
        kept = ((key, recorded(folder / f"{key}.json")) for key in cases)
        self.done = {key: found for key, found in kept if found is not None}
        self.waiting = deque(key for key in cases if key not in self.done)
        self.suspects = deque[str]()
        self.under_way: dict[Future[Measurement], str] = {}
        self.failed = sum(found.response.status != COMPLETED for found in self.done.values())
        self.began, self.before = monotonic(), len(self.done)
        self.report()

    def work(self, executor: Executor, workers: Workers, **how: Any) -> None:
        """Keep the workers busy until all is done; while there are suspects, with one of them at a time."""
        while len(self.done) < len(self.cases):
            free = not self.under_way if self.suspects else workers.width - len(self.under_way)
            for key in list(islice(self.suspects or self.waiting, free)):
                with interrupts_held():
                    self.under_way[executor.submit(solve, key, self.cases[key], **how)] = key
                if not self.suspects:
                    self.waiting.popleft()
            finished, _ = wait(self.under_way, timeout=BEAT, return_when=FIRST_COMPLETED)
            for future in finished:
                self.finish(self.under_way[future], outcome(future, workers.lost))
                del self.under_way[future]
            if not finished:
                self.report()

    def suspect(self, cause: str) -> None:
        """Note that a worker died: every case under way is suspect, and one that was alone is to blame."""
        keys = list(self.under_way.values())
        self.under_way.clear()
        if not self.suspects:
            self.suspects.extend(keys)
        elif keys:
            self.finish(keys[0], unmeasured(WORKER_LOST, f"{cause}, twice, the second time alone"))

    def finish(self, key: str, found: Measurement) -> None:
        """Keep a result; it is written under a temporary name, which is then renamed."""
        file = self.folder / f"{key}.json"
        temporary = file.with_name(f".{key}.{os.getpid()}")
        try:
            temporary.write_text(found.to_json(**self.cases[key].description), encoding="utf-8")
            temporary.replace(file)
        except OSError as error:
            raise OutputError(f"{file}: cannot be written: {error.strerror or error}") from None
        finally:
            temporary.unlink(missing_ok=True)
        self.done[key] = found
        self.failed += found.response.status != COMPLETED
        if self.suspects:
            self.suspects.popleft()
        self.report()

    def report(self) -> None:
        """Tell the progress."""
        total, done, seconds = len(self.cases), len(self.done), monotonic() - self.began
        pace = seconds / (done - self.before) if done > self.before else math.nan
        left = pace * (total - done) if done < total else 0.0
        self.progress(Tally(total, done, self.failed, seconds, left))


def recorded(file: Path) -> Measurement | None:
    """Return the settled result that `file` holds; None if there is none.

    A file that cannot be read, or holds something else, is an `OutputError`.
    """
    try:
        found = Measurement.from_json(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except OSError as error:
        raise OutputError(f"{file}: cannot be read: {error.strerror or error}") from None
    except (ValueError, LookupError, TypeError, AttributeError):
        raise OutputError(f"{file}: is damaged: delete it, and the case is solved again") from None
    return None if found.response.status in UNSETTLED else found


def solve(key: str, case: Case, *, repeats: int, process: bool) -> Measurement:
    """Measure `case` in a worker; raise if the worker has another version or other mesh files than the key."""
    if case.key != key:
        raise RuntimeError("the worker has another version of this package, or of a mesh file")
    return measure(case, repeats=repeats, process=process)


def outcome(future: Future[Measurement], lost: tuple[type[BaseException], ...]) -> Measurement:
    """Return what a future holds, exceptions of its case as measurements."""
    try:
        return future.result()
    except BrokenExecutor:
        raise
    except CancelledError:
        raise WorkersError("cluster", "is gone; what has been finished is kept") from None
    except lost as error:
        return unmeasured(WORKER_LOST, " ".join(str(error).split()))
    except Exception as error:  # noqa: BLE001 - one case must not stop the others, and it is listed
        return unmeasured(ERROR, " ".join(f"{type(error).__name__}: {error}".split()))

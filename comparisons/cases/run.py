"""Run the cases of a sweep: claim, compute, record, until all are done."""

from collections import Counter, deque
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from dataclasses import dataclass
from functools import partial
from time import monotonic, sleep

from comparisons.cases.case import Case
from comparisons.cases.measure import Measurement, measure, unmeasured
from comparisons.cases.store import ERROR, UNSETTLED, WORKER_LOST, Store
from comparisons.cases.workers import Workers, WorkersError
from comparisons.files import interrupts_held

BEAT = 5.0
"""Seconds between signs of life, far below the lease."""
POLL = 0.2
"""Seconds between looks at what other runs are working on."""
COMPLETED = "COMPLETED"
"""The status of a completed and checked solution."""


@dataclass(frozen=True, kw_only=True)
class Tally:
    """How far a sweep has come.

    Attributes
    ----------
    total, done, failed : int
        Numbers of all cases, of recorded cases, and of recorded cases without a completed and checked solution.
    statuses : dict of int
        Recorded cases by status.
    seconds, left : float
        Time since the run began, and estimated time to its end, nan before the first case is done [s].
    older : dict of int
        Numbers of cases with a result of another version, by version. They count as recorded only with `keep`.
    """

    total: int
    done: int
    failed: int
    statuses: dict[str, int]
    seconds: float
    left: float
    older: dict[str, int]


Progress = Callable[[Tally], None]
"""Called after each finished case, and every few seconds."""


def run(
    cases: Iterable[Case],
    store: Store,
    workers: Workers,
    *,
    repeats: int = 3,
    progress: Progress = lambda _: None,
    keep: bool = False,
    process: bool = False,
) -> Tally:
    """Measure all `cases` without a result of this version in `store`; return when all are recorded.

    Several runs may share one store; each case is then measured by one of them. A case whose worker dies is tried once more, alone.
    If its worker dies again, the case is recorded as ``WORKER_LOST``. A case that raises is recorded as ``ERROR``. A later run repeats
    cases with these two statuses; every other status is a result.

    Parameters
    ----------
    cases : iterable of Case
        Cases in the order of work; equal cases are measured once.
    store : Store
        Where results are.
    workers : Workers
        Where cases run.
    repeats : int
        Runs timed for each case.
    progress : callable
        Receives the progress.
    keep : bool
        Whether results of other versions are accepted.
    process : bool
        Whether a whole process is timed too, see `measure`.

    Raises
    ------
    OutputError
        If the store cannot be written.
    WorkersError
        If the cluster is gone.
    """
    measuring = partial(solve, repeats=repeats, process=process)
    sweep = _Sweep({case.key: case for case in cases}, store, measuring, progress, keep=keep)
    while sweep.unfinished:
        with workers.start() as executor:
            sweep.work(executor, workers)
    return sweep.tally()


class _Sweep:
    """The state of one run."""

    def __init__(
        self,
        cases: dict[str, Case],
        store: Store,
        measuring: Callable[[str, Case], Measurement],
        progress: Progress,
        *,
        keep: bool,
    ) -> None:
        recorded, older = store.statuses(), store.older(cases)
        older = {key: found for key, found in older.items() if recorded.get(key, ERROR) in UNSETTLED}
        self.older = dict(sorted(Counter(version for version, _ in older.values()).items()))
        if keep:
            recorded |= {key: status for key, (_, status) in older.items()}
        self.cases, self.store, self.measuring, self.progress = cases, store, measuring, progress
        self.again = frozenset(key for key in cases if recorded.get(key) in UNSETTLED)
        self.statuses = {key: recorded[key] for key in cases if key in recorded and key not in self.again}
        self.counts = Counter(self.statuses.values())
        self.open = deque(key for key in cases if key not in self.statuses)
        self.suspects: deque[str] = deque()
        self.flying: dict[str, Future[Measurement] | None] = {}
        self.began, self.before, self.heard = monotonic(), len(self.statuses), monotonic()

    @property
    def unfinished(self) -> bool:
        return len(self.statuses) < len(self.cases)

    def work(self, executor: Executor, workers: Workers) -> None:
        """Go on until all is done or the executor breaks."""
        self.progress(self.tally())
        while self.unfinished:
            try:
                self.submit(executor, workers.width)
                self.collect(workers.lost)
            except BrokenExecutor:
                self.suspect()
                return

    def submit(self, executor: Executor, width: int) -> None:
        """Fill the executor; while there are suspects, with one of them at a time."""
        if self.suspects:
            keys = [] if self.flying else [self.suspects[0]]
        else:
            keys = self.claim(width - len(self.flying))
        # what cannot be started any more is under way like the rest when the executor turns out to be broken
        self.flying.update(dict.fromkeys(keys))
        for key in keys:
            with interrupts_held():
                self.flying[key] = executor.submit(self.measuring, key, self.cases[key])

    def claim(self, limit: int) -> list[str]:
        if limit == 0 or not self.open:
            return []
        claim = self.store.claim(self.open, limit=limit, again=self.again)
        for key in (*claim.claimed, *claim.done, *claim.taken):
            self.open.remove(key)
        self.open.extend(claim.taken)
        for key, status in claim.done.items():
            self.note(key, status)
        return claim.claimed

    def collect(self, lost: tuple[type[BaseException], ...]) -> None:
        """Record what has finished, and say that this run is alive."""
        under_way = {future: key for key, future in self.flying.items() if future is not None}
        if not under_way:
            sleep(POLL)
        finished, _ = wait(under_way, timeout=POLL if self.open else BEAT, return_when=FIRST_COMPLETED)
        if monotonic() - self.heard > BEAT:
            self.heard = monotonic()
            self.store.say_alive()
            self.progress(self.tally())
        for future in finished:
            self.record(under_way[future], outcome(future, lost))

    def record(self, key: str, measurement: Measurement) -> None:
        self.store.record(key, self.cases[key], measurement)
        self.flying.pop(key, None)
        if self.suspects and self.suspects[0] == key:
            self.suspects.popleft()
        self.note(key, measurement.response.status)

    def note(self, key: str, status: str) -> None:
        self.statuses[key] = status
        self.counts[status] += 1
        self.progress(self.tally())

    def suspect(self) -> None:
        """Handle a broken executor: a single running case caused it; of several running cases, each is suspect and later runs alone."""
        keys = list(self.flying)
        self.flying.clear()
        if not self.suspects:
            self.suspects.extend(keys)
        elif keys:
            message = "the worker process died, and again when it had nothing else to do"
            self.record(keys[0], unmeasured(WORKER_LOST, message))

    def tally(self) -> Tally:
        seconds, pace = monotonic() - self.began, len(self.statuses) - self.before
        left = len(self.cases) - len(self.statuses)
        return Tally(
            total=len(self.cases),
            done=len(self.statuses),
            failed=len(self.statuses) - self.counts[COMPLETED],
            statuses=dict(sorted(self.counts.items())),
            seconds=seconds,
            left=seconds / pace * left if pace else float("nan") if left else 0.0,
            older=self.older,
        )


def solve(key: str, case: Case, *, repeats: int, process: bool) -> Measurement:
    """Measure `case` in a worker; raise if the worker has another version or other mesh files than the key."""
    if case.key != key:
        raise RuntimeError("the worker has another version of this package, or of a mesh file")
    return measure(case, repeats=repeats, process=process)


def outcome(future: Future[Measurement], lost: tuple[type[BaseException], ...]) -> Measurement:
    """Return what a future holds, exceptions as measurements.

    Raises
    ------
    BrokenExecutor
        If the executor broke.
    WorkersError
        If it was cancelled from outside.
    """
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

"""What may happen to a worker, in place of `comparisons.cases.run.solve`; and a writer among several."""

import os
import signal
from pathlib import Path
from typing import Any

from comparisons.cases.case import Case
from comparisons.cases.measure import Measurement, unmeasured
from comparisons.cases.run import solve
from comparisons.cases.store import Store
from comparisons.scene import load_scene

FATAL = 3
"""Elements of the case that meets its fate."""


def killed(key: str, case: Case, **how: Any) -> Measurement:
    if case.options.elements == FATAL:
        os.kill(os.getpid(), signal.SIGKILL)
    return solve(key, case, **how)


def killed_once(key: str, case: Case, **how: Any) -> Measurement:
    marker = Path(os.environ["CROSSVAL_TEST_MARKER"])
    if case.options.elements == FATAL and not marker.exists():
        marker.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return solve(key, case, **how)


def raising(key: str, case: Case, **how: Any) -> Measurement:
    if case.options.elements == FATAL:
        raise ZeroDivisionError("a bug\nin two lines")
    return solve(key, case, **how)


def write_many(path: str, keys: int) -> list[str]:
    """Claim and record cases, three at a time, until none is left; return those that this writer recorded."""
    case = Case(scene=load_scene("ks-cantilever"), model="rod")
    nothing = unmeasured("COMPLETED", "")
    own: list[str] = []
    with Store(Path(path)) as store:
        while True:
            claim = store.claim([f"{n:05}" for n in range(keys)], limit=3)
            for key in claim.claimed:
                store.record(key, case, nothing)
            own += claim.claimed
            if not claim.claimed and not claim.taken:
                return own

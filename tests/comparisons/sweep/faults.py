"""What may happen to a worker, in place of `comparisons.sweep.run.solve`."""

import os
import signal
from pathlib import Path

from comparisons.sweep.case import Case
from comparisons.sweep.measure import Measurement
from comparisons.sweep.run import solve

FATAL = 3
"""Elements of the case that meets its fate."""


def killed(key: str, case: Case, repeats: int) -> Measurement:
    if case.options.elements == FATAL:
        os.kill(os.getpid(), signal.SIGKILL)
    return solve(key, case, repeats)


def killed_once(key: str, case: Case, repeats: int) -> Measurement:
    marker = Path(os.environ["CROSSVAL_TEST_MARKER"])
    if case.options.elements == FATAL and not marker.exists():
        marker.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return solve(key, case, repeats)


def raising(key: str, case: Case, repeats: int) -> Measurement:
    if case.options.elements == FATAL:
        raise ZeroDivisionError("a bug\nin two lines")
    return solve(key, case, repeats)

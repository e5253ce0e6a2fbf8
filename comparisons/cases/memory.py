"""Peak memory of one action within a process that lives on."""

import ctypes
import gc
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")
STATUS, CLEAR = Path("/proc/self/status"), Path("/proc/self/clear_refs")
RESET_PEAK = "5"


def with_peak_memory(action: Callable[[], T]) -> tuple[T, int]:
    """Return what `action` returns, and by how many bytes the resident memory rose above its start at most.

    Freed memory is given back to the system before the start, where the C library can do that. On Linux the process's own
    peak is reset and read again; elsewhere it cannot be reset, and a rise below an earlier peak is counted as zero, as every rise on
    Windows.
    """
    gc.collect()
    if sys.platform == "linux" and hasattr(ctypes.CDLL(None), "malloc_trim"):
        ctypes.CDLL(None).malloc_trim(0)
    try:
        CLEAR.write_text(RESET_PEAK)
        start = _kibibytes("VmRSS")
    except (OSError, KeyError):
        start = -1
    if start < 0:
        before = _largest_so_far()
        return action(), _largest_so_far() - before
    result = action()
    return result, 1024 * max(_kibibytes("VmHWM") - start, 0)


def _kibibytes(field: str) -> int:
    """Read a field of the process's status."""
    values = dict(line.split(":", 1) for line in STATUS.read_text().splitlines())
    return int(values[field].split()[0])


def _largest_so_far() -> int:
    """Largest resident memory of the process so far, in bytes; zero where Python does not tell it."""
    try:
        import resource
    except ImportError:  # Windows
        return 0
    largest = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return largest if sys.platform == "darwin" else 1024 * largest

"""Solution of many structures of one topology at once; every array operation runs over all structures.

The structure is the last axis of every array in this package, so that an operation is one pass over contiguous numbers.
"""

from tsm.batch.result import BatchResult
from tsm.batch.solve import solve_batch

__all__ = ["BatchResult", "solve_batch"]


def __dir__() -> list[str]:
    return sorted(__all__)

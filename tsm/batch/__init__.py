"""Many structures of one topology at once: every array operation runs over all of them.

Axes: the structure comes last in every array here, so that each operation is one pass over contiguous numbers.
"""

from tsm.batch.result import BatchResult
from tsm.batch.solve import solve_batch

__all__ = ["BatchResult", "solve_batch"]

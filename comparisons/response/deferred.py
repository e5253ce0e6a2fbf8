"""Tables that are computed when they are first asked for."""

from collections.abc import Callable, Iterator, Mapping
from functools import cache

from comparisons.response.record import Array


class Deferred(Mapping[str, Array]):
    """A table that not every use of a response needs, and that takes long.

    Parameters
    ----------
    compute : callable
        Returns the table; it is called once.

    Examples
    --------
    >>> table = Deferred(lambda: print("computed") or {"strip": 1.0})
    >>> [len(table), *table.items()]
    computed
    [1, ('strip', 1.0)]
    """

    def __init__(self, compute: Callable[[], Mapping[str, Array]]) -> None:
        self._table = cache(compute)

    def __getitem__(self, name: str) -> Array:
        return self._table()[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._table())

    def __len__(self) -> int:
        return len(self._table())

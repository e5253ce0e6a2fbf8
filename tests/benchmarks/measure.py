"""A ratio with its target, and times taken in turn."""

from __future__ import annotations

import re
import resource
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Gate:
    """A measured ratio and its bar."""

    name: str
    value: float
    bar: float
    at_least: bool

    @property
    def met(self) -> bool:
        return bool(self.value >= self.bar if self.at_least else self.value <= self.bar)

    @property
    def mark(self) -> str:
        """Name of the number in the pages."""
        return "bench." + slug(self.name).strip("-")

    def __str__(self) -> str:
        relation = ">=" if self.at_least else "<="
        return f"{'met    ' if self.met else 'NOT MET'}  {self.name}: {self.value:.3g} (bar {relation} {self.bar:g})"


def slug(name: str) -> str:
    """Return a name in small letters with dashes."""
    return re.sub(r"[^a-z0-9.]+", "-", name.lower())


def seconds(
    *actions: Callable[[], Any],
    repeats: int = 7,
    of: Callable[[list[float]], float] = statistics.median,
    clock: Callable[[], float] = time.perf_counter,
) -> list[float]:
    """Median or other seconds of each action, taken in turn so that a slow moment of the machine meets all of them."""
    for action in actions:
        action()
    taken: list[list[float]] = [[] for _ in actions]
    for _ in range(repeats):
        for row, action in zip(taken, actions, strict=True):
            begin = clock()
            action()
            row.append(clock() - begin)
    return [of(row) for row in taken]


def children() -> float:
    """Processor time of the processes that this one has started and seen end."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime

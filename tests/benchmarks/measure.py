"""A ratio with its target, and times taken in turn."""

from __future__ import annotations

import re
import resource
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Gate:
    """A measured ratio and its bar."""

    name: str
    value: float
    bar: float
    at_least: bool = False

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


@dataclass
class Bench:
    """What is measured: ratios, and the seconds behind them."""

    gates: list[Gate] = field(default_factory=list)
    times: dict[str, float] = field(default_factory=dict)

    def add(self, gate: Gate) -> None:
        self.gates.append(gate)

    def seconds(self, repeats: int = 7, of: Callable[[list[float]], float] = statistics.median,
                clock: Callable[[], float] = time.perf_counter, **actions: Callable[[], Any]) -> list[float]:  # fmt: skip
        """Median or other seconds of each action, taken in turn so that a slow moment of the machine meets all of them."""
        for action in actions.values():
            action()
        taken: dict[str, list[float]] = {name: [] for name in actions}
        for _ in range(repeats):
            for name, action in actions.items():
                begin = clock()
                action()
                taken[name].append(clock() - begin)
        self.times |= {name: of(row) for name, row in taken.items()}
        return [self.times[name] for name in actions]


def slug(name: str) -> str:
    """Return a name in small letters with dashes."""
    return re.sub(r"[^a-z0-9.]+", "-", name.lower())


def children() -> float:
    """Processor time of the processes that this one has started and seen end."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime

"""What a comparison costs besides its solutions."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from statistics import median
from typing import Any
from unittest.mock import patch

from comparisons import budget, compare
from comparisons.scene import load_scene
from tests.benchmarks.measure import Gate


def comparison(gates: list[Gate], times: dict[str, float]) -> None:
    """Seconds of `compare` over those that its models, certificates and the solutions of the budget take in it."""
    scene, solving = load_scene("ks-cantilever"), 0.0

    def timed(function: Callable[..., Any]) -> Callable[..., Any]:
        def run(*arguments: Any) -> Any:
            nonlocal solving
            began = time.perf_counter()
            try:
                return function(*arguments)
            finally:
                solving += time.perf_counter() - began

        return run

    def taken() -> tuple[float, float]:
        nonlocal solving
        solving, began = 0.0, time.perf_counter()
        with tempfile.TemporaryDirectory() as folder:
            compare.compare(scene, Path(folder), lambda _: None)
        return time.perf_counter() - began, solving

    with ExitStack() as patches:
        for module, name in ((compare, "solve"), (compare, "certified"), (budget, "solve")):
            patches.enter_context(patch.object(module, name, timed(getattr(module, name))))
        runs = [taken() for _ in range(4)][1:]
    times["compare ks-cantilever"] = median(whole for whole, _ in runs)
    ratio = median(whole / part for whole, part in runs)
    gates.append(Gate("compare ks-cantilever over its solutions", ratio, 2.0, False))

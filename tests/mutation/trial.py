"""Trials: the tests of a module, run in a copy of the project in which the module is changed."""

from __future__ import annotations

import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

ROOT = Path(__file__).parents[2]
_COPIED = ("tsm", "fem_reference", "comparisons", "tests", "docs", "pyproject.toml", "README.md")
_MEMORY = 4 << 30
"""Bytes that a trial may take: a mutant can make a loop that only collects."""
_STARTING = 10.0
"""Seconds that a trial has beside its tests."""
_SLOWER = 4.0
"""What a test may take longer than in the unchanged project: others use the machine."""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What the tests say of a mutant.

    Attributes
    ----------
    killed : bool
        Whether a test fails, or does not end in time.
    by : str
        The test that fails, `timeout`, or the last line of pytest where no test is named; empty for a survivor.
    seconds : float
        What it took.
    """

    killed: bool
    by: str
    seconds: float


@contextmanager
def project_copy() -> Iterator[Path]:
    """Yield a folder with a compiled copy of the project; it is removed afterwards."""
    with tempfile.TemporaryDirectory(prefix="mutation-") as folder:
        for name in _COPIED:
            source, copy = ROOT / name, Path(folder, name)
            if source.is_dir():
                shutil.copytree(source, copy, ignore=shutil.ignore_patterns("__pycache__", "_generated"))
            else:
                shutil.copy(source, copy)
        yield Path(folder)


def run(folder: Path, files: list[str], *, seconds: float = 600.0) -> Outcome:
    """Run the fast tests in a copy of the project up to the first that fails.

    Raises
    ------
    RuntimeError
        If there is no test to run.
    """
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    environment = {**os.environ, **threads, "PYTHONPATH": str(folder)}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:xdist", "--no-header", "--tb=no"]
    command += ["-m", "not slow", *files]
    start = time.monotonic()
    try:
        ended = subprocess.run(
            command,
            cwd=folder,
            env=environment,
            capture_output=True,
            text=True,
            timeout=seconds,
            preexec_fn=_limit,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Outcome(killed=True, by="timeout", seconds=seconds)
    spent = time.monotonic() - start
    if ended.returncode in {4, 5}:
        raise RuntimeError(f"{' '.join(files)}: no test ran: {ended.stdout}{ended.stderr}")
    if ended.returncode == 0:
        return Outcome(killed=False, by="", seconds=spent)
    named = re.search(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", ended.stdout, re.MULTILINE)
    last = (ended.stdout + ended.stderr).strip().splitlines() or ["no output"]
    return Outcome(killed=True, by=named[1] if named else last[-1], seconds=spent)


def _limit() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))


def run_changed(folder: Path, module: str, source: str, files: list[str], *, seconds: float) -> Outcome:
    """Run tests in a copy of the project with another source of one module, which is put back afterwards."""
    path = folder / module
    original = path.read_bytes()
    try:
        path.write_text(source, encoding="utf-8")
        _forget(path)
        return run(folder, files, seconds=seconds)
    finally:
        path.write_bytes(original)
        _forget(path)


def _forget(path: Path) -> None:
    """Remove compiled code: it is told from its source by the second and the size."""
    for compiled in path.parent.glob(f"__pycache__/{path.stem}.*.pyc"):
        compiled.unlink()


class Trials:
    """Trials in one copy of the project, and how long its tests take unchanged."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._seconds: dict[tuple[str, ...], float] = {}

    def __call__(self, module: str, source: str, stages: list[list[str]]) -> Outcome:
        """Try a changed module on its tests, a stage of them after the other, up to the first that fails."""
        spent = 0.0
        for files in stages:
            outcome = run_changed(self.folder, module, source, files, seconds=self._allowed(files))
            spent += outcome.seconds
            if outcome.killed:
                break
        return replace(outcome, seconds=spent)

    def _allowed(self, files: list[str]) -> float:
        """Seconds for a stage, from a run of the unchanged project, which must pass."""
        key = tuple(files)
        if key not in self._seconds:
            outcome = run(self.folder, files)
            if outcome.killed:
                raise RuntimeError(f"the unchanged project fails: {outcome.by}")
            self._seconds[key] = outcome.seconds
        return _STARTING + _SLOWER * self._seconds[key]

"""Studies for the tests: small cases, and the command in a process of its own."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

COMMAND = "import sys; from comparisons.cli import main; sys.exit(main())"
STUDY = """
[study]
name = "tiny"
scene = "ks-cantilever"
repeats = 1

[[run]]
model = "tsm"
element = ["mixed", "exact", "timoshenko"]
elements = {{ from = 5, to = {last}, count = {count} }}
scene.load_parameters = 5
"""


def tiny(path: Path, count: int) -> Path:
    """Write a study of 3 `count` cases, about 10 ms each."""
    path.write_text(STUDY.format(last=count + 4, count=count))
    return path


@pytest.fixture
def start() -> Callable[..., "subprocess.Popen[str]"]:
    """Start the command as the leader of its own group of processes."""

    def begin(*arguments: object, **options: object) -> "subprocess.Popen[str]":
        return subprocess.Popen(
            [sys.executable, "-c", COMMAND, *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
            **options,  # type: ignore[call-overload]
        )

    return begin

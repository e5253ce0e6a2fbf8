"""Locks and the life of processes on the libraries of this environment."""

from pathlib import Path

from tests.platforms.processes import check


def test_a_lock_ends_with_its_process(tmp_path: Path) -> None:
    check(tmp_path)

"""The reader of scene files takes bytes or refuses them, each mistake in one line."""

from pathlib import Path

import pytest

from tests.fuzz.reader import mutants, reader


def check(number: int, seed: int, folder: Path) -> None:
    taken = sum(map(reader(folder), mutants(number, seed)))
    assert 0 < taken < number


def test_reader_on_mutated_scenes(tmp_path: Path) -> None:
    check(1000, 0, tmp_path)


@pytest.mark.slow
def test_reader_on_many_mutated_scenes(tmp_path: Path) -> None:
    check(20_000, 1, tmp_path)

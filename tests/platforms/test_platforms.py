"""The answers of this platform are those of the golden files; a lock ends with its process."""

import pytest

from tests.platforms import numbers
from tests.platforms.processes import check


@pytest.mark.slow
def test_answers_are_those_of_the_golden_files(monkeypatch, stated):
    """And a change is seen."""
    stated("platforms.bound", numbers.BOUND)
    assert list(numbers.apart()) == []
    lines = list(numbers.solved("ks-cantilever"))
    changed = [line.replace("1", "2") if "force" in line else line for line in lines]
    monkeypatch.setattr(numbers, "SCENES", ("ks-cantilever",))
    monkeypatch.setattr(numbers, "solved", lambda _: changed)
    assert len(list(numbers.apart())) > 5


def test_a_lock_ends_with_its_process(tmp_path):
    check(tmp_path)

"""The answers of this platform are those of the golden files; a lock ends with its process."""

import pytest

from tests.platforms import numbers
from tests.platforms.processes import check


@pytest.mark.slow
def test_answers_are_those_of_the_golden_files(stated):
    stated("platforms.bound", numbers.BOUND)
    assert list(numbers.apart()) == []


def test_a_lock_ends_with_its_process(tmp_path):
    check(tmp_path)

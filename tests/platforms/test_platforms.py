"""The answers of this platform are those of the golden files."""

import pytest

from tests.platforms import numbers


@pytest.mark.slow
def test_answers_are_those_of_the_golden_files(stated):
    stated("platforms.bound", numbers.BOUND)
    assert list(numbers.apart()) == []

"""The order of a file's tables does not matter."""

import pytest

from tests.laws.scenes import cases, scene, stated, within
from tests.laws.transform import apart, reordered


@pytest.mark.parametrize(("model", "name"), cases())
def test_the_order_in_the_file_does_not_matter(model: str, name: str) -> None:
    other = reordered(scene(name))
    off = apart(other, stated(scene(name), model), stated(other, model))
    assert off[0] <= within(model), off

"""The order of a file's tables does not matter."""

import pytest

from tests.laws.scenes import answer, cases, scene, stated, within
from tests.laws.transform import apart, reordered


@pytest.mark.parametrize(("model", "name"), cases())
def test_the_order_in_the_file_does_not_matter(model: str, name: str) -> None:
    other = reordered(scene(name))
    off = apart(other, stated(scene(name), model), stated(other, model))
    assert off[0] <= within(model), off


@pytest.mark.parametrize("element", ["exact", "mixed"])
def test_a_pull_that_a_slip_off_at_once_takes_away_is_no_release(element: str) -> None:
    """The contact that came first in the file was released at the start, and touched again."""
    for found in (scene("world-18"), reordered(scene("world-18"))):
        events = answer(found, element).events or ()
        assert [event.kind for event in events if event.kind != "pass-through"] == ["slip-off"]

"""An answer is the same in other units of length and force."""

import pytest

from tests.laws.scenes import cases, scene, stated, within
from tests.laws.transform import Change, apart


@pytest.mark.parametrize(("model", "name"), cases())
def test_an_answer_does_not_depend_on_the_units(model: str, name: str) -> None:
    own = scene(name)
    for change in (Change(length=1e3, force=1e-3), Change(length=1e-5, force=1e-7)):
        other = change.scene(own)
        off = apart(other, change.readings(stated(own, model)), stated(other, model))
        assert off[0] <= within(model), (change, off)

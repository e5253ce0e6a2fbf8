"""An answer is the same in other units of length and force."""

import numpy as np
import pytest

from comparisons.referee import Verdict, certify
from tests.laws.scenes import answer, cases, scene, stated, within
from tests.laws.transform import Change, apart
from tests.stated import ROOT


@pytest.mark.slow_at("mixed-friction-12")
@pytest.mark.parametrize(("model", "name"), [*cases(), ("mixed", "friction-12")])
def test_an_answer_does_not_depend_on_the_units(model: str, name: str) -> None:
    """In ``friction-12`` a contact turns a beam without bending it, and the rate of its force is round-off."""
    own = scene(name)
    for change in (Change(length=1e3, force=1e9), Change(length=1e-5, force=1e-7)):
        other = change.scene(own)
        off = apart(other, change.readings(stated(own, model)), stated(other, model))
        assert off[0] <= within(model), (change, off)


def test_the_round_off_of_a_stiff_hinge_has_a_unit() -> None:
    """Newton's method ends at it: with that of another unit it goes on for ever."""
    stiff = scene(str(ROOT / "tests" / "comparisons" / "findings" / "stopped" / "stiff-hinge.toml"))
    for own in (Change(length=length).scene(stiff) for length in (1e-4, 1e4)):
        assert certify(answer(own, "exact"), own).verdict is Verdict.CERTIFIED


@pytest.mark.slow_at("solid-special-58")
@pytest.mark.parametrize(
    ("model", "name"), [("mixed", "ks-cantilever"), ("mixed", "special-37"), ("solid", "special-58")]
)
def test_powers_of_two_as_units_change_no_iteration(model: str, name: str) -> None:
    """Every product is exact, so that a step or a fall which knows a unit is seen; sums of BLAS differ by their last bit."""
    own = scene(name)
    one, other = (answer(asked, model) for asked in (own, Change(length=2.0**10, force=2.0**-12).scene(own)))
    assert one.status == other.status
    assert len(one.newton_iterations) == len(other.newton_iterations)
    assert np.abs(one.newton_iterations - other.newton_iterations).sum() <= 2

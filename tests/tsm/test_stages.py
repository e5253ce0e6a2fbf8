"""Stages of the load: each goes on from where the last one ended, and contacts and their friction with it."""

from dataclasses import replace

import numpy as np
import pytest

import tsm
from tests.tsm.structures import cantilever, steps

SECTION = tsm.Section(EA=8.4, GA=2.7, EI=2.8e-4)
T = steps(4)
THREE = [*T, *(1 + T), *(2 + T)]


@pytest.mark.slow_at("exact-0.3")
@pytest.mark.parametrize(("element", "friction"), [("mixed", 0.0), ("exact", 0.3)])
def test_stages_of_a_pin_are_its_path_with_corners(element, friction):
    there, back = (0.7, 0.3), (0.9, -0.05)
    plain = cantilever((back, there), section=SECTION, element=element, elements=1 if element == "exact" else 6, friction=friction)  # fmt: skip
    (pin,) = plain.pins
    pins = replace(pin, onward=((back,), (there,))), replace(pin, path=(back, there, back, there))
    staged, single = (
        tsm.solve(replace(plain, pins=(pin,)), np.array(THREE) / turns) for pin, turns in zip(pins, (1, 3), strict=True)
    )  # fmt: skip
    parts, whole = (result.contacts["p0->b"] for result in (staged, single))
    assert parts.force == pytest.approx(whole.force, abs=1e-12)
    assert parts.arc_position == pytest.approx(whole.arc_position, abs=1e-9, nan_ok=True)
    own, other = (
        [e for e in result.events if e.kind is not tsm.EventKind.PASS_THROUGH] for result in (staged, single)
    )
    assert [event.kind for event in own] == [event.kind for event in other]
    assert [event.load_parameter for event in own] == pytest.approx(
        [3 * event.load_parameter for event in other], abs=1e-9
    )
    begun = [
        event.stage
        for event in own
        if event.kind is tsm.EventKind.STICK and abs(event.load_parameter - 1.0) < 1e-15
    ]
    assert begun == [2] * (friction > 0.0)
    stages = [event.stage for event in staged.events]
    assert stages == sorted(stages)
    assert set(stages) == {1, 2, 3}

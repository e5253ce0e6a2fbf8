"""Stages of the load: each goes on from where the last one ended, and contacts and their friction with it."""

from dataclasses import replace

import numpy as np
import pytest

import tsm
from tests.tsm.structures import CLAMP, cantilever, steps

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


def summed(*parts):
    return tuple(sum(values) for values in zip(*parts, strict=True))


def negative(*parts):
    return tuple(-value for value in summed(*parts))


def test_the_work_of_all_stages_is_stored_or_dissipated():
    """Of a pin with friction, a moving clamp, loads, a spring and a hinge."""
    plain = cantilever(((0.8, -0.05), (0.7, 0.25)), section=SECTION, element="exact", friction=0.2)
    structure = replace(
        plain, pins=(replace(plain.pins[0], onward=((), ((0.8, 0.1),))),),
        supports=(replace(CLAMP, onward=((0.0, 0.02, 0.1), (0.01, 0.0, -0.05))),),
        loads=(tsm.Load(beam="b", end="end", force=(0.0, -2e-4)), tsm.Load(beam="b", end="end", force=(1e-4, 3e-4), stage=1)),
        springs=(tsm.Spring(beam="b", end="end", y=3e-4),),
        hinges=(tsm.Hinge(beam="b", end="start", stiffness=2e-3),),
    )  # fmt: skip
    result = tsm.solve(structure, [1.0, 2.0, 3.0])
    dissipated = result.contacts["p0->b"].friction.dissipated
    assert dissipated[-1] > 1e-7
    assert result.work == pytest.approx(result.strain_energy + dissipated, abs=1e-9 * SECTION.EI)
    assert {tsm.EventKind.STICK, tsm.EventKind.SLIP} <= {event.kind for event in result.events}


def loaded(stages, motions, lines):
    """Loads (force, moment) at the tip, motions of the clamp, and loads along halves of the beam, by their increments of every stage."""
    (ux, uy, rotation), *onward = motions
    structure = cantilever(
        section=SECTION, supports=(replace(CLAMP, ux=ux, uy=uy, rotation=rotation, onward=tuple(onward)),)
    )
    loads = (tsm.Load(beam="b", end="end", force=f[:2], moment=f[2], stage=k) for k, f in enumerate(stages))
    line_loads = (tsm.LineLoad(beam="b", force=(f,), start=a, end=a + 0.5, stage=k) for k, a, f in lines)
    return replace(structure, loads=tuple(loads), line_loads=tuple(line_loads))


def test_loads_and_supports_go_on_and_come_back():
    up, more = (1e-4, 3e-4, 2e-4), (0.0, -2e-4, 5e-4)
    moved, further = (0.1, 0.0, 0.4), (-0.2, 0.3, -0.9)
    first, second = (0, 0.0, (0.0, -2e-4)), (1, 0.5, (1e-4, 3e-4))
    back = [(2, a, (-x, -y)) for _, a, (x, y) in (first, second)]
    staged = tsm.solve(
        loaded(
            (up, more, negative(up, more)),
            (moved, further, negative(moved, further)),
            (first, second, *back),
        ),
        THREE,
    )
    single = tsm.solve(loaded((up,), (moved,), (first,)), T)
    at_once = loaded((summed(up, more),), (summed(moved, further),), (first, (0, *second[1:])))
    whole = tsm.solve(at_once, [1.0])
    support = staged.supports["b.start"]
    assert staged.tips["b"][:4] == pytest.approx(single.tips["b"], abs=1e-13)
    assert staged.tips["b"][7] == pytest.approx(whole.tips["b"][0], abs=1e-9)
    assert support.moment[7] == pytest.approx(whole.supports["b.start"].moment[0], abs=1e-10)
    assert support.force[7] == pytest.approx(whole.supports["b.start"].force[0], abs=1e-12)
    assert staged.tips["b"][11] == pytest.approx((1.0, 0.0), abs=1e-9)
    assert support.force[11] == pytest.approx((0.0, 0.0), abs=1e-12)
    assert (staged.index == 0).all()

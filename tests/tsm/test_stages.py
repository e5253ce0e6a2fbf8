"""Stages of the load: each goes on from where the last one ended, and contacts and their friction with it."""

import numpy as np
import pytest

import tsm
from tsm.stages import Increments

SECTION = tsm.Section(EA=8.4, GA=2.7, EI=2.8e-4)
T = np.linspace(0.25, 1.0, 4)
THERE, BACK = (0.7, 0.3), (0.9, -0.05)
PAIR = "pin->c"


def cantilever(
    element: str, path: tuple[tuple[float, float], ...], friction: float = 0.0, **more: object
) -> tsm.Structure:
    onward = more.pop("onward", ())
    given = {"supports": (tsm.Support(beam="c", end="start"),), **more}
    elements = 1 if element == "exact" else 6
    return tsm.Structure(
        beams=(
            tsm.Beam(name="c", start=(0, 0), end=(1, 0), section=SECTION, elements=elements, element=element),
        ),
        pins=(tsm.Pin(name="pin", path=path, onward=onward),),
        contacts=(tsm.ContactPair(node="pin", beam="c", side="right", friction=friction),),
        **given,
    )


@pytest.mark.parametrize(
    ("element", "friction"),
    [("mixed", 0.0), ("exact", 0.0), ("exact", 0.3), pytest.param("mixed", 0.3, marks=pytest.mark.slow)],
)
def test_stages_of_a_pin_are_its_path_with_corners(element: str, friction: float) -> None:
    staged = tsm.solve(
        cantilever(element, (BACK, THERE), friction, onward=((BACK,), (THERE,))), [*T, *(1 + T), *(2 + T)]
    )
    single = tsm.solve(
        cantilever(element, (BACK, THERE, BACK, THERE), friction), np.array([*T, *(1 + T), *(2 + T)]) / 3
    )
    parts, whole = staged.contacts[PAIR], single.contacts[PAIR]
    assert parts.force == pytest.approx(whole.force, abs=1e-12)
    assert parts.arc_position == pytest.approx(whole.arc_position, abs=1e-9, nan_ok=True)
    inner = [(e.kind, e.load_parameter) for e in staged.events if e.kind is not tsm.EventKind.PASS_THROUGH]
    others = [
        (e.kind, 3 * e.load_parameter) for e in single.events if e.kind is not tsm.EventKind.PASS_THROUGH
    ]
    assert [kind for kind, _ in inner] == [kind for kind, _ in others]
    assert [t for _, t in inner] == pytest.approx([t for _, t in others], abs=1e-9)
    assert parts.force[:4] == pytest.approx(parts.force[8:], abs=1e-12)
    stages = [event.stage for event in staged.events]
    assert stages == sorted(stages)
    assert set(stages) == {1, 2, 3}
    if friction:
        assert abs(parts.force[1] - parts.force[5]) > 1e-6
        (turn,) = [
            e for e in staged.events if e.kind is tsm.EventKind.STICK and abs(e.load_parameter - 1.0) < 1e-15
        ]
        assert turn.stage == 2
    else:
        assert parts.force[:3] == pytest.approx(parts.force[6:3:-1], abs=1e-9)


def loaded(
    stages: tuple[tuple[float, float, float], ...], motions: tuple[tuple[float, float, float], ...]
) -> tsm.Structure:
    (ux, uy, rotation), *onward = motions
    return tsm.Structure(
        beams=(tsm.Beam(name="c", start=(0, 0), end=(1, 0), section=SECTION, elements=10),),
        supports=(tsm.Support(beam="c", end="start", ux=ux, uy=uy, rotation=rotation, onward=tuple(onward)),),
        loads=tuple(
            tsm.Load(beam="c", end="end", force=(fx, fy), moment=moment, stage=k)
            for k, (fx, fy, moment) in enumerate(stages)
        ),
    )


def test_loads_and_supports_go_on_and_come_back() -> None:
    up, more = (1e-4, 3e-4, 2e-4), (0.0, -2e-4, 5e-4)
    moved, further = (0.1, 0.0, 0.4), (-0.2, 0.3, -0.9)
    back = (
        tuple(-a - b for a, b in zip(up, more, strict=True)),
        tuple(-a - b for a, b in zip(moved, further, strict=True)),
    )
    staged = tsm.solve(loaded((up, more, back[0]), (moved, further, back[1])), [*T, *(1 + T), *(2 + T)])
    single = tsm.solve(loaded((up,), (moved,)), T)
    assert staged.tips["c"][:4] == pytest.approx(single.tips["c"], abs=1e-13)
    both = [tuple(a + b for a, b in zip(*pair, strict=True)) for pair in ((up, more), (moved, further))]
    whole = tsm.solve(loaded((both[0],), (both[1],)), [1.0])
    assert staged.tips["c"][7] == pytest.approx(whole.tips["c"][0], abs=1e-9)
    assert staged.supports["c.start"].moment[7] == pytest.approx(
        whole.supports["c.start"].moment[0], abs=1e-10
    )
    assert staged.tips["c"][11] == pytest.approx((1.0, 0.0), abs=1e-9)
    assert staged.supports["c.start"].force[11] == pytest.approx((0.0, 0.0), abs=1e-12)
    assert (staged.index == 0).all()


@pytest.mark.parametrize("element", [pytest.param("mixed", marks=pytest.mark.slow), "exact"])
def test_the_work_of_all_stages_is_stored_or_dissipated(element: str) -> None:
    structure = cantilever(
        element, ((0.8, -0.05), (0.7, 0.25)), 0.2, onward=((), ((0.8, 0.1),)),
        supports=(tsm.Support(beam="c", end="start", onward=((0.0, 0.02, 0.1), (0.01, 0.0, -0.05))),),
        loads=(tsm.Load(beam="c", end="end", force=(0.0, -2e-4)), tsm.Load(beam="c", end="end", force=(1e-4, 3e-4), stage=1)),
        springs=(tsm.Spring(beam="c", end="end", y=3e-4),),
        hinges=(tsm.Hinge(beam="c", end="start", stiffness=2e-3),),
    )  # fmt: skip
    result = tsm.solve(structure, [1.0, 2.0, 3.0])
    kept = result.strain_energy + result.contacts[PAIR].friction.dissipated
    assert result.contacts[PAIR].friction.dissipated[-1] > 1e-7
    assert result.work == pytest.approx(kept, abs=1e-9 * SECTION.EI)
    kinds = {event.kind for event in result.events}
    assert {tsm.EventKind.STICK, tsm.EventKind.SLIP} <= kinds


def test_the_first_stage_is_the_structure_without_stages_to_the_bit() -> None:
    one = cantilever("exact", (BACK, THERE), 0.3)
    two = cantilever("exact", (BACK, THERE), 0.3, onward=((BACK,),))
    first, both = tsm.solve(one, T), tsm.solve(two, [*T, 1.01])
    assert np.array_equal(first.contacts[PAIR].force, both.contacts[PAIR].force[:4])
    assert np.array_equal(first.tips["c"], both.tips["c"][:4])


def test_loads_along_a_beam_go_on_by_stages() -> None:
    """Weight, then a load on a part, then both taken away, against one stage with the sums."""
    beam = tsm.Beam(name="c", start=(0, 0), end=(1, 0), section=SECTION, elements=1, element="exact").divided(
        0.4
    )

    def structure(*loads: tsm.LineLoad) -> tsm.Structure:
        return tsm.Structure(beams=(beam,), supports=(tsm.Support(beam="c", end="start"),), line_loads=loads)

    whole, part = ((0.0, -2e-3),), ((1e-3, 3e-3), (0.0, 1e-3))
    back = tuple((-x, -y) for x, y in part)
    loads = (
        tsm.LineLoad(beam="c", force=whole),
        tsm.LineLoad(beam="c", force=part, start=0.4, stage=1),
        tsm.LineLoad(beam="c", force=((0.0, 2e-3),), stage=2),
        tsm.LineLoad(beam="c", force=back, start=0.4, stage=2),
    )
    staged = tsm.solve(structure(*loads), [*T, *(1 + T), *(2 + T)])
    first = tsm.solve(structure(loads[0]), [0.5, 1.0])
    both = tsm.solve(structure(loads[0], tsm.LineLoad(beam="c", force=part, start=0.4)), [1.0])
    assert staged.tips["c"][[1, 3]] == pytest.approx(first.tips["c"], abs=1e-12)
    assert staged.tips["c"][7] == pytest.approx(both.tips["c"][0], abs=1e-9)
    assert staged.supports["c.start"].force[7] == pytest.approx(both.supports["c.start"].force[0], abs=1e-14)
    assert staged.tips["c"][11] == pytest.approx((1.0, 0.0), abs=1e-9)


def test_quantities_rise_by_increments() -> None:
    increments = Increments(np.array([[1.0, -2.0], [3.0, 0.0], [-4.0, 5.0]]))
    for t, expected in (
        (0.0, (0, 0)),
        (0.5, (0.5, -1)),
        (1.0, (1, -2)),
        (1.5, (2.5, -2)),
        (2.25, (3, -0.75)),
        (3.0, (0, 3)),
    ):
        assert increments.at(t) == pytest.approx(expected)
        assert increments.dot(t, np.array([2.0, 3.0])) == pytest.approx(np.dot(expected, (2.0, 3.0)))
    assert increments.change(0.5, 2.25) == pytest.approx((2.5, 0.25))


def test_stages_that_cannot_be_are_refused() -> None:
    staged = cantilever("mixed", (BACK,), onward=((THERE,),))
    assert staged.stages == 2
    with pytest.raises(ValueError, match=r"must increase within \(0, 2\]"):
        tsm.solve(staged, [1.0, 2.5])
    with pytest.raises(ValueError, match="arc-length control follows a single stage"):
        tsm.trace(staged, arc_length=0.1, steps=2)
    with pytest.raises(ValueError, match="must have at least one point"):
        tsm.Pin(name="p", path=(), onward=((),))
    with pytest.raises(ValueError, match="must be zero where the component is free"):
        tsm.Support(beam="c", end="end", rotation=None, onward=((0.0, 0.0, 0.1),))
    with pytest.raises(ValueError, match="stage = -1"):
        tsm.Load(beam="c", end="end", stage=-1)
    with pytest.raises(ValueError, match="must not repeat a point"):
        tsm.Pin(name="p", path=(BACK,), onward=((BACK, THERE),))

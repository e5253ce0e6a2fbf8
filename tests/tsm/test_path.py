"""Paths: the same branch whatever the load parameters, and critical points by name."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipk

import tsm

SECTION = tsm.Section(EA=3e4, GA=9e3, EI=1.0)
ENDS = {
    "clamped-free": [("start", 0.0, 0.0, 0.0)],
    "pinned": [("start", 0.0, 0.0, None), ("end", 0.0, None, None)],
    "clamped": [("start", 0.0, 0.0, 0.0), ("end", 0.0, None, 0.0)],
    "clamped-pinned": [("start", 0.0, 0.0, 0.0), ("end", 0.0, None, None)],
}
"""Supports (ux, uy, rotation) of a column along y that is pressed at its end."""


def buckling_load(ends: str, section: tsm.Section) -> float:
    """First critical load of Reissner's rod of unit length (Reissner 1972; Timoshenko and Gere 1961, 2.17)."""
    shear, stretch = 1 / section.GA, 1 / section.EA

    def wave(P: float) -> float:
        return float(np.sqrt(P * (1 + P * (shear - stretch)) / section.EI))

    if ends == "clamped-pinned":

        def condition(P: float) -> float:
            k = wave(P)
            return float(np.sin(k) - k * np.cos(k) * (1 - P * stretch) / (1 + P * (shear - stretch)))

        return float(brentq(condition, 12.0, 21.0, xtol=1e-13))
    half_waves = {"clamped-free": 0.5, "pinned": 1.0, "clamped": 2.0}[ends]
    return float(brentq(lambda P: wave(P) - half_waves * np.pi, 0.1, 60.0, xtol=1e-13))


def column(
    ends: str, load: float, section: tsm.Section = SECTION, *, elements: int = 1, aside: float = 0.0
) -> tsm.Structure:
    """Column under an end load, with a part of it aside if it is not perfect."""
    element = "exact" if elements == 1 else "mixed"
    beam = tsm.Beam(name="c", start=(0, 0), end=(0, 1), section=section, elements=elements, element=element)
    supports = [
        tsm.Support(beam="c", end=end, ux=ux, uy=uy, rotation=turn)  # type: ignore[arg-type]
        for end, ux, uy, turn in ENDS[ends]
    ]
    push = tsm.Load(beam="c", end="end", force=(aside * load, -load))
    return tsm.Structure(beams=(beam,), supports=tuple(supports), loads=(push,))


def steps(count: int) -> np.ndarray:
    return np.arange(1, count + 1) / count


@pytest.mark.parametrize("count", [1, 5, 30])
@pytest.mark.parametrize("ends", ENDS)
@pytest.mark.parametrize("GA", [50.0, 9e3])
def test_a_perfect_column_ends_at_its_first_critical_load(ends: str, GA: float, count: int) -> None:
    section = tsm.Section(EA=3e4, GA=GA, EI=1.0)
    first = buckling_load(ends, section)
    result = tsm.solve(column(ends, 1.7 * first, section), steps(count), throw=False)
    assert result.status is tsm.Status.BIFURCATION
    (point,) = result.critical
    assert point.kind.value == "bifurcation"
    assert 1.7 * point.load_parameter == pytest.approx(1.0, abs=1e-8)
    assert (result.index == 0).all()
    assert len(result.load_parameter) == int(count / 1.7)
    assert np.abs(point.mode["c"][:, 0]).max() == pytest.approx(1.0)
    assert np.abs(point.mode["c"][:, 1]).max() < 1e-3


@pytest.mark.parametrize("ends", ENDS)
def test_mixed_elements_find_the_first_critical_load_with_their_order(ends: str) -> None:
    """Fourth order; 40 elements of a slender column leave at most 1e-6."""
    section = tsm.Section(EA=1e8, GA=1e8, EI=1.0)
    first = buckling_load(ends, section)
    off = []
    for elements in (20, 40):
        result = tsm.solve(column(ends, 1.7 * first, section, elements=elements), steps(5), throw=False)
        assert result.status is tsm.Status.BIFURCATION
        off.append(1.7 * result.critical[0].load_parameter - 1.0)
    assert np.log2(off[0] / off[1]) == pytest.approx(4.0, abs=0.2)
    assert abs(off[1]) < 1e-6


@pytest.mark.parametrize("degrees", [20.0, 60.0, 120.0, 160.0])
def test_the_stable_branch_is_the_elastica(degrees: float) -> None:
    """P/P_1 = (2 K(p)/pi)^2 with p = sin(tip angle/2), for both elements, in the slender limit."""
    section = tsm.Section(EA=1e10, GA=1e10, EI=1.0)
    ratio = float(2 * ellipk(np.sin(np.radians(degrees) / 2) ** 2) / np.pi) ** 2
    structure = column("clamped-free", ratio * buckling_load("clamped-free", section), section)
    result = tsm.solve(structure, [1.0], tsm.Settings(branch="stable"))
    assert abs(result.shape("c", -1)[-1, 2]) == pytest.approx(np.radians(degrees), abs=1e-6)
    assert result.index.tolist() == [0]
    (turned,) = result.events
    assert turned.released > 0


def test_the_primary_branch_is_labelled_unstable() -> None:
    first = buckling_load("pinned", SECTION)
    result = tsm.solve(column("pinned", 5 * first), steps(9), tsm.Settings(branch="primary"))
    assert result.index.tolist() == [0, 1, 1, 1, 1, 1, 1, 2, 2]
    assert [point.kind.value for point in result.critical] == ["bifurcation", "bifurcation"]
    assert 5 * result.critical[1].load_parameter == pytest.approx(4.0, rel=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("elements", [pytest.param(1, marks=pytest.mark.slow), 20])
def test_an_imperfect_column_bends_with_any_number_of_load_parameters(elements: int) -> None:
    ends = []
    for count in (1, 2, 5, 8, 12, 40, 200):
        result = tsm.solve(column("clamped-free", 20.0, elements=elements, aside=1e-5), steps(count))
        assert (result.index == 0).all()
        ends.append(result.tips["c"][-1])
    assert np.ptp(ends, axis=0).max() < 1e-9
    assert ends[0][0] > 0.4


@pytest.mark.parametrize("elements", [pytest.param(1, marks=pytest.mark.slow), 10])
def test_a_moved_tip_goes_to_its_own_side(elements: int) -> None:
    """A slender rod pushed in by .5 and moved aside by .02: it buckles to the side that it is moved to."""
    element = "exact" if elements == 1 else "mixed"
    section = tsm.Section(EA=1.2e6, GA=4e5, EI=1.0)
    beam = tsm.Beam(name="b", start=(0, 0), end=(1, 0), section=section, elements=elements, element=element)
    supports = (
        tsm.Support(beam="b", end="start"),
        tsm.Support(beam="b", end="end", ux=-0.5, uy=0.02, rotation=None),
    )
    found = []
    for count in (1, 3, 10, 40):
        result = tsm.solve(tsm.Structure(beams=(beam,), supports=supports), steps(count))
        found.append(result.supports["b.start"].moment[-1])
        assert (result.index == 0).all()
    assert np.ptp(found) < 1e-8 * abs(found[0])


def toggle(load: float) -> tsm.Structure:
    """Williams' toggle."""
    section = tsm.Section(EA=1.885e6, GA=1.885e10, EI=9274.0)
    apex = (12.94328, 0.386)
    return tsm.Structure(
        beams=(
            tsm.Beam(name="left", start=(0.0, 0.0), end=apex, section=section, elements=8),
            tsm.Beam(name="right", start=apex, end=(25.88656, 0.0), section=section, elements=8),
        ),
        supports=(tsm.Support(beam="left", end="start"), tsm.Support(beam="right", end="end")),
        loads=(tsm.Load(beam="left", end="end", force=(0.0, -load)),),
    )


@pytest.mark.parametrize("count", [1, 7, 50])
def test_load_control_ends_at_the_limit_point(count: int) -> None:
    """Where arc-length control finds it, to 1e-8."""
    traced = tsm.trace(toggle(40.0), arc_length=0.02, steps=20)
    passed = next(event for event in traced.events if event.kind is tsm.EventKind.LIMIT_POINT)
    result = tsm.solve(toggle(40.0), steps(count), throw=False)
    assert result.status is tsm.Status.LIMIT_POINT
    (point,) = result.critical
    assert point.kind.value == "limit point"
    assert point.load_parameter == pytest.approx(passed.load_parameter, abs=1e-8)
    assert 40 * point.load_parameter == pytest.approx(33.87, rel=2e-3)


def test_a_structure_snaps_through_to_the_stable_branch() -> None:
    traced = tsm.trace(toggle(40.0), arc_length=0.02, steps=30)
    beyond = traced.load_parameter[12:]
    last = 12 + int(np.argmax((beyond[:-1] < 1.0) & (beyond[1:] >= 1.0)))
    part = (1.0 - traced.load_parameter[last]) / (
        traced.load_parameter[last + 1] - traced.load_parameter[last]
    )
    apex = traced.tips["left"][last : last + 2, 1]
    result = tsm.solve(toggle(40.0), steps(20), tsm.Settings(branch="stable"))
    assert (result.index == 0).all()
    assert result.tips["left"][-1, 1] == pytest.approx(apex[0] + part * (apex[1] - apex[0]), abs=2e-3)
    snap = next(event for event in result.events if event.kind is tsm.EventKind.LIMIT_POINT)
    assert snap.released > 0


def held(
    shortened: float,
    *,
    height: float = 0.02,
    turn: float = 0.0,
    aside: float = 0.0,
    angle: float = 0.0,
    elements: int = 1,
) -> tsm.Structure:
    """Beam of unit length at an angle, clamped at both ends, of which one is moved."""
    section = tsm.Section.rectangle(width=height, height=height, youngs_modulus=1e7, shear_modulus=1e7 / 2.6)
    along = np.array([np.cos(angle), np.sin(angle)])
    moved = -shortened * along + aside * along[::-1] * [-1, 1]
    beam = tsm.Beam(
        name="b", start=(0, 0), end=tuple(along), section=section, elements=elements,
        element="exact" if elements < 10 else "mixed",
    )  # fmt: skip
    end = tsm.Support(beam="b", end="end", ux=moved[0], uy=moved[1], rotation=turn)
    return tsm.Structure(beams=(beam,), supports=(tsm.Support(beam="b", end="start"), end))


@pytest.mark.parametrize("count", [1, 4, 10, 20])
@pytest.mark.parametrize(
    ("height", "shortened", "aside", "turn"), [(0.1, 0.0626, 0.0, 0.01), (0.02, 0.3, 0.01, 0.1)]
)
def test_a_beam_without_a_free_node_follows_its_path(
    height: float, shortened: float, aside: float, turn: float, count: int
) -> None:
    """One element between two clamps has no free displacement: what happens inside tells one branch from another."""
    one, two = (
        tsm.solve(held(shortened, height=height, turn=turn, aside=aside, elements=elements), steps(number))
        for elements, number in ((1, count), (2, 10))
    )
    assert one.index[-1] == 0
    assert one.supports["b.start"].moment[-1] == pytest.approx(two.supports["b.start"].moment[-1], rel=1e-9)


@pytest.mark.parametrize("count", [1, 3, 20])
@pytest.mark.parametrize("elements", [1, 2, 20])
@pytest.mark.parametrize("angle", [0.0, 2.0])
def test_a_symmetric_bifurcation_turns_to_the_left(angle: float, elements: int, count: int) -> None:
    """To the side to which the mode goes first, seen from start to end; at .00437433, by name."""
    structure = held(0.3, aside=0.01, angle=angle, elements=elements)
    stopped = tsm.solve(structure, steps(count), throw=False)
    assert stopped.status is tsm.Status.BIFURCATION
    assert stopped.critical[0].load_parameter == pytest.approx(0.004374326, rel=2e-5)
    result = tsm.solve(structure, steps(count), tsm.Settings(branch="stable"))
    left = np.array([-np.sin(angle), np.cos(angle)])
    shape, mode = result.axis_line("b", -1)[1] @ left, result.critical[0].mode["b"] @ left
    assert mode[len(mode) // 2] > 0.9
    assert shape.max() > 0.3 > -0.1 > -shape.max()
    assert shape.min() > -0.02


@pytest.mark.parametrize("element", ["mixed", "exact"])
@pytest.mark.parametrize("count", [1, 12, 50])
def test_a_beam_on_a_drum_ends_where_it_bends_as_the_drum_does(element: str, count: int) -> None:
    """Clamp, drum of radius .5 under x = .3, dead load at the tip: the curvature at the drum is 1/(R + h/2)."""
    section = tsm.Section.rectangle(width=0.02, height=0.005, youngs_modulus=4.8e9, shear_modulus=1.846e9)
    structure = tsm.Structure(
        beams=(
            tsm.Beam(
                name="b",
                start=(0, 0),
                end=(1, 0),
                section=section,
                element=element,
                elements=1 if element == "exact" else 20,
            ),
        ),
        supports=(tsm.Support(beam="b", end="start"),),
        pins=(tsm.Pin(name="drum", path=((0.3, -0.5025), (0.3, -0.5025 + 1e-9))),),
        contacts=(tsm.ContactPair(node="drum", beam="b", side="right", offset=0.5025),),
        loads=(tsm.Load(beam="b", end="end", force=(0.0, -12.0)),),
    )
    result = tsm.solve(structure, steps(count), throw=False)
    assert result.status is tsm.Status.LINE_CONTACT
    (event,) = [event for event in result.events if event.kind is tsm.EventKind.LINE_CONTACT]
    # the tail beyond the drum is a cantilever under its dead load: moment = EI/(R + h/2) where it leaves the drum
    stopped = tsm.solve(structure, [event.load_parameter - 1e-9])
    line = stopped.axis_line("b", 0, 200)[1]
    tip, at = line[-1], line[np.argmin(np.abs(stopped.axis_line("b", 0, 200)[0] - event.arc_position))]
    moment = 12.0 * event.load_parameter * (tip[0] - at[0])
    assert moment / section.EI == pytest.approx(1 / 0.5025, rel=5e-3)

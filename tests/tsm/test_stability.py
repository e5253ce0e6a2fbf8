"""The index of an equilibrium, and the mode at a critical point."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

import tsm
from tests.tsm.drawn_states import drawn_equilibrium, drawn_structure, segments_of, tangent_index
from tests.tsm.reissner_hessian import displacement_index, mixed_index
from tsm.contact_set import initial_state
from tsm.model import Model
from tsm.newton import Equilibrium, Newton
from tsm.settings import Settings
from tsm.stability import index, mode
from tsm.status import Status
from tsm.stepping import Stepper

EA, GA = 5000.0, 2000.0
ENDS = {
    "clamped-free": ({}, None),
    "pinned": ({"rotation": None}, {"ux": None, "rotation": None}),
    "clamped": ({}, {"ux": None}),
    "clamped-pinned": ({}, {"ux": None, "rotation": None}),
}


def column(ends: str, load: float, element: str, elements: int) -> tsm.Structure:
    start, end = ENDS[ends]
    supports = [tsm.Support(beam="c", end="start", **start)]
    supports += [] if end is None else [tsm.Support(beam="c", end="end", **end)]
    section = tsm.Section(EA=EA, GA=GA, EI=1.0)
    beam = tsm.Beam(
        name="c", start=(0.0, 0.0), end=(1.0, 0.0), section=section, elements=elements, element=element
    )
    load = tsm.Load(beam="c", end="end", force=(-load, 0.0))
    return tsm.Structure(beams=(beam,), supports=tuple(supports), loads=(load,))


def straight(structure: tsm.Structure) -> tuple[Newton, Equilibrium]:
    newton = Newton(Model(structure), Settings())
    state = initial_state(newton.model)
    for t in np.linspace(0.1, 1, 10):
        found = newton.solve(replace(state, load_parameter=float(t)))
        assert found.status is Status.CONVERGED
        state = found.state
    assert np.abs(state.q.reshape(-1, 3)[:2, 1:]).max() == 0
    return newton, found


def critical_loads(ends: str, count: int) -> list[float]:
    """Loads of the straight Reissner column, EI = L = 1, at which it may bend.

    With ``c = 1/GA - 1/EA``, ``k^2 = P (1 + c P)``: ``cos k = 0``, ``sin k = 0``, and, where both ends are held across the axis,
    from ``int y' = 0``.
    """
    ratio = lambda P: (1 - P / EA) / (1 + P / GA - P / EA)  # noqa: E731
    wave = lambda P: math.sqrt(P * (1 + P / GA - P / EA))  # noqa: E731
    conditions: dict[str, list[Callable[[float], float]]] = {
        "clamped-free": [lambda P: math.cos(wave(P))],
        "pinned": [lambda P: math.sin(wave(P))],
        "clamped": [
            lambda P: math.sin(wave(P) / 2),
            lambda P: math.sin(wave(P) / 2) - wave(P) / 2 * ratio(P) * math.cos(wave(P) / 2),
        ],
        "clamped-pinned": [lambda P: math.sin(wave(P)) - wave(P) * ratio(P) * math.cos(wave(P))],
    }
    loads = np.linspace(0.5, 450, 4000)
    found = []
    for condition in conditions[ends]:
        values = [condition(P) for P in loads]
        changes = [n for n in range(len(loads) - 1) if values[n] * values[n + 1] < 0]
        found += [brentq(condition, loads[n], loads[n + 1], xtol=1e-13) for n in changes]
    return sorted(found)[:count]


def test_critical_loads_have_their_euler_limits() -> None:
    assert critical_loads("clamped-free", 1)[0] == pytest.approx((math.pi / 2) ** 2, rel=2e-3)
    assert critical_loads("clamped", 1)[0] == pytest.approx(4 * math.pi**2, rel=2e-2)
    assert critical_loads("clamped-pinned", 1)[0] == pytest.approx(4.4934**2, rel=1e-2)


@pytest.mark.parametrize("ends", ENDS)
@pytest.mark.parametrize("elements", [1, 4])
def test_straight_exact_columns_gain_a_negative_eigenvalue_at_every_critical_load(
    ends: str, elements: int
) -> None:
    for n, load in enumerate(critical_loads(ends, 4)):
        for factor, expected in ((1 - 1e-8, n), (1 + 1e-8, n + 1)):
            newton, found = straight(column(ends, factor * load, "exact", elements))
            assert index(newton.assembler, found.state, found.system) == expected


@pytest.mark.parametrize("ends", ENDS)
def test_straight_mixed_columns_gain_a_negative_eigenvalue_near_every_critical_load(ends: str) -> None:
    for n, load in enumerate(critical_loads(ends, 3)):
        for factor, expected in ((0.999, n), (1.001, n + 1)):
            newton, found = straight(column(ends, factor * load, "mixed", 40))
            assert index(newton.assembler, found.state, found.system) == expected


@pytest.mark.parametrize(("factor", "expected"), [(0.5, 0), (2, 1), (9.5, 2), (26, 3)])
@pytest.mark.parametrize("element", ["exact", "mixed", "timoshenko"])
def test_strut_at_multiples_of_its_buckling_load(factor: float, expected: int, element: str) -> None:
    load = factor * critical_loads("clamped-free", 1)[0]
    newton, found = straight(column("clamped-free", load, element, 1 if element == "exact" else 40))
    assert index(newton.assembler, found.state, found.system) == expected


@pytest.mark.parametrize("ends", ENDS)
def test_mode_of_a_perfect_column_is_a_bifurcation(ends: str) -> None:
    newton, found = straight(column(ends, critical_loads(ends, 1)[0], "exact", 1))
    at = mode(newton.assembler, found.state, found.system)
    assert at is not None
    assert at.softness < 1e-11
    assert at.driven < 1e-11
    assert np.abs(at.x / newton.model.units).max() == pytest.approx(1)
    tangent = newton.assembler.whole(found.system.tangent)
    units = newton.model.units
    assert np.abs(tangent @ at.x / newton.model.row_units).max() < 1e-10 * np.abs(tangent * units).max()


def test_mode_of_a_clamped_column_is_a_quarter_wave() -> None:
    newton, found = straight(column("clamped-free", critical_loads("clamped-free", 1)[0], "mixed", 40))
    at = mode(newton.assembler, found.state, found.system)
    assert at is not None
    across = at.x[1::3]
    wave = 1 - np.cos(math.pi / 2 * np.arange(1, 41) / 40)
    assert np.abs(across / across[-1] - wave).max() < 1e-3


def toggle(load: float) -> tsm.Structure:
    """Half of a toggle frame, which keeps its symmetry."""
    section = tsm.Section(EA=1e4, GA=5e3, EI=1.0)
    beam = tsm.Beam(name="a", start=(0.0, 0.0), end=(1.0, 0.1), section=section, elements=1, element="exact")
    supports = (tsm.Support(beam="a", end="start"), tsm.Support(beam="a", end="end", uy=None))
    push = tsm.Load(beam="a", end="end", force=(0.0, -load))
    return tsm.Structure(beams=(beam,), supports=supports, loads=(push,))


def test_mode_at_a_limit_point_is_driven_by_the_load() -> None:
    path = tsm.trace(toggle(10.0), arc_length=0.05, steps=25)
    highest = max(event.load_parameter for event in path.events if event.kind is tsm.EventKind.LIMIT_POINT)
    newton = Newton(Model(toggle(10.0)), Settings())
    state = initial_state(newton.model)
    for part in (*np.linspace(0.05, 0.95, 19), 0.99, 0.999, 0.9999, 0.99999):
        found = newton.solve(replace(state, load_parameter=float(part) * highest))
        assert found.status is Status.CONVERGED
        state = found.state
        assert index(newton.assembler, state, found.system) == 0
    at = mode(newton.assembler, state, found.system)
    assert at is not None
    assert at.softness < 1e-2
    assert at.driven > 1e-3


def test_contacts_of_the_paper_have_no_index() -> None:
    structure = pushed("timoshenko", 10)
    stepper = Stepper(Model(structure), Settings())
    step = next(stepper.march(np.array([0.1])))
    found = step.equilibrium
    assert index(stepper.newton.assembler, found.state, found.system) == -1


def pushed(element: str, elements: int, *, load: float = 0.0) -> tsm.Structure:
    """A cantilever whose tip is pushed up by a pin and, if at all, back by a load."""
    section = tsm.Section(EA=1e4, GA=5e3, EI=1.0)
    beam = tsm.Beam(
        name="c", start=(0.0, 0.0), end=(1.0, 0.0), section=section, elements=elements, element=element
    )
    return tsm.Structure(
        beams=(beam,),
        supports=(tsm.Support(beam="c", end="start"),),
        pins=(tsm.Pin(name="p", path=((0.8, 0.0), (0.8, 0.4))),),
        contacts=(tsm.ContactPair(node="p", beam="c"),),
        loads=(tsm.Load(beam="c", end="end", force=(-load, 0.0)),) if load else (),
    )


@pytest.mark.parametrize(("element", "elements"), [("exact", 1), ("exact", 4), ("mixed", 10)])
def test_contact_without_force_has_an_index_only_if_it_does_not_matter(element: str, elements: int) -> None:
    for load, expected in ((0.0, 0), (1.0, 0), (5.0, -1)):
        structure = pushed(element, elements, load=load)
        newton = Newton(Model(structure), Settings())
        still = replace(structure.pins[0], path=((0.8, 0.0), (0.8, 1e-300)))
        newton = Newton(Model(replace(structure, pins=(still,))), Settings())
        found = newton.solve(replace(initial_state(newton.model), load_parameter=1.0))
        assert found.status is Status.CONVERGED
        assert index(newton.assembler, found.state, found.system) == expected


def joined_column(load: float, elements: tuple[str, str], pin: float | None) -> tsm.Structure:
    """A column of two beams, whose end could touch a third that knows no contact force."""
    section = tsm.Section(EA=EA, GA=GA, EI=1.0)
    spans = {"a": ((0.0, 0.0), (0.5, 0.0)), "b": ((0.5, 0.0), (1.0, 0.0)), "far": ((0.0, 2.0), (2.0, 2.0))}
    kinds = dict(zip(spans, (*elements, "timoshenko"), strict=True))
    beams = tuple(
        tsm.Beam(
            name=name,
            start=start,
            end=end,
            section=section,
            elements=1 if kinds[name] == "exact" else 20,
            element=kinds[name],
        )
        for name, (start, end) in spans.items()
    )
    pins = () if pin is None else (tsm.Pin(name="p", path=((pin, -0.01), (pin, -0.01 + 1e-6))),)
    touching = tsm.ContactPair(node="p", beam="a" if pin is None or pin < 0.5 else "b", offset=0.01)
    return tsm.Structure(
        beams=beams,
        supports=(tsm.Support(beam="a", end="start"), tsm.Support(beam="far", end="start")),
        pins=pins,
        contacts=(tsm.ContactPair(node="b.end", beam="far"), *((touching,) if pins else ())),
        loads=(tsm.Load(beam="b", end="end", force=(-load, 0.0)),),
    )


@pytest.mark.slow_at("0.3", "0.8")
@pytest.mark.parametrize("pin", [None, 0.3, 0.8])
def test_index_does_not_depend_on_the_mixture_of_elements(pin: float | None) -> None:
    seen = set()
    for load in (1.0, 5.0, 25.0, 60.0, 100.0):
        found = []
        for elements in (("exact", "exact"), ("exact", "mixed"), ("mixed", "exact"), ("mixed", "mixed")):
            newton = Newton(Model(joined_column(load, elements, pin)), Settings())
            state = initial_state(newton.model)
            for t in np.linspace(0.1, 1, 10):
                at = newton.solve(replace(state, load_parameter=float(t)))
                state = at.state
            assert at.status is Status.CONVERGED
            assert np.abs(state.q[newton.model.dofs[1]]).max() < 1e-3
            found.append(index(newton.assembler, state, at.system))
        assert len(set(found)) == 1
        seen.update(found)
    assert len(seen) >= 3


def held_column(arc: float, load: float) -> int:
    """Index of a column pressed along its axis, held across it by a pin at an arc position."""
    base = pushed("exact", 2, load=load)
    place = arc * (1 - load / 1e4)
    pin = tsm.Pin(name="p", path=((place, 0.0), (place, 1e-6)))
    newton = Newton(Model(replace(base, pins=(pin,))), Settings())
    found = newton.solve(replace(initial_state(newton.model), load_parameter=1.0))
    assert found.status is Status.CONVERGED
    return index(newton.assembler, found.state, found.system)


@pytest.mark.parametrize(("load", "expected"), [(3.0, 0), (30.0, 1), (90.0, 2), (150.0, 3)])
def test_index_does_not_see_where_a_contact_cuts(load: float, expected: int) -> None:
    """Segments without length keep their moment. The column with a held tip buckles at 20.2, 59.7, 118.9 and 197.9."""
    at_node = {held_column(0.5 + d, load) for d in (-1e-2, -1e-5, -1e-12, 0.0, 1e-12, 1e-5, 1e-2)}
    assert at_node == {expected}
    assert {held_column(1.0 - d, load) for d in (-1e-6, 0.0, 1e-12, 1e-9, 1e-5, 1e-3)} == {expected}


def compare_exact(seed: int, count: int, *, offset: bool) -> Counter[int]:
    rng, seen = np.random.default_rng(seed), Counter[int]()
    while seen.total() < count:
        drawn = drawn_equilibrium(rng, drawn_structure(rng, "exact", offset=offset))
        if drawn is None:
            continue
        newton, found = drawn
        segments, fixed = segments_of(newton, found)
        if min(segment.length for segment in segments) < 0.003:
            continue
        counted = index(newton.assembler, found.state, found.system)
        units = newton.model.length, newton.model.force_scale
        assert mixed_index(segments, fixed, *units) == counted
        if not offset:
            assert displacement_index(segments, fixed, *units) == counted
        seen[counted] += 1
    return seen


def compare_mixed(seed: int, count: int, *, offset: bool) -> Counter[int]:
    rng, seen = np.random.default_rng(seed), Counter[int]()
    while seen.total() < count:
        drawn = drawn_equilibrium(rng, drawn_structure(rng, "mixed", offset=offset))
        if drawn is None:
            continue
        newton, found = drawn
        counted = index(newton.assembler, found.state, found.system)
        assert tangent_index(newton, found, rng) == counted
        seen[counted] += 1
    return seen


def test_index_is_that_of_the_dense_hessian_on_drawn_states() -> None:
    seen = compare_exact(1, 6, offset=False) + compare_exact(2, 3, offset=True)
    seen += compare_mixed(3, 6, offset=False)
    assert seen.total() == 15


@pytest.mark.parametrize(("factor", "expected"), [(2, 1), (26, 3)])
def test_large_matrices_are_counted_sparse(
    factor: float, expected: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    load = factor * critical_loads("clamped-free", 1)[0]
    newton, found = straight(column("clamped-free", load, "mixed", 40))
    held = [held_column(0.5, load) for load in (30.0, 150.0)]
    monkeypatch.setattr("tsm.inertia._DENSE", 0)
    assert index(newton.assembler, found.state, found.system) == expected
    monkeypatch.setattr("tsm.inertia._SOFT", 0.0)
    assert [held_column(0.5, load) for load in (30.0, 150.0)] == held == [1, 3]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_index_is_that_of_the_dense_hessian_on_many_drawn_states(seed: int) -> None:
    seen = compare_exact(100 + seed, 30, offset=False) + compare_exact(200 + seed, 15, offset=True)
    seen += compare_mixed(300 + seed, 30, offset=False)
    assert seen.total() == 75
    assert max(seen) >= 2

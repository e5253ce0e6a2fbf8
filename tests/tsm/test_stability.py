"""The index of an equilibrium: stable or not, with and without contacts, against critical loads in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import pytest
from scipy.optimize import brentq

import tsm

EA, GA = 5000.0, 2000.0
SECTION = tsm.Section(EA=EA, GA=GA, EI=1.0)
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
    beam = tsm.Beam(name="c", start=(0, 0), end=(1, 0), section=SECTION, elements=elements, element=element)
    push = tsm.Load(beam="c", end="end", force=(-load, 0.0))
    return tsm.Structure(beams=(beam,), supports=tuple(supports), loads=(push,))


def index(structure: tsm.Structure) -> int:
    """Index of the straight column, past the loads at which it may bend."""
    result = tsm.solve(structure, [1.0], tsm.Settings(branch="primary"))
    assert all(abs(result.shape(beam.name, 0)[:, 2]).max() < 1e-3 for beam in structure.beams)
    return int(result.index[0])


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
    loads = [0.5 + 0.1125 * n for n in range(4000)]
    found = []
    for condition in conditions[ends]:
        values = [condition(P) for P in loads]
        changes = [n for n in range(len(loads) - 1) if values[n] * values[n + 1] < 0]
        found += [brentq(condition, loads[n], loads[n + 1], xtol=1e-13) for n in changes]
    return sorted(found)[:count]


@pytest.mark.parametrize("ends", ENDS)
@pytest.mark.parametrize(
    ("element", "elements", "apart"), [("exact", 1, 1e-6), ("exact", 4, 1e-6), ("mixed", 40, 1e-3)]
)
def test_straight_columns_gain_a_negative_eigenvalue_at_every_critical_load(
    ends: str, element: str, elements: int, apart: float
) -> None:
    for n, load in enumerate(critical_loads(ends, 4 if element == "exact" else 3)):
        for factor, expected in ((1 - apart, n), (1 + apart, n + 1)):
            assert index(column(ends, factor * load, element, elements)) == expected


@pytest.mark.parametrize(("element", "elements"), [("timoshenko", 40), ("mixed", 600)])
def test_the_index_of_the_papers_element_and_of_matrices_that_are_counted_sparse(
    element: str, elements: int
) -> None:
    load = critical_loads("clamped-free", 1)[0]
    for factor, expected in ((0.5, 0), (2, 1), (9.5, 2), (26, 3)):
        assert index(column("clamped-free", factor * load, element, elements)) == expected


def pushed(
    element: str, elements: int, *, load: float, x: float = 0.8, rise: float = 1e-300
) -> tsm.Structure:
    """A column under a pin that rests on its side."""
    free = column("clamped-free", load, element, elements)
    return replace(
        free,
        pins=(tsm.Pin(name="p", path=((x, 0.0), (x, rise))),),
        contacts=(tsm.ContactPair(node="p", beam="c"),),
    )


def test_contacts_of_the_paper_have_no_index() -> None:
    assert tsm.solve(pushed("timoshenko", 11, load=0.0, rise=0.04), [0.1]).index.tolist() == [-1]


@pytest.mark.parametrize(("element", "elements"), [("exact", 1), ("exact", 4), ("mixed", 10)])
def test_contact_without_force_has_an_index_only_if_it_does_not_matter(element: str, elements: int) -> None:
    for load, expected in ((0.0, 0), (1.0, 0), (5.0, -1)):
        assert index(pushed(element, elements, load=load)) == expected


@pytest.mark.parametrize(("element", "elements"), [("exact", 2), ("mixed", 10)])
def test_index_does_not_see_where_a_contact_cuts(element: str, elements: int) -> None:
    """Segments without length keep their moment; beyond the load at which the free column buckles."""
    arcs = [0.5 + d for d in (-1e-2, -1e-5, -1e-12, 0.0, 1e-12, 1e-5, 1e-2)]
    down = tsm.Load(beam="c", end="end", force=(0.0, -1e-4))
    for arc in (*arcs, *(1.0 - d for d in (1e-12, 1e-9, 1e-5, 1e-3))):
        structure = pushed(element, elements, load=4.0, x=arc * (1 - 4.0 / EA), rise=1e-6)
        result = tsm.solve(replace(structure, loads=(*structure.loads, down)), [0.5, 1.0])
        assert (result.contacts["p->c"].force > 0).all()
        assert result.index.tolist() == [0, 0]


def joined_column(load: float, elements: tuple[str, str]) -> tsm.Structure:
    """A column of two beams, whose end could touch a third that knows no contact force."""
    spans = {"a": ((0.0, 0.0), (0.5, 0.0)), "b": ((0.5, 0.0), (1.0, 0.0)), "far": ((0.0, 2.0), (2.0, 2.0))}
    beams = tuple(
        tsm.Beam(
            name=name, start=start, end=end, section=SECTION, elements=1 if kind == "exact" else 20, element=kind
        )
        for (name, (start, end)), kind in zip(spans.items(), (*elements, "timoshenko"), strict=True)
    )  # fmt: skip
    return tsm.Structure(
        beams=beams,
        supports=(tsm.Support(beam="a", end="start"), tsm.Support(beam="far", end="start")),
        contacts=(tsm.ContactPair(node="b.end", beam="far"),),
        loads=(tsm.Load(beam="b", end="end", force=(-load, 0.0)),),
    )


def test_index_does_not_depend_on_the_mixture_of_elements() -> None:
    seen = set()
    for load in (1.0, 5.0, 25.0, 60.0, 100.0):
        kinds = (("exact", "exact"), ("exact", "mixed"), ("mixed", "exact"), ("mixed", "mixed"))
        (found,) = {index(joined_column(load, elements)) for elements in kinds}
        seen.add(found)
    assert len(seen) >= 3

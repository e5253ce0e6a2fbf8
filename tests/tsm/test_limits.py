"""Extreme structures from Python: a ``ValueError`` that names field, value and rule, before anything is made."""

from collections.abc import Callable

import numpy as np
import pytest

import tsm
from tsm.memory import CLOSED, EXACT_ONE, needed

SECTION = tsm.Section(EA=8.4, GA=2.7, EI=2.8e-4)


def beam(**changes: object) -> tsm.Beam:
    given = {"name": "b", "start": (0.0, 0.0), "end": (1.0, 0.0), "section": SECTION, "elements": 4}
    return tsm.Beam(**{**given, **changes})  # type: ignore[arg-type]


def cantilever(*beams: tsm.Beam) -> tsm.Structure:
    return tsm.Structure(beams=beams, supports=tuple(tsm.Support(beam=b.name, end="start") for b in beams))


BAD: dict[str, tuple[Callable[[], object], str]] = {
    "far end": (lambda: beam(end=(1e155, 0)), r"Beam\(b\)\.end = \(1e\+155, 0\): must be two finite numbers, of at most 1e\+50"),
    "far start": (lambda: beam(start=(-1e308, 0)), r"Beam\(b\)\.start = "),
    "huge integer": (lambda: beam(start=(10**400, 0)), r"Beam\(b\)\.start = "),
    "short": (lambda: beam(end=(1e-320, 0)), r"Beam\(b\)\.end = .*: must differ from start, by 1e-50 to 1e\+50"),
    "far support": (lambda: tsm.Support(beam="b", end="end", ux=1e60), r"Support\(b\.end\)\.ux = 1e\+60: "),
    "large force": (lambda: tsm.Load(beam="b", end="end", force=(1e60, 0.0)), r"Load\(b\.end\)\.force = "),
    "large moment": (lambda: tsm.Load(beam="b", end="end", moment=np.inf), r"Load\(b\.end\)\.moment = inf"),
    "far pin": (lambda: tsm.Pin(name="p", path=((0, 0), (1e60, 0))), r"Pin\(p\)\.path = "),
    "far surface": (lambda: tsm.ContactPair(node="p", beam="b", offset=1e60), r"p->b\.offset = 1e\+60"),
    "elements": (lambda: beam(elements=10**9), r"Beam\(b\)\.elements = 1000000000: must be a whole number from 1 to 1000000"),
    "elements in all": (
        lambda: cantilever(beam(elements=600_000), beam(name="c", end=(2.0, 0.0), elements=600_000)),
        r"Structure\.elements = 1200000: must be at most 1000000 in all",
    ),
    "memory": (
        lambda: tsm.solve(cantilever(beam(elements=100_000)), np.linspace(1e-5, 1, 100_000)),
        r"load_parameters = 100000: with 100000 elements and 0 contacts needs 5e\+03 GB, more than 80% of the memory",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_an_extreme_structure_is_refused(case: str) -> None:
    make, sentence = BAD[case]
    with pytest.raises(ValueError, match=sentence) as caught:
        make()
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("size", [1e-40, 1e-20, 1e20, 1e40])
def test_a_structure_at_the_limits_is_solved(size: float) -> None:
    """The same cantilever in other units of length and force."""
    force = 1e-3 if size < 1 else 1e3
    section = tsm.Section(EA=8.4 * force, GA=2.7 * force, EI=2.8e-4 * force * size**2)
    structure = tsm.Structure(
        beams=(beam(end=(size, 0.0), section=section),),
        supports=(tsm.Support(beam="b", end="start"),),
        loads=(tsm.Load(beam="b", end="end", force=(0.0, 2.8e-4 * force)),),
    )
    result = tsm.solve(structure, [0.5, 1.0])
    assert result.tips["b"][-1] / size == pytest.approx([0.9436, 0.3017], abs=1e-3)


@pytest.mark.parametrize(("element", "each"), [("mixed", CLOSED), ("exact", EXACT_ONE)])
def test_the_estimate_of_the_memory_holds(element: str, each: int) -> None:
    """What a solution keeps, measured, is at most the estimate and at least half of it."""
    import tracemalloc

    structure = cantilever(beam(elements=200, element=element))
    structure = tsm.Structure(
        beams=structure.beams,
        supports=structure.supports,
        loads=(tsm.Load(beam="b", end="end", force=(0.0, 1e-4)),),
    )
    steps = np.linspace(0.05, 1, 20)
    tsm.solve(structure, steps[-1:])
    tracemalloc.start()
    result = tsm.solve(structure, steps)
    kept, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert result.status is tsm.Status.COMPLETED
    assert needed(structure, 20) == 21 * 200 * each
    assert 0.5 * needed(structure, 20) < kept < needed(structure, 20)

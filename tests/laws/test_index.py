"""The index of a column is the number of its critical loads that have been passed, by closed forms of the rod that stretches and shears."""

import math

import pytest
from scipy.optimize import brentq

import tsm
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.referee import certify
from comparisons.scene import BeamSpec, HingeSpec, LoadSpec, Scene, SpringSpec, SupportSpec
from tests.laws.scenes import answer, scene

EA, GA = 4e3, 5e2
ENDS = {
    "free": ((), ()),
    "pinned": (("x", "y"), ("y",)),
    "clamped": ((), ("y", "rotation")),
    "hinged": ((), ()),
    "sprung": (("x", "y"), ()),
}
SPRING = 2.0
"""Stiffness of the hinge, and of the spring, at the foot of a column that is free else."""
WITHIN = {"exact": 1e-8, "mixed": 5e-4}
MESHED = 2e-2
"""Largest error of a critical load; the order is two without the bow."""


def column(ends: str, load: float, number: int) -> Scene:
    """EI = L = 1."""
    first, last = ENDS[ends]
    fixed = ((("start", first),) if first else ()) + ((("end", last),) if last else ())
    beam = BeamSpec(
        name="b", start=(0.0, 0.0), end=(1.0, 0.0), youngs_modulus=1.0, shear_modulus=1.0, area=EA, second_moment=1.0, shear_area=GA,
        clamped=() if first else ("start",), elements=20,
    )  # fmt: skip
    supports = tuple(SupportSpec(beam="b", end=end, fixed=held) for end, held in fixed)
    push, foot = LoadSpec(beam="b", end="end", force=(-load, 0.0)), {"beam": "b", "end": "start"}
    hinges = (HingeSpec(**foot, stiffness=SPRING),) if ends == "hinged" else ()
    springs = (SpringSpec(**foot, rotation=SPRING),) if ends == "sprung" else ()
    return Scene(
        name="column", load_parameters=number, beams=(beam,), supports=supports, loads=(push,), hinges=hinges, springs=springs,
    )  # fmt: skip


def critical(ends: str, mode: int, GA: float = GA) -> float:
    """Load of a mode: ``P (1 + P (1/GA - 1/EA)) = k^2``; on a spring ``k tan k`` is its stiffness."""
    if ends in ("hinged", "sprung"):
        k = brentq(
            lambda k: k * math.sin(k) - SPRING * math.cos(k),
            (mode - 1.0) * math.pi,
            (mode - 0.5) * math.pi,
            xtol=1e-15,
        )
    else:
        k = math.pi * {"free": mode - 0.5, "pinned": float(mode), "clamped": 2.0 * mode}[ends]
    a = 1.0 / GA - 1.0 / EA
    return (math.sqrt(1.0 + 4.0 * a * k**2) - 1.0) / (2.0 * a)


@pytest.mark.slow_at(*(f"timoshenko-{ends}" for ends in ENDS))
@pytest.mark.parametrize("ends", ENDS)
@pytest.mark.parametrize("element", [name for name, kind in tsm.ELEMENTS.items() if not kind.variant])
def test_the_index_is_the_number_of_critical_loads_passed(element: str, ends: str) -> None:
    """On the straight path, whose end is named unstable; the referee counts the same of a rod that shears. Without `primary` it ends at the first."""
    kind, modes = tsm.ELEMENTS[element], 1 if ends == "clamped" else 2
    stiffness = GA if kind.sheared else math.inf
    load = 1.15 * critical(ends, modes, stiffness)
    asked = column(ends, load, 12)
    found = solve(asked, "tsm", Options(element=element, branch="primary"))
    assert found.status == "UNSTABLE", found.message
    loads = [critical(ends, mode, stiffness) / load for mode in range(1, modes + 1)]
    located = [point.load_parameter for point in found.critical]
    assert located == pytest.approx(loads, rel=WITHIN.get(element, MESHED))
    assert {point.kind for point in found.critical} == {"bifurcation"}
    assert found.index is not None
    passed = [sum(t > one for one in loads) for t in asked.times]
    assert list(found.index) == passed
    if kind.sheared:
        judged = certify(found, asked, at=range(12), allowance=math.inf).judged
        assert [item.index for item in judged] == passed
    for number in (1, 5):
        stopped = solve(column(ends, load, number), "tsm", Options(element=element))
        assert stopped.status == "BIFURCATION"
        assert stopped.critical[0].load_parameter == pytest.approx(found.critical[0].load_parameter, abs=1e-8)
        assert list(stopped.index) == [0] * int(number * loads[0])


def test_a_strut_that_comes_down_beyond_its_buckling_load_is_bent() -> None:
    """Ten times the force would hold it straight, with index 1: what the solid finds first in the step in which it touches."""
    force, exact = (
        answer(scene("world-1042"), model).contacts["b1.end->b0"].force[:3] for model in ("solid", "exact")
    )
    assert force == pytest.approx(exact, rel=1e-2)


@pytest.mark.parametrize("element", ["exact", "mixed"])
def test_a_beam_that_idle_contacts_hold_has_no_index(element: str) -> None:
    """Without them it turns about its pin: an eigenvalue is zero, and its sign was that of the round-off."""
    assert set(answer(scene("world-12"), element).index) == {-1}

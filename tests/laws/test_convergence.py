"""The error of an element falls with the mesh by its order, against the referee's equilibrium."""

import math

import pytest

import tsm
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.referee import certify
from tests.laws.scenes import ELEMENTS, numbered, scene, states

MESHES = (8, 16)
SCENES = ("special-58", "special-46", "held-8", "friction-10")
"""Bent beams on springs, a tapered one under a load along it, one that is shortened, and a pin that slides."""


def fits(element: str, name: str) -> bool:
    """A beam that is rigid in shear is another one where shear matters."""
    kind = tsm.ELEMENTS[element]
    return kind.meshed and states(element, scene(name)) and (kind.sheared or name == "special-58")


CASES = [(element, name) for element in ELEMENTS for name in SCENES if fits(element, name)]
QUICK = [("mixed", "special-58"), ("timoshenko", "held-8"), ("mixed", "held-8"), ("mixed", "friction-10")]


def error(element: str, name: str, elements: int) -> float:
    asked = numbered(scene(name), 3)
    found = solve(asked, "tsm", Options(element=element, elements=elements))
    (judged,) = certify(found, asked, at=[-1], allowance=math.inf).judged
    assert judged.distance is not None, judged.reason
    return judged.distance.largest[1]


@pytest.mark.parametrize(
    ("element", "name"),
    [pytest.param(*case, marks=() if case in QUICK else pytest.mark.slow) for case in CASES],
)
def test_the_error_falls_by_the_order_of_the_element(element: str, name: str) -> None:
    coarse, fine = (error(element, name, elements) for elements in MESHES)
    assert math.log2(coarse / fine) >= tsm.ELEMENTS[element].order - 0.2

"""The axis between the nodes is as good as the nodes: against exact elements, at every load parameter."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import tsm

STRIP = tsm.Section.rectangle(width=0.02, height=0.02, youngs_modulus=2.1e4, shear_modulus=8.0769e3)
BEAM = tsm.Beam(name="beam", start=(0, 0), end=(1, 0), section=STRIP, elements=1)
STEPS = np.linspace(0.1, 1, 10)


def pushed(section: tsm.Section, element: str, elements: int) -> tsm.Result:
    structure = tsm.Structure(
        beams=(replace(BEAM, section=section, element=element, elements=elements),),
        supports=(tsm.Support(beam="beam", end="start"),),
        pins=(tsm.Pin(name="pin", path=((1, 0), (0, 2 / np.pi))),),
        contacts=(tsm.ContactPair(node="pin", beam="beam", side="right"),),
    )
    return tsm.solve(structure, STEPS)


def apart(found: tsm.Result, exact: tsm.Result) -> tuple[float, float]:
    """Largest distance from the exact axis at nodes and anywhere."""
    distances = []
    for k in range(len(STEPS)):
        arc, xy = found.axis_line("beam", k)
        distances.append(np.hypot(*(xy - CubicSpline(*exact.axis_line("beam", k, 400))(arc)).T))
    return float(np.max([line[::10] for line in distances])), float(np.max(distances))


SECTIONS = {
    "slender": STRIP,
    "sheared": replace(STRIP, GA=50 * STRIP.EI),
    "stretched": replace(STRIP, EA=300 * STRIP.EI),
}


@pytest.mark.slow_at("sheared")
@pytest.mark.parametrize("section", SECTIONS.values(), ids=SECTIONS)
def test_between_nodes_as_at_nodes(section: tsm.Section) -> None:
    exact = pushed(section, "exact", 1)
    for elements in (10, 20):
        at_nodes, anywhere = apart(pushed(section, "mixed", elements), exact)
        assert anywhere < 1.1 * at_nodes


def test_the_whole_axis_converges_with_the_fourth_order() -> None:
    exact = pushed(STRIP, "exact", 1)
    coarse, fine = (apart(pushed(STRIP, "mixed", elements), exact)[1] for elements in (10, 20))
    assert coarse < 5e-6
    assert np.log2(coarse / fine) == pytest.approx(4, abs=0.15)


def test_points_do_not_depend_on_how_many_are_asked_for() -> None:
    found = pushed(STRIP, "mixed", 5)
    (_, few), (_, many) = (found.axis_line("beam", -1, count) for count in (2, 40))
    assert few == pytest.approx(many[::20], abs=1e-6)


@pytest.mark.parametrize("element", ["mixed", "timoshenko", "mixed-no-bow"])
def test_elements_meet_at_their_nodes(element: str) -> None:
    found = pushed(STRIP, element, 7)
    for k in range(len(STEPS)):
        _, xy = found.axis_line("beam", k)
        assert xy[::10] == pytest.approx(found.shape("beam", k)[:, :2], abs=1e-14)


def test_an_arc_of_a_circle() -> None:
    """Rolled up by its end moment: the points lie on the circle and are evenly spread."""
    structure = tsm.Structure(
        beams=(replace(BEAM, element="mixed", elements=8),),
        supports=(tsm.Support(beam="beam", end="start"),),
        loads=(tsm.Load(beam="beam", end="end", moment=STRIP.EI * np.pi),),
    )
    _, xy = tsm.solve(structure, [0.25, 0.5, 0.75, 1]).axis_line("beam", 3)
    angle = np.pi * np.linspace(0, 1, 81)
    assert xy == pytest.approx(np.stack([np.sin(angle), 1 - np.cos(angle)], axis=1) / np.pi, abs=3e-5)

"""Paths and their index: critical points by name, the branch that is followed, stable or not, against closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import tsm
from comparisons.models.tsm import to_structure
from comparisons.scene import LoadSpec, load_scene
from tests.tsm.structures import beam, cantilever, steps

EA, GA = 5000.0, 2000.0
SECTION = tsm.Section(EA=EA, GA=GA, EI=1.0)
PRIMARY, STABLE = tsm.Settings(branch="primary"), tsm.Settings(branch="stable")


def test_the_main_scene_takes_two_iterations_a_load_parameter():
    """The path is predicted by Hermite's polynomial: 144 iterations without the tangents."""
    scene = load_scene("ks-cantilever")
    result = tsm.solve(to_structure(scene, element="mixed", elements=10), np.array(scene.times))
    assert result.newton_iterations.sum() <= 105


def test_many_beams_have_the_answers_of_one():
    """The border of 22 contacts is wider than what is solved as dense columns."""
    alone = [cantilever(((0.9, 0.0), (0.7, 0.3)))] * 22
    many = tsm.Structure(
        beams=tuple(replace(s.beams[0], name=f"b{k}", start=(0, k), end=(1, k)) for k, s in enumerate(alone)),
        supports=tuple(replace(s.supports[0], beam=f"b{k}") for k, s in enumerate(alone)),
        pins=tuple(tsm.Pin(name=f"p{k}", path=((0.9, k), (0.7, k + 0.3))) for k in range(len(alone))),
        contacts=tuple(replace(s.contacts[0], node=f"p{k}", beam=f"b{k}") for k, s in enumerate(alone)),
    )
    single, result = (tsm.solve(structure, steps(4)) for structure in (alone[0], many))
    for contact in result.contacts.values():
        np.testing.assert_allclose(contact.force, single.contacts["p0->b"].force, rtol=1e-9)
    assert (result.index == single.index).all()


def column(load, *paths, element="exact", elements=1):
    push = tsm.Load(beam="b", end="end", force=(-load, 0.0))
    return cantilever(*paths, section=SECTION, element=element, elements=elements, load=push)


def index(structure):
    """Index of the straight column, past the loads at which it may bend."""
    result = tsm.solve(structure, [1.0], PRIMARY)
    assert all(abs(result.shape(beam.name, 0)[:, 2]).max() < 1e-3 for beam in structure.beams)
    return int(result.index[0])


def test_the_index_of_matrices_that_are_counted_sparse():
    """Between the second critical load, 22.1, and the third, 60."""
    assert index(column(24.0, element="mixed", elements=600)) == 2


def pressed(element, elements, *, load, x=0.8, rise=1e-300):
    return column(load, ((x, 0.0), (x, rise)), element=element, elements=elements)


@pytest.mark.parametrize(("element", "elements"), [("exact", 1), ("mixed", 10)])
def test_contact_without_force_has_an_index_only_if_it_does_not_matter(element, elements):
    for load, expected in ((0.0, 0), (1.0, 0), (5.0, -1)):
        assert index(pressed(element, elements, load=load)) == expected


def test_the_index_of_exact_among_other_elements_does_not_depend_on_the_units():
    """The exact elements' own rows, of compliances as large as 1e25, had cancelled all digits of their units."""
    for length, stiffness in ((1.0, 1.0), (1e-5, 1e-25)):
        section = tsm.Section(EA=1e6 * stiffness / length**2, GA=1e6 * stiffness / length**2, EI=stiffness)
        heavy = beam("a", (0.0, 0.0), (length, 0.0), section=section, element="mixed")
        light = beam("b", (length, 0.0), (length, length), section=section, element="mixed")
        weight = tsm.LineLoad(beam="a", force=((0.0, -stiffness / length**3),))
        structure = tsm.Structure(
            beams=(heavy, light), supports=(tsm.Support(beam="a", end="start"),), line_loads=(weight,)
        )
        assert tsm.solve(structure, [1.0]).index.tolist() == [0]


def test_contacts_of_the_paper_have_no_index():
    assert tsm.solve(pressed("timoshenko", 11, load=0.0, rise=0.04), [0.1]).index.tolist() == [-1]


@pytest.mark.parametrize(("element", "elements"), [("exact", 2), ("mixed", 10)])
def test_index_does_not_see_where_a_contact_cuts(element, elements):
    """Segments without length keep their moment; beyond the load at which the free column buckles."""
    down = tsm.Load(beam="b", end="end", force=(0.0, -1e-4))
    for arc in (0.5 - 1e-12, 0.5, 0.5 + 1e-5, 1.0 - 1e-12):
        structure = pressed(element, elements, load=4.0, x=arc * (1 - 4.0 / EA), rise=1e-6)
        result = tsm.solve(replace(structure, loads=(*structure.loads, down)), [0.5, 1.0])
        assert (result.contacts["p0->b"].force > 0).all()
        assert result.index.tolist() == [0, 0]


def test_load_control_ends_at_the_limit_point_or_snaps_through():
    """Where arc-length control finds it, to 1e-8; and to the stable branch at which it arrives."""
    frame, push = load_scene("williams-toggle"), LoadSpec(beam="left", end="end", force=(0.0, -40.0))
    held = tuple(item for item in frame.supports if not item.moves)
    toggle = to_structure(replace(frame, supports=held, loads=(push,)), elements=8)
    traced = tsm.trace(toggle, arc_length=0.02, steps=30)
    passed = next(event for event in traced.events if event.kind is tsm.EventKind.LIMIT_POINT)
    for count in (1, 7):
        result = tsm.solve(toggle, steps(count), throw=False)
        assert result.status is tsm.Status.LIMIT_POINT
        assert result.cutbacks <= 20  # steps keep room before it: 12 and 6 are cut, and more than 30 without
        (point,) = result.critical
        assert point.kind.value == "limit point"
        assert point.load_parameter == pytest.approx(passed.load_parameter, abs=1e-8)
    t, apex = traced.load_parameter[12:], traced.tips["left"][12:, 1]
    last = int(np.argmax((t[:-1] < 1.0) & (t[1:] >= 1.0)))
    result = tsm.solve(toggle, steps(20), STABLE)
    assert (result.index == 0).all()
    expected = np.interp(1.0, t[last : last + 2], apex[last : last + 2])
    assert result.tips["left"][-1, 1] == pytest.approx(expected, abs=2e-3)
    assert next(event for event in result.events if event.kind is tsm.EventKind.LIMIT_POINT).released > 0


def held(shortened, *, height=0.02, turn=0.0, aside=0.0, angle=0.0, elements=1):
    """Beam of unit length at an angle, clamped at both ends, of which one is moved."""
    section = tsm.Section.rectangle(width=height, height=height, youngs_modulus=1e7, shear_modulus=1e7 / 2.6)
    along = np.array([np.cos(angle), np.sin(angle)])
    moved = -shortened * along + aside * along[::-1] * [-1, 1]
    element = "exact" if elements < 10 else "mixed"
    end = tsm.Support(beam="b", end="end", ux=moved[0], uy=moved[1], rotation=turn)
    return tsm.Structure(
        beams=(beam("b", (0, 0), tuple(along), section=section, elements=elements, element=element),),
        supports=(tsm.Support(beam="b", end="start"), end),
    )


@pytest.mark.parametrize(("angle", "elements", "count"), [(0.0, 20, 20), (2.0, 2, 3)])
def test_a_symmetric_bifurcation_turns_to_the_left(angle, elements, count):
    """To the side to which the mode goes first, seen from start to end; at .00437433, by name."""
    structure = held(0.3, aside=0.01, angle=angle, elements=elements)
    stopped = tsm.solve(structure, steps(count), throw=False)
    assert stopped.status is tsm.Status.BIFURCATION
    assert stopped.critical[0].load_parameter == pytest.approx(0.004374326, rel=2e-5)
    result = tsm.solve(structure, steps(count), STABLE)
    left = np.array([-np.sin(angle), np.cos(angle)])
    shape, mode = result.axis_line("b", -1)[1] @ left, result.critical[0].mode["b"] @ left
    assert mode[len(mode) // 2] > 0.9
    assert shape.max() > 0.3
    assert shape.min() > -0.02


@pytest.mark.parametrize(("element", "count"), [("mixed", 12), ("exact", 1)])
def test_a_beam_on_a_drum_ends_where_it_bends_as_the_drum_does(element, count):
    """Clamp, drum of radius .5 under x = .3, dead load at the tip, a beam that stretches: the curvature at the drum is 1/(R + h/2)."""
    section = tsm.Section(EA=200.0, GA=1e6, EI=1.0)
    load, path = tsm.Load(beam="b", end="end", force=(0.0, -12.0)), ((0.3, -0.5025), (0.3, -0.5025 + 1e-9))
    elements = 1 if element == "exact" else 20
    structure = cantilever(
        path, section=section, element=element, elements=elements, load=load, offset=0.5025
    )
    result = tsm.solve(structure, steps(count), throw=False)
    assert result.status is tsm.Status.LINE_CONTACT
    (event,) = [event for event in result.events if event.kind is tsm.EventKind.LINE_CONTACT]
    # the tail beyond the drum is a cantilever under its dead load: its moment bends a stretched axis as the drum where it leaves it
    arc, line = tsm.solve(structure, [event.load_parameter - 1e-9]).axis_line("b", 0, 200)
    (x, _), slope = (
        [np.interp(event.arc_position, arc, c) for c in of.T] for of in (line, np.gradient(line, arc, axis=0))
    )
    force = 12.0 * event.load_parameter
    stretch = -force * slope[1] / np.hypot(*slope) / section.EA
    assert force * (line[-1, 0] - x) / section.EI / (1 + stretch) == pytest.approx(1 / 0.5025, rel=5e-3)

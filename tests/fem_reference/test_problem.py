import numpy as np
import pytest

import fem_reference as fr

NAN = float("nan")


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("height", -0.02),
        ("width", 0.0),
        ("youngs_modulus", NAN),
        ("poissons_ratio", 0.5),
        ("poissons_ratio", -1.0),
        ("start", (NAN, 0.0)),
        ("end", (0.0, 0.0)),
        ("clamped", ("start", "end")),
        ("clamped", ()),
        ("clamp", "hinge"),
        ("mesh", (1, 1)),
        ("mesh", (4, 0)),
        ("mesh", (4.5, 1)),
        ("material", "rubber"),
        ("plane", "stretch"),
        ("element", "Q3"),
        ("grading", -1.0),
    ],
)
def test_strip_refuses_and_names_the_field(strip, field, value):
    with pytest.raises(ValueError, match=rf"Strip\('cantilever'\)\.{field} = .*: must"):
        strip(**{field: value})


@pytest.mark.parametrize("path", [((0.0, 0.0),), ((1.0, 0.0), (1.0, 0.0)), ((1.0, NAN), (0.0, 0.0))])
def test_pin_refuses_a_path_without_length(path):
    with pytest.raises(ValueError, match=r"Pin\('pin'\)\.path = .*: must"):
        fr.Pin(name="pin", path=path)


def test_pin_runs_at_constant_speed():
    pin = fr.Pin(name="pin", path=((0.0, 0.0), (3.0, 0.0), (3.0, 1.0)))
    np.testing.assert_allclose(pin.position(0.375), [1.5, 0.0])
    np.testing.assert_allclose(pin.position(0.875), [3.0, 0.5])


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("side", "up"),
        ("surface", "top"),
        ("penalty", 0.0),
        ("penalty", float("inf")),
        ("penetration", 0.0),
        ("spread", -1.0),
    ],
)
def test_contact_refuses_and_names_the_field(problem, field, value):
    with pytest.raises(ValueError, match=rf"Contact\('pin->cantilever'\)\.{field} = .*: must"):
        problem(contact={field: value})


@pytest.mark.parametrize("radius", [-0.1, NAN])
def test_pin_refuses_a_radius(radius):
    with pytest.raises(ValueError, match=r"Pin\('pin'\)\.radius = .*: must"):
        fr.Pin(name="pin", path=((0.0, 0.0), (1.0, 0.0)), radius=radius)


@pytest.mark.parametrize(
    ("side", "surface", "y"),
    [("right", "axis", 0.01), ("left", "axis", -0.01), ("right", "face", 0.0), ("left", "face", 0.0)],
)
def test_problem_refuses_a_pin_that_starts_on_the_wrong_side(problem, side, surface, y):
    with pytest.raises(ValueError, match=r"Pin\('pin'\)\.path\[0\] = .*must not start beyond"):
        problem(path=((0.5, y), (0.5, 1.0)), contact={"side": side, "surface": surface})


@pytest.mark.parametrize(
    ("contact", "rule"),
    [
        ({"strip": "beam"}, "strip = 'beam': must name a strip"),
        ({"node": "nail"}, "node = 'nail': must name a pin"),
        ({"node": "cantilever.end"}, "node = 'cantilever.end': must name a pin"),
    ],
)
def test_problem_refuses_a_contact_that_names_nothing(problem, contact, rule):
    with pytest.raises(ValueError, match=rule):
        problem(contact=contact)


def test_problem_refuses_names_that_appear_twice(strip):
    with pytest.raises(ValueError, match=r"strips = 'cantilever': must not appear twice"):
        fr.SolidProblem(strips=(strip(), strip()))


def test_problem_refuses_an_end_that_starts_beyond_the_other_strip(strip):
    upper = strip(name="upper", start=(0.0, 0.1), end=(1.0, 0.1))
    contact = fr.Contact(node="upper.end", strip="cantilever", side="right")
    with pytest.raises(
        ValueError, match=r"Contact\('upper.end->cantilever'\)\.node = .*must not start beyond"
    ):
        fr.SolidProblem(strips=(strip(end=(2.0, 0.0)), upper), contacts=(contact,))


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("tolerance", 0.0),
        ("min_step", 1.0),
        ("balance_tolerance", NAN),
        ("max_iterations", 0),
        ("predictor_order", -1),
        ("max_attempts", 0),
        ("largest_growth", 0.5),
        ("max_penetration", 2.0),
    ],
)
def test_settings_refuse_and_name_the_field(field, value):
    with pytest.raises(ValueError, match=rf"Settings\.{field} = .*: must"):
        fr.Settings(**{field: value})


@pytest.mark.parametrize("loads", [[], [0.0, 1.0], [0.5, 0.5], [0.5, 1.1], [0.5, NAN], [[0.5, 1.0]]])
def test_solve_refuses_load_parameters_out_of_order(problem, loads):
    with pytest.raises(ValueError, match=r"load_parameters = .*: must"):
        fr.solve(problem(), np.array(loads))


def test_default_penalty_is_about_1e4_for_the_ks_strip(strip):
    assert fr.default_penalty(strip()) == pytest.approx(1.05e4)

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
    ("field", "value"), [("side", "up"), ("surface", "top"), ("penalty", 0.0), ("penalty", float("inf"))]
)
def test_contact_refuses_and_names_the_field(problem, field, value):
    with pytest.raises(ValueError, match=rf"Contact\('pin->cantilever'\)\.{field} = .*: must"):
        problem(**{field: value})


@pytest.mark.parametrize(
    ("side", "surface", "y"),
    [("right", "axis", 0.01), ("left", "axis", -0.01), ("right", "face", 0.0), ("left", "face", 0.0)],
)
def test_problem_refuses_a_pin_that_starts_on_the_wrong_side(problem, side, surface, y):
    with pytest.raises(ValueError, match=r"Pin\('pin'\)\.path\[0\] = .*must not start beyond"):
        problem(path=((0.5, y), (0.5, 1.0)), side=side, surface=surface)


def test_problem_refuses_a_contact_that_names_nothing(strip):
    pin = fr.Pin(name="pin", path=((1.0, 0.0), (0.0, 1.0)))
    with pytest.raises(ValueError, match="must name the problem's strip"):
        fr.SolidProblem(strip=strip(), pin=pin, contact=fr.Contact(pin="pin", strip="beam", penalty=1.0))
    with pytest.raises(ValueError, match="must name the problem's pin"):
        fr.SolidProblem(
            strip=strip(), pin=pin, contact=fr.Contact(pin="nail", strip="cantilever", penalty=1.0)
        )


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("tolerance", 0.0),
        ("min_step", 1.0),
        ("balance_tolerance", NAN),
        ("max_iterations", 0),
        ("predictor_order", -1),
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

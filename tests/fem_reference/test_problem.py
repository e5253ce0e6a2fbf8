import numpy as np
import pytest

import fem_reference as fr
from tests.fem_reference.conftest import STRIP, make_problem, make_strip

NAN = float("nan")


def pin(**values):
    return fr.Pin(**({"name": "pin", "path": ((0.0, 0.0), (1.0, 0.0))} | values))


def contact(**values):
    return make_problem(contact=values)


def load(**values):
    given = {"strip": STRIP, "force": (1.0, 0.0)} | values
    return fr.SolidProblem(strips=(make_strip(),), loads=(fr.EndLoad(**given),))


def support(**values):
    return fr.Support(**({"strip": STRIP, "end": "start"} | values))


REFUSED = {
    (make_strip, r"Strip\('cantilever'\)"): {
        "height": [-0.02],
        "width": [0.0],
        "youngs_modulus": [NAN],
        "poissons_ratio": [0.5, -1.0],
        "start": [(NAN, 0.0)],
        "end": [(0.0, 0.0)],
        "clamped": [("middle",), ("end", "start")],
        "clamp": ["hinge"],
        "mesh": [(1, 1), (4, 0), (4.5, 1)],
        "material": ["rubber"],
        "plane": ["stretch"],
        "element": ["Q3"],
        "grading": [-1.0],
    },
    (pin, r"Pin\('pin'\)"): {
        "path": [(), ((1.0, 0.0), (1.0, 0.0)), ((1.0, NAN), (0.0, 0.0))],
        "radius": [-0.1, NAN],
    },
    (contact, r"Contact\('.*'\)"): {
        "side": ["up"],
        "surface": ["top"],
        "penalty": [0.0, float("inf")],
        "penetration": [0.0],
        "spread": [-1.0],
        "strip": ["beam"],
        "node": ["nail", "cantilever.end"],
    },
    (load, r"EndLoad\('.*'\)"): {
        "strip": ["nobody"],
        "force": [(0.0, 0.0), (np.inf, 0.0)],
        "moment": [NAN],
        "end": ["middle", "start"],
    },
    (support, r"Support\('.*'\)"): {
        "end": ["middle"],
        "motion": [(None, None, None), (0.0, NAN, None), (0.0, 0.0)],
    },
    (fr.Joint, r"Joint\(\(.*\)\)"): {"ends": [("a.end",), ("a.end", "a.end")]},
    (fr.Settings, "Settings"): {
        "tolerance": [0.0],
        "min_step": [1.0],
        "balance_tolerance": [NAN],
        "first_step": [1.5],
        "largest_departure": [1.5],
        "max_penetration": [2.0],
        "max_iterations": [0],
        "max_attempts": [0],
        "predictor_order": [-1],
        "largest_growth": [0.5],
        "branch": ["other"],
    },
}


@pytest.mark.parametrize(
    ("make", "owner", "field", "value"),
    [
        (make, owner, field, value)
        for (make, owner), fields in REFUSED.items()
        for field, values in fields.items()
        for value in values
    ],
)
def test_bad_value_is_refused_by_owner_and_field(make, owner, field, value):
    with pytest.raises(ValueError, match=rf"^{owner}\.{field} = .*: must") as caught:
        make(**{field: value})
    assert len(str(caught.value).splitlines()) == 1


def test_pin_runs_at_constant_speed():
    bent = fr.Pin(name="pin", path=((0.0, 0.0), (3.0, 0.0), (3.0, 1.0)))
    np.testing.assert_allclose(bent.position(0.375), [1.5, 0.0])
    np.testing.assert_allclose(bent.position(0.875), [3.0, 0.5])


@pytest.mark.parametrize(
    ("side", "surface", "y"),
    [("right", "axis", 0.01), ("left", "axis", -0.01), ("right", "face", 0.0), ("left", "face", 0.0)],
)
def test_problem_refuses_a_pin_that_starts_on_the_wrong_side(problem, side, surface, y):
    with pytest.raises(ValueError, match=r"Pin\('pin'\)\.path\[0\] = .*must not start beyond"):
        problem(path=((0.5, y), (0.5, 1.0)), contact={"side": side, "surface": surface})


def test_problem_refuses_names_that_appear_twice(strip):
    with pytest.raises(ValueError, match=r"strips = 'cantilever': must not appear twice"):
        fr.SolidProblem(strips=(strip(), strip()))


def test_problem_refuses_an_end_that_starts_beyond_the_other_strip(strip):
    upper = strip(name="upper", start=(0.0, 0.1), end=(1.0, 0.1))
    end = fr.Contact(node="upper.end", strip=STRIP, side="right")
    with pytest.raises(ValueError, match=r"Contact\('upper.end->cantilever'\)\.node = .*must not start be"):
        fr.SolidProblem(strips=(strip(end=(2.0, 0.0)), upper), contacts=(end,))


@pytest.mark.parametrize("loads", [[], [0.0, 1.0], [0.5, 0.5], [0.5, 1.1], [0.5, NAN], [[0.5, 1.0]]])
def test_solve_refuses_load_parameters_out_of_order(problem, loads):
    with pytest.raises(ValueError, match=r"load_parameters = .*: must"):
        fr.solve(problem(), np.array(loads))


def test_default_penalty_is_about_1e4_for_the_ks_strip(strip):
    assert fr.default_penalty(strip()) == pytest.approx(1.05e4)

"""Bad data is refused in one line that names owner, field and rule."""

import re
from functools import partial

import numpy as np
import pytest

import fem_reference as fr
from tests.fem_reference.conftest import STRIP, held, load, make_problem, make_strip, support

NAN, INF = float("nan"), float("inf")


def contact(**values):
    return make_problem(contact=values)


def loaded(**values):
    return held(load(**({"force": (1.0, 0.0)} | values)), clamped=("start",))


pin = partial(fr.Pin, name="pin", path=((0.0, 0.0), (1.0, 0.0)))
spring = partial(fr.Spring, strip="s", end="end", stiffness=(1.0, 0.0, 0.0))
line = partial(fr.LineLoad, strip="s", force=((0.0, 1.0),))
point = partial(fr.PointLoad, strip="s", at=0.5, force=(0.0, 1.0))
joint = partial(fr.Joint, ends=("a.end", "b.end"))


REFUSED = {
    (make_strip, r"Strip\('cantilever'\)"): {
        "height": [-0.02],
        "end_height": [0.0],
        "width": [0.0],
        "youngs_modulus": [NAN],
        "poissons_ratio": [0.5, -1.0],
        "start": [(NAN, 0.0)],
        "end": [(0.0, 0.0)],
        "turn": [6.3],
        "clamped": [("middle",), ("end", "start")],
        "clamp": ["hinge"],
        "mesh": [(1, 1), (4, 0), (4.5, 1), (10**12, 1), (10**400, 1), (2, 500)],
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
        "penalty": [0.0, INF],
        "penetration": [0.0],
        "spread": [-1.0],
        "friction": [-0.1, NAN, INF],
        "strip": ["beam"],
        "node": ["nail", "cantilever.end"],
    },
    (loaded, r"EndLoad\('.*'\)"): {
        "strip": ["nobody"],
        "force": [(0.0, 0.0), (INF, 0.0)],
        "moment": [NAN],
        "end": ["middle", "start"],
        "stage": [-1],
    },
    (support, r"Support\('.*'\)"): {
        "end": ["middle"],
        "motion": [(None, None, None), (0.0, NAN, None), (0.0, 0.0)],
        "onward": [((0.0, 0.0),)],
    },
    (spring, r"Spring\('.*'\)"): {"stiffness": [(-1.0, 0.0, 0.0)]},
    (line, r"LineLoad\('s'\)"): {"force": [((0.0, 0.0),)], "part": [(0.5, 0.5)], "stage": [-1]},
    (point, r"PointLoad\('s'\)"): {"at": [1.0], "force": [(0.0, 0.0)], "moment": [NAN]},
    (joint, r"Joint\(\(.*\)\)"): {
        "ends": [("a.end",), ("a.end", "a.end")],
        "hinged": [("c.end",), ("a.end",)],
    },
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


@pytest.mark.parametrize(("make", "owner"), REFUSED)
def test_bad_value_is_refused_by_owner_and_field(make, owner):
    for field, values in REFUSED[make, owner].items():
        for value in values:
            with pytest.raises(ValueError, match=rf"^{owner}\.{field} = .*: must") as caught:
                make(**{field: value})
            assert len(str(caught.value).splitlines()) == 1


def hinged_chain():
    halves = (
        make_strip(name="a", end=(0.5, 0.0), clamped=()),
        make_strip(name="b", start=(0.5, 0.0), clamped=()),
    )
    supports = (
        fr.Support(strip="a", end="start", motion=(0.0, 0.0, None)),
        fr.Support(strip="b", end="end", motion=(None, 0.0, None)),
    )
    joints = (joint(ends=("a.end", "b.start"), hinged=("b.start",)),)
    return fr.SolidProblem(strips=halves, supports=supports, joints=joints)


def joint_apart():
    other = make_strip(name="other", start=(1.0, 0.1), end=(2.0, 0.1))
    return fr.SolidProblem(
        strips=(make_strip(), other), joints=(joint(ends=(f"{STRIP}.end", "other.start")),)
    )


def end_beyond():
    upper = make_strip(name="upper", start=(0.0, 0.1), end=(1.0, 0.1))
    end = fr.Contact(node="upper.end", strip=STRIP, side="right")
    return fr.SolidProblem(strips=(make_strip(end=(2.0, 0.0)), upper), contacts=(end,))


def pin_beyond(y, **values):
    return make_problem(path=((0.5, y), (0.5, 1.0)), contact=values)


HINGE = support(motion=(0.0, 0.0, None))
TOGETHER = {
    "SolidProblem.strips = 'cantilever': must not appear twice": lambda: fr.SolidProblem(
        strips=(make_strip(),) * 2
    ),
    "SolidProblem.supports = .*: must hold": lambda: held(support(motion=(0.0, None, 0.0))),
    "SolidProblem.supports = .*: must .*": lambda: held(HINGE, support("end", (0.0, None, None))),
    "SolidProblem.supports = .*: must not appear twice": lambda: held(support(), support()),
    "SolidProblem.supports = .*: must hold a, b": hinged_chain,
    "Support.*end = 'start': must not be a clamped end": lambda: held(support(), clamped=("start",)),
    "EndLoad.*end = 'start': must not be a clamped end": lambda: loaded(end="start"),
    "ends = 'other.start': must be an end without a clamp, at the pos": joint_apart,
    "strip = 's': must name a strip": lambda: held(point(), clamped=("start",)),
    "turn = 2.0: must leave the radius": lambda: make_strip(turn=2.0, height=1.3),
    "turn = 1.0: must be zero with a mesh file": lambda: make_strip(turn=1.0, mesh_file="a.msh"),
    "Contact('upper.end->cantilever').node = .*must not start be": end_beyond,
    "Pin('pin').path[0] = .*must not start beyond the right axis": lambda: pin_beyond(0.01),
    "Pin('pin').path[0] = .*must not start beyond the left axis": lambda: pin_beyond(-0.01, side="left"),
    "Pin('pin').path[0] = .*must not start beyond the right face": lambda: pin_beyond(0.0, surface="face"),
    "Pin('pin').path[0] = .*must not start beyond the left face": lambda: pin_beyond(
        0.0, side="left", surface="face"
    ),
}


@pytest.mark.parametrize("message", TOGETHER)
def test_data_that_do_not_fit_are_refused_in_one_line(message):
    pattern = ".*".join(re.escape(part) for part in message.split(".*"))
    with pytest.raises(ValueError, match=pattern) as caught:
        TOGETHER[message]()
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize("parameters", [[], [0.0, 1.0], [0.5, 0.5], [0.5, 1.1], [0.5, NAN], [[0.5, 1.0]]])
def test_solve_refuses_load_parameters_out_of_order(parameters):
    with pytest.raises(ValueError, match=r"load_parameters = .*: must"):
        fr.solve(make_problem(), np.array(parameters))


def test_default_penalty_is_about_1e4_for_the_ks_strip():
    assert fr.default_penalty(make_strip()) == pytest.approx(1.05e4)

"""Bad data is refused in one line that names owner, field and rule."""

import re
from functools import partial

import numpy as np
import pytest

import fem_reference as fr
from tests.fem_reference.strips import STRIP, held, load, make_problem, make_strip, support

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
        "youngs_modulus": [NAN],
        "poissons_ratio": [0.5, -1.0],
        "start": [(NAN, 0.0)],
        "end": [(0.0, 0.0)],
        "turn": [6.3],
        "clamped": [("middle",)],
        "clamp": ["hinge"],
        "mesh": [(1, 1), (4.5, 1), (10**400, 1), (2, 500)],
        "material": ["rubber"],
    },
    (pin, r"Pin\('pin'\)"): {"path": [(), ((1.0, 0.0), (1.0, 0.0)), ((1.0, NAN), (0.0, 0.0))]},
    (contact, r"Contact\('.*'\)"): {
        "side": ["up"],
        "penalty": [0.0, INF],
        "spread": [-1.0],
        "strip": ["beam"],
        "node": ["nail", "cantilever.end"],
    },
    (loaded, r"PointLoad\('.*'\)"): {
        "strip": ["nobody"],
        "force": [(0.0, 0.0)],
        "at": [0.0, 1.1],
        "stage": [-1],
    },
    (support, r"Support\('.*'\)"): {"motion": [(None, None, None), (0.0, 0.0)], "onward": [((0.0, 0.0),)]},
    (spring, r"Spring\('.*'\)"): {"stiffness": [(-1.0, 0.0, 0.0)]},
    (line, r"LineLoad\('s'\)"): {"force": [((0.0, 0.0),)], "part": [(0.5, 0.5)]},
    (point, r"PointLoad\('s at .*'\)"): {"at": [-0.1], "force": [(0.0, 0.0)]},
    (joint, r"Joint\(\(.*\)\)"): {
        "ends": [("a.end",), ("a.end", "a.end")],
        "hinged": [("c.end",), ("a.end",)],
    },
    (fr.Settings, "Settings"): {
        "tolerance": [0.0],
        "min_step": [1.0],
        "max_iterations": [0],
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


def joint_apart():
    other = make_strip(name="other", start=(1.0, 0.1), end=(2.0, 0.1))
    return fr.SolidProblem(
        strips=(make_strip(), other), joints=(joint(ends=(f"{STRIP}.end", "other.start")),)
    )


def end_beyond():
    upper = make_strip(name="upper", start=(0.0, 0.1), end=(1.0, 0.1))
    end = fr.Contact(node="upper.end", strip=STRIP, side="right")
    return fr.SolidProblem(strips=(make_strip(end=(2.0, 0.0)), upper), contacts=(end,))


HINGE = support(motion=(0.0, 0.0, None))
TOGETHER = {
    "SolidProblem.strips = 'cantilever': must not appear twice": lambda: fr.SolidProblem(
        strips=(make_strip(),) * 2
    ),
    "SolidProblem.supports = .*: must hold": lambda: held(support(motion=(0.0, None, 0.0))),
    "SolidProblem.supports = .*: must .*": lambda: held(HINGE, support("end", (0.0, None, None))),
    "SolidProblem.supports = .*: must not appear twice": lambda: held(support(), support()),
    "Support.*end = 'start': must not be a clamped end": lambda: held(support(), clamped=("start",)),
    "ends = 'other.start': must be an end without a clamp, at the pos": joint_apart,
    "turn = 2.0: must leave the radius": lambda: make_strip(turn=2.0, height=1.3),
    "turn = 1.0: must be zero with a mesh file": lambda: make_strip(turn=1.0, mesh_file="a.msh"),
    "Contact('upper.end->cantilever').node = .*must not start be": end_beyond,
    "Pin('pin').path[0] = .*must not start beyond the right axis": lambda: make_problem(
        path=((0.5, 0.01), (0.5, 1.0))
    ),
}


@pytest.mark.parametrize("message", TOGETHER)
def test_data_that_do_not_fit_are_refused_in_one_line(message):
    pattern = ".*".join(re.escape(part) for part in message.split(".*"))
    with pytest.raises(ValueError, match=pattern) as caught:
        TOGETHER[message]()
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize("parameters", [[], [0.5, 0.5], [0.5, NAN], [[0.5, 1.0]]])
def test_solve_refuses_load_parameters_out_of_order(parameters):
    with pytest.raises(ValueError, match=r"load_parameters = .*: must"):
        fr.solve(make_problem(), np.array(parameters))

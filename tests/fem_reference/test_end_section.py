"""End sections as control points: patch tests, reactions, joints, stages, and the buckling loads of columns."""

import numpy as np
import pytest
from scipy.optimize import brentq

import fem_reference as fr
from tests.fem_reference.conftest import (
    CLAMP,
    EA,
    EI,
    NU,
    PAIR,
    STRIP,
    TIP,
    B,
    E,
    held,
    load,
    loads,
    make_problem,
    make_strip,
    rotation,
    support,
)


def poses(result, k=-1):
    """Displacement and rotation of the start and the end of a strip with one row of biquadratic elements."""
    line, found = fr.axis_line(result, STRIP, k), {}
    at_rest = result.mesh_points
    for end, x in (("start", 0.0), ("end", 1.0)):
        low, high = (np.flatnonzero((at_rest == [x, y]).all(axis=1))[0] for y in (-0.01, 0.01))
        a, b = (
            (at_rest[high] - at_rest[low]),
            np.diff((at_rest + result.displacement[k])[[low, high]], axis=0)[0],
        )
        moved = line[0 if end == "start" else -1] - [x, 0.0]
        found[end] = (*moved, np.arctan2(a[0] * b[1] - a[1] * b[0], a @ b))
    return found


@pytest.mark.parametrize(
    "changes",
    [
        {"element": "Q1", "material": "biot-linear"},
        {"element": "Q2-full", "material": "neo-hookean"},
        {"element": "Q2"},
        {"turn": 1.5, "end_height": 0.04},
    ],
)
def test_a_rigid_rotation_of_the_control_point_gives_no_stress(changes):
    """Turned by two thirds of a turn in one support: the strip follows, without energy and reaction."""
    motion = (0.3, -0.2, -4 * np.pi / 3)
    result = fr.solve(held(support(motion=motion), mesh=(6, 1), **changes), loads(2))
    places = result.mesh_points @ rotation(motion[2]).T + motion[:2]
    np.testing.assert_allclose(result.mesh_points + result.displacement[-1], places, atol=1e-9)
    assert sum(fr.energy(result, -1)) < 1e-11 * EI
    assert np.abs(result.supports[CLAMP].force).max() < 1e-9 * EI
    assert np.abs(result.supports[CLAMP].moment).max() < 1e-9 * EI
    assert np.all(result.index == 0)


@pytest.mark.parametrize("element", ["Q2", "Q2-full"])
@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("clamped", [(), ("start",)])
def test_a_moment_gives_pure_bending_in_small_strain(element, plane, clamped):
    """The rate at rest is the exact field ``(-x y, x^2 / 2 + nu' y^2 / 2)`` of curvature M / EI, to 1e-10.

    It is extrapolated from four moments. The strip is stocky, since the round-off of its stiffness grows with L/h.
    """
    height, modulus = 0.2, {"stress": E, "strain": E / (1 - NU**2)}[plane]
    stiffness = modulus * B * height**3 / 12
    changes = {"element": element, "plane": plane, "clamped": clamped, "mesh": (8, 2), "height": height}
    held_by, exactly = () if clamped else (support(),), fr.Settings(tolerance=1e-13)
    bent = [
        fr.solve(held(*held_by, load(moment=sign * 2e-3 * stiffness), **changes), loads(2), exactly)
        for sign in (1, -1)
    ]
    one, two = (bent[0].displacement - bent[1].displacement) / 2
    rate = (8 * one - two) / 6 / 1e-3
    x, y = bent[0].mesh_points.T
    nu = {"stress": NU, "strain": NU / (1 - NU)}[plane]
    mean = 0.0 if clamped else height**2 / 12
    exact = np.stack([-x * y, x**2 / 2 + nu * (y**2 - mean) / 2], axis=1)
    np.testing.assert_allclose(rate, exact, rtol=0, atol=1e-10 * np.abs(exact).max())


BALANCED = {
    "moment and force at the tip": (support(), load(force=(-4 * EI, EI), moment=EI)),
    "moving clamp": (support(), support("end", (-0.2, 0.1, 1.0))),
    "pinned and pinned": (
        support(motion=(0.0, 0.0, None)),
        support("end", (-0.1, 0.0, None)),
        load(moment=EI),
    ),
    "pinned and roller": (
        support(motion=(0.0, 0.0, None)),
        support("end", (None, 0.1, None)),
        load(moment=EI),
    ),
    "rotation held": (support(), support("end", (None, None, 1.0)), load(force=(0.0, EI))),
}


@pytest.mark.slow_at("moving clamp", "pinned and pinned")
@pytest.mark.parametrize("case", BALANCED)
def test_reactions_balance_the_loads(case):
    """Forces, and moments about the origin, to 1e-9 of the largest; the prescribed motions are met."""
    problem = held(*BALANCED[case], mesh=(30, 1))
    result = fr.solve(problem, loads(4))
    reached = poses(result)
    acting = [(item.end, item.force, item.moment) for item in problem.loads]
    for item in problem.supports:
        history = result.supports[item.node]
        acting.append((item.end, history.force[-1], history.moment[-1]))
        for value, found in zip(item.motion, reached[item.end], strict=True):
            if value is not None:
                assert found == pytest.approx(value, abs=1e-12)
    places = {end: np.add([float(end == "end"), 0.0], reached[end][:2]) for end in reached}
    force = sum(np.array(force) for _, force, _ in acting)
    moment = sum(m + places[end][0] * F[1] - places[end][1] * F[0] for end, F, m in acting)
    scale = max(EI, *(np.abs(F).max() for _, F, _ in acting))
    assert np.abs([*force, moment]).max() < 1e-9 * scale
    assert np.all(result.index == 0)


def test_a_moment_rolls_the_strip_up():
    """The tip turns by more than once round: M L / EI to a quarter of the square of twice the face's strain, ``kappa h``."""
    stiffness, turned = E * B * 0.002**3 / 12, 2.2 * np.pi
    problem = held(
        support(), load(moment=turned * stiffness), height=0.002, mesh=(80, 1), material="biot-linear"
    )
    result = fr.solve(problem, loads(5))
    tip = np.array([np.sin(turned), 1 - np.cos(turned)]) / turned
    np.testing.assert_allclose(result.tips[STRIP][-1], tip, atol=3e-5)
    line = fr.axis_line(result, STRIP, -1)
    ahead = np.diff(line[-2:], axis=0)[0]
    last = np.arctan2(ahead[1], ahead[0]) + turned / 160 / 2
    assert last == pytest.approx(turned - 2 * np.pi, abs=turned * (turned * 0.002) ** 2 / 4)
    assert result.supports[CLAMP].moment[-1] == pytest.approx(-turned * stiffness, rel=1e-9)


@pytest.mark.parametrize("clamp", ["rod", "full"])
def test_two_clamped_ends_of_one_strip_share_a_load_that_moves_neither(clamp):
    """A pin at the middle of a strip clamped at both ends: mirrored reactions, by edges and by sections."""
    forces = []
    for clamped, supports in ((("start", "end"), ()), ((), (support(), support("end")))):
        scene = make_problem(
            path=((0.5, 0.0), (0.5, 0.03)), mesh=(40, 1), clamp=clamp, clamped=("start", "end")
        )
        strip = make_strip(mesh=(40, 1), clamp=clamp, clamped=clamped)
        both = fr.SolidProblem(strips=(strip,), pins=scene.pins, contacts=scene.contacts, supports=supports)
        result = fr.solve(both, loads(3))
        first, second = result.supports[CLAMP], result.supports[TIP]
        np.testing.assert_allclose(first.force, second.force * [-1, 1], rtol=1e-7)
        np.testing.assert_allclose(first.moment, -second.moment, rtol=1e-7)
        forces.append(result.contacts[PAIR].force)
    np.testing.assert_allclose(*forces, rtol=2e-3)


@pytest.mark.parametrize("pushed", [{"moment": EI}, {"force": (0.0, EI)}])
def test_a_straight_joint_carries_on_the_strip(pushed):
    """A strip of two joined halves bends as one strip. The tractions of the joint are linear, those inside nearly."""
    whole = fr.SolidProblem(strips=(make_strip(name="b"),), loads=(fr.EndLoad(strip="b", **pushed),))
    halves = fr.SolidProblem(
        strips=(
            make_strip(name="a", end=(0.5, 0.0), mesh=(25, 2)),
            make_strip(name="b", start=(0.5, 0.0), clamped=(), mesh=(25, 2)),
        ),
        joints=(fr.Joint(ends=("a.end", "b.start")),),
        loads=whole.loads,
    )
    joined, single = (fr.solve(problem, loads(2)) for problem in (halves, whole))
    np.testing.assert_allclose(joined.tips["b"], single.tips["b"], atol=2e-6)
    np.testing.assert_allclose(joined.tips["a"][-1], fr.axis_line(single, "b", -1)[50], atol=2e-6)
    np.testing.assert_allclose(joined.tips["a"][-1], fr.axis_line(joined, "b", -1)[0], atol=1e-12)


def effective(P):
    """``P (1 + P (1/GA - 1/EA))``, the load of the Reissner column in Euler's formula [N]."""
    return P * (1 + P * (2 * (1 + NU) * 6 / 5 - 1) / EA)


def buckling_load(k):
    """``effective(P) = k^2 EI`` [N]."""
    return brentq(lambda P: effective(P) - k**2 * EI, 0, 2 * k**2 * EI)


COLUMNS = {
    "clamped at a section and free": (np.pi / 2, [1, 1], (0.0, 0.0, 0.0), None),
    "pinned and pinned": (np.pi, [1, 1], (0.0, 0.0, None), (None, 0.0, None)),
    "clamped and clamped": (2 * np.pi, [1, 2], (0.0, 0.0, 0.0), (None, 0.0, 0.0)),
}


@pytest.mark.parametrize("case", COLUMNS)
def test_column_ends_as_bifurcation_at_its_buckling_load(case):
    """``effective(P) = (k L)^2 EI`` but for .742 of the strain P/EA, whatever the supports; the index counts the modes."""
    k, modes, *motions = COLUMNS[case]
    P = buckling_load(k)
    ends = [support(end, motion) for end, motion in zip(("start", "end"), motions, strict=True) if motion]
    problem = held(*ends, load(force=(-3 * P, 0.0)), mesh=(32, 2), material="biot-linear")
    result = fr.solve(problem, loads(4), throw=False)
    assert result.status is fr.Status.BIFURCATION
    (point,) = result.critical
    assert (3 * point.load_parameter - 1) / (P / EA) == pytest.approx(0.742, abs=0.01)
    assert fr.solve(problem, loads(2), fr.Settings(branch="primary")).index.tolist() == modes


def test_a_pin_goes_on_from_where_it_is_at_constant_speed():
    pin = fr.Pin(
        name="p",
        path=((0.0, 0.0),),
        onward=(((1.0, 0.0), (1.0, 1.0)), (), ((0.0, 1.0),), ((0.0, 4.0), (1.0, 4.0))),
    )
    places = [pin.position(t).tolist() for t in (0.5, 1.0, 1.5, 2.0, 2.7, 3.5, 4.0, 4.375, 4.875)]
    assert places == [[0, 0], [0, 0], [1, 0], [1, 1], [1, 1], [0.5, 1], [0, 1], [0, 2.5], [0.5, 4]]
    assert pin.turns == (1.5, 4.75)


def staged():
    """A pin, a support and a load of every kind, moved in the first stage, and back in the third one."""
    there_and_back = [(sign, stage) for sign, stage in ((-1, 0), (1, 2))]
    conditions = [
        support(motion=(0.0, 0.02, 0.3), onward=((0.0, 0.0, 0.0), (0.0, -0.02, -0.3))),
        *(fr.LineLoad(strip=STRIP, force=((0.0, 3 * sign * EI),), stage=k) for sign, k in there_and_back),
        *(fr.PointLoad(strip=STRIP, at=0.6, force=(0.0, sign * EI), stage=k) for sign, k in there_and_back),
        *(load(moment=sign * EI / 2, stage=k) for sign, k in ((1, 1), (-1, 2))),
    ]
    one = held(*conditions, mesh=(20, 1))
    pin = fr.Pin(name="pin", path=((0.8, -0.001), (0.8, 0.1)), onward=((), ((0.8, -0.001),)))
    contact = fr.Contact(node="pin", strip=STRIP, penalty=1e4)
    return fr.SolidProblem(
        strips=one.strips,
        pins=(pin,),
        contacts=(contact,),
        supports=one.supports,
        loads=one.loads,
        inner_loads=one.inner_loads,
    )


def test_a_stage_leads_back_on_the_way_there():
    """What the first two stages have done, the third one undoes, and every state of it is in balance."""
    problem = staged()
    assert (problem.stages, problem.turns) == (3, (1.0, 2.0))
    result = fr.solve(problem, np.arange(1, 13) / 4)
    reaction = result.supports[CLAMP].force
    assert result.contacts[PAIR].force[3] > 0.01 * EI
    assert np.abs(result.displacement[-1]).max() < 1e-8
    assert np.abs(reaction[-1]).max() < 1e-8 * EI
    assert reaction[7, 1] != pytest.approx(reaction[3, 1], rel=1e-3)  # the moment of the second stage
    with pytest.raises(ValueError, match=r"must be a one-dimensional increasing array in \(0, 3\]"):
        fr.solve(problem, np.array([3.1]))


def test_one_stage_in_two_has_the_same_end():
    """Half a motion in each of two stages leads to the states of the whole motion."""
    whole = make_problem(path=((0.8, 0.0), (0.8, 0.2)), mesh=(20, 1))
    pin = fr.Pin(name="pin", path=((0.8, 0.0), (0.8, 0.1)), onward=(((0.8, 0.2),),))
    halves = fr.SolidProblem(strips=whole.strips, pins=(pin,), contacts=whole.contacts)
    one, two = fr.solve(whole, np.array([0.5, 1.0])), fr.solve(halves, np.array([1.0, 2.0]))
    np.testing.assert_allclose(two.contacts[PAIR].force, one.contacts[PAIR].force, rtol=1e-8)
    np.testing.assert_allclose(two.displacement, one.displacement, atol=1e-9)

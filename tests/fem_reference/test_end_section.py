"""End sections as control points: exact derivatives, patch tests, reactions, joints and stability of ties."""

import numpy as np
import pytest
from scipy.optimize import brentq

import fem_reference as fr
from fem_reference.model import build
from fem_reference.state import at_rest, build_state, imbalance, residual, tie_residuals
from fem_reference.strip import ELEMENTS
from fem_reference.tangent import linearise
from tests.fem_reference.conftest import (
    NU,
    STEP,
    STRIP,
    B,
    E,
    dense_hessian,
    loads,
    make_portal,
    make_strip,
    rotation,
)

START = f"{STRIP}.start"
EI = E * B * 0.02**3 / 12
elements = pytest.mark.parametrize("element", ELEMENTS)


def held(*conditions, **changes):
    """A strip without a clamp, with its supports and loads."""
    kinds = {fr.Support: "supports", fr.EndLoad: "loads"}
    found = {name: tuple(c for c in conditions if type(c) is kind) for kind, name in kinds.items()}
    return fr.SolidProblem(strips=(make_strip(**({"clamped": ()} | changes)),), **found)


def support(end="start", motion=(0.0, 0.0, 0.0)):
    return fr.Support(strip=STRIP, end=end, motion=motion)


@pytest.fixture(scope="module")
def loaded():
    """A frame with a moment and contact, away from equilibrium."""
    model = build(make_portal(fr.Pin(name="pin", path=((0.5, 0.83), (0.5, 0.7)))))
    last = fr.solve(model.problem, loads(2)).states[-1]
    return model, build_state(model, 1.01 * last.u, 0.9, last.conditions, 1.05 * last.tie_forces)


def test_tangent_is_the_derivative_of_the_residual(loaded):
    """By complex steps in drawn directions, with tie forces, a dead moment and a closed contact."""
    model, state = loaded
    A, _ = dense_hessian(model, state)
    rng = np.random.default_rng(2)
    for _ in range(5):
        x = rng.standard_normal(model.unknowns)
        u = state.u + 1j * STEP * (model.expansion @ x).reshape(-1, 2)
        moved = build_state(model, u, state.t, state.conditions, state.tie_forces)
        change = model.expansion.T @ residual(model, moved).imag.ravel() / STEP
        np.testing.assert_allclose(change, A @ x, rtol=0, atol=1e-12 * np.abs(change).max())


@elements
@pytest.mark.parametrize("material", ["st-venant-kirchhoff", "biot-linear", "neo-hookean"])
def test_a_rigid_rotation_of_the_control_point_gives_no_stress(element, material):
    """Turned by two thirds of a turn in one support: the strip follows, without energy and reaction."""
    motion = (0.3, -0.2, -4 * np.pi / 3)
    problem = held(support(motion=motion), element=element, material=material, mesh=(6, 1))
    result = fr.solve(problem, loads(2))
    body = result.model.bodies[0]
    places = (rotation(motion[2]) @ body.mesh.nodes.T).T + motion[:2]
    np.testing.assert_allclose(body.mesh.nodes + result.displacement[-1], places, atol=1e-9)
    assert result.model.strain_energy(result.states[-1].u) < 1e-11 * EI
    reaction = result.supports[START]
    assert np.abs(reaction.force).max() < 1e-9 * EI
    assert np.abs(reaction.moment).max() < 1e-9 * EI
    assert np.all(result.index == 0)


@pytest.mark.parametrize("element", ["Q2", "Q2-full"])
@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("clamped", [(), ("start",)])
def test_a_moment_gives_pure_bending_in_small_strain(element, plane, clamped):
    """The rate at rest is the exact field ``(-x y, x^2 / 2 + nu' y^2 / 2)`` of curvature M / EI, to 1e-10.

    The strip is stocky, since the round-off of its stiffness grows with L/h; at L/h = 50 it is 1e-8.
    """
    height = 0.2
    conditions = [fr.EndLoad(strip=STRIP, moment=1.0)]
    conditions += [] if clamped else [support()]
    nu = {"stress": NU, "strain": NU / (1 - NU)}[plane]
    modulus = {"stress": E, "strain": E / (1 - NU**2)}[plane]
    problem = held(*conditions, element=element, plane=plane, clamped=clamped, mesh=(8, 2), height=height)
    model = build(problem)
    rate = linearise(model, at_rest(model)).rate(0.0, 1.0)
    x, y = model.bodies[0].mesh.nodes.T
    curvature = 12 / (modulus * B * height**3)
    mean = 0.0 if clamped else height**2 / 12
    exact = curvature * np.stack([-x * y, x**2 / 2 + nu * (y**2 - mean) / 2], axis=1)
    np.testing.assert_allclose(rate.u, exact, rtol=0, atol=1e-10 * np.abs(exact).max())
    if not clamped:
        np.testing.assert_allclose(rate.forces, [0, 0, -1], atol=1e-10)


CASES = {
    "moment and force at the tip": (support(), fr.EndLoad(strip=STRIP, force=(-4 * EI, EI), moment=EI)),
    "moving clamp": (support(), support("end", (-0.2, 0.1, 1.0))),
    "pinned and pinned": (
        support(motion=(0.0, 0.0, None)),
        support("end", (-0.1, 0.0, None)),
        fr.EndLoad(strip=STRIP, moment=EI),
    ),
    "pinned and roller": (
        support(motion=(0.0, 0.0, None)),
        support("end", (None, 0.1, None)),
        fr.EndLoad(strip=STRIP, moment=EI),
    ),
    "rotation held": (support(), support("end", (None, None, 1.0)), fr.EndLoad(strip=STRIP, force=(0.0, EI))),
}


@pytest.mark.slow_at("moving clamp", "pinned and pinned")
@pytest.mark.parametrize("case", CASES)
def test_reactions_balance_the_loads(case):
    """Forces, and moments about the origin, to 1e-9 of the largest; the prescribed motions are met."""
    problem = held(*CASES[case], mesh=(30, 1))
    result = fr.solve(problem, loads(4))
    t, force, moment, scale = 1.0, np.zeros(2), 0.0, EI
    sections = {section.node: section for section in result.model.sections}
    poses = dict(zip(sections, result.states[-1].poses, strict=True))
    for load in problem.loads:
        line = fr.axis_line(result, STRIP, -1)[-1]
        force += t * np.array(load.force)
        moment += t * (load.moment + line[0] * load.force[1] - line[1] * load.force[0])
    for item in problem.supports:
        history, pose = result.supports[item.node], poses[item.node]
        place = sections[item.node].position + pose.displacement
        force += history.force[-1]
        moment += history.moment[-1] + place[0] * history.force[-1, 1] - place[1] * history.force[-1, 0]
        scale = max(scale, np.abs(history.force[-1]).max())
        for value, reached in zip(item.motion, pose.motion, strict=True):
            if value is not None:
                assert reached == pytest.approx(value, abs=1e-12)
    assert np.abs([*force, moment]).max() < 1e-9 * scale
    assert imbalance(result.model, result.states[-1]) < 1e-9 * scale
    assert np.all(result.index == 0)


def test_a_moment_rolls_the_strip_up():
    """The tip turns by more than once round: M L / EI to a quarter of the square of twice the face's strain, ``kappa h``."""
    thin = {"height": 0.002, "mesh": (80, 1), "material": "biot-linear"}
    stiffness = E * B * 0.002**3 / 12
    problem = held(support(), fr.EndLoad(strip=STRIP, moment=2.2 * np.pi * stiffness), **thin)
    result = fr.solve(problem, loads(5))
    turned = 2.2 * np.pi
    tip = np.array([np.sin(turned), 1 - np.cos(turned)]) / turned
    np.testing.assert_allclose(result.tips[STRIP][-1], tip, atol=3e-5)
    rotated = result.states[-1].poses[-1].rotation
    assert rotated == pytest.approx(turned - 2 * np.pi, abs=turned * (turned * 0.002) ** 2 / 4)
    assert result.supports[START].moment[-1] == pytest.approx(-2.2 * np.pi * stiffness, rel=1e-9)


@pytest.mark.parametrize("clamp", ["rod", "full"])
def test_two_clamped_ends_of_one_strip_share_a_load_that_moves_neither(clamp):
    """A pin at the middle of a strip clamped at both ends: mirrored reactions, by edges and by sections."""
    pin = fr.Pin(name="pin", path=((0.5, 0.0), (0.5, 0.03)))
    contact = fr.Contact(node="pin", strip=STRIP)
    both, tied = (
        fr.solve(
            fr.SolidProblem(
                strips=(make_strip(mesh=(40, 1), clamp=clamp, clamped=ends),),
                pins=(pin,),
                contacts=(contact,),
                supports=supports,
            ),
            loads(3),
        )
        for ends, supports in ((("start", "end"), ()), ((), (support(), support("end"))))
    )
    for result in (both, tied):
        first, second = result.supports[START], result.supports[f"{STRIP}.end"]
        np.testing.assert_allclose(first.force, second.force * [-1, 1], rtol=1e-7)
        np.testing.assert_allclose(first.moment, -second.moment, rtol=1e-7)
    pushed, other = (result.contacts["pin->cantilever"].force for result in (both, tied))
    np.testing.assert_allclose(pushed, other, rtol=2e-3)


def test_a_straight_joint_carries_on_the_strip():
    """A strip of two joined halves bends as one strip. The tractions of the joint are linear, those inside nearly."""
    for load in (fr.EndLoad(strip="b", moment=EI), fr.EndLoad(strip="b", force=(0, EI))):
        half = {"mesh": (25, 2)}
        halves = fr.SolidProblem(
            strips=(
                make_strip(name="a", end=(0.5, 0.0), **half),
                make_strip(name="b", start=(0.5, 0.0), clamped=(), **half),
            ),
            joints=(fr.Joint(ends=("a.end", "b.start")),),
            loads=(load,),
        )
        whole = fr.SolidProblem(strips=(make_strip(name="b"),), loads=(load,))
        joined, single = (fr.solve(problem, loads(2)) for problem in (halves, whole))
        np.testing.assert_allclose(joined.tips["b"], single.tips["b"], atol=2e-6)
        middle = fr.axis_line(single, "b", -1)[50]
        np.testing.assert_allclose(joined.tips["a"][-1], middle, atol=2e-6)
        assert np.abs(tie_residuals(joined.model, joined.states[-1])).max() < 1e-12


def test_rate_is_the_difference_of_two_answers():
    """Moving supports, joints, a dead load and a closed contact."""
    problem = make_portal(fr.Pin(name="pin", path=((0.5, 0.83), (0.5, 0.7))))
    t, h = 0.5, 1e-4
    low, at, high = fr.solve(problem, np.array([t - h, t, t + h]), fr.Settings(tolerance=1e-12)).states
    assert at.touches[0].closed
    rate = linearise(build(problem), at).rate(t - h, t + h)
    np.testing.assert_allclose(rate.u, (high.u - low.u) / (2 * h), atol=2e-5 * np.abs(rate.u).max())
    change = (high.tie_forces - low.tie_forces) / (2 * h)
    np.testing.assert_allclose(rate.forces[1:], change, atol=1e-4 * np.abs(change).max())


def effective(P, EA):
    """``P (1 + P (1/GA - 1/EA))``, the load of the Reissner column in Euler's formula [N]."""
    return P * (1 + P * (2 * (1 + NU) * 6 / 5 - 1) / EA)


COLUMNS = {
    "clamped at a section and free": (np.pi / 2, (0.0, 0.0, 0.0), None),
    "pinned and pinned": (np.pi, (0.0, 0.0, None), (None, 0.0, None)),
    "clamped and clamped": (2 * np.pi, (0.0, 0.0, 0.0), (None, 0.0, 0.0)),
}


@pytest.mark.parametrize("case", COLUMNS)
def test_column_ends_as_bifurcation_at_its_buckling_load(case):
    """``effective(P) = (k L)^2 EI`` but for .742 of the strain P/EA, whatever the supports; the index counts the modes."""
    k, *motions = COLUMNS[case]
    EA = E * B * 0.02
    P = brentq(lambda P: effective(P, EA) - k**2 * EI, 0, 2 * k**2 * EI)
    ends = [support(end, motion) for end, motion in zip(("start", "end"), motions, strict=True) if motion]
    load = fr.EndLoad(strip=STRIP, force=(-3 * P, 0.0))
    problem = held(*ends, load, mesh=(32, 2), material="biot-linear")
    result = fr.solve(problem, loads(4), throw=False)
    assert result.status is fr.Status.BIFURCATION
    (point,) = result.critical
    assert (3 * point.load_parameter - 1) / (P / EA) == pytest.approx(0.742, abs=0.01)
    passed = fr.solve(problem, loads(2), fr.Settings(branch="primary"))
    assert passed.index.tolist() == ([1, 2] if case == "clamped and clamped" else [1, 1])


@pytest.mark.parametrize(
    ("conditions", "field"),
    [
        ((support(motion=(0.0, None, 0.0)),), "supports"),
        ((support(motion=(0.0, 0.0, None)), support("end", (0.0, None, None))), "supports"),
        ((support(), support()), "supports"),
    ],
)
def test_problem_refuses_strips_that_can_move(conditions, field):
    with pytest.raises(ValueError, match=rf"SolidProblem\.{field} = .*: must"):
        held(*conditions)


def test_problem_refuses_conditions_of_a_clamped_end_and_joints_apart():
    for condition in (support(), fr.EndLoad(strip=STRIP, end="start", moment=1.0)):
        with pytest.raises(ValueError, match=r"end = 'start': must not be a clamped end"):
            held(condition, clamped=("start",))
    other = make_strip(name="other", start=(1.0, 0.1), end=(2.0, 0.1))
    with pytest.raises(
        ValueError, match=r"ends = 'other\.start': must be an end without a clamp, at the pos"
    ):
        fr.SolidProblem(
            strips=(make_strip(), other), joints=(fr.Joint(ends=(f"{STRIP}.end", "other.start")),)
        )

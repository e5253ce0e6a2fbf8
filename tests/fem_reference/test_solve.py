import numpy as np
import pytest
from scipy.integrate import simpson

import fem_reference as fr
from tests.fem_reference.conftest import CLAMP, PAIR, STRIP, B, E, loads, rotation, surfaces

EI, GA = E * B**4 / 12, E / 2.6 * B**2 * 5 / 6
# The Reissner rod on the KS path: force [N] and arc position [m] by load parameter (theory, section 7).
ROD = {
    "axis": {
        0.1: (7.279980308998e-05, 0.9026989400),
        0.25: (2.971723827275e-04, 0.7700720074),
        0.5: (1.304991984260e-03, 0.6126214853),
        0.75: (2.717905910938e-03, 0.6155108916),
        1.0: (2.288274307175e-03, 0.8960220975),
    },
    "face": {
        0.1: (7.299229040762e-05, 0.9016399646),
        0.25: (2.999095335254e-04, 0.7669419948),
        0.5: (1.346233117025e-03, 0.6042648292),
        0.75: (2.881130179598e-03, 0.6002969972),
        1.0: (2.423414546757e-03, 0.8766313645),
    },
}


def against_rod(result, surface, t):
    """Relative differences of force and arc position from the rod."""
    k = int(np.flatnonzero(np.isclose(result.load_parameter, t))[0])
    force, arc = ROD[surface][t]
    contact = result.contacts[PAIR]
    return abs(contact.force[k] / force - 1), abs(contact.arc_position[k] / arc - 1)


def check_against_rod(result, surface, allowed):
    """Allowed: 0.6 % of the force at the end and 0.25 % at half way, by St. Venant-Kirchhoff's coupling, not the mesh."""
    assert result.status is fr.Status.COMPLETED
    assert result.newton_iterations.sum() <= 5 * result.substeps
    for t, difference in allowed.items():
        force, arc = against_rod(result, surface, t)
        assert force < difference
        assert arc < 2e-3


@surfaces
@pytest.mark.slow_at("face")
def test_ks_cantilever_agrees_with_the_rod(request, surface):
    result = request.getfixturevalue(f"ks_{surface}")
    assert result.cutbacks == 0
    check_against_rod(result, surface, {0.1: 1e-3, 0.5: 2.5e-3, 1.0: 6e-3})


def test_biot_linear_material_is_closer_to_the_rod(problem):
    """The rod is linear in Biot's strain too; the remaining difference is the solid's, not the mesh's."""
    biot, svk = (
        fr.solve(problem(material=name), loads(20)) for name in ("biot-linear", "st-venant-kirchhoff")
    )
    for t in (0.25, 0.5, 0.75, 1.0):
        errors = [against_rod(result, "axis", t)[0] for result in (biot, svk)]
        assert errors[0] < 1e-3
        assert errors[1] < 6e-3
        if t >= 0.5:
            assert errors[0] < errors[1] / 3


@pytest.mark.slow
@pytest.mark.parametrize("penalty", [1.0, 1e4])
@surfaces
@pytest.mark.parametrize("mesh", [(25, 2), (200, 4)])
def test_every_mesh_and_penalty_completes(problem, mesh, surface, penalty):
    scene = problem(mesh=mesh, contact={"surface": surface, "penalty": penalty})
    result = fr.solve(scene, loads(50), fr.Settings(max_penetration=1e-2))
    check_against_rod(result, surface, {0.5: 2.5e-3, 1.0: 6e-3} if penalty == 1e4 else {})


def test_penalty_error_is_linear_in_its_inverse(problem, ks_axis):
    stiff = ks_axis.contacts[PAIR].force[24]
    errors = [
        fr.solve(problem(contact={"penalty": eps}), loads(50)[:25]).contacts[PAIR].force[24] / stiff - 1
        for eps in (10.0, 40.0)
    ]
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.02)


@pytest.mark.parametrize("case", ["turned", "mirrored", "reversed"])
def test_pose_does_not_matter(problem, ks_face, case):
    """The face scene turned and moved; also mirrored, or with the strip's direction reversed."""
    Q, sign = rotation(0.7), -1.0 if case == "mirrored" else 1.0

    def place(points):
        return (points * [1.0, sign]) @ Q.T + [2.0, -3.0]

    start, end, *path = map(
        tuple, place(np.array([(0.0, 0.0), (1.0, 0.0), (1.0, -0.01), (0.0, 2 / np.pi - 0.01)]))
    )
    ends = {"start": start, "end": end}
    if case == "reversed":
        ends = {"start": end, "end": start, "clamped": ("end",)}
    side = "right" if case == "turned" else "left"
    scene = problem(path=tuple(path), contact={"side": side, "surface": "face"}, **ends)
    result = fr.solve(scene, ks_face.load_parameter[:10])
    contact, original = result.contacts[PAIR], ks_face.contacts[PAIR]
    (support,), reference = result.supports.values(), ks_face.supports[CLAMP]
    arc = 1 - contact.arc_position if case == "reversed" else contact.arc_position
    np.testing.assert_allclose(contact.force, original.force[:10], rtol=1e-8)
    np.testing.assert_allclose(arc, original.arc_position[:10], rtol=1e-8)
    np.testing.assert_allclose(support.moment, sign * reference.moment[:10], rtol=1e-8)
    np.testing.assert_allclose(support.force, (reference.force[:10] * [1, sign]) @ Q.T, rtol=1e-7, atol=1e-12)
    np.testing.assert_allclose(result.tips[STRIP], place(ks_face.tips[STRIP][:10]), atol=1e-9)


@pytest.mark.slow_at("steel and a kilometre")
@pytest.mark.parametrize(
    ("size", "modulus", "origin"),
    [
        pytest.param(1.0, E, (1000.0, -1000.0), id="far away: a pin's position is rounded there to 1e-13"),
        pytest.param(1000.0, 1e7 * E, (0.0, 0.0), id="steel and a kilometre"),
    ],
)
def test_place_and_units_do_not_matter(problem, ks_axis, size, modulus, origin):
    """The same ``F L^2 / EI`` and ``s / L``."""
    scaled = {"height": 0.02 * size, "youngs_modulus": modulus, "contact": {"penalty": 1e4 * modulus / E}}
    ends = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (0.0, 2 / np.pi)])
    start, end, *path = map(tuple, size * ends + origin)
    result = fr.solve(problem(path=tuple(path), start=start, end=end, **scaled), loads(10))
    contact, original = result.contacts[PAIR], ks_axis.contacts[PAIR]
    np.testing.assert_allclose(contact.force, original.force[4::5] * modulus / E * size, rtol=1e-8)
    np.testing.assert_allclose(contact.arc_position, original.arc_position[4::5] * size, rtol=1e-8)


def test_slender_strip_converges_to_the_elastica(problem):
    """``h/L`` = 1/500: round-off in the residual, and the closed form ``F = 4.66473101966 EI / L^2`` at half way."""
    result = fr.solve(problem(height=0.002, mesh=(200, 1)), loads(20)[:10])
    stiffness = result.model.problem.strips[0].bending_stiffness
    assert result.contacts[PAIR].force[-1] / stiffness == pytest.approx(4.66473101966107, rel=2e-4)
    assert result.contacts[PAIR].arc_position[-1] == pytest.approx(0.612622877902267, rel=1e-4)


def test_small_deflection_is_the_timoshenko_beams(problem):
    result = fr.solve(problem(path=((0.8, 0.0), (0.8, 1e-4))), loads(1))
    expected = 1e-4 / (0.8**3 / (3 * EI) + 0.8 / GA)
    assert result.contacts[PAIR].force[0] == pytest.approx(expected, rel=1e-4)
    assert result.supports[CLAMP].moment[0] == pytest.approx(-0.8 * expected, rel=1e-4)


def test_work_of_the_pin_is_the_stored_energy(ks_axis):
    """Integrate the pin's force along its path; Simpson's rule over 50 intervals is accurate to about 1e-5."""
    velocity = np.array([-1.0, 2 / np.pi])
    power = np.append(0.0, -ks_axis.supports[CLAMP].force @ velocity)
    work = simpson(power, x=np.append(0.0, ks_axis.load_parameter))
    assert work == pytest.approx(sum(fr.energy(ks_axis, -1)), rel=2e-5)


def test_pin_that_comes_later_touches_and_leaves(problem):
    result = fr.solve(problem(path=((0.8, -0.1), (0.8, 0.2), (0.8, -0.2)), mesh=(20, 1)), loads(14))
    contact = result.contacts[PAIR]
    height = np.array([result.model.problem.pins[0].position(t)[1] for t in result.load_parameter])
    pushing, apart = height > 1e-12, height < -1e-12
    assert result.status is fr.Status.COMPLETED
    assert np.all(contact.force[pushing] > 1e-6)
    assert np.all(contact.force[apart] == 0)
    # Where it just touches, open and closed agree within the residual's tolerance.
    assert np.all(contact.force[~pushing & ~apart] < 1e-12)
    assert np.sum(~pushing & ~apart) == 2
    assert np.all(np.isfinite(contact.arc_position[pushing]))
    assert np.all(np.isnan(contact.arc_position[apart]))
    np.testing.assert_allclose(contact.gap[apart], -height[apart], atol=1e-12)


def test_slip_off_the_tip_is_at_the_height_of_the_elastica(problem):
    """Pin at 0.8, raised: an inextensible elastica of length 1 is left at the height 0.538697375157."""
    with pytest.raises(fr.SolveError, match="passed the end") as caught:
        fr.solve(problem(path=((0.8, 0.0), (0.8, 1.0))), loads(20))
    result = caught.value.result
    assert result.status is fr.Status.LOST_CONTACT
    assert result.reached == pytest.approx(0.538697375157, rel=2e-4)
    assert result.load_parameter[-1] == pytest.approx(0.5)
    assert len(result.contacts[PAIR].force) == len(result.displacement) == 10


def test_one_load_step_follows_a_path_that_turns(problem):
    """The pin leaves the strip on the way up; at the end of its path it could press the strip again."""
    bent = problem(path=((0.9, 0.0), (0.9, 0.6), (0.7, 0.2)), mesh=(20, 1))
    one, many = (fr.solve(bent, loads(n), throw=False) for n in (1, 20))
    assert one.status is many.status is fr.Status.LOST_CONTACT
    assert one.reached == pytest.approx(many.reached, abs=1e-5)


@pytest.mark.slow_at("1")
@pytest.mark.parametrize("n", [1, 7])
def test_pin_that_jumps_past_the_clamp_is_not_taken_for_an_open_contact(problem, n):
    """A KS path drawn on to x = -0.1, where the undeformed strip is not: the contact is followed until it slips."""
    result = fr.solve(problem(path=((1.0, 0.0), (-0.1, 0.6366)), mesh=(20, 1)), loads(n), throw=False)
    assert result.status is fr.Status.LOST_CONTACT
    assert result.reached > 0.9
    assert np.all(result.contacts[PAIR].force > 0)


def test_step_floor_is_a_status_and_keeps_the_accepted_states(problem):
    settings = fr.Settings(max_iterations=2, min_step=0.02)
    result = fr.solve(problem(mesh=(10, 1)), loads(10), settings, throw=False)
    assert result.status is fr.Status.CUTBACK_FLOOR
    assert "because Newton's method did not converge" in result.message
    assert "after load parameter" in result.message
    assert result.cutbacks > 0
    assert len(result.load_parameter) == len(result.states) < 10


def test_steps_that_stay_short_run_out(problem):
    settings = fr.Settings(max_iterations=3, max_attempts=3)
    result = fr.solve(problem(mesh=(10, 1)), loads(2), settings, throw=False)
    assert result.status is fr.Status.STEP_LIMIT
    assert result.cutbacks + result.substeps == 3


@pytest.mark.slow
@pytest.mark.parametrize("scene", ["axis", "round pin", "tip load"])
def test_the_last_answer_does_not_depend_on_the_number_of_load_parameters(problem, strip, scene):
    """With 1, 2, 5, 8, 12, 40 and 200 of them the same force and arc position at t = 1, within 1e-6."""
    load = fr.EndLoad(strip=STRIP, force=(-1.5e-3, 2e-5))
    made = {
        "axis": problem(mesh=(20, 1)),
        "round pin": problem(mesh=(20, 1), radius=0.05, contact={"surface": "face"}),
        "tip load": fr.SolidProblem(strips=(strip(mesh=(20, 1)),), loads=(load,)),
    }[scene]
    answers = []
    for n in (1, 2, 5, 8, 12, 40, 200):
        result = fr.solve(made, loads(n))
        contacts = [(c.force[-1], c.arc_position[-1]) for c in result.contacts.values()]
        answers.append(np.concatenate([result.tips[STRIP][-1], *contacts]))
    np.testing.assert_allclose(answers, np.broadcast_to(answers[0], np.shape(answers)), rtol=1e-6, atol=1e-7)

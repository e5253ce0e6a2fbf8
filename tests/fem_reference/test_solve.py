import numpy as np
import pytest

import fem_reference as fr
from fem_reference.state import contact_force

EI, GA = 2.1e4 * 0.02**4 / 12, 2.1e4 / 2.6 * 0.02**2 * 5 / 6
PAIR, STRIP = "pin->cantilever", "cantilever"
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


def loads(n):
    return np.arange(1, n + 1) / n


def against_rod(result, surface, t):
    k = int(np.flatnonzero(np.isclose(result.load_parameter, t))[0])
    force, arc = ROD[surface][t]
    contact = result.contacts[PAIR]
    return abs(contact.force[k] / force - 1), abs(contact.arc_position[k] / arc - 1)


@pytest.mark.parametrize("surface", ["axis", "face"])
def test_ks_cantilever_agrees_with_the_rod(request, surface):
    """Bars of 0.6 % at the end and 0.25 % at half way: St. Venant-Kirchhoff's coupling, not the mesh."""
    result = request.getfixturevalue(f"ks_{surface}")
    assert result.status is fr.Status.COMPLETED
    assert result.cutbacks == 0
    assert result.newton_iterations.sum() <= 5 * result.substeps
    for t, bar in ((0.1, 1e-3), (0.5, 2.5e-3), (1.0, 6e-3)):
        force, arc = against_rod(result, surface, t)
        assert force < bar
        assert arc < 2e-3


def test_biot_linear_material_is_closer_to_the_rod(problem):
    """The rod is linear in Biot's strain too; what is left at the end is the solid, not the mesh."""
    biot, svk = (
        fr.solve(problem(material=name), loads(20)) for name in ("biot-linear", "st-venant-kirchhoff")
    )
    for t in (0.25, 0.5, 0.75, 1.0):
        assert against_rod(biot, "axis", t)[0] < 1e-3
        assert against_rod(svk, "axis", t)[0] < 6e-3
        if t >= 0.5:
            assert against_rod(biot, "axis", t)[0] < against_rod(svk, "axis", t)[0] / 3


@pytest.mark.slow
@pytest.mark.parametrize("penalty", [1.0, 1e2, 1e4])
@pytest.mark.parametrize("surface", ["axis", "face"])
@pytest.mark.parametrize("mesh", [(25, 2), (50, 2), (100, 2), (200, 4)])
def test_every_mesh_and_penalty_completes(problem, mesh, surface, penalty):
    settings = fr.Settings(max_penetration=1e-2)
    result = fr.solve(
        problem(mesh=mesh, contact={"surface": surface, "penalty": penalty}), loads(50), settings
    )
    assert result.status is fr.Status.COMPLETED
    assert result.newton_iterations.sum() <= 5 * result.substeps
    if penalty == 1e4:
        for t, bar in ((0.5, 2.5e-3), (1.0, 6e-3)):
            force, arc = against_rod(result, surface, t)
            assert force < bar
            assert arc < 2e-3


def test_penalty_error_is_linear_in_its_inverse(problem, ks_axis):
    stiff = ks_axis.contacts[PAIR].force[24]
    errors = [
        fr.solve(problem(contact={"penalty": eps}), loads(50)[:25]).contacts[PAIR].force[24] / stiff - 1
        for eps in (10.0, 40.0)
    ]
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.02)


def test_answers_do_not_depend_on_the_load_parameters(problem, ks_axis):
    coarse, fine = fr.solve(problem(), loads(10)).contacts[PAIR], ks_axis.contacts[PAIR]
    np.testing.assert_allclose(coarse.force, fine.force[4::5], rtol=1e-9)
    np.testing.assert_allclose(coarse.arc_position, fine.arc_position[4::5], rtol=1e-9)


def test_one_load_parameter_is_reached_by_cutting_back(problem, ks_axis):
    result = fr.solve(problem(), loads(1))
    assert result.cutbacks > 0
    assert result.contacts[PAIR].force[0] == pytest.approx(ks_axis.contacts[PAIR].force[-1], rel=1e-9)


@pytest.mark.parametrize("x", [np.nextafter(1.0, 2), np.nextafter(1.0, 0)])
def test_pin_one_unit_of_round_off_beside_the_tip(problem, ks_axis, x):
    result = fr.solve(problem(path=((float(x), 0.0), (0.0, 2 / np.pi))), loads(50)[:5])
    np.testing.assert_allclose(result.contacts[PAIR].force, ks_axis.contacts[PAIR].force[:5], rtol=1e-9)


def test_pose_does_not_matter(problem, ks_face):
    """The face scene turned, moved, mirrored, and with the strip's direction reversed."""
    few, original = loads(50)[:10], ks_face.contacts[PAIR]
    angle = 0.7
    Q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])

    def place(points, mirror=1.0):
        return tuple(map(tuple, (np.array(points) * [1.0, mirror]) @ Q.T + [2.0, -3.0]))

    path = ((1.0, -0.01), (0.0, 2 / np.pi - 0.01))
    ends = ((0.0, 0.0), (1.0, 0.0))
    turned = dict(zip(("start", "end"), place(ends), strict=True))
    reversed_ = {**dict(zip(("end", "start"), place(ends), strict=True)), "clamped": ("end",)}
    cases = {
        "turned": fr.solve(problem(path=place(path), contact={"surface": "face"}, **turned), few),
        "mirrored": fr.solve(
            problem(path=place(path, -1.0), contact={"side": "left", "surface": "face"}, **turned), few
        ),
        "reversed": fr.solve(
            problem(path=place(path), contact={"side": "left", "surface": "face"}, **reversed_), few
        ),
    }
    moment, force, tip = (
        ks_face.supports[STRIP].moment[:10],
        ks_face.supports[STRIP].force[:10],
        ks_face.tips[STRIP][:10],
    )
    for name, result in cases.items():
        sign, contact = (-1.0 if name == "mirrored" else 1.0), result.contacts[PAIR]
        arc = 1 - contact.arc_position if name == "reversed" else contact.arc_position
        np.testing.assert_allclose(contact.force, original.force[:10], rtol=1e-8, err_msg=name)
        np.testing.assert_allclose(arc, original.arc_position[:10], rtol=1e-8, err_msg=name)
        np.testing.assert_allclose(result.supports[STRIP].moment, sign * moment, rtol=1e-8, err_msg=name)
        np.testing.assert_allclose(
            result.supports[STRIP].force, (force * [1, sign]) @ Q.T, rtol=1e-7, atol=1e-12
        )
        np.testing.assert_allclose(
            result.tips[STRIP], (tip * [1, sign]) @ Q.T + [2, -3], atol=1e-9, err_msg=name
        )


def test_place_does_not_matter(problem, ks_axis):
    """A thousand lengths from the origin; the pin's own position is rounded there, to 1e-13."""
    far = 1000.0
    strip = {"start": (far, -far), "end": (far + 1, -far)}
    result = fr.solve(problem(path=((far + 1, -far), (far, 2 / np.pi - far)), **strip), loads(10))
    moved, original = result.contacts[PAIR], ks_axis.contacts[PAIR]
    np.testing.assert_allclose(moved.force, original.force[4::5], rtol=1e-8)
    np.testing.assert_allclose(moved.arc_position, original.arc_position[4::5], rtol=1e-8)


def test_units_do_not_matter(problem, ks_axis):
    """Steel and a strip of a kilometre: the same ``F L^2 / EI`` and ``s / L``."""
    size = 1000.0
    strip = {"end": (size, 0.0), "height": 0.02 * size, "youngs_modulus": 2.1e11}
    path = ((size, 0.0), (0.0, 2 / np.pi * size))
    result = fr.solve(problem(path=path, contact={"penalty": 1e4 * 1e7}, **strip), loads(10))
    scaled, original = result.contacts[PAIR], ks_axis.contacts[PAIR]
    np.testing.assert_allclose(scaled.force, original.force[4::5] * 1e7 * size, rtol=1e-8)
    np.testing.assert_allclose(scaled.arc_position, original.arc_position[4::5] * size, rtol=1e-8)


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
    assert result.supports[STRIP].moment[0] == pytest.approx(-0.8 * expected, rel=1e-4)


def test_reaction_balances_the_contact_force(ks_face):
    model = ks_face.model
    for at, force, moment in zip(
        ks_face.states, ks_face.supports[STRIP].force, ks_face.supports[STRIP].moment, strict=True
    ):
        touch, pin = at.touches[0], model.problem.pins[0].position(at.t)
        p = contact_force(touch)
        np.testing.assert_allclose(force, -p, rtol=0, atol=1e-8 * touch.force + 1e-12)
        assert moment == pytest.approx(-(pin[0] * p[1] - pin[1] * p[0]), rel=1e-6)


def test_gap_is_minus_the_penetration(ks_axis):
    contact = ks_axis.contacts[PAIR]
    np.testing.assert_allclose(contact.gap, -contact.force / 1e4, rtol=0, atol=3e-15)


def test_work_of_the_pin_is_the_stored_energy(ks_axis):
    """Integrate the pin's force along its path; Simpson's rule over 50 intervals is good to about 1e-5."""
    from scipy.integrate import simpson

    velocity = np.array([-1.0, 2 / np.pi])
    power = np.append(0.0, -ks_axis.supports[STRIP].force @ velocity)
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


def test_slip_off_the_tip_is_named_where_the_elastica_has_it(problem):
    """Pin at 0.8, raised: an inextensible elastica of length 1 is left at the height 0.538697375157."""
    with pytest.raises(fr.SolveError, match="passed the end") as caught:
        fr.solve(problem(path=((0.8, 0.0), (0.8, 1.0))), loads(20))
    result = caught.value.result
    assert result.status is fr.Status.LOST_CONTACT
    assert result.reached == pytest.approx(0.538697375157, rel=2e-4)
    assert result.load_parameter[-1] == pytest.approx(0.5)
    assert len(result.contacts[PAIR].force) == len(result.displacement) == 10


def test_one_load_step_follows_a_path_that_turns(problem):
    """Where it ends the pin could press the strip, which it has left on the way up."""
    bent = problem(path=((0.9, 0.0), (0.9, 0.6), (0.7, 0.2)), mesh=(20, 1))
    one, many = (fr.solve(bent, loads(n), throw=False) for n in (1, 20))
    assert one.status is many.status is fr.Status.LOST_CONTACT
    assert one.reached == pytest.approx(many.reached, abs=1e-5)


@pytest.mark.parametrize("n", [1, 7])
def test_pin_that_jumps_past_the_clamp_is_not_taken_for_an_open_contact(problem, n):
    """A KS path drawn on to x = -0.1, where the undeformed strip is not: the contact is followed until it slips."""
    result = fr.solve(problem(path=((1.0, 0.0), (-0.1, 0.6366)), mesh=(20, 1)), loads(n), throw=False)
    assert result.status is fr.Status.LOST_CONTACT
    assert result.reached > 0.9
    assert np.all(result.contacts[PAIR].force > 0)


def test_step_floor_has_its_name_and_keeps_what_was_reached(problem):
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


def test_full_clamp_is_stiffer(problem):
    full, rod = (
        fr.solve(problem(clamp=clamp, path=((0.8, 0.0), (0.8, 0.1))), loads(1)).contacts[PAIR].force[0]
        for clamp in ("full", "rod")
    )
    assert 1e-4 < full / rod - 1 < 3e-3


@pytest.mark.slow
@pytest.mark.parametrize("scene", ["axis", "round pin", "tip load"])
def test_the_last_answer_does_not_depend_on_the_number_of_load_parameters(problem, strip, scene):
    """With 1, 2, 5, 8, 12, 40 and 200 of them the same force and arc position at t = 1, within 1e-6."""
    made = {
        "axis": lambda: problem(mesh=(20, 1)),
        "round pin": lambda: problem(mesh=(20, 1), radius=0.05, contact={"surface": "face"}),
        "tip load": lambda: fr.SolidProblem(
            strips=(strip(mesh=(20, 1)),), loads=(fr.EndLoad(strip=STRIP, force=(-1.5e-3, 2e-5)),)
        ),
    }[scene]()
    found = []
    for n in (1, 2, 5, 8, 12, 40, 200):
        result = fr.solve(made, loads(n))
        contacts = [(c.force[-1], c.arc_position[-1]) for c in result.contacts.values()]
        found.append(np.concatenate([result.tips[STRIP][-1], *contacts]))
    np.testing.assert_allclose(found, np.broadcast_to(found[0], np.shape(found)), rtol=1e-6, atol=1e-7)

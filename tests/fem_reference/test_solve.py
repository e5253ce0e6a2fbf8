"""The KS cantilever and its relatives against rods, and the statuses with which a path ends."""

import numpy as np
import pytest

import fem_reference as fr
from tests.fem_reference.conftest import (
    CLAMP,
    EI,
    GA,
    PAIR,
    STRIP,
    loads,
    make_problem,
    rotation,
    surfaces,
)

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
        0.5: (1.346233117025e-03, 0.6042648292),
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
def test_ks_cantilever_agrees_with_the_rod(request, surface):
    result = request.getfixturevalue(f"ks_{surface}")
    assert result.cutbacks <= 1
    check_against_rod(result, surface, {0.1: 1e-3, 0.5: 2.5e-3, 1.0: 6e-3})


def test_biot_linear_material_is_closer_to_the_rod(ks_axis):
    """The rod is linear in Biot's strain too; the remaining difference is the solid's, not the mesh's."""
    biot = fr.solve(make_problem(material="biot-linear"), loads(20))
    for t in (0.25, 0.5, 0.75, 1.0):
        assert against_rod(biot, "axis", t)[0] < 1e-3
        if t in (0.5, 1.0):
            assert against_rod(biot, "axis", t)[0] < against_rod(ks_axis, "axis", t)[0] / 3


@pytest.mark.slow
@pytest.mark.parametrize("penalty", [1.0, 1e4])
@surfaces
@pytest.mark.parametrize("mesh", [(25, 2), (200, 4)])
def test_every_mesh_and_penalty_completes(mesh, surface, penalty):
    scene = make_problem(mesh=mesh, contact={"surface": surface, "penalty": penalty})
    result = fr.solve(scene, loads(50), fr.Settings(max_penetration=1e-2))
    check_against_rod(result, surface, {0.5: 2.5e-3, 1.0: 6e-3} if penalty == 1e4 else {})


@pytest.mark.parametrize(
    ("surface", "reversed_", "origin"), [("face", False, (2.0, -3.0)), ("axis", True, (1000.0, -1000.0))]
)
def test_pose_does_not_matter(request, surface, reversed_, origin):
    """Turned, moved (so far that a pin's position is rounded to 1e-13), and mirrored or with the ends swapped."""
    reference, y = request.getfixturevalue(f"ks_{surface}"), -0.01 if surface == "face" else 0.0
    Q, sign, n = rotation(0.7), 1.0 if reversed_ else -1.0, 3

    def place(points):
        return (points * [1.0, sign]) @ Q.T + origin

    points = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, y), (0.0, 2 / np.pi + y)])
    start, end, *path = map(tuple, place(points))
    ends = {"start": start, "end": end}
    if reversed_:
        ends = {"start": end, "end": start, "clamped": ("end",)}
    scene = make_problem(path=tuple(path), contact={"side": "left", "surface": surface}, **ends)
    result = fr.solve(scene, reference.load_parameter[:n])
    contact, original = result.contacts[PAIR], reference.contacts[PAIR]
    (support,), held = result.supports.values(), reference.supports[CLAMP]
    arc = 1 - contact.arc_position if reversed_ else contact.arc_position
    np.testing.assert_allclose(contact.force, original.force[:n], rtol=1e-8)
    np.testing.assert_allclose(arc, original.arc_position[:n], rtol=1e-8)
    np.testing.assert_allclose(support.moment, sign * held.moment[:n], rtol=1e-8)
    np.testing.assert_allclose(support.force, (held.force[:n] * [1, sign]) @ Q.T, rtol=1e-7, atol=1e-12)
    np.testing.assert_allclose(result.tips[STRIP], place(reference.tips[STRIP][:n]), atol=1e-9)


@pytest.mark.parametrize("size", [1e-18, 1e18])
def test_a_coarse_strip_of_any_length(size):
    """Three stations: in raw units SciPy warns of an ill-conditioned matrix of their spline."""

    def force(size):
        changes = {"height": 0.02 * size, "width": 0.02 * size, "end": (size, 0.0)}
        path = ((0.8 * size, 0.0), (0.8 * size, 1e-4 * size))
        scene = make_problem(path=path, mesh=(2, 1), element="Q1", contact={"penalty": 1e4 * size}, **changes)
        return fr.solve(scene, loads(1)).contacts[PAIR].force[-1]

    assert force(size) == pytest.approx(force(1.0) * size**2, rel=1e-8)


def test_slender_strip_converges_to_the_elastica():
    """``h/L`` = 1/500: round-off in the residual, and the closed form ``F = 4.66473101966 EI / L^2`` at half way."""
    result = fr.solve(make_problem(height=0.002, mesh=(200, 1)), loads(20)[:10])
    stiffness = result.model.problem.strips[0].bending_stiffness
    assert result.contacts[PAIR].force[-1] / stiffness == pytest.approx(4.66473101966107, rel=2e-4)
    assert result.contacts[PAIR].arc_position[-1] == pytest.approx(0.612622877902267, rel=1e-4)


def test_small_deflection_is_the_timoshenko_beams():
    result = fr.solve(make_problem(path=((0.8, 0.0), (0.8, 1e-4))), loads(1))
    expected = 1e-4 / (0.8**3 / (3 * EI) + 0.8 / GA)
    assert result.contacts[PAIR].force[0] == pytest.approx(expected, rel=1e-4)
    assert result.supports[CLAMP].moment[0] == pytest.approx(-0.8 * expected, rel=1e-4)


def test_pin_that_comes_later_touches_and_leaves():
    result = fr.solve(make_problem(path=((0.8, -0.1), (0.8, 0.2), (0.8, -0.2)), mesh=(20, 1)), loads(14))
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


def test_slip_off_the_tip_is_at_the_height_of_the_elastica():
    """Pin at 0.8, raised: an inextensible elastica of length 1 is left at the height 0.538697375157."""
    with pytest.raises(fr.SolveError, match="passed the end") as caught:
        fr.solve(make_problem(path=((0.8, 0.0), (0.8, 1.0))), loads(20))
    result = caught.value.result
    assert result.status is fr.Status.LOST_CONTACT
    assert result.reached == pytest.approx(0.538697375157, rel=2e-4)
    assert result.load_parameter[-1] == pytest.approx(0.5)
    assert len(result.contacts[PAIR].force) == len(result.displacement) == 10


def test_one_load_step_follows_a_path_that_turns():
    """The pin leaves the strip on the way up; at the end of its path it could press the strip again."""
    bent = make_problem(path=((0.9, 0.0), (0.9, 0.6), (0.7, 0.2)), mesh=(20, 1))
    one, many = (fr.solve(bent, loads(n), throw=False) for n in (1, 20))
    assert one.status is many.status is fr.Status.LOST_CONTACT
    assert one.reached == pytest.approx(many.reached, abs=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize("n", [1, 7])
def test_pin_that_jumps_past_the_clamp_is_not_taken_for_an_open_contact(n):
    """A KS path drawn on to x = -0.1, where the undeformed strip is not: the contact is followed until it slips."""
    result = fr.solve(make_problem(path=((1.0, 0.0), (-0.1, 0.6366)), mesh=(20, 1)), loads(n), throw=False)
    assert result.status is fr.Status.LOST_CONTACT
    assert result.reached > 0.9
    assert np.all(result.contacts[PAIR].force > 0)


def test_step_floor_is_a_status_and_keeps_the_accepted_states():
    settings = fr.Settings(max_iterations=2, min_step=0.02)
    result = fr.solve(make_problem(mesh=(10, 1)), loads(10), settings, throw=False)
    assert result.status is fr.Status.CUTBACK_FLOOR
    assert "because Newton's method did not converge" in result.message
    assert "after load parameter" in result.message
    assert result.cutbacks > 0
    assert len(result.load_parameter) == len(result.states) < 10


def test_steps_that_stay_short_run_out():
    settings = fr.Settings(max_iterations=3, max_attempts=3)
    result = fr.solve(make_problem(mesh=(10, 1)), loads(2), settings, throw=False)
    assert result.status is fr.Status.STEP_LIMIT
    assert result.cutbacks + result.substeps == 3

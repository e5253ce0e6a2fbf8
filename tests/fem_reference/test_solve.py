"""The KS cantilever and its relatives against rods, and the statuses with which a path ends."""

import numpy as np
import pytest

import fem_reference as fr
from comparisons.exact import rod_under_pin
from tests.fem_reference.conftest import CLAMP, EA, EI, GA, PAIR, H, loads, make_problem, surfaces


@pytest.mark.parametrize(
    ("material", "allowed"),
    [("biot-linear", {0.25: 1e-3, 1.0: 1e-3}), ("st-venant-kirchhoff", {0.1: 1e-3, 0.5: 2.5e-3, 1.0: 6e-3})],
)
@surfaces
def test_ks_cantilever_agrees_with_the_rod(material, surface, allowed):
    """The rod is linear in Biot's strain too; St. Venant-Kirchhoff's coupling, not the mesh, makes 0.6 % at the end."""
    t = loads(20)
    result = fr.solve(make_problem(contact={"surface": surface}, material=material), t)
    assert result.newton_iterations.sum() <= 5 * result.substeps
    offset = H / 2 if surface == "face" else 0.0
    points = np.stack([1 - np.append(0, t), 2 / np.pi * np.append(0, t) - offset], axis=1)
    rod, contact = (
        rod_under_pin(points, EA=EA, GA=GA, EI=EI, length=1.0, offset=offset),
        result.contacts[PAIR],
    )
    np.testing.assert_allclose(contact.arc_position, rod.arc_position[1:], rtol=2e-3)
    for end, difference in allowed.items():
        k = int(np.flatnonzero(np.isclose(t, end))[0])
        assert contact.force[k] == pytest.approx(rod.magnitude[k + 1], rel=difference)


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

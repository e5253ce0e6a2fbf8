"""What the penalty leaves of the constraint, what augmented Lagrangian steps remove, and what scatters with the mesh."""

import numpy as np
import pytest

import fem_reference as fr

PAIR = "pin->cantilever"
surfaces = pytest.mark.parametrize("surface", ["axis", "face"])
# Force and arc position of two meshes within this of each other are the same answer.
SCATTER = 2e-4


def loads(n):
    return np.arange(1, n + 1) / n


def augmented(problem, surface="axis", **changes):
    return problem(contact={"surface": surface, "penalty": None, "penetration": 1e-10}, **changes)


def work_and_energy(problem, panels):
    """Work of the pin's force along its path, by four Gauss points a panel, and the energy stored at its end."""
    x, w = np.polynomial.legendre.leggauss(4)
    t = ((np.arange(panels)[:, None] + (1 + x) / 2) / panels).ravel()
    result = fr.solve(problem, np.append(t, 1.0))
    power = result.contacts[PAIR].vector[:-1] @ np.subtract(*problem.pins[0].path[::-1])
    return result, np.tile(w / 2 / panels, panels) @ power, sum(fr.energy(result, -1))


@surfaces
@pytest.mark.parametrize("material", fr.MATERIALS)
def test_augmented_lagrangian_reaches_the_requested_penetration(problem, surface, material):
    result, work, energy = work_and_energy(augmented(problem, surface, material=material), 10)
    assert np.abs(result.contacts[PAIR].gap).max() <= 1e-10
    assert work == pytest.approx(energy, rel=1e-6)


@pytest.mark.slow
@surfaces
@pytest.mark.parametrize("material", fr.MATERIALS)
@pytest.mark.parametrize(("mesh", "panels"), [((25, 2), 80), ((100, 2), 10), ((200, 4), 10)])
def test_every_mesh_and_material_reaches_it(problem, surface, material, mesh, panels):
    """On 25 x 2 the force changes with every element that the pin passes: it takes 80 panels to integrate it."""
    result, work, energy = work_and_energy(augmented(problem, surface, material=material, mesh=mesh), panels)
    assert np.abs(result.contacts[PAIR].gap).max() <= 1e-10
    assert work == pytest.approx(energy, rel=1e-6)


def test_augmentations_that_do_not_suffice_have_their_name(problem):
    soft = problem(contact={"penalty": 1.0, "penetration": 1e-12}, mesh=(10, 1))
    result = fr.solve(soft, loads(4), fr.Settings(max_augmentations=1, min_step=0.1), throw=False)
    assert result.status is fr.Status.CUTBACK_FLOOR
    assert fr.Status.AUGMENTATION_LIMIT.value in result.message


@surfaces
def test_penetration_falls_with_the_penalty_over_ten_decades(problem, surface):
    """Slope -1 +- .05 from 10 to 1e11 N/m; below, a named failure; above, the force still stands."""
    exact = fr.solve(augmented(problem, surface), loads(10)[:5]).contacts[PAIR].force[-1]
    penalties = 10.0 ** np.arange(1, 12, 2)
    found = [
        fr.solve(problem(contact={"surface": surface, "penalty": eps}), loads(10)[:5]).contacts[PAIR]
        for eps in penalties
    ]
    slopes = np.diff(np.log10([-contact.gap[-1] for contact in found])) / np.diff(np.log10(penalties))
    np.testing.assert_allclose(slopes, -1, atol=0.05)
    for eps, contact in zip(penalties, found, strict=True):
        assert contact.force[-1] == pytest.approx(exact, rel=8e-3 / eps + 1e-8)
    for eps in (1e-2, 1.0):
        result = fr.solve(problem(contact={"surface": surface, "penalty": eps}), loads(10), throw=False)
        assert result.status is fr.Status.CUTBACK_FLOOR
        assert fr.Status.TOO_DEEP.value in result.message
    stiff = fr.solve(problem(contact={"surface": surface, "penalty": 1e14}), loads(10)[:5]).contacts[PAIR]
    assert stiff.force[-1] == pytest.approx(exact, rel=1e-8)


@surfaces
def test_default_penalty_is_as_good_as_augmented_lagrangian(problem, surface):
    default = fr.solve(problem(contact={"surface": surface, "penalty": None}), loads(20)).contacts[PAIR]
    exact = fr.solve(augmented(problem, surface), loads(20)).contacts[PAIR]
    np.testing.assert_allclose(default.force, exact.force, rtol=2e-6)
    np.testing.assert_allclose(default.arc_position, exact.arc_position, rtol=2e-6)


def histories(problem, meshes, surface, radius):
    found = [
        fr.solve(augmented(problem, surface, mesh=mesh, radius=radius, material="biot-linear"), loads(20))
        for mesh in meshes
    ]
    contacts = [result.contacts[PAIR] for result in found]
    return np.array([[contact.force, contact.arc_position] for contact in contacts])


def spread(found):
    """Largest relative difference between any two meshes at any load parameter past .1."""
    late = found[:, :, 2:]
    return float((np.ptp(late, axis=0) / late.mean(axis=0)).max())


@pytest.mark.parametrize(("surface", "radius"), [("axis", 0.0), ("face", 0.005)])
def test_answers_scatter_little_between_meshes(problem, surface, radius):
    assert spread(histories(problem, [(nx, 2) for nx in (40, 43, 47, 54, 60)], surface, radius)) <= SCATTER


@pytest.mark.slow
@pytest.mark.parametrize(("surface", "radius"), [("axis", 0.0), ("face", 0.005)])
def test_answers_of_21_meshes_scatter_little(problem, surface, radius):
    assert spread(histories(problem, [(nx, 2) for nx in range(40, 61)], surface, radius)) <= SCATTER


@pytest.mark.slow
@pytest.mark.parametrize(("surface", "radius"), [("axis", 0.0), ("face", 0.005)])
def test_coarse_and_fine_meshes_have_the_same_answer(problem, surface, radius):
    meshes = [(25, 2), (50, 2), (100, 2), (200, 4)]
    assert spread(histories(problem, meshes, surface, radius)) <= 5e-4


@pytest.mark.slow
def test_a_sharp_contact_scatters_more(problem):
    """What the average over three heights is for."""
    meshes = [(nx, 2) for nx in (40, 47, 54, 60)]
    sharp = np.array(
        [
            fr.solve(
                problem(mesh=mesh, material="biot-linear", contact={"surface": "face", "spread": 0.0}),
                loads(20),
            )
            .contacts[PAIR]
            .force
            for mesh in meshes
        ]
    )
    late = sharp[:, 2:]
    assert (np.ptp(late, axis=0) / late.mean(axis=0)).max() > 2 * SCATTER


def test_round_pin_pushes_the_axis_as_an_offset_does(problem):
    """A pin of radius R on the axis is a sharp pin on the curve R below: half the height, the face of a rigid section."""
    round_ = fr.solve(problem(radius=0.01), loads(20)).contacts[PAIR]
    face = fr.solve(problem(contact={"surface": "face"}), loads(20)).contacts[PAIR]
    np.testing.assert_allclose(round_.force, face.force, rtol=2e-3)
    np.testing.assert_allclose(round_.arc_position, face.arc_position, rtol=1e-3)

"""Penetration of the penalty method and of augmented Lagrangian steps, and the scatter of answers between meshes."""

from functools import partial

import numpy as np
import pytest

import fem_reference as fr
from tests.fem_reference.conftest import PAIR, loads, surfaces

SCATTER = 2e-4
"""Relative difference of force and arc position below which two meshes have the same answer."""
pins = pytest.mark.parametrize(("surface", "radius"), [("axis", 0.0), ("face", 0.005)])


def augmented(problem, surface="axis", **changes):
    return problem(contact={"surface": surface, "penalty": None, "penetration": 1e-10}, **changes)


def work_and_energy(problem, panels):
    """Work of the pin's force along its path, by four Gauss points a panel, and the energy stored at its end."""
    x, w = np.polynomial.legendre.leggauss(4)
    t = ((np.arange(panels)[:, None] + (1 + x) / 2) / panels).ravel()
    result = fr.solve(problem, np.append(t, 1.0))
    power = result.contacts[PAIR].vector[:-1] @ np.subtract(*problem.pins[0].path[::-1])
    return result, np.tile(w / 2 / panels, panels) @ power, sum(fr.energy(result, -1))


def check_penetration_and_work(problem, panels, stated):
    result, work, energy = work_and_energy(problem, panels)
    penetration, difference = np.abs(result.contacts[PAIR].gap).max(), abs(work / energy - 1)
    assert penetration <= 1e-10
    assert difference <= 1e-6
    stated("solid.penetration", penetration, part=True)
    stated("solid.work", difference, part=True)


@surfaces
@pytest.mark.slow_at(
    "biot-linear-axis",
    "biot-linear-face",
    "neo-hookean-axis",
    "st-venant-kirchhoff-axis",
    "st-venant-kirchhoff-face",
)
@pytest.mark.parametrize("material", fr.MATERIALS)
def test_augmented_lagrangian_reaches_the_requested_penetration(problem, surface, material, stated):
    check_penetration_and_work(augmented(problem, surface, material=material), 10, stated)


def test_too_few_augmentations_are_a_status(problem):
    soft = problem(contact={"penalty": 1.0, "penetration": 1e-12}, mesh=(10, 1))
    result = fr.solve(soft, loads(4), fr.Settings(max_augmentations=1, min_step=0.1), throw=False)
    assert result.status is fr.Status.CUTBACK_FLOOR
    assert fr.Status.AUGMENTATION_LIMIT.value in result.message


@surfaces
def test_penetration_falls_with_the_penalty_over_ten_decades(problem, surface):
    """Slope -1 +- .05 from 10 to 1e11 N/m. A softer penalty fails with a status; a stiffer one keeps the force."""

    def solve(eps, count=5, **options):
        return fr.solve(problem(contact={"surface": surface, "penalty": eps}), loads(10)[:count], **options)

    exact = fr.solve(augmented(problem, surface), loads(10)[:5]).contacts[PAIR].force[-1]
    penalties = 10.0 ** np.arange(1, 12, 2)
    contacts = [solve(eps).contacts[PAIR] for eps in penalties]
    slopes = np.diff(np.log10([-contact.gap[-1] for contact in contacts])) / np.diff(np.log10(penalties))
    np.testing.assert_allclose(slopes, -1, atol=0.05)
    for eps, contact in zip(penalties, contacts, strict=True):
        assert contact.force[-1] == pytest.approx(exact, rel=8e-3 / eps + 1e-8)
    for eps in (1e-2, 1.0):
        result = solve(eps, 10, throw=False)
        assert result.status is fr.Status.CUTBACK_FLOOR
        assert fr.Status.TOO_DEEP.value in result.message
    assert solve(1e14).contacts[PAIR].force[-1] == pytest.approx(exact, rel=1e-8)


def scatter(make, meshes, quantities=("force", "arc_position")):
    """Largest relative difference between any two meshes at any load parameter past .1."""
    contacts = [
        fr.solve(make(mesh=mesh, material="biot-linear"), loads(20)).contacts[PAIR] for mesh in meshes
    ]
    late = np.array([[getattr(contact, name)[2:] for name in quantities] for contact in contacts])
    return float((np.ptp(late, axis=0) / late.mean(axis=0)).max())


FINE = [(25, 2), (50, 2), (100, 2), (200, 4)]


@pins
@pytest.mark.slow
@pytest.mark.parametrize(
    ("meshes", "allowed"),
    [
        pytest.param([(nx, 2) for nx in (40, 43, 47, 54, 60)], SCATTER, id="5 meshes"),
        pytest.param([(nx, 2) for nx in range(40, 61)], SCATTER, id="21 meshes"),
        pytest.param(FINE, 5e-4, id="coarse and fine"),
    ],
)
def test_answers_scatter_little_between_meshes(problem, surface, radius, meshes, allowed):
    assert scatter(partial(augmented, problem, surface, radius=radius), meshes) <= allowed


@pytest.mark.slow
def test_a_sharp_contact_scatters_more(problem, stated):
    """Without the average over three heights."""
    sharp = partial(problem, contact={"surface": "face", "spread": 0.0})
    found = scatter(sharp, [(nx, 2) for nx in (40, 47, 54, 60)], ("force",))
    assert found > 2 * SCATTER
    stated("solid.sharp", found)


@pytest.mark.slow
def test_round_pin_pushes_the_axis_as_an_offset_does(problem):
    """A pin of radius R on the axis is a sharp pin on the curve R below: half the height, the face of a rigid section."""
    round_ = fr.solve(problem(radius=0.01), loads(20)).contacts[PAIR]
    face = fr.solve(problem(contact={"surface": "face"}), loads(20)).contacts[PAIR]
    np.testing.assert_allclose(round_.force, face.force, rtol=2e-3)
    np.testing.assert_allclose(round_.arc_position, face.arc_position, rtol=1e-3)

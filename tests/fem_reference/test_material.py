import numpy as np
import pytest
from scipy.linalg import polar

from fem_reference.arrays import Array
from fem_reference.material import MATERIALS, plane_stress_constants

LAM, MU = plane_stress_constants(2.1e4, 0.3)
STEP = 1e-30
laws = pytest.mark.parametrize("law", MATERIALS.values(), ids=MATERIALS.keys())


def gradients(points: int = 5) -> Array:
    """Deformation gradients near rotations by all angles."""
    rng = np.random.default_rng(1)
    angles = np.linspace(0, 2 * np.pi, points, endpoint=False)
    Q = np.array([[np.cos(angles), -np.sin(angles)], [np.sin(angles), np.cos(angles)]])
    return np.einsum(
        "ij...,jk...->ik...", Q, np.eye(2)[:, :, None] + 0.2 * rng.standard_normal((2, 2, points))
    )


@laws
def test_stress_is_the_gradient_of_the_energy(law):
    F = gradients()
    P = law.stress(F, LAM, MU)
    for i, j in np.ndindex(2, 2):
        dF = np.zeros((2, 2, 1))
        dF[i, j] = 1
        derivative = law.energy(F + 1j * STEP * dF, LAM, MU).imag / STEP
        np.testing.assert_allclose(P[i, j], derivative, rtol=0, atol=1e-13 * MU)


@laws
def test_tangent_is_the_derivative_of_the_stress_and_symmetric(law):
    F = gradients()
    A = law.tangent(F, LAM, MU)
    for k, m in np.ndindex(2, 2):
        dF = np.zeros((2, 2, 1))
        dF[k, m] = 1
        derivative = law.stress(F + 1j * STEP * dF, LAM, MU).imag / STEP
        np.testing.assert_allclose(A[:, :, k, m], derivative, rtol=0, atol=1e-12 * MU)
    np.testing.assert_allclose(A, A.transpose(2, 3, 0, 1, 4), rtol=0, atol=1e-12 * MU)


@laws
def test_rotation_changes_no_energy_and_turns_the_stress(law):
    F, angle = gradients(), 2.3
    Q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turned = np.einsum("ij,jk...->ik...", Q, F)
    np.testing.assert_allclose(law.energy(turned, LAM, MU), law.energy(F, LAM, MU), atol=1e-13 * MU)
    P = np.einsum("ij,jk...->ik...", Q, law.stress(F, LAM, MU))
    np.testing.assert_allclose(law.stress(turned, LAM, MU), P, atol=1e-12 * MU)


@laws
def test_small_uniaxial_stress_gives_youngs_modulus(law):
    strain = 1e-6
    F = np.diag([1 + strain, 1 - 0.3 * strain])[:, :, None]
    np.testing.assert_allclose(
        law.stress(F, LAM, MU)[:, :, 0], np.diag([2.1e4 * strain, 0]), atol=1e-5 * 2.1e4 * strain
    )


def test_biot_energy_is_quadratic_in_the_stretch_minus_identity():
    F = gradients()
    for point in range(F.shape[2]):
        U = polar(F[:, :, point], side="right")[1] - np.eye(2)
        expected = LAM / 2 * np.trace(U) ** 2 + MU * np.sum(U * U)
        assert MATERIALS["biot-linear"].energy(F[:, :, point], LAM, MU) == pytest.approx(expected, rel=1e-12)

"""Material laws: energies, their derivatives, small strains, and plane stress by the laws in three dimensions."""

import numpy as np
import pytest
from scipy.optimize import brentq

# A law at every gradient of deformation: strips reach few of them.
from fem_reference.material import MATERIALS, PLANES, elastic_law, in_plane_lam, lame_constants
from tests.fem_reference.conftest import NU, E, rotation

STEP = 1e-30

LAM, MU = lame_constants(E, NU)


@pytest.fixture(params=[(name, plane) for name in MATERIALS for plane in PLANES], ids="-".join)
def law(request):
    name, plane = request.param
    return elastic_law(name, E, NU, plane)


def gradients(points=5):
    """Deformation gradients near rotations by all angles."""
    rng = np.random.default_rng(1)
    Q = np.stack([rotation(angle) for angle in np.linspace(0, 2 * np.pi, points, endpoint=False)], axis=-1)
    return np.einsum(
        "ij...,jk...->ik...", Q, np.eye(2)[:, :, None] + 0.2 * rng.standard_normal((2, 2, points))
    )


def test_stress_and_symmetric_tangent_are_derivatives_of_the_energy(law):
    F = gradients()
    P, A = law.stress(F), law.tangent(F)
    for i, j in np.ndindex(2, 2):
        dF = np.zeros((2, 2, 1))
        dF[i, j] = STEP
        np.testing.assert_allclose(P[i, j], law.energy(F + 1j * dF).imag / STEP, rtol=0, atol=1e-12 * MU)
        derivative = law.stress(F + 1j * dF).imag / STEP
        np.testing.assert_allclose(A[:, :, i, j], derivative, rtol=0, atol=1e-11 * MU)
    np.testing.assert_allclose(A, A.transpose(2, 3, 0, 1, 4), rtol=0, atol=1e-12 * MU)


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("name", MATERIALS)
@pytest.mark.parametrize("nu", [-0.4, 0.0, 0.3, 0.4999])
def test_small_strains_are_hookes(name, plane, nu):
    """``dP/dF`` at rest is isotropic linear elasticity: ``lam tr(e) I + 2 mu e`` with the plane's lam."""
    lam, mu = lame_constants(E, nu)
    lam = in_plane_lam(lam, mu, plane)
    d = np.eye(2)
    expected = lam * np.einsum("ij,kl->ijkl", d, d) + mu * (
        np.einsum("ik,jl->ijkl", d, d) + np.einsum("il,jk->ijkl", d, d)
    )
    A = elastic_law(name, E, nu, plane).tangent(d[:, :, None])[..., 0]
    np.testing.assert_allclose(A, expected, rtol=0, atol=1e-12 * (lam + mu))


THREE_DIMENSIONAL = {
    "st-venant-kirchhoff": lambda C: ((C - 1) / 2).sum() ** 2 * LAM / 2 + MU * (((C - 1) / 2) ** 2).sum(),
    "biot-linear": lambda C: (np.sqrt(C) - 1).sum() ** 2 * LAM / 2 + MU * ((np.sqrt(C) - 1) ** 2).sum(),
    "neo-hookean": lambda C: MU / 2 * (C.sum() - 3 - np.log(C.prod())) + LAM / 8 * np.log(C.prod()) ** 2,
}


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("name", MATERIALS)
def test_plane_laws_are_the_three_dimensional_law_without_transverse_stress_or_strain(name, plane):
    """Principal stretches, the transverse one found by a bracketing root search on its stress."""
    W, F, law = THREE_DIMENSIONAL[name], gradients(), elastic_law(name, E, NU, plane)
    for point in range(F.shape[2]):
        in_plane = np.linalg.eigvalsh(F[:, :, point].T @ F[:, :, point])

        def transverse_stress(stretch, in_plane=in_plane):
            return W(np.array([*in_plane, (stretch + 1j * STEP) ** 2])).imag / STEP

        stretch = brentq(transverse_stress, 0.6, 1.6, xtol=1e-15) if plane == "stress" else 1.0
        assert law.energy(F[:, :, point]) == pytest.approx(W(np.array([*in_plane, stretch**2])), rel=1e-11)

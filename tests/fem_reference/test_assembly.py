import numpy as np
import pytest

from fem_reference.assembly import deformation_gradient
from fem_reference.body import build_body
from fem_reference.material import MATERIALS, in_plane_lam, lame_constants
from fem_reference.strip import ELEMENTS
from tests.fem_reference import bilinear_reference as reference
from tests.fem_reference.conftest import NU, STEP, B, E


@pytest.fixture(params=[(material, element) for material in MATERIALS for element in ELEMENTS], ids="-".join)
def body(request, strip):
    """Three rows, so that bilinear elements have no node at the clamp's middle."""
    material, element = request.param
    return build_body(strip(mesh=(4, 3), height=0.3, material=material, element=element, grading=2.0))


def displacements(body, size=0.005, seed=0):
    return size * np.random.default_rng(seed).standard_normal(body.mesh.nodes.shape)


def test_tangent_and_residual_equal_scikit_fems_own_assembly(strip):
    body = build_body(strip(mesh=(50, 2), element="Q2-full"))
    u = displacements(body, 1e-3)
    lam, mu = lame_constants(E, NU)
    basis = reference.vector_basis(body.mesh.nodes, body.mesh.cells)
    np.testing.assert_array_equal(basis.doflocs[:, ::2].T, body.mesh.nodes)
    K, f = reference.tangent_and_residual(basis, u.ravel(), in_plane_lam(lam, mu, "stress"), mu, B)
    T = body.expansion
    assert abs(body.tangent(u) - T.T @ K @ T).max() <= 1e-12 * abs(K).max()
    np.testing.assert_allclose(body.internal_force(u).ravel(), f, rtol=0, atol=1e-12 * np.abs(f).max())


def test_internal_force_is_the_gradient_of_the_energy(body):
    u, v = displacements(body), displacements(body, 1.0, 1)
    F = deformation_gradient(body.mesh, u + 1j * STEP * v)
    derivative = (body.law.energy(F) * body.mesh.weights).sum().imag / STEP
    assert np.sum(body.internal_force(u) * v) == pytest.approx(derivative, rel=1e-11)


def test_stiffness_is_the_derivative_of_the_internal_force(body):
    """Over what the clamp leaves free."""
    T = body.expansion
    u, dq = displacements(body), np.random.default_rng(1).standard_normal(T.shape[1])
    v = (T @ dq).reshape(-1, 2)
    derivative = T.T @ body.internal_force(u + 1j * STEP * v).imag.ravel() / STEP
    np.testing.assert_allclose(
        body.tangent(u) @ dq, derivative, rtol=0, atol=1e-12 * np.abs(derivative).max()
    )


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("rows", [2, 3])
def test_rods_clamp_holds_no_more_than_a_rigid_motion(strip, element, rows):
    """The clamp admits uniaxial stretching with lateral contraction, and none of the three rigid motions."""
    body = build_body(strip(mesh=(4, rows), height=0.3, element=element))
    T = body.expansion
    held = np.stack([np.ones(len(body.mesh.nodes)), np.zeros(len(body.mesh.nodes))], 1)
    x, y = body.mesh.nodes.T
    for free in (np.stack([x, -0.3 * y], 1), np.stack([0 * x, x], 1)):
        q = np.linalg.lstsq(T.toarray(), free.ravel(), rcond=None)[0]
        np.testing.assert_allclose(T @ q, free.ravel(), atol=1e-13)
    for motion in (held, held[:, ::-1], np.stack([-y, x], 1)):
        q, *_ = np.linalg.lstsq(T.toarray(), motion.ravel(), rcond=None)
        assert np.abs(T @ q - motion.ravel()).max() > 1e-3

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from fem_reference.assembly import deformation_gradient, element_dofs, element_tangents, internal_force
from fem_reference.material import MATERIALS, elastic_law, in_plane_lam, lame_constants
from fem_reference.mesh import discretise
from fem_reference.model import build

STEP = 1e-30
laws = pytest.mark.parametrize("material", MATERIALS)


def bilinear_reference():
    path = Path(__file__).with_name("bilinear_reference.py")
    spec = importlib.util.spec_from_file_location("bilinear_reference", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(params=MATERIALS)
def model(request, problem):
    return build(problem(mesh=(4, 2), height=0.3, material=request.param))


def plane_stress_constants():
    lam, mu = lame_constants(2.1e4, 0.3)
    return in_plane_lam(lam, mu, "stress"), mu


def displacements(model, size=0.005, seed=0):
    return size * np.random.default_rng(seed).standard_normal(model.mesh.nodes.shape)


def test_tangent_and_residual_equal_scikit_fems_own_assembly(problem):
    model = build(problem(mesh=(50, 2)))
    reference = bilinear_reference()
    u = displacements(model, 1e-3)
    basis = reference.vector_basis(model.mesh.nodes, model.mesh.cells)
    np.testing.assert_array_equal(basis.doflocs[:, ::2].T, model.mesh.nodes)
    K, f = reference.tangent_and_residual(basis, u.ravel(), *plane_stress_constants(), 0.02)
    free = model.stiffness.unknowns
    assert abs(model.solid_stiffness(u) - K[free][:, free]).max() <= 1e-12 * abs(K).max()
    np.testing.assert_allclose(model.internal_force(u).ravel(), f, rtol=0, atol=1e-12 * np.abs(f).max())


def test_internal_force_is_the_gradient_of_the_energy(model):
    u, v = displacements(model), displacements(model, 1.0, 1)
    F = deformation_gradient(model.mesh, u + 1j * STEP * v)
    derivative = (model.law.energy(F) * model.mesh.weights).sum().imag / STEP
    assert np.sum(model.internal_force(u) * v) == pytest.approx(derivative, rel=1e-12)


def test_stiffness_is_the_derivative_of_the_internal_force(model):
    u, v = displacements(model), displacements(model, 1.0, 1)
    free = model.stiffness.unknowns
    held = np.setdiff1d(np.arange(u.size), free)
    v.reshape(-1)[held] = 0
    derivative = model.internal_force(u + 1j * STEP * v).imag.ravel()[free] / STEP
    product = model.solid_stiffness(u) @ v.ravel()[free]
    np.testing.assert_allclose(product, derivative, rtol=0, atol=1e-12 * np.abs(derivative).max())


def test_stiffness_is_symmetric_with_three_rigid_modes(model):
    A = model.law.tangent(deformation_gradient(model.mesh, 0 * model.mesh.nodes))
    K = np.zeros((model.mesh.nodes.size,) * 2)
    for dofs, Ke in zip(element_dofs(model.mesh), element_tangents(model.mesh, A), strict=True):
        K[np.ix_(dofs, dofs)] += Ke
    np.testing.assert_allclose(K, K.T, rtol=0, atol=1e-13 * np.abs(K).max())
    eigenvalues = np.linalg.eigvalsh(K)
    assert np.sum(np.abs(eigenvalues) < 1e-11 * eigenvalues[-1]) == 3
    assert eigenvalues[0] > -1e-11 * eigenvalues[-1]


def test_rigid_motion_gives_no_force(model):
    angle = 2.0
    Q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    u = model.mesh.nodes @ Q.T + [3.0, -1.0] - model.mesh.nodes
    assert np.abs(model.internal_force(u)).max() < 1e-14 * 2.1e4 * 0.02 * 5


@laws
def test_patch_of_distorted_elements_passes_a_constant_stress(strip, material):
    """Interior nodes moved, displacements linear: no force inside, the stress's own tractions on the boundary."""
    mesh = discretise(strip(mesh=(3, 3), height=0.5))
    moved = mesh.nodes.copy()
    inside = (np.abs(mesh.nodes[:, 1]) < 0.24) & (mesh.nodes[:, 0] > 0.01) & (mesh.nodes[:, 0] < 0.99)
    corner = np.isin(np.arange(len(moved)), mesh.cells[:, :4])
    moved[inside & corner] += 0.03 * np.random.default_rng(2).standard_normal((np.sum(inside & corner), 2))
    basis = bilinear_reference().vector_basis(moved, mesh.cells)
    scalar = np.stack([basis.basis[2 * a][0].grad[0] for a in range(9)])
    G = np.ascontiguousarray(scalar.transpose(2, 1, 3, 0)).reshape(len(mesh.cells), -1, 9)
    patch = type(mesh)(
        nodes=basis.doflocs[:, ::2].T,
        cells=mesh.cells,
        gradients=G,
        weights=0.02 * basis.dx,
        nodal_gradients=G,
        columns=mesh.columns,
    )
    H = np.array([[0.1, 0.3], [-0.2, 0.05]])
    F = deformation_gradient(patch, patch.nodes @ H.T)
    np.testing.assert_allclose(F, (np.eye(2) + H)[:, :, None, None] + np.zeros(F.shape), atol=1e-13)
    P = elastic_law(material, 2.1e4, 0.3).stress(F)
    force = internal_force(patch, P)
    assert np.abs(force[inside]).max() < 1e-13 * 8e3
    right = np.abs(patch.nodes[:, 0] - 1) < 1e-12
    traction = P[:, 0, 0, 0] * 0.5 * 0.02
    np.testing.assert_allclose(force[right].sum(axis=0), traction, atol=1e-12 * 8e3)

"""Material laws, a patch test, and a manufactured solution in large strain on distorted meshes."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.sparse import csr_matrix, eye_array
from scipy.sparse.linalg import spsolve
from skfem import MeshQuad

# Laws at every gradient, displacements of a whole boundary, body forces: strips have none of them.
from fem_reference.solid.assembly import deformation_gradient, element_entries, internal_force, pattern
from fem_reference.solid.factor import full
from fem_reference.solid.mesh import from_basis, scalar_basis
from fem_reference.statement.material import MATERIALS, PLANES, elastic_law, lame_constants
from tests.fem_reference.strips import NU, E, elements, make_strip, rotation

STEP = 1e-30
laws = pytest.mark.parametrize("material", MATERIALS)


def distorted(element, n, height=0.6):
    """A mesh of n x n elements whose inner corners are displaced smoothly, by a third of a side where n = 4."""
    base = MeshQuad.init_tensor(np.linspace(0, 1, n + 1), np.linspace(-height / 2, height / 2, n + 1))
    x, y = base.p
    bubble = np.sin(np.pi * x) * np.cos(np.pi * y / height)
    moved = np.stack([x + 0.08 * bubble * np.cos(7 * y), y + 0.05 * bubble * np.sin(9 * x)])
    basis = scalar_basis(MeshQuad(moved, base.t[[0, 3, 2, 1]]), element)
    return from_basis(make_strip(), basis, {}, np.zeros(0), csr_matrix((0, 0)))


def solve_inside(mesh, law, exact, loads):
    """Newton's method with the displacements of the boundary prescribed, and nodal ``loads``."""
    x, y = mesh.nodes.T
    held = np.repeat((np.abs(x * (x - 1)) < 1e-9) | (np.abs(np.abs(y) - 0.3) < 1e-9), 2)
    T = eye_array(exact.size, format="csr")[:, np.flatnonzero(~held)]
    u = np.where(held.reshape(-1, 2), exact, 0.9 * exact)
    stiffness = pattern(mesh, csr_matrix(T))
    for _ in range(30):
        F = deformation_gradient(mesh, u)
        R = T.T @ (internal_force(mesh, law.stress(F)) - loads).ravel()
        step = spsolve(full(stiffness.band(element_entries(mesh, law.tangent(F)))), -R)
        u = u + (T @ step).reshape(-1, 2)
        if np.abs(step).max() < 1e-14:
            return u
    raise AssertionError("no convergence")


@elements
@laws
@pytest.mark.parametrize("plane", PLANES)
def test_patch_test(material, element, plane, stated):
    """Linear displacements on the boundary of distorted elements: a constant gradient inside, to 1e-12."""
    mesh = distorted(element, 4)
    H = np.array([[0.1, 0.3], [-0.2, 0.05]])
    exact = mesh.nodes @ H.T
    law = elastic_law(material, E, 0.3, plane)
    u = solve_inside(mesh, law, exact, 0 * exact)
    np.testing.assert_allclose(u, exact, rtol=0, atol=1e-12)
    stated("solid.patch", np.abs(u - exact).max(), part=True)
    P = law.stress(deformation_gradient(mesh, u))
    expected = law.stress((np.eye(2) + H)[:, :, None])[:, :, 0]
    np.testing.assert_allclose(P, expected[:, :, None, None] + 0 * P, rtol=0, atol=1e-10 * E)


def field(X, Y):
    """A smooth displacement with strains of a third."""
    return 0.1 * np.sin(2 * X + Y), 0.12 * np.cos(X - 2 * Y)


def gradient(X, Y):
    """``I`` plus the gradient of `field`, in closed form."""
    a, b = 2 * X + Y, X - 2 * Y
    return np.array([[1 + 0.2 * np.cos(a), 0.1 * np.cos(a)], [-0.12 * np.sin(b), 1 + 0.24 * np.sin(b)]])


@pytest.mark.slow_at("Q2-full-biot-linear", "Q2-st-venant-kirchhoff")
@pytest.mark.parametrize(
    ("element", "material"),
    [
        ("Q1", "st-venant-kirchhoff"),
        ("Q2-full", "biot-linear"),
        *(("Q2", material) for material in MATERIALS),
    ],
)
def test_manufactured_solution_in_large_strain(material, element, stated):
    """Orders p + 1 in the mean square of u and p in that of its gradient; body force by complex steps."""
    law = elastic_law(material, E, 0.3)
    errors = np.array([manufactured_errors(law, element, n) for n in (8, 16)])
    order = 1 if element == "Q1" else 2
    orders = np.log2(errors[0] / errors[1])
    assert orders[0] == pytest.approx(order + 1, abs=0.15)
    assert orders[1] == pytest.approx(order, abs=0.1)
    if (element, material) == ("Q2", "st-venant-kirchhoff"):
        stated("solid.orders", *orders)


def manufactured_errors(law, element, n):
    mesh = distorted(element, n)
    X, Y = np.asarray(mesh.basis.global_coordinates())
    force = -sum(
        law.stress(gradient(X + 1j * STEP * (j == 0), Y + 1j * STEP * (j == 1)))[:, j].imag / STEP
        for j in range(2)
    )
    shapes = np.stack([np.broadcast_to(np.asarray(part[0]), X.shape) for part in mesh.basis.basis])
    loads = np.zeros(mesh.nodes.shape)
    np.add.at(loads, mesh.cells, np.einsum("aeq,ieq,eq->eai", shapes, force, mesh.weights))
    exact = np.stack(field(*mesh.nodes.T), 1)
    u = solve_inside(mesh, law, exact, loads)
    difference = np.einsum("aeq,eai->ieq", shapes, u[mesh.cells]) - np.array(field(X, Y))
    slopes = deformation_gradient(mesh, u) - gradient(X, Y)
    return [np.sqrt((part**2 * mesh.weights).sum()) for part in (difference, slopes)]


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

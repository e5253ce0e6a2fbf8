"""Index of a state: signs of the factorisation against the eigenvalues of the dense reduced Hessian."""

from collections import Counter

import numpy as np
import pytest
from scipy.linalg import null_space
from scipy.sparse import csc_matrix

import fem_reference as fr
from fem_reference import factor
from fem_reference.factor import band_of, count_negatives, factorise
from fem_reference.model import build
from fem_reference.state import Condition, build_state
from fem_reference.tangent import linearise


def drawn(rng, strip):
    """A strip bent, compressed and disturbed, or two of them, under up to three contacts, each open or closed."""
    mesh = (int(rng.integers(2, 7)), int(rng.integers(1, 3)))
    changes = {
        "height": float(rng.uniform(0.02, 0.15)),
        "mesh": mesh,
        "element": str(rng.choice(fr.ELEMENTS)),
        "material": str(rng.choice(["st-venant-kirchhoff", "biot-linear"])),
    }
    strips = [strip(name="a", **changes)]
    if rng.random() < 0.4:
        strips.append(strip(name="b", start=(1.4, 0.2), end=(0.6, 0.15), **changes))
    pins, contacts = [], []
    for number in range(int(rng.integers(0, 3))):
        x, radius = rng.uniform(0.2, 0.9), rng.choice([0.0, 0.05])
        side, sign = (("left", 1), ("right", -1))[rng.integers(2)]
        surface = str(rng.choice(["axis", "face"]))
        y = sign * (radius + 0.2)
        pins.append(fr.Pin(name=f"p{number}", path=((float(x), y), (float(x), 0.0)), radius=float(radius)))
        penetration = [None, 1e-9][rng.integers(2)]
        penalty = [None, float(10 ** rng.uniform(-2, 3))][rng.integers(2)]
        contacts.append(
            fr.Contact(
                node=f"p{number}",
                strip="a",
                side=side,
                surface=surface,
                penalty=penalty,
                penetration=penetration,
            )
        )
    if len(strips) == 2:
        contacts.append(fr.Contact(node="b.end", strip="a", side="left"))
    model = build(fr.SolidProblem(strips=tuple(strips), pins=tuple(pins), contacts=tuple(contacts)))
    u = np.zeros((model.nodes, 2))
    for _, part in model.bodies_and_nodes():
        X = model.bodies[0].mesh.nodes
        angle = rng.uniform(-1, 1) * X[:, 0]
        press = rng.choice([0.0, rng.uniform(0, 0.3)])
        u[part, 0] = -press * X[:, 0] - X[:, 1] * np.sin(angle)
        u[part, 1] = 0.3 * np.sin(angle) * X[:, 0]
        u[part] += 0.02 * changes["height"] * rng.standard_normal(X.shape)
    EI = strips[0].bending_stiffness
    conditions = tuple(
        Condition(closed=bool(rng.random() < 0.7), force=float(EI * 10 ** rng.uniform(-1, 2)))
        for _ in contacts
    )
    return model, build_state(model, u, 1.0, conditions)


def dense_index(model, at):
    """Count the negative eigenvalues of the Hessian with springs, over what constraints leave free."""
    blocks = [body.tangent(at.u[part]).toarray() for body, part in model.bodies_and_nodes()]
    sizes = np.cumsum([0, *map(len, blocks)])
    A = np.zeros((sizes[-1], sizes[-1]))
    for block, start in zip(blocks, sizes, strict=False):
        A[start : start + len(block), start : start + len(block)] = block
    held = np.zeros((len(A), 0))
    for touch in at.closed:
        U = model.expansion.T @ touch.slopes
        A -= touch.force * U @ touch.curvature @ U.T
        if touch.pair.contact.penetration is None:
            A += touch.pair.penalty * np.outer(U[:, 0], U[:, 0])
        else:
            held = np.column_stack([held, U[:, 0] / np.linalg.norm(U[:, 0])])
    Z = null_space(held.T) if held.size else np.eye(len(A))
    return int((np.linalg.eigvalsh(Z.T @ A @ Z) < 0).sum())


@pytest.mark.parametrize(
    ("seed", "count"), [(14, 60), *(pytest.param(k, 300, marks=pytest.mark.slow) for k in (1,))]
)
def test_index_is_that_of_the_dense_reduced_hessian_on_every_drawn_state(strip, seed, count):
    rng, seen = np.random.default_rng(seed), Counter()
    for number in range(count):
        model, at = drawn(rng, strip)
        tangent = linearise(model, at)
        found = tangent.index()
        assert found == dense_index(model, at), number
        seen[min(found, 5)] += 1
        seen["closed"] += len(at.closed) > 0
        seen["indefinite body"] += sum(one.negatives() for one in tangent.factors) > 0
    assert min(seen[index] for index in range(5)) > count / 60
    assert min(seen["closed"], seen["indefinite body"]) > count / 5


def symmetric(rng, m=40, width=6):
    """A sparse symmetric matrix of either sign, in compressed columns."""
    dense = np.triu(np.tril(rng.standard_normal((m, m)), width), -width)
    return csc_matrix(dense + dense.T)


@pytest.mark.parametrize("growth", [None, 0.0])
def test_negatives_are_counted_whether_or_not_pivots_are_trusted(monkeypatch, growth):
    """With no growth allowed, the eigenvalues themselves are counted; the solution is that of K either way."""
    if growth is not None:
        monkeypatch.setattr(factor, "_GROWTH", growth)
    rng = np.random.default_rng(0)
    for _ in range(50):
        K = symmetric(rng)
        found = factorise(K, band_of(K.indices, K.indptr))
        assert found.negatives() == (np.linalg.eigvalsh(K.toarray()) < 0).sum()
        b = rng.standard_normal((40, 2))
        np.testing.assert_allclose(K @ found.solve(b), b, atol=1e-8)


def test_pivots_that_vanish_or_grow_are_not_trusted():
    """``[[0, 1], [1, 0]]`` has no pivot on its diagonal, ``[[e, 1], [1, 0]]`` one that spoils the next."""
    for corner in (0.0, 1e-12):
        K = csc_matrix(np.array([[corner, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -2.0]]))
        found = factorise(K, band_of(K.indices, K.indptr))
        assert found.negatives() == 2
        np.testing.assert_allclose(found.solve(np.array([1.0, 2.0, 3.0])), [2, 1, -1.5], atol=1e-9)


def test_singular_matrix_has_no_factor():
    K = csc_matrix(np.zeros((3, 3)) + np.diag([0.0, 1.0, 1.0]))
    K.data[:] = K.data
    assert factorise(K, band_of(K.indices, K.indptr)) is None
    assert count_negatives(np.array([[-1.0, 2.0, -3.0]])) == 2

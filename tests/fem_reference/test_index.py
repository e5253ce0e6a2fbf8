"""Index of a state: signs of the factorisation against the eigenvalues of the dense reduced Hessian."""

from collections import Counter

import numpy as np
import pytest
from scipy.linalg import null_space

import fem_reference as fr
from fem_reference.model import build
from fem_reference.state import build_state
from fem_reference.tangent import linearise
from fem_reference.touch import Condition
from tests.fem_reference.conftest import dense_hessian


def drawn(rng, strip):
    """One or two random strips, bent, compressed and disturbed, with up to three contacts, open or closed."""
    mesh = (int(rng.integers(2, 7)), int(rng.integers(1, 3)))
    changes = {
        "height": float(rng.uniform(0.02, 0.15)),
        "mesh": mesh,
        "element": str(rng.choice(fr.ELEMENTS)),
        "material": str(rng.choice(["st-venant-kirchhoff", "biot-linear"])),
    }
    held = {name: bool(rng.random() < 0.3) for name in "ab"}  # by sections, without a clamp
    strips = [strip(name="a", clamped=() if held["a"] else ("start",), **changes)]
    if rng.random() < 0.4:
        ends = {"start": (1.4, 0.2), "end": (0.6, 0.15), "clamped": () if held["b"] else ("start",)}
        strips.append(strip(name="b", **ends, **changes))
    pins, contacts = [], []
    for number in range(int(rng.integers(0, 3))):
        x, radius = rng.uniform(0.2, 0.9), rng.choice([0.0, 0.05])
        side, sign = (("left", 1), ("right", -1))[rng.integers(2)]
        values = {"side": side, "surface": str(rng.choice(["axis", "face"]))}
        path = ((float(x), sign * (radius + 0.2)), (float(x), 0.0))
        pins.append(fr.Pin(name=f"p{number}", path=path, radius=float(radius)))
        values["penetration"] = [None, 1e-9][rng.integers(2)]
        values["penalty"] = [None, float(10 ** rng.uniform(-2, 3))][rng.integers(2)]
        contacts.append(fr.Contact(node=f"p{number}", strip="a", **values))
    if len(strips) == 2:
        contacts.append(fr.Contact(node="b.end", strip="a", side="left"))
    supports, joints = sections_held(rng, strips)
    between = {"start": (1.0, 0.0), "end": (1.4, 0.2), "clamped": ()}
    model = build(
        fr.SolidProblem(
            strips=(*strips, *(strip(name="c", **between, **changes) for _ in joints[:1])),
            pins=tuple(pins),
            contacts=tuple(contacts),
            supports=supports,
            joints=joints,
        )
    )
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
    forces = EI * rng.standard_normal(len(model.ties)) * 10 ** rng.uniform(-1, 1)
    return model, build_state(model, u, 1.0, conditions, forces)


def sections_held(rng, strips):
    """Supports of the strips without a clamp, and perhaps a third strip that joins the two."""
    supports = []
    for part in strips:
        if not part.clamped:
            motions = [
                ((0.0, 0.0, 0.0), None),
                ((0.0, 0.0, None), (None, 0.0, None)),
                ((None, 0.0, 0.0), (0.0, None, None)),
            ]
            chosen = motions[rng.integers(3)]
            ends = zip(("start", "end"), chosen, strict=True)
            supports += [
                fr.Support(strip=part.name, end=end, motion=motion) for end, motion in ends if motion
            ]
    joined = len(strips) == 2 and not strips[1].clamped
    joints = (fr.Joint(ends=("a.end", "c.start")), fr.Joint(ends=("b.start", "c.end"))) if joined else ()
    return tuple(supports), joints


def dense_index(model, state):
    """Count the negative eigenvalues of the Hessian with springs, over the displacements that constraints admit."""
    A, gradients = dense_hessian(model, state)
    constraints = np.zeros((len(A), 0))
    for touch, gradient in zip(state.closed, gradients, strict=False):
        if touch.pair.contact.penetration is None:
            A += touch.pair.penalty * np.outer(gradient, gradient)
        else:
            constraints = np.column_stack([constraints, gradient / np.linalg.norm(gradient)])
    for gradient in gradients[len(state.closed) :]:
        constraints = np.column_stack([constraints, gradient / np.linalg.norm(gradient)])
    Z = null_space(constraints.T) if constraints.size else np.eye(len(A))
    return int((np.linalg.eigvalsh(Z.T @ A @ Z) < 0).sum())


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "count"), [(14, 60), pytest.param(1, 300, marks=pytest.mark.slow)])
def test_index_is_that_of_the_dense_reduced_hessian_on_every_drawn_state(strip, seed, count):
    rng, seen = np.random.default_rng(seed), Counter()
    for number in range(count):
        model, state = drawn(rng, strip)
        tangent = linearise(model, state)
        index = tangent.index()
        assert index == dense_index(model, state), number
        seen[min(index, 5)] += 1
        seen["closed"] += len(state.closed) > 0
        seen["tied"] += len(model.ties) > 0
        seen["joined"] += len(model.problem.joints) > 0
        seen["indefinite body"] += sum(body.negatives() for body in tangent.factors) > 0
    assert min(seen[index] for index in range(5)) > count / 60
    assert min(seen["closed"], seen["indefinite body"], seen["tied"]) > count / 5
    assert seen["joined"] > count / 30

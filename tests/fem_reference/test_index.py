"""Index of a state: signs of the factorisation against the eigenvalues of the dense reduced Hessian."""

from collections import Counter

import numpy as np
import pytest
from scipy.linalg import block_diag, null_space

import fem_reference as fr
from fem_reference.model import build  # drawn states are in no equilibrium: no solution has them
from fem_reference.state import build_state, section_actions
from fem_reference.tangent import linearise
from fem_reference.touch import Condition
from tests.fem_reference.conftest import (
    EA,
    EI,
    STRIP,
    held,
    make_problem,
    make_strip,
    portal,
    support,
    upper_on_lower,
)
from tests.fem_reference.test_newton import springs_and_hinges


def two_pins(rng, **changes):
    """A strip between two pins, one of them round, without or with the penetration removed."""
    sides = {"right": (-1, 0.0, "axis"), "left": (1, 0.05, str(rng.choice(["axis", "face"])))}
    pins, contacts = [], []
    for side, (sign, radius, surface) in sides.items():
        x = float(rng.uniform(0.2, 0.9))
        pins.append(fr.Pin(name=side, path=((x, sign * (radius + 0.2)), (x, 0.0)), radius=radius))
        values = {"penetration": [None, 1e-9][rng.integers(2)], "penalty": float(10 ** rng.uniform(-2, 3))}
        contacts.append(fr.Contact(node=side, strip=STRIP, side=side, surface=surface, **values))
    return fr.SolidProblem(strips=(make_strip(**changes),), pins=tuple(pins), contacts=tuple(contacts))


def drawn_problem(rng):
    changes = {
        "height": float(rng.uniform(0.02, 0.15)),
        "mesh": (int(rng.integers(2, 7)), int(rng.integers(1, 3))),
        "element": str(rng.choice(fr.ELEMENTS)),
        "material": str(rng.choice(["st-venant-kirchhoff", "biot-linear"])),
    }
    match rng.integers(6):
        case 0:
            return portal()
        case 1:
            return springs_and_hinges()
        case 2:
            return upper_on_lower((4, 1), penetration=[None, 1e-9][rng.integers(2)])
        case 3:
            return held(support(motion=(None, 0.0, 0.0)), support("end", (0.0, None, None)), **changes)
        case _:
            return two_pins(rng, **changes)


def drawn(rng):
    """A state of a drawn problem, bent, compressed and disturbed, with contacts open or closed."""
    model = build(drawn_problem(rng))
    u = np.zeros((model.nodes, 2))
    for body, part in model.bodies_and_nodes():
        X = body.mesh.nodes
        angle = rng.uniform(-1, 1) * X[:, 0]
        press = rng.choice([0.0, rng.uniform(0, 0.3)])
        u[part, 0] = -press * X[:, 0] - X[:, 1] * np.sin(angle)
        u[part, 1] = 0.3 * np.sin(angle) * X[:, 0]
        u[part] += 0.02 * body.strip.height * rng.standard_normal(X.shape)
    scale = model.problem.strips[0].bending_stiffness
    conditions = tuple(
        Condition(closed=bool(rng.random() < 0.7), force=float(scale * 10 ** rng.uniform(-1, 2)))
        for _ in model.pairs
    )
    forces = scale * rng.standard_normal(len(model.ties)) * 10 ** rng.uniform(-1, 1)
    return model, build_state(model, u, 1.0, conditions, forces)


def dense_index(model, state):
    """Negative eigenvalues of ``K - sum lam g'' - sum m theta''`` with springs, over the displacements that constraints admit."""
    A = block_diag(*(body.tangent(state.u[part]).toarray() for body, part in model.bodies_and_nodes()))
    constraints = []
    for touch in state.closed:
        U = model.restriction @ touch.slopes
        A += -touch.force * U @ touch.curvature @ U.T
        if touch.pair.contact.penetration is None:
            A += touch.pair.penalty * np.outer(U[:, 0], U[:, 0])
        else:
            constraints.append(U[:, 0])
    columns = np.split(model.restriction @ model.columns, max(len(model.sections), 1), axis=1)
    for U, pose, action in zip(columns, state.poses, section_actions(model, state), strict=False):
        A -= action[2] * U @ pose.curvature @ U.T
    for tie in model.ties:
        gradient = columns[tie.section] @ state.poses[tie.section].gradient[:, tie.component]
        if tie.other is not None:
            gradient = gradient - columns[tie.other] @ state.poses[tie.other].gradient[:, tie.component]
        if tie.flexibility:
            A += np.outer(gradient, gradient) / tie.flexibility
        else:
            constraints.append(gradient)
    G = np.array([gradient / np.linalg.norm(gradient) for gradient in constraints])
    Z = null_space(G) if constraints else np.eye(len(A))
    return int((np.linalg.eigvalsh(Z.T @ A @ Z) < 0).sum())


@pytest.mark.slow_at("1-300")
@pytest.mark.parametrize(("seed", "count"), [(3, 25), (1, 300)])
def test_index_is_that_of_the_dense_reduced_hessian_on_every_drawn_state(seed, count):
    rng, seen = np.random.default_rng(seed), Counter()
    for number in range(count):
        model, state = drawn(rng)
        tangent = linearise(model, state)
        index = tangent.index()
        assert index == dense_index(model, state), number
        seen[min(index, 5)] += 1
        seen["closed"] += len(state.closed) > 0
        seen["tied"] += len(model.ties) > 0
        seen["indefinite body"] += sum(body.negatives() for body in tangent.factors) > 0
    assert min(seen[index] for index in range(5)) > count / 60
    assert min(seen["closed"], seen["indefinite body"], seen["tied"]) > count / 5


def test_contact_closed_without_force_has_no_index_where_its_sides_differ():
    """A straight column at twice its buckling load that a pin just touches is stable if the contact is closed only."""
    model = build(make_problem(path=((1.0, 0.0), (1.0, 0.1)), mesh=(10, 1), contact={"penalty": None}))
    u = np.zeros((model.nodes, 2))
    u[:, 0] = -2 * (np.pi / 2) ** 2 * EI / EA * model.bodies[0].mesh.nodes[:, 0]
    for force, expected in ((1e-3, 0), (1e-13, -1), (None, 1)):
        condition = Condition() if force is None else Condition(closed=True, force=force)
        tangent = linearise(model, build_state(model, u, 0.0, (condition,)))
        assert tangent.index(force_tolerance=1e-12) == expected

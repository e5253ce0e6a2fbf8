"""Index of a state: signs of the factorisation against the eigenvalues of the dense reduced Hessian."""

from collections import Counter

import numpy as np
import pytest
from scipy.linalg import null_space

import fem_reference as fr
from fem_reference.model import build  # drawn states are in no equilibrium: no solution has them
from fem_reference.state import build_state, section_actions
from fem_reference.tangent import linearise
from fem_reference.touch import Condition
from tests.fem_reference.conftest import EA, EI, make_problem, make_strip

HELD = [
    ((0.0, 0.0, 0.0), None),
    ((0.0, 0.0, None), (None, 0.0, None)),
    ((None, 0.0, 0.0), (0.0, None, None)),
]


def drawn_problem(rng):
    """One or two strips, clamped or held by sections and perhaps joined by a third, with up to three contacts."""
    changes = {
        "height": float(rng.uniform(0.02, 0.15)),
        "mesh": (int(rng.integers(2, 7)), int(rng.integers(1, 3))),
        "element": str(rng.choice(fr.ELEMENTS)),
        "material": str(rng.choice(["st-venant-kirchhoff", "biot-linear"])),
    }
    places = {"a": ((0.0, 0.0), (1.0, 0.0)), "b": ((1.4, 0.2), (0.6, 0.15)), "c": ((1.0, 0.0), (1.4, 0.2))}

    def strip(name, clamped=()):
        start, end = places[name]
        return make_strip(name=name, start=start, end=end, clamped=clamped, **changes)

    strips = [
        strip(name, () if rng.random() < 0.3 else ("start",))
        for name in ("a", "b")[: 1 + (rng.random() < 0.4)]
    ]
    supports = [
        fr.Support(strip=part.name, end=end, motion=motion)
        for part in strips
        if not part.clamped
        for end, motion in zip(("start", "end"), HELD[rng.integers(3)], strict=True)
        if motion
    ]
    pins, contacts = [], []
    for number in range(int(rng.integers(0, 3))):
        x, radius = float(rng.uniform(0.2, 0.9)), float(rng.choice([0.0, 0.05]))
        side, sign = (("left", 1), ("right", -1))[rng.integers(2)]
        pins.append(fr.Pin(name=f"p{number}", path=((x, sign * (radius + 0.2)), (x, 0.0)), radius=radius))
        contacts.append(
            fr.Contact(
                node=f"p{number}",
                strip="a",
                side=side,
                surface=str(rng.choice(["axis", "face"])),
                penetration=[None, 1e-9][rng.integers(2)],
                penalty=[None, float(10 ** rng.uniform(-2, 3))][rng.integers(2)],
            )
        )
    joints = ()
    if len(strips) == 2:
        contacts.append(fr.Contact(node="b.end", strip="a", side="left"))
        if not strips[1].clamped:
            strips.append(strip("c"))
            joints = (fr.Joint(ends=("a.end", "c.start")), fr.Joint(ends=("b.start", "c.end")))
    return fr.SolidProblem(
        strips=tuple(strips),
        pins=tuple(pins),
        contacts=tuple(contacts),
        supports=tuple(supports),
        joints=joints,
    )


def drawn(rng):
    """A state of a drawn problem, bent, compressed and disturbed, with contacts open or closed."""
    model = build(drawn_problem(rng))
    u = np.zeros((model.nodes, 2))
    for _, part in model.bodies_and_nodes():
        X = model.bodies[0].mesh.nodes
        angle = rng.uniform(-1, 1) * X[:, 0]
        press = rng.choice([0.0, rng.uniform(0, 0.3)])
        u[part, 0] = -press * X[:, 0] - X[:, 1] * np.sin(angle)
        u[part, 1] = 0.3 * np.sin(angle) * X[:, 0]
        u[part] += 0.02 * model.problem.strips[0].height * rng.standard_normal(X.shape)
    scale = model.problem.strips[0].bending_stiffness
    conditions = tuple(
        Condition(closed=bool(rng.random() < 0.7), force=float(scale * 10 ** rng.uniform(-1, 2)))
        for _ in model.pairs
    )
    forces = scale * rng.standard_normal(len(model.ties)) * 10 ** rng.uniform(-1, 1)
    return model, build_state(model, u, 1.0, conditions, forces)


def dense_index(model, state):
    """Negative eigenvalues of ``K - sum lam g'' - sum m theta''`` with springs, over the displacements that constraints admit."""
    A = np.zeros((model.unknowns, model.unknowns))
    for (body, part), own in zip(model.bodies_and_nodes(), model.unknowns_of_bodies, strict=True):
        A[own, own] = body.tangent(state.u[part]).toarray()
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
        constraints.append(gradient)
    G = np.array([gradient / np.linalg.norm(gradient) for gradient in constraints])
    Z = null_space(G) if constraints else np.eye(len(A))
    return int((np.linalg.eigvalsh(Z.T @ A @ Z) < 0).sum())


@pytest.mark.slow_at("14-60", "1-300")
@pytest.mark.parametrize(("seed", "count"), [(3, 25), (14, 60), (1, 300)])
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
        seen["joined"] += len(model.problem.joints) > 0
        seen["indefinite body"] += sum(body.negatives() for body in tangent.factors) > 0
    assert min(seen[index] for index in range(5)) > count / 60
    assert min(seen["closed"], seen["indefinite body"], seen["tied"]) > count / 5
    assert seen["joined"] > count / 30


def test_contact_closed_without_force_has_no_index_where_its_sides_differ():
    """A straight column at twice its buckling load that a pin just touches is stable if the contact is closed only."""
    model = build(make_problem(path=((1.0, 0.0), (1.0, 0.1)), mesh=(10, 1), contact={"penalty": None}))
    u = np.zeros((model.nodes, 2))
    u[:, 0] = -2 * (np.pi / 2) ** 2 * EI / EA * model.bodies[0].mesh.nodes[:, 0]
    for force, expected in ((1e-3, 0), (1e-13, -1), (None, 1)):
        condition = Condition() if force is None else Condition(closed=True, force=force)
        tangent = linearise(model, build_state(model, u, 0.0, (condition,)))
        assert tangent.index(force_tolerance=1e-12) == expected

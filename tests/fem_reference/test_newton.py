"""Newton's corrections and the index at states away from equilibrium, and the statuses with which an iteration ends."""

from collections import Counter
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.linalg import block_diag, null_space

import fem_reference as fr
from fem_reference.contact.friction import stiffness  # of a stick, whose force turns
from fem_reference.path.march import slipped_off  # no path is known on which Newton's method diverges so
from fem_reference.solid.assembly import deformation_gradient
from fem_reference.solid.factor import full
from fem_reference.statement.material import Law, lame_constants
from fem_reference.statement.status import Status
from fem_reference.system import newton  # steps that are cut would hide a status
from fem_reference.system.body import build_body  # the stiffness of a strip alone, against scikit-fem's
from fem_reference.system.model import build  # drawn states are in no equilibrium: no solution has them
from fem_reference.system.state import at_rest
from fem_reference.system.system import linearise  # the tangent: a wrong one costs iterations only
from tests.fem_reference import bilinear_reference as reference
from tests.fem_reference.strips import (
    EA,
    EI,
    NU,
    B,
    E,
    held,
    load,
    make_problem,
    make_strip,
    portal,
    upper_on_lower,
)


def test_tangent_and_residual_equal_scikit_fems_own_assembly():
    body = build_body(make_strip(element="Q2-full"))
    u = 1e-3 * np.random.default_rng(0).standard_normal(body.mesh.nodes.shape)
    lam, mu = lame_constants(E, NU)
    basis = reference.vector_basis(body.mesh.nodes, body.mesh.cells)
    np.testing.assert_array_equal(basis.doflocs[:, ::2].T, body.mesh.nodes)
    K, f = reference.tangent_and_residual(basis, u.ravel(), 2 * lam * mu / (lam + 2 * mu), mu, B)
    T, F = body.expansion, deformation_gradient(body.mesh, u)
    assert abs(full(body.band(F)) - T.T @ K @ T).max() <= 1e-12 * abs(K).max()
    np.testing.assert_allclose(body.internal_force(F).ravel(), f, rtol=0, atol=1e-12 * np.abs(f).max())


def noisy(problem, size=0.005, forces=0.0):
    model, rng = build(problem), np.random.default_rng(0)
    u = model.displacements(size * rng.standard_normal(model.unknowns))
    return at_rest(model).moved(u, 0.7, forces * rng.standard_normal(len(model.ties)))


@cache
def reached(problem, load_parameters):
    return fr.solve(problem, np.array(load_parameters))


def disturbed(problem, load_parameters, t, direction=0, scale=1.0):
    """State at t with the displacements of the last of some load parameters, with other forces."""
    last = reached(problem, load_parameters).states[-1]
    assert all(touch.closed for touch in last.touches)
    assert all(touch.slipped != 0 for touch in last.rubbing)
    slips = last.touching([replace(touch, direction=direction) for touch in last.touches])
    factors = np.repeat([1.1, 1.2, 1.05], [len(last.closed), len(last.rubbing), last.tie_forces.size])
    return slips.moved(scale * last.u, t, factors * last.forces)


def springs_and_hinges():
    strips = (
        make_strip(name="a", end=(0.5, 0.0), mesh=(4, 1), end_height=0.03),
        make_strip(name="b", start=(0.5, 0.0), end=(0.5, 0.5), clamped=(), mesh=(4, 1)),
    )
    return fr.SolidProblem(
        strips=strips,
        joints=(fr.Joint(ends=("a.end", "b.start"), hinged=("b.start",), stiffness=(EI,)),),
        springs=(fr.Spring(strip="b", end="end", stiffness=(EI, 2 * EI, 3 * EI)),),
        loads=(
            fr.LineLoad(strip="b", force=((EI, 0.0), (0.0, EI))),
            fr.PointLoad(strip="a", at=0.3, moment=EI),
        ),
    )


def pinned(at, radius=0.0, **contact):
    """A strip turned by .4 under a pin, at a place along it: on a node, within an element, near the end."""
    side = -1 if contact.get("side", "right") == "right" else 1
    y = side * ((0.1 if contact.get("surface") == "face" else 0.0) + radius)
    Q = np.array([[np.cos(0.4), -np.sin(0.4)], [np.sin(0.4), np.cos(0.4)]])
    path = tuple(tuple(map(float, Q @ point)) for point in ((at, y), (at - 0.05, y - side * 0.3)))
    changes = {"end": tuple(map(float, Q[:, 0])), "height": 0.2, "mesh": (5, 2)}
    return make_problem(path=path, radius=radius, contact=contact, **changes)


def rolled(direction):
    problem = make_problem(contact={"friction": 0.3, "surface": "face"}, radius=0.05, mesh=(10, 1))
    return disturbed(problem, (0.1, 0.2), 0.2002, direction)


def rubbed(direction):
    return disturbed(upper_on_lower((8, 1), friction=0.3), (0.4, 0.5), 0.502, direction)


CASES = {
    f"{material}-{element}": lambda material=material, element=element: noisy(
        held(clamped=("start",), mesh=(4, 3), height=0.3, material=material, element=element)
    )
    for material, element in zip(fr.MATERIALS, fr.ELEMENTS, strict=True)
} | {
    "plane-strain": lambda: noisy(held(clamped=("end",), mesh=(4, 3), height=0.3, plane="strain")),
    "arc": lambda: noisy(
        held(clamped=("end",), clamp="rod", mesh=(6, 3), height=0.1, end_height=0.2, turn=1.5, element="Q1"),
        1e-3,
    ),
    "springs-hinges": lambda: noisy(springs_and_hinges(), 1e-3, EI),
    "frame": lambda: disturbed(portal(), (0.5, 1.0), 0.9, scale=1.01),
    "end": lambda: disturbed(upper_on_lower((8, 1), surface="axis"), (0.4, 0.5), 0.502),
    "axis-node": lambda: disturbed(pinned(0.6), (0.5, 1.0), 0.99),
    "axis-left-element": lambda: disturbed(pinned(0.53, side="left"), (0.5, 1.0), 0.99),
    "face-round": lambda: disturbed(pinned(0.75, 0.05, surface="face", penetration=1e-6), (0.5, 1.0), 0.99),
    "face-left-end": lambda: disturbed(pinned(0.97, surface="face", side="left"), (0.1, 0.2), 0.21),
    "roll": lambda: rolled(0),
    "round-slip": lambda: rolled(-1),
    "end-stick": lambda: rubbed(0),
    "end-slip": lambda: rubbed(1),
}


@pytest.mark.parametrize("case", CASES)
def test_a_correction_removes_the_linear_part_of_all_residuals(case):
    """``J c = -r`` with the derivative J along c by central differences, extrapolated."""
    state = CASES[case]()
    correction = linearise(state).correction()

    def residuals(at):
        return at.reduced, at.residuals

    def slopes(h):
        ahead, behind = (residuals(newton.corrected(state, correction, step)) for step in (h, -h))
        return [(a - b) / (2 * h) for a, b in zip(ahead, behind, strict=True)]

    for few, many, old, round_off in zip(
        slopes(2e-3), slopes(4e-3), residuals(state), (1e-10, 1e-13), strict=True
    ):
        allowed = 1e-8 * np.abs(old).max(initial=0.0) + round_off
        np.testing.assert_allclose((4 * few - many) / 3, -old, rtol=0, atol=allowed)


def with_law(model, energy, stress, tangent):
    law = Law(energy=energy, stress=stress, tangent=tangent)
    return replace(model, bodies=(replace(model.bodies[0], law=law),))


@cache
def pin_at(*point, **settings):
    path = ((point[0], -1.0), point)
    return build(make_problem(path=path, mesh=(10, 1)), fr.Settings(**settings))


def touching(model, u=0.0, **contact):
    """State at the pin's point with some displacements and a closed contact."""
    state = at_rest(model, 1.0)
    touches = [replace(touch, closed=True, **contact) for touch in state.touches]
    return state.touching(touches).moved(u + 0 * state.u, 1.0)


def solved(model):
    """Attempt at the pin's point from rest."""
    return newton.equilibrium(at_rest(model, 1.0))


def test_what_is_not_finite_or_singular_or_out_of_balance_or_cycles_is_a_status():
    """Laws without stiffness, linear in the displacement gradient (a rotated element has moments), and with reversed stiffness."""
    model = pin_at(0.7, 0.2)
    law = model.bodies[0].law
    A = law.tangent(np.eye(2)[:, :, None])[..., 0]

    def stress(F):
        return np.einsum("ijkl,kl...->ij...", A, F - np.eye(2).reshape(2, 2, *(1,) * (F.ndim - 2)))

    def tangent(F):
        return A.reshape(2, 2, 2, 2, *(1,) * (F.ndim - 2)) + np.zeros((2, 2, *F.shape))

    empty = with_law(model, lambda F: 0 * F[0, 0], lambda F: 0 * F, lambda F: np.zeros((2, 2, *F.shape)))
    false = with_law(model, lambda F: (stress(F) * F).sum(axis=(0, 1)) / 2, stress, tangent)
    reversed_ = with_law(
        pin_at(0.9, 0.01), lambda F: -law.energy(F), lambda F: -law.stress(F), lambda F: -law.tangent(F)
    )
    assert newton.equilibrium(touching(model, np.nan)).status is Status.NOT_FINITE
    assert solved(empty).status is Status.SINGULAR
    assert solved(false).status is Status.UNBALANCED
    cycles = solved(reversed_)
    assert (cycles.status, cycles.pair) == (Status.CYCLING, 0)


def test_limits_of_an_attempt_are_statuses(monkeypatch):
    few = solved(pin_at(0.9, 0.1, max_iterations=1))
    assert (few.status, few.iterations) == (Status.ITERATION_LIMIT, 1)
    monkeypatch.setattr(newton, "_MAX_CONTACT_CHANGES", 0)
    undecided = newton.equilibrium(touching(pin_at(0.9, -0.1)))
    assert (undecided.status, undecided.pair) == (Status.UNDECIDED_CONTACT, 0)
    assert solved(pin_at(1.2, 0.1)).status is Status.LOST_CONTACT
    assert solved(pin_at(1.2, -0.1)).status is Status.CONVERGED


def test_a_contact_is_lost_over_an_end_that_its_node_has_reached():
    """Newton's method that diverges may leave a contact anywhere. The node does not go through the strip then."""
    for x, lost in ((0.5, None), (0.02, None), (0.98, None), (0.9999, 0), (1e-4, 0)):
        before = touching(pin_at(x, 0.0), force=1.0)
        assert slipped_off(before, newton.Attempt(status=Status.LOST_CONTACT, state=before, pair=0)) == lost


def test_a_step_of_displacement_control_that_is_not_finite_ends_without_a_state():
    """The search for a limit point may diverge. It then has no load parameter at which a pin could be placed."""
    problem = make_problem(path=((0.7, -0.1), (0.7, 0.3)), mesh=(10, 1))
    start = at_rest(build(replace(problem, loads=(load(force=(0.0, EI)),))))
    rate = linearise(start).rate(0.0, 1e-6).u
    control = newton.Control(origin=start.u, c=rate / np.linalg.norm(rate), delta=np.inf)
    assert newton.iterate(start, control).status is Status.SINGULAR


def dense_index(state):
    """Negative eigenvalues of the tangent with springs, over the displacements that constraints admit; a stick none along the strip."""
    model, constraints = state.model, []
    bands = [body.band(F) for body, F in zip(model.bodies, state.gradients, strict=True)]
    A = block_diag(*(full(band).toarray() for band in bands))
    for touch in state.closed:
        U = model.restriction @ touch.columns
        A -= U @ stiffness(touch) @ U.T
        if touch.pair.contact.penetration is None:
            A += touch.pair.penalty * np.outer(U[:, 0], U[:, 0])
        else:
            constraints.append(U[:, 0])
        if touch.rubs:
            constraints.append(U[:, 1])
    columns = np.split(model.restriction @ model.columns, max(len(model.sections), 1), axis=1)
    for U, section, pose, action in zip(columns, model.sections, state.poses, state.actions, strict=False):
        A -= U @ (action[2] * pose.curvature + section.anchor_stiffness * np.eye(4)) @ U.T
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
    return int((np.linalg.eigvalsh(Z.T @ (A + A.T) @ Z) < 0).sum())


def test_index_is_that_of_the_dense_reduced_hessian_on_every_drawn_state():
    """Every state above is compressed along its strips, more and more. A slip has no index."""
    seen = Counter()
    for case, make in CASES.items():
        state = make()
        bodies = state.model.bodies
        along = [(body.mesh.nodes, np.array(body.strip.directions(0.0)[0])) for body in bodies]
        shorter = np.concatenate([np.outer(nodes @ tangent, tangent) for nodes, tangent in along])
        for part in (0.0, 0.1, 0.2, 0.3):
            pressed = state.moved(state.u - part * shorter, state.t)
            tangent = linearise(pressed)
            index = tangent.index()
            slips = any(touch.direction for touch in state.touches)
            assert index == (-1 if slips else dense_index(pressed)), (case, part)
            seen[min(index, 5)] += 1
            seen["closed"] += len(pressed.closed) > 0
            seen["stuck"] += len(pressed.rubbing) > 0 < index
            seen["tied"] += len(pressed.model.ties) > 0
            seen["indefinite body"] += tangent.factor.negatives() > 0
    assert min(seen[index] for index in range(4)) > 2
    assert min(seen["closed"], seen["stuck"], seen["indefinite body"], seen["tied"]) > 5


def test_contact_closed_without_force_has_no_index_where_its_sides_differ():
    """A straight column at twice its buckling load that a pin just touches is stable if the contact is closed only."""
    model = build(make_problem(path=((1.0, 0.0), (1.0, 0.1)), mesh=(10, 1), contact={"penalty": None}))
    u = np.zeros((model.nodes, 2))
    u[:, 0] = -2 * (np.pi / 2) ** 2 * EI / EA * model.bodies[0].mesh.nodes[:, 0]
    rest = at_rest(model).moved(u, 0.0)
    for force, expected in ((1e-3, 0), (1e-13, -1), (None, 1)):
        closed = rest.touching([replace(rest.touches[0], closed=True, force=force)])
        assert linearise(rest if force is None else closed).index(force_tolerance=1e-12) == expected

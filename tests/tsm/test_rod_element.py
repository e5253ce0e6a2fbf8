"""The exact element in a structure: its tangent, its energy, its error estimate and its shape."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import tsm
from tsm.elements.collocation import collocation
from tsm.newton import Newton
from tsm.rods import accuracy, profile
from tsm.state import Touch

KS = tsm.Section.rectangle(width=0.02, height=0.02, youngs_modulus=2.1e4, shear_modulus=2.1e4 / 2.6)


def beam(name, start, end, *, section=KS, elements=1, element="exact"):
    return tsm.Beam(name=name, start=start, end=end, section=section, elements=elements, element=element)


def two_beams(elements=1, lower="exact"):
    """A tip that meets a second beam, a pin on each, one of them with an offset."""
    return tsm.Structure(
        beams=(
            beam("upper", (0.0, 0.0), (1.0, 0.0), elements=elements),
            beam("lower", (0.0, -0.1), (1.2, -0.1), elements=elements, element=lower),
        ),
        supports=(tsm.Support(beam="upper", end="start"), tsm.Support(beam="lower", end="start")),
        pins=(
            tsm.Pin(name="p", path=((0.7, 0.01), (0.65, -0.25))),
            tsm.Pin(name="q", path=((0.4, -0.1), (0.4, -0.08))),
        ),
        contacts=(
            tsm.ContactPair(node="p", beam="upper", side="left", offset=0.01),
            tsm.ContactPair(node="q", beam="lower"),
            tsm.ContactPair(node="upper.end", beam="lower", side="left", offset=0.003),
        ),
    )


def two_pins(elements=1):
    """Two pins on one beam, from both sides."""
    return tsm.Structure(
        beams=(beam("b", (0.0, 0.0), (1.0, 0.0), elements=elements),),
        supports=(tsm.Support(beam="b", end="start"),),
        pins=(
            tsm.Pin(name="p", path=((0.5, -0.01), (0.5, 0.2))),
            tsm.Pin(name="q", path=((0.9, 0.01), (0.9, 0.1))),
        ),
        contacts=(
            tsm.ContactPair(node="p", beam="b", offset=0.01),
            tsm.ContactPair(node="q", beam="b", side="left", offset=0.01),
        ),
    )


def dense(model, tangent):
    """The band with its border as one matrix."""
    n, banded, k = model.equations + model.contact_unknowns, model.banded, model.bandwidth
    matrix = np.zeros((n, n))
    for column in range(banded):
        for row in range(max(0, column - k), min(banded, column + k + 1)):
            matrix[row, column] = tangent.band[column, 2 * k + row - column]
    matrix[:banded, banded:], matrix[banded:, :banded] = tangent.right[:banded], tangent.below[:, :banded]
    matrix[banded:, banded:] = tangent.corner
    return matrix


def settled(newton, state):
    """State whose angles inside belong to the rest of it."""
    rods = newton.model.rods
    for _ in range(20):
        balance = rods.balance(state)
        if balance.inside < 1e-15:
            break
        inner = rods.linearise(state, balance).inner[:, :, 6]
        state = replace(state, profile=replace(state.profile, angle=state.profile.angle + inner))
    return state


def perturbed(newton, equilibrium, rng):
    """A state out of equilibrium in every unknown."""
    model = newton.model
    step = 0.02 * rng.normal(size=model.equations + model.contact_unknowns) / newton.scale
    step[: model.equations][newton.per_step[: model.equations] > 0] = 0.01 * rng.normal(
        size=int((newton.per_step[: model.equations] > 0).sum())
    )
    for pair in model.pairs:
        if pair.cuts:
            step[model.equations + pair.slot + 2 : model.equations + pair.slot + 4] = 0.01 * rng.normal(
                size=2
            )
    system = newton.assembler.linearise(equilibrium.state)
    return newton.update(equilibrium.state, step, system)


SCENES = {
    "two beams": two_beams,
    "two beams, two elements each": lambda: two_beams(2),
    "tip on mixed": lambda: two_beams(2, "mixed"),
    "two pins": two_pins,
}


@pytest.mark.parametrize("name", SCENES)
def test_assembled_tangent(name):
    """Out of equilibrium, every column by central differences with one extrapolation, the equations inside satisfied."""
    result = tsm.solve(SCENES[name](), np.array([0.5, 1.0]))
    newton, rng = Newton(result.model, tsm.Settings()), np.random.default_rng(5)
    assert all(result.equilibria[-1].state.touches)
    state = settled(newton, perturbed(newton, result.equilibria[-1], rng))
    system = newton.assembler.linearise(state)
    assert newton.norm(system) > 1.0
    matrix = dense(newton.model, system.tangent)
    for column in range(len(matrix)):
        unit = np.zeros(len(matrix))
        unit[column] = 1.0

        def difference(h, unit=unit):
            ends = [
                newton.assembler.linearise(settled(newton, newton.update(state, s * h * unit, system)))
                for s in (1, -1)
            ]
            return (ends[0].residual - ends[1].residual) / (2 * h)

        h = 2e-3 * (min(1.0, 1e-3) if newton.scale[column] > 10 else 1.0)
        expected = (4 * difference(h / 2) - difference(h)) / 3
        size = np.abs(matrix[:, column]).max()
        assert np.abs(matrix[:, column] - expected).max() <= 1e-7 * size, column


def test_what_the_residual_inside_carries():
    """Off by d inside, residual + `carried` is what is left once the angles are settled, to d^2."""
    result = tsm.solve(two_beams(2), np.array([0.5, 1.0]))
    newton, rng = Newton(result.model, tsm.Settings()), np.random.default_rng(6)
    state = settled(newton, perturbed(newton, result.equilibria[-1], rng))
    goal = newton.assembler.linearise(state).residual
    shift = rng.normal(size=state.profile.angle.shape)
    missed = []
    for d in (1e-3, 5e-4):
        off = newton.assembler.linearise(
            replace(state, profile=replace(state.profile, angle=state.profile.angle + d * shift))
        )
        carried = off.tangent.condensed_residual
        assert np.abs((off.residual - goal) * newton.scale).max() > 100 * newton.tolerance
        missed.append(np.abs((off.residual + carried - goal) * newton.scale).max())
    assert 3.5 < missed[0] / missed[1] < 4.5


def cantilever(load=None, pins=(), contacts=(), section=KS, elements=1):
    return tsm.Structure(
        beams=(beam("b", (0.0, 0.0), (1.0, 0.0), section=section, elements=elements),),
        supports=(tsm.Support(beam="b", end="start"),),
        loads=(load,) if load else (),
        pins=pins,
        contacts=contacts,
    )


def ks():
    pin = tsm.Pin(name="p", path=((1.0, 0.0), (0.0, 2 / np.pi)))
    return cantilever(pins=(pin,), contacts=(tsm.ContactPair(node="p", beam="b"),))


def test_energy_is_the_work_of_a_tip_load():
    """Slack section, so that stretch, shear and bending all store; work by Gauss quadrature of the dead load's."""
    section, force = tsm.Section(EA=30.0, GA=10.0, EI=1.0), np.array([-1.0, 4.0])
    gauss, weight = np.polynomial.legendre.leggauss(20)
    t = np.append((gauss + 1) / 2, 1.0)
    result = tsm.solve(
        cantilever(tsm.Load(beam="b", end="end", force=tuple(force)), section=section, elements=2), t
    )
    moved = (result.tips["b"] - [1.0, 0.0]) @ force
    # work = [t u] - int u dt, u the tip's way along the load
    work = moved[-1] - weight @ moved[:-1] / 2
    assert result.strain_energy[-1] == pytest.approx(work, rel=1e-10)


def test_energy_of_a_circle():
    moment = 2 * np.pi * KS.EI
    result = tsm.solve(cantilever(tsm.Load(beam="b", end="end", moment=moment)), np.arange(1, 5) / 4)
    t = result.load_parameter
    assert result.strain_energy == pytest.approx((t * moment) ** 2 / (2 * KS.EI), rel=1e-12)


def with_nodes(monkeypatch, order, t):
    """KS with a fixed number of Gauss nodes."""
    monkeypatch.setattr(profile, "START_ORDER", order)
    result = tsm.solve(ks(), t, tsm.Settings(integration_tolerance=0.5))
    assert {e.state.profile.angle.shape[1] for e in result.equilibria} == {order}
    contact = result.contacts["p->b"]
    found = [contact.force / KS.EI, contact.arc_position, *result.tips["b"].T]
    return result, np.stack([*found, [e.state.q[5] for e in result.equilibria]], axis=1)


def test_error_estimate_is_an_upper_bound(monkeypatch):
    """Force, arc position, tip and its rotation on KS against 40 nodes: below the estimate, within a factor of 1e5."""
    t = np.arange(1, 11) / 10
    _, exact = with_nodes(monkeypatch, 40, t)
    counted = 0
    for order in (8, 10, 12, 14):
        result, found = with_nodes(monkeypatch, order, t)
        rods = result.model.rods
        estimate = np.array([accuracy.truncation(rods, rods.enter(e.state)) for e in result.equilibria])
        error = np.abs(found - exact).max(axis=1)
        seen = estimate > 1e-13
        assert (error <= estimate + 1e-13).all()
        assert (estimate[seen] <= 1e5 * error[seen]).all()
        counted += int(seen.sum())
    assert counted >= 12


def test_nodes_are_added_until_the_accuracy_is_reached(monkeypatch):
    monkeypatch.setattr(profile, "START_ORDER", 4)
    orders = []
    for asked in (1e-5, 1e-9, 1e-13):
        result = tsm.solve(ks(), np.array([1.0]), tsm.Settings(integration_tolerance=asked))
        state, rods = result.equilibria[-1].state, result.model.rods
        assert accuracy.truncation(rods, rods.enter(state)) <= asked
        orders.append(state.profile.angle.shape[1])
    assert 4 < orders[0] < orders[1] < orders[2] <= 24


TWO_TURNS = tsm.Load(beam="b", end="end", moment=4 * np.pi * KS.EI)


def test_too_few_nodes_are_told(monkeypatch):
    """Two turns in one element need more than 14 nodes: equilibrium with 14 does not pass for accurate."""
    result = tsm.solve(cantilever(TWO_TURNS), np.arange(1, 17) / 16)
    newton, state = Newton(result.model, tsm.Settings()), result.equilibria[-1].state
    assert newton.solve(state).status is tsm.Status.CONVERGED
    monkeypatch.setattr(accuracy, "MOST_NODES", 14)
    turned = replace(state, profile=replace(state.profile, angle=4 * np.pi * collocation(14).c[None]))
    assert newton.solve(turned).status is tsm.Status.INACCURATE


def test_a_march_that_ends_for_too_few_nodes_says_so(monkeypatch):
    monkeypatch.setattr(accuracy, "MOST_NODES", 14)
    result = tsm.solve(cantilever(TWO_TURNS), np.arange(1, 17) / 16, throw=False)
    rods = result.model.rods
    assert max(accuracy.truncation(rods, rods.enter(e.state)) for e in result.equilibria) <= 1e-9
    assert result.status is tsm.Status.INACCURATE


def axis(rods, state):
    at = accuracy.deflected(rods, state).at(0, np.linspace(0, 1, 101))
    return np.concatenate([at.position, at.angle[:, None], at.moment[:, None] / KS.EI], axis=1)


def test_resampling_and_cutting_keep_the_shape():
    pins = tsm.Pin(name="p", path=((1.0, 0.0), (0.0, 2 / np.pi))), tsm.Pin(name="q", path=((0, -3), (0, -4)))
    pairs = tuple(tsm.ContactPair(node=name, beam="b") for name in "pq")
    result = tsm.solve(cantilever(pins=pins, contacts=pairs), np.array([0.5, 0.8]))
    state, rods = result.equilibria[-1].state, result.model.rods
    first, none = state.touches
    assert none is None
    shape = axis(rods, state)
    order = state.profile.angle.shape[1]
    for more in (order + 4, 2 * order):
        assert np.abs(axis(rods, profile.resampled(rods, state, more)) - shape).max() <= 1e-9
    for xi in (0.0, 0.3, first.xi, 0.97, 1.0):
        cut = profile.recut(
            rods, state, replace(state, touches=(first, Touch(element=0, xi=xi, force=(0.0, 0.0))))
        )
        assert cut.profile.angle.shape == (3, order)
        assert rods.balance(cut).inside <= 1e-7
        assert np.abs(axis(rods, settled(Newton(result.model, tsm.Settings()), cut)) - shape).max() <= 1e-9


def test_section_forces_along_the_axis_balance_the_pin():
    """Between the clamp and the contact every section carries the pin's force and its moment, beyond it nothing."""
    turn = np.array([[0.8, -0.6], [0.6, 0.8]])
    path = np.array([(0.83, 0.0), (0.83, 0.3)]) @ turn.T
    beam = tsm.Beam(name="b", start=(0, 0), end=(0.8, 0.6), section=KS, elements=3, element="exact")
    problem = tsm.Structure(
        beams=(beam,),
        supports=(tsm.Support(beam="b", end="start"),),
        pins=(tsm.Pin(name="p", path=tuple(map(tuple, path))),),
        contacts=(tsm.ContactPair(node="p", beam="b"),),
    )
    result = tsm.solve(problem, np.array([0.5, 1.0]), tsm.Settings(tolerance=1e-14))
    assert result.status is tsm.Status.COMPLETED
    contact, lines = result.contacts["p->b"], result.stations("b", -1)
    assert lines.arc[0, 0] == 0.0
    assert lines.arc[-1, 1] == pytest.approx(1.0, abs=1e-15)
    assert lines.arc[1:, 0] == pytest.approx(lines.arc[:-1, 1], abs=1e-15)
    assert lines.position[1:, 0] == pytest.approx(lines.position[:-1, 1], abs=1e-14)
    assert lines.rotation[1:, 0] == pytest.approx(lines.rotation[:-1, 1], abs=1e-14)
    nodes = result.shape("b", -1)
    assert lines.position[-1, 1] == pytest.approx(nodes[-1, :2], abs=1e-14)
    assert lines.rotation[-1, 1] == pytest.approx(nodes[-1, 2], abs=1e-14)
    carried = lines.arc.mean(axis=1) < contact.arc_position[-1]
    assert carried.any()
    assert not carried.all()
    angle = lines.rotation + np.arctan2(0.6, 0.8)
    c, s = np.cos(angle), np.sin(angle)
    axial, shear, moment = np.moveaxis(lines.forces, -1, 0)
    force = np.stack([axial * c - shear * s, axial * s + shear * c], axis=-1)
    push = force[0, 0]
    assert np.hypot(*push) == pytest.approx(contact.force[-1], rel=1e-10)
    assert force[carried] == pytest.approx(np.broadcast_to(push, force[carried].shape), rel=1e-10)
    assert force[~carried] == pytest.approx(0.0, abs=1e-10 * contact.force[-1])
    lever = path[-1] - lines.position
    torque = lever[..., 0] * push[1] - lever[..., 1] * push[0]
    scale = float(np.abs(moment).max())
    assert moment[carried] == pytest.approx(torque[carried], abs=1e-9 * scale)
    assert moment[~carried] == pytest.approx(0.0, abs=1e-9 * scale)

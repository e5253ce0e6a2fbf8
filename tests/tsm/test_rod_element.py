"""The exact element in a structure: its tangent, its energy, its error estimate and its shape."""

from __future__ import annotations

import numpy as np
import pytest

import tsm
from tsm.rods import accuracy, profile

KS = tsm.Section.rectangle(width=0.02, height=0.02, youngs_modulus=2.1e4, shear_modulus=2.1e4 / 2.6)


def beam(name, start, end, *, section=KS, elements=1, element="exact"):
    return tsm.Beam(name=name, start=start, end=end, section=section, elements=elements, element=element)


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


TWO_TURNS = tsm.Load(beam="b", end="end", moment=4 * np.pi * KS.EI)


def test_a_march_that_ends_for_too_few_nodes_says_so(monkeypatch):
    monkeypatch.setattr(accuracy, "MOST_NODES", 14)
    result = tsm.solve(cantilever(TWO_TURNS), np.arange(1, 17) / 16, throw=False)
    rods = result.model.rods
    assert max(accuracy.truncation(rods, rods.enter(e.state)) for e in result.equilibria) <= 1e-9
    assert result.status is tsm.Status.INACCURATE


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

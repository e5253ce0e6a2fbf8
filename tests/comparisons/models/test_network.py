"""The exact rods of any scene, by the referee: against quadrature, coupled rods, and mixed elements."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.claims.problems.double_beam import TIP, UPPER
from comparisons.models import TSM, solve
from comparisons.models.network import solve_network
from comparisons.models.progress import unwatched
from comparisons.scene import load_scene
from comparisons.scene.conditions import LoadSpec, SupportSpec
from tests.oracles.coupled import pair_of

KS = replace(load_scene("ks-cantilever"), load_parameters=5)
PAIR = "pin->cantilever"
TIED = replace(load_scene("ks-tied-tip"), load_parameters=5)
LENGTH = KS.beams[0].length
TWO_SUPPORTS = replace(
    KS,
    supports=(SupportSpec(beam="cantilever", end="end", kind="pinned"),),
    pins=(replace(KS.pins[0], start=(0.4 * LENGTH, 0.0), displacement=(0.0, 0.05 * LENGTH)),),
)
LOADED = replace(
    TIED, supports=(), pins=(), loads=(LoadSpec(beam="cantilever", end="end", moment=KS.beams[0].EI / 500.0),)
)


def test_two_beams_in_contact_are_the_coupled_rods() -> None:
    scene = replace(load_scene("double-beam"), load_parameters=8)
    rods = solve(scene, "rod")
    assert rods.completed
    closed = np.flatnonzero((rods.contacts[UPPER].force > 0.0) & (rods.contacts[TIP].force > 0.0))
    assert len(closed) >= 2
    drop = abs(scene.pins[0].points[1][1] - scene.pins[0].points[0][1])
    exact = pair_of(scene).stage(rods.load_parameter[closed] * drop)
    np.testing.assert_allclose(rods.contacts[UPPER].force[closed], np.hypot(*exact.pin_force.T), rtol=1e-9)
    np.testing.assert_allclose(rods.contacts[TIP].force[closed], np.hypot(*exact.tip_force.T), rtol=1e-9)
    np.testing.assert_allclose(rods.contacts[UPPER].arc_position[closed], exact.pin_arc, rtol=1e-9)


def test_it_ends_where_the_path_ends() -> None:
    """A strut under twice Euler's load: the exact elements stop at the bifurcation below .5, and so do the rods."""
    beam = KS.beams[0]
    load = LoadSpec(
        beam=beam.name, end="end", force=(-2.0 * np.pi**2 * beam.EI / (2.0 * beam.length) ** 2, 0.0)
    )
    scene = replace(KS, pins=(), contacts=(), loads=(load,), load_parameters=10)
    rods = solve(scene, "rod")
    assert (rods.status, rods.completed) == ("BIFURCATION", False)
    assert len(rods.load_parameter) == 4
    assert rods.index is not None
    assert not rods.index.any()


def test_it_may_end_before_the_first_load_parameter() -> None:
    """The strut buckles at once, beside a contact with friction that is still open."""
    beam = KS.beams[0]
    load = LoadSpec(beam=beam.name, end="end", force=(-beam.EI * (10.0 / beam.length) ** 2, 0.0))
    aside = replace(KS.pins[0], start=(0.5 * beam.length, -beam.length))
    rubbing = tuple(replace(spec, friction=0.3) for spec in KS.contacts)
    scene = replace(KS, pins=(aside,), contacts=rubbing, loads=(load,), load_parameters=2)
    rods = solve(scene, "rod")
    assert (rods.status, rods.completed, len(rods.load_parameter)) == ("BIFURCATION", False, 0)
    friction = rods.contacts[PAIR].friction
    assert friction is not None
    assert len(friction.dissipated) == 0


def test_an_answer_that_the_referee_refuses_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """The forces of the third load parameter have the wrong sign: two equilibria are left."""
    answer = TSM.solve(TWO_SUPPORTS, TSM.reference, unwatched)
    contact = answer.contacts[PAIR]
    assert contact.vector is not None
    sign = np.array([1.0, 1.0, -1.0, 1.0, 1.0])
    wrong = replace(contact, vector=contact.vector * sign[:, None])
    monkeypatch.setattr(type(TSM), "solve", lambda *_: replace(answer, contacts={PAIR: wrong}))
    rods = solve_network(TWO_SUPPORTS, "rod")
    assert (rods.status, rods.completed, len(rods.load_parameter)) == ("NOT_AN_EQUILIBRIUM", False, 2)
    assert len(rods.contacts[PAIR].force) == len(rods.tips["cantilever"]) == 2

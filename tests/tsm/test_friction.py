"""Contacts with friction against exact answers that share no code with the solver."""

from dataclasses import replace

import numpy as np
import pytest

import tsm
from tests.fuzz.cantilevers import verdict
from tests.oracles.friction import elastica_with_friction
from tests.tsm.friction_scenes import LAST, Cantilever, drawn, ks
from tests.tsm.structures import KS

PAIR = "pin->beam"
STIFF = tsm.Section(EA=1e12, GA=1e12, EI=1.0)
SLIP, STICK = TURNS = tsm.EventKind.SLIP, tsm.EventKind.STICK


def turns(result):
    return [(event.kind, event.load_parameter) for event in result.events if event.kind in TURNS]


def balance(result):
    """Largest difference of work and strain energy, dissipation and what jumps release, over the last work."""
    lost = sum(history.friction.dissipated for history in result.contacts.values() if history.friction)
    jumps = [(event.load_parameter, event.released) for event in result.events if event.released]
    released = sum((np.where(result.load_parameter >= t, energy, 0.0) for t, energy in jumps), np.zeros(1))
    return float(np.abs(result.work - result.strain_energy - lost - released).max() / result.work.max())


def test_one_exact_element_is_the_elastica_with_friction():
    result = ks(0.3, STIFF).solve(20)
    points = np.array([[1.0, 0.0], *((1 - t, t * LAST[1]) for t in result.load_parameter)])
    exact, contact = elastica_with_friction(points, friction=0.3), result.contacts[PAIR]
    assert result.status is tsm.Status.COMPLETED
    assert contact.force == pytest.approx(exact.magnitude[1:], rel=1e-9)
    assert contact.arc_position == pytest.approx(exact.arc_position[1:], rel=1e-9)
    assert result.supports["beam.start"].moment == pytest.approx(exact.clamp_moment[1:], rel=1e-9)
    assert contact.friction.dissipated == pytest.approx(exact.dissipated[1:], abs=1e-9)
    kinds, found = zip(*turns(result), strict=True)
    assert kinds == (STICK, SLIP)
    assert found == pytest.approx([event.load_parameter for event in exact.events[-2:]], abs=1e-8)


@pytest.mark.slow
def test_a_slip_that_has_come_and_gone_within_a_step_is_found():
    """A slip between two sticks, whose margins are positive at the end of the step."""
    scene = drawn(14)
    found, exact = turns(scene.solve(1)), [event.load_parameter for event in scene.exact(1)[0].events[-5:]]
    assert [t for _, t in found] == pytest.approx(exact, abs=1e-8)
    last = found[-1][1]
    assert 0.9 < last < 1.0


CORNER = Cantilever(section=KS, friction=0.3, path=((0.5, 0.0), (0.5, 0.1), (0.6, 0.1), (0.5, 0.1)))
ROUND = Cantilever(section=KS, friction=0.3, face=0.02, radius=0.03, path=((0.5, -0.05), (0.5, 0.0)))
WORK = {  # scene, load parameters, elements, largest part of the work that is lost
    "face": (ks(0.3, face=0.01), 5, ("exact", 1), 1e-9),
    # the trapezium of the slip rate lost 1.7e-5 of the work here; the arc position turns within a step
    "a thick rod that rolls": (drawn(8), 1, ("exact", 1), 1e-12),
    "jumps at nodes": (ks(0.3), 10, ("mixed", 10), 5e-7),
    "a round pin on a face": (ROUND, 1, ("mixed", 1), 1e-11),
    "a corner at which the contact slips on": (CORNER, 4, ("mixed", 5), 5e-9),
}


@pytest.mark.slow_at("face", "a thick rod that rolls", "jumps at nodes")
@pytest.mark.parametrize("name", WORK)
def test_work_is_stored_or_dissipated(name):
    scene, steps, elements, lost = WORK[name]
    result = scene.solve(steps, *elements)
    assert result.status is tsm.Status.COMPLETED
    assert balance(result) <= lost
    assert np.diff(result.contacts[PAIR].friction.dissipated, prepend=0.0).min() >= -1e-15


def test_no_friction_is_the_frictionless_contact():
    path = ((1.0, 0.0), (0.8, 0.1))
    free, little = (replace(ks(friction), path=path).solve(4, "mixed", 8) for friction in (0.0, 1e-6))
    assert free.contacts[PAIR].friction is None
    assert not len(free.work)
    assert little.contacts[PAIR].force == pytest.approx(free.contacts[PAIR].force, rel=1e-6)
    assert np.abs(little.contacts[PAIR].force / free.contacts[PAIR].force - 1).max() > 1e-9


@pytest.mark.slow
def test_arc_length_control_follows_a_slip_and_ends_where_it_sticks():
    structure = ks(0.3).structure()
    traced = tsm.trace(structure, arc_length=0.02, steps=400, throw=False)
    assert traced.status is tsm.Status.CONTACT_CHANGED
    solved = tsm.solve(structure, traced.load_parameter)
    assert traced.contacts[PAIR].force == pytest.approx(solved.contacts[PAIR].force, rel=1e-8)
    assert 0.55 < traced.load_parameter[-1] < 0.6205


@pytest.mark.slow
@pytest.mark.parametrize("first", [0, 10])
def test_drawn_cantilevers_with_friction(first):
    found = [verdict(seed) for seed in range(first, first + 10)]
    assert not [item for item in found if item.wrong]
    right = {tsm.Status.COMPLETED.name, tsm.Status.END_CONTACT.name}
    assert sum(item.ended not in right for item in found) <= 2


MENDED = {
    156: "a pin at the tip goes in, sticks and slips off within one step",
    351: "the same, with a larger coefficient",
}
"""Cantilevers that were answered wrongly, and why."""


@pytest.mark.slow_at("351")
@pytest.mark.parametrize("seed", MENDED)
def test_drawn_cantilevers_that_once_failed(seed):
    found = verdict(seed)
    assert not found.wrong
    assert found.ended == tsm.Status.COMPLETED.name


def test_a_pin_that_rests_on_the_beam_and_leaves_opens_the_contact():
    scene = Cantilever(section=KS, friction=0.2, path=((0.5, 0.0), (0.5, -0.1)))
    result = scene.solve(3, "mixed", 8)
    assert result.status is tsm.Status.COMPLETED
    assert [(event.kind, event.load_parameter) for event in result.events] == [(tsm.EventKind.RELEASE, 0.0)]
    assert not result.contacts[PAIR].force.any()


def test_a_load_along_a_beam_works_too():
    structure = replace(ks(0.3), path=((1.0, 0.0), (0.8, 0.1))).structure()
    load = tsm.LineLoad(beam="beam", force=((0.0, -5.0 * structure.beams[0].section.EI),))
    result = tsm.solve(replace(structure, line_loads=(load,)), np.ones(1))
    assert result.contacts[PAIR].friction.dissipated[-1] > 0.05 * result.work[-1]
    assert balance(result) <= 1e-10


@pytest.mark.slow
def test_a_slip_of_a_very_stiff_beam_ends_once():
    """The round-off of a slip rate, times the stiffness, is a force that leaves the cone: the stick is no slip for a moment."""
    section = tsm.Section(EA=1e11, GA=1e11, EI=1.0)
    result = replace(ks(0.2, section), path=((1.0, 0.0), (0.36, 0.64 * LAST[1]))).solve(1, "mixed", 3)
    assert result.status is tsm.Status.COMPLETED
    assert [kind for kind, _ in turns(result)] == [STICK]

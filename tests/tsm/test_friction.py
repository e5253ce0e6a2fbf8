"""Contacts with friction against exact answers that share no code with the solver."""

import numpy as np
import pytest

import tsm
from comparisons.exact import rod_under_pin
from tests.oracles.shooting import RIGID
from tests.tsm.structures import KS, KS_PATH, cantilever, raised, steps

PAIR = "p0->b"
STIFF = tsm.Section(EA=1e12, GA=1e12, EI=1.0)
SLIP, STICK = TURNS = tsm.EventKind.SLIP, tsm.EventKind.STICK


def rubbed(friction, *path, section=KS, element="exact", **more):
    """A cantilever of length 1 under a pin with friction, by default that of Konyukhov and Schweizerhof."""
    return cantilever(path or KS_PATH, section=section, element=element, friction=friction, **more)


def solved(structure, count):
    return tsm.solve(structure, steps(count), throw=False)


def turns(result):
    return [(event.kind, event.load_parameter) for event in result.events if event.kind in TURNS]


def balance(result):
    """Largest difference of work and strain energy, dissipation and what jumps release, over the last work."""
    lost = sum(history.friction.dissipated for history in result.contacts.values() if history.friction)
    jumps = [(event.load_parameter, event.released) for event in result.events if event.released]
    released = sum((np.where(result.load_parameter >= t, energy, 0.0) for t, energy in jumps), np.zeros(1))
    return float(np.abs(result.work - result.strain_energy - lost - released).max() / result.work.max())


def test_one_exact_element_is_the_elastica_with_friction():
    result = solved(rubbed(0.3, section=STIFF), 20)
    points = np.array([[1.0, 0.0], *((1 - t, t * KS_PATH[1][1]) for t in result.load_parameter)])
    exact, contact = rod_under_pin(points, friction=0.3, length=1.0, **RIGID), result.contacts[PAIR]
    assert result.status is tsm.Status.COMPLETED
    assert contact.force == pytest.approx(exact.magnitude[1:], rel=1e-9)
    assert contact.arc_position == pytest.approx(exact.arc_position[1:], rel=1e-9)
    assert result.supports["b.start"].moment == pytest.approx(exact.clamp_moment[1:], rel=1e-9)
    assert contact.friction.dissipated == pytest.approx(exact.dissipated[1:], abs=1e-9)
    kinds, found = zip(*turns(result), strict=True)
    assert kinds == (STICK, SLIP)
    assert found == pytest.approx([event.load_parameter for event in exact.events[-2:]], abs=1e-8)


ROLLS = rubbed(
    0.788549, (0.374868, -0.0218941), (0.18286, 0.179312), (0.113251, 0.619679), (0.365283, 0.229144),
    section=tsm.Section(EA=1522.54, GA=755.46, EI=1.0), offset=0.0218941, radius=0.0218941,
)  # fmt: skip
WORK = {  # structure, load parameters, largest part of the work that is lost
    "face": (rubbed(0.3, (1.0, -0.01), KS_PATH[1], offset=0.01), 5, 1e-9),
    # the trapezium of the slip rate lost 1.7e-5 of the work here; the arc position turns within a step
    "a thick rod that rolls": (ROLLS, 1, 1e-12),
    "jumps at nodes": (rubbed(0.3, element="mixed"), 10, 5e-7),
    # one element that is integrated leaves 3e-8, and the error falls by the sixth power of its length
    "a round pin on a face": (rubbed(0.3, (0.5, -0.05), (0.5, 0.0), element="mixed", elements=8, offset=0.05, radius=0.03), 1, 1e-11),
    "a corner at which the contact slips on": (
        rubbed(0.3, (0.5, 0.0), (0.5, 0.1), (0.6, 0.1), (0.5, 0.1), element="mixed", elements=5), 4, 5e-9,
    ),
}  # fmt: skip


@pytest.mark.slow_at("face", "a thick rod that rolls", "jumps at nodes", "a round pin on a face")
@pytest.mark.parametrize("name", WORK)
def test_work_is_stored_or_dissipated(name):
    structure, count, lost = WORK[name]
    # the default tolerance leaves 3e-11 of the smallest work
    result = tsm.solve(structure, np.arange(1, count + 1) / count, tsm.Settings(tolerance=1e-12))
    assert result.status is tsm.Status.COMPLETED
    assert balance(result) <= lost
    assert np.diff(result.contacts[PAIR].friction.dissipated, prepend=0.0).min() >= -1e-15


@pytest.mark.slow
@pytest.mark.parametrize("EA", [1e9, 1e10])
def test_a_stick_that_ends_within_round_off_of_its_force_is_a_slip(EA):
    """Lifted square to its axis a rod slips when ``EA t^2`` is ``mu t``, at a force that is round-off in a slender one."""
    section = tsm.Section(EA=EA, GA=EA / 3, EI=1.0)
    result = solved(rubbed(0.6, *raised(0.5, 0.02), section=section), 2)
    assert result.status is tsm.Status.COMPLETED
    assert [kind for kind, _ in turns(result)] == [SLIP]
    # that of a rod whose stretch is a thousand times as large; it moves the force by less
    assert result.contacts[PAIR].force[-1] == pytest.approx(0.554506, abs=1e-6)


@pytest.mark.slow
def test_arc_length_control_follows_a_slip_and_ends_where_it_sticks():
    traced = tsm.trace(rubbed(0.3), arc_length=0.02, steps=400, throw=False)
    assert traced.status is tsm.Status.CONTACT_CHANGED
    again = tsm.solve(rubbed(0.3), traced.load_parameter)
    assert traced.contacts[PAIR].force == pytest.approx(again.contacts[PAIR].force, rel=1e-8)
    assert 0.55 < traced.load_parameter[-1] < 0.6205


def test_a_pin_that_rests_on_the_beam_and_leaves_opens_the_contact():
    result = solved(rubbed(0.2, (0.5, 0.0), (0.5, -0.1), element="mixed", elements=8), 3)
    assert result.status is tsm.Status.COMPLETED
    assert [(event.kind, event.load_parameter) for event in result.events] == [(tsm.EventKind.RELEASE, 0.0)]
    assert not result.contacts[PAIR].force.any()

"""Friction against a rod, a bar and elasticas, and answers whatever the load steps."""

import numpy as np
import pytest

import fem_reference as fr
from comparisons.exact import rod_under_pin
from tests.fem_reference.strips import EA, EI, GA, PAIR, H, held, loads, make_problem, pressed, support
from tests.oracles.elastica import three_point_limit


def slip_changes(contact):
    """Load parameters at which a contact came to stick or began to slip, with the direction from there on."""
    return [
        (event.load_parameter, event.direction) for event in contact.events if event.kind in ("slip", "stick")
    ]


def rubbed(friction, n=20, path=None, mesh=(50, 2), radius=0.0, material="biot-linear", **contact):
    """The KS scene with friction, or another path of its pin, and the history of its contact."""
    values = {"friction": friction, "penalty": None} | contact
    scene = make_problem(path=path, radius=radius, contact=values, material=material, mesh=mesh)
    result = fr.solve(scene, loads(n) if isinstance(n, int) else n)
    return result, result.contacts[PAIR]


RUBBED = {
    "mu .3, coarse": (0.3, {"mesh": (20, 1)}),
    "round pin on a face": (0.3, {"radius": 0.05, "surface": "face"}),
}


@pytest.mark.slow_at("round pin on a face")
@pytest.mark.parametrize("case", RUBBED)
def test_strip_with_friction_is_the_rod_at_every_load_parameter(case):
    """Forces within 2e-3 and arc positions within 3e-4, with the linear law of the rod; 1.5e-3 and 2.5e-4 measured."""
    mu, changes = RUBBED[case]
    t = loads(2 if "mesh" in changes else 20)
    result, contact = rubbed(mu, t, **changes)
    radius, offset = changes.get("radius", 0.0), H / 2 if "surface" in changes else 0.0
    y = -offset - radius
    points = np.outer(1 - np.append(0, t), [1.0, y]) + np.outer(np.append(0, t), [0.0, y + 2 / np.pi])
    pin = {"friction": mu, "offset": offset, "radius": radius}
    rod = rod_under_pin(points, **pin, EA=EA, GA=GA, EI=EI, length=1.0)
    np.testing.assert_allclose(contact.force, rod.magnitude[1:], rtol=2e-3)
    np.testing.assert_allclose(contact.arc_position, rod.arc_position[1:], rtol=0, atol=3e-4)
    within = 5e-3 * rod.magnitude.max()
    np.testing.assert_allclose(contact.tangential_force, rod.tangential[1:], rtol=0, atol=within)
    np.testing.assert_allclose(contact.dissipated, rod.dissipated[1:], rtol=0, atol=2e-3 * rod.dissipated[-1])
    slides = contact.direction != 0
    np.testing.assert_allclose(contact.tangential_force[slides], rod.tangential[1:][slides], rtol=2e-3)
    # The slide towards the clamp rests once.
    (rests, stick), (slips, back) = slip_changes(contact)
    assert (stick, back) == (0, 1)
    assert (rests, slips) == pytest.approx([event.load_parameter for event in rod.events[1:]], abs=3e-4)
    assert np.array_equal(result.index, np.where(slides, -1, 0))


@pytest.mark.slow
def test_answer_does_not_depend_on_the_load_steps():
    """Force and position within 1e-10; dissipated energy within 1e-4 of 80 load parameters."""
    values = {"radius": 0.05, "mesh": (30, 1), "surface": "face"}
    many = rubbed(0.3, 80, **values)[1]
    for n in (10, 1):
        few = rubbed(0.3, n, **values)[1]
        assert few.force[-1] == pytest.approx(many.force[-1], rel=1e-10)
        assert few.arc_position[-1] == pytest.approx(many.arc_position[-1], abs=1e-10)
        assert few.dissipated[-1] == pytest.approx(many.dissipated[-1], rel=1e-4)
        # In stick the stretch of the rolled length is the mean of both ends of a step.
        np.testing.assert_allclose(slip_changes(few), slip_changes(many), rtol=0, atol=3e-6)


def test_first_touch_within_a_step_is_located():
    """A round pin meets a strip obliquely: the slip counts from there, with 1 or 8 load parameters."""
    path = (0.9, -0.26), (0.5, 0.14)
    once, often = (rubbed(0.6, n, path, (40, 1), radius=0.05, surface="face")[1] for n in (1, 8))
    assert once.force[-1] == pytest.approx(often.force[-1], rel=1e-9)
    assert once.slip[-1] == pytest.approx(often.slip[-1], abs=1e-5)
    assert once.slip[-1] == pytest.approx(-0.153, abs=0.01)
    assert once.direction[-1] == often.direction[-1] == -1


def test_strip_rolls_on_a_round_pin_that_sticks():
    """``rho d zeta = s R d theta``: the contact moves along the strip without slip."""
    radius, n = 0.05, np.append(0.3, np.arange(0.6, 0.711, 0.005))
    result, contact = rubbed(0.5, n, radius=radius, mesh=(30, 1), surface="face")
    stuck = np.flatnonzero(contact.direction == 0)
    assert stuck.size > 10
    at = [result.states[k].touches[0].at for k in stuck]
    zeta, stretch = contact.arc_position[stuck], np.array([one.stretch for one in at])
    angle = np.array([np.arctan2(*one.tangent[::-1]) for one in at])
    rolled = (stretch[1:] + stretch[:-1]) / 2 * np.diff(zeta) + radius * np.diff(angle)
    assert np.abs(rolled).max() < 1e-12
    assert np.ptp(zeta) > 1e-3
    assert np.ptp(contact.slip[stuck]) == 0


def test_limit_load_of_three_point_bending():
    """Elastica drawn in between rough supports: largest ``V a^2 / EI`` per side, within 1e-4; 4e-5 measured.

    At first the beam sticks. The shortening ``3 d^2 / 5 a`` of a cantilever with the deflection d strains it, and it slips where
    ``EA 3 d^2 / (5 a^2) = mu 3 EI d / a^3``, at ``d = 5 mu I / (A a)``. The force there is 37 times the round-off of a nodal force
    for mu = .1.
    """
    mu = 0.1
    most, height = three_point_limit(mu)[0]
    section = {"height": 0.01, "poissons_ratio": 0.0, "material": "biot-linear"}
    half = held(support(), end=(1.6, 0.0), mesh=(80, 1), **section)
    contact = fr.solve(pressed(half, ((1.0, 0.0), (1.0, height)), friction=mu), loads(10)).contacts[PAIR]
    assert contact.vector[-1, 1] / (EI / 8) == pytest.approx(most, rel=1e-4)
    ((slips, way),) = slip_changes(contact)
    assert way == 1
    assert slips * height == pytest.approx(5 * mu * 0.01**2 / 12, rel=1e-2)

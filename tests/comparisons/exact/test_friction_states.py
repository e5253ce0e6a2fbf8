"""States of a contact with friction: stick on a face and on a round pin, limits, events, drawn paths, input."""

import numpy as np
import pytest

from comparisons.exact import (
    FrictionState,
    Surface,
    elastica_with_friction,
    rod_under_pin,
    rod_with_friction,
)
from tests.comparisons.exact.test_friction import (
    KS,
    KS_STATES,
    THICK,
    along_the_axis,
    balance,
    check_states,
    ks_pins,
)

OPEN, STICK, TO_TIP, TO_CLAMP = (
    FrictionState.OPEN,
    FrictionState.STICK,
    FrictionState.SLIP_TO_TIP,
    FrictionState.SLIP_TO_CLAMP,
)


def states(path):
    return [event.after for event in path.events]


def stick_terms(path, k, stiffness, surface):
    """`A`, the arc position and the roll of the contact, from the reactions of the clamp."""
    end, mean = along_the_axis(path, k, stiffness)
    phi = np.arctan2(mean[1], mean[0])
    couple = surface.offset * path.force[k] @ [np.cos(phi), np.sin(phi)]
    factor = np.hypot(*mean) + surface.offset * couple / stiffness["EI"] / 2.0
    return factor, path.arc_position[k], surface.offset * (phi - end[2]) + surface.radius * phi


@pytest.mark.slow
@pytest.mark.parametrize("surface", [Surface(offset=0.05), Surface(offset=0.05, radius=0.1)])
def test_the_slip_rate_vanishes_in_stick_when_integrated_from_the_clamp(surface):
    """Its integral, by a polynomial through nine places of the stick."""
    whole = rod_with_friction(
        ks_pins([0.0, 1.0], surface.offset + surface.radius), friction=0.5, **THICK, surface=surface
    )
    assert states(whole) == KS_STATES
    begin, end = (event.load_parameter for event in whole.events[1:])
    places = begin + (end - begin) * (1.0 - np.cos(np.linspace(0.01, 0.99, 9) * np.pi)) / 2.0
    path = rod_with_friction(
        ks_pins([0.0, *places], surface.offset + surface.radius), friction=0.5, **THICK, surface=surface
    )
    assert set(path.state[1:]) == {STICK}
    factor, arc, roll = np.array([stick_terms(path, k, THICK, surface) for k in range(1, 10)]).T
    A, s = (np.polynomial.Polynomial.fit(places, values, 8) for values in (factor, arc))
    slid = (A * s.deriv()).integ(lbnd=places[0])(places[-1]) + roll[-1] - roll[0]
    chord = (factor[0] + factor[-1]) / 2.0 * (arc[-1] - arc[0]) + roll[-1] - roll[0]
    assert abs(arc[-1] - arc[0]) > 1e-5
    assert slid == pytest.approx(0.0, abs=1e-10)
    assert abs(chord) > 1e-8
    check_states(path, 0.5)


@pytest.mark.slow_at("0.1")
@pytest.mark.parametrize("radius", [0.01, 0.1])
def test_a_stick_that_rolls_loses_no_work(radius):
    surface = Surface(offset=0.0 if radius == 0.01 else 0.01, radius=radius)
    path = rod_with_friction(
        ks_pins([0.0, 1.0], surface.offset + radius), friction=0.3, **KS, surface=surface
    )
    assert states(path) == KS_STATES
    assert balance(path)[1] < 1e-13


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.1, 0.5])
def test_a_rod_without_stretch_and_shear_is_the_elastica(friction):
    """Collocation and the quadrature of the first integral share nothing but the law of friction."""
    rigid = {"EA": np.inf, "GA": np.inf, "EI": 1.0, "length": 1.0}
    rod = rod_with_friction(ks_pins([0.0, 0.5, 1.0]), friction=friction, **rigid)
    elastica = elastica_with_friction(ks_pins([0.0, 0.5, 1.0]), friction=friction)
    for name in ("magnitude", "arc_position", "clamp_moment", "dissipated", "stored", "tip", "tip_rotation"):
        np.testing.assert_allclose(
            getattr(rod, name)[1:], getattr(elastica, name)[1:], rtol=1e-11, err_msg=name
        )
    for first, second in zip(rod.events, elastica.events, strict=True):
        assert first.load_parameter == pytest.approx(second.load_parameter, abs=1e-12)


@pytest.mark.parametrize("offset", [0.0, 0.01])
def test_without_friction_the_rod_is_the_frictionless_one(offset):
    pins = ks_pins([0.0, 0.25, 0.5, 0.75, 1.0], offset)
    path = rod_with_friction(pins, friction=0.0, **KS, surface=Surface(offset=offset))
    frictionless = rod_under_pin(pins, offset=offset, **KS)
    for name in ("magnitude", "arc_position", "clamp_moment", "tip_rotation"):
        np.testing.assert_allclose(
            getattr(path, name)[1:], getattr(frictionless, name)[1:], rtol=1e-12, err_msg=name
        )
    np.testing.assert_allclose(path.dissipated, 0.0, atol=1e-15 * path.work[-1])
    assert balance(path)[-1] < 1e-13


def test_a_pin_that_rises_square_to_the_rod_sticks_first():
    """The rod stretches, so that it slips at a small deflection only; the elastica slips at once."""
    points = [[0.8, -0.1], [0.8, 0.3], [0.8, -0.2]]
    rod = rod_with_friction(points, friction=0.3, **KS)
    assert states(rod) == [STICK, TO_TIP, STICK, TO_CLAMP, OPEN]
    assert 0.0 < rod.events[1].load_parameter * 0.9 - 0.1 < 1e-3
    elastica = elastica_with_friction(points, friction=0.3)
    assert states(elastica) == [TO_TIP, STICK, TO_CLAMP, OPEN]
    for path in (rod, elastica):
        assert path.events[-1].load_parameter * 0.9 == pytest.approx(0.7, abs=1e-12)
        assert path.work[-1] == pytest.approx(path.dissipated[-1], rel=1e-12)
        assert path.magnitude[-1] == 0.0
        check_states(path, 0.3)


def test_touch_slip_off_and_touch_again():
    points = [[0.8, -0.1], [0.8, 0.7], [0.8, 0.6], [0.8, -0.1], [0.8, 0.1]]
    path = rod_with_friction(points, friction=0.3, **THICK)
    slipped = FrictionState.SLIPPED
    assert path.state == (OPEN, slipped, slipped, OPEN, TO_TIP)
    assert states(path) == [STICK, TO_TIP, slipped, STICK, TO_TIP]
    assert path.events[2].arc_position == pytest.approx(1.0, abs=1e-12)
    again = rod_with_friction([[0.8, 0.0], [0.8, 0.1]], friction=0.3, **THICK)
    assert path.magnitude[-1] == pytest.approx(again.magnitude[-1], rel=1e-12)
    assert path.released[1] > 0.0
    assert np.max(balance(path)) < 1e-13


@pytest.mark.parametrize(
    ("k", "turn", "after"), [(1, -0.1, TO_CLAMP), (1, 0.1, STICK), (2, -0.1, STICK), (2, 0.1, TO_TIP)]
)
def test_a_pin_that_turns_at_an_event(k, turn, after):
    """At the corner the force is on the edge of the cone: the slip goes on or begins, or the pin sticks."""
    event = elastica_with_friction(ks_pins([0.0, 1.0]), friction=0.3).events[k]
    x, y = ks_pins([event.load_parameter])[0]
    path = elastica_with_friction([[1.0, 0.0], [x, y], [x + turn, y]], friction=0.3)
    assert path.state[1] is after
    assert not path.state[-1].ends
    assert np.max(balance(path)) < 1e-13
    check_states(path, 0.3)


def test_slip_off_at_the_touch():
    points = [[1.0, -0.1], [1.0, 0.1]]
    elastica = elastica_with_friction(points, friction=0.3)
    assert states(elastica) == [TO_TIP, FrictionState.SLIPPED]
    assert elastica.events[-1].load_parameter == pytest.approx(0.5, abs=1e-12)
    rod = rod_with_friction(points, friction=0.3, **KS)
    assert states(rod) == [STICK, TO_TIP, FrictionState.SLIPPED]
    assert rod.events[2].load_parameter == pytest.approx(rod.events[1].load_parameter, abs=1e-12)
    assert 0.5 < rod.events[2].load_parameter < 0.501
    assert rod.magnitude[-1] == elastica.magnitude[-1] == 0.0
    assert rod_with_friction(points, friction=0.0, **KS).state[-1] is FrictionState.SLIPPED


def test_a_pin_that_turns_sticks_before_it_slips_back():
    path = elastica_with_friction([[1.0, 0.0], [0.7, 0.2], [0.85, 0.1]], friction=0.3)
    assert states(path) == [TO_CLAMP, STICK, TO_TIP]
    turn = path.load_parameter[1]
    assert path.events[1].load_parameter == turn
    assert path.state[1] is STICK
    straight_on = elastica_with_friction([[1.0, 0.0], [0.7, 0.2], [0.4, 0.4]], friction=0.3)
    assert straight_on.state[1] is TO_CLAMP
    check_states(path, 0.3)


def test_a_contact_that_neither_slip_nor_stick_continues_is_jammed():
    """The stick is released at the edge of the cone, where the forces of the slip would push the pin the other way."""
    points = np.array([[0.681, -0.019], [0.291, 0.559], [0.735, 0.173]])
    paths = [
        elastica_with_friction(points, friction=1.086),
        rod_with_friction(points, friction=1.086, EA=3e5, GA=1e5, EI=1.0, length=1.0),
    ]
    for path in paths:
        assert path.events[-1].before is STICK
        assert path.state[-1] is path.events[-1].after is FrictionState.JAMMED
        assert np.isnan(path.magnitude[-1])
        assert np.isfinite(path.magnitude[-2])
    jammed = [path.events[-1].load_parameter for path in paths]
    assert jammed[0] == pytest.approx(jammed[1], abs=1e-3)


def test_a_path_without_equilibrium_is_lost():
    path = elastica_with_friction(
        [[0.709, -0.01], [0.781, 0.236], [-0.181, 0.259]], friction=0.277, length=4.0
    )
    assert path.state[-1] is FrictionState.LOST
    assert np.isnan(path.stored[-1])


def drawn_points(rng, reach):
    """Path of two to five vertices that starts outside the beam."""
    points = np.column_stack([rng.uniform(0.2, 1.0, 5), rng.uniform(-0.1, 0.5, 5)])
    points[0, 1] = -0.05
    return (points - [0.0, reach])[: rng.integers(2, 6)] * [1.0, rng.choice([1, -1])]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("shape", [(0.0, 0.0), (0.02, 0.0), (0.02, 0.05)])
def test_drawn_paths_of_the_rod(seed, shape):
    """Work is stored, dissipated or set free, exactly on the axis and to the trapezium of the stick row elsewhere."""
    rng, ended, surface = np.random.default_rng(seed), 0, Surface(offset=shape[0], radius=shape[1])
    for _ in range(5):
        friction, EA = rng.uniform(0.02, 1.0), 10.0 ** rng.uniform(2.5, 4.5)
        points = drawn_points(rng, sum(shape))
        path = rod_with_friction(
            points, friction=friction, EA=EA, GA=EA / 3.0, EI=1.0, length=1.0, surface=surface
        )
        check_states(path, friction)
        assert np.nanmax(balance(path)) < (1e-12 if shape == (0.0, 0.0) else 1e-3)
        ended += path.state[-1].ends
    assert ended <= 1


@pytest.mark.slow_at(
    "-1e-11-0.5", "-1e-15-0.5", "0.0-0.5", "1e-07-0.5", "1e-09-0.5", "1e-13-0.5", "2e-16-0.5"
)
@pytest.mark.parametrize("friction", [0.05, 0.5])
@pytest.mark.parametrize("shift", [0.0, 2e-16, -1e-15, 1e-13, -1e-11, 1e-9, 1e-7])
def test_a_load_parameter_at_an_event_changes_nothing(friction, shift):
    whole = elastica_with_friction(ks_pins([0.0, 1.0]), friction=friction)
    for event in whole.events[1:]:
        path = elastica_with_friction(ks_pins([0.0, event.load_parameter + shift, 1.0]), friction=friction)
        assert states(path) == KS_STATES
        assert path.magnitude[-1] == pytest.approx(whole.magnitude[-1], rel=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"friction": -0.1}, "friction = -0.1: must be finite and not negative"),
        ({"EA": 0.0}, "EA = 0.0: must be positive"),
        ({"length": np.nan}, "length = nan: must be positive and finite"),
        ({"points": [0.8, 0.1]}, "points"),
        ({"points": [[0.8, 0.0]], "surface": Surface(offset=0.1)}, "must not start inside the rod"),
    ],
)
def test_bad_input(change, message):
    arguments = {"points": [[0.8, 0.0]], "friction": 0.3, **KS} | change
    with pytest.raises(ValueError, match=message):
        rod_with_friction(**arguments)


def test_bad_surface():
    with pytest.raises(ValueError, match=r"radius = -1\.0: must be finite and not negative"):
        Surface(radius=-1.0)


def test_beside_the_rod_nothing_touches():
    path = rod_with_friction([[1.1, -0.1], [1.1, 0.1]], friction=0.3, **KS)
    assert path.state == (OPEN, OPEN)
    np.testing.assert_array_equal(path.tip, [[1.0, 0.0], [1.0, 0.0]])
    assert path.events == ()

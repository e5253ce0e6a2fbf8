"""The elastica and the rod with Coulomb friction: printed values, balances, limits, and the states along drawn paths."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from comparisons.exact import (
    FrictionState,
    Surface,
    elastica_with_friction,
    frictional_three_point_limit,
    rod_with_friction,
)

E, A, INERTIA, HEIGHT = 2.1e4, 4e-4, 0.02**4 / 12.0, 0.02
KS = {"EA": E * A, "GA": 5.0 / 6.0 * E / 2.6 * A, "EI": E * INERTIA, "length": 1.0}
THICK = {"EA": 300.0, "GA": 80.0, "EI": 1.0, "length": 1.0}
FACE = Surface(offset=HEIGHT / 2.0)
KS_STATES = [FrictionState.SLIP_TO_CLAMP, FrictionState.STICK, FrictionState.SLIP_TO_TIP]


def ks_pins(t, offset=0.0):
    t = np.asarray(t)
    return np.stack([1.0 - t, 2.0 * t / np.pi - offset], axis=1)


def check_states(path, friction):
    """The force lies in the cone in stick and on its edge in slip, and drags the beam the way of the slip; nothing is gained."""
    for k, state in enumerate(path.state):
        F_t, F_n = path.tangential[k], path.normal[k]
        if state.ends:
            continue
        assert F_n >= -1e-12
        if state is FrictionState.STICK:
            assert abs(F_t) <= friction * F_n + 1e-12
        elif state.touches:
            assert F_t == pytest.approx(state.sense * friction * F_n, abs=1e-12)
    assert np.all(np.diff(path.dissipated[np.isfinite(path.dissipated)]) >= 0.0)
    for event in path.events:
        assert event.before is not event.after


def balance(path):
    """Work of the pin that is neither stored nor dissipated nor set free, over the whole work."""
    lost = np.abs(path.work - path.stored - path.dissipated - path.released)
    return lost / (np.nanmax(np.abs(path.work)) or 1.0)


@pytest.mark.parametrize(
    ("friction", "stick", "slip", "F", "s", "moment"),
    [
        (0.05, 0.62656173790590, 0.6486409617, 7.992147417325, 0.883057818696, 3.3778986185),
        (0.1, 0.62552021891215, 0.6579074196, 7.841931727558, 0.873153311584, 3.5777850768),
        (0.2, 0.62324035484810, 0.6715734767, 7.639113310576, 0.858197305534, 3.9082538894),
        (0.3, 0.62065097789095, 0.6825541119, 7.541844254804, 0.847105863940, 4.1787969211),
        (0.5, 0.61423836803155, 0.7011266178, 7.582736946124, 0.831181215881, 4.6121130165),
    ],
)
def test_elastica_on_the_ks_path(friction, stick, slip, F, s, moment):
    path = elastica_with_friction(ks_pins([0.0, 1.0]), friction=friction)
    assert [event.after for event in path.events] == KS_STATES
    t = [event.load_parameter for event in path.events]
    np.testing.assert_allclose(t[:2], [0.0, stick], rtol=0, atol=1e-13)
    assert t[2] == pytest.approx(slip, abs=5e-11)
    assert path.magnitude[1] == pytest.approx(F, abs=5e-13)
    assert path.arc_position[1] == pytest.approx(s, abs=5e-13)
    assert path.clamp_moment[1] == pytest.approx(-moment, abs=5e-11)
    assert balance(path)[1] < 1e-13
    check_states(path, friction)


@pytest.mark.parametrize(
    ("friction", "F", "s", "stick", "slip"),
    [
        (0.1, 2.1935803158557e-3, 0.873335466586, 0.6254363, 0.6582915),
        (0.3, 2.110304862086e-3, 0.847142560461, 0.6204977, 0.6832873),
        (0.5, 2.122282811362e-3, 0.831119109269, 0.6140016, 0.7021081),
    ],
)
def test_rod_on_the_ks_path(friction, F, s, stick, slip):
    path = rod_with_friction(ks_pins([0.0, 0.5, 1.0]), friction=friction, **KS)
    assert [event.after for event in path.events] == KS_STATES
    np.testing.assert_allclose(
        [event.load_parameter for event in path.events], [0.0, stick, slip], rtol=0, atol=5e-8
    )
    assert path.magnitude[2] == pytest.approx(F, rel=3e-13)
    assert path.arc_position[2] == pytest.approx(s, abs=6e-13)
    if friction == 0.3:
        assert path.magnitude[1] == pytest.approx(1.440282590723e-3, rel=4e-13)
        assert path.arc_position[1] == pytest.approx(0.613373425413, abs=5e-13)
    assert np.max(balance(path)) < 1e-13
    check_states(path, friction)


@pytest.mark.parametrize(
    ("friction", "drawn_in", "displacement", "pushed_back"),
    [
        (0.0, 0.833976054298, 0.476377598, 0.833976054298),
        (0.1, 0.890538486811, 0.499796765, 0.779438646160),
        (0.2, 0.948651379547, 0.5220894796, 0.727371650252),
        (0.3, 1.007848170943, 0.543001429, 0.678152760523),
    ],
)
def test_three_point_bending_limits(friction, drawn_in, displacement, pushed_back):
    limit = frictional_three_point_limit(friction)
    assert limit.drawn_in.load == pytest.approx(drawn_in, abs=6e-13)
    assert limit.drawn_in.displacement == pytest.approx(displacement, abs=6e-10)
    assert limit.pushed_back.load == pytest.approx(pushed_back, abs=6e-13)
    scaled = frictional_three_point_limit(friction, half_span=2.0, EI=3.0).drawn_in
    assert scaled.load == pytest.approx(0.75 * drawn_in, rel=1e-12)
    assert scaled.displacement == pytest.approx(2.0 * displacement, abs=2e-9)


def test_friction_is_recovered_from_the_reactions_of_the_clamp():
    """`H = m^2/2 EI + N + N^2/2 EA + Q^2/2 GA` at the clamp is the tangential force times the mean tangent."""
    for friction in (0.1, 0.5):
        path = elastica_with_friction(ks_pins([0.0, 0.3, 1.0]), friction=friction)
        for k, sign in ((1, -1.0), (2, 1.0)):
            H = path.clamp_moment[k] ** 2 / 2.0 - path.clamp_force[k, 0]
            F = np.hypot(*path.clamp_force[k])
            assert H / np.sqrt(F**2 - H**2) == pytest.approx(sign * friction, abs=1e-10)


@pytest.mark.parametrize("friction", [0.1, 0.3])
def test_the_limit_load_is_the_largest_along_the_path_of_a_support(friction):
    limit = frictional_three_point_limit(friction).drawn_in
    d = limit.displacement + np.array([0.0, -1e-3, 0.0, 1e-3])
    d[0] = 0.0
    path = elastica_with_friction(np.stack([np.ones(4), d], axis=1), friction=friction, length=3.0)
    assert set(path.state) == {FrictionState.SLIP_TO_TIP}
    assert path.force[2, 1] == pytest.approx(limit.load, rel=1e-13)
    assert max(path.force[1, 1], path.force[3, 1]) < limit.load


def along_the_axis(path, k, stiffness):
    """Integrate the rod's equations from the reactions of the clamp: `x, y, theta, m` at the contact and both derivatives."""
    (nx, ny), (EA, GA, EI) = path.force[k], (stiffness[name] for name in ("EA", "GA", "EI"))

    def rate(_, state):
        c, s = np.cos(state[2]), np.sin(state[2])
        N, Q = nx * c + ny * s, -nx * s + ny * c
        dx, dy = (1.0 + N / EA) * c - Q / GA * s, (1.0 + N / EA) * s + Q / GA * c
        energy = (N**2 / EA + Q**2 / GA + state[3] ** 2 / EI) / 2.0
        return [dx, dy, state[3] / EI, -(dx * ny - dy * nx), energy]

    moment = -path.clamp_moment[k]
    scale = np.array([1.0, 1.0, 1.0, abs(moment), abs(moment)])
    end = solve_ivp(
        rate,
        (0.0, path.arc_position[k]),
        [0.0, 0.0, 0.0, moment, 0.0],
        method="DOP853",
        rtol=1e-13,
        atol=1e-15 * scale,
    ).y[:, -1]
    tail = np.array([np.cos(end[2]), np.sin(end[2])])
    return end, (np.array(rate(0.0, end)[:2]) + tail) / 2.0


@pytest.mark.slow_at("-1-surface0", "-1-surface2", "1-surface0", "1-surface1", "1-surface2")
@pytest.mark.parametrize("surface", [Surface(), Surface(offset=0.06), Surface(offset=0.06, radius=0.1)])
@pytest.mark.parametrize("side", [1, -1])
def test_all_conditions_hold_when_integrated_from_the_clamp(surface, side):
    """Contact at the offset across the mean tangent, the couple of the friction about the axis, Coulomb's law, energy."""
    friction, reach = 0.3, surface.offset + surface.radius
    pins = ks_pins([0.0, 0.3, 0.9], reach) * [1.0, side]
    path = rod_with_friction(pins, friction=friction, **THICK, surface=surface)
    for k, sense in ((1, -1), (2, 1)):
        end, mean = along_the_axis(path, k, THICK)
        tangent = mean / np.hypot(*mean)
        normal = np.array([-tangent[1], tangent[0]])
        np.testing.assert_allclose(end[:2] - side * reach * normal, pins[k], rtol=0, atol=1e-11)
        F_t, F_n = path.force[k] @ tangent, side * path.force[k] @ normal
        assert path.state[k].sense == sense
        assert F_t == pytest.approx(sense * friction * F_n, rel=1e-11)
        assert end[3] == pytest.approx(side * surface.offset * F_t, abs=1e-11)
        assert end[4] == pytest.approx(path.stored[k], rel=1e-11)
    check_states(path, friction)

"""The rod under a pin with Coulomb friction: integration from the clamp, the elastica, balances, limits, states."""

from itertools import pairwise

import numpy as np
import pytest

from comparisons.exact import Outcome, rod_under_pin
from tests.oracles.friction import rubbed
from tests.oracles.shooting import RIGID, ks_pins, shot

GAUSS, WEIGHTS = np.polynomial.legendre.leggauss(40)
ELASTICA = {**RIGID, "length": 1.0}
SECTION = {"EA": 300.0, "GA": 80.0, "EI": 1.0}
OPEN, STICK, TO_TIP, TO_CLAMP, SLIPPED, LOST, JAMMED = map(
    Outcome, ("open", "stick", "slip to tip", "slip to clamp", "slipped", "lost", "jammed")
)
KS_STATES = [TO_CLAMP, STICK, TO_TIP]


def states(path):
    return [event.after for event in path.events]


def stored(path, k):
    """Strain energy of a rod with EI = L = 1 by quadrature; zero where it is straight."""
    Fx, Fy, _, s = path.unknowns[k]
    part, (stretch, shear) = path.rod.sections(path.unknowns[k], (GAUSS + 1.0) / 2.0), path.rod.flexibility
    c, d = np.cos(part.theta), np.sin(part.theta)
    density = part.moment**2 + stretch * (Fx * c + Fy * d) ** 2 + shear * (Fy * c - Fx * d) ** 2
    return s * (WEIGHTS @ density) / 4.0


def checked(points, friction, lost=1e-13, **given):
    """The path, whose force lies in the cone in stick and on its edge in slip, drags the rod the way of the slip, and keeps its work."""
    path = rod_under_pin(points, friction=friction, **given)
    for k, state in enumerate(path.outcome):
        F_t, F_n = path.tangential[k], path.normal[k]
        assert state.ends or F_n >= -1e-12
        if state is STICK:
            assert abs(F_t) <= friction * F_n + 1e-12
        elif state.touches:
            assert F_t == pytest.approx(state.sense * friction * F_n, abs=1e-12)
    work = np.nanmax(np.abs(path.work))
    assert np.all(np.diff(path.dissipated[np.isfinite(path.dissipated)]) >= -1e-15 * work)
    assert all(event.before is not event.after for event in path.events)
    kept = path.work - [stored(path, k) for k in range(len(path.work))] - path.dissipated
    slipped = [e.load_parameter for e in path.events if e.after is SLIPPED]
    for (first, before), (last, after) in pairwise(zip(path.load_parameter, kept, strict=True)):
        if any(first < t <= last for t in slipped):
            assert after >= before - lost * work
        elif np.isfinite(after):
            assert abs(after - before) <= lost * work + 1e-20
    return path


@pytest.mark.slow_at("0.5")
@pytest.mark.parametrize("friction", [0.1, 0.5])
def test_elastica_on_the_ks_path(friction):
    """A rod without stretch and shear has the values of the first integral; `H = m^2/2 EI + N = F_t` at the clamp gives the friction alone."""
    path = checked(ks_pins([0.0, 0.3, 1.0]), friction, **ELASTICA)
    assert states(path) == KS_STATES
    found = [path.magnitude[2], path.arc_position[2], path.clamp_moment[2]]
    located = [event.load_parameter for event in path.events[1:]]
    assert located + found == pytest.approx(rubbed(friction), abs=5e-11)
    H = path.clamp_moment[1:] ** 2 / 2.0 + path.force[1:, 0]
    normal = np.sqrt(path.magnitude[1:] ** 2 - H**2)
    assert H / normal == pytest.approx([-friction, friction], abs=1e-10)


@pytest.mark.slow_at("0.06-0.1")
@pytest.mark.parametrize(("offset", "radius"), [(0.0, 0.0), (0.06, 0.0), (0.06, 0.1)])
def test_all_conditions_hold_when_integrated_from_the_clamp(offset, radius):
    """Contact at the offset across the mean tangent, the couple of the friction about the axis, Coulomb's law, energy."""
    friction, reach = 0.3, offset + radius
    pins = ks_pins([0.0, 0.3, 0.9], reach)
    path = checked(pins, friction, **SECTION, length=1.0, offset=offset, radius=radius)
    for k, sense in ((1, -1), (2, 1)):
        start = [0.0, 0.0, 0.0, -path.clamp_moment[k]]
        end, before = shot(path.force[k], start, path.arc_position[k], **SECTION)
        mean = (before + np.array([np.cos(end[2]), np.sin(end[2])])) / 2.0
        tangent = mean / np.hypot(*mean)
        normal = np.array([-tangent[1], tangent[0]])
        np.testing.assert_allclose(end[:2] - reach * normal, pins[k], rtol=0, atol=1e-11)
        F_t, F_n = path.force[k] @ tangent, path.force[k] @ normal
        assert path.outcome[k].sense == sense
        assert F_t == pytest.approx(sense * friction * F_n, rel=1e-11)
        assert end[3] == pytest.approx(offset * F_t, abs=1e-11)
        assert end[4] == pytest.approx(stored(path, k), rel=1e-11)


UP = [(0.8, -0.1), (0.8, 0.3), (0.8, -0.2)]
AGAIN = [(0.8, -0.1), (0.8, 0.7), (0.8, 0.6), (0.8, -0.1), (0.8, 0.1)]
PAST = [(0.709, -0.01), (0.781, 0.236), (-0.6, 0.259)]
JAM = [(0.681, -0.019), (0.291, 0.559), (0.735, 0.173)]


@pytest.mark.slow_at(
    "points3-1.086-rod3-elastica3", "points4-0.277-None-elastica4", "points6-0.3-rod6-elastica6"
)
@pytest.mark.parametrize(
    ("points", "friction", "rod", "elastica"),
    [
        (UP, 0.3, [STICK, TO_TIP, STICK, TO_CLAMP, OPEN], [TO_TIP, STICK, TO_CLAMP, OPEN]),
        ([(1.0, -0.1), (1.0, 0.1)], 0.3, [STICK, TO_TIP, SLIPPED], [TO_TIP, SLIPPED]),
        ([(1.0, 0.0), (0.7, 0.2), (0.85, 0.1)], 0.3, [TO_CLAMP, STICK, TO_TIP], [TO_CLAMP, STICK, TO_TIP]),
        (JAM, 1.086, [TO_CLAMP, STICK, TO_TIP, STICK, JAMMED], [TO_CLAMP, STICK, TO_TIP, STICK, JAMMED]),
        (PAST, 0.277, None, [TO_TIP, STICK, TO_CLAMP, STICK, TO_TIP, LOST]),
        ([(1.1, -0.1), (1.1, 0.1)], 0.3, [], []),
        (AGAIN, 0.3, [STICK, TO_TIP, SLIPPED, STICK, TO_TIP], [TO_TIP, SLIPPED, TO_TIP]),
    ],
)
def test_states_along_a_path(points, friction, rod, elastica):
    """A pin that rises square to the axis holds a rod that stretches, for a while; a pin that turns sticks before it slips back."""
    ends = []
    for given, wanted in (({"EA": 3e5, "GA": 1e5, "EI": 1.0, "length": 1.0}, rod), (ELASTICA, elastica)):
        if wanted is not None:
            path = checked(points, friction, 1e-12, **given)
            assert states(path) == wanted
            assert np.isnan(path.magnitude[-1]) == np.isnan(path.work[-1]) == path.outcome[-1].ends
            ends += [event.load_parameter for event in path.events[-1:]]
    assert max(ends, default=0.0) == pytest.approx(min(ends, default=0.0), abs=1e-3)

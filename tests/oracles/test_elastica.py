"""The elastica's integrals against integrations along the axis, and its greatest loads along the paths of pins."""

import numpy as np
import pytest

from comparisons.exact import elastica_under_pin, rod_under_pin
from tests.oracles import elastica
from tests.oracles.shooting import RIGID, shot


@pytest.mark.parametrize("load", [1e-3, 1.0, 30.0])
def test_a_dead_load_integrated_backwards_arrives_at_the_clamp(load: float) -> None:
    """The rotation of the tip follows from x by the energy integral."""
    tip = elastica.tip_under_dead_load(load)
    start = [*tip, np.arcsin(load * tip[0] ** 2 / 2.0), 0.0]
    np.testing.assert_allclose(shot((0.0, load), start, -1.0, **RIGID)[0][:3], 0.0, atol=1e-10)


@pytest.mark.parametrize("moment", [1e-3, -0.1, 2.0])
@pytest.mark.parametrize("thrust", [1e-3, 1.0, 2.4674, 2.5])
def test_thrust_integrated_from_the_clamp_arrives_at_the_tip(thrust: float, moment: float) -> None:
    x, y, turn = elastica.tip_under_thrust(thrust, moment)
    end, _ = shot((-thrust, 0.0), [0.0, 0.0, 0.0, moment + thrust * y], 1.0, **RIGID)
    np.testing.assert_allclose(end[:4], [x, y, turn, moment], atol=1e-11)


@pytest.mark.parametrize(
    ("friction", "drawn_in", "displacement", "pushed_back"),
    [
        (0.0, 0.833976054298, 0.476377598, 0.833976054298),
        (0.1, 0.890538486811, 0.499796765, 0.779438646160),
        (0.2, 0.948651379547, 0.5220894796, 0.727371650252),
        (0.3, 1.007848170943, 0.543001429, 0.678152760523),
    ],
)
def test_the_limit_of_three_point_bending_is_the_largest_load_along_the_path_of_a_support(
    friction: float, drawn_in: float, displacement: float, pushed_back: float
) -> None:
    (load, place), (back, _) = elastica.three_point_limit(friction)
    assert [load, back] == pytest.approx([drawn_in, pushed_back], abs=6e-13)
    assert place == pytest.approx(displacement, abs=6e-10)
    points = [(1.0, 0.0), (1.0, place - 1e-3), (1.0, place), (1.0, place + 1e-3)]
    force = rod_under_pin(points, friction=friction, length=3.0, **RIGID).force[1:, 1]
    assert force[1] == pytest.approx(load, rel=1e-13)
    assert max(force[0], force[2]) < load


def test_the_contact_force_of_a_raised_pin_has_a_maximum_and_the_pin_leaves_at_the_tip() -> None:
    load, place = elastica.contact_force_limit()
    pins = [(1.0, place + d) for d in (-1e-3, 0.0, 1e-3)]
    before, at, after = elastica_under_pin(pins, length=3.0).magnitude
    assert at == pytest.approx(load, rel=1e-14)
    assert max(before, after) < load
    for x in (0.8, 0.9, 0.95, 0.99):
        height = elastica.slip_off_height(x)
        below, above = elastica_under_pin([(x, height - 1e-9), (x, height + 1e-9)]).arc_position
        assert below == pytest.approx(1.0, abs=1e-7)
        assert np.isnan(above)

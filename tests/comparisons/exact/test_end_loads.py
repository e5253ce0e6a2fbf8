"""The elastica under thrust and moment at its tip, against an integration from the clamp and against limits."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from comparisons.exact.end_loads import tip_under_moment, tip_under_thrust


def integrated(thrust: float, moment: float) -> np.ndarray:
    """Tip of the elastica with EI = L = 1 by integration from the clamp, which balances the loads at the stated tip."""
    y = tip_under_thrust(thrust, moment)[1]
    curvature = moment + thrust * y

    def rates(_: float, state: np.ndarray) -> list[float]:
        theta, bend, _, _ = state
        return [bend, -thrust * np.sin(theta), np.cos(theta), np.sin(theta)]

    end = solve_ivp(rates, (0.0, 1.0), [0.0, curvature, 0.0, 0.0], method="DOP853", rtol=1e-13, atol=1e-14).y[
        :, -1
    ]
    assert end[1] == pytest.approx(moment, abs=1e-11)
    return np.array([end[2], end[3], end[0]])


@pytest.mark.parametrize("moment", [1e-3, -0.1, 2.0])
@pytest.mark.parametrize("thrust", [1e-3, 1.0, 2.4674, 2.5])
def test_integration_from_the_clamp_arrives_at_the_tip(thrust: float, moment: float) -> None:
    assert tip_under_thrust(thrust, moment) == pytest.approx(integrated(thrust, moment), abs=1e-11)


def test_without_thrust_it_is_an_arc() -> None:
    found = tip_under_thrust(1e-12, 1.3)
    assert found == pytest.approx([*tip_under_moment(1.3), 1.3], abs=1e-11)


def test_units_and_bad_values() -> None:
    small, large = (
        tip_under_thrust(3.0, 0.01),
        tip_under_thrust(3.0 * 7.0 / 4.0, 0.01 * 7.0 / 2.0, EI=7.0, length=2.0),
    )
    assert large == pytest.approx(small * [2.0, 2.0, 1.0], rel=1e-13)
    with pytest.raises(ValueError, match="more than half a circle"):
        tip_under_thrust(6.0, 2.0)
    with pytest.raises(ValueError, match="moment = 0"):
        tip_under_thrust(1.0, 0.0)
    with pytest.raises(ValueError, match="thrust = -1"):
        tip_under_thrust(-1.0, 0.1)

"""The elastica's elliptic integrals against integrations along the axis."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.oracles.elastica import tip_under_dead_load, tip_under_thrust


def integrated(force: tuple[float, float], start: list[float], length: float) -> np.ndarray:
    """Rotation, moment and place after a length, with a constant force and EI = 1, from values of the same."""

    def rates(_: float, state: np.ndarray) -> list[float]:
        c, s = np.cos(state[0]), np.sin(state[0])
        return [state[1], s * force[0] - c * force[1], c, s]

    return solve_ivp(rates, (0.0, length), start, method="DOP853", rtol=1e-13, atol=1e-15).y[:, -1]


@pytest.mark.parametrize("load", [1e-3, 1.0, 30.0])
def test_a_dead_load_integrated_backwards_arrives_at_the_clamp(load: float) -> None:
    """The rotation of the tip follows from x by the energy integral."""
    tip = tip_under_dead_load(load)
    start = [np.arcsin(load * tip[0] ** 2 / 2.0), 0.0, *tip]
    np.testing.assert_allclose(integrated((0.0, load), start, -1.0)[[0, 2, 3]], 0.0, atol=1e-10)


def test_a_large_dead_load_hangs_the_beam_straight() -> None:
    np.testing.assert_allclose(tip_under_dead_load(1e4), [np.sqrt(2e-4), 1.0], rtol=0.01)


@pytest.mark.parametrize("moment", [1e-3, -0.1, 2.0])
@pytest.mark.parametrize("thrust", [1e-3, 1.0, 2.4674, 2.5])
def test_thrust_integrated_from_the_clamp_arrives_at_the_tip(thrust: float, moment: float) -> None:
    x, y, turn = tip_under_thrust(thrust, moment)
    end = integrated((-thrust, 0.0), [0.0, moment + thrust * y, 0.0, 0.0], 1.0)
    np.testing.assert_allclose(end, [turn, moment, x, y], atol=1e-11)

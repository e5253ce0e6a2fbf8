"""Frames by shooting, whose small deflections have a closed form."""

import numpy as np
import pytest

from tests.oracles.frames import Frame


@pytest.mark.parametrize(("clamped", "bending"), [(True, 192.0), (False, 48.0)])
@pytest.mark.parametrize("GA", [np.inf, 50.0])
def test_small_deflection_of_a_straight_beam(clamped: bool, bending: float, GA: float) -> None:
    """``d = P (L^3/(192 EI) + L/(4 GA))`` between clamps, 48 between hinges; what bends stretches by the deflection's square."""
    beam = Frame(joints=((0, 0), (1.5, 0), (3, 0)), loaded=1, clamped=clamped, EA=1e4, GA=GA, EI=7.0)
    flexibility = 27.0 / (bending * 7.0) + 3.0 / (4.0 * GA)
    assert beam.load([1e-5])[0] == pytest.approx(1e-5 / flexibility, rel=1e-6)

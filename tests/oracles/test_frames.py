"""Frames by shooting: small deflections in closed form, and the same frame stated otherwise."""

from dataclasses import replace

import numpy as np
import pytest

from tests.oracles.frames import Frame

LEE = Frame(
    joints=((0.0, 0.0), (0.0, 1.2), (0.24, 1.2), (1.2, 1.2)), loaded=2, clamped=False, EA=2e3, GA=5e2, EI=1.0
)


@pytest.mark.parametrize(("clamped", "bending"), [(True, 192.0), (False, 48.0)])
@pytest.mark.parametrize("GA", [np.inf, 50.0])
def test_small_deflection_of_a_straight_beam(clamped: bool, bending: float, GA: float) -> None:
    """``d = P (L^3/(192 EI) + L/(4 GA))`` between clamps, 48 between hinges; what bends stretches by the deflection's square."""
    beam = Frame(joints=((0, 0), (1.5, 0), (3, 0)), loaded=1, clamped=clamped, EA=1e4, GA=GA, EI=7.0)
    flexibility = 27.0 / (bending * 7.0) + 3.0 / (4.0 * GA)
    assert beam.load([1e-5])[0] == pytest.approx(1e-5 / flexibility, rel=1e-6)


def test_lees_frame_turned_from_its_other_support_and_with_one_more_joint() -> None:
    down = np.linspace(0.04, 0.48, 9)
    load = LEE.load(down)
    mirrored = replace(LEE, joints=tuple((-x, y) for x, y in LEE.joints[::-1]), loaded=1)
    c, s = np.cos(0.7), np.sin(0.7)
    joints = tuple((float(c * x - s * y), float(s * x + c * y)) for x, y in LEE.joints)
    turned = replace(LEE, joints=joints, direction=(float(s), float(-c)))
    cut = replace(LEE, joints=(LEE.joints[0], (0.0, 0.5), *LEE.joints[1:]), loaded=3)
    for other in (mirrored, turned, cut):
        assert other.load(down) == pytest.approx(load, rel=1e-9)
    with pytest.raises(ArithmeticError, match="no equilibrium at the deflection 5"):
        LEE.load([5.0])

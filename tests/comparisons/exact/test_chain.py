"""Chains of rods under one load: small deflections in closed form, and the same frame stated otherwise."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.exact.chain import Chain, load_path

BEAM = Chain(joints=((0.0, 0.0), (0.5, 0.0), (1.0, 0.0)), loaded=1, clamped=True, EA=1e4, GA=np.inf, EI=1.0)
LEE = Chain(
    joints=((0.0, 0.0), (0.0, 1.2), (0.24, 1.2), (1.2, 1.2)), loaded=2, clamped=False, EA=2e3, GA=5e2, EI=1.0
)


@pytest.mark.parametrize(("clamped", "bending"), [(True, 192.0), (False, 48.0)])
@pytest.mark.parametrize("GA", [np.inf, 50.0])
def test_small_deflection_of_a_straight_beam(clamped, bending, GA):
    """``d = P (L^3/(192 EI) + L/(4 GA))`` between clamps, 48 between hinges; what bends stretches by the deflection's square."""
    size = 3.0
    joints = tuple((size * x, size * y) for x, y in BEAM.joints)
    beam = replace(BEAM, joints=joints, clamped=clamped, GA=GA, EI=7.0)
    flexibility = size**3 / (bending * 7.0) + size / (4.0 * GA)
    assert load_path(beam, [1e-5])[0] == pytest.approx(1e-5 / flexibility, rel=1e-6)


@pytest.mark.slow
def test_from_the_other_support_or_with_one_more_joint():
    """Lee's frame, soft in stretch and shear, shot from its other end, and with its rods cut once more."""
    down = np.linspace(0.02, 0.56, 15)
    load = load_path(LEE, down)
    mirrored = replace(LEE, joints=tuple((-x, y) for x, y in LEE.joints[::-1]), loaded=1)
    assert load_path(mirrored, down) == pytest.approx(load, rel=1e-9)
    (a, b, c, d) = LEE.joints
    cut = replace(LEE, joints=(a, (0.0, 0.5), b, c, (0.8, 1.2), d), loaded=3)
    assert load_path(cut, down) == pytest.approx(load, rel=1e-9)
    assert np.argmax(load) not in {0, 14}


def test_a_frame_that_is_turned_with_its_load():
    """Lee's frame turned by .7 rad and by a half circle."""
    down = np.linspace(0.02, 0.5, 9)
    load = load_path(LEE, down)
    for angle in (0.7, np.pi):
        c, s = np.cos(angle), np.sin(angle)
        joints = tuple((float(c * x - s * y), float(s * x + c * y)) for x, y in LEE.joints)
        turned = replace(LEE, joints=joints, direction=(float(s), float(-c)))
        assert load_path(turned, down) == pytest.approx(load, rel=1e-9)


def test_what_is_not_a_chain_is_refused():
    with pytest.raises(ValueError, match=r"loaded = 2: must be a joint between the supports"):
        replace(BEAM, loaded=2)
    with pytest.raises(ValueError, match=r"EA = -1.0: must be positive"):
        replace(BEAM, EA=-1.0)
    with pytest.raises(ValueError, match=r"direction = \(1.0, 1.0\): must be a unit vector"):
        replace(LEE, direction=(1.0, 1.0))
    with pytest.raises(ArithmeticError, match="no equilibrium at the deflection 5"):
        load_path(LEE, [5.0])

"""End sections as control points, moments on them, and stages."""

from dataclasses import replace

import numpy as np
import pytest

import fem_reference as fr
from tests.fem_reference.conftest import (
    CLAMP,
    EI,
    NU,
    PAIR,
    STRIP,
    B,
    E,
    held,
    load,
    loads,
    rotation,
    support,
)


@pytest.mark.parametrize(
    "changes",
    [
        {"element": "Q1", "material": "biot-linear"},
        {"element": "Q2-full", "material": "neo-hookean"},
        {"element": "Q2"},
        {"turn": 1.5, "end_height": 0.04},
    ],
)
def test_a_rigid_rotation_of_the_control_point_gives_no_stress(changes):
    """Turned by two thirds of a turn in one support: the strip follows, without energy and reaction."""
    motion = (0.3, -0.2, -4 * np.pi / 3)
    result = fr.solve(held(support(motion=motion), mesh=(6, 1), **changes), loads(2))
    places = result.mesh_points @ rotation(motion[2]).T + motion[:2]
    np.testing.assert_allclose(result.mesh_points + result.displacement[-1], places, atol=1e-9)
    assert sum(fr.energy(result, -1)) < 1e-11 * EI
    assert np.abs(result.supports[CLAMP].force).max() < 1e-9 * EI
    assert np.abs(result.supports[CLAMP].moment).max() < 1e-9 * EI
    assert np.all(result.index == 0)


@pytest.mark.parametrize("element", ["Q2", "Q2-full"])
@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("clamped", [(), ("start",)])
def test_a_moment_gives_pure_bending_in_small_strain(element, plane, clamped):
    """The rate at rest is the exact field ``(-x y, x^2 / 2 + nu' y^2 / 2)`` of curvature M / EI, to 1e-10.

    It is extrapolated from four moments. The strip is stocky, since the round-off of its stiffness grows with L/h.
    """
    height, modulus = 0.2, {"stress": E, "strain": E / (1 - NU**2)}[plane]
    stiffness = modulus * B * height**3 / 12
    changes = {"element": element, "plane": plane, "clamped": clamped, "mesh": (8, 2), "height": height}
    held_by, exactly = () if clamped else (support(),), fr.Settings(tolerance=1e-13)
    bent = [
        fr.solve(held(*held_by, load(moment=sign * 2e-3 * stiffness), **changes), loads(2), exactly)
        for sign in (1, -1)
    ]
    one, two = (bent[0].displacement - bent[1].displacement) / 2
    rate = (8 * one - two) / 6 / 1e-3
    x, y = bent[0].mesh_points.T
    nu = {"stress": NU, "strain": NU / (1 - NU)}[plane]
    mean = 0.0 if clamped else height**2 / 12
    exact = np.stack([-x * y, x**2 / 2 + nu * (y**2 - mean) / 2], axis=1)
    np.testing.assert_allclose(rate, exact, rtol=0, atol=1e-10 * np.abs(exact).max())


def test_a_moment_rolls_the_strip_up():
    """The tip turns by more than once round: M L / EI to a quarter of the square of twice the face's strain, ``kappa h``."""
    stiffness, turned = E * B * 0.002**3 / 12, 2.2 * np.pi
    problem = held(
        support(), load(moment=turned * stiffness), height=0.002, mesh=(80, 1), material="biot-linear"
    )
    result = fr.solve(problem, loads(5))
    tip = np.array([np.sin(turned), 1 - np.cos(turned)]) / turned
    np.testing.assert_allclose(result.tips[STRIP][-1], tip, atol=3e-5)
    line = fr.axis_line(result, STRIP, -1)
    ahead = np.diff(line[-2:], axis=0)[0]
    last = np.arctan2(ahead[1], ahead[0]) + turned / 160 / 2
    assert last == pytest.approx(turned - 2 * np.pi, abs=turned * (turned * 0.002) ** 2 / 4)
    assert result.supports[CLAMP].moment[-1] == pytest.approx(-turned * stiffness, rel=1e-9)


def test_a_pin_goes_on_from_where_it_is_at_constant_speed():
    pin = fr.Pin(
        name="p",
        path=((0.0, 0.0),),
        onward=(((1.0, 0.0), (1.0, 1.0)), (), ((0.0, 1.0),), ((0.0, 4.0), (1.0, 4.0))),
    )
    places = [pin.position(t).tolist() for t in (0.5, 1.0, 1.5, 2.0, 2.7, 3.5, 4.0, 4.375, 4.875)]
    assert places == [[0, 0], [0, 0], [1, 0], [1, 1], [1, 1], [0.5, 1], [0, 1], [0, 2.5], [0.5, 4]]
    assert pin.turns == (1.5, 4.75)


def staged():
    """A pin, a support and a load of every kind, moved in the first stage, and back in the third one."""
    there_and_back = [(sign, stage) for sign, stage in ((-1, 0), (1, 2))]
    conditions = [
        support(motion=(0.0, 0.02, 0.3), onward=((0.0, 0.0, 0.0), (0.0, -0.02, -0.3))),
        *(fr.LineLoad(strip=STRIP, force=((0.0, 3 * sign * EI),), stage=k) for sign, k in there_and_back),
        *(fr.PointLoad(strip=STRIP, at=0.6, force=(0.0, sign * EI), stage=k) for sign, k in there_and_back),
        *(load(moment=sign * EI / 2, stage=k) for sign, k in ((1, 1), (-1, 2))),
    ]
    pin = fr.Pin(name="pin", path=((0.8, -0.001), (0.8, 0.1)), onward=((), ((0.8, -0.001),)))
    contact = fr.Contact(node="pin", strip=STRIP, penalty=1e4)
    return replace(held(*conditions, mesh=(20, 1)), pins=(pin,), contacts=(contact,))


def test_a_stage_leads_back_on_the_way_there():
    """What the first two stages have done, the third one undoes, and every state of it is in balance."""
    problem = staged()
    assert (problem.stages, problem.turns) == (3, (1.0, 2.0))
    result = fr.solve(problem, np.arange(1, 13) / 4)
    reaction = result.supports[CLAMP].force
    assert result.contacts[PAIR].force[3] > 0.01 * EI
    assert np.abs(result.displacement[-1]).max() < 1e-8
    assert np.abs(reaction[-1]).max() < 1e-8 * EI
    assert reaction[7, 1] != pytest.approx(reaction[3, 1], rel=1e-3)  # the moment of the second stage
    with pytest.raises(ValueError, match=r"must be a one-dimensional increasing array in \(0, 3\]"):
        fr.solve(problem, np.array([3.1]))

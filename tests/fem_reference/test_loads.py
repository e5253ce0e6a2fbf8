"""Loads, supports, joints, stages and arcs of strips against beam theory."""

from dataclasses import replace

import numpy as np
import pytest

import fem_reference as fr
from tests.fem_reference.strips import (
    CLAMP,
    EI,
    NU,
    PAIR,
    STRIP,
    B,
    E,
    H,
    held,
    load,
    loads,
    pressed,
    rotation,
    support,
)

KEPT = {"clamped": ("start",)}


def test_the_axis_has_a_point_at_a_moment_between_two_sections():
    """At .29 of a strip of length 2, on the line through a free strip's sections that a moment turns with its hinge."""
    hinge, spring = (
        support(motion=(0.0, 0.0, None)),
        fr.Spring(strip=STRIP, end="start", stiffness=(0, 0, EI)),
    )
    moment = fr.PointLoad(strip=STRIP, at=0.29, moment=1e-6 * EI)
    result = fr.solve(held(hinge, spring, moment, end=(2.0, 0.0), mesh=(8, 1)), loads(1))
    stations, line = fr.axis_stations(result, STRIP), fr.axis_line(result, STRIP, -1)
    (at,) = np.flatnonzero(np.abs(stations - 0.58) < 1e-12)
    assert len(stations) == len(line) == 18
    assert line[at] == pytest.approx([0.58, 1e-6 * (0.58 + 0.58**2 / 2)], abs=1e-10)


def test_a_face_contact_is_on_the_face_of_the_taper():
    """A sharp pin touches the inclined face at the start; below it, it is refused."""

    def problem(y):
        return pressed(
            held(end_height=0.01, **KEPT), ((0.6, y), (0.6, y - 1e-6)), side="left", surface="face"
        )

    face = (H - 0.6 * 0.01) / 2
    with pytest.raises(ValueError, match="must not start beyond the left face"):
        problem(face - 1e-6)
    x, y = fr.solve(problem(face), loads(1)).contacts[PAIR].vector[-1]
    assert x / y == pytest.approx(-np.tan(-0.005), rel=2e-3)  # normal to the face, which falls by .005


def test_a_rotational_spring_turns_with_its_moment():
    """By any angle: a strip on a hinge with a spring, turned by a moment of 4 rad times its stiffness."""
    k = 1e-3 * EI
    hinge = support(motion=(0.0, 0.0, None))
    spring = fr.Spring(strip=STRIP, end="start", stiffness=(0.0, 0.0, k))
    result = fr.solve(held(hinge, spring, load(moment=4 * k), mesh=(8, 1)), loads(8))
    assert result.springs[CLAMP].moment[-1] == pytest.approx(-4 * k, rel=1e-8)
    angle = np.arctan2(*result.tips[STRIP][-1][::-1]) % (2 * np.pi)
    assert angle == pytest.approx(4.0 + 0.002, abs=1e-7)  # half of the strip's own turn of .004


@pytest.mark.parametrize("angle", [0.0, np.pi / 2, 0.9])
def test_a_full_clamp_holds_every_point_of_its_edge(angle):
    along = rotation(angle)[:, 0]
    clamp = {"clamp": "full", "end": tuple(map(float, along)), "mesh": (4, 2)}
    result = fr.solve(held(load(force=(EI, 2 * EI)), **KEPT | clamp), loads(1))
    still = np.flatnonzero(np.all(result.displacement[-1] == 0.0, axis=1))
    assert still.tolist() == np.flatnonzero(np.abs(result.mesh_points @ along) < 1e-9).tolist()


def arc(turn, **changes):
    chord = np.sin(turn / 2) / (turn / 2)
    return {"start": (0.3, 0.2), "end": (0.3 + 0.6 * chord, 0.2 + 0.8 * chord), "turn": turn} | changes


@pytest.mark.parametrize("turn", [1e-3, -2.5])
def test_a_moment_straightens_a_curved_strip(turn):
    """The moment -EI kappa, up to terms of the order (kappa h)^2, and the strains of the faces; at first the mesh is the arc."""
    t = np.array([1e-9, 1 / 3, 2 / 3, 1.0])
    result = fr.solve(held(load(moment=-EI * turn), material="biot-linear", **KEPT, **arc(turn)), t)
    strip, axis, bent = result.model.problem.strips[0], fr.axis_line(result, STRIP, 0), (turn * H) ** 2
    middle = np.add(strip.start, strip.end) / 2 - (1 - np.cos(turn / 2)) / turn * np.array([-0.8, 0.6])
    np.testing.assert_allclose(axis[50], middle, rtol=0, atol=2e-9 * abs(turn) + H**2 * abs(turn) / 12)
    straight = np.add(strip.start, strip.directions(0.0)[0])
    np.testing.assert_allclose(result.tips[STRIP][-1], straight, rtol=0, atol=1e-7 + bent)
    forces = fr.section_forces(result, STRIP, -1)
    np.testing.assert_allclose(forces.M, -EI * turn, rtol=1e-5)
    assert np.abs(forces.N).max() < 1e-5 * EI * abs(turn)
    assert np.ptp(forces.rotation) < 1e-6 + bent
    _, strains = fr.face_strains(result, STRIP, -1)
    for side, sign in (("left", 1), ("right", -1)):
        np.testing.assert_allclose(strains[side], sign * turn * H / 2, rtol=0.03)
    stress = np.abs(fr.fibre_stress(result, -1))  # two of five rows of nodes are on the faces
    assert [stress.max(), np.quantile(stress, 0.7)] == pytest.approx([E * abs(turn) * H / 2] * 2, rel=0.06)


@pytest.mark.parametrize(
    ("element", "plane", "clamped"), [("Q2", "strain", ()), ("Q2-full", "stress", ("start",))]
)
def test_a_moment_gives_pure_bending_in_small_strain(element, plane, clamped):
    """The rate at rest is the exact field ``(-x y, x^2 / 2 + nu' y^2 / 2)`` of curvature M / EI, to 1e-10."""
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

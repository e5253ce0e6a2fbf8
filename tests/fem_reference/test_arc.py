"""Strips whose undeformed axis is an arc of a circle."""

from dataclasses import replace

import numpy as np
import pytest

import fem_reference as fr
from fem_reference.body import build_body
from fem_reference.strip import ELEMENTS
from tests.fem_reference.conftest import STEP, STRIP, B, make_strip, rotation

H = 0.02
turns = pytest.mark.parametrize("turn", [1e-3, 1.0, -2.5])


def arc(turn, **changes):
    """A strip of length 1."""
    chord = np.sin(turn / 2) / (turn / 2)
    return make_strip(start=(0.3, 0.2), end=(0.3 + 0.6 * chord, 0.2 + 0.8 * chord), turn=turn, **changes)


@turns
def test_the_mesh_is_the_arc(turn):
    strip = arc(turn)
    mesh = build_body(strip).mesh
    assert strip.length == pytest.approx(1.0, rel=1e-14)
    assert mesh.weights.sum() == pytest.approx(H * B, rel=1e-7)
    ends = [strip.to_global(mesh.nodes[mesh.edges[end]]).mean(axis=0) for end in ("start", "end")]
    np.testing.assert_allclose(ends, [strip.start, strip.end], atol=1e-14)
    middle = strip.to_global(strip.placed(np.array([0.5, 0.0])))
    chord = np.subtract(strip.end, strip.start)
    sag = (1 - np.cos(turn / 2)) / turn
    left = np.array([-0.8, 0.6])
    np.testing.assert_allclose(middle, np.array(strip.start) + chord / 2 - sag * left, atol=1e-13)
    assert strip.place(strip.placed(np.array([0.37, 0.004]))) == pytest.approx((0.37, 0.004), abs=1e-13)


@pytest.mark.parametrize(
    ("clamp", "mesh", "element"), [("rod", (8, 1), "Q2"), ("full", (8, 2), "Q2"), ("rod", (20, 3), "Q1")]
)
def test_an_arc_that_is_clamped_at_its_end_is_the_arc_stated_from_there(clamp, mesh, element):
    """Also where no node is at the middle of the clamped edge."""
    force = (0.3 * make_strip().bending_stiffness, -make_strip().bending_stiffness)
    one = arc(1.2, clamped=("end",), clamp=clamp, mesh=mesh, element=element)
    other = arc(1.2, clamp=clamp, mesh=mesh, element=element)
    other = replace(other, start=one.end, end=one.start, turn=-1.2)
    found = []
    for strip, end in ((one, "start"), (other, "end")):
        load = fr.EndLoad(strip=STRIP, end=end, force=force)
        found.append(fr.solve(fr.SolidProblem(strips=(strip,), loads=(load,)), np.array([0.5, 1.0])))
    a, b = found
    held, holding = a.supports[f"{STRIP}.end"], b.supports[f"{STRIP}.start"]
    np.testing.assert_allclose(held.force, -np.outer([0.5, 1.0], force), rtol=1e-8)
    np.testing.assert_allclose(held.moment, holding.moment, rtol=1e-8)
    np.testing.assert_allclose(fr.axis_line(a, STRIP, 1), fr.axis_line(b, STRIP, 1)[::-1], atol=1e-9)


@pytest.mark.parametrize("element", ELEMENTS)
def test_an_arc_is_free_of_stress_and_its_stiffness_is_exact(element):
    body = build_body(arc(1.5, mesh=(6, 2), height=0.1, element=element, end_height=0.2))
    X = body.mesh.nodes
    rigid = X @ rotation(2.0).T + [3.0, -1.0] - X
    assert np.abs(body.internal_force(rigid)).max() < 1e-12 * np.abs(body.tangent(0 * X)).max()
    rng = np.random.default_rng(0)
    u, dq = 1e-3 * rng.standard_normal(X.shape), rng.standard_normal(body.expansion.shape[1])
    v = (body.expansion @ dq).reshape(-1, 2)
    derivative = body.expansion.T @ body.internal_force(u + 1j * STEP * v).imag.ravel() / STEP
    np.testing.assert_allclose(
        body.tangent(u) @ dq, derivative, rtol=0, atol=1e-12 * np.abs(derivative).max()
    )


@turns
def test_a_moment_straightens_a_curved_strip(turn):
    """The moment -EI kappa, up to terms of the order (kappa h)^2, and the strains of the faces."""
    strip = arc(turn, material="biot-linear")
    moment = -strip.bending_stiffness * turn
    problem = fr.SolidProblem(strips=(strip,), loads=(fr.EndLoad(strip=STRIP, moment=moment),))
    result = fr.solve(problem, np.arange(1, 4) / 3)
    straight = np.array(strip.start) + strip.frame[:, 0]
    bent = (turn * H) ** 2
    np.testing.assert_allclose(result.tips[STRIP][-1], straight, atol=1e-7 + bent)
    forces = fr.section_forces(result, STRIP, 2)
    np.testing.assert_allclose(forces.M, moment, rtol=1e-5)
    assert np.abs(forces.N).max() < 1e-5 * abs(moment)
    assert np.ptp(forces.rotation) < 1e-6 + bent
    stations, strains = fr.face_strains(result, STRIP, 2)
    assert stations.size
    for side, sign in (("left", 1), ("right", -1)):
        np.testing.assert_allclose(strains[side], sign * turn * H / 2, rtol=0.03)
    largest = np.abs(fr.fibre_stress(result, 2)).max()
    assert largest == pytest.approx(strip.youngs_modulus * abs(turn) * H / 2, rel=0.06)


@pytest.mark.parametrize(
    ("changes", "rule"),
    [
        ({"turn": 6.3}, "turn = 6.3: must lie between -2 pi and 2 pi"),
        ({"turn": 2.0, "height": 1.1}, "turn = 2.0: must leave the radius"),
        ({"turn": 1.0, "mesh_file": "a.msh"}, "turn = 1.0: must be zero with a mesh file"),
    ],
)
def test_mistakes_cost_one_line(changes, rule):
    with pytest.raises(ValueError, match=rule):
        arc(**changes)

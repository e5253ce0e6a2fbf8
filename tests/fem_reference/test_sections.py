import numpy as np
import pytest

import fem_reference as fr
from tests.fem_reference.conftest import CLAMP, PAIR, STRIP, loads, rotation


@pytest.fixture(scope="module", params=[0.0, 0.9])
def turned(request, problem):
    """A biot-linear strip in a turned scene, bent far by a pin."""
    end, *path = np.array([[1.0, 0.0], [0.8, 0.0], [0.6, 0.4]]) @ rotation(request.param).T
    scene = problem(end=tuple(end), path=tuple(map(tuple, path)), material="biot-linear")
    return fr.solve(scene, loads(4))


def test_section_forces_are_those_of_statics(turned):
    """The pin's force alone gives f and M on every section between clamp and contact; both vanish beyond."""
    k = -1
    forces = fr.section_forces(turned, STRIP, k)
    contact = turned.contacts[PAIR]
    p, pin = contact.vector[k], turned.model.problem.pins[0].position(1.0)
    loaded = forces.stations < contact.arc_position[k] - 0.06
    beyond = forces.stations > contact.arc_position[k] + 0.06
    axis = fr.axis_stations(turned, STRIP)
    line = [np.interp(forces.stations, axis, x) for x in fr.axis_line(turned, STRIP, k).T]
    arm = pin[:, None] - line
    M = arm[0] * p[1] - arm[1] * p[0]
    scale = np.hypot(*p)
    inner = loaded & (forces.stations > 0.1)
    np.testing.assert_allclose(forces.force[inner], p + 0 * forces.force[inner], atol=2e-3 * scale)
    np.testing.assert_allclose(forces.M[inner], M[inner], atol=1e-3 * np.abs(M).max())
    np.testing.assert_allclose(forces.force[beyond], 0, atol=2e-3 * scale)
    np.testing.assert_allclose(forces.M[beyond], 0, atol=1e-4 * np.abs(M).max())
    normal = np.stack([np.cos(forces.rotation), np.sin(forces.rotation)])
    np.testing.assert_allclose(forces.N[inner], (normal[:, inner].T * p).sum(axis=1), atol=2e-3 * scale)
    np.testing.assert_allclose(
        forces.V[inner], p[1] * normal[0, inner] - p[0] * normal[1, inner], atol=2e-3 * scale
    )


def test_moment_is_the_bending_stiffness_times_the_curvature(turned):
    """``M = E I dtheta/dX`` of a rod, and the faces' strains ``-+ h/2 dtheta/dX``."""
    forces, strip = fr.section_forces(turned, STRIP, -1), turned.model.problem.strips[0]
    stations, strains = fr.face_strains(turned, STRIP, -1)
    np.testing.assert_array_equal(stations, forces.stations)
    inner = (stations > 0.1) & (stations < turned.contacts[PAIR].arc_position[-1] - 0.1)
    curvature = np.gradient(forces.rotation, stations)
    np.testing.assert_allclose(forces.M[inner], strip.bending_stiffness * curvature[inner], rtol=3e-3)
    for name, y in (("right", -0.01), ("left", 0.01)):
        np.testing.assert_allclose(strains[name][inner], -y * curvature[inner], rtol=2e-2)


def test_clamp_reaction_is_the_force_on_the_first_sections(turned):
    """The mean over an element's two Gauss stations; the moment extrapolated from them to the clamp."""
    support, k = turned.supports[CLAMP], -1
    forces = fr.section_forces(turned, STRIP, k)
    np.testing.assert_allclose(
        forces.force[2:4].mean(axis=0), -support.force[k], atol=3e-4 * np.hypot(*support.force[k])
    )
    slope = np.diff(forces.M[2:4]) / np.diff(forces.stations[2:4])
    assert forces.M[2] - slope[0] * forces.stations[2] == pytest.approx(-support.moment[k], rel=2e-3)


def test_the_j_integral_is_the_tangential_force(turned):
    """It vanishes between clamp and contact, where the bending part alone is more than half of the contact force, and in the free tail."""
    forces, strip = fr.section_forces(turned, STRIP, -1), turned.model.problem.strips[0]
    force, arc = turned.contacts[PAIR].force[-1], turned.contacts[PAIR].arc_position[-1]
    inner = (forces.stations > 0.03) & (forces.stations < arc - 0.03)
    bending = forces.M**2 / (2 * strip.bending_stiffness)
    assert bending.max() > 0.5 * force
    assert np.abs(forces.material_force[inner]).max() < 1e-4 * force
    assert abs(forces.material_force[inner].mean()) < 1e-5 * force
    assert np.abs(forces.material_force[forces.stations > arc + 0.03]).max() < 1e-6 * force

import numpy as np
import pytest

import fem_reference as fr

STRIP, PAIR = "cantilever", "pin->cantilever"


@pytest.fixture(scope="module", params=[0.0, 0.9])
def turned(request, problem):
    """A biot-linear strip in a turned scene, bent far by a pin."""
    c, s = np.cos(request.param), np.sin(request.param)

    def place(x, y):
        return (float(c * x - s * y), float(s * x + c * y))

    changes = {"end": place(1.0, 0.0), "path": (place(0.8, 0.0), place(0.6, 0.4)), "material": "biot-linear"}
    return fr.solve(problem(**changes), np.arange(1, 5) / 4)


def test_section_forces_are_those_of_statics(turned):
    """From the pin's force alone: f and M on every section between clamp and contact, nothing beyond."""
    k = -1
    found = fr.section_forces(turned, STRIP, k)
    contact = turned.contacts[PAIR]
    p, pin = contact.vector[k], turned.model.problem.pins[0].position(1.0)
    loaded = found.stations < contact.arc_position[k] - 0.06
    beyond = found.stations > contact.arc_position[k] + 0.06
    line = np.stack(
        [
            np.interp(found.stations, fr.axis_stations(turned, STRIP), x)
            for x in fr.axis_line(turned, STRIP, k).T
        ]
    )
    arm = pin[:, None] - line
    M = arm[0] * p[1] - arm[1] * p[0]
    scale = np.hypot(*p)
    inner = loaded & (found.stations > 0.1)
    np.testing.assert_allclose(found.force[inner], p + 0 * found.force[inner], atol=2e-3 * scale)
    np.testing.assert_allclose(found.M[inner], M[inner], atol=1e-3 * np.abs(M).max())
    np.testing.assert_allclose(found.force[beyond], 0, atol=2e-3 * scale)
    np.testing.assert_allclose(found.M[beyond], 0, atol=1e-4 * np.abs(M).max())
    normal = np.stack([np.cos(found.rotation), np.sin(found.rotation)])
    np.testing.assert_allclose(found.N[inner], (normal[:, inner].T * p).sum(axis=1), atol=2e-3 * scale)
    np.testing.assert_allclose(
        found.V[inner], p[1] * normal[0, inner] - p[0] * normal[1, inner], atol=2e-3 * scale
    )


def test_moment_is_the_bending_stiffness_times_the_curvature(turned):
    """``M = E I dtheta/dX`` of a rod, and the faces' strains ``-+ h/2 dtheta/dX``."""
    found, strip = fr.section_forces(turned, STRIP, -1), turned.model.problem.strips[0]
    stations, strains = fr.face_strains(turned, STRIP, -1)
    np.testing.assert_array_equal(stations, found.stations)
    inner = (stations > 0.1) & (stations < turned.contacts[PAIR].arc_position[-1] - 0.1)
    curvature = np.gradient(found.rotation, stations)
    np.testing.assert_allclose(found.M[inner], strip.bending_stiffness * curvature[inner], rtol=3e-3)
    for name, y in (("right", -0.01), ("left", 0.01)):
        np.testing.assert_allclose(strains[name][inner], -y * curvature[inner], rtol=2e-2)


def test_clamp_reaction_is_the_force_on_the_first_sections(turned):
    """The mean over an element's two Gauss stations; the moment extrapolated from them to the clamp."""
    support, k = turned.supports[STRIP], -1
    found = fr.section_forces(turned, STRIP, k)
    np.testing.assert_allclose(
        found.force[2:4].mean(axis=0), -support.force[k], atol=3e-4 * np.hypot(*support.force[k])
    )
    slope = np.diff(found.M[2:4]) / np.diff(found.stations[2:4])
    assert found.M[2] - slope[0] * found.stations[2] == pytest.approx(-support.moment[k], rel=2e-3)


def test_sections_of_the_users_own_choice(turned):
    own = fr.section_forces(turned, STRIP, -1, np.array([0.25, 0.251]))
    all_ = fr.section_forces(turned, STRIP, -1)
    np.testing.assert_allclose(own.M, np.interp(own.stations, all_.stations, all_.M), rtol=2e-3)

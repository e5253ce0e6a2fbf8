from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.sparse import eye_array

import fem_reference as fr
from fem_reference.curve import ContactCurve, CurveFrom, averaging, band_slopes, closest
from fem_reference.model import build
from tests.fem_reference.conftest import PAIR, STEP, loads, make_problem, place_pin, surfaces

# Inside an element, at a corner and a midside node, one unit of round-off beside it, near both ends.
PLACES = [0.33, 0.4, 0.5, np.nextafter(0.4, 1), np.nextafter(0.4, 0), 0.02, 0.97]


@pytest.fixture
def model(request, problem):
    """A strip turned by 0.4 in its scene, so that no frame is mistaken for another."""
    changes = {"end": (float(np.cos(0.4)), float(np.sin(0.4))), "height": 0.2, "mesh": (5, 2)}
    contact = {"surface": getattr(request, "param", "axis")}
    return build(problem(path=((2.0, 2.0), (1.0, 1.0)), contact=contact, **changes))


def bent(model, seed=0):
    """Displacements of a bent strip with some noise."""
    x = model.bodies[0].mesh.nodes
    noise = 0.004 * np.random.default_rng(seed).standard_normal(x.shape)
    angle = 1.2 * x[:, 0]
    bend = np.stack([np.sin(angle), 1 - np.cos(angle)], 1) / 1.2
    return bend + x[:, 1:] * np.stack([-np.sin(angle), np.cos(angle)], 1) + noise - x


def near(model, u, zeta, distance):
    """The point at a distance to the left of the curve at zeta."""
    pair = model.pairs[0]
    r, r1, _ = pair.curve.basis(zeta) @ pair.carrier.points(u)
    return r + distance * np.array([-r1[1], r1[0]]) / np.hypot(*r1)


def test_curve_is_twice_continuously_differentiable(model):
    curve = model.pairs[0].curve
    for station in curve.stations[1:-1]:
        before, after = curve.basis(np.nextafter(station, 0)), curve.basis(np.nextafter(station, 1))
        scale = np.array([1.0, 1 / 0.1, 1 / 0.01])[:, None]
        np.testing.assert_allclose(before / scale, after / scale, atol=1e-11)


def curve_through(stations, offsets, kernel):
    rows = eye_array(stations.size, format="csr")
    slopes = band_slopes(stations)
    return ContactCurve(stations=stations, slopes=slopes, rows=rows, offsets=offsets, kernel=kernel)


@pytest.mark.parametrize("spread", [0.0, 1e-4])
def test_curve_converges_with_fourth_order(spread):
    """Fine meshes: the end pieces of a not-a-knot spline approach order four from above (4.6, 4.4, 4.3, ...)."""

    def error(n):
        s = np.linspace(0, 1, n + 1)
        curve = curve_through(s, *averaging(spread, 1 / n))
        return max(abs((curve.basis(z) @ np.sin(3 * s))[0] - np.sin(3 * z)) for z in np.linspace(0, 1, 2001))

    assert np.log2(error(80) / error(160)) == pytest.approx(4, abs=0.4)


@pytest.mark.parametrize("m", [3, 46, 300, 700])
def test_slopes_in_windows_equal_the_slopes_of_the_whole_spline(m):
    rng = np.random.default_rng(m)
    s = np.cumsum(rng.uniform(0.5, 2, m))
    values = rng.standard_normal(m)
    band = band_slopes(s)
    half = band.shape[1] // 2
    slopes = [
        band[k, max(0, half - k) : half + m - k] @ values[max(0, k - half) : k + half + 1] for k in range(m)
    ]
    np.testing.assert_allclose(slopes, CubicSpline(s, values)(s, 1), atol=1e-13)


def test_average_leaves_cubics_and_reaches_no_further():
    offsets, kernel = averaging(0.3, 0.01)
    for power, moment in ((0, 1.0), (1, 0.0), (2, 0.0), (3, 0.0)):
        assert kernel @ offsets**power == pytest.approx(moment, abs=1e-14)
    assert np.abs(offsets).max() < 0.3
    assert [part.tolist() for part in averaging(0.0, 0.01)] == [[0.0], [1.0]]


def test_contact_is_spread_over_a_stated_length(problem):
    """By default 1.5 heights to either side, at most a tenth of the length; never beyond the given spread."""
    for height, spread, expected in ((0.02, None, 0.03), (0.2, None, 0.1), (0.02, 0.05, 0.05)):
        curve = build(problem(height=height, contact={"spread": spread})).pairs[0].curve
        assert expected * 0.95 < np.abs(curve.offsets).max() < expected


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("distance", [-0.05, 0.0, 0.03])
@pytest.mark.parametrize("zeta", PLACES)
@pytest.mark.parametrize("model", ["axis", "face"], indirect=True)
def test_gap_derivatives_by_complex_steps(model, zeta, distance, side):
    """Both derivatives, at and beside the nodes of the curve, with the pin off it and on it."""
    u = bent(model)
    pair = place_pin(model, near(model, u, zeta, distance), radius=0.01).pairs[0]
    check_derivatives(replace(pair, contact=replace(pair.contact, side=side)), u)


def check_derivatives(pair, u):
    U, H = pair.gap_derivatives(pair.project(u, 0.0))
    v = np.random.default_rng(3).standard_normal(u.shape)
    at = pair.project(u + 1j * STEP * v, 0.0)
    assert U[:, 0] @ v.ravel() == pytest.approx(pair.gap(at).imag / STEP, abs=1e-11)
    slope = pair.gap_derivatives(at)[0][:, 0].imag / STEP
    np.testing.assert_allclose(U @ (H @ (U.T @ v.ravel())), slope, rtol=0, atol=1e-9)


def two_strips(strip, surface="face"):
    """An upper strip whose end lies above a lower strip of the opposite direction."""
    upper = strip(name="upper", start=(0.0, 0.3), end=(0.8, 0.25), height=0.1, mesh=(4, 2))
    lower = strip(name="lower", start=(1.1, 0.0), end=(0.1, 0.1), height=0.1, mesh=(5, 1), clamped=("start",))
    contact = fr.Contact(node="upper.end", strip="lower", side="right", surface=surface)
    return build(fr.SolidProblem(strips=(upper, lower), contacts=(contact,)))


@surfaces
def test_gap_derivatives_of_an_end_act_on_both_strips(strip, surface):
    model = two_strips(strip, surface)
    u = 0.003 * np.random.default_rng(0).standard_normal((model.nodes, 2))
    check_derivatives(model.pairs[0], u)


def test_action_and_reaction_of_two_strips_cancel(strip):
    """Forces and, where they touch, moments of the unit contact force in the global frame."""
    model = two_strips(strip)
    pair = model.pairs[0]
    u = 0.003 * np.random.default_rng(0).standard_normal((model.nodes, 2))
    forces = pair.gap_derivatives(pair.project(u, 0.0))[0][:, 0].reshape(-1, 2)
    upper, lower = (
        forces[part].sum(axis=0) @ body.strip.frame.T
        for body, part in zip(model.bodies, model.parts, strict=True)
    )
    np.testing.assert_allclose(upper, -lower, atol=1e-13)
    assert np.hypot(*upper) == pytest.approx(1, abs=1e-13)


@pytest.mark.parametrize("axial", [1.0, np.nextafter(1.0, 2), np.nextafter(1.0, 0)])
def test_pin_within_round_off_of_the_tip_is_on_the_strip(model, axial):
    pair = place_pin(model, model.problem.strips[0].to_global(np.array([axial, 0.0]))).pairs[0]
    at = pair.project(np.zeros((model.nodes, 2)), 0.0)
    assert at.inside
    assert pair.gap(at) == pytest.approx(0, abs=2e-16)


@pytest.mark.parametrize(("pin", "distance"), [((1.5, -0.3), np.hypot(0.5, 0.3)), ((-0.4, 0.3), 0.5)])
def test_pin_beyond_an_end_is_not_on_the_strip(model, pin, distance):
    moved = place_pin(model, model.problem.strips[0].to_global(np.array(pin)))
    at = moved.pairs[0].project(np.zeros((model.nodes, 2)), 0.0)
    assert not at.inside
    assert at.end_distance == pytest.approx(distance)


@pytest.mark.parametrize("length", [1e-18, 1e18])
def test_a_curve_of_three_stations_at_any_length(problem, length):
    """The slopes scale with the length; in raw units SciPy warns of an ill-conditioned matrix."""

    def slopes(size):
        changes = {"height": 0.02 * size, "width": 0.02 * size, "end": (size, 0.0)}
        path = ((size, 0.0), (0.5 * size, 0.5 * size))
        return build(problem(path=path, mesh=(2, 1), element="Q1", **changes)).pairs[0].curve.slopes

    np.testing.assert_allclose(slopes(length) * length, slopes(1.0), atol=1e-12)


@pytest.mark.parametrize("point", [(0.521, 0.105), (0.480, 0.104), (0.522, 0.107), (0.478, 0.107)])
def test_a_point_beside_the_centre_of_curvature_has_its_nearest_foot(point):
    """Newton's slope nearly vanishes at the start, so that a full Newton step would miss the closest point."""
    s = np.linspace(0, 1, 6)
    curve = curve_through(s, np.zeros(1), np.ones(1))
    X = np.stack([s, 0.15 * np.cos(2 * np.pi * s)], axis=1)
    zeta, stationary = closest(CurveFrom(curve=curve, points=X - np.array(point)))
    places = np.linspace(0, 1, 4001)
    distances = [np.hypot(*(curve.basis(z)[0] @ X - point)) for z in places]
    assert stationary
    assert zeta == pytest.approx(places[np.argmin(distances)], abs=2.5e-4)


def test_the_gap_of_a_pin_beyond_the_end_is_that_of_its_surface():
    """A pin passes .2 behind the end of a strip that stays at rest."""
    result = fr.solve(make_problem(path=((1.2, -0.2), (1.2, -0.1)), radius=0.03, mesh=(10, 1)), loads(2))
    assert result.contacts[PAIR].gap == pytest.approx(np.hypot(0.2, [0.15, 0.1]) - 0.03, abs=1e-12)


def test_radius_moves_the_gap_by_itself(model):
    u = bent(model)
    point = near(model, u, 0.6, -0.05)
    sharp, round_ = (place_pin(model, point, radius=radius).pairs[0] for radius in (0.0, 0.02))
    assert sharp.gap(sharp.project(u, 0.0)) - round_.gap(round_.project(u, 0.0)) == pytest.approx(0.02)

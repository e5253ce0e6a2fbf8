import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from fem_reference.contact import Curve, gap_derivatives, project
from fem_reference.model import build

STEP = 1e-30
surfaces = pytest.mark.parametrize("surface", ["axis", "face"])
# Inside an element, at a corner and a midside node, one unit of round-off beside it, near both ends.
PLACES = [0.33, 0.4, 0.5, np.nextafter(0.4, 1), np.nextafter(0.4, 0), 0.02, 0.97]


@pytest.fixture
def model(request, problem):
    return build(problem(height=0.2, mesh=(5, 2), surface=getattr(request, "param", "axis")))


def bent(model, seed=0):
    """Nodes of a bent strip with some noise."""
    x = model.mesh.nodes
    noise = 0.004 * np.random.default_rng(seed).standard_normal(x.shape)
    angle = 1.2 * x[:, 0]
    return (
        np.stack(
            [
                np.sin(angle) / 1.2 - x[:, 1] * np.sin(angle),
                (1 - np.cos(angle)) / 1.2 + x[:, 1] * np.cos(angle),
            ],
            1,
        )
        + noise
    )


def pin_near(curve, x, zeta, distance):
    r, r1, _ = curve.basis(zeta) @ curve.points(x)
    return r + distance * np.array([-r1[1], r1[0]]) / np.hypot(*r1)


@surfaces
def test_curve_interpolates_sections_and_straight_lines(problem, surface):
    model = build(problem(mesh=(6, 2), surface=surface))
    X = model.curve.points(model.mesh.nodes)
    height = 0.0 if surface == "axis" else -0.01
    for zeta in (0.0, 0.123, 0.5, 0.987, 1.0, 1.01):
        r, r1, r2 = model.curve.basis(zeta) @ X
        np.testing.assert_allclose(r, [zeta, height], atol=1e-14)
        np.testing.assert_allclose(r1, [1, 0], atol=1e-12)
        np.testing.assert_allclose(r2, 0, atol=1e-9)


def test_face_is_the_one_on_the_pins_side(problem):
    left = build(problem(side="left", surface="face", path=((0.5, 0.01), (0.5, 0.0))))
    assert left.curve.points(left.mesh.nodes)[:, 1] == pytest.approx(0.01)


def test_curve_is_twice_continuously_differentiable(model):
    s = model.curve.stations
    for k in range(1, s.size - 1):
        before, after = model.curve.basis(np.nextafter(s[k], 0)), model.curve.basis(np.nextafter(s[k], 1))
        scale = np.array([1.0, 1 / 0.1, 1 / 0.01])[:, None]
        np.testing.assert_allclose(before / scale, after / scale, atol=1e-11)


def test_curve_derivatives_by_complex_steps(model):
    for zeta in PLACES:
        B, step = model.curve.basis(zeta), model.curve.basis(zeta + 1j * STEP).imag / STEP
        np.testing.assert_allclose(B[1], step[0], atol=1e-12)
        np.testing.assert_allclose(B[2], step[1], atol=1e-10)


def test_curve_converges_with_fourth_order():
    """Fine meshes: the end pieces of a not-a-knot spline approach order four from above (4.6, 4.4, 4.3, ...)."""

    def error(n):
        s = np.linspace(0, 1, n + 1)
        slopes = CubicSpline(s, np.eye(n + 1))(s, 1)
        curve = Curve(stations=s, slopes=slopes, nodes=np.arange(n + 1)[:, None], weights=np.ones(1))
        return max(abs((curve.basis(z) @ np.sin(3 * s))[0] - np.sin(3 * z)) for z in np.linspace(0, 1, 2001))

    assert np.log2(error(80) / error(160)) == pytest.approx(4, abs=0.4)


@pytest.mark.parametrize("zeta", PLACES)
@pytest.mark.parametrize("distance", [-0.05, 0.0, 0.03])
def test_projection_finds_the_foot_of_the_normal(model, zeta, distance):
    x = bent(model)
    at = project(model.curve, x, pin_near(model.curve, x, zeta, distance), -1.0)
    assert at.stationary
    assert at.inside
    assert at.zeta == pytest.approx(zeta, abs=1e-13)
    assert at.gap == pytest.approx(-distance, abs=1e-14)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("distance", [-0.05, 0.0, 0.03])
@pytest.mark.parametrize("zeta", PLACES)
@pytest.mark.parametrize("model", ["axis", "face"], indirect=True)
def test_gap_derivatives_by_complex_steps(model, zeta, distance, side):
    """Both derivatives, at and beside the nodes of the curve, with the pin off it and on it."""
    x = bent(model)
    n = len(x)
    pin = pin_near(model.curve, x, zeta, distance)
    U, H = gap_derivatives(model.curve, project(model.curve, x, pin, side), n, side)
    v = np.random.default_rng(3).standard_normal(x.shape)
    at = project(model.curve, x + 1j * STEP * v, pin, side)
    assert U[:, 0] @ v.ravel() == pytest.approx(at.gap.imag / STEP, abs=1e-11)
    slope = gap_derivatives(model.curve, at, n, side)[0][:, 0].imag / STEP
    np.testing.assert_allclose(U @ (H @ (U.T @ v.ravel())), slope, rtol=0, atol=1e-9)


def test_penalty_energy_has_the_reduced_force_and_tangent(model):
    """``eps (W^T W - c c^T / h)`` of the penalty alone is ``eps (g' g'^T + g g'')``."""
    x = bent(model)
    at = project(model.curve, x, pin_near(model.curve, x, 0.37, 0.02), -1.0)
    U, H = gap_derivatives(model.curve, at, len(x), -1.0)
    tangent = np.outer(U[:, 0], U[:, 0]) + at.gap * U @ H @ U.T
    r, r1, r2 = at.basis @ model.curve.points(x)
    d = r - pin_near(model.curve, x, 0.37, 0.02)
    W, W1 = (np.zeros((2, x.size)) for _ in range(2))
    for row, target in ((0, W), (1, W1)):
        field = np.zeros(len(x))
        field[model.curve.nodes] = at.basis[row][:, None] * model.curve.weights
        target[0, ::2] = target[1, 1::2] = field
    c = W.T @ r1 + W1.T @ d
    np.testing.assert_allclose(tangent, W.T @ W - np.outer(c, c) / (r1 @ r1 + d @ r2), rtol=0, atol=1e-12)
    np.testing.assert_allclose(at.gap * U[:, 0], W.T @ d, rtol=0, atol=1e-14)


@pytest.mark.parametrize("x", [1.0, np.nextafter(1.0, 2), np.nextafter(1.0, 0)])
def test_pin_within_round_off_of_the_tip_is_on_the_strip(model, x):
    at = project(model.curve, model.mesh.nodes, np.array([x, 0.0]), -1.0)
    assert at.inside
    assert at.gap == pytest.approx(0, abs=1e-16)


@pytest.mark.parametrize(("pin", "distance"), [((1.5, -0.3), np.hypot(0.5, 0.3)), ((-0.4, 0.3), 0.5)])
def test_pin_beyond_an_end_is_not_on_the_strip(model, pin, distance):
    at = project(model.curve, model.mesh.nodes, np.array(pin), -1.0)
    assert not at.inside
    assert at.end_distance == pytest.approx(distance)


def test_contact_slopes_balance(model):
    """The contact's nodal forces sum to the unit force on the strip."""
    at = project(model.curve, bent(model), np.array([0.5, 0.2]), -1.0)
    U, _ = gap_derivatives(model.curve, at, len(model.mesh.nodes), -1.0)
    np.testing.assert_allclose(U[:, 0].reshape(-1, 2).sum(axis=0), at.normal, atol=1e-13)

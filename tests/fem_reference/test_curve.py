"""The contact curve: a smooth spline through a strip's sections, and the closest point on it."""

import numpy as np
import pytest

# Orders and derivatives of the curve: answers hold it to about 1e-4 only.
from fem_reference.contact.curve import ContactCurve, averaging, cardinal_slopes, closest


def curve_through(stations, offsets=(0.0,), kernel=(1.0,)):
    slopes = cardinal_slopes(stations)
    kernel, offsets = np.array(kernel), np.array(offsets)
    values = {"slopes": slopes, "transposed": slopes.T, "offsets": offsets, "kernel": kernel}
    return ContactCurve(stations=stations, **values)


def test_curve_is_twice_continuously_differentiable():
    curve = curve_through(np.linspace(0, 1, 11), *averaging(0.1, 0.1))
    scale = np.array([1.0, 1 / 0.1, 1 / 0.01])[:, None]
    splines = np.eye(11), curve.slopes.toarray()
    for station in curve.stations[1:-1]:
        before, after = (curve.at(np.nextafter(station, side), *splines) for side in (0, 1))
        np.testing.assert_allclose(curve.basis(station), curve.at(station, *splines)[:2], rtol=0, atol=1e-12)
        np.testing.assert_allclose(before / scale, after / scale, rtol=0, atol=1e-11)


def test_average_leaves_cubics_and_reaches_no_further():
    offsets, kernel = averaging(0.3, 0.01)
    for power, moment in ((0, 1.0), (1, 0.0), (2, 0.0), (3, 0.0)):
        assert kernel @ offsets**power == pytest.approx(moment, abs=1e-14)
    assert np.abs(offsets).max() < 0.3
    assert [part.tolist() for part in averaging(0.0, 0.01)] == [[0.0], [1.0]]


@pytest.mark.parametrize("point", [(0.521, 0.105), (0.478, 0.107)])
def test_a_point_beside_the_centre_of_curvature_has_its_nearest_foot(point):
    """Newton's slope nearly vanishes at the start, so that a full Newton step would miss the closest point."""
    s = np.linspace(0, 1, 6)
    curve = curve_through(s)
    X = np.stack([s, 0.15 * np.cos(2 * np.pi * s)], axis=1)
    zeta, stationary, _ = closest(curve, X - point, curve.slopes @ (X - point))
    places = np.linspace(0, 1, 4001)
    distances = [np.hypot(*(curve.basis(z)[0] @ X - point)) for z in places]
    assert stationary
    assert zeta == pytest.approx(places[np.argmin(distances)], abs=2.5e-4)

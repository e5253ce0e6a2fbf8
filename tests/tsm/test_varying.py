"""Loads along a beam, natural curvature and taper: index, falls, meshes, and numbers known in closed form."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import jn_zeros, jv

import tsm
from tests.tsm.structures import CLAMP, beam, cantilever, hook, raised


@pytest.mark.parametrize(("element", "elements", "apart"), [("exact", 1, 1e-6), ("mixed", 8, 1e-4)])
def test_heavy_column_gains_a_negative_eigenvalue_at_every_critical_weight(element, elements, apart):
    """Greenhill 1881: ``q L^3/EI = 9/4 z^2`` with the zeros z of the Bessel function of order -1/3; the first is 7.8373."""
    # zeros of J_(-1/3) lie just below those of J_0
    zeros = [brentq(lambda z: jv(-1 / 3, z), bound - 1.0, bound, xtol=1e-15) for bound in jn_zeros(0, 3)]
    assert 9 / 4 * zeros[0] ** 2 == pytest.approx(7.837347, abs=1e-6)
    section = tsm.Section(EA=1e9, GA=1e9, EI=1.0)
    rod = beam("b", (0, 0), (0, 1), section=section, elements=elements, element=element)
    for number, zero in enumerate(zeros):
        for factor, expected in ((1 - apart, number), (1 + apart, number + 1)):
            load = tsm.LineLoad(beam="b", force=((0.0, -9 / 4 * zero**2 * factor),))
            column = tsm.Structure(beams=(rod,), supports=(CLAMP,), line_loads=(load,))
            assert tsm.solve(column, [1.0], tsm.Settings(branch="primary")).index.tolist() == [expected]


@pytest.mark.parametrize(("part", "end"), [(0.5, (-0.2, 0.8)), (0.97, (-0.2, 0.5))])
def test_a_pin_that_is_led_behind_the_clamp_meets_a_limit_point(part, end):
    """The index changes where the path turns back, and not before, which would be a bifurcation."""
    pin = tsm.Pin(name="p", path=(hook().beams[0].point(part), end))
    structure = hook(pins=(pin,), contacts=(tsm.ContactPair(node="p", beam="b"),))
    assert tsm.solve(structure, [1.0], throw=False).status is tsm.Status.LIMIT_POINT


@pytest.mark.slow
def test_what_a_snap_releases_counts_the_work_of_loads_along_a_beam():
    """A bar pushed down through its support by a free mast: the load on the mast does the same work as one on the bar."""
    section, load, high = tsm.Section(EA=100.0, GA=40.0, EI=30.0), 5.0, 0.4
    whole = math.hypot(1.0, high)

    def force(y):
        return section.EA * (1.0 / math.hypot(1.0, y) - 1.0 / whole) * y

    def potential(y):
        return section.EA / (2 * whole) * (math.hypot(1.0, y) - whole) ** 2 + limit * (y - high)

    fold = math.sqrt(whole ** (2 / 3) - 1)
    limit = force(fold)
    rest = brentq(lambda y: force(y) - limit, -3.0, -high, xtol=1e-14)
    structure = tsm.Structure(
        beams=(
            beam("bar", (0, 0), (1, high), section=section),
            beam("mast", (1, high), (1, 1 + high), section=section),
        ),
        supports=(
            tsm.Support(beam="bar", end="start", rotation=None),
            tsm.Support(beam="mast", end="start", uy=None),
        ),
        hinges=(tsm.Hinge(beam="bar", end="end"),),
        line_loads=(tsm.LineLoad(beam="mast", force=((0.0, -load),)),),
    )
    (snap,) = tsm.solve(structure, [0.5, 1.0], tsm.Settings(branch="stable")).events
    assert snap.load_parameter * load == pytest.approx(limit, rel=1e-8)
    # the fall begins a little beyond the limit
    assert snap.released == pytest.approx(potential(fold) - potential(rest), rel=1e-3)


@pytest.mark.slow
def test_too_coarse_a_mesh_for_a_boundary_layer_is_told():
    """Tension along the clamp's normal, 40,000 EI/L^2: the layer at the clamp has the length L/200."""
    stiff, pull = tsm.Section(EA=1e9, GA=1e9, EI=1.0), tsm.Load(beam="b", end="end", force=(0.0, 4e4))
    weight = (tsm.LineLoad(beam="b", force=((0.0, 1e-3),)),)

    def status(elements, element):
        given = cantilever(section=stiff, elements=elements, element=element, load=pull)
        return tsm.solve(replace(given, line_loads=weight), [1.0], throw=False).status

    assert status(4, "mixed") is tsm.Status.INACCURATE
    assert status(150, "mixed") is status(8, "exact") is tsm.Status.COMPLETED


@pytest.mark.slow
def test_largest_span_of_a_heavy_strip_on_two_points():
    """Curtis, Griffiths and Vella: up to the half span 1/e of its half length a strip bears any weight on two points without friction.

    Beyond, the weight f has a limit, with ``a - 1/e = c f^(-1/2) + ...``: the half span is extrapolated to infinite weight.
    """
    spans, limits = [], []
    for beyond in (0.012, 0.008, 0.006, 0.004):
        span, weight = 1 / math.e + beyond, 1.1 * (1.167 / beyond) ** 2
        stiff = tsm.Section(EA=1e9 * weight, GA=1e9 * weight, EI=1.0)
        slider = (replace(CLAMP, uy=None),)
        half = cantilever(raised(span, 1e-9), section=stiff, elements=4, element="exact", supports=slider)
        weighted = replace(half, line_loads=(tsm.LineLoad(beam="b", force=((0.0, -weight),)),))
        result = tsm.solve(weighted, [1.0], throw=False)
        assert result.status is tsm.Status.LIMIT_POINT
        spans.append(span)
        limits.append(result.critical[-1].load_parameter * weight)
    least = np.polyfit(np.array(limits) ** -0.5, spans, 3)[-1]
    assert least == pytest.approx(1 / math.e, abs=1e-6)

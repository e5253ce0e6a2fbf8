"""Loads along a beam, natural curvature and taper in exact elements: derivatives, index, and numbers known in closed form."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import jn_zeros, jv

import tsm
from tests.tsm.structures import THICK, THIN, hook, leaning, pushed


def heavy_column(weight, elements, *, tapered=False, element="exact"):
    """A clamped column under its weight, nearly without stretch."""
    section = tsm.Section(EA=1e9, GA=1e9, EI=1.0)
    thin = tsm.Section(EA=0.5e9, GA=0.5e9, EI=1 / 8)
    return tsm.Structure(
        beams=(
            tsm.Beam(
                name="b", start=(0, 0), end=(0, 1), section=section, elements=elements, element=element,
                end_section=thin if tapered else None,
            ),
        ),
        supports=(tsm.Support(beam="b", end="start"),),
        line_loads=(tsm.LineLoad(beam="b", force=((0.0, -weight),)),),
    )  # fmt: skip


def index(column):
    """Index of the straight column, past the weights at which it may bend."""
    return int(tsm.solve(column, [1.0], tsm.Settings(branch="primary")).index[0])


@pytest.mark.parametrize(
    ("element", "elements", "apart"), [("exact", 1, 1e-6), ("exact", 3, 1e-6), ("mixed", 8, 1e-4)]
)
def test_heavy_column_gains_a_negative_eigenvalue_at_every_critical_weight(element, elements, apart):
    """Greenhill 1881: ``q L^3/EI = 9/4 z^2`` with the zeros z of the Bessel function of order -1/3; the first is 7.8373."""
    # zeros of J_(-1/3) lie just below those of J_0
    zeros = []
    for bound in jn_zeros(0, 3):
        low, high = bound - 1.0, bound
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if jv(-1 / 3, low) * jv(-1 / 3, middle) > 0 else (low, middle)
        zeros.append(low)
    assert 9 / 4 * zeros[0] ** 2 == pytest.approx(7.837347, abs=1e-6)
    for number, zero in enumerate(zeros):
        for factor, expected in ((1 - apart, number), (1 + apart, number + 1)):
            column = heavy_column(9 / 4 * zero**2 * factor, elements, element=element)
            assert index(column) == expected


def test_index_of_a_tapered_column_does_not_depend_on_the_elements():
    """Unstable columns under their weight, up to 30 times the first critical one."""
    for weight in (2.0, 10.0, 60.0, 240.0):
        assert len({index(heavy_column(weight, n, tapered=True)) for n in (1, 2, 5)}) == 1


def test_work_of_loads_along_the_beam_is_the_strain_energy():
    gauss, weight = np.polynomial.legendre.leggauss(16)
    t = np.append((gauss + 1) / 2, 1.0)
    result = tsm.solve(hook(), t)
    (group,) = result.model.groups
    full = np.array([group.load_work(e.state) / e.state.load_parameter for e in result.equilibria])
    assert result.strain_energy[-1] == pytest.approx(full[-1] - weight @ full[:-1] / 2, rel=1e-11)


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
            tsm.Beam(name="bar", start=(0, 0), end=(1, high), element="exact", section=section, elements=1),
            tsm.Beam(
                name="mast", start=(1, high), end=(1, 1 + high), element="exact", section=section, elements=1
            ),
        ),
        supports=(
            tsm.Support(beam="bar", end="start", rotation=None),
            tsm.Support(beam="mast", end="start", uy=None),
        ),
        hinges=(tsm.Hinge(beam="bar", end="end"),),
        line_loads=(tsm.LineLoad(beam="mast", force=((0.0, -load),)),),
    )
    (snap,) = tsm.solve(structure, np.linspace(0.1, 1, 5), tsm.Settings(branch="stable")).events
    assert snap.load_parameter * load == pytest.approx(limit, rel=1e-8)
    # the fall begins a little beyond the limit
    assert snap.released == pytest.approx(potential(fold) - potential(rest), rel=1e-3)


@pytest.mark.slow
def test_work_goes_into_strain_and_friction():
    result = tsm.solve(pushed(offset=0.03, radius=0.01, friction=0.3), np.linspace(0, 1, 5)[1:])
    spent = sum(history.friction.dissipated for history in result.contacts.values())
    assert spent[-1] > 1e-3
    assert np.abs(result.work - result.strain_energy - spent).max() <= 1e-7 * result.work[-1]


def test_elements_that_cannot_state_it_refuse_by_name():
    curved = replace(hook(element="timoshenko"), line_loads=())
    laden = replace(heavy_column(1, 1), beams=(replace(heavy_column(1, 1).beams[0], element="timoshenko"),))
    for structure in (curved, laden):
        with pytest.raises(
            ValueError, match="such elements are straight and uniform, without loads along them; use mixed"
        ):
            tsm.solve(structure, [1.0])
    both = replace(leaning(), beams=(replace(leaning().beams[0], element="mixed"), leaning().beams[1]))
    with pytest.raises(
        ValueError, match=r'Beam\(low\).element = .mixed.: must be "exact" as of other beams here'
    ):
        tsm.solve(both, [1.0])


def test_straight_mixed_beams_stand_beside_varying_ones():
    """A tip of straight elements in closed form on a curved and tapered beam."""
    loads = leaning().line_loads[:1]
    push = tsm.Load(beam="up", end="end", force=(0.0, -1.0))
    found = []
    for element, elements in (("mixed", 16), ("exact", 1)):
        beams = tuple(replace(beam, element=element, elements=elements, nodes=()) for beam in leaning().beams)
        result = tsm.solve(replace(leaning(), beams=beams, line_loads=loads, loads=(push,)), [0.5, 1.0])
        history = result.contacts["up.end->low"]
        found.append([*history.force, *history.arc_position, *result.shape("low", -1)[-1]])
        assert result.index.tolist() == [0, 0]
        assert (result.deformation is None) == (element == "exact")
    assert np.abs(np.subtract(*found)).max() <= 2e-6


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"turn": 2 * math.pi}, "must lie between -2 pi and 2 pi"),
        ({"end_section": tsm.Section(EA=1.0, GA=1.0, EI=1.0)}, "must have the GA/EA of section"),
    ],
)
def test_beams_that_are_refused(change, said):
    with pytest.raises(ValueError, match=said):
        replace(hook().beams[0], **change)


@pytest.mark.parametrize(
    ("load", "said"),
    [
        ({"start": 0.2}, "must be a node of the beam"),
        ({"end": 2.0}, "must be at most the length"),
        ({"start": 0.8, "end": 0.3}, "must lie between 0 and end"),
        ({"force": ()}, "must hold pairs of finite numbers"),
    ],
)
def test_loads_that_are_refused(load, said):
    with pytest.raises(ValueError, match=said):
        hook(line_loads=(tsm.LineLoad(**{"beam": "b", "force": ((0.0, -1.0),), **load}),))


def test_faces_that_are_refused():
    pair = {"node": "p", "beam": "b", "offset": 0.04, "end_offset": 0.02}
    with pytest.raises(ValueError, match="must be 0 on a surface with an end_offset"):
        tsm.ContactPair(**pair, friction=0.3)
    with pytest.raises(ValueError, match="must differ from offset by less than the length"):
        pushed(offset=0.04, end_offset=2.0)
    straight = replace(pushed(offset=0.04, end_offset=0.02), line_loads=())
    mixed = replace(straight.beams[0], turn=0.0, end_section=None, element="mixed")
    with pytest.raises(ValueError, match="belongs to a beam that tapers or has elements"):
        tsm.solve(replace(straight, beams=(mixed,)), [1.0])


def test_point_force_inside_a_beam():
    """Half of a beam under a force in its middle is a beam under a force at its end."""
    whole = tsm.solve(hook(line_loads=(), loads=(tsm.Load(beam="b", arc=0.3, force=(0.0, 3.0)),)), [1.0])
    beam = hook().beams[0]
    part = 0.3 / beam.length
    ratio = (THIN.EI / THICK.EI * THICK.EA / THIN.EA) ** 0.5
    high, wide = 1 - part * (1 - ratio), 1 - part * (1 - THIN.EA / THICK.EA / ratio)
    cut = tsm.Section(EA=THICK.EA * high * wide, GA=THICK.GA * high * wide, EI=THICK.EI * high**3 * wide)
    half = replace(beam, end=beam.point(part), turn=part * beam.turn, end_section=cut, elements=1, nodes=())
    load = tsm.Load(beam="b", end="end", force=(0.0, 3.0))
    alone = tsm.solve(replace(hook(line_loads=()), beams=(half,), loads=(load,)), [1.0])
    assert np.abs(whole.shape("b", 0)[1] - alone.shape("b", 0)[1]).max() <= 1e-13
    with pytest.raises(ValueError, match="must be a node, see Beam"):
        hook(loads=(tsm.Load(beam="b", arc=0.4),))

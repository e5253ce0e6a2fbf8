"""[P] 4.1 and what a node that slides along a beam must not notice: beam nodes, steps, the frame it is seen from."""

from __future__ import annotations

import numpy as np
import pytest

import tsm
from comparisons.models.translate import to_structure
from comparisons.scene import load_scene, read_scene
from tests.verification.structures import (
    KS,
    KS_PATH,
    PINS,
    SECTIONS,
    cantilever,
    essentials,
    forces,
    moved,
    oracle,
    places,
    raised,
    slip_offs,
    square,
    steps,
)

SLIP_OFF = (1.7814439389, 1.6861593947, 1.4716026278, 1.2107350431, 1.0524732309, 0.8625478871)
SECTION, LENGTH = SECTIONS["4.1"]


def mixed(path, *, section="4.1", elements=18):
    """Cantilever of `mixed` elements with a section of [P] under one pin."""
    stiffness, length = SECTIONS[section]
    return cantilever(tuple(path), section=stiffness, length=length, elements=elements, element="mixed")


def slip_off(x, elements):
    return 2.0 * slip_offs(tsm.solve(mixed(raised(x, 2.0), elements=elements), steps(20)))[0]


@pytest.mark.parametrize(("x", "exact"), list(zip(PINS, SLIP_OFF, strict=True)))
def test_slip_off_displacements(x, exact, stated):
    """Within 1e-5, which is of the third power of the shear strain there, with 18 and with 72 elements."""
    error = max(abs(slip_off(x, elements) / exact - 1) for elements in (18, 72))
    assert error <= 1e-5
    stated("sliding.slip-off", error, part=True)


def test_floor_is_the_fourth_power_of_the_shear_strain():
    """Up to gamma = F/GA = 3 %, many elements differ from the rod by 5 gamma^4, where the bow alone leaves gamma^2."""
    structure = mixed(raised(4.05, 1.6), elements=72)
    exact = oracle(structure, steps(20)).magnitude[1:]
    gamma = exact / SECTION.GA
    assert gamma.max() == pytest.approx(0.03, rel=0.02)
    error = np.abs(tsm.solve(structure, steps(20)).contacts["p0->b"].force / exact - 1)
    assert (error <= 5 * gamma**4 + 1e-9).all()


@pytest.mark.slow
@pytest.mark.parametrize("section", SECTIONS)
def test_no_critical_area(section, stated):
    """Places around every node, ten depths each: the same tolerance everywhere, no cut-back."""
    length = SECTIONS[section][1]
    elements, count = 11, 0
    every = list(places(elements, length))
    stated(f"sliding.places-{section}", len(set().union(*every)))
    for around in every:
        for x in around:
            structure = mixed(raised(float(x), 0.02 * length), section=section, elements=elements)
            taken = list(tsm.march(structure, steps(10)))
            assert [step.requested for step in taken] == [True] * 10
            assert sum(step.cutbacks for step in taken) == 0
            assert max(step.equilibrium.residuals[-1] for step in taken) <= 1e-9
            count += len(taken)
    assert count >= 3333


@pytest.mark.slow
@pytest.mark.parametrize("x", PINS)
def test_success_map(x, stated):
    """Step counts from 10 to 500: all complete, and no answer depends on the count."""
    reference, worst = None, 0.0
    counts = np.unique(np.round(np.geomspace(1, 50, 20)).astype(int) * 10)
    for count in counts:
        result = tsm.solve(mixed(raised(x, 0.8)), steps(count))
        tenths = result.contacts["p0->b"].force[count // 10 - 1 :: count // 10]
        reference = tenths if reference is None else reference
        worst = max(worst, np.abs(tenths / reference - 1).max())
    assert worst <= 1e-8
    stated("sliding.step-counts", len(counts))
    stated("sliding.success-map", worst, part=True)


@pytest.mark.slow
def test_a_thousand_cycles_leave_nothing_behind(stated):
    """Touch, push .05 and release, again and again: the same force and the same straight beam to 1e-10."""
    cycles = 1000
    path = [(4.1, -0.05)]
    for _ in range(cycles):
        path += [(4.1, 0.05), (4.1, -0.05)]
    result = tsm.solve(mixed(path), steps(2 * cycles))
    force = result.contacts["p0->b"].force
    drift = np.abs(force[0::2] / force[0] - 1).max()
    assert drift <= 1e-10
    stated("sliding.cycles", drift, bound=True)
    assert (force[1::2] == 0).all()
    assert np.abs(result.tips["b"][1::2] - [LENGTH, 0.0]).max() <= 1e-10 * LENGTH
    kinds = [kind for kind, _ in essentials(result)]
    assert kinds == [tsm.EventKind.TOUCH, tsm.EventKind.RELEASE] * cycles


SCENES = {
    "ks-cantilever": [0.5, 1.0],
    "ks-face": [0.5, 1.0],
    "ks-printed-shear": [0.5, 1.0],
    "ks-tied-tip": [0.05, 0.1],
    "cantilever-critical-area": [0.3, 0.6],
    "double-beam": [0.1, 0.5],
}


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("name", SCENES)
def test_objectivity(name, stated):
    """1,000 rigid motions of a scene change no force and no moment by more than 1e-10 of the largest.

    The angles are evenly spread over the circle, a draw in each of 1,000 parts, so that none is far from a quarter turn or the other end.
    """
    rng = np.random.default_rng(7)
    count = 1000
    structure, t = to_structure(load_scene(name), elements=10), np.array(SCENES[name])
    plain = forces(tsm.solve(structure, t))
    length = structure.beams[0].length
    worst = 0.0
    for angle in -np.pi + 2.0 * np.pi * (np.arange(count) + rng.uniform(size=count)) / count:
        other = moved(structure, float(angle), rng.normal(size=2) * length)
        found = forces(tsm.solve(other, t))
        worst = max(worst, float(np.abs(found - plain).max() / np.abs(plain).max()))
    assert worst <= 1e-10
    stated("sliding.rigid-motion", worst, part=True)


@pytest.mark.slow_at("0.00303014214-path0")
@pytest.mark.parametrize(
    ("height", "path"),
    [
        (0.00303014214, ((0.9773519805, 0.0), (-0.3390120922, 0.7057013676))),
        (0.0854887241, ((0.7927555626, 0.0), (-0.08104586997, 0.6300149440))),
        (0.01212944359, ((0.5395708677, 0.0), (0.06041369545, 0.9213513552))),
    ],
)
def test_a_beam_that_is_let_go_far_over_falls_to_rest(height, path, stated):
    """At the slip-off no dead load in place of the contact has an equilibrium nearby; exact elements jump to the same energy."""
    given = {"section": square(height)}
    mixed, exact = (
        tsm.solve(structure, steps(50))
        for structure in (cantilever(path, elements=10, element="mixed", **given), cantilever(path, **given))
    )
    slips = [next(e for e in r.events if e.kind is tsm.EventKind.SLIP_OFF) for r in (mixed, exact)]
    assert slips[0].load_parameter == pytest.approx(slips[1].load_parameter, abs=1e-5)
    error = abs(slips[0].released / slips[1].released - 1)
    assert error <= 1e-5
    stated("sliding.released", error, part=True)
    assert mixed.strain_energy[-1] <= 1e-12 * slips[0].released


def error_on_ks(elements, *, shear=1.0, stretch=1.0):
    """Error of the force against the rod, and the largest shear strain."""
    section = tsm.Section(EA=stretch * KS.EA, GA=shear * KS.GA, EI=KS.EI)
    structure = cantilever(KS_PATH, section=section, elements=elements, element="mixed")
    exact = oracle(structure, steps(5)).magnitude[1:]
    force = tsm.solve(structure, steps(5)).contacts["p0->b"].force
    return np.abs(force - exact).max() / exact.max(), exact.max() / section.GA


def test_what_many_elements_leave_on_the_ks_cantilever(stated):
    error, gamma = error_on_ks(640)
    assert 0.4 * gamma**3 == pytest.approx(4.5e-10, rel=0.01)
    stated("ks.many-elements", error)


STRETCHED = """
[scene]
name = "stretched"
load_parameters = 10
[[beam]]
name = "strip"
start = [0.0, 0.0]
end = [1.0, 0.0]
youngs_modulus = 1e5
poissons_ratio = 0.3
width = 1.0
height = 0.02
clamped = ["start", "end"]
[[pin]]
name = "pin"
start = [{}, 0.0]
displacement = [0.0, 0.05]
[[contact]]
node = "pin"
beam = "strip"
side = "right"
"""


def force_on_a_stretched_strip(place, **resolution):
    structure = to_structure(read_scene(STRETCHED.format(place), "stretched.toml"), **resolution)
    return tsm.solve(structure, steps(10)).contacts["pin->strip"].force[-1]


@pytest.mark.parametrize(("place", "order", "factors"), [(0.5, 4, (10, 25)), (0.4137, 2, (0.3, 0.7))])
def test_order_between_the_nodes_of_a_stretched_strip(place, order, factors):
    """Fourth order where the pin is at a node, second order between nodes: the kink of a contact's own shear is not stretched with the axis."""
    exact = force_on_a_stretched_strip(place, elements=2, element="exact")
    assert exact / (1e5 * 0.02**3 / 12) == pytest.approx(50, rel=0.05)
    for n in (16, 32):
        error = abs(force_on_a_stretched_strip(place, elements=n, element="mixed") / exact - 1)
        assert factors[0] <= error * n**order <= factors[1]

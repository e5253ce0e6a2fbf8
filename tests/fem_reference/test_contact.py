"""Contacts: penetration and its cure, where a pin is on a strip, slip-off and arming, and contact along a line."""

from dataclasses import replace

import numpy as np
import pytest

import fem_reference as fr
from tests.fem_reference.strips import (
    EI,
    PAIR,
    STRIP,
    held,
    load,
    loads,
    make_problem,
    pressed,
    rotation,
    support,
    surfaces,
)


@surfaces
@pytest.mark.slow_at(
    "biot-linear-axis", "biot-linear-face", "neo-hookean-axis", "neo-hookean-face", "st-venant-kirchhoff-face"
)
@pytest.mark.parametrize("material", fr.MATERIALS)
def test_augmented_lagrangian_reaches_the_requested_penetration(surface, material, stated):
    """And the pin's work, by four Gauss points a tenth of the path, is the energy stored at its end."""
    contact, panels = {"surface": surface, "penalty": None, "penetration": 1e-10}, 10
    problem = make_problem(contact=contact, material=material)
    x, w = np.polynomial.legendre.leggauss(4)
    t = ((np.arange(panels)[:, None] + (1 + x) / 2) / panels).ravel()
    result = fr.solve(problem, np.append(t, 1.0))
    power = result.contacts[PAIR].vector[:-1] @ np.subtract(*problem.pins[0].path[::-1])
    work = np.tile(w / 2 / panels, panels) @ power
    penetration = np.abs(result.contacts[PAIR].gap).max()
    difference = abs(work / sum(fr.energy(result, -1)) - 1)
    assert penetration <= 1e-10
    assert difference <= 1e-6
    stated("solid.penetration", penetration, part=True)
    stated("solid.work", difference, part=True)


def test_work_of_the_pin_is_strain_and_contact_energy():
    """A soft penalty, which stores a fortieth of the work."""
    problem = make_problem(path=((0.8, 0.0), (0.8, 0.03)), mesh=(10, 1), contact={"penalty": 0.06})
    x, w = np.polynomial.legendre.leggauss(8)
    result = fr.solve(problem, np.append((1 + x) / 2, 1.0))
    strain, contact = fr.energy(result, -1)
    assert contact > 0.02 * strain
    assert w / 2 @ result.contacts[PAIR].vector[:-1, 1] * 0.03 == pytest.approx(strain + contact, rel=1e-9)


@pytest.mark.slow
def test_answers_scatter_little_between_meshes_and_those_of_a_sharp_contact_more(stated):
    """Relative differences of the force on any two meshes; a sharp contact has no average over three heights."""

    def scatter(**contact):
        answers = [
            fr.solve(make_problem(contact=contact, mesh=(nx, 2), material="biot-linear"), loads(20)).contacts[
                PAIR
            ]
            for nx in (40, 47, 54, 60)
        ]
        late = np.array([[answer.force[2:], answer.arc_position[2:]] for answer in answers])
        return (np.ptp(late, axis=0) / late.mean(axis=0)).max(axis=1)

    for surface in ("axis", "face"):
        assert np.all(scatter(surface=surface, penalty=None, penetration=1e-10) < 2e-4)
    sharp = scatter(surface="face", spread=0.0)[0]
    assert sharp > 4e-4
    stated("solid.sharp", float(sharp))


@pytest.mark.parametrize(("height", "spread"), [(0.02, 0.03), (0.2, 0.1)])
def test_contact_is_spread_over_a_stated_length(height, spread):
    """By default 1.5 heights to either side, at most a tenth of the length."""

    def force(value):
        scene = make_problem(
            path=((0.8, 0.0), (0.7, 0.1)), height=height, mesh=(10, 1), contact={"spread": value}
        )
        return fr.solve(scene, loads(1)).contacts[PAIR].force[-1]

    assert force(None) == force(spread)
    assert abs(force(1.2 * spread) / force(spread) - 1) > 1e-7


@pytest.mark.parametrize("x", [np.nextafter(1.0, 2), np.nextafter(1.0, 0)])
def test_pin_within_round_off_of_the_tip_is_on_the_strip(x):
    Q = rotation(0.4)
    path = tuple(tuple(map(float, Q @ point)) for point in ((x, 0.0), (x, 1e-7)))
    result = fr.solve(make_problem(path=path, end=tuple(map(float, Q[:, 0])), mesh=(10, 1)), loads(1))
    assert result.contacts[PAIR].force[-1] == pytest.approx(3e-7 * EI, rel=2e-3)


def test_the_gap_of_a_pin_beyond_an_end_is_that_of_its_surface():
    """Pins pass an end of a strip that stays at rest, one beyond its tip and one behind its clamp."""
    for x, beyond in ((1.2, 0.2), (-0.4, 0.4)):
        scene = make_problem(path=((x, -0.2), (x, -0.1)), radius=0.03, mesh=(10, 1))
        gap = fr.solve(scene, loads(2)).contacts[PAIR].gap
        assert gap == pytest.approx(np.hypot(beyond, [0.15, 0.1]) - 0.03, abs=1e-12)


def test_pin_round_the_tip_is_lost_or_passes_and_is_armed_again_on_its_side():
    """Beyond the tip to the far side, through the strip without contact, and from its own side into contact."""
    path = ((1.2, -0.1), (1.2, 0.1), (0.9, 0.1), (0.9, -0.1), (0.9, 0.05))
    kept, free = (
        fr.solve(make_problem(path=path, mesh=(10, 1), contact={"keep": keep}), loads(60), throw=False)
        for keep in (True, False)
    )
    assert kept.status is fr.Status.LOST_CONTACT
    assert kept.reached < 0.25
    contact = free.contacts[PAIR]
    assert free.status is fr.Status.COMPLETED
    y = np.array([free.model.problem.pins[0].position(t)[1] for t in free.load_parameter])
    pressing = (free.load_parameter > 0.85) & (y > 1e-9)
    assert np.all(contact.force[pressing] > 0)
    assert np.all(contact.force[~pressing] == 0)


def test_strip_that_was_left_by_its_pin_comes_to_rest_on_the_next():
    """Two pins lift a strip; the outer one passes its tip, and the inner one, until then not touching, takes over at once."""
    paths = {
        "outer": ((0.95, 0.0), (0.95, 0.5)),
        "inner": ((0.6, -0.03), (0.6, 0.14)),
        "far": ((0.4, -2.0), (0.4, -1.9)),
    }
    pins = tuple(fr.Pin(name=name, path=path) for name, path in paths.items())
    contacts = tuple(fr.Contact(node=name, strip=STRIP, keep=False) for name in paths)
    strip = held(support(), mesh=(16, 1))
    result = fr.solve(replace(strip, pins=pins, contacts=contacts), loads(10))
    outer, inner, far = (result.contacts[f"{name}->{STRIP}"] for name in paths)
    assert 0.3 < outer.slip_off < 0.9
    after = result.load_parameter > outer.slip_off
    assert np.all(outer.force[after] == 0)
    assert np.all(inner.force[after] > 0)
    assert np.all(far.force == 0)
    alone = fr.solve(replace(strip, pins=pins[1:2], contacts=contacts[1:2]), loads(10))
    np.testing.assert_allclose(inner.force[after], alone.contacts[f"inner->{STRIP}"].force[after], rtol=1e-7)


@pytest.mark.parametrize(("end", "x", "way"), [("start", -0.3, 0.2), ("end", 1.3, -0.2)])
def test_the_end_that_a_round_pin_meets_is_named(end, x, way):
    """The strip lies on springs, and both its ends are free."""
    springs = (fr.Spring(strip=STRIP, end=one, stiffness=(EI, EI, EI)) for one in ("start", "end"))
    problem = pressed(held(*springs, mesh=(10, 1)), ((x, 0.0), (x + way, 0.0)), 0.2)
    result = fr.solve(problem, loads(1), throw=False)
    assert result.message.endswith(f"pin meets the {end} of {STRIP} at load parameter 0.5")


def test_line_contact_begins_where_the_beams_curvature_reaches_the_drums():
    """``M / EI = 1 / (R + h / 2)`` under a moment, since there is no force beyond the contact; a strip of height .005 on a drum."""
    begins = EI / 64 / 0.5025
    bent = held(
        load(moment=-2 * begins), clamped=("start",), height=0.005, mesh=(40, 1), material="biot-linear"
    )
    path = ((0.3, -0.5025), (0.3, -0.5025 + 1e-9))
    result = fr.solve(pressed(bent, path, 0.5, surface="face"), loads(1), throw=False)
    assert result.status is fr.Status.LINE_CONTACT
    assert f"({PAIR}), at load parameter" in result.message
    assert 2 * result.reached == pytest.approx(1.0, rel=2e-3)

"""Floor of the unbalanced force against the distance from a node: slopes, units, input."""

from __future__ import annotations

import numpy as np
import pytest

from comparisons.claims.paper import turned_frame
from comparisons.claims.paper.force_floor import force_floor
from tsm.elements import CLOSED_FORM, cantilever
from tsm.elements.properties import Properties

RATIOS = 10.0 ** -np.arange(1, 14)


def slope(element, end, ratios=RATIOS, **options):
    floors = [force_floor(element, float(ratio), end=end, samples=25, **options) for ratio in ratios]
    return np.polyfit(np.log10(ratios), np.log10(floors), 1)[0]


@pytest.mark.parametrize("end", ["start", "end"])
@pytest.mark.parametrize(
    ("element", "expected", "within"),
    [
        ("euler-bernoulli-simple", -3, 0.3),
        ("euler-bernoulli-cantilever", -3, 0.3),
        (turned_frame.NAME, -3, 0.3),
        ("timoshenko", -1, 0.2),
        ("mixed", 0, 0.1),
        ("mixed-no-bow", 0, 0.1),
    ],
)
def test_slope(element, expected, within, end):
    assert slope(element, end) == pytest.approx(expected, abs=within)


def test_timoshenko_is_euler_bernoulli_until_the_distance_falls_below_the_shear_length():
    """``sqrt(Psi)`` = 1e-3 of the element: the same cubic floor above, a linear one below."""
    above = [
        force_floor(name, 1e-2, Psi=1e-6, samples=200) for name in ("timoshenko", "euler-bernoulli-simple")
    ]
    assert above[0] == pytest.approx(above[1], rel=0.25)
    assert slope("timoshenko", "start", 10.0 ** -np.arange(4, 13), Psi=1e-6) == pytest.approx(-1, abs=0.2)


@pytest.mark.slow
def test_cantilever_form_has_the_floor_of_the_simple_one():
    """The last bit of the coordinates times one and the same K_cc: no smaller critical area from the form."""
    for end in ("start", "end"):
        for ratio in RATIOS:
            simple, cantilever = (
                force_floor(f"euler-bernoulli-{form}", float(ratio), end=end, samples=50)
                for form in ("simple", "cantilever")
            )
            assert cantilever == pytest.approx(simple, rel=0.25)


def turned_state():
    """An element turned by 1.3 rad and bent by a tenth, and a node that presses it."""
    p = Properties(0.6, 0.8, 1.0, 100.0, 1.0, 0.0)
    rng = np.random.default_rng(3)
    c, s = np.cos(1.3), np.sin(1.3)
    end = np.array([c * 0.6 - s * 0.8 - 0.6, s * 0.6 + c * 0.8 - 0.8])
    x = np.array([0.0, 0.0, 1.3, *end, 1.3]) + 0.1 * rng.normal(size=6)
    t, n = turned_frame.frame(p, x)
    return p, x, x[:2] + 0.3 * t + 0.05 * n


def test_forces_of_the_turned_frame_are_the_gradient_of_its_energy():
    """By complex steps, at a constant a; the slide changes a, and no force comes of that."""
    p, x, node = turned_state()
    t, _ = turned_frame.frame(p, x)
    xi = t @ (node - x[:2]) / p.l0

    def energy(z):
        _, n = turned_frame.frame(p, z)
        d = np.array([p.dx0, p.dy0]) + z[3:5] - z[:2]
        v = np.array([n @ d, n @ (z[6:] - z[:2]), z[5] - z[2]])
        return (
            v @ cantilever.euler_bernoulli(p, xi)[0] @ v / 2 + p.EA / p.l0 * (np.sqrt(d @ d) - p.l0) ** 2 / 2
        )

    z = np.concatenate([x, node])
    gradient = [energy(z + 1e-30j * unit).imag / 1e-30 for unit in np.eye(8)]
    force, _ = turned_frame.contact(p, x, x[:2] - node)
    assert force == pytest.approx(gradient, abs=1e-12 * np.abs(force).max())


def test_forces_of_the_turned_frame_balance():
    """A rigid motion changes nothing, so forces and moments sum to zero, the slide's work left out."""
    p, x, node = turned_state()
    force, _ = turned_frame.contact(p, x, x[:2] - node)
    total = force[:2] + force[3:5] + force[6:]
    d, r = np.array([0.6, 0.8]) + x[3:5] - x[:2], node - x[:2]
    moment = force[2] + force[5] + d[0] * force[4] - d[1] * force[3] + r[0] * force[7] - r[1] * force[6]
    assert np.abs([*total, moment]).max() < 1e-12 * np.abs(force).max()


def test_the_turned_frame_is_another_element_than_the_simple_one():
    """Equal where nothing turns from the chord, apart in second order of the rotations; `tsm`'s cantilever is the simple one throughout."""
    p = Properties(1.0, 0.0, 1.0, 100.0, 1.0, 0.0)

    def forces(size):
        x, node = size * np.array([0, 0, 1.0, 0, 0, -0.7]), np.array([0.3, 0.2 * size])
        chord = [
            CLOSED_FORM[f"euler-bernoulli-{form}"].contact.response(p, x, -node, 0.3, np.zeros(2), 1.0, 0.0)[
                0
            ]
            for form in ("simple", "cantilever")
        ]
        return *chord, turned_frame.contact(p, x, -node)[0]

    apart = []
    for size in (1e-2, 1e-3):
        simple, clamped, turned = forces(size)
        assert clamped == pytest.approx(simple, abs=1e-12 * np.abs(simple).max())
        apart.append(np.abs(turned - simple).max() / np.abs(simple).max())
    assert apart[0] > 1e-4
    assert apart[0] / apart[1] == pytest.approx(10.0, rel=0.1)


def test_mixed_has_the_floor_of_mid_element_everywhere():
    middle = force_floor("mixed", 0.5)
    for end in ("start", "end"):
        for ratio in (0.0, 1e-300, 1e-16, 1e-8, 1e-2):
            assert force_floor("mixed", ratio, end=end) <= 1.5 * middle


@pytest.mark.parametrize("elements", [10, 100, 1000])
def test_the_size_is_the_contact_stiffness_times_the_last_bit_of_a_coordinate(elements):
    """``3 EI/b^3`` times ``eps L/10`` (half a last bit, root mean square, of coordinates up to L), in EI/L^2."""
    ratio = 1e-4
    expected = 3 / ratio**3 * np.finfo(float).eps * elements / 10 * elements**2
    floor = force_floor("euler-bernoulli-simple", ratio, elements=elements, samples=200)
    assert 0.5 < floor / expected < 2


def test_input_is_checked():
    for arguments, field in (
        (("spring", 0.1), "element"),
        (("mixed", 1.5), "ratio"),
        (("mixed", float("nan")), "ratio"),
    ):
        with pytest.raises(ValueError, match=field):
            force_floor(*arguments)
    with pytest.raises(ValueError, match="end"):
        force_floor("mixed", 0.1, end="middle")
    for option in ({"Psi": 0.0}, {"elements": 0}, {"samples": 0}):
        with pytest.raises(ValueError, match=next(iter(option))):
            force_floor("mixed", 0.1, **option)

"""The segments of the exact element: its collocation, its condensation and the rod that it integrates."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import tsm
from tsm.elements import rod
from tsm.elements.collocation import collocation, interpolation
from tsm.elements.rod import Flexibility, Segments

STEP = 1e-30
ORDERS = range(4, 21)


@pytest.mark.parametrize("order", [1, 2, 5, 14, 40])
def test_quadrature_is_exact_to_degree_2p_minus_1(order):
    table, degree = collocation(order), np.arange(2 * order)
    powers = table.c ** degree[:, None]
    assert powers @ table.w == pytest.approx(1 / (degree + 1), rel=1e-13)
    twice = 1 / (degree + 1) / (degree + 2)
    assert powers[:-1] @ table.ends[:, 1] == pytest.approx(twice[:-1], rel=1e-12)


@pytest.mark.parametrize("order", [2, 5, 14, 40])
def test_integrals_of_polynomials_at_the_nodes(order):
    """`once` is exact to degree p - 1, `twice` to p - 2, less half the line to the integral at the far end."""
    table, degree = collocation(order), np.arange(order)
    powers = table.c[:, None] ** degree
    assert np.abs(table.once @ powers - table.c[:, None] ** (degree + 1) / (degree + 1)).max() <= 1e-14
    second = (table.c[:, None] ** (degree + 2) - table.c[:, None] / 2) / (degree + 1) / (degree + 2)
    assert np.abs(table.twice @ powers - second)[:, :-1].max() <= 1e-14
    polynomials = np.polynomial.legendre.legvander(2 * table.c - 1, order - 1)
    assert np.abs(table.legendre @ polynomials - np.eye(order)).max() <= 1e-13


@pytest.mark.parametrize("order", [2, 5, 14, 40])
def test_integration_is_symplectic_and_greens_function_symmetric(order):
    table = collocation(order)
    once = table.w[:, None] * table.once
    assert np.abs(once + once.T - np.outer(table.w, table.w)).max() <= 1e-16
    green = table.w[:, None] * (table.twice - np.outer(table.c, table.ends[:, 1]) / 2)
    assert np.abs(green - green.T).max() <= 1e-16
    assert np.abs(table.once - np.roll(table.once, 1)).max() > 1e-3


@pytest.mark.parametrize("order", [2, 5, 14, 40])
def test_interpolation(order):
    """Exact to degree p between the stations, on them, and one last bit beside them."""
    table = collocation(order)
    near = np.concatenate([np.nextafter(table.c, 0), np.nextafter(table.c, 1), [1e-300]])
    x = np.concatenate([table.stations, np.linspace(0, 1, 33), near])
    degree = np.arange(order + 1)
    found = interpolation(order, x) @ table.stations[:, None] ** degree
    assert np.abs(found - x[:, None] ** degree).max() <= 1e-13
    assert np.array_equal(interpolation(order, table.stations), np.eye(order + 1))


def random_segments(rng, order, count):
    """Slack and stiff sections, forces of any direction, lengths of both signs, one zero; ends that nothing fits."""
    stretch, shear = 10 ** rng.uniform(-9, -0.5, (2, count, 1))
    bend = 10 ** rng.uniform(-1, 1, (count, 1))
    length = 10 ** rng.uniform(-3, 0.3, (count, 1)) * rng.choice([-1.0, 1.0], (count, 1))
    length[0] = 0.0
    force = rng.normal(size=(2, count, 1)) / bend
    waves = rng.normal(size=(count, 3)) @ collocation(order).c ** np.arange(3)[:, None]
    angle = rng.uniform(-np.pi, np.pi, (count, 1)) + waves + 0.01 * rng.normal(size=(count, order))
    at = Segments(Flexibility(stretch, shear, bend), force, length, angle)
    start, end = angle[:, :1] + 0.1 * rng.normal(size=(2, count, 1))
    return at, start, rng.normal(size=(count, 1)), end


def outputs(at, start, moment, end):
    """Residual inside (p), then miss, moment at the end and vector, of the equations before elimination."""
    of = rod.field(at)
    found = rod.arrival(at, of, start, moment, end)
    total = at.length * of.sums[:, :, 0].T
    ends = [found.end_residual[:, None], moment + total[:, :1], total[:, 1:]]
    return np.concatenate([found.inside, *ends], axis=1)


def whole_jacobian(at, start, moment, end):
    """Complex steps of all outputs by the angles inside, then by start, moment, end, force x and y, length."""
    columns = []
    for k in range(at.angle.shape[1]):
        angle = at.angle.astype(complex)
        angle[:, k] += STEP * 1j
        columns.append(outputs(at._replace(angle=angle), start, moment, end))
    for k in range(3):
        given = [start, moment, end]
        given[k] = given[k] + STEP * 1j
        columns.append(outputs(at, *given))
    for k in range(2):
        force = at.force.astype(complex)
        force[k] += STEP * 1j
        columns.append(outputs(at._replace(force=force), start, moment, end))
    columns.append(outputs(at._replace(length=at.length + STEP * 1j), start, moment, end))
    return np.stack(columns, axis=2).imag / STEP


@pytest.mark.parametrize("order", ORDERS)
def test_condensed_derivatives_are_those_of_the_whole_equations(order):
    """60 random segments of every order, 1,020 in all: every derivative by complex steps, condensed by numbers."""
    at, start, moment, end = random_segments(np.random.default_rng(order), order, 60)
    whole = whole_jacobian(at, start, moment, end)
    of = rod.field(at)
    found = rod.arrival(at, of, start, moment, end)
    right = np.concatenate([whole[:, :order, order:], found.inside[:, :, None]], axis=2)
    inner = -np.linalg.solve(whole[:, :order, :order], right)
    direct = np.pad(whole[:, order:, order:], ((0, 0), (0, 0), (0, 1)))
    transfer = whole[:, order:, :order] @ inner + direct
    condensed = rod.condense(at, of, found, moment)
    for got, expected in ((condensed.inner, inner), (condensed.transfer, transfer)):
        size = np.abs(expected).max(axis=(1, 2))
        assert (np.abs(got - expected).max(axis=(1, 2)) <= 1e-8 * size).all()


def test_a_segment_without_length_changes_nothing():
    at, start, moment, end = random_segments(np.random.default_rng(1), 7, 20)
    at = at._replace(length=np.zeros_like(at.length))
    of = rod.field(at)
    condensed = rod.condense(at, of, rod.arrival(at, of, start, moment, end), moment)
    found = outputs(at, start, moment, end)[:, 7:]
    assert np.array_equal(found, np.concatenate([start - end, moment, 0 * moment, 0 * moment], axis=1))
    identity = np.zeros((4, 5))
    identity[0, [0, 2]], identity[1, 1] = (1, -1), 1
    assert np.array_equal(condensed.transfer[:, :, :5], np.broadcast_to(identity, (20, 4, 5)))
    rates = np.concatenate([at.flexibility.bend * moment, of.sums[:, :, 0].T], axis=1)
    assert condensed.transfer[:, :, 5] == pytest.approx(rates, rel=1e-13)


def shot(order, section, length, start, moment, force):
    """Angle, moment and position on arrival, from angle and moment at the start: Newton on what `condense` gives."""
    flexibility = Flexibility(*(np.array([[1 / value]]) for value in (section.EA, section.GA, section.EI)))
    force = np.array(force)[:, None, None]
    at = Segments(flexibility, force, np.array([[length]]), np.full((1, order), start))
    start, moment, end = np.array([[start]]), np.array([[moment]]), np.array([[start]])
    for _ in range(30):
        of = rod.field(at)
        found = rod.arrival(at, of, start, moment, end)
        if max(np.abs(found.inside).max(), abs(found.end_residual[0])) < 1e-15:
            break
        condensed = rod.condense(at, of, found, moment)
        turned = -(found.end_residual[0] + condensed.transfer[0, 0, 6]) / condensed.transfer[0, 0, 2]
        at = at._replace(angle=at.angle + condensed.inner[:, :, 2] * turned + condensed.inner[:, :, 6])
        end = end + turned
    return np.concatenate([end[0], outputs(at, start, moment, end)[0, order + 1 :]])


def integrated(section, length, start, moment, force):
    """The same by an explicit method of eighth order with tight tolerances."""

    def rates(_, z):
        c, s = np.cos(z[0]), np.sin(z[0])
        N, Q = force[0] * c + force[1] * s, force[1] * c - force[0] * s
        x = (1 + N / section.EA) * c - Q / section.GA * s
        y = (1 + N / section.EA) * s + Q / section.GA * c
        return [z[1] / section.EI, force[0] * y - force[1] * x, x, y]

    return solve_ivp(rates, (0, length), [start, moment, 0, 0], method="DOP853", rtol=1e-13, atol=1e-14).y[
        :, -1
    ]


@pytest.mark.parametrize("order", [2, 3, 4, 5])
def test_order_2p_at_the_ends(order):
    """One segment of length h: the error falls with h^(2p + 1)."""
    section = tsm.Section(EA=20.0, GA=12.0, EI=1.0)
    given = 0.3, 1.1, (0.8, 1.7)
    lengths = np.array([1.0, 0.5]) * (0.6, 1.0, 1.6, 2.2)[order - 2]
    errors = [np.abs(shot(order, section, h, *given) - integrated(section, h, *given)).max() for h in lengths]
    assert errors[1] > 1e-12
    assert abs(np.log2(errors[0] / errors[1]) - (2 * order + 1)) <= 0.6


@pytest.mark.parametrize("force", [(8.0, -3.0), (-8.0, 3.0), (0.5, 30.0)])
def test_a_segment_against_an_explicit_integrator(force):
    section = tsm.Section(EA=200.0, GA=80.0, EI=1.0)
    for length in (1.0, -0.7):
        found, exact = (f(section, length, 0.3, 1.1, force) for f in (lambda *a: shot(40, *a), integrated))
        assert np.abs(found - exact).max() <= 1e-11 * np.abs(exact).max()


@pytest.mark.parametrize("order", [14, 24])
def test_half_way_elimination_is_regular_at_every_axial_force(order):
    """Straight, ``N h^2/EI = k``: with the start's angle and moment held, or both angles, the same matrix is singular somewhere."""
    table = collocation(order)
    line = np.outer(table.c, table.ends[:, 1]) / 2

    def condition(k, matrix):
        return np.linalg.cond(np.eye(order) - k * matrix)

    for k in (0.0, 1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6):
        assert condition(k, table.twice) <= 10 * (1 + k)
    assert condition(1e3, table.twice + line) > 1e3 * condition(1e3, table.twice)
    for k in (-(np.pi**2), -4 * np.pi**2):
        assert condition(k, table.twice) <= 20
        assert condition(k, table.twice - line) > 1e12


def test_half_way_determinant_of_a_straight_rod_is_positive():
    """``h theta'(0) + theta(1) - theta(0)`` over ``2 theta'(0)`` from ``theta'' = -(k/h)^2 theta``: ``(1 + sin k/k)/2``, by sympy.

    ``m' = -Q (1 + g N)`` of a rod that turns by theta under N has ``Q = -N theta``, hence ``k^2 = -N (1 + g N) h^2/EI``.
    """
    k, c, N, theta = sp.symbols("k c N theta")
    angle = sp.Function("angle")
    found = sp.dsolve(
        angle(c).diff(c, 2) + k**2 * angle(c), ics={angle(0): 0, angle(c).diff(c).subs(c, 0): 1}
    ).rhs
    half_way = (found.diff(c).subs(c, 0) + found.subs(c, 1) - found.subs(c, 0)) / 2
    assert sp.simplify(half_way.rewrite(sp.sin) - (1 + sp.sin(k) / k) / 2) == 0
    g, EI, h = sp.symbols("g EI h", positive=True)
    n = sp.Matrix([N, 0])
    along, across = sp.Matrix([sp.cos(theta), sp.sin(theta)]), sp.Matrix([-sp.sin(theta), sp.cos(theta)])
    rate = -n.dot(across) * (1 + g * n.dot(along))
    assert sp.simplify(rate.diff(theta).subs(theta, 0) * h**2 / EI - N * (1 + g * N) * h**2 / EI) == 0
    least = [np.linspace(1e-3, 60, 60000), 1j * np.linspace(1e-3, 60, 6000)]
    assert min((1 + np.sin(part) / part).real.min() / 2 for part in least) > 0.39


@pytest.mark.parametrize("k", [-100.0, -4 * np.pi**2, -(np.pi**2), 0.0, 1.0, 1e2, 1e3])
def test_straight_rod_under_axial_force_in_closed_form(k):
    """Angles inside that turn with the end, ``m_i h/EI - phi_i`` held: ``sinh(sqrt(k) c)/(sqrt(k) + sinh(sqrt(k)))``."""
    order, one = 40, np.ones((1, 1))
    flexibility = Flexibility(1e-12 * one, 1e-12 * one, one)
    at = Segments(flexibility, np.array([k, 0.0])[:, None, None], one, np.zeros((1, order)))
    of = rod.field(at)
    found = rod.arrival(at, of, 0 * one, 0 * one, 0 * one)
    root = np.sqrt(complex(k))
    c = collocation(order).c
    exact = np.sinh(root * c) / (root + np.sinh(root)) if k else c / 2
    inner = rod.condense(at, of, found, 0 * one).inner[0, :, 2]
    assert np.abs(inner - exact.real).max() <= 1e-9 * np.abs(exact).max()

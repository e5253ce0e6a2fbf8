"""The paper's matrices against sympy, entry by entry; tsm/elements/errata.md against both; the elements they make."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import sympy as sp

from tests.tsm.test_elements import random_contact

# the paper's matrices have no place in an answer
from tsm.elements import CLOSED_FORM, mixed_contact
from tsm.elements.kinds import paper
from tsm.elements.properties import Properties

ERRATA = Path(__file__).parents[3] / "tsm" / "elements" / "errata.md"

a, b, EI, Psi, x = sp.symbols("a b EI Psi x", positive=True)
l0 = a + b
SIMPLE = ["M_i-theta_i", "M_i-theta_j", "M_i-y_c", "M_j-theta_j", "M_j-y_c", "Y_c-y_c"]
CANTILEVER = ["Y_j-y_j", "Y_j-y_c", "Y_j-theta_j", "Y_c-y_c", "Y_c-theta_j", "M_j-theta_j"]
FORMULATIONS = {
    "(5)-(6)": SimpleNamespace(
        correct=paper.euler_bernoulli, printed=paper.euler_bernoulli_as_printed, shear=0, entries=SIMPLE
    ),
    "(7)-(8)": SimpleNamespace(
        correct=paper.cantilever, printed=paper.cantilever_as_printed, shear=0, entries=CANTILEVER
    ),
    "(9)-(12)": SimpleNamespace(
        correct=paper.timoshenko, printed=paper.timoshenko_as_printed, shear=Psi, entries=SIMPLE
    ),
}


def stiffness(moments, shears, forces):
    """Inverse of the flexibility from the complementary energy; both fields are pairs, left and right of the contact."""
    energy = sum(
        sp.integrate(m**2 + Psi * v**2, (x, *span))
        for m, v, span in zip(moments, shears, ((0, a), (a, l0)), strict=True)
    ) / (2 * EI)
    return sp.hessian(energy, forces).inv().applyfunc(sp.cancel)


@cache
def derived(formulation):
    """Matrix of a formulation, nothing taken from the paper but its basic system."""
    if formulation == "(7)-(8)":
        Yj, Yc, Mj = forces = sp.symbols("Y_j Y_c M_j")
        right = Mj + Yj * (l0 - x)
        K = stiffness((right + Yc * (a - x), right), (Yj + Yc, Yj), forces)
    else:
        Mi, Mj, Yc = forces = sp.symbols("M_i M_j Y_c")
        support = (Mi + Mj + Yc * a) / l0 - Yc
        left = support * x - Mi
        K = stiffness((left, left + Yc * (x - a)), (support, support + Yc), forces)
    return K.subs(Psi, FORMULATIONS[formulation].shear)


def in_symbols(function, shear):
    p = Properties(l0, 0, l0, 1, EI, 12 * shear / l0**2)
    return sp.Matrix(function(p, a / l0))


def upper(matrix):
    return [matrix[i, j] for i in range(3) for j in range(i, 3)]


def table(formulation):
    """Rows of errata.md: entry, correct, as printed, verdict."""
    section = ERRATA.read_text().split(f"## {formulation}")[1].split("\n## ")[0]
    omega = (a * b) ** 2 + 3 * Psi * (l0**2 + a * b) + 36 * Psi**2
    letters = {"a": a, "b": b, "l0": l0, "l": l0, "Psi": Psi, "Omega": omega}
    letters |= {"k_a": EI / l0, "k_b": 3 * EI / (a * b) ** 3, "k_c": EI / (l0 * omega)}
    rows = []
    for line in section.splitlines():
        if line.startswith("| `"):
            entry, correct, printed, verdict = (
                cell.strip().strip("`") for cell in line.strip("|").split("|")
            )
            rows.append((entry, sp.sympify(correct, letters), sp.sympify(printed, letters), verdict))
    return rows


def judged(correct, printed):
    ratio = sp.cancel(printed / correct)
    if ratio == 1:
        return "same"
    s = sp.Symbol("s", positive=True)
    growth = sp.cancel(ratio.subs({a: s * a, b: s * b, Psi: s * s * Psi}, simultaneous=True) / ratio)
    if growth == 1:
        return "wrong sign" if ratio.subs({a: 1, b: 2, Psi: 3}) == -1 else "wrong factor"
    if growth.free_symbols - {s} or ratio.subs({a: 1, b: 2, Psi: 3}) > 0:
        return "wrong dimension"
    return "wrong dimension, wrong sign"


@pytest.mark.parametrize("formulation", FORMULATIONS)
def test_corrected_matrix_is_the_inverse_of_the_flexibility(formulation):
    f = FORMULATIONS[formulation]
    K = in_symbols(f.correct, f.shear)
    assert (K - derived(formulation)).applyfunc(sp.cancel) == sp.zeros(3, 3)


@pytest.mark.parametrize("formulation", FORMULATIONS)
def test_errata_table_is_true(formulation):
    f = FORMULATIONS[formulation]
    rows = table(formulation)
    assert [row[0] for row in rows] == f.entries
    exact, coded = upper(derived(formulation)), in_symbols(f.printed, f.shear)
    for (entry, correct, printed, verdict), value, code in zip(rows, exact, upper(coded), strict=True):
        assert sp.cancel(correct - value) == 0, entry
        assert sp.cancel(printed - code) == 0, entry
        assert verdict == judged(value, printed), entry


def test_contact_stiffness_near_an_end():
    """Timoshenko's ``3 EI/(b (b^2 + 3 Psi))`` while b and sqrt(Psi) are small: G A_e/b far below ``sqrt(3 Psi)``, 3 EI/b^3 beyond."""
    K = in_symbols(paper.timoshenko, Psi)
    s = sp.Symbol("s", positive=True)
    near = sp.limit((K[2, 2] * s**3).subs({b: s * b, Psi: s * s * Psi}, simultaneous=True), s, 0)
    law = 3 * EI / (b * (b**2 + 3 * Psi))
    assert sp.simplify(near - law) == 0
    assert sp.limit(law * b, b, 0) == EI / Psi
    assert sp.limit(law * b**3, b, sp.oo) == 3 * EI


def test_other_sentences_of_the_errata():
    """Factorised entry; misprint of (5) from (9); no signs mend (7)."""
    corrected = in_symbols(paper.timoshenko, Psi)
    omega = (a * b) ** 2 + 3 * Psi * (l0**2 + a * b) + 36 * Psi**2
    assert sp.cancel(corrected[0, 1] + EI * (a**2 - 6 * Psi) * (b**2 - 6 * Psi) / (l0 * omega)) == 0
    without_shear = in_symbols(paper.timoshenko_as_printed, 0)
    simple = in_symbols(paper.euler_bernoulli_as_printed, 0)
    assert (without_shear - simple).applyfunc(sp.cancel) == sp.zeros(3, 3)
    for function, positive in ((paper.cantilever, True), (paper.cantilever_as_printed, False)):
        K = in_symbols(function, 0)
        assert bool((K[0, 1] * K[0, 2] * K[1, 2]).subs({a: 1, b: 2, EI: 1}) > 0) is positive


def negative_eigenvalues(function, length, xi):
    K = function(Properties(length, 0.0, length, 1.0, 1.0, 0.0), xi)
    scale = np.sqrt(np.diag(K))
    return int((np.linalg.eigvalsh(K / np.outer(scale, scale)) < 0).sum())


@pytest.mark.slow
def test_printed_matrix_is_indefinite_at_every_position():
    """One negative eigenvalue for any a as long as l0 < 6 sqrt(2) units of length; none when corrected."""
    for length in (0.05, 1.0, 8.48):
        for xi in np.linspace(0.01, 0.99, 33):
            assert negative_eigenvalues(paper.euler_bernoulli_as_printed, length, xi) == 1
            assert negative_eigenvalues(paper.euler_bernoulli, length, xi) == 0
    printed = in_symbols(paper.euler_bernoulli_as_printed, 0)
    determinant = printed.subs(EI, 1).applyfunc(sp.cancel).det(method="berkowitz")
    factor = sp.cancel(determinant / (2 * a**2 * b**2 - 9 * l0**2))
    assert all(factor.subs({a: i, b: j}) > 0 for i in (sp.Rational(1, 50), 1, 40) for j in (1, 9))
    assert negative_eigenvalues(paper.euler_bernoulli_as_printed, 8.49, 0.5) == 0


def test_cantilever_is_the_simply_supported_element():
    """``T^T K T`` is (5) in symbols; forces and tangents of the contact agree to round-off."""
    p = Properties(l0, 0, l0, 1, EI, 0)
    T = sp.Matrix(paper.transformation(p, a / l0))
    turned = T.T * in_symbols(paper.cantilever, 0) * T
    difference = turned - in_symbols(paper.euler_bernoulli, 0)
    assert difference.applyfunc(sp.cancel) == sp.zeros(3, 3)
    rng = np.random.default_rng(9)
    names = ("euler-bernoulli-simple", "euler-bernoulli-cantilever")
    for _ in range(100):
        state = random_contact(rng, near=rng.uniform(0.05, 0.5))
        simple, clamped = (CLOSED_FORM[name].contact.response(*state) for name in names)
        for one, other in zip(clamped, simple, strict=True):
            assert np.abs(one - other).max() <= 1e-11 * np.abs(other).max()


ELEMENT_FORCES = {
    "euler-bernoulli-simple": (paper.force_equation(paper.euler_bernoulli), 0.0),
    "euler-bernoulli-cantilever": (paper.force_equation(paper.cantilever, paper.transformation), 0.0),
    "timoshenko": (paper.force_equation(paper.timoshenko), 0.7),
    "timoshenko, stocky": (paper.force_equation(paper.timoshenko), 100.0),
}


@pytest.mark.parametrize("name", ELEMENT_FORCES)
@pytest.mark.parametrize("xi", [1e-3, 0.37, 0.93])
def test_eliminating_the_contact_force_gives_the_papers_elements(name, xi):
    """``g + C lam = 0`` with ``g = y_c - w(xi)``, the force normal to the chord, no bow: matrix and forces."""
    element_force, Phi = ELEMENT_FORCES[name]
    p = Properties(1.3, 0.0, 1.3, 10.0, 2.0, Phi)
    near, far = p.EI / p.l0 * np.array([4 + Phi, 2 - Phi]) / (1 + Phi)
    k = np.array([[near, far, 0], [far, near, 0], [0, 0, 0]])
    w = p.l0 * xi * (1 - xi) / (1 + Phi) * np.array([1 - xi + Phi / 2, -(xi + Phi / 2), 0])
    g = np.array([0.0, 0.0, 1.0]) - w
    C = mixed_contact.compliance(p, xi)[0]
    v = np.array([0.2, -0.1, w @ [0.2, -0.1, 0] + 0.3 * C])
    S, K, _ = element_force(p, xi, v)
    assert np.abs(K - (k + np.outer(g, g) / C)).max() <= 1e-12 * np.abs(K).max()
    lam = -(g @ v) / C
    assert lam == pytest.approx(-0.3, rel=1e-9)
    assert np.abs(S - (k @ v - lam * g)).max() <= 1e-13 * (np.abs(K) @ np.abs(v)).max()

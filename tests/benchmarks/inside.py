"""Ratios within a solution: an iteration of beams over the elements, assembly and factorisation of the solid."""

import time
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.sparse.linalg import splu

import fem_reference
import tsm
from comparisons.models.solid import to_solid
from comparisons.models.tsm import to_structure
from comparisons.scene import load_scene

# not public: one iteration, one assembly and one factorisation, which no solution gives apart
from fem_reference.solid.assembly import deformation_gradient, element_entries
from fem_reference.solid.factor import factorise, full
from fem_reference.system.body import build_body
from tests.benchmarks import plain
from tests.benchmarks.measure import Gate
from tests.fem_reference import bilinear_reference as forms
from tsm.model.model import Model
from tsm.system.system import Assembler

KS = load_scene("ks-cantilever")
T = np.array(KS.times)


def iterations(elements, count=20, **options):
    """Action that does iterations of KS at the load parameter 0.1."""
    model = Model(to_structure(KS, elements=elements, **options))
    state = tsm.solve(model.structure, np.array([0.1])).equilibria[-1].state
    assembler = Assembler(model)

    def iterate():
        for _ in range(count):
            assembler.solve(assembler.linearise(state))

    return iterate


def against_plain(bench):
    """Solutions of KS over that of a plain NumPy program, all load parameters and the end state alone."""
    bars = {"mixed 10": 0.35, "mixed 40": 0.45, "exact 1": 0.38}
    asked = {name: {"element": name.split()[0], "elements": int(name.split()[1])} for name in bars}
    built = {name: to_structure(KS, **options) for name, options in asked.items()}
    actions = {name: partial(tsm.solve, structure, T) for name, structure in built.items()}
    actions["exact 1, end state alone"], bars["exact 1, end state alone"] = (
        partial(tsm.solve, built["exact 1"], np.array([1.0])), 0.10,
    )  # fmt: skip
    base, *found = bench.seconds(
        7, min, time.process_time, **{"plain program": partial(plain.solved, KS)}, **actions
    )
    for (name, bar), value in zip(bars.items(), found, strict=True):
        bench.add(Gate(f"{name} over a plain program", value / base, bar))


def beams(bench):
    """The element without critical area against the paper's; the exponent of the cost over the elements."""
    mixed, paper = bench.seconds(
        mixed_20=iterations(20, 200), timoshenko_20=iterations(20, 200, element="timoshenko")
    )
    bench.add(Gate("mixed over timoshenko, seconds per iteration", mixed / paper, 1.3))

    def exponent(few, many, **options):
        actions = {f"{options} {n} elements": iterations(n, **options) for n in (few, many)}
        one, other = bench.seconds(9, min, **actions)
        return np.log10(other / one)

    bench.add(Gate("exponent of the cost per iteration, 200 to 2000 elements", exponent(200, 2000), 1.1))
    value = exponent(100, 1000, element="exact")
    bench.add(Gate("exponent of the cost per iteration, exact, 100 to 1000 elements", value, 1.1))


def solution(bench):
    """A Newton iteration of the solid against SuperLU's factorisation of its tangent and four solutions.

    The bars are the ratios of the solid before its band was assembled and factorised as such, over 1.4 and 1.7.
    """
    for mesh, bar in (((50, 2), 3.2), ((200, 4), 0.8)):
        problem, name = to_solid(KS, mesh=mesh), f"{mesh[0]}x{mesh[1]}"
        result = fem_reference.solve(problem, T)
        K = full(result.model.bodies[0].band(result.states[len(result.states) // 2].gradients[0]))
        columns = np.random.default_rng(0).standard_normal((K.shape[0], 4))

        def general(K=K, columns=columns):
            splu(K, permc_spec="NATURAL").solve(columns)

        def solved(problem=problem):
            fem_reference.solve(problem, T)

        (whole,) = bench.seconds(5, min, time.process_time, **{f"solid {name}": solved})
        (once,) = bench.seconds(50, min, time.process_time, **{f"SuperLU {name}": general})
        value = whole / result.newton_iterations.sum() / once
        bench.add(Gate(f"iteration of the solid over SuperLU with four solutions, {name}", value, bar))


def assembly(bench):
    """Tangent and residual of the solid against scikit-fem's forms, and against the factorisation."""
    for mesh, repeats in (((50, 2), 7), ((200, 4), 7), ((1000, 20), 1)):
        strip = replace(to_solid(KS, mesh=mesh).strips[0], element="Q2-full")
        body, name = build_body(strip), f"{mesh[0]}x{mesh[1]}"
        u = 1e-4 * np.random.default_rng(0).standard_normal(body.mesh.nodes.shape)
        E, nu = strip.youngs_modulus, strip.poissons_ratio
        lame = E * nu / (1 - nu**2), E / (2 * (1 + nu))
        basis = forms.vector_basis(body.mesh.nodes, body.mesh.cells)

        def band(u, body=body):
            F = deformation_gradient(body.mesh, u)
            return body.stiffness.band(element_entries(body.mesh, body.law.tangent(F)))

        K = band(0 * u)

        def batched(body=body, u=u, band=band):
            body.internal_force(deformation_gradient(body.mesh, u))
            band(u)

        def bilinear(basis=basis, u=u, lame=lame):
            forms.tangent_and_residual(basis, u.ravel(), *lame, 0.02)

        def factorised(K=K):
            factorise(K)

        actions = {f"batched {name}": batched, f"BilinearForm {name}": bilinear, f"factor {name}": factorised}
        own, general, factor = bench.seconds(repeats, **actions)
        bench.add(Gate(f"BilinearForm over batched products, {name}", general / own, 15, at_least=True))
        if mesh == (200, 4):
            bench.add(Gate(f"assembly over factorisation, {name}", own / factor, 1))


PARTS = (against_plain, beams, solution, assembly)

"""Ratios of the solid and the certificate: assembly, index, memory."""

from __future__ import annotations

import math
import subprocess
import sys
import time
from dataclasses import replace
from typing import Any
from unittest.mock import patch

import numpy as np

import fem_reference
import tsm
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.models.translate import to_solid, to_structure
from comparisons.referee import answer_state, certify, equilibrium
from comparisons.scene import BeamSpec, ContactSpec, PinSpec, Scene, load_scene
from fem_reference.tangent import linearise
from tests.benchmarks.measure import Gate, seconds
from tests.fem_reference import bilinear_reference as forms
from tsm import path

CROWD = Scene(
    name="crowd",
    load_parameters=4,
    beams=(
        BeamSpec(
            name="b", start=(0.0, 0.0), end=(11.0, 0.0), clamped=("start", "end"), width=0.2, height=0.1,
            youngs_modulus=1e7, poissons_ratio=0.3,
        ),
    ),
    pins=tuple(
        PinSpec(name=f"p{k}", start=(k + 0.03 * math.sin(k), 0.05 * (-1) ** k), displacement=(0.05, -0.12 * (-1) ** k))
        for k in range(1, 11)
    ),
    contacts=tuple(
        ContactSpec(node=f"p{k}", beam="b", side="left" if k % 2 == 0 else "right", surface="face") for k in range(1, 11)
    ),
)  # fmt: skip
"""Ten pins on both sides of one beam, in turn."""


def index_and_certificate(gates: list[Gate], times: dict[str, float]) -> None:
    """What stability costs of a solution, and what a certificate does."""
    scene = load_scene("ks-cantilever")
    load_parameters = np.array(scene.times)
    solid = to_solid(scene, mesh=(50, 2))
    for label, structure, bar in (
        ("mixed 10", to_structure(scene, elements=10), 0.2),
        ("exact", to_structure(scene, element="exact"), 0.2),
    ):

        def counted(structure: tsm.Structure = structure) -> None:
            tsm.solve(structure, load_parameters)

        def uncounted(structure: tsm.Structure = structure) -> None:
            with patch.object(path, "index", lambda *_: 0):
                tsm.solve(structure, load_parameters)

        whole, rest = seconds(counted, uncounted, of=min)
        gates.append(Gate(f"index of {label}, part of its solution", (whole - rest) / whole, bar, False))
    steps = fem_reference.solve(solid, load_parameters[:10])
    tangent = linearise(steps.model, steps.states[-1])
    (signs,) = seconds(lambda: tangent.index(1e-12), repeats=15, of=min)
    gates.append(
        Gate(
            "index of the solid, part of its solution",
            signs * steps.substeps / steps.wall_seconds,
            0.05,
            False,
        )
    )
    response, crowd = solve(scene, "tsm"), solve(CROWD, "tsm", Options(element="exact"))
    times["certificate of ks-cantilever"], times["certificate of ten contacts"] = seconds(
        lambda: certify(response, scene), lambda: equilibrium(CROWD, answer_state(crowd, CROWD, -1))
    )
    gates.append(
        Gate("seconds of a certificate with ten contacts", times["certificate of ten contacts"], 0.3, False)
    )


def solution(gates: list[Gate], times: dict[str, float]) -> None:
    """A Newton iteration of the solid against SuperLU's factorisation of its tangent and four solutions.

    The bars are the ratios of the solid before its band was assembled and factorised as such, over 1.4 and 1.7.
    """
    from scipy.sparse.linalg import splu

    scene = load_scene("ks-cantilever")
    load_parameters = np.array(scene.times)
    for mesh, bar in (((50, 2), 3.2), ((200, 4), 0.8)):
        problem, name = to_solid(scene, mesh=mesh), f"{mesh[0]}x{mesh[1]}"
        result = fem_reference.solve(problem, load_parameters)
        K = result.model.bodies[0].tangent(result.states[len(result.states) // 2].u)
        columns = np.random.default_rng(0).standard_normal((K.shape[0], 4))

        def general(K: Any = K, columns: Any = columns) -> None:
            splu(K, permc_spec="NATURAL").solve(columns)

        def solved(problem: Any = problem) -> None:
            fem_reference.solve(problem, load_parameters)

        whole, (once,) = (
            seconds(solved, repeats=5, of=min, clock=time.process_time)[0],
            seconds(general, repeats=50, of=min, clock=time.process_time),
        )
        times[f"solid {name}, 50 load parameters of ks-cantilever"] = whole
        value = whole / result.newton_iterations.sum() / once
        gates.append(
            Gate(f"iteration of the solid over SuperLU with four solutions, {name}", value, bar, False)
        )


def assembly(gates: list[Gate], times: dict[str, float]) -> None:
    """Tangent and residual of the solid against scikit-fem's forms, and against the factorisation."""
    from fem_reference.assembly import element_entries
    from fem_reference.body import build_body
    from fem_reference.factor import factorise

    for mesh, repeats in (((50, 2), 7), ((200, 4), 7), ((1000, 20), 1)):
        strip = replace(to_solid(load_scene("ks-cantilever"), mesh=mesh).strips[0], element="Q2-full")
        body, name = build_body(strip), f"{mesh[0]}x{mesh[1]}"
        u = 1e-4 * np.random.default_rng(0).standard_normal(body.mesh.nodes.shape)
        E, nu = strip.youngs_modulus, strip.poissons_ratio
        lam, mu = E * nu / (1 - nu**2), E / (2 * (1 + nu))
        basis = forms.vector_basis(body.mesh.nodes, body.mesh.cells)

        def band(body: Any = body, u: Any = u) -> Any:
            return body.stiffness.band(element_entries(body.mesh, body.law.tangent, u))

        K = band(u=0 * u)

        def batched(body: Any = body, u: Any = u, band: Any = band) -> None:
            body.internal_force(u)
            band()

        def bilinear(basis: Any = basis, u: Any = u, lam: float = lam, mu: float = mu) -> None:
            forms.tangent_and_residual(basis, u.ravel(), lam, mu, 0.02)

        def factorised(K: Any = K) -> None:
            factorise(lambda: K.copy(order="F"))

        own, general, factor = seconds(batched, bilinear, factorised, repeats=repeats)
        times |= {
            f"tangent + residual {name}, batched": own,
            f"tangent + residual {name}, BilinearForm": general,
            f"factorisation {name}": factor,
        }
        gates.append(Gate(f"BilinearForm over batched products, {name}", general / own, 15, True))
        if mesh == (200, 4):
            gates.append(Gate(f"assembly over factorisation, {name}", own / factor, 1, False))


PEAK = """
import resource
import numpy as np
import fem_reference
from comparisons.scene import BeamSpec, ContactSpec, PinSpec, Scene, load_scene
from comparisons.models.translate import to_solid
fem_reference.solve(to_solid(load_scene("ks-cantilever"), mesh=(1000, 20)), np.array([0.02]))
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


def memory(gates: list[Gate], times: dict[str, float]) -> None:
    """Peak memory of one load parameter on 1000x20, 164,000 unknowns."""
    begin = time.perf_counter()
    done = subprocess.run([sys.executable, "-c", PEAK], check=True, capture_output=True, text=True)
    times["one load parameter, 1000x20"] = time.perf_counter() - begin
    gates.append(Gate("peak memory of 1000x20, GB", int(done.stdout) * 1024 / 1e9, 1.5, False))

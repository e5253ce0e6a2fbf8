"""Linear solvers on the solid's tangent, KS strip: processor time, iterations and memory, in one table.

A Newton iteration solves with one matrix and four right-hand sides, the residual and the three columns of a closed contact; the table's
solution is for the first column. No solver's true residual falls below the round-off of ``K x``, 1e-6 of the load on so slender a strip: the
Krylov methods stop at 1e-10 by their own count, SciPy's MINRES relative to ``|K| |x|``, and answers are compared with SuperLU's. Packages
that are not installed are left out by name.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from importlib import import_module
from importlib.util import find_spec
from multiprocessing import get_context
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RectBivariateSpline
from scipy.sparse import csc_matrix, csr_matrix, load_npz, save_npz, triu
from scipy.sparse.linalg import LinearOperator, cg, gmres, minres, spilu, splu

import fem_reference
from comparisons.models.translate import to_solid
from comparisons.scene import load_scene
from fem_reference.model import build
from fem_reference.state import build_state

Floats = NDArray[np.float64]
TOLERANCE, MOST_ITERATIONS = 1e-10, 500
COARSE = (50, 2)
REFERENCE = "SuperLU, in use"


class System(NamedTuple):
    """``K x = b`` with the rigid body modes of the deformed strip, ``(m, 3)``, and SuperLU's ordering for K."""

    K: csc_matrix
    b: Floats
    modes: Floats
    ordering: str


class Outcome(NamedTuple):
    """A solution with its processor times [s] and what its solver needed on top of the matrix [GB]."""

    x: Floats
    setup: float
    solve: float
    iterations: int
    memory: float


Solve = Callable[[Floats], tuple[Floats, int]]


def write_systems(mesh: tuple[int, int], loads: list[float], folder: str) -> None:
    """Tangents of a mesh at equilibria of a coarse one, carried over by cubic splines."""
    scene = load_scene("ks-cantilever")
    t = np.union1d(np.arange(1, 21) / 20, loads)
    coarse = fem_reference.solve(to_solid(scene, mesh=COARSE), t)
    model = build(to_solid(scene, mesh=mesh))
    body, nodes = model.bodies[0], model.bodies[0].mesh.nodes
    places = np.round(coarse.model.bodies[0].mesh.nodes, 9)
    (x, y), order = map(np.unique, places.T), np.lexsort(places.T[::-1])
    for load in loads:
        at = coarse.states[int(np.argmin(np.abs(t - load)))]
        grids = at.u[order].reshape(x.size, y.size, 2).transpose(2, 0, 1)
        u = np.column_stack([RectBivariateSpline(x, y, grid)(*nodes.T, grid=False) for grid in grids])
        place = nodes + u - (nodes + u).mean(axis=0)
        modes = np.zeros((len(nodes), 2, 3))
        modes[:, 0, 0] = modes[:, 1, 1] = 1
        modes[:, 0, 2], modes[:, 1, 2] = -place[:, 1], place[:, 0]
        slopes = build_state(model, u, load, at.conditions).closed[0].slopes
        save_npz(_matrix(folder, load), body.tangent(u), compressed=False)
        np.savez(
            _vectors(folder, load),
            b=model.expansion.T @ slopes[:, 0],
            modes=model.expansion.T @ modes.reshape(-1, 3),
            ordering="NATURAL" if body.mesh.edges["start"].size < 16 else "MMD_AT_PLUS_A",
        )


def _matrix(folder: str, load: float) -> Path:
    return Path(folder) / f"{load}-K.npz"


def _vectors(folder: str, load: float) -> Path:
    return Path(folder) / f"{load}.npz"


def read_system(load: float, folder: str) -> System:
    vectors = np.load(_vectors(folder, load))
    return System(load_npz(_matrix(folder, load)), vectors["b"], vectors["modes"], str(vectors["ordering"]))


def superlu(system: System) -> Solve:
    factors = splu(system.K, permc_spec=system.ordering)
    return lambda b: (factors.solve(b), 0)


def incomplete(system: System) -> Solve:
    factors = spilu(
        system.K, drop_tol=1e-4, fill_factor=10, permc_spec=system.ordering, diag_pivot_thresh=0.1
    )
    return _krylov(system.K, LinearOperator(system.K.shape, factors.solve), "GMRES")


def multigrid(system: System, method: str) -> Solve:
    """Smoothed aggregation that keeps the rigid body modes."""
    sweep = ("gauss_seidel", {"sweep": "symmetric"})
    levels = import_module("pyamg").smoothed_aggregation_solver(
        csr_matrix(system.K),
        B=system.modes,
        improve_candidates=None,
        presmoother=sweep,
        postsmoother=sweep,
        max_coarse=600,
        coarse_solver="splu",
    )
    return _krylov(system.K, levels.aspreconditioner(), method)


def pardiso(system: System) -> Solve:
    """MKL's factorisation ``L D L^T`` of the symmetric indefinite matrix."""
    factors = import_module("pypardiso").PyPardisoSolver(mtype=-2)
    upper = csr_matrix(triu(system.K))
    factors.factorize(upper)
    return lambda b: (factors.solve(upper, b), 0)


def _krylov(K: csc_matrix, M: LinearOperator, method: str) -> Solve:
    def solve(b: Floats) -> tuple[Floats, int]:
        steps: list[None] = []

        def count(_: Any) -> None:
            steps.append(None)

        if method == "GMRES":
            limits = {"restart": 100, "maxiter": MOST_ITERATIONS // 100, "callback_type": "pr_norm"}
            x, _ = gmres(K, b, M=M, rtol=TOLERANCE, callback=count, **limits)
        else:
            solver = {"CG": cg, "MINRES": minres}[method]
            x, _ = solver(K, b, M=M, rtol=TOLERANCE, maxiter=MOST_ITERATIONS, callback=count)
        return x, len(steps)

    return solve


SOLVERS: dict[str, tuple[Callable[[System], Solve], str]] = {
    REFERENCE: (superlu, "scipy"),
    "PARDISO": (pardiso, "pypardiso"),
    "multigrid, CG": (lambda system: multigrid(system, "CG"), "pyamg"),
    "multigrid, MINRES": (lambda system: multigrid(system, "MINRES"), "pyamg"),
    "multigrid, GMRES": (lambda system: multigrid(system, "GMRES"), "pyamg"),
    "incomplete LU, GMRES": (incomplete, "scipy"),
}


def measure(name: str, load: float, folder: str) -> Outcome:
    """Set up and solve once; to be called in a process of its own, whose peak memory is the solver's."""
    system = read_system(load, folder)
    set_up, package = SOLVERS[name]
    import_module(package)
    before = _resident()
    begin = time.process_time()
    solve = set_up(system)
    ready = time.process_time()
    x, iterations = solve(system.b)
    return Outcome(x, ready - begin, time.process_time() - ready, iterations, _peak() - before)


def _peak() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9


def _resident() -> float:
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 1e9


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--meshes", nargs="+", default=["1000x20", "2000x20", "2000x40"])
    parser.add_argument("--loads", nargs="+", type=float, default=[0.5, 1.0])
    parser.add_argument("--solvers", nargs="+", choices=list(SOLVERS), default=list(SOLVERS))
    options = parser.parse_args()
    names = [
        name for name in SOLVERS if name in {REFERENCE, *options.solvers} and find_spec(SOLVERS[name][1])
    ]
    for name in options.solvers:
        if name not in names:
            print(f"left out: {name} ({SOLVERS[name][1]} is not installed)")
    print("| mesh | t | solver | set-up, s | solution, s | iterations | memory, GB | difference |")
    print("|---|---|---|---|---|---|---|---|")
    for mesh in options.meshes:
        along, across = map(int, mesh.split("x"))
        with (
            tempfile.TemporaryDirectory() as folder,
            ProcessPoolExecutor(1, get_context("spawn"), max_tasks_per_child=1) as processes,
        ):
            processes.submit(write_systems, (along, across), options.loads, folder).result()
            for load in options.loads:
                found = {name: processes.submit(measure, name, load, folder) for name in names}
                for name in names:
                    of, reference = found[name].result(), found[names[0]].result().x
                    off = np.abs(of.x - reference).max() / np.abs(reference).max()
                    numbers = f"{of.setup:.2g} | {of.solve:.2g} | {of.iterations or '-'} | {of.memory:.2f} | {off:.0e}"
                    print(f"| {mesh} | {load:g} | {name} | {numbers} |", flush=True)


if __name__ == "__main__":
    main()

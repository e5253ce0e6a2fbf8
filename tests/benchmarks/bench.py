"""Speed as ratios within one run, one thread. `make bench` writes them to bench.json; the ratios gate, times inform."""

from __future__ import annotations

import argparse
import importlib.util
import json
import os
import platform
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

import fem_reference
import tsm
from comparisons.cases import measure
from comparisons.cost.points import cheapest
from comparisons.cost.sweep import measure_trade
from comparisons.files import write_text
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.models.translate import to_solid, to_structure
from comparisons.referee import answer_state, certify, equilibrium
from comparisons.scene import load_scene, read_scene
from fem_reference.tangent import linearise
from tests.comparisons.many_beams import MANY
from tests.comparisons.referee.test_index import CROWD
from tsm import path
from tsm.model import Model
from tsm.system import Assembler


@dataclass(frozen=True)
class Gate:
    """A measured ratio and its bar."""

    name: str
    value: float
    bar: float
    at_least: bool

    @property
    def met(self) -> bool:
        return bool(self.value >= self.bar if self.at_least else self.value <= self.bar)

    def __str__(self) -> str:
        relation = ">=" if self.at_least else "<="
        return f"{'met    ' if self.met else 'NOT MET'}  {self.name}: {self.value:.3g} (bar {relation} {self.bar:g})"


def seconds(
    *actions: Callable[[], Any],
    repeats: int = 7,
    of: Callable[[list[float]], float] = statistics.median,
    clock: Callable[[], float] = time.perf_counter,
) -> list[float]:
    """Median or other seconds of each action, taken in turn so that a slow moment of the machine meets all of them."""
    for action in actions:
        action()
    taken: list[list[float]] = [[] for _ in actions]
    for _ in range(repeats):
        for row, action in zip(taken, actions, strict=True):
            begin = clock()
            action()
            row.append(clock() - begin)
    return [of(row) for row in taken]


def children() -> float:
    """Processor time of the processes that this one has started and seen end."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def beams_against_solid(gates: list[Gate], times: dict[str, float]) -> None:
    import fem_reference

    scene = load_scene("ks-cantilever")
    structure, solid = to_structure(scene, elements=10), to_solid(scene, mesh=(50, 2))
    t = np.arange(1, 51) / 50
    results: dict[str, Any] = {}

    def run_beams() -> None:
        results["beams"] = tsm.solve(structure, t)

    def run_solid() -> None:
        results["solid"] = fem_reference.solve(solid, t)

    beams, reference = seconds(run_beams, run_solid)
    times |= {"tsm mixed 10, 50 load parameters": beams, "solid 50x2, 50 load parameters": reference}
    gates.append(Gate("solid 50x2 over TSM mixed 10, seconds", reference / beams, 40, True))
    for name, result in results.items():
        mean = float(np.mean(result.newton_iterations))
        gates.append(Gate(f"Newton iterations per load parameter, {name}", mean, 5, False))
        gates.append(Gate(f"cut-backs, {name}", result.cutbacks, 0, False))


def equal_error(gates: list[Gate], times: dict[str, float]) -> None:
    """The cheapest solid over the cheapest beams at .1 % of the force, each against what it converges to: `crossval trade --quick`."""
    trade = measure_trade(
        load_scene("ks-cantilever"), lambda cases: {case: measure(case) for case in cases}, quick=True
    )
    for scope, state in (("end", "end state"), ("path", "50 load parameters")):
        found = cheapest(trade, scope, "force", 1e-3)
        for point in (found.tsm, found.solid):
            assert point is not None
            times[f"{point.case.label}, .1 % of F, {state}"] = point.measured.seconds
        gates.append(Gate(f"solid over TSM at .1 % of F, {state}, seconds", found.ratio, 100, True))


def scenes_and_elements(gates: list[Gate], times: dict[str, float]) -> None:
    """Double beam against the KS run, and the element without critical area against the paper's, per iteration."""
    ks, both = load_scene("ks-cantilever"), load_scene("double-beam")
    one, two = to_structure(ks, elements=20), to_structure(both, elements=10)
    t, depths = np.arange(1, 51) / 50, np.arange(1, both.load_parameters + 1) / both.load_parameters
    single, double = seconds(lambda: tsm.solve(one, t), lambda: tsm.solve(two, depths))
    times |= {"tsm mixed 20, KS": single, "tsm mixed 10 + 10, double beam": double}
    gates.append(Gate("double beam over KS with 20 elements, seconds", double / single, 4, False))

    actions = []
    for element in ("mixed", "timoshenko"):
        structure = to_structure(ks, elements=20, element=element)
        result = tsm.solve(structure, np.array([0.1]))
        assembler, state = Assembler(result.model), result.equilibria[-1].state

        def iterate(assembler: Assembler = assembler, state: Any = state) -> None:
            for _ in range(200):
                assembler.solve(assembler.linearise(state))

        actions.append(iterate)
    mixed, paper = seconds(*actions)
    times |= {"200 iterations, mixed 20": mixed, "200 iterations, timoshenko 20": paper}
    gates.append(Gate("mixed over timoshenko, seconds per iteration", mixed / paper, 1.3, False))


def iterations(elements: int, **options: Any) -> Callable[[], None]:
    """Action that does 20 iterations of KS at the load parameter 0.1."""
    model = Model(to_structure(load_scene("ks-cantilever"), elements=elements, **options))
    state = tsm.solve(model.structure, np.array([0.1])).equilibria[-1].state
    assembler = Assembler(model)

    def iterate() -> None:
        for _ in range(20):
            assembler.solve(assembler.linearise(state))

    return iterate


def linear_cost(gates: list[Gate], times: dict[str, float]) -> None:
    """Exponent of the cost of one iteration over the elements, largest chord from 200 to 2000."""
    few, many = seconds(*(iterations(elements) for elements in (200, 2000)))
    times |= {"20 iterations, 200 elements": few, "20 iterations, 2000 elements": many}
    gates.append(
        Gate(
            "exponent of the cost per iteration, 200 to 2000 elements",
            float(np.log10(many / few)),
            1.1,
            False,
        )
    )


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


def many_beams(gates: list[Gate], times: dict[str, float]) -> None:
    """3,000 beams, in chains, rows and frames."""
    for kind, text in MANY.items():
        scene = read_scene(text(3000), "many.toml")
        (spent,) = seconds(lambda scene=scene: solve(scene, "tsm"), repeats=1)
        gates.append(Gate(f"seconds for 3,000 beams, {kind}", spent, 20, False))


def exact_element(gates: list[Gate], times: dict[str, float]) -> None:
    """The exact element against `mixed`; the shortest of 15 repeats, which varies less than their median.

    End states are timed eight in a row: a short action meets fewer slow moments than the long one that it is compared with.
    """
    from integrators import errors

    ks, both = load_scene("ks-cantilever"), load_scene("double-beam")
    t, depths = np.arange(1, 51) / 50, np.arange(1, both.load_parameters + 1) / both.load_parameters
    exact, loose = to_structure(ks, elements=1, element="exact"), tsm.Settings(accuracy=1e-6)
    assert max(errors(tsm.solve(exact, t))) <= 1e-8
    assert max(errors(tsm.solve(exact, t, loose))) <= 1e-6
    elements = next(
        n for n in range(2, 100, 2) if max(errors(tsm.solve(to_structure(ks, elements=n), t))) <= 1e-6
    )
    ten, fine = to_structure(ks, elements=10), to_structure(ks, elements=elements)
    path, end, path_loose, mixed, mixed_fine = seconds(
        lambda: tsm.solve(exact, t),
        lambda: [tsm.solve(exact, np.array([1.0])) for _ in range(8)],
        lambda: tsm.solve(exact, t, loose),
        lambda: tsm.solve(ten, t),
        lambda: tsm.solve(fine, t),
        repeats=15,
        of=min,
    )
    times |= {
        "tsm exact 1, 50 load parameters": path,
        "tsm exact 1, end state alone, 8 times": end,
        "tsm exact 1, accuracy 1e-6": path_loose,
        "tsm mixed 10, 50 load parameters (shortest)": mixed,
        f"tsm mixed {elements}, error 1e-6": mixed_fine,
    }
    gates.append(Gate("exact 1 over mixed 10, seconds", path / mixed, 2.5, False))
    gates.append(Gate("exact 1, 50 load parameters over end state, seconds", 8 * path / end, 8, True))
    gates.append(
        Gate(f"mixed {elements} over exact 1 at error 1e-6, seconds", mixed_fine / path_loose, 1, True)
    )

    few, many = seconds(*(iterations(n, element="exact") for n in (100, 1000)), repeats=9, of=min)
    times |= {"20 iterations, exact 100": few, "20 iterations, exact 1000": many}
    exponent = float(np.log10(many / few))
    gates.append(
        Gate("exponent of the cost per iteration, exact, 100 to 1000 elements", exponent, 1.1, False)
    )

    one, two = to_structure(both, elements=1, element="exact"), to_structure(both, elements=10)
    double, closed = seconds(
        lambda: tsm.solve(one, depths), lambda: tsm.solve(two, depths), repeats=5, of=min
    )
    times |= {"tsm exact 1 + 1, double beam": double, "tsm mixed 10 + 10, double beam (shortest)": closed}


def assembly(gates: list[Gate], times: dict[str, float]) -> None:
    """Tangent and residual of the solid against scikit-fem's forms, and against the factorisation."""
    from scipy.sparse.linalg import splu

    from fem_reference.body import build_body

    forms = _forms()
    for mesh, repeats in (((50, 2), 7), ((200, 4), 7), ((1000, 20), 1)):
        strip = replace(to_solid(load_scene("ks-cantilever"), mesh=mesh).strips[0], element="Q2-full")
        body, name = build_body(strip), f"{mesh[0]}x{mesh[1]}"
        u = 1e-4 * np.random.default_rng(0).standard_normal(body.mesh.nodes.shape)
        E, nu = strip.youngs_modulus, strip.poissons_ratio
        lam, mu = E * nu / (1 - nu**2), E / (2 * (1 + nu))
        basis, K = forms.vector_basis(body.mesh.nodes, body.mesh.cells), body.tangent(u)

        def batched(body: Any = body, u: Any = u) -> None:
            body.internal_force(u)
            body.tangent(u)

        def bilinear(basis: Any = basis, u: Any = u, lam: float = lam, mu: float = mu) -> None:
            forms.tangent_and_residual(basis, u.ravel(), lam, mu, 0.02)

        def factorise(K: Any = K, ordering: str = "NATURAL" if mesh[1] < 8 else "MMD_AT_PLUS_A") -> None:
            splu(K, permc_spec=ordering)

        ours, theirs, factor = seconds(batched, bilinear, factorise, repeats=repeats)
        times |= {
            f"tangent + residual {name}, batched": ours,
            f"tangent + residual {name}, BilinearForm": theirs,
            f"factorisation {name}": factor,
        }
        gates.append(Gate(f"BilinearForm over batched products, {name}", theirs / ours, 15, True))
        if mesh == (200, 4):
            gates.append(Gate(f"assembly over factorisation, {name}", ours / factor, 1, False))


def variants(count: int) -> list[tsm.Structure]:
    """KS cantilevers of other lengths, slendernesses, stiffnesses and paths of the pin, 10 `mixed` elements each."""
    rng = np.random.default_rng(0)
    ks = to_structure(load_scene("ks-cantilever"), elements=10)
    (beam,), (pin,), found = ks.beams, ks.pins, []
    for _ in range(count):
        size, slender, stiff = rng.uniform(0.5, 2), rng.uniform(0.5, 1.5), 10 ** rng.uniform(-1, 1)
        (x, y), (dx, dy) = pin.path[0], np.subtract(pin.path[1], pin.path[0]) * rng.uniform(0.95, 1, 2)
        EI = stiff * slender**2 * size**2 * beam.section.EI
        section = tsm.Section(EA=stiff * beam.section.EA, GA=stiff * beam.section.GA, EI=EI)
        start, end = ((size * a, size * b) for a, b in (beam.start, beam.end))
        path = ((size * x, size * y), (size * (x + dx), size * (y + dy)))
        found.append(
            replace(
                ks,
                beams=(replace(beam, start=start, end=end, section=section),),
                pins=(replace(pin, path=path),),
            )
        )
    return found


def apart(batch: tsm.BatchResult, alone: list[tsm.Result]) -> float:
    """Largest difference of a batch from results one by one, forces over the largest force, positions over the length."""
    largest = 0.0
    for n, one in zip(range(0, len(batch), len(batch) // len(alone)), alone, strict=True):
        (contact,), (held,), (tip,) = one.contacts.items(), one.supports.items(), one.tips.items()
        F, L = contact[1].force.max(), one.model.length
        assert batch.status[n] is one.status
        for mine, theirs, scale in (
            (batch.force[contact[0]], contact[1].force, F),
            (batch.arc_position[contact[0]], contact[1].arc_position, L),
            (batch.supports[held[0]].moment, held[1].moment, F * L),
            (batch.tips[tip[0]], tip[1], L),
        ):
            reached = mine[n, : len(theirs)]
            largest = max(largest, float(np.abs(reached - theirs).max()) / scale)
    return largest


def batches(gates: list[Gate], times: dict[str, float]) -> None:
    """A batch of 1,000 variants of KS against every tenth of them one by one; equal where the tolerance is sharp."""
    structures, t = variants(1000), np.arange(1, 51) / 50
    some = structures[::10]
    found: dict[str, Any] = {}
    for name, settings, bar in (
        ("default tolerance", tsm.Settings(), 1e-10),
        ("tolerance 1e-12", tsm.Settings(tolerance=1e-12), 1e-12),
    ):

        def together(settings: tsm.Settings = settings) -> None:
            found["batch"] = tsm.solve_batch(structures, t, settings)

        def alone(settings: tsm.Settings = settings) -> None:
            found["alone"] = [tsm.solve(structure, t, settings, throw=False) for structure in some]

        batch, one_by_one = seconds(together, alone, repeats=3)
        times |= {f"1,000 KS at once, {name}": batch, f"100 KS one by one, {name}": one_by_one}
        gates.append(Gate(f"1,000 KS one by one over at once, {name}", 10 * one_by_one / batch, 20, True))
        difference = apart(found["batch"], found["alone"])
        gates.append(Gate(f"largest difference at once from one by one, {name}", difference, bar, False))


def _forms() -> Any:
    path = Path(__file__).parents[1] / "fem_reference" / "bilinear_reference.py"
    spec = importlib.util.spec_from_file_location("bilinear_reference", path)
    assert spec is not None
    assert spec.loader is not None
    forms = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(forms)
    return forms


PEAK = """
import resource
import numpy as np
import fem_reference
from comparisons.scene import load_scene
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


KS = ["solve", "ks-cantilever", "--model", "tsm", "--elements", "10"]
CROSSVAL = "from comparisons.cli import main; import sys; sys.exit(main({}))"
IN_PLACE = f"""
import contextlib, io, statistics, time
from comparisons.cli import main
taken = []
for _ in range(8):
    began = time.process_time()
    with contextlib.redirect_stdout(io.StringIO()):
        main({KS})
    taken.append(time.process_time() - began)
print(statistics.median(taken[1:]))
"""


def start_up(gates: list[Gate], times: dict[str, float]) -> None:
    """Processor time of processes from start to end, over that of ``import numpy``, bytecode compiled as an installation has it.

    The solution in ``crossval solve`` is the time that the command takes when it is repeated in one process. It is subtracted.
    """
    with tempfile.TemporaryDirectory() as bytecode:
        apart = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
        environment = {**apart, "PYTHONPYCACHEPREFIX": bytecode}

        def output(code: str) -> str:
            command = [sys.executable, "-c", code]
            return subprocess.run(command, check=True, capture_output=True, text=True, env=environment).stdout

        def start(code: str) -> Callable[[], Any]:
            return lambda: output(code)

        numpy, ours, told, whole = seconds(
            start("import numpy"),
            start("import tsm"),
            start(CROSSVAL.format(["--help"])),
            start(CROSSVAL.format(KS)),
            repeats=9,
            clock=children,
        )
        solution = float(output(IN_PLACE))
    times |= {"import numpy": numpy, "import tsm": ours, "crossval --help": told, "crossval solve": whole}
    times["solution in crossval solve"] = solution
    gates.append(Gate("import tsm over import numpy, processes", ours / numpy, 2.5, False))
    gates.append(Gate("crossval --help over import numpy, processes", told / numpy, 1.5, False))
    gates.append(
        Gate("crossval solve without its solution over import numpy", (whole - solution) / numpy, 3, False)
    )


def recorded(gates: list[Gate], times: dict[str, float]) -> str:
    """What was measured, and where, as JSON."""
    record = {
        "machine": platform.platform(),
        "python": platform.python_version(),
        "gates": [vars(gate) | {"value": float(gate.value), "met": gate.met} for gate in gates],
        "seconds": times,
    }
    return json.dumps(record, indent=1) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("bench.json"))
    out = parser.parse_args().out
    gates: list[Gate] = []
    times: dict[str, float] = {}
    for part in (
        beams_against_solid,
        equal_error,
        scenes_and_elements,
        linear_cost,
        index_and_certificate,
        many_beams,
        exact_element,
        batches,
        assembly,
        memory,
        start_up,
    ):
        part(gates, times)
    for gate in gates:
        print(gate)
    for name, value in times.items():
        print(f"         {name}: {1e3 * value:.3g} ms")
    write_text(out, recorded(gates, times))


if __name__ == "__main__":
    main()

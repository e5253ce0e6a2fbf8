"""Ratios of what users call: solutions of beams and solid, the command, the start of processes."""

import io
import json
import os
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack, redirect_stdout
from pathlib import Path
from statistics import median
from unittest.mock import patch

import numpy as np

import fem_reference
import tsm
from comparisons.answer.errors import difference
from comparisons.cli import main
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.models.solid import to_solid
from comparisons.models.tsm import to_structure
from comparisons.scene import load_scene
from comparisons.suite import budget
from comparisons.suites import compare
from tests.benchmarks.measure import Gate, children

KS = load_scene("ks-cantilever")
T = np.array(KS.times)


def beams_against_solid(bench):
    structure, solid = to_structure(KS, elements=10), to_solid(KS, mesh=(50, 2))
    beams, reference = bench.seconds(
        tsm_mixed_10=lambda: tsm.solve(structure, T), solid_50x2=lambda: fem_reference.solve(solid, T)
    )
    bench.add(Gate("solid 50x2 over TSM mixed 10, seconds", reference / beams, 40, at_least=True))


def equal_error(bench):
    """The cheapest solid over the cheapest beams at .1 % of the force, each against what it converges to."""
    with tempfile.TemporaryDirectory() as folder:
        assert main(["run", "trade", KS.name, "--quick", "--out", folder]) == 0
        rows = json.loads((Path(folder) / "trade.json").read_text())["cheapest"]
    for scope, state in (("end", "end state"), ("path", "50 load parameters")):
        found = next(
            row for row in rows if (row["scope"], row["quantity"], row["target"]) == (scope, "force", 1e-3)
        )
        bench.add(Gate(f"solid over TSM at .1 % of F, {state}, seconds", found["ratio"], 100, at_least=True))


def exact_elements(bench):
    """The exact element against `mixed`; the shortest of 15 repeats, which varies less than their median.

    End states are timed eight in a row: a short action meets fewer slow moments than the long one that it is compared with.
    """
    rod = solve(KS, "rod")

    def error(**options):
        response = solve(KS, "tsm", Options(**options))
        return max(difference(response, rod, KS, quantity) for quantity in ("force", "arc"))

    assert error(element="exact") <= 1e-8
    assert error(element="exact", integration_tolerance=1e-6) <= 1e-6
    elements = next(n for n in range(2, 100, 2) if error(elements=n) <= 1e-6)
    exact, ten, fine = (
        to_structure(KS, elements=1, element="exact"), to_structure(KS, elements=10), to_structure(KS, elements=elements),
    )  # fmt: skip
    loose = tsm.Settings(integration_tolerance=1e-6)
    path, end, path_loose, mixed, mixed_fine = bench.seconds(
        15,
        min,
        exact_path=lambda: tsm.solve(exact, T),
        exact_end_8_times=lambda: [tsm.solve(exact, T[-1:]) for _ in range(8)],
        exact_loose=lambda: tsm.solve(exact, T, loose),
        mixed_10_shortest=lambda: tsm.solve(ten, T),
        mixed_fine=lambda: tsm.solve(fine, T),
    )
    bench.add(Gate("exact 1 over mixed 10, seconds", path / mixed, 2.5))
    bench.add(Gate("exact 1, 50 load parameters over end state, seconds", 8 * path / end, 8, at_least=True))
    ratio = mixed_fine / path_loose
    bench.add(Gate(f"mixed {elements} over exact 1 at error 1e-6, seconds", ratio, 1, at_least=True))


def scenes(bench):
    """Double beam against KS."""
    both = load_scene("double-beam")
    one, two, depths = to_structure(KS, elements=20), to_structure(both, elements=10), np.array(both.times)
    single, double = bench.seconds(
        mixed_20_KS=lambda: tsm.solve(one, T), double_beam=lambda: tsm.solve(two, depths)
    )
    bench.add(Gate("double beam over KS with 20 elements, seconds", double / single, 4))


PEAK = """
import resource
import numpy as np
import fem_reference
from comparisons.scene import load_scene
from comparisons.models.solid import to_solid
fem_reference.solve(to_solid(load_scene("ks-cantilever"), mesh=(1000, 20)), np.array([0.02]))
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


def memory(bench):
    """Peak memory of one load parameter on 1000x20, 164,000 unknowns."""
    done = subprocess.run([sys.executable, "-c", PEAK], check=True, capture_output=True, text=True)
    bench.add(Gate("peak memory of 1000x20, GB", int(done.stdout) * 1024 / 1e9, 1.5))


def comparison(bench):
    """Seconds of `compare` over those that its models, certificates and the solutions of the budget take in it."""
    spent = []

    def timed(function):
        def run(*arguments):
            began = time.perf_counter()
            try:
                return function(*arguments)
            finally:
                spent.append(time.perf_counter() - began)

        return run

    def taken():
        spent.clear()
        began = time.perf_counter()
        with tempfile.TemporaryDirectory() as folder:
            compare.compare(KS, Path(folder), lambda _: None).write(Path(folder))
        return (time.perf_counter() - began) / sum(spent)

    with ExitStack() as patches:
        for module, name in ((compare, "solve"), (compare, "certified"), (budget, "solve")):
            patches.enter_context(patch.object(module, name, timed(getattr(module, name))))
        ratios = [taken() for _ in range(4)][1:]
    bench.add(Gate("compare ks-cantilever over its solutions", median(ratios), 2.0))


SOLVE = ["solve", "ks-cantilever", "--model", "tsm", "--elements", "10"]
CROSSVAL = "from comparisons.cli import main; import sys; sys.exit(main({}))"


def start_up(bench):
    """Processor time of processes from start to end, over that of ``import numpy``, bytecode compiled as an installation has it.

    The solution in ``crossval solve`` is the time that the command takes when it is repeated in one process. It is subtracted.
    """
    apart = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    with tempfile.TemporaryDirectory() as bytecode:

        def started(code):
            environment = {**apart, "PYTHONPYCACHEPREFIX": bytecode}
            return lambda: subprocess.run(
                [sys.executable, "-c", code], check=True, capture_output=True, env=environment
            )

        numpy, tsm_import, help_command, check, usual, whole = bench.seconds(
            9,
            clock=children,
            import_numpy=started("import numpy"),
            import_tsm=started("import tsm"),
            crossval_help=started(CROSSVAL.format(["--help"])),
            crossval_check=started(CROSSVAL.format(["check", "ks-cantilever"])),
            crossval_solve_as_it_is=started(CROSSVAL.format(["solve", "ks-cantilever"])),
            crossval_solve=started(CROSSVAL.format(SOLVE)),
        )
    with redirect_stdout(io.StringIO()):
        (solution,) = bench.seconds(clock=time.process_time, in_place=lambda: main(SOLVE))
    bench.add(Gate("import tsm over import numpy, processes", tsm_import / numpy, 2.5))
    bench.add(Gate("crossval --help over import numpy, processes", help_command / numpy, 1.5))
    bench.add(Gate("crossval check over crossval solve, processes", check / usual, 1.0))
    rest = (whole - solution) / numpy
    bench.add(Gate("crossval solve without its solution over import numpy", rest, 3))


PARTS = (beams_against_solid, equal_error, exact_elements, scenes, memory, comparison, start_up)

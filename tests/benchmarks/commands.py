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

from comparisons.cli import main
from comparisons.scene import load_scene
from comparisons.suite import budget
from comparisons.suites import compare
from tests.benchmarks.measure import Gate, children

KS = load_scene("ks-cantilever")
T = np.array(KS.times)


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
            compare.compare(KS, Path(folder), lambda _: None)
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

        numpy, tsm_import, help_command, whole = bench.seconds(
            9,
            clock=children,
            import_numpy=started("import numpy"),
            import_tsm=started("import tsm"),
            crossval_help=started(CROSSVAL.format(["--help"])),
            crossval_solve=started(CROSSVAL.format(SOLVE)),
        )
    with redirect_stdout(io.StringIO()):
        (solution,) = bench.seconds(clock=time.process_time, in_place=lambda: main(SOLVE))
    bench.add(Gate("import tsm over import numpy, processes", tsm_import / numpy, 2.5))
    bench.add(Gate("crossval --help over import numpy, processes", help_command / numpy, 1.5))
    rest = (whole - solution) / numpy
    bench.add(Gate("crossval solve without its solution over import numpy", rest, 3))


PARTS = (equal_error, comparison, start_up)

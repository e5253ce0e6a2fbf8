"""Ratios of the start of processes."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from typing import Any

from tests.benchmarks.measure import Gate, children, seconds

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

        numpy, tsm_import, help_command, whole = seconds(
            start("import numpy"),
            start("import tsm"),
            start(CROSSVAL.format(["--help"])),
            start(CROSSVAL.format(KS)),
            repeats=9,
            clock=children,
        )
        solution = float(output(IN_PLACE))
    times |= {
        "import numpy": numpy,
        "import tsm": tsm_import,
        "crossval --help": help_command,
        "crossval solve": whole,
    }
    times["solution in crossval solve"] = solution
    gates.append(Gate("import tsm over import numpy, processes", tsm_import / numpy, 2.5, False))
    gates.append(Gate("crossval --help over import numpy, processes", help_command / numpy, 1.5, False))
    gates.append(
        Gate("crossval solve without its solution over import numpy", (whole - solution) / numpy, 3, False)
    )

"""Measurement of one case of a study: its response and its cost."""

import json
import statistics
import subprocess
import sys
from dataclasses import dataclass, fields, replace
from importlib import import_module
from os import times
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import numpy as np

from comparisons.cases.case import Case
from comparisons.cases.memory import with_peak_memory
from comparisons.models import certified, find, solve
from comparisons.models.options import ModelError
from comparisons.output import plain
from comparisons.referee import Verdict
from comparisons.response import Response
from comparisons.response.axis import storable
from comparisons.response.file import as_dict, restated
from comparisons.scene import to_toml

REFUSED = "REFUSED"
REFUSALS = {verdict.name for verdict in Verdict} - {Verdict.CERTIFIED.name, Verdict.NOT_JUDGED.name}
"""Verdicts by which the referee refuses an answer."""
SLOW = 10.0
"""Time of a run [s] above which the first run is the measurement, without a warm-up."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Measurement:
    """Response and cost of one case.

    Attributes
    ----------
    response : Response
        Storable response, up to the last load parameter reached. Its status is ``REFUSED`` if the model cannot state the scene. It has no
        axes if no run is timed, and no wall time.
    seconds : float
        Processor time from the scene to the checked response without imports [s]: the median over `repeats` runs after a warm-up, nan if
        no run is timed. On one thread it equals the wall time on an idle core.
    repeats : int
        Number of timed runs; one, without a warm-up, where the first run took more than 10 s.
    peak_memory : int
        Largest rise of the process's resident memory over its start in the first run [byte].
    verdict : str
        Verdict of the certificate for the last load parameter and the neighbours of events. Empty if none was reached or no run is timed.
    process_seconds : float
        Processor time of a whole process of ``crossval solve`` without certificate [s]; nan if it was not asked for.
    """

    response: Response
    seconds: float = np.nan
    repeats: int = 0
    peak_memory: int = 0
    verdict: str = ""
    process_seconds: float = np.nan

    @classmethod
    def of(cls, response: Response) -> "Measurement":
        """Return a response that was not timed, with the verdict of its certificate."""
        return cls(response=response, verdict=_verdict(response))

    @property
    def wrong(self) -> bool:
        """Whether the model reported success and its answer was refused by the checks or the referee."""
        response = self.response
        return response.false_success or (response.reported_success and self.verdict in REFUSALS)

    def to_json(self, **case: object) -> str:
        """Return the measurement as JSON text, after what `case` tells; a number that is not finite is null."""
        numbers = {item.name: getattr(self, item.name) for item in fields(self) if item.name != "response"}
        return json.dumps(plain({**case, **numbers, "response": as_dict(self.response)}), allow_nan=False)

    @classmethod
    def from_json(cls, text: str) -> "Measurement":
        """Return the measurement that `to_json` wrote, every number the same."""
        data: dict[str, Any] = json.loads(text)
        numbers: dict[str, Any] = {
            item.name: data[item.name] for item in fields(cls) if item.name != "response"
        }
        numbers = {name: np.nan if value is None else value for name, value in numbers.items()}
        return cls(response=restated(data["response"]), **numbers)


def measure(case: Case, *, repeats: int = 3, process: bool = False) -> Measurement:
    """Solve `case` once to warm up, then `repeats` times with the clock on; if `repeats` is zero, the first time counts.

    With `process` a whole process of ``crossval solve`` is timed in addition.

    A solution that stops is measured like any other. A scene that the model refuses has the status ``REFUSED``. Neither raises.
    """
    for library in find(case.model).libraries:
        import_module(library)
    try:
        (response, first), peak = with_peak_memory(lambda: _timed(case))
    except ModelError as error:
        return unmeasured(REFUSED, str(error))
    seconds = [first] if first > SLOW or not repeats else [_timed(case)[1] for _ in range(repeats)]
    return Measurement(
        response=storable(replace(response, wall_seconds=np.nan), axes=repeats > 0),
        seconds=statistics.median(seconds),
        repeats=len(seconds),
        peak_memory=peak,
        verdict=_verdict(certified(response, case.scene)) if repeats else "",
        process_seconds=_process_seconds(case) if process else np.nan,
    )


def _process_seconds(case: Case) -> float:
    """Processor time of ``crossval solve`` in a process of its own [s]; nan where the system does not count it."""
    command = [sys.executable, "-c", "from comparisons.cli import main; main()", "solve"]
    words = ["--model", case.model, "--certify", "none", "--quiet"]
    for name, value in vars(case.options).items():
        if value is not None:
            text = "x".join(map(str, value)) if isinstance(value, tuple) else str(value)
            words += ["--" + name.replace("_", "-"), text]
    with TemporaryDirectory() as folder:
        file = Path(folder) / f"{case.scene.name}.toml"
        file.write_text(to_toml(case.scene), encoding="utf-8")
        before = times()
        subprocess.run([*command, str(file), *words], capture_output=True, check=False)  # noqa: S603 - this program
        after = times()
    spent = after.children_user + after.children_system - before.children_user - before.children_system
    return spent or np.nan


def _verdict(response: Response) -> str:
    return "" if response.certificate is None else response.certificate.verdict.name


def _timed(case: Case) -> tuple[Response, float]:
    began = _processor_seconds()
    response = solve(case.scene, case.model, case.options)
    return response, _processor_seconds() - began


def _processor_seconds() -> float:
    """Processor time of this process, and of child processes that have ended, which programs of others are [s]."""
    now = times()
    return process_time() + now.children_user + now.children_system


def unmeasured(status: str, message: str) -> Measurement:
    """Return the measurement of a case that gave neither answer nor cost, and why."""
    return Measurement(response=storable(Response(status=status, message=message)))

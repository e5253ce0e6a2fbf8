"""Rows: a case with its answer, what it cost, and its errors."""

import ctypes
import gc
import json
import statistics
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from importlib import import_module
from math import nan
from os import times
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import numpy as np

from comparisons.answer import Response
from comparisons.answer.axis import storable
from comparisons.answer.errors import Errors, errors
from comparisons.answer.file import as_dict, restated
from comparisons.frozen import Frozen
from comparisons.models import certified, solve
from comparisons.models.model import ModelError
from comparisons.models.shared import kept
from comparisons.output import plain
from comparisons.referee import Verdict
from comparisons.scene import to_toml
from comparisons.suite.case import Case

REFUSED = "REFUSED"
ACCEPTED = ("", Verdict.CERTIFIED.name, Verdict.NOT_JUDGED.name)
"""Verdicts by which the referee does not refuse an answer."""
SLOW = 10.0
"""Time of a run [s] above which the first run is the measurement, without a warm-up."""
STORED = "seconds repeats peak_memory verdict process_seconds"
"""What is kept of a row besides its answer."""


class Row(Frozen):
    """A case with its answer, its cost and its errors."""

    case: Case  #: What was solved.
    #: The answer, up to the last load parameter reached; ``REFUSED`` if the model cannot state the scene. That of `measure` is storable,
    #: has no wall time, and has no axes if no run is timed.
    response: Response
    #: Processor time from the scene to the checked response without imports [s]: the median over `repeats` runs after a warm-up, nan if no
    #: run is timed. On one thread it is the wall time on an idle core.
    seconds: float = nan
    #: Number of timed runs; one, without a warm-up, where the first run took more than 10 s.
    repeats: int = 0
    #: Largest rise of the process's resident memory in the first run [byte]; zero but on Linux.
    peak_memory: int = 0
    #: Verdict of the certificate for the last load parameter and the neighbours of events; empty if none was reached or no run is timed.
    verdict: str = ""
    process_seconds: float = nan  #: Processor time of a process of ``crossval solve`` without certificate [s]; nan if not asked for.
    errors: Errors | None = None  #: By scope and quantity, against the reference, which has none.
    own_errors: Errors | None = None  #: Against the model's limit.
    name: str = ""  #: Label of the run, if not that of the case.
    #: Largest part of the error that theory allows the model; empty where theory has no estimate.
    cause: str = ""

    @property
    def label(self) -> str:
        """Label of the run."""
        return self.name or self.case.label

    @property
    def family(self) -> str:
        """What the runs that differ in resolution only share."""
        return self.case.family

    @property
    def resolution(self) -> float:
        """Number of elements along a beam; nan without a mesh, or where the scene gives the number."""
        return self.case.resolution

    @property
    def stable(self) -> str:
        """Yes, no, a dash where no index is stated, or that it is at a part of the load parameters."""
        index = self.response.index
        if index is None or not np.any(index >= 0):
            return "-"
        return "no" if np.any(index > 0) else "yes" if np.all(index >= 0) else "in part"

    @property
    def wrong(self) -> bool:
        """Whether the model reported success and its answer was refused by the checks or the referee."""
        response = self.response
        return response.false_success or (response.reported_success and self.verdict not in ACCEPTED)

    @property
    def outcome(self) -> str:
        """``certified``, ``wrong`` for a refused answer that was reported as a success, or a stop's status."""
        if self.wrong:
            return "wrong"
        if not self.response.completed:
            return self.response.status
        return self.verdict.lower().replace("_", " ") or "no verdict"

    def against(self, reference: Response, quantities: Sequence[str]) -> "Row":
        """Return the row with its errors as far as both answers came; of ``end`` at the reference's last state."""
        scene = self.case.scene
        return replace(
            self, errors=errors(self.response, reference, scene, quantities=quantities, whole=False)
        )

    def error(self, scope: str, quantity: str, *, own: bool = False) -> float:
        """Return an error against the reference, or against the model's limit; nan where it is not known."""
        errors = self.own_errors if own else self.errors
        return nan if errors is None else errors[scope][quantity]

    def spent(self, cost: str) -> float:
        """Return the ``seconds``, the ``iterations`` or the ``unknowns``."""
        return float(getattr(self if cost == "seconds" else self.response, cost))

    def columns(self) -> dict[str, Any]:
        """Return the run as a line of a table: what it is, how it ended, what it cost, and all errors that are known."""
        of, response = self.case, self.response
        errors = {"error": self.errors, "own_error": self.own_errors}
        return {
            "scene": of.scene.name,
            "model": of.found.name,
            "family": self.family,
            "label": self.label,
            "outcome": self.outcome,
            "status": response.status,
            "verdict": self.verdict,
            "load_parameters_reached": len(response.load_parameter),
            **kept(response, "iterations cutbacks unknowns"),
            **kept(self, "seconds repeats peak_memory process_seconds"),
            **{
                f"{prefix}_{scope}_{name}": error
                for prefix, known in errors.items()
                for scope, table in (known or {}).items()
                for name, error in table.items()
            },
            "message": response.message,
        }

    def to_json(self) -> str:
        """Return what was measured as JSON text, after what the case is; null for what is not finite."""
        data = {**self.case.description, **kept(self, STORED), "response": as_dict(self.response)}
        return json.dumps(plain(data), allow_nan=False)

    @classmethod
    def from_json(cls, case: Case, text: str) -> "Row":
        """Return the row that `to_json` wrote, every number the same."""
        data: dict[str, Any] = json.loads(text)
        numbers: dict[str, Any] = {name: nan if data[name] is None else data[name] for name in STORED.split()}
        return cls(case=case, response=restated(data["response"]), **numbers)


def measure(case: Case, *, repeats: int = 3, process: bool = False) -> Row:
    """Solve `case` once to warm up, then `repeats` times with the clock on; if `repeats` is zero, the first time counts.

    With `process` a whole process of ``crossval solve`` is timed in addition.

    A solution that stops is measured like any other. A scene that the model refuses has the status ``REFUSED``. Neither raises.
    """
    for library in case.found.libraries:
        import_module(library)
    try:
        response, first, peak = _with_peak_memory(case)
    except ModelError as error:
        return unmeasured(case, REFUSED, str(error))
    seconds = [first] if first > SLOW or not repeats else [_timed(case)[1] for _ in range(repeats)]
    return Row(
        case=case,
        response=storable(replace(response, wall_seconds=nan), axes=repeats > 0),
        seconds=statistics.median(seconds),
        repeats=len(seconds),
        peak_memory=peak,
        verdict=verdict(certified(response, case.scene)) if repeats else "",
        process_seconds=_process_seconds(case) if process else nan,
    )


def _process_seconds(case: Case) -> float:
    """Processor time of ``crossval solve`` in a process of its own [s]; nan where the system does not count it."""
    command = [sys.executable, "-c", "from comparisons.cli import main; main()", "solve"]
    words = ["--model", case.model, "--certify", "none", "--quiet"]
    for name, value in case.given.items():
        text = "x".join(map(str, value)) if isinstance(value, tuple) else str(value)
        words += ["--" + name.replace("_", "-"), text]
    with TemporaryDirectory() as folder:
        file = Path(folder) / f"{case.scene.name}.toml"
        file.write_text(to_toml(case.scene), encoding="utf-8")
        before = _children_seconds()
        subprocess.run([*command, str(file), *words], capture_output=True, check=False)  # noqa: S603 - this program
        return _children_seconds() - before or nan


def verdict(response: Response) -> str:
    """Return the verdict of an answer's certificate; empty without one."""
    return "" if response.certificate is None else response.certificate.verdict.name


def _timed(case: Case) -> tuple[Response, float]:
    # programs of others are child processes
    began = process_time() + _children_seconds()
    response = solve(case.scene, case.model, case.options)
    return response, process_time() + _children_seconds() - began


def _children_seconds() -> float:
    """Processor time of child processes that have ended [s]."""
    now = times()
    return now.children_user + now.children_system


def _with_peak_memory(case: Case) -> tuple[Response, float, int]:
    """Return the response, its seconds, and by how many bytes the memory rose: Linux can reset its peak."""
    gc.collect()
    with suppress(AttributeError, TypeError):  # not every C library can give freed memory back to the system
        ctypes.CDLL(None).malloc_trim(0)
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        return *_timed(case), 0
    start = _kibibytes("VmRSS")
    return *_timed(case), 1024 * max(_kibibytes("VmHWM") - start, 0)


def _kibibytes(field: str) -> int:
    """Return a field of the process's status."""
    values = dict(line.split(":", 1) for line in Path("/proc/self/status").read_text().splitlines())
    return int(values[field].split()[0])


def unmeasured(case: Case, status: str, message: str) -> Row:
    """Return the row of a case that gave neither answer nor cost, and why."""
    return Row(case=case, response=storable(Response(status=status, message=message)))

"""Measurement of one case of a study: its response and its cost."""

import json
import statistics
from dataclasses import dataclass, replace
from importlib import import_module
from os import times
from time import process_time

import numpy as np

from comparisons.cases.case import Case
from comparisons.cases.memory import with_peak_memory
from comparisons.models import certified, find, solve
from comparisons.models.options import ModelError
from comparisons.output import plain
from comparisons.response import Response
from comparisons.response.axis import storable
from comparisons.response.from_json import restated
from comparisons.response.record import unanswered
from comparisons.response.to_json import as_dict

REFUSED = "REFUSED"
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
        no run is timed. On one thread it equals the wall time on an idle core, and other programs do not lengthen it.
    repeats : int
        Number of timed runs; one, without a warm-up, where the first run took more than 10 s.
    peak_memory : int
        Largest rise of the process's resident memory over its start in the first run, interpreter and libraries left out [byte].
    verdict : str
        Verdict of the certificate for the last load parameter and the neighbours of events, ``CERTIFIED`` or another. It is empty if no
        load parameter was reached or no run is timed.
    """

    response: Response
    seconds: float = np.nan
    repeats: int = 0
    peak_memory: int = 0
    verdict: str = ""

    def to_json(self) -> str:
        """Return the measurement as JSON text; a number that is not finite is null."""
        cost = {name: getattr(self, name) for name in ("seconds", "repeats", "peak_memory", "verdict")}
        return json.dumps(plain({**cost, "response": as_dict(self.response)}), allow_nan=False)

    @classmethod
    def from_json(cls, text: str) -> "Measurement":
        """Return the measurement that `to_json` wrote, every number the same."""
        data = json.loads(text)
        seconds = np.nan if data["seconds"] is None else data["seconds"]
        return cls(**{**data, "seconds": seconds, "response": restated(data["response"])})


def measure(case: Case, *, repeats: int = 3) -> Measurement:
    """Solve `case` once to warm up, then `repeats` times with the clock on; if `repeats` is zero, the first time counts.

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
        verdict=_verdict(response, case) if repeats else "",
    )


def _verdict(response: Response, case: Case) -> str:
    found = certified(response, case.scene).certificate
    return "" if found is None else found.verdict.name


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
    return Measurement(response=storable(unanswered(status, message)))

"""What one case of a sweep measures: its answer and its cost."""

import json
import statistics
from dataclasses import dataclass, fields
from importlib import import_module
from time import process_time
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from comparisons.cases.case import Case
from comparisons.cases.memory import with_peak_memory
from comparisons.models import MODELS, certified, solve
from comparisons.models.options import ModelError
from comparisons.output import plain
from comparisons.response import Array, Response

REFUSED = "REFUSED"
SLOW = 10.0
"""Seconds from which one run is both warm-up and measurement."""
STATIONS = 101
"""Points of a deflected axis, at equal distances along the undeformed one."""
TAILS = {"support_force": (2,), "other_end_force": (2,), "tip": (2,), "shape": (STATIONS, 2)}
"""Shape of one row of the tables that are not of numbers, which an empty table has lost in JSON."""
SHAPES_AT = (0.2, 0.4, 0.6, 0.8)
"""Load parameters, besides the last, whose axes are kept where the case has them."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Measurement:
    """Answer and cost of one case; what it did not reach is missing from the histories.

    Attributes
    ----------
    status, message : str
        How the solution ended: a name and its sentence; ``REFUSED`` if the model cannot state the case.
    completed : bool
        Whether it is complete and checked.
    verdict : str
        Verdict of the certificate of the last load parameter and of those beside events, ``CERTIFIED`` or another; empty where nothing was
        reached, or no run is timed.
    seconds : float
        Processor time from the scene to the checked response, imports left out, median over `repeats` runs after a warm-up; nan if there is
        none. On one thread it is the time on the clock of a core that does nothing else, and it is not lengthened by what else
        the machine does.
    repeats : int
        Runs timed: one, and no warm-up, where the first took more than 10 s.
    iterations, cutbacks, unknowns : int
        Newton iterations of the whole path, rejected steps, size of the system of equations.
    peak_memory : int
        Largest rise of the process's resident memory over its start in the first run, interpreter and libraries left out [byte].
    load_parameter : ndarray, shape (s,)
        The accepted load parameters.
    force, arc_position : dict of ndarray, shape (s,)
        By contact pair; arc position nan where open.
    support_force, other_end_force : dict of ndarray, shape (s, 2)
        Force of a beam's support, and of the one at its other end, by beam.
    moment : dict of ndarray, shape (s,)
        Moment of a beam's support.
    tip : dict of ndarray, shape (s, 2)
        Positions of the beams' less held ends.
    shape_at : ndarray, shape (m,)
        Load parameters of `shape`: the last one, and .2, .4, .6, .8 where they are among the case's.
    shape : dict of ndarray, shape (m, 101, 2)
        Deformed axes by beam, at equal distances along the undeformed axis (cubic splines through the model's points).
    """

    status: str
    message: str
    completed: bool
    seconds: float
    repeats: int
    iterations: int
    cutbacks: int
    unknowns: int
    peak_memory: int
    load_parameter: Array
    force: dict[str, Array]
    arc_position: dict[str, Array]
    support_force: dict[str, Array]
    other_end_force: dict[str, Array]
    moment: dict[str, Array]
    tip: dict[str, Array]
    shape_at: Array
    shape: dict[str, Array]
    verdict: str = ""

    def to_json(self) -> str:
        """Return the measurement as JSON text; a number that is not finite is null."""
        return json.dumps(plain(self), allow_nan=False)

    @classmethod
    def from_json(cls, text: str) -> "Measurement":
        """Return the measurement that `to_json` wrote, every number the same; older versions wrote no verdict."""
        data = {"verdict": ""} | json.loads(text)
        return cls(**{item.name: _restored(item.name, item.type, data[item.name]) for item in fields(cls)})


def measure(case: Case, *, repeats: int = 3) -> Measurement:
    """Solve `case` once to warm up, then `repeats` times with the clock on; if `repeats` is zero, the first time counts.

    A solution that stops is measured like any other, a scene that the model refuses has the status ``REFUSED``: nothing is raised
    for either.
    """
    for library in MODELS[case.model].libraries:
        import_module(library)
    try:
        (response, first), peak = with_peak_memory(lambda: _timed(case))
    except ModelError as error:
        return unmeasured(REFUSED, str(error))
    seconds = [first] if first > SLOW or not repeats else [_timed(case)[1] for _ in range(repeats)]
    return Measurement(
        status=response.status,
        message=response.message,
        completed=response.completed,
        seconds=statistics.median(seconds),
        repeats=len(seconds),
        iterations=int(response.newton_iterations.sum()),
        cutbacks=response.cutbacks,
        unknowns=response.unknowns,
        peak_memory=peak,
        verdict=_verdict(response, case) if repeats else "",
        **_histories(response, case),
    )


def _verdict(response: Response, case: Case) -> str:
    found = certified(response, case.scene).certificate
    return "" if found is None else found.verdict.name


def _timed(case: Case) -> tuple[Response, float]:
    began = process_time()
    response = solve(case.scene, case.model, case.options)
    return response, process_time() - began


def _histories(response: Response, case: Case) -> dict[str, Any]:
    supports = response.supports
    kept = _kept(response.load_parameter)
    return {
        "load_parameter": response.load_parameter,
        "force": {pair: contact.force for pair, contact in response.contacts.items()},
        "arc_position": {pair: contact.arc_position for pair, contact in response.contacts.items()},
        "support_force": {beam: support.force for beam, support in supports.items()},
        "other_end_force": {
            beam: support.other_end.force
            for beam, support in supports.items()
            if support.other_end is not None
        },
        "moment": {beam: support.moment for beam, support in supports.items()},
        "tip": response.tips,
        "shape_at": response.load_parameter[kept],
        "shape": {
            beam.name: np.array([_axis(response, beam.name, k) for k in kept]).reshape(-1, STATIONS, 2)
            for beam in case.scene.beams
        },
    }


def _kept(load_parameter: Array) -> list[int]:
    """Return the numbers of the load parameters whose axes are kept."""
    wanted = [int(k) for t in SHAPES_AT for k in np.flatnonzero(np.abs(load_parameter - t) < 1e-12)]
    return sorted({*wanted, len(load_parameter) - 1}) if len(load_parameter) else []


def _axis(response: Response, beam: str, k: int) -> Array:
    arc, line = response.axis_line(beam, k)
    parts = (arc - arc[0]) / (arc[-1] - arc[0])
    return np.asarray(CubicSpline(parts, line)(np.linspace(0.0, 1.0, STATIONS)))


def unmeasured(status: str, message: str) -> Measurement:
    """Return the measurement of a case that gave neither answer nor cost, and why."""
    empty: dict[str, Any] = {
        **dict.fromkeys(("repeats", "iterations", "cutbacks", "unknowns", "peak_memory"), 0),
        **{item.name: np.empty(0) for item in fields(Measurement) if item.type == Array},
        **{item.name: {} for item in fields(Measurement) if item.type == dict[str, Array]},
    }
    return Measurement(status=status, message=message, completed=False, seconds=np.nan, **empty)


def _restored(name: str, kind: Any, value: Any) -> Any:
    """Return a value of JSON as the field `name` of the type `kind` holds it."""
    if kind == Array:
        return np.array(value, dtype=np.float64)
    if kind == dict[str, Array]:
        shape = (-1, *TAILS.get(name, ()))
        return {key: np.array(table, dtype=np.float64).reshape(shape) for key, table in value.items()}
    return np.nan if value is None else value

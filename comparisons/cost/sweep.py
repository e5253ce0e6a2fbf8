"""The trade-off of a scene: run every setting, state its errors, write tables and diagrams."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import nan
from pathlib import Path

from comparisons.cases import Case
from comparisons.cases.run import Progress, run
from comparisons.cases.workers import Workers
from comparisons.cost.cases import meshed, sweep_cases
from comparisons.cost.orders import orders
from comparisons.cost.plots import plot_all
from comparisons.cost.points import COSTS, Point, Trade, front
from comparisons.cost.references import (
    Measured,
    best_reference,
    reference_cases,
    solid_limit,
)
from comparisons.cost.report import write_trade_page
from comparisons.cost.tables import cheapest_rows, setting_rows
from comparisons.files import writable_folder
from comparisons.models import MODELS
from comparisons.output import Row, write_numbers, write_rows
from comparisons.quantities import KEPT, SCOPES
from comparisons.scene import Scene, to_toml

Runner = Callable[[Sequence[Case]], Measured]
"""Measures cases."""
UNKNOWN = {scope: dict.fromkeys(KEPT, nan) for scope in SCOPES}
SHOWN = "force"
"""The quantity of the diagrams, and of the tables for people; the files have all."""


@dataclass(frozen=True, kw_only=True)
class Written:
    """A trade-off, and the files that hold it."""

    trade: Trade
    files: list[Path]


def trade_off(
    scene: Scene, folder: Path, workers: Workers, *, quick: bool = False, progress: Progress = lambda _: None
) -> Written:
    """Measure the trade-off of `scene` and write it to `folder`; what its folder ``results`` has of this version is not run again.

    Parameters
    ----------
    scene : Scene
        The scene.
    folder : Path
        Made if it is not there.
    workers : Workers
        Where cases run.
    quick : bool
        Fewer settings.
    progress : callable
        Receives the progress.

    Raises
    ------
    OutputError
        If `folder` cannot be written; nothing is computed.
    NoReferenceError
        If there is nothing to measure errors against.
    """
    results = writable_folder(folder, "report.html", "trade.csv", "trade.json") / "results"
    trade = measure_trade(
        scene, partial(run, folder=results, workers=workers, progress=progress), quick=quick
    )
    return Written(trade=trade, files=write_trade(trade, folder))


def measure_trade(scene: Scene, run: Runner, *, quick: bool = False) -> Trade:
    """Run every setting of `scene` and state its errors.

    Raises
    ------
    NoReferenceError
        If there is nothing to measure errors against.
    """
    cases = list(dict.fromkeys([*reference_cases(scene), *sweep_cases(scene, quick=quick)]))
    measured = run(cases)
    reference = best_reference(scene, measured)
    limit = solid_limit(scene, measured, quick=quick)
    points = []
    for case in cases:
        errors = reference.errors(measured[case])
        own = (
            errors
            if not MODELS[case.model].continuum
            else UNKNOWN
            if limit is None
            else limit.errors(measured[case])
        )
        points.append(Point(case=case, measured=measured[case], errors=errors, own_errors=own))
    return Trade(scene=scene, points=points, reference=reference, limit=limit)


def write_trade(trade: Trade, folder: Path) -> list[Path]:
    """Write the tables and diagrams; return the files."""
    fitted = {quantity: list(orders(trade, quantity)) for quantity in KEPT}
    numbers = {
        "scene": trade.scene.name,
        "scene_file": to_toml(trade.scene),
        "references": {
            name: known and {"is": known.sentence, "end": known.end, "uncertainty": known.uncertainty}
            for name, known in (("error", trade.reference), ("own_error of the solid", trade.limit))
        },
        "cheapest": cheapest_rows(trade),
        "orders": fitted,
        "pareto": _fronts(trade),
    }
    tables: dict[str, list[Row]] = {
        "trade.csv": setting_rows(trade),
        "cheapest.csv": cheapest_rows(trade),
        "orders.csv": [{"quantity": name, **row} for name, rows in fitted.items() for row in rows],
    }
    files = [write_rows(folder / name, rows) for name, rows in tables.items() if rows]
    files.append(write_numbers(folder / "trade.json", numbers))
    files += plot_all(trade, SHOWN, folder, SCOPES)
    return [write_trade_page(trade, fitted[SHOWN], SHOWN, files, folder), *files]


def _fronts(trade: Trade) -> list[Row]:
    """Return the points of the Pareto fronts."""
    return [
        {
            "model": model,
            "scope": scope,
            "quantity": quantity,
            "cost": cost,
            "label": one.point.case.label,
            "load_steps": one.point.case.scene.load_parameters,
            "spent": one.cost,
            "own_error": one.error,
        }
        for model in meshed()
        for scope in SCOPES
        for quantity in KEPT
        for cost in COSTS
        for one in front(trade, model, scope, quantity, cost)
    ]

"""The trade-off of a scene: cost and errors of every setting, the cheapest ones, fronts and orders."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import nan
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from comparisons.frozen import Frozen
from comparisons.models import MODELS, SOLID, TSM
from comparisons.output import Row as Line
from comparisons.scene import Scene
from comparisons.suite import Row
from comparisons.suite.progress import Runner
from comparisons.suites.trade.cases import (
    Reference,
    best_reference,
    chains,
    reference_cases,
    solid_limit,
    sweep_cases,
)

FEWEST, MOST = 3, 4
"""Points of a fit."""
STEADY = 0.9
"""A local order below this part of the median is not the order of the family."""


def pareto(cost: ArrayLike, error: ArrayLike) -> list[int]:
    """Return the numbers of the points that no other beats in both, by rising cost; a point with a nan is none of them.

    Examples
    --------
    >>> pareto([1, 2, 3, 4], [0.5, 0.7, 0.1, 0.1])
    [0, 2]
    """
    costs, errors = np.asarray(cost, dtype=float), np.asarray(error, dtype=float)
    rising = np.lexsort((errors, costs))
    rising = rising[np.isfinite(costs[rising]) & np.isfinite(errors[rising])]
    before = np.minimum.accumulate(np.append(np.inf, errors[rising]))
    return [int(k) for k in rising[errors[rising] < before[:-1]]]


class Fit(NamedTuple):
    """A power law ``y ~ x^exponent`` from x = first to last; scatter is the largest ``|ln y - ln y_fit|``."""

    exponent: float | None = None
    points: int = 0
    first: float | None = None
    last: float | None = None
    scatter: float | None = None


def power_law(x: Sequence[float], y: Sequence[float]) -> Fit:
    """Return the power law through the points, without an exponent if they are fewer than three or not positive."""
    if len(x) < FEWEST or not (min(x) > 0.0 and min(y) > 0.0):
        return Fit()
    lx, ly = np.log(x), np.log(y)
    exponent, constant = np.polyfit(lx, ly, 1)
    scatter = float(np.abs(ly - exponent * lx - constant).max())
    return Fit(float(exponent), len(x), float(min(x)), float(max(x)), scatter)


def convergence(resolution: Sequence[float], error: Sequence[float], floor: float) -> Fit:
    """Return the power law of an error over rising resolution in its asymptotic range."""
    # it is the longest run of meshes, before the first error below the floor, whose local orders are at least
    # nine tenths of the median positive one: neither chance on coarse meshes nor round-off on fine ones
    x, y = np.asarray(resolution, dtype=float), np.asarray(error, dtype=float)
    above = np.logical_and.accumulate(y > floor)
    x, y = x[above], y[above]
    local = -np.diff(np.log(y)) / np.diff(np.log(x))
    if not (local > 0.0).any():
        return Fit()
    falling = np.flatnonzero(local >= STEADY * np.median(local[local > 0.0]))
    run = max(reversed(np.split(falling, np.flatnonzero(np.diff(falling) > 1) + 1)), key=len)
    chosen = slice(max(run[0], run[-1] + 2 - MOST), run[-1] + 2)
    return power_law(list(x[chosen]), list(y[chosen]))


TARGETS = (5e-2, 1e-2, 1e-3, 1e-4, 1e-5)
COSTS = ("seconds", "iterations", "unknowns")
MESHED = tuple(model.name for model in MODELS.values() if model.meshed)
"""The models that have a Pareto front."""
THERE = "solid_against_reference"
"""The solid whose error against the reference counts, too."""
LARGEST = 4
"""Number of the largest settings of a family to which the cost exponent is fitted; the cost of small settings does not depend on size."""
ABOVE = 3.0
"""Least error in a fit, over the uncertainty of the reference."""


class Trade(Frozen):
    """The sweep: rows with errors against the reference, and against the limit of their model if known."""

    scene: Scene
    rows: list[Row]
    reference: Reference
    limit: Reference | None

    def uncertainty(self, model: str, scope: str, quantity: str) -> float:
        """Return the uncertainty of a model's limit; nan if the limit is not known."""
        known = self.limit if MODELS[model].continuum else self.reference
        return nan if known is None else known.uncertainty[scope][quantity]

    def of_model(self, model: str, scope: str) -> list[Row]:
        """Return the completed rows of a model; for the scope ``path`` those with every load parameter of the scene."""
        rows = [row for row in self.rows if row.response.completed and row.case.model == model]
        every = self.scene.load_parameters
        return [row for row in rows if scope == "end" or row.case.scene.load_parameters == every]


def measure_trade(scene: Scene, run: Runner, *, quick: bool) -> Trade:
    """Measure every setting of `scene` and state its errors; nothing to measure them against is a `NoReferenceError`."""
    measured = run([*reference_cases(scene), *sweep_cases(scene, quick=quick)])
    reference = best_reference(scene, measured)
    limit = solid_limit(scene, measured, quick=quick)
    rows = []
    for case, row in measured.items():
        own = limit if case.found.continuum else reference
        own_errors = None if own is None else own.errors(row.response, scene)
        rows.append(replace(row, errors=reference.errors(row.response, scene), own_errors=own_errors))
    return Trade(scene=scene, rows=rows, reference=reference, limit=limit)


def short(row: Row) -> str:
    """Return a setting in a few words, its load steps in brackets."""
    setting = row.label.partition(" ")[2] or row.label
    return f"{setting.replace('tolerance', 'tol')} [{row.case.scene.load_parameters}]"


def front(trade: Trade, model: str, scope: str, quantity: str, cost: str) -> list[Line]:
    """Return the Pareto front of a model against its limit, known no better than its uncertainty; for `THERE`, also against the reference."""
    name, own = (SOLID.name, False) if model == THERE else (model, True)
    rows, doubt = trade.of_model(name, scope), trade.uncertainty(name, scope, quantity)
    costs = [row.spent(cost) for row in rows]
    # the larger error counts: on a coarse mesh, discretisation and model error may cancel
    known = [[row.error(scope, quantity, own=one) for row in rows] for one in (True, own)]
    errors = np.maximum(known[0], doubt) if own else np.fmax(known[0], known[1])
    of = {"model": model, "scope": scope, "quantity": quantity, "cost": cost}
    return [
        {**of, "setting": short(rows[k]), "spent": costs[k], "own_error": float(errors[k])}
        for k in pareto(costs, errors)
    ]


def cheapest(trade: Trade, scope: str, quantity: str, target: float) -> Line:
    """Return the settings with the least seconds for an error of `target`, and their ratios to TSM's."""
    doubt = trade.uncertainty(SOLID.name, scope, quantity)
    line: Line = {"scope": scope, "quantity": quantity, "target": target, "limit_uncertainty": doubt}
    for model, ratio in ((TSM.name, ""), (SOLID.name, "ratio"), (THERE, "ratio_against_reference")):
        points = front(trade, model, scope, quantity, COSTS[0])
        least = next((point for point in points if point["own_error"] <= target), None)
        line |= {model: least and least["setting"], f"{model}_seconds": least and least["spent"]}
        if ratio:
            fast = line[f"{TSM.name}_seconds"]
            line[ratio] = least["spent"] / fast if least and fast else None
    return line


def orders(trade: Trade, quantity: str) -> Iterator[Line]:
    """Yield a row per family: ``error ~ n^-order`` over the path, ``seconds ~ unknowns^cost_exponent``."""
    rows = {row.case: row for model in MESHED for row in trade.of_model(model, "path")}
    for chain in chains(rows):
        case, known = chain[0], [rows[one] for one in chain]
        floor = ABOVE * trade.uncertainty(case.model, "path", quantity)
        errors = [row.error("path", quantity, own=True) for row in known]
        order = convergence([row.resolution for row in known], errors, floor)
        costs = ([row.spent(cost) for row in known[-LARGEST:]] for cost in ("unknowns", "seconds"))
        given = [contact for contact in case.scene.contacts if contact.penetration is not None]
        yield {
            "family": case.family + (f", penetration {given[0].penetration:g}" if given else ""),
            "settings": len(chain),
            "order": None if order.exponent is None else -order.exponent,
            **_range("order", order),
            "cost_exponent": (cost := power_law(*costs)).exponent,
            **_range("cost_exponent", cost),
        }


def _range(name: str, fit: Fit) -> Line:
    columns = (f"{name}_{key}" for key in ("points", "from", "to", "scatter"))
    return dict(zip(columns, fit[1:], strict=True))

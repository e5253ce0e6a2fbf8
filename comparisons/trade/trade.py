"""The trade-off of a scene: every setting with its cost and errors, the cheapest for an accuracy, fronts and orders."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import isfinite, nan
from typing import NamedTuple

from comparisons.cases import Case, Row
from comparisons.models import MODELS, SOLID, TSM
from comparisons.scene import Scene
from comparisons.trade.fits import Fit, convergence, pareto, power_law
from comparisons.trade.reference import (
    Measured,
    Reference,
    best_reference,
    reference_cases,
    solid_limit,
)
from comparisons.trade.settings import refined, sweep_cases

TARGETS = (5e-2, 1e-2, 1e-3, 1e-4, 1e-5)
COSTS = ("seconds", "iterations", "unknowns")
MESHED = tuple(model.name for model in MODELS.values() if model.meshed)
"""The models that have a Pareto front."""
LARGEST = 4
"""Number of the largest settings of a family to which the cost exponent is fitted; the cost of small settings does not depend on size."""
ABOVE = 3.0
"""Least error in a fit, over the uncertainty of the reference."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Trade:
    """The whole sweep.

    Attributes
    ----------
    scene : Scene
        The scene.
    rows : list of Row
        All cases, those that stopped too. The solid has a limit of its own, that of all other models is the reference.
    reference : Reference
        What errors are against.
    limit : Reference or None
        The solid's own limit, None if it is not known.
    """

    scene: Scene
    rows: list[Row]
    reference: Reference
    limit: Reference | None

    def uncertainty(self, model: str, scope: str, quantity: str) -> float:
        """Return the uncertainty of a model's limit; nan if the limit is not known."""
        known = self.limit if MODELS[model].continuum else self.reference
        return nan if known is None else known.uncertainty[scope][quantity]

    @property
    def stopped(self) -> list[Row]:
        """The cases without a completed and checked solution."""
        return [row for row in self.rows if not row.response.completed]

    def of_model(self, model: str, scope: str) -> list[Row]:
        """Return the completed rows of a model; for the scope ``path`` those with every load parameter of the scene."""
        return [
            row
            for row in self.rows
            if row.response.completed
            and row.case.model == model
            and (scope == "end" or row.case.scene.load_parameters == self.scene.load_parameters)
        ]


def measure_trade(scene: Scene, run: Callable[[list[Case]], Measured], *, quick: bool = False) -> Trade:
    """Measure every setting of `scene` with `run` and state its errors.

    Raises
    ------
    NoReferenceError
        If there is nothing to measure errors against.
    """
    cases = list(dict.fromkeys([*reference_cases(scene), *sweep_cases(scene, quick=quick)]))
    measured = run(cases)
    reference = best_reference(scene, measured)
    limit = solid_limit(scene, measured, quick=quick)
    rows = []
    for case in cases:
        response = measured[case].response
        own = limit if case.found.continuum else reference
        rows.append(
            Row(
                case=case,
                measured=measured[case],
                errors=reference.errors(response),
                own_errors=None if own is None else own.errors(response),
            )
        )
    return Trade(scene=scene, rows=rows, reference=reference, limit=limit)


class Cheapest(NamedTuple):
    """The settings with the least seconds for an accuracy; None if no setting reaches it.

    The error of `solid` is measured against the solid's limit, that of `solid_against_reference` against the reference; `untold` says
    that the solid's limit is known less well than the target.
    """

    target: float
    tsm: Row | None
    solid: Row | None
    solid_against_reference: Row | None
    untold: bool

    def ratio(self, *, reference: bool = False) -> float:
        """Return the seconds of the solid over those of the beams, with errors against each model's limit, or both against the reference."""
        slow = self.solid_against_reference if reference else self.solid
        return nan if slow is None or self.tsm is None else slow.measured.seconds / self.tsm.measured.seconds


def cheapest(trade: Trade, scope: str, quantity: str, target: float) -> Cheapest:
    """Return the cheapest settings of TSM and of the solid with an error of at most `target`."""

    def least(model: str, error: Callable[[Row], float]) -> Row | None:
        good = (row for row in trade.of_model(model, scope) if error(row) <= target)
        return min(good, key=lambda row: row.measured.seconds, default=None)

    def against(row: Row) -> float:
        return row.error(scope, quantity)

    def own(row: Row) -> float:
        return row.error(scope, quantity, own=True)

    def by_no_chance(row: Row) -> float:
        # on a coarse mesh, discretisation and model error may cancel
        return max((error for error in (against(row), own(row)) if isfinite(error)), default=nan)

    untold = not trade.uncertainty(SOLID.name, scope, quantity) <= target
    return Cheapest(
        target,
        least(TSM.name, against),
        None if untold else least(SOLID.name, own),
        least(SOLID.name, by_no_chance),
        untold,
    )


class OnFront(NamedTuple):
    """A setting that no other of its model beats in both cost and error."""

    row: Row
    cost: float
    error: float


def front(trade: Trade, model: str, scope: str, quantity: str, cost: str) -> list[OnFront]:
    """Return the Pareto front of a model by rising cost, with errors against the model's limit.

    Errors below the uncertainty of the limit count as equal.
    """
    rows, doubt = trade.of_model(model, scope), trade.uncertainty(model, scope, quantity)
    costs = [row.spent(cost) for row in rows]
    errors = [max(row.error(scope, quantity, own=True), doubt) for row in rows]
    return [OnFront(rows[k], costs[k], errors[k]) for k in pareto(costs, errors)]


def orders(trade: Trade, quantity: str) -> Iterator[dict[str, object]]:
    """Yield a row for every family with all load steps: ``error ~ n^-order`` over the path, ``seconds ~ unknowns^cost_exponent``.

    An exponent is None where its asymptotic range has fewer than three points.
    """
    rows = {row.case: row for model in MESHED for row in trade.of_model(model, "path")}
    seen: set[Case] = set()
    for case in rows:
        members = refined(case, rows)
        if case in members and case not in seen and len(members) > 2:
            seen.update(members)
            yield _order(trade, [rows[member] for member in members], quantity)


def _order(trade: Trade, chain: Sequence[Row], quantity: str) -> dict[str, object]:
    case = chain[0].case
    doubt = trade.uncertainty(case.model, "path", quantity)
    sizes = [row.resolution for row in chain]
    errors = [row.error("path", quantity, own=True) for row in chain]
    order = convergence(sizes, errors, ABOVE * doubt) if isfinite(doubt) else None
    last = chain[-LARGEST:]
    given = [contact for contact in case.scene.contacts if contact.penetration is not None]
    return {
        "family": case.family + (f", penetration {given[0].penetration:g}" if given else ""),
        "settings": len(chain),
        **_stated("order", order, -1.0),
        **_stated(
            "cost_exponent",
            power_law(*([row.spent(cost) for row in last] for cost in ("unknowns", "seconds"))),
            1.0,
        ),
    }


def _stated(name: str, fit: Fit | None, sign: float) -> dict[str, object]:
    return {
        name: fit and sign * fit.exponent,
        f"{name}_points": fit.points if fit else 0,
        f"{name}_from": fit and fit.first,
        f"{name}_to": fit and fit.last,
        f"{name}_scatter": fit and fit.scatter,
    }

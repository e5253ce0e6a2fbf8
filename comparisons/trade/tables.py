"""The tables of a trade-off: every setting, the cheapest for an accuracy, the fronts, the orders; for files and for people."""

from collections.abc import Mapping
from math import isfinite
from typing import Any

from comparisons.cases import Row
from comparisons.models import SOLID, TSM
from comparisons.output import tabulated
from comparisons.quantities import KEPT, SCOPES
from comparisons.trade.trade import COSTS, MESHED, TARGETS, Cheapest, Trade, cheapest, front, orders

Table = list[dict[str, Any]]
SHOWN = "force"
"""The quantity of the diagrams, and of the tables for people; the files have all."""


def setting_rows(trade: Trade) -> Table:
    """Return a row for every setting, those that stopped too: what it is, what it cost, all its errors."""
    return [_setting(row) for row in trade.rows]


def _setting(row: Row) -> dict[str, Any]:
    case, response = row.case, row.response
    contact = case.scene.contacts[0] if case.scene.contacts and case.found.continuum else None
    return {
        "label": row.label,
        "family": row.family,
        "model": case.model,
        "elements": case.options.elements,
        "mesh": case.options.mesh and "x".join(map(str, case.options.mesh)),
        "integration_tolerance": case.options.integration_tolerance,
        "penalty": contact and contact.penalty,
        "penetration": contact and contact.penetration,
        "load_steps": case.scene.load_parameters,
        "load_parameters_reached": len(response.load_parameter),
        "status": response.status,
        "message": response.message,
        **row.cost(),
        **{
            f"{'own_' * own}error_{scope}_{quantity}": row.error(scope, quantity, own=own)
            for own in (False, True)
            for scope in SCOPES
            for quantity in KEPT
        },
    }


def cheapest_rows(trade: Trade) -> Table:
    """Return the cheapest settings for every scope, quantity and target that the reference can tell."""
    return [
        _cheapest(trade, scope, quantity, cheapest(trade, scope, quantity, target))
        for scope in SCOPES
        for quantity in KEPT
        if isfinite(trade.reference.uncertainty[scope][quantity])
        for target in TARGETS
    ]


def _cheapest(trade: Trade, scope: str, quantity: str, one: Cheapest) -> dict[str, Any]:
    return {
        "scope": scope,
        "quantity": quantity,
        "target": one.target,
        **_named(TSM.name, one.tsm),
        **_named(SOLID.name, one.solid),
        "ratio": one.ratio(),
        "limit_uncertainty": trade.uncertainty(SOLID.name, scope, quantity),
        **_named("solid_against_reference", one.solid_against_reference),
        "ratio_against_reference": one.ratio(reference=True),
    }


def _named(name: str, row: Row | None) -> dict[str, Any]:
    return {
        name: row and row.label,
        f"{name}_load_steps": row and row.case.scene.load_parameters,
        f"{name}_seconds": row and row.measured.seconds,
    }


def order_rows(trade: Trade) -> Table:
    """Return the orders of all quantities."""
    return [{"quantity": name, **row} for name in KEPT for row in orders(trade, name)]


def front_rows(trade: Trade) -> Table:
    """Return the points of the Pareto fronts."""
    return [
        {
            "model": model,
            "scope": scope,
            "quantity": quantity,
            "cost": cost,
            "label": one.row.label,
            "load_steps": one.row.case.scene.load_parameters,
            "spent": one.cost,
            "own_error": one.error,
        }
        for model in MESHED
        for scope in SCOPES
        for quantity in KEPT
        for cost in COSTS
        for one in front(trade, model, scope, quantity, cost)
    ]


def cheapest_lines(trade: Trade, scope: str) -> tuple[str, Table]:
    """Return a title, and the cheapest settings of one scope as rows for people."""
    titles = {
        "end": f"at the load parameter {trade.reference.end:g}, any number of load steps",
        "path": f"the largest over all {trade.scene.load_parameters} load parameters",
    }
    title = f"cheapest for an error of {SHOWN}, {titles[scope]}"
    return title, [_line(cheapest(trade, scope, SHOWN, target)) for target in TARGETS]


def _line(one: Cheapest) -> dict[str, Any]:
    ratios = (one.ratio(), one.ratio(reference=True))
    ratio, ratio_there = (value if isfinite(value) else None for value in ratios)
    return {
        "error": one.target,
        "TSM": one.tsm and short(one.tsm),
        "seconds": one.tsm and one.tsm.measured.seconds,
        "solid, its own limit": "not told" if one.untold else one.solid and short(one.solid),
        "its seconds": one.solid and one.solid.measured.seconds,
        "ratio": ratio,
        "solid, the reference": one.solid_against_reference and short(one.solid_against_reference),
        "and its seconds": one.solid_against_reference and one.solid_against_reference.measured.seconds,
        "ratio there": ratio_there,
    }


def order_lines(trade: Trade) -> Table:
    """Return the orders and cost exponents with what they are fitted to as rows for people."""
    return [
        {
            "family": row["family"],
            "order": row["order"],
            "points": row["order_points"],
            "elements": _range(row, "order"),
            "cost exponent": row["cost_exponent"],
            "its points": row["cost_exponent_points"],
            "unknowns": _range(row, "cost_exponent"),
        }
        for row in orders(trade, SHOWN)
    ]


def _range(row: Mapping[str, Any], name: str) -> str | None:
    return None if row[name] is None else f"{row[f'{name}_from']:g} to {row[f'{name}_to']:g}"


def stopped(trade: Trade) -> dict[str, str]:
    """Return the settings without a completed and checked solution, and why."""
    return {
        f"{row.label} [{row.case.scene.load_parameters}]": f"{row.response.status}: {row.response.message}"
        for row in trade.stopped
    }


def summary(trade: Trade) -> str:
    """Return what a person reads of a trade-off: references, cheapest settings, orders, and what stopped."""
    limit = trade.limit.sentence if trade.limit else "not known: a solid that it is extrapolated from stopped"
    lines = order_lines(trade)
    reasons = stopped(trade)
    return "\n\n".join(
        [
            f"""{trade.scene.name}: {len(trade.rows)} settings
errors against: {trade.reference.sentence}
the solid's own limit: {limit}
seconds: processor time of one thread from the scene to the checked answer, median of repeats after a warm-up
-: no setting does it; not told: the limit is known less well than that; [n]: n load steps""",
            *(
                f"{title}\n\n{tabulated(rows)}"
                for title, rows in (cheapest_lines(trade, scope) for scope in SCOPES)
            ),
            f"orders of convergence and cost exponents, error of {SHOWN} over the path",
            tabulated(lines) if lines else "no family has three settings",
            "\n".join(
                [
                    f"{len(reasons)} of {len(trade.rows)} settings without a solution:",
                    *(f"  {name}: {reason}" for name, reason in reasons.items()),
                ]
            ),
        ]
    )


def short(row: Row) -> str:
    """Return a setting in a few words, its load steps in brackets."""
    _, _, label = row.label.partition(" ")
    return f"{(label or row.label).replace('tolerance', 'tol')} [{row.case.scene.load_parameters}]"

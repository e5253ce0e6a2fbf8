"""The tables of a sweep: every setting, the cheapest for an accuracy, and the orders."""

from collections.abc import Sequence
from math import isfinite

from comparisons.cost.cases import family
from comparisons.cost.points import TARGETS, Cheapest, Point, Trade, cheapest
from comparisons.models import MODELS, SOLID, TSM
from comparisons.output import Row, tabulated
from comparisons.quantities import KEPT, SCOPES


def setting_rows(trade: Trade) -> list[Row]:
    """Return a row for every setting, those that stopped too: what it is, what it cost, all its errors."""
    return [_setting(point) for point in trade.points]


def _setting(point: Point) -> Row:
    case, measured, response = point.case, point.measured, point.measured.response
    contact = case.scene.contacts[0] if case.scene.contacts and MODELS[case.model].continuum else None
    mesh = case.options.mesh
    errors = {
        f"{against}_{scope}_{quantity}": table[scope][quantity]
        for against, table in (("error", point.errors), ("own_error", point.own_errors))
        for scope in SCOPES
        for quantity in KEPT
    }
    return {
        "label": case.label,
        "family": family(case),
        "model": case.model,
        "elements": case.options.elements,
        "mesh": mesh and f"{mesh[0]}x{mesh[1]}",
        "integration_tolerance": case.options.integration_tolerance,
        "penalty": contact and contact.penalty,
        "penetration": contact and contact.penetration,
        "load_steps": case.scene.load_parameters,
        "load_parameters_reached": len(response.load_parameter),
        "status": response.status,
        "message": response.message,
        "unknowns": response.unknowns,
        "iterations": response.iterations,
        "cutbacks": response.cutbacks,
        "seconds": measured.seconds,
        "repeats": measured.repeats,
        "peak_memory": measured.peak_memory,
        **errors,
    }


def all_cheapest(trade: Trade) -> list[Cheapest]:
    """Return the cheapest settings for every scope, quantity and target that the reference can tell."""
    return [
        cheapest(trade, scope, quantity, target)
        for scope in SCOPES
        for quantity in KEPT
        if isfinite(trade.reference.uncertainty[scope][quantity])
        for target in TARGETS
    ]


def cheapest_rows(trade: Trade) -> list[Row]:
    """Return `all_cheapest` as rows."""
    return [
        {
            "scope": one.scope,
            "quantity": one.quantity,
            "target": one.target,
            **_named(TSM.name, one.tsm),
            **_named(SOLID.name, one.solid),
            "ratio": one.ratio,
            "limit_uncertainty": trade.uncertainty(SOLID.name, one.scope, one.quantity),
            **_named("solid_against_reference", one.solid_against_reference),
            "ratio_against_reference": one.ratio_against_reference,
        }
        for one in all_cheapest(trade)
    ]


def _named(name: str, point: Point | None) -> Row:
    return {
        name: point and point.case.label,
        f"{name}_load_steps": point and point.case.scene.load_parameters,
        f"{name}_seconds": point and point.measured.seconds,
    }


def cheapest_text(trade: Trade, quantity: str) -> str:
    """Return the cheapest settings for the errors of one quantity as aligned text, both scopes."""
    blocks = (cheapest_lines(trade, quantity, scope) for scope in SCOPES)
    return "\n\n".join(f"{title}\n\n{tabulated(rows)}" for title, rows in blocks)


def cheapest_lines(trade: Trade, quantity: str, scope: str) -> tuple[str, list[Row]]:
    """Return the cheapest settings for the errors of one quantity and scope as rows for people, below their title."""
    titles = {
        "end": f"at the load parameter {trade.reference.end:g}, any number of load steps",
        "path": f"the largest over all {trade.scene.load_parameters} load parameters",
    }
    title = f"cheapest for an error of {quantity.replace('_', ' ')}, {titles[scope]}"
    return title, [_line(cheapest(trade, scope, quantity, target)) for target in TARGETS]


def _line(one: Cheapest) -> Row:
    return {
        "error": one.target,
        "TSM": one.tsm and short(one.tsm),
        "seconds": one.tsm and one.tsm.measured.seconds,
        "solid, its own limit": "not told" if one.untold else one.solid and short(one.solid),
        "its seconds": one.solid and one.solid.measured.seconds,
        "ratio": _known(one.ratio),
        "solid, the reference": one.solid_against_reference and short(one.solid_against_reference),
        "and its seconds": one.solid_against_reference and one.solid_against_reference.measured.seconds,
        "ratio there": _known(one.ratio_against_reference),
    }


def _known(value: float) -> float | None:
    return value if isfinite(value) else None


def orders_text(rows: Sequence[Row]) -> str:
    """Return the orders and cost exponents with what they are fitted to as aligned text."""
    return tabulated(order_lines(rows)) if rows else "no family has three settings"


def order_lines(rows: Sequence[Row]) -> list[Row]:
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
        for row in rows
    ]


def _range(row: Row, name: str) -> str | None:
    return None if row[name] is None else f"{row[f'{name}_from']:g} to {row[f'{name}_to']:g}"


def stopped_text(trade: Trade) -> str:
    """Return one line for every setting without a completed and checked solution."""
    lines = [
        f"  {point.case.label} [{point.case.scene.load_parameters}]: {point.measured.response.status}: {point.measured.response.message}"
        for point in trade.stopped
    ]
    return "\n".join([f"{len(lines)} of {len(trade.points)} settings without a solution:", *lines])


def short(point: Point) -> str:
    """Return a setting in a few words, its load steps in brackets."""
    _, _, label = point.case.label.partition(" ")
    return f"{(label or point.case.label).replace('tolerance', 'tol')} [{point.case.scene.load_parameters}]"

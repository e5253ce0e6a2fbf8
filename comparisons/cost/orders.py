"""The order of convergence and the cost exponent of every family of settings."""

from collections.abc import Iterator, Sequence
from math import isfinite
from typing import Any

from comparisons.cases import Case
from comparisons.cost.cases import family, meshed, refined, resolution
from comparisons.cost.fits import Fit, convergence, power_law
from comparisons.cost.points import Point, Trade
from comparisons.output import Row

LARGEST = 4
"""Number of the largest settings of a family to which the cost exponent is fitted; the cost of small settings does not depend on size."""
ABOVE = 3.0
"""Least error in a fit, over the uncertainty of the reference."""


def orders(trade: Trade, quantity: str) -> Iterator[Row]:
    """Yield a row for every family with all load steps: ``error ~ n^-order`` over the path, ``seconds ~ unknowns^cost_exponent``.

    An exponent is None where its asymptotic range has fewer than three points.
    """
    points = {point.case: point for model in meshed() for point in trade.of_model(model, "path")}
    seen: set[Case] = set()
    for case in points:
        members = refined(case, points)
        if case in members and case not in seen and len(members) > 2:
            seen.update(members)
            yield _row(trade, [points[member] for member in members], quantity)


def _row(trade: Trade, chain: Sequence[Point], quantity: str) -> Row:
    case = chain[0].case
    doubt = trade.uncertainty(case.model, "path", quantity)
    sizes = [resolution(point.case) for point in chain]
    errors = [point.own_errors["path"][quantity] for point in chain]
    costs = [(float(one.measured.response.unknowns), one.measured.seconds) for one in chain[-LARGEST:]]
    return {
        "family": f"{family(case)}{_contact(case)}",
        "settings": len(chain),
        **_stated("order", convergence(sizes, errors, ABOVE * doubt) if isfinite(doubt) else None, -1.0),
        **_stated("cost_exponent", power_law(*zip(*costs, strict=True)), 1.0),
    }


def _contact(case: Case) -> str:
    given = [contact for contact in case.scene.contacts if contact.penetration is not None]
    return f", penetration {given[0].penetration:g}" if given else ""


def _stated(name: str, fit: Fit | None, sign: float) -> dict[str, Any]:
    return {
        name: fit and sign * fit.exponent,
        f"{name}_points": fit.points if fit else 0,
        f"{name}_from": fit and fit.first,
        f"{name}_to": fit and fit.last,
        f"{name}_scatter": fit and fit.scatter,
    }

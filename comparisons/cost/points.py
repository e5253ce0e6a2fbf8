"""What the sweep found: every case with its cost and errors, the cheapest for an accuracy, and the fits."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite, nan

from comparisons.cases import Case, Measurement
from comparisons.cost.fits import pareto
from comparisons.cost.references import Reference
from comparisons.errors import Errors
from comparisons.models import MODELS, SOLID, TSM
from comparisons.scene import Scene

TARGETS = (5e-2, 1e-2, 1e-3, 1e-4, 1e-5)
COSTS = ("seconds", "iterations", "unknowns")


@dataclass(frozen=True, kw_only=True, eq=False)
class Point:
    """One case with its cost and its errors.

    Attributes
    ----------
    case : Case
        The case.
    measured : Measurement
        Its answer and cost.
    errors : dict of dict of float
        Errors against the reference, by scope and quantity.
    own_errors : dict of dict of float
        Errors against the model's limit, by scope and quantity. The solid has a limit of its own, with nan where it is not known; the
        limit of all other models is the reference.
    """

    case: Case
    measured: Measurement
    errors: Errors
    own_errors: Errors

    def spent(self, cost: str) -> float:
        """Return what the case cost, by a name of `COSTS`."""
        return float(getattr(self.measured if cost == "seconds" else self.measured.response, cost))


@dataclass(frozen=True, kw_only=True, eq=False)
class Trade:
    """The whole sweep.

    Attributes
    ----------
    scene : Scene
        The scene.
    points : list of Point
        All cases, those that stopped too.
    reference : Reference
        What `Point.errors` are against.
    limit : Reference or None
        The solid's own limit, None if it is not known.
    """

    scene: Scene
    points: list[Point]
    reference: Reference
    limit: Reference | None

    def uncertainty(self, model: str, scope: str, quantity: str) -> float:
        """Return the uncertainty of a model's limit; nan if the limit is not known."""
        known = self.limit if MODELS[model].continuum else self.reference
        return nan if known is None else known.uncertainty[scope][quantity]

    @property
    def stopped(self) -> list[Point]:
        """The cases without a completed and checked solution."""
        return [point for point in self.points if not point.measured.response.completed]

    def of_model(self, model: str, scope: str) -> list[Point]:
        """Return the completed points of a model; for the scope ``path`` those with every load parameter of the scene."""
        return [
            point
            for point in self.points
            if point.measured.response.completed
            and point.case.model == model
            and (scope == "end" or point.case.scene.load_parameters == self.scene.load_parameters)
        ]


@dataclass(frozen=True, kw_only=True, eq=False)
class Cheapest:
    """The cheapest settings for an accuracy.

    Attributes
    ----------
    scope, quantity : str
        Which error.
    target : float
        Largest error accepted.
    tsm, solid, solid_against_reference : Point or None
        Settings with the least seconds; None if no setting reaches the target. The error of `solid` is measured against the solid's
        limit, the error of `solid_against_reference` against the reference.
    untold : bool
        Whether the solid's limit is known less well than the target.
    """

    scope: str
    quantity: str
    target: float
    tsm: Point | None
    solid: Point | None
    solid_against_reference: Point | None
    untold: bool

    @property
    def ratio(self) -> float:
        """Seconds of the solid over seconds of the beams at this error, which is measured against each model's limit."""
        return _ratio(self.solid, self.tsm)

    @property
    def ratio_against_reference(self) -> float:
        """Seconds of the solid over seconds of the beams, with both errors measured against the reference."""
        return _ratio(self.solid_against_reference, self.tsm)


def _ratio(slow: Point | None, fast: Point | None) -> float:
    return nan if slow is None or fast is None else slow.measured.seconds / fast.measured.seconds


def cheapest(trade: Trade, scope: str, quantity: str, target: float) -> Cheapest:
    """Return the cheapest settings of TSM and of the solid with an error of at most `target`."""
    beams, solids = trade.of_model(TSM.name, scope), trade.of_model(SOLID.name, scope)
    untold = not trade.uncertainty(SOLID.name, scope, quantity) <= target
    return Cheapest(
        scope=scope,
        quantity=quantity,
        target=target,
        tsm=_least(beams, [point.errors[scope][quantity] for point in beams], target),
        solid=None
        if untold
        else _least(solids, [point.own_errors[scope][quantity] for point in solids], target),
        solid_against_reference=_least(
            solids, [_not_by_chance(one, scope, quantity) for one in solids], target
        ),
        untold=untold,
    )


def _not_by_chance(point: Point, scope: str, quantity: str) -> float:
    """Larger of the errors against the reference and against the model's limit. On a coarse mesh, discretisation and model error may cancel."""
    either = (point.errors[scope][quantity], point.own_errors[scope][quantity])
    return max((error for error in either if isfinite(error)), default=nan)


def _least(points: Sequence[Point], errors: Sequence[float], target: float) -> Point | None:
    good = [point for point, error in zip(points, errors, strict=True) if error <= target]
    return min(good, key=lambda point: point.measured.seconds, default=None)


@dataclass(frozen=True, kw_only=True, eq=False)
class OnFront:
    """A setting that no other of its model beats in both cost and error."""

    point: Point
    cost: float
    error: float


def front(trade: Trade, model: str, scope: str, quantity: str, cost: str) -> list[OnFront]:
    """Return the Pareto front of a model by rising cost, with errors against the model's limit.

    Errors below the uncertainty of the limit count as equal.
    """
    points, doubt = trade.of_model(model, scope), trade.uncertainty(model, scope, quantity)
    costs = [point.spent(cost) for point in points]
    errors = [max(point.own_errors[scope][quantity], doubt) for point in points]
    return [OnFront(point=points[k], cost=costs[k], error=errors[k]) for k in pareto(costs, errors)]

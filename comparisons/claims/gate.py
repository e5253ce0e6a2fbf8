"""Errors of one model against bounds: what a CI run asks."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from math import isnan

from comparisons.claims.claim import Allowance, Claim, Finding, Judgement, Quantity, StoppedError, judge
from comparisons.claims.junit import junit_text
from comparisons.errors import difference, worst_place
from comparisons.models import ROD, certified, find, solve
from comparisons.models.options import ModelError, Options
from comparisons.quantities import QUANTITIES
from comparisons.referee.certify import ALLOWED
from comparisons.response import Response
from comparisons.scene import Scene


@dataclass(frozen=True, kw_only=True, eq=False)
class Gate:
    """A run against its bounds.

    Attributes
    ----------
    scene : Scene
        What is solved.
    response, reference : Response
        The run and what it is measured against.
    judgements : tuple of Judgement
        One for each bound, in the order asked for.
    """

    scene: Scene
    response: Response
    reference: Response
    judgements: tuple[Judgement, ...]

    @property
    def bounds(self) -> tuple[Finding, ...]:
        """The errors and their bounds, by name of the quantity; an error is infinite where a solution stopped."""
        return tuple(finding for item in self.judgements for finding in item.findings)

    @property
    def held(self) -> bool:
        """Whether both solutions are complete and every bound holds."""
        return all(item.passed for item in self.judgements)

    def place(self, quantity: str) -> str:
        """Return the pair, support or beam, and the load parameter, with the largest error; empty without an error or an answer."""
        if not (self.response.completed and self.reference.completed):
            return ""
        return worst_place(self.response, self.reference, self.scene, quantity)

    def junit(self) -> str:
        """Return the bounds as JUnit XML, one test case each."""
        classname = f"{self.response.scene}.{self.response.model}"
        cases = [item.junit(classname) for item in self.judgements]
        against = f", against {self.reference.model}"
        named = [replace(one, failure=one.failure and one.failure + against) for one in cases]
        return junit_text(f"crossval compare {self.response.scene}", named)


def gate(
    scene: Scene, model: str, options: Options, bounds: Mapping[str, float], against: str | None = None
) -> Gate:
    """Solve `scene` with a model and measure its errors.

    Parameters
    ----------
    scene : Scene
        What is solved.
    model, options
        As for `comparisons.models.solve`.
    bounds : mapping of float
        Largest errors allowed, by quantity.
    against : str, optional
        Model to measure against; the exact rods if not given.

    Raises
    ------
    ModelError
        If a model cannot state the scene, a model is measured against itself, or the two do not state a quantity that is bounded.
    """
    other = find(ROD.name if against is None else against)
    exact = other.reference or Options()
    if find(model).name == other.name and other.setting(scene, options) == other.setting(scene, exact):
        raise ModelError(f"{model}: is measured against itself; --against names another model")
    for name in bounds:
        refused = QUANTITIES[name].refusal(scene, find(model).continuum and other.continuum)
        if refused is not None:
            raise ModelError(f"{name}: {refused}")
    allowance = max(ALLOWED, *bounds.values())
    reference = certified(solve(scene, against or ROD.name, exact), scene)
    response = certified(solve(scene, model, options), scene, allowance=allowance)

    def measured(quantity: str) -> tuple[float]:
        for one in (response, reference):
            if not one.completed:
                raise StoppedError(f"{one.model}: {one.status}: {one.message}")
        error = difference(response, reference, scene, quantity)
        if isnan(error):
            absent = QUANTITIES[quantity].absent(response, reference)
            raise ModelError(f"{quantity}: {absent or 'the scene has none'}")
        return (error,)

    claims = (
        Claim(
            name=quantity,
            statement=f"the error of {response.model} in {scene.name}",
            source=f"against {reference.model}",
            quantities=(Quantity(name=quantity, exact=0.0, scale=1.0),),
            allowance=Allowance(error=bound, why="asked for"),
            measure=partial(measured, quantity),
        )
        for quantity, bound in bounds.items()
    )
    return Gate(
        scene=scene, response=response, reference=reference, judgements=tuple(judge(one) for one in claims)
    )

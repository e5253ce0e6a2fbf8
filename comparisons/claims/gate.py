"""Errors of one model against bounds: what a CI run asks."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial

from comparisons.claims.claim import Allowance, Claim, Finding, Judgement, Quantity, StoppedError, judge
from comparisons.claims.junit import junit_text
from comparisons.errors import difference, event_differences, worst_place
from comparisons.models import ROD, certified, find, solve
from comparisons.models.options import ModelError, Options
from comparisons.referee.certify import ALLOWED
from comparisons.response import Response
from comparisons.response.material import UNDEFINED, clamped
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
        return junit_text(f"crossval gate {self.response.scene}", named)


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
        If a model cannot state the scene, the scene has no material force for a bound on the friction, or there are no events for
        a bound on them.
    """
    if "friction" in bounds and not clamped(scene):
        raise ModelError(f"friction: {UNDEFINED}")
    allowance = max(ALLOWED, *bounds.values())
    reference = certified(_reference(scene, against), scene)
    response = certified(solve(scene, model, options), scene, allowance=allowance)
    silent = [one.model for one in (reference, response) if one.events is None]
    if "event" in bounds and silent and not event_differences(response, reference):
        raise ModelError(
            f"event: {silent[0]} states no events of this scene; compare two models that do, --against tsm"
        )

    def measured(quantity: str) -> tuple[float]:
        for one in (response, reference):
            if not one.completed:
                raise StoppedError(f"{one.model}: {one.status}: {one.message}")
        return (difference(response, reference, scene, quantity),)

    claims = (
        Claim(
            name=f"{quantity} <= {bound:g}",
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


def _reference(scene: Scene, against: str | None) -> Response:
    name = ROD.name if against is None else against
    return solve(scene, name, find(name).reference or Options())

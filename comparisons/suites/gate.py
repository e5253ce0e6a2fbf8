"""Errors of one model against bounds: what a CI run asks."""

from collections.abc import Mapping
from math import inf, isnan

from comparisons.answer import Response
from comparisons.answer.errors import difference, worst_place
from comparisons.answer.quantities import QUANTITIES
from comparisons.frozen import Frozen
from comparisons.models import ROD, certified, find, solve
from comparisons.models.model import ModelError, Options
from comparisons.referee.certify import ALLOWED
from comparisons.scene import Scene
from comparisons.suites.finding import Finding, junit_text


class Gate(Frozen):
    """A run, what it is measured against, and its errors with their bounds by name of the quantity, in the order asked for.

    An error is infinite where a solution stopped.
    """

    scene: Scene
    response: Response
    reference: Response
    bounds: tuple[Finding, ...]

    @property
    def stopped(self) -> str:
        """Which of the two solutions stopped, and why; empty if none did."""
        both = (self.response, self.reference)
        return next((f"{one.model}: {one.ended}" for one in both if not one.completed), "")

    @property
    def held(self) -> bool:
        """Whether both solutions are complete and every bound holds."""
        return not self.stopped and all(item.holds for item in self.bounds)

    def place(self, quantity: str) -> str:
        """Return the pair, support or beam, and the load parameter, with the largest error; empty without an error or an answer."""
        return "" if self.stopped else worst_place(self.response, self.reference, self.scene, quantity)

    def junit(self) -> str:
        """Return the bounds as JUnit XML, one test case each."""
        group, against = f"{self.response.scene}.{self.response.model}", f", against {self.reference.model}"
        checks = (
            (group, one.name, 0.0, one.failure and (self.stopped or one.failure) + against, [one])
            for one in self.bounds
        )
        return junit_text(f"crossval compare {self.response.scene}", checks)


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
    own, other = find(model), find(against or ROD.name)
    exact = other.reference or Options()
    if own.name == other.name and other.setting(scene, options) == other.setting(scene, exact):
        raise ModelError(f"{model}: is measured against itself; --against names another model")
    for name in bounds:
        refused = QUANTITIES[name].refusal(scene, own.continuum and other.continuum)
        if refused is not None:
            raise ModelError(f"{name}: {refused}")
    reference = certified(solve(scene, against or ROD.name, exact), scene)
    response = certified(solve(scene, model, options), scene, allowance=max(ALLOWED, *bounds.values()))
    held = list[Finding]()
    for name, bound in bounds.items():
        both = response.completed and reference.completed
        error = difference(response, reference, scene, name) if both else inf
        if isnan(error):
            absent = QUANTITIES[name].absent(response, reference)
            raise ModelError(f"{name}: {absent or 'the scene has none'}")
        held.append(Finding(name=name, error=error, allowed=bound))
    return Gate(scene=scene, response=response, reference=reference, bounds=tuple(held))

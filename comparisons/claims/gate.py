"""Errors of one model against bounds: what a CI run asks."""

from collections.abc import Mapping
from dataclasses import dataclass

from comparisons.claims.junit import JUnitCase, junit_text
from comparisons.errors import difference
from comparisons.models.options import ModelError, Options
from comparisons.models.registry import COARSE, certified, solve
from comparisons.response import Response
from comparisons.scene import Scene

REFERENCES = (("rod", Options()), ("tsm", Options(element="exact")))
"""What errors are measured against: the first that can state the scene."""


@dataclass(frozen=True, kw_only=True)
class Bound:
    """A bound on the error of a quantity, and the error found.

    Attributes
    ----------
    quantity : str
        Key of `comparisons.quantities.QUANTITIES`.
    bound, error : float
        Relative, the largest over all load parameters; the error is infinite where a solution stopped.
    """

    quantity: str
    bound: float
    error: float

    @property
    def held(self) -> bool:
        """Whether the error lies within the bound."""
        return self.error <= self.bound


@dataclass(frozen=True, kw_only=True, eq=False)
class Gate:
    """A run against its bounds.

    Attributes
    ----------
    response, reference : Response
        The run and what it is measured against.
    bounds : tuple of Bound
        In the order asked for.
    """

    response: Response
    reference: Response
    bounds: tuple[Bound, ...]

    @property
    def held(self) -> bool:
        """Whether both solutions are complete and every bound holds."""
        return self.response.completed and self.reference.completed and all(item.held for item in self.bounds)

    def junit(self) -> str:
        """Return the bounds as JUnit XML, one test case each."""
        return junit_text(
            f"crossval gate {self.response.scene}",
            [
                JUnitCase(
                    classname=f"{self.response.scene}.{self.response.model}",
                    name=f"{item.quantity} <= {item.bound:g}",
                    failure=None if item.held else f"error {item.error:.3g}, against {self.reference.model}",
                )
                for item in self.bounds
            ],
        )


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
        Model to measure against; if not given the exact rod, or exact TSM elements where the rod cannot state the scene.

    Raises
    ------
    ModelError
        If a model cannot state the scene.
    """
    allowance = max(COARSE, *bounds.values())
    reference = certified(_reference(scene, against), scene)
    response = certified(solve(scene, model, options), scene, allowance=allowance)
    complete = response.completed and reference.completed
    return Gate(
        response=response,
        reference=reference,
        bounds=tuple(
            Bound(
                quantity=quantity,
                bound=bound,
                error=difference(response, reference, scene, quantity) if complete else float("inf"),
            )
            for quantity, bound in bounds.items()
        ),
    )


def _reference(scene: Scene, against: str | None) -> Response:
    if against is not None:
        return solve(scene, against, Options(element="exact") if against == "tsm" else Options())
    for model, options in REFERENCES:
        try:
            return solve(scene, model, options)
        except ModelError:
            continue
    raise ModelError("no model without a mesh can state the scene")

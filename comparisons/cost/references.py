"""References for errors: the best exact answer of a scene, and the limit of the solid."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from comparisons.cases import Case, Measurement
from comparisons.cost.cases import family, limit_cases
from comparisons.cost.limit import end_state, extrapolated
from comparisons.errors import Errors, errors
from comparisons.models import ROD, TSM
from comparisons.models.options import Options
from comparisons.quantities import Scales, scales
from comparisons.response import Response
from comparisons.scene import Scene
from tsm.elements import EXACT

Measured = Mapping[Case, Measurement]

ROUND_OFF = 2.0**-52
"""Least uncertainty of a reference, also where two answers are equal."""


class NoReferenceError(ValueError):
    """The exact rods did not complete: one line."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Reference:
    """A response that errors are measured against.

    Attributes
    ----------
    response : Response
        The response.
    scene : Scene
        The scene with all load parameters.
    scale : Scales
        Divisors of the errors.
    end : float
        The load parameter of the scope ``end``.
    uncertainty : dict of dict of float
        Uncertainty of the response, by scope and quantity.
    name, sentence : str
        What it is, in a few words and in full.
    """

    response: Response
    scene: Scene
    scale: Scales
    end: float
    uncertainty: Errors
    name: str
    sentence: str

    def errors(self, measured: Measurement) -> Errors:
        """Return the errors of a measured case."""
        return errors(measured.response, self.response, self.scene, scale=self.scale, end=self.end)


def reference_cases(scene: Scene) -> list[Case]:
    """Return the cases that the reference is chosen from: the exact rods, and exact elements."""
    return [Case(scene=scene, model=ROD.name), _exact(scene)]


def _exact(scene: Scene) -> Case:
    options = Options(element=EXACT.name, elements=1, integration_tolerance=1e-12)
    return Case(scene=scene, model=TSM.name, options=options)


def best_reference(scene: Scene, measured: Measured) -> Reference:
    """Return the answer of the exact rods, as uncertain as its difference from exact TSM elements.

    The rods and not the elastica: every model of the sweep stretches and shears.

    Raises
    ------
    NoReferenceError
        If the exact rods did not complete.
    """
    exact = measured[_exact(scene)]
    rod = measured[Case(scene=scene, model=ROD.name)]
    if not rod.response.completed:
        raise NoReferenceError(f"{scene.name}: the exact rods stopped: {rod.response.message}")
    confirmed = (
        "TSM exact, which shares no code with them, agrees within {:.1e} of the largest force"
        if exact.response.completed
        else "TSM exact, which would confirm them, did not complete"
    )
    template = f"the exact Reissner rods, with the beams' stretch and shear, which the elastica leaves out; {confirmed}"
    return _by_difference(scene, rod, exact if exact.response.completed else rod, "exact rod", template)


def _by_difference(
    scene: Scene, best: Measurement, other: Measurement, name: str, template: str
) -> Reference:
    """Return a reference that is as uncertain as its difference from another solution."""
    found = best.response
    scale, end = scales(found), end_state(found)
    apart = errors(other.response, found, scene, end=end)
    known = {
        scope: {quantity: max(error, ROUND_OFF) for quantity, error in table.items()}
        for scope, table in apart.items()
    }
    sentence = template.format(apart["path"]["force"])
    return Reference(
        response=found, scene=scene, scale=scale, end=end, uncertainty=known, name=name, sentence=sentence
    )


def solid_limit(scene: Scene, measured: Measured, *, quick: bool = False) -> Reference | None:
    """Return what the solid of the scene's material converges to, contacts closed without penetration; None if a mesh did not complete."""
    cases = limit_cases(scene, quick=quick)
    if not all(measured[case].response.completed for case in cases):
        return None
    return _limit(scene, measured, cases, "the solid's own limit")


def _limit(scene: Scene, measured: Measured, cases: Sequence[Case], name: str) -> Reference:
    series = [measured[case].response for case in cases]
    found = extrapolated(series)
    scale, end = scales(found), end_state(found)
    known = errors(series[-2], series[-1], scene, scale=scale, end=end)
    meshes = ", ".join(case.label.removeprefix(f"{family(case)} ") for case in cases)
    sentence = f"extrapolated from {meshes}, known to {known['path']['force']:.1e} of the largest force"
    return Reference(
        response=found, scene=scene, scale=scale, end=end, uncertainty=known, name=name, sentence=sentence
    )

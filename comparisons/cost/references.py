"""References for errors: the best exact answer of a scene, and the limit of the solid."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from comparisons.cases import Case, Measurement
from comparisons.cost.cases import family, limit_cases, refined, resolution
from comparisons.cost.limit import end_state, extrapolated
from comparisons.errors import Errors, Scales, errors, scales
from comparisons.models import ROD, TSM
from comparisons.models.options import Options
from comparisons.response import Response
from comparisons.scene import Scene
from tsm.elements import EXACT, MIXED

Measured = Mapping[Case, Measurement]

ROUND_OFF = 2.0**-52
"""Least uncertainty of a reference, also where two answers are equal."""


class NoReferenceError(ValueError):
    """No exact answer of the scene, and none to extrapolate it from: one line."""


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
    """Return the cases that the reference is chosen from: the rod where it can state the scene, and exact elements."""
    rod = [Case(scene=scene, model=ROD.name)] if ROD.refusal(scene) is None else []
    return [*rod, *(_exact(scene, elements) for elements in (1, 2))]


def _exact(scene: Scene, elements: int) -> Case:
    options = Options(element=EXACT.name, elements=elements, tolerance=1e-12)
    return Case(scene=scene, model=TSM.name, options=options)


def best_reference(scene: Scene, measured: Measured) -> Reference:
    """Return the best answer of the scene: the Reissner rod, else exact elements, else what `mixed` elements converge to.

    The rod and not the elastica: every model of the sweep stretches and shears.

    Raises
    ------
    NoReferenceError
        If none of them completed.
    """
    exact, finer = (measured[_exact(scene, elements)] for elements in (1, 2))
    rod = measured.get(Case(scene=scene, model=ROD.name))
    if rod is not None and rod.response.completed:
        return _rod(scene, rod, exact)
    if exact.response.completed and finer.response.completed:
        told = (
            "TSM exact elements, two a beam: they solve the rod's own equations but are not independent of the other TSM "
            "elements; one a beam is within {:.1e} of the largest force"
        )
        return _by_difference(scene, finer, exact, "TSM exact, 2 elements", told)
    return _of_mixed(scene, measured)


def _rod(scene: Scene, rod: Measurement, exact: Measurement) -> Reference:
    confirmed = (
        "TSM exact, which shares nothing with it, agrees within {:.1e} of the largest force"
        if exact.response.completed
        else "TSM exact, which would confirm it, did not complete"
    )
    told = f"the exact Reissner rod, with the beams' stretch and shear, which the elastica leaves out; {confirmed}"
    return _by_difference(scene, rod, exact if exact.response.completed else rod, "exact rod", told)


def _by_difference(scene: Scene, best: Measurement, other: Measurement, name: str, told: str) -> Reference:
    """Return a reference that is as uncertain as its difference from another solution."""
    found = best.response
    scale, end = scales(found), end_state(found)
    apart = errors(other.response, found, scene, end=end)
    known = {
        scope: {quantity: max(error, ROUND_OFF) for quantity, error in table.items()}
        for scope, table in apart.items()
    }
    sentence = told.format(apart["path"]["force"])
    return Reference(
        response=found, scene=scene, scale=scale, end=end, uncertainty=known, name=name, sentence=sentence
    )


def _of_mixed(scene: Scene, measured: Measured) -> Reference:
    sample = Case(scene=scene, model=TSM.name, options=Options(element=MIXED.name, elements=1))
    completed = [case for case in refined(sample, measured) if measured[case].response.completed]
    # a constant ratio of refinement: every mesh has twice the elements of the one before
    halved = {resolution(completed[-1]) / 2**k for k in range(3)} if completed else set()
    chain = [case for case in completed if resolution(case) in halved]
    if len(chain) < 3:
        raise NoReferenceError(
            f"{scene.name}: no exact answer and fewer than three `mixed` solutions to extrapolate one from"
        )
    return _limit(scene, measured, chain, "TSM mixed, extrapolated")


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

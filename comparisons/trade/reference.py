"""What the errors of a trade-off are measured against: the exact rods, and the limit of the solid by extrapolation."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from comparisons.cases import Case, Row
from comparisons.errors import Errors, errors
from comparisons.models import ROD
from comparisons.quantities import forces, moments, scales, size
from comparisons.response import Array, Response
from comparisons.response.axis import SampledAxes, sampled_axes
from comparisons.scene import Scene
from comparisons.trade.settings import beams, limit_cases
from tsm.elements import EXACT

Measured = Mapping[Case, Row]
ROUND_OFF = 2.0**-52
"""Least uncertainty of a reference, also where two answers are equal."""


class NoReferenceError(ValueError):
    """The exact rods did not complete: one line."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Reference:
    """A response that errors are measured against, its uncertainty by scope and quantity, and what it is in one sentence."""

    response: Response
    scene: Scene
    uncertainty: Errors
    sentence: str

    @property
    def end(self) -> float:
        """The load parameter of the scope ``end``: the last one at which the response carries a force."""
        carries = np.any([size(values) > 0.0 for values in forces(self.response).values()], axis=0)
        times = self.response.load_parameter
        return float(times[carries][-1] if carries.any() else times[-1])

    def errors(self, response: Response) -> Errors:
        """Return the errors of a response."""
        return errors(response, self.response, self.scene, end=self.end)


def reference_cases(scene: Scene) -> list[Case]:
    """Return the exact rods, and the exact elements that confirm them."""
    return [Case(scene=scene, model=ROD.name), beams(scene, EXACT, 1, tolerance=1e-12)]


def best_reference(scene: Scene, measured: Measured) -> Reference:
    """Return the answer of the exact rods, as uncertain as its difference from exact TSM elements.

    The rods and not the elastica: every model of the sweep stretches and shears.

    Raises NoReferenceError if the exact rods did not complete.
    """
    rod, exact = (measured[case].response for case in reference_cases(scene))
    if not rod.completed:
        raise NoReferenceError(f"{scene.name}: the exact rods stopped: {rod.message}")
    found = Reference(response=rod, scene=scene, uncertainty={}, sentence="")
    apart = found.errors(exact if exact.completed else rod)
    confirmed = (
        f"TSM exact, which shares no code with them, agrees within {apart['path']['force']:.1e} of the largest force"
        if exact.completed
        else "TSM exact, which would confirm them, did not complete"
    )
    return replace(
        found,
        uncertainty={
            scope: {quantity: max(error, ROUND_OFF) for quantity, error in table.items()}
            for scope, table in apart.items()
        },
        sentence=f"the exact Reissner rods, with the beams' stretch and shear, which the elastica leaves out; {confirmed}",
    )


def solid_limit(scene: Scene, measured: Measured, *, quick: bool = False) -> Reference | None:
    """Return what the solid of the scene's material converges to, contacts closed without penetration; None if a mesh did not complete.

    It is as uncertain as the last two meshes differ.
    """
    cases = limit_cases(scene, quick=quick)
    series = [measured[case].response for case in cases]
    if not all(response.completed for response in series):
        return None
    found = Reference(response=extrapolated(series), scene=scene, uncertainty={}, sentence="")
    apart = errors(series[-2], series[-1], scene, scale=scales(found.response), end=found.end)
    meshes = ", ".join(case.label.removeprefix(f"{case.family} ") for case in cases)
    known = f"known to {apart['path']['force']:.1e} of the largest force"
    return replace(found, uncertainty=apart, sentence=f"extrapolated from {meshes}, {known}")


def extrapolated(responses: Sequence[Response]) -> Response:
    """Return the limit of the last three responses, coarse to fine with a constant ratio of refinement, at the same load parameters.

    With the differences ``d1, d2`` of successive responses, the limit of a quantity is ``q = q3 + d2 / (|d1|/|d2| - 1)`` (Richardson,
    Aitken). The norm is the maximum over the load parameters, so that the order is observed and not assumed. If ``|d2|`` is more than
    nine tenths of ``|d1|``, nothing is added. The last difference ``|d2|`` is the stated uncertainty of the limit. It is larger than the
    error at a constant order, because a local singularity, as under a load on one node, lowers the order on fine meshes.
    """

    def limit(read: Callable[[Response], Mapping[str, Array]]) -> dict[str, Array]:
        coarse, middle, fine = (read(one) for one in responses[-3:])
        last = {name: fine[name] - middle[name] for name in fine}
        d1, d2 = _largest([middle[name] - coarse[name] for name in fine]), _largest(last.values())
        factor = d2 / (d1 - d2) if 0.0 < 1.1 * d2 < d1 else 0.0
        return {name: values + factor * last[name] for name, values in fine.items()}

    best = responses[-1]
    force, moment = limit(forces), limit(moments)
    arc = limit(lambda one: {pair: contact.arc_position for pair, contact in one.contacts.items()})
    axis = limit(lambda one: sampled_axes(one).position)
    return replace(
        best,
        contacts={
            pair: replace(contact, force=force[pair], arc_position=arc[pair])
            for pair, contact in best.contacts.items()
        },
        supports={
            # with contacts only their forces are extrapolated
            node: replace(support, force=force.get(node, support.force), moment=moment[node])
            for node, support in best.supports.items()
        },
        material_force=limit(lambda one: one.material_force),
        tips=limit(lambda one: one.tips),
        axis_line=SampledAxes(arc_length=sampled_axes(best).arc_length, position=axis),
    )


def _largest(parts: Iterable[Array]) -> float:
    return max((float(np.nanmax(np.abs(part), initial=0.0)) for part in parts), default=0.0)

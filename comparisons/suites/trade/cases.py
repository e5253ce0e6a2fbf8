"""What a trade-off solves: the settings that are swept, and what their errors are measured against, the exact rods and the limit of the solid."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import log

import numpy as np

from comparisons.answer import Array, Response
from comparisons.answer.axis import SampledAxes, sampled_axes
from comparisons.answer.errors import Errors, errors
from comparisons.answer.quantities import QUANTITIES, forces, moments, scales, size
from comparisons.frozen import Frozen
from comparisons.models import MODELS, ROD, SOLID, TSM, Model
from comparisons.models.solid import REFINED
from comparisons.scene import Scene
from comparisons.suite import Case, case
from comparisons.suite.run import Results
from comparisons.suite.settings import changed
from tsm.elements import EXACT, MIXED_NO_BOW, PAPER

PENALTIES = (1e-4, 1e-2, 1e2)
"""Penalties over Young's modulus times width; the automatic one is 25."""
PENETRATION = 1e-10
ROUND_OFF = 2.0**-52
"""Least uncertainty of a reference, also where two answers are equal."""


def sweep_cases(scene: Scene, *, quick: bool) -> list[Case]:
    """Return the cases of the sweep, each once, without the longest if quick."""
    every = (one for model in MODELS.values() for one in _settings(model, scene, quick=quick))
    return list(dict.fromkeys(every))


def load_steps(scene: Scene) -> tuple[int, ...]:
    """Return numbers of load steps whose load parameters are among the scene's: 1, near 5, near 10, and all."""
    count = scene.load_parameters
    divisors = [n for n in range(1, count + 1) if count % n == 0]
    return tuple(sorted({min(divisors, key=lambda n: abs(log(n / wanted))) for wanted in (1, 5, 10, count)}))


def limit_cases(scene: Scene, *, quick: bool) -> list[Case]:
    """Return the solids for the extrapolation to the limit, coarse to fine: Q2 elements, contact without penetration."""
    return [solid(scene, mesh, penetration=PENETRATION) for mesh in (REFINED[:3] if quick else REFINED[1:])]


def _settings(model: Model, scene: Scene, *, quick: bool) -> Iterator[Case]:
    """Yield the resolutions of a model with several numbers of load steps, and variants of one resolution with all of them."""
    if not model.meshed:
        if model.reference is None:  # the exact rod is among the references
            yield case(scene, model)
        return
    plain, steps = solid(scene).scene if model.continuum else scene, load_steps(scene)
    for count in (steps[0], *steps[-2:]) if quick else steps:
        stepped = replace(plain, load_parameters=count)
        for options in model.resolutions(quick=quick):
            yield Case(scene=stepped, model=model.name, options=options)
    if model is TSM and not quick:
        yield _exact(scene, 1e-3)
        kinds = (*PAPER[1:], MIXED_NO_BOW)
        yield from (case(scene, TSM, element=one.name, elements=n) for one in kinds for n in (5, 10, 20, 40))
    if model is SOLID:
        yield from limit_cases(scene, quick=quick)
        if not quick:
            yield solid(scene, REFINED[3])
        for order in ("Q1", "Q2-full"):
            yield from (solid(scene, mesh, order) for mesh in REFINED[: 2 if quick else 4])
        beam = scene.beams[0]
        stiffness = float(f"{beam.youngs_modulus * beam.section()[0] / beam.rectangle_height:.2g}")
        for factor in PENALTIES[:2] if quick else PENALTIES:
            yield solid(scene, (25, 2), penalty=factor * stiffness)
        yield solid(scene, (25, 2), penetration=PENETRATION)


def _exact(scene: Scene, tolerance: float) -> Case:
    """Return TSM with an exact element a beam."""
    return case(scene, TSM, element=EXACT.name, elements=1, integration_tolerance=tolerance)


def solid(
    scene: Scene, mesh: tuple[int, int] | None = None, order: str = "Q2", **contact: float | None
) -> Case:
    """Return the solid with elements of an order, and with another penalty or penetration of every contact if one is given."""
    given = {"penalty": None, "penetration": None, **contact} if contact else {}
    changes = {f"contact.{key}": value for key, value in given.items()}
    scene = changed(scene, {"beam.solid_element": order, **changes})
    return case(scene, SOLID, mesh=mesh)


def chains(cases: Iterable[Case]) -> Iterator[list[Case]]:
    """Yield the cases that differ in resolution only, three or more, coarse to fine; solids are refined alike in both directions."""
    found: dict[Case, list[Case]] = {}
    for one in cases:
        if one.options.mesh in (None, *REFINED):
            alike = replace(one, options=replace(one.options, elements=None, mesh=None))
            found.setdefault(alike, []).append(one)
    return (sorted(chain, key=lambda one: one.resolution) for chain in found.values() if len(chain) > 2)


class NoReferenceError(ValueError):
    """The exact rods did not complete: one line."""


class Reference(Frozen):
    """A response that errors are measured against, its uncertainty by scope and quantity, and what it is in one sentence."""

    response: Response
    uncertainty: Errors
    sentence: str

    @property
    def end(self) -> float:
        """The load parameter of the scope ``end``."""
        return _end(self.response)

    def errors(self, response: Response, scene: Scene) -> Errors:
        """Return the errors of a response."""
        return errors(response, self.response, scene, end=self.end)


def _end(response: Response) -> float:
    """The last load parameter at which a response carries a force."""
    carries = np.any([size(values) > 0.0 for values in forces(response).values()], axis=0)
    times = response.load_parameter
    return float(times[carries][-1] if carries.any() else times[-1])


def reference_cases(scene: Scene) -> list[Case]:
    """Return the exact rods, and the exact elements that confirm them."""
    return [case(scene, ROD), _exact(scene, 1e-12)]


def best_reference(scene: Scene, measured: Results) -> Reference:
    """Return the answer of the exact rods, as uncertain as its difference from exact TSM elements."""
    # the rods and not the elastica: every model of the sweep stretches and shears
    rod, exact = (measured[one].response for one in reference_cases(scene))
    if not rod.completed:
        raise NoReferenceError(f"{scene.name}: the exact rods stopped: {rod.message}")
    apart = errors(exact if exact.completed else rod, rod, scene, end=_end(rod))
    confirmed = "TSM exact, which would confirm them, did not complete"
    if exact.completed:
        within = f"{apart['path']['force']:.1e} of the largest force"
        confirmed = f"TSM exact, which shares no code with them, agrees within {within}"
    least = {scope: {name: max(e, ROUND_OFF) for name, e in table.items()} for scope, table in apart.items()}
    what = "the exact Reissner rods, with the beams' stretch and shear, which the elastica leaves out"
    return Reference(response=rod, uncertainty=least, sentence=f"{what}; {confirmed}")


def solid_limit(scene: Scene, measured: Results, *, quick: bool) -> Reference | None:
    """Return what the solid converges to, as uncertain as its last meshes differ; None if one stopped."""
    cases = limit_cases(scene, quick=quick)
    series = [measured[one].response for one in cases]
    if not all(response.completed for response in series):
        return None
    limit = extrapolated(series)
    apart = errors(series[-2], series[-1], scene, scale=scales(limit), end=_end(limit))
    meshes = ", ".join(one.label.removeprefix(f"{one.family} ") for one in cases)
    sentence = f"extrapolated from {meshes}, known to {apart['path']['force']:.1e} of the largest force"
    return Reference(response=limit, uncertainty=apart, sentence=sentence)


def extrapolated(responses: Sequence[Response]) -> Response:
    """Return the limit ``q3 + d2 / (|d1|/|d2| - 1)`` of the last three responses (Richardson, Aitken)."""
    # the norms are maxima over the load parameters, so that the order is observed; its uncertainty is |d2|,
    # more than the error at a constant order, because a local singularity, as under a load on one node,
    # lowers the order on fine meshes

    def limit(read: Callable[[Response], Mapping[str, Array]]) -> dict[str, Array]:
        _, middle, fine = series = [read(one) for one in responses[-3:]]
        d1, d2 = (
            max((float(np.nanmax(np.abs(b[name] - a[name]), initial=0.0)) for name in fine), default=0.0)
            for a, b in pairwise(series)
        )
        factor = d2 / (d1 - d2) if 0.0 < 1.1 * d2 < d1 else 0.0
        return {name: values + factor * (values - middle[name]) for name, values in fine.items()}

    best, force, moment = responses[-1], limit(forces), limit(moments)
    arc = limit(QUANTITIES["arc"].read)
    axis = limit(lambda one: sampled_axes(one).position)
    closed, held = best.contacts.items(), best.supports.items()
    return replace(
        best,
        contacts={pair: replace(one, force=force[pair], arc_position=arc[pair]) for pair, one in closed},
        # with contacts only their forces are extrapolated
        supports={at: replace(one, force=force.get(at, one.force), moment=moment[at]) for at, one in held},
        material_force=limit(lambda one: one.material_force),
        tips=limit(lambda one: one.tips),
        axis_line=SampledAxes(arc_length=sampled_axes(best).arc_length, position=axis),
    )

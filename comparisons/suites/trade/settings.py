"""The settings that are swept: model, element, resolution, order, penalty and load steps, each a complete case."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from math import log

from comparisons.models import MODELS, SOLID, TSM, Model
from comparisons.models.solid import REFINED
from comparisons.scene import Scene
from comparisons.suite import Case, case
from comparisons.suite.settings import changed
from tsm.elements import EXACT, MIXED_NO_BOW, PAPER, ElementType

LIMIT = REFINED[1:]
"""The meshes that the solid's limit is extrapolated from."""
QUICK_LIMIT = ((25, 1), (50, 2), (100, 4))
PENALTIES = (1e-4, 1e-2, 1e2)
"""Penalties over Young's modulus times width; the automatic one is 25."""
PENETRATION = 1e-10


def sweep_cases(scene: Scene, *, quick: bool = False) -> list[Case]:
    """Return the cases of the sweep, each once, without the longest if quick."""
    every = (one for model in MODELS.values() for one in _settings(model, scene, quick=quick))
    return list(dict.fromkeys(every))


def load_steps(scene: Scene) -> tuple[int, ...]:
    """Return numbers of load steps whose load parameters are among the scene's: 1, near 5, near 10, and all."""
    count = scene.load_parameters
    divisors = [n for n in range(1, count + 1) if count % n == 0]
    return tuple(sorted({min(divisors, key=lambda n: abs(log(n / wanted))) for wanted in (1, 5, 10, count)}))


def limit_cases(scene: Scene, *, quick: bool = False) -> list[Case]:
    """Return the solids for the extrapolation to the limit, coarse to fine: Q2 elements, contact without penetration."""
    return [solid(scene, mesh, penetration=PENETRATION) for mesh in (QUICK_LIMIT if quick else LIMIT)]


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
        yield beams(scene, EXACT, 1, tolerance=1e-3)
        yield from (beams(scene, kind, n) for kind in (*PAPER[1:], MIXED_NO_BOW) for n in (5, 10, 20, 40))
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


def beams(scene: Scene, kind: ElementType, elements: int, tolerance: float | None = None) -> Case:
    """Return TSM with elements of a type."""
    return case(scene, TSM, element=kind.name, elements=elements, integration_tolerance=tolerance)


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

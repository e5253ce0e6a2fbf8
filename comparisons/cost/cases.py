"""The settings that are swept: model, element, resolution, order, penalty and load steps, each a complete case."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from math import log

from comparisons.cases import Case
from comparisons.models import MODELS, SOLID, TSM, Model
from comparisons.models.options import Options
from comparisons.models.solid import REFINED
from comparisons.scene import Scene
from tsm.elements import EXACT, MIXED_NO_BOW, PAPER, ElementType

LIMIT = REFINED[1:]
"""The meshes that the solid's limit is extrapolated from."""
PENALTIES = (1e-4, 1e-2, 1e2)
"""Penalties over Young's modulus times width; the automatic one is 25."""
PENETRATION = 1e-10
QUICK_LIMIT = ((25, 1), (50, 2), (100, 4))


def sweep_cases(scene: Scene, *, quick: bool = False) -> list[Case]:
    """Return the cases of the sweep, each once: the settings of every model, whether or not it can state the scene.

    Parameters
    ----------
    scene : Scene
        Gives the load parameters; fewer load steps hit a part of them.
    quick : bool
        Half of the settings, without those that take longest.
    """
    steps = load_steps(scene)
    some = (steps[0], *steps[-2:]) if quick else steps
    found = [case for model in MODELS.values() for case in _settings(model, scene, some, quick=quick)]
    return list(dict.fromkeys(found))


def load_steps(scene: Scene) -> tuple[int, ...]:
    """Return numbers of load steps whose load parameters are among the scene's: 1, near 5, near 10, and all."""
    count = scene.load_parameters
    divisors = [n for n in range(1, count + 1) if count % n == 0]
    return tuple(sorted({min(divisors, key=lambda n: abs(log(n / wanted))) for wanted in (1, 5, 10, count)}))


def limit_cases(scene: Scene, *, quick: bool = False) -> list[Case]:
    """Return the solids for the extrapolation to the limit, coarse to fine: Q2 elements, contact without penetration."""
    exact = with_contact(with_order(scene, "Q2"), penetration=PENETRATION)
    return [_solid(exact, mesh) for mesh in (QUICK_LIMIT if quick else LIMIT)]


def _settings(model: Model, scene: Scene, steps: Sequence[int], *, quick: bool) -> Iterator[Case]:
    """Yield the resolutions of a model with several numbers of load steps, and variants of one resolution with all of them."""
    if not model.meshed:
        if model.reference is None:  # the exact rod is among the references
            yield Case(scene=scene, model=model.name)
        return
    plain = with_order(scene, "Q2") if model.continuum else scene
    for count in steps:
        stepped = replace(plain, load_parameters=count)
        yield from (
            Case(scene=stepped, model=model.name, options=options)
            for options in model.resolutions(quick=quick)
        )
    if model is TSM and not quick:
        yield _beam(scene, EXACT, 1, tolerance=1e-3)
        yield from (_beam(scene, kind, n) for kind in (*PAPER[1:], MIXED_NO_BOW) for n in (5, 10, 20, 40))
    if model is SOLID:
        yield from limit_cases(scene, quick=quick)
        yield from _solid_variants(scene, quick=quick)


def _solid_variants(scene: Scene, *, quick: bool) -> Iterator[Case]:
    """Other orders, penalties and meshes with all load steps."""
    if not quick:
        yield _solid(with_order(scene, "Q2"), REFINED[3])
    for order in ("Q1", "Q2-full"):
        yield from (_solid(with_order(scene, order), mesh) for mesh in REFINED[: 2 if quick else 4])
    for factor in PENALTIES[:2] if quick else PENALTIES:
        yield _solid(with_contact(with_order(scene, "Q2"), penalty=factor * _line_stiffness(scene)), (25, 2))
    yield _solid(with_contact(with_order(scene, "Q2"), penetration=PENETRATION), (25, 2))


def _line_stiffness(scene: Scene) -> float:
    """Young's modulus times width of the first beam, to two digits."""
    beam = scene.beams[0]
    width = beam.cross_section[0] / beam.rectangle_height
    return float(f"{beam.youngs_modulus * width:.2g}")


def _beam(scene: Scene, kind: ElementType, elements: int, tolerance: float | None = None) -> Case:
    options = Options(element=kind.name, elements=elements, integration_tolerance=tolerance)
    return Case(scene=scene, model=TSM.name, options=options)


def _solid(scene: Scene, mesh: tuple[int, int]) -> Case:
    return Case(scene=scene, model=SOLID.name, options=Options(mesh=mesh))


def with_order(scene: Scene, order: str) -> Scene:
    """Return the scene with solid elements of another order."""
    return replace(scene, beams=tuple(replace(beam, solid_element=order) for beam in scene.beams))


def with_contact(scene: Scene, *, penalty: float | None = None, penetration: float | None = None) -> Scene:
    """Return the scene with another penalty or penetration of every contact."""
    return replace(
        scene,
        contacts=tuple(
            replace(contact, penalty=penalty, penetration=penetration) for contact in scene.contacts
        ),
    )


def meshed() -> tuple[str, ...]:
    """Names of the models that have a Pareto front: those with a mesh."""
    return tuple(model.name for model in MODELS.values() if model.meshed)


def family(case: Case) -> str:
    """Name of the cases that differ from this one in resolution, load steps and contact only."""
    return MODELS[case.model].family(case.scene, case.options)


def resolution(case: Case) -> float:
    """Number of elements along a beam, nan of an exact model."""
    return MODELS[case.model].resolution(case.options)


def refined(case: Case, cases: Iterable[Case]) -> list[Case]:
    """Return the members of `cases` that differ from `case` in resolution only; a solid must be refined alike in both directions."""
    found = []
    for other in cases:
        alike = other.options.mesh is None or other.options.mesh in REFINED
        same_scene = (other.scene, other.model) == (case.scene, case.model)
        options = replace(other.options, elements=case.options.elements, mesh=case.options.mesh)
        if alike and same_scene and options == case.options:
            found.append(other)
    return sorted(found, key=resolution)

"""The settings that are swept: model, element, resolution, order, penalty and load steps, each a complete case."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from math import log

from comparisons.cases import Case
from comparisons.models.options import Options
from comparisons.scene import Scene

PAPER = ("timoshenko", "euler-bernoulli-simple", "euler-bernoulli-cantilever", "mixed-no-bow")
MIXED = (2, 3, 5, 10, 20, 40, 80, 160)
REFINED = ((25, 1), (50, 2), (100, 4), (200, 8))
"""Meshes refined alike in both directions: along them an order can be fitted."""
COARSE = ((8, 1), (12, 1), (16, 1), (25, 2))
LIMIT = REFINED[1:]
"""The meshes that the solid's limit is extrapolated from."""
PENALTIES = (1e-4, 1e-2, 1e2)
"""Penalties over Young's modulus times width; the automatic one is 25."""
PENETRATION = 1e-10
QUICK_LIMIT = ((25, 1), (50, 2), (100, 4))


def sweep_cases(scene: Scene, *, quick: bool = False) -> list[Case]:
    """Return the cases of the sweep, each once; elastica and solid are among them whether or not they can state the scene.

    Parameters
    ----------
    scene : Scene
        Gives the load parameters; fewer load steps hit a part of them.
    quick : bool
        Half of the settings, without those that take longest.
    """
    steps = load_steps(scene)
    some = (steps[0], *steps[-2:]) if quick else steps
    found = [*_beams(scene, some, quick=quick), *_solids(scene, some, quick=quick)]
    return list(dict.fromkeys([*found, Case(scene=scene, model="elastica")]))


def load_steps(scene: Scene) -> tuple[int, ...]:
    """Return numbers of load steps whose load parameters are among the scene's: 1, near 5, near 10, and all."""
    count = scene.load_parameters
    divisors = [n for n in range(1, count + 1) if count % n == 0]
    return tuple(sorted({min(divisors, key=lambda n: abs(log(n / wanted))) for wanted in (1, 5, 10, count)}))


def limit_cases(scene: Scene, *, quick: bool = False) -> list[Case]:
    """Return the solids that their limit is extrapolated from, coarse to fine: Q2, closed contact without penetration."""
    exact = with_contact(with_order(scene, "Q2"), penetration=PENETRATION)
    return [_solid(exact, mesh) for mesh in (QUICK_LIMIT if quick else LIMIT)]


def _beams(scene: Scene, steps: Sequence[int], *, quick: bool) -> Iterator[Case]:
    for count in steps:
        stepped = replace(scene, load_parameters=count)
        for n in (1,) if quick else (1, 2, 4):
            yield _tsm(stepped, "exact", n)
        for n in MIXED[:6] if quick else MIXED:
            yield _tsm(stepped, "mixed", n)
        for n in (10, 20, 50) if quick else (5, 10, 20, 50, 100):
            yield _tsm(stepped, "timoshenko", n)
    if not quick:
        yield _tsm(scene, "exact", 1, tolerance=1e-3)
        yield from (_tsm(scene, element, n) for element in PAPER[1:] for n in (5, 10, 20, 40))


def _solids(scene: Scene, steps: Sequence[int], *, quick: bool) -> Iterator[Case]:
    q2 = with_order(scene, "Q2")
    for count in steps:
        stepped = replace(q2, load_parameters=count)
        meshes = (*COARSE, *REFINED[: 2 if quick else 3])
        yield from (_solid(stepped, mesh) for mesh in meshes)
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
    area, inertia, _ = beam.cross_section
    width = beam.width or area / (12.0 * inertia / area) ** 0.5
    return float(f"{beam.youngs_modulus * width:.2g}")


def _tsm(scene: Scene, element: str, elements: int, tolerance: float | None = None) -> Case:
    return Case(
        scene=scene,
        model="tsm",
        options=Options(element=element, elements=elements, tolerance=tolerance),
    )


def _solid(scene: Scene, mesh: tuple[int, int]) -> Case:
    return Case(scene=scene, model="solid", options=Options(mesh=mesh))


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


def family(case: Case) -> str:
    """Name of the cases that differ from this one in resolution, load steps and contact only."""
    if case.model == "tsm":
        return f"TSM {case.options.element or 'mixed'}"
    if case.model == "solid":
        return f"solid {'+'.join(sorted({beam.solid_element for beam in case.scene.beams}))}"
    return case.model


def resolution(case: Case) -> float:
    """Number of elements along a beam, nan of an exact model."""
    along = case.options.elements if case.model == "tsm" else (case.options.mesh or (None,))[0]
    return float("nan") if along is None else float(along)


def refined(case: Case, cases: Iterable[Case]) -> list[Case]:
    """Return those of `cases` that differ from `case` in resolution only, a solid's alike in both directions."""
    found = []
    for other in cases:
        alike = case.model != "solid" or other.options.mesh in REFINED
        same_scene = (other.scene, other.model) == (case.scene, case.model)
        options = replace(other.options, elements=case.options.elements, mesh=case.options.mesh)
        if alike and same_scene and options == case.options:
            found.append(other)
    return sorted(found, key=resolution)

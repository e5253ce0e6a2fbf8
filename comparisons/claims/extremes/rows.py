"""The rows of the maps: models, each with its options and with what its answers are compared."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

from comparisons.cases.case import Case
from comparisons.claims.extremes.cell import Cell
from comparisons.claims.extremes.checks import Against, Check, Energy
from comparisons.claims.extremes.scenes import rigid_in_shear
from comparisons.models import MODELS, ROD, SOLID, TSM
from comparisons.models.options import Options
from comparisons.scene import Scene
from tsm.elements import ELEMENTS, ElementType


def kinds(*, meshed: bool | None = None) -> list[ElementType]:
    """Return the types of TSM elements of the matrix, those without a mesh first; with `meshed` only those with one, or without."""
    found = sorted((kind for kind in ELEMENTS.values() if not kind.variant), key=lambda kind: kind.meshed)
    return [kind for kind in found if meshed in (None, kind.meshed)]


def exact_rod(scene: Scene) -> Case:
    """Return the exact rod on `scene`."""
    return Case(scene=scene, model=ROD.name)


def beam_case(scene: Scene, kind: ElementType, elements: int | None) -> Case:
    """Return TSM on `scene`; elements without a mesh are one per beam, None leaves the others to the scene."""
    options = Options(element=kind.name, elements=elements if kind.meshed else 1)
    return Case(scene=scene, model=TSM.name, options=options)


def against_rod(case: Case) -> Against:
    """Return the comparison of a TSM or solid case with the exact rod of the same shear stiffness."""
    scene = case.scene
    if case.model == TSM.name and not TSM.element(case.options).sheared:
        scene = replace(scene, beams=tuple(rigid_in_shear(beam) for beam in scene.beams))
    return Against(case=exact_rod(scene))


def cell(row: str, column: str, case: Case, *checks: Check) -> Cell:
    """Return the cell of a case, by default against the rod."""
    return Cell(row=row, column=column, case=case, checks=checks or (against_rod(case),))


def beams(
    column: str, scene: Scene, elements: int | None, *, only: Iterable[ElementType] | None = None
) -> Iterator[Cell]:
    """Yield the cells of TSM, and of other models of beams with a mesh as they are, against the rod."""
    for kind in kinds() if only is None else only:
        yield cell(kind.name, column, beam_case(scene, kind, elements))
    for model in MODELS.values():
        if model.meshed and not model.continuum and model is not TSM:
            yield cell(model.name, column, Case(scene=scene, model=model.name))


def solid(column: str, scene: Scene, mesh: tuple[int, int], *checks: Check, row: str = SOLID.name) -> Cell:
    """Return the cell of the solid, by default against the rod."""
    return cell(row, column, Case(scene=scene, model=SOLID.name, options=Options(mesh=mesh)), *checks)


def exact_answers(column: str, scene: Scene) -> Iterator[Cell]:
    """Yield the cells of the models without a mesh: against their energy, and against the rod."""
    rod = Against(case=exact_rod(scene))
    for model in (one for one in MODELS.values() if not one.meshed):
        checks = (Energy(rigid=not model.rod), *(() if model is ROD else (rod,)))
        yield cell(model.name, column, Case(scene=scene, model=model.name), *checks)


def everything(
    column: str, scene: Scene, elements: int | None, mesh: tuple[int, int] | None = None
) -> Iterator[Cell]:
    """Yield the cells of all models on a scene: beams, the solid if it has a mesh, exact answers."""
    yield from beams(column, scene, elements)
    if mesh:
        yield solid(column, scene, mesh)
    yield from exact_answers(column, scene)

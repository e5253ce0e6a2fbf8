"""The rows of the maps: models, each with its options and with what its answers are compared."""

from collections.abc import Iterable
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
    return Case(
        scene=scene,
        model=TSM.name,
        options=Options(element=kind.name, elements=elements if kind.meshed else 1),
    )


def against_rod(case: Case) -> Against:
    """Return the comparison of a TSM or solid case with the exact rod of the same shear stiffness."""
    scene = case.scene
    if case.model == TSM.name and not TSM.element(case.options).sheared:
        scene = replace(scene, beams=tuple(rigid_in_shear(beam) for beam in scene.beams))
    return Against(case=exact_rod(scene))


def beams(
    axis: str, column: str, scene: Scene, elements: int | None, *, only: Iterable[ElementType] | None = None
) -> list[Cell]:
    """Return the cells of TSM, and of other models of beams with a mesh as they are, against the rod."""
    others = (model for model in MODELS.values() if model.meshed and not model.continuum and model is not TSM)
    return [
        *(
            _beam(axis, column, beam_case(scene, kind, elements))
            for kind in (kinds() if only is None else only)
        ),
        *(against(axis, model.name, column, Case(scene=scene, model=model.name)) for model in others),
    ]


def _beam(axis: str, column: str, case: Case) -> Cell:
    return against(axis, TSM.element(case.options).name, column, case)


def against(axis: str, row: str, column: str, case: Case) -> Cell:
    """Return the cell of a case against the rod."""
    return Cell(axis=axis, row=row, column=column, case=case, checks=(against_rod(case),))


def solids(
    axis: str,
    column: str,
    scene: Scene,
    mesh: tuple[int, int],
    *,
    row: str = SOLID.name,
    checks: tuple[Check, ...] = (),
) -> list[Cell]:
    """Return the cell of the solid, by default against the rod."""
    case = Case(scene=scene, model=SOLID.name, options=Options(mesh=mesh))
    return [Cell(axis=axis, row=row, column=column, case=case, checks=checks or (against_rod(case),))]


def exact_answers(axis: str, column: str, scene: Scene) -> list[Cell]:
    """Return the cells of the models without a mesh: against their energy, and against the rod."""
    rod = exact_rod(scene)
    return [
        Cell(
            axis=axis,
            row=model.name,
            column=column,
            case=Case(scene=scene, model=model.name),
            checks=(Energy(rigid=not model.rod), *(() if model is ROD else (Against(case=rod),))),
        )
        for model in MODELS.values()
        if not model.meshed
    ]


def everything(
    axis: str, column: str, scene: Scene, elements: int | None, mesh: tuple[int, int] | None = None
) -> list[Cell]:
    """Return the cells of all models on a scene: beams, the solid if it has a mesh, exact answers."""
    solid = solids(axis, column, scene, mesh) if mesh else []
    return [*beams(axis, column, scene, elements), *solid, *exact_answers(axis, column, scene)]


def with_check(cell: Cell, *checks: Check) -> Cell:
    """Return `cell` with further checks."""
    return replace(cell, checks=(*cell.checks, *checks))

"""The rows of the maps: models, each with its options and with what its answers are compared."""

from dataclasses import replace

from comparisons.cases.case import Case
from comparisons.claims.extremes.allowance import PAPER, RIGID
from comparisons.claims.extremes.cell import Cell
from comparisons.claims.extremes.checks import Against, Check, Energy
from comparisons.claims.extremes.scenes import rigid_in_shear
from comparisons.models.options import Options
from comparisons.scene import Scene

ELEMENTS = ("exact", "mixed", *PAPER)
"""The TSM elements of the matrix."""


def exact_rod(scene: Scene) -> Case:
    """Return the exact rod on `scene`."""
    return Case(scene=scene, model="rod")


def beam_case(scene: Scene, element: str, elements: int | None) -> Case:
    """Return TSM on `scene`; exact elements are one per beam, None leaves the others to the scene."""
    return Case(
        scene=scene,
        model="tsm",
        options=Options(element=element, elements=1 if element == "exact" else elements),
    )


def against_rod(case: Case) -> Against:
    """Return the comparison of a TSM or solid case with the exact rod of the same shear stiffness."""
    scene = case.scene
    if case.options.element in RIGID:
        scene = replace(scene, beams=tuple(rigid_in_shear(beam) for beam in scene.beams))
    return Against(case=exact_rod(scene))


def beams(
    axis: str, column: str, scene: Scene, elements: int | None, *, only: tuple[str, ...] = ELEMENTS
) -> list[Cell]:
    """Return the cells of TSM, against the rod."""
    return [_beam(axis, column, beam_case(scene, element, elements)) for element in only]


def _beam(axis: str, column: str, case: Case) -> Cell:
    row = case.options.element or "mixed"
    return Cell(axis=axis, row=row, column=column, case=case, checks=(against_rod(case),))


def solids(
    axis: str,
    column: str,
    scene: Scene,
    mesh: tuple[int, int],
    *,
    row: str = "solid",
    checks: tuple[Check, ...] = (),
) -> list[Cell]:
    """Return the cell of the solid, by default against the rod."""
    case = Case(scene=scene, model="solid", options=Options(mesh=mesh))
    return [Cell(axis=axis, row=row, column=column, case=case, checks=checks or (against_rod(case),))]


def exact_answers(axis: str, column: str, scene: Scene) -> list[Cell]:
    """Return the cells of rod and elastica: their energies, and each other."""
    rod, elastica = exact_rod(scene), Case(scene=scene, model="elastica")
    return [
        Cell(axis=axis, row="rod", column=column, case=rod, checks=(Energy(),)),
        Cell(
            axis=axis,
            row="elastica",
            column=column,
            case=elastica,
            checks=(Energy(rigid=True), Against(case=rod)),
        ),
    ]


def with_check(cell: Cell, *checks: Check) -> Cell:
    """Return `cell` with further checks."""
    return replace(cell, checks=(*cell.checks, *checks))

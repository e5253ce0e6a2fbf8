"""The two discrete models, TSM beams and the solid, as responses."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from comparisons.options import Options
from comparisons.response import Array, ContactHistory, Grid, Response, SupportHistory
from comparisons.scene import BeamSpec, Scene
from comparisons.translate import to_solid, to_structure


def solve_tsm(scene: Scene, options: Options) -> Response:
    """Solve `scene` by the tangent stiffness method."""
    import tsm

    structure = to_structure(scene, elements=options.elements, element=options.element)
    try:
        result = tsm.solve(structure, np.array(scene.times))
    except tsm.SolveError as error:
        result = error.result

    def grid(k: int) -> Grid:
        return _beam_grid(scene, result, k)

    tips = {
        beam.name: np.array([_free_end(result, beam, k) for k in range(len(result.load_parameter))]).reshape(
            -1, 2
        )
        for beam in scene.beams
    }
    slipped = {
        event.pair: event.load_parameter for event in reversed(result.events) if event.kind.name == "SLIP_OFF"
    }
    response = _response("tsm", scene, result, result.axis_line, grid, slipped=slipped)
    return replace(response, tips=tips)


def solve_solid(scene: Scene, options: Options) -> Response:
    """Solve `scene` with solid elements and penalty contact."""
    import fem_reference

    problem = to_solid(scene, mesh=options.mesh)
    try:
        result = fem_reference.solve(problem, np.array(scene.times))
    except fem_reference.SolveError as error:
        result = error.result

    def axis_line(_: str, k: int) -> tuple[Array, Array]:
        return fem_reference.axis_stations(result), fem_reference.axis_line(result, k)

    def grid(k: int) -> Grid:
        displacement = result.displacement[k]
        data = {
            "displacement": displacement,
            "deformed": result.mesh_points + displacement,
            "cauchy_stress": fem_reference.nodal_stress(result, k),
        }
        return Grid(points=result.mesh_points, cells={"quad9": result.mesh_cells}, point_data=data)

    return _response("solid", scene, result, axis_line, grid, compliance=1.0 / problem.contact.penalty)


def _response(
    model: str,
    scene: Scene,
    result: Any,
    axis_line: Callable[[str, int], tuple[Array, Array]],
    grid: Callable[[int], Grid],
    *,
    compliance: float = 0.0,
    slipped: dict[str, float] | None = None,
) -> Response:
    """Take over what both solvers' results have in common."""
    contacts = {
        pair: ContactHistory(
            force=history.force,
            arc_position=history.arc_position,
            gap=history.gap,
            compliance=compliance,
            slip_off=(slipped or {}).get(pair, np.nan),
        )
        for pair, history in result.contacts.items()
    }
    return Response(
        model=model,
        scene=scene.name,
        status=result.status.name,
        message=result.message,
        completed=result.status.name == "COMPLETED",
        load_parameter=result.load_parameter,
        contacts=contacts,
        supports={
            beam: SupportHistory(force=support.force, moment=support.moment)
            for beam, support in result.supports.items()
        },
        tips=dict(result.tips),
        newton_iterations=result.newton_iterations,
        cutbacks=result.cutbacks,
        unknowns=result.unknowns,
        wall_seconds=result.wall_seconds,
        axis_line=axis_line,
        grid=grid,
    )


def _beam_grid(scene: Scene, result: Any, k: int) -> Grid:
    """Return the TSM elements, each with its own two points: section forces jump at a contact.

    Besides the fields, `beam` is the beam's number in the scene and `arc` the distance along its undeformed axis.
    """
    parts = [_one_beam(scene, number, result, k) for number in range(len(scene.beams))]
    data = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    points = data.pop("reference")
    return Grid(points=points, cells={"line": np.arange(len(points)).reshape(-1, 2)}, point_data=data)


def _one_beam(scene: Scene, number: int, result: Any, k: int) -> dict[str, Array]:
    beam = scene.beams[number]
    shape, forces = result.shape(beam.name, k), result.section_forces(beam.name, k).reshape(-1, 3)
    fraction = np.linspace(0.0, 1.0, len(shape))[:, None]
    reference = (1.0 - fraction) * np.array(beam.start) + fraction * np.array(beam.end)
    return {
        "reference": _pairs(reference),
        "displacement": _pairs(shape[:, :2] - reference),
        "deformed": _pairs(shape[:, :2]),
        "rotation": _pairs(shape[:, 2]),
        "N": forces[:, 0],
        "V": forces[:, 1],
        "M": forces[:, 2],
        "beam": np.full(len(forces), float(number)),
        "arc": _pairs(fraction[:, 0] * beam.length),
    }


def _free_end(result: Any, beam: BeamSpec, k: int) -> Array:
    """Return the deformed position of the end that is not clamped, of the beam's end if both are."""
    node = 0 if beam.clamped == ("end",) else -1
    return np.asarray(result.shape(beam.name, k)[node, :2])


def _pairs(values: Array) -> Array:
    """Values (e + 1, ...) at nodes as values (2 e, ...) at the elements' ends."""
    return np.repeat(values, 2, axis=0)[1:-1]

"""What several models state alike: ends that meet, weights, and the histories in the results of both solvers."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from comparisons.answer import Array, CriticalPoint, Response, SupportHistory
from comparisons.scene import BeamSpec, PinSpec, Scene

POINTS = 401
"""Points of a deflected axis in pictures. The exact solutions do not depend on this number."""
Axis = tuple[Any, Any]
"""Arc lengths (m,) and positions (m, 2) of a deformed axis."""
Force = tuple[float, float]


def joints(scene: Scene) -> list[list[str]]:
    """Return the ends of beams that meet, as ``column.end``, one list for each joint."""
    return [[f"{beam.name}.{end}" for beam, end in ends] for ends in scene.meeting.values() if len(ends) > 1]


def occupied(scene: Scene) -> set[str]:
    """Return the ends of beams at which more than a support may act: those with loads, springs, joints or hinges."""
    joined = {end for ends in joints(scene) for end in ends}
    acting = {one.node for one in (*scene.hinges, *scene.springs)}
    return joined | acting | {load.node for _, load in scene.numbered_loads()}


def line_loads(scene: Scene) -> Iterator[tuple[BeamSpec, int, tuple[Force, ...], Force]]:
    """Yield the forces per length, then the weights: beam, stage, coefficients along the beam, and the part of its length."""
    for stage, load in scene.numbered_loads():
        if load.force_per_length is not None:
            yield scene.beam(load.beam), stage, (load.force_per_length,), load.span
    for beam in scene.beams:
        for stage, (gx, gy) in enumerate(scene.stage_gravities):
            if beam.density is not None and (gx or gy):
                weight = tuple((gx * mass, gy * mass) for mass in beam.mass_coefficients())
                yield beam, stage, weight, (0.0, 1.0)


def kept(record: object, names: str) -> dict[str, Any]:
    """Return what a record has under some names, which are the same where it goes."""
    return {name: getattr(record, name) for name in names.split()}


def ways(pin: PinSpec) -> dict[str, Any]:
    """Return the path of a pin in the first stage and the points of its way onward in each of the others."""
    path, *onward = pin.stage_points
    return {"path": path, "onward": tuple(points[1:] for points in onward)}


def rows(found: Any, width: int) -> Array:
    """Return a list of vectors as an array (n, width), also where the list is empty."""
    return np.array(found, dtype=np.float64).reshape(-1, width)


def of_result(
    scene: Scene,
    result: Any,
    axis_line: Callable[[str, int], Axis],
    line: Callable[[str, int], Array],
    **more: Any,
) -> Response:
    """Return the response of one of the solvers; `line(beam, k)` has the positions at both ends of the axis, `more` what is its own."""
    tips = {beam.name: 0 if scene.tip(beam.name) == "start" else -1 for beam in scene.beams}
    steps = range(len(result.load_parameter))
    return Response(
        **kept(result, "message load_parameter newton_iterations cutbacks unknowns wall_seconds index"),
        status=result.status.name,
        supports={item.node: _held(result.supports[item.node]) for item in scene.all_supports},
        springs={end: _held(one) for end, one in result.springs.items()},
        tips={beam: rows([line(beam, k)[end] for k in steps], 2) for beam, end in tips.items()},
        axis_line=axis_line,
        critical=tuple(
            CriticalPoint(kind=str(point.kind), **kept(point, "load_parameter mode"))
            for point in result.critical
        ),
        **more,
    )


def _held(found: Any) -> SupportHistory:
    return SupportHistory(**kept(found, "force moment"))

"""What several models state alike: ends that meet, weights, and the histories in the results of both solvers."""

from collections import defaultdict
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from comparisons.models.base import Model
from comparisons.response import Array, ContactHistory, CriticalPoint, Response, SupportHistory
from comparisons.scene import Scene

ENDS = ("start", "end")
POINTS = 401
"""Points of a deflected axis in pictures. The exact solutions do not depend on this number."""
Axis = tuple[Array, Array]
"""Arc lengths (m,) and positions (m, 2) of a deformed axis."""
Force = tuple[float, float]


def joints(scene: Scene) -> list[list[str]]:
    """Return the ends of beams that meet, as ``column.end``, one list for each joint."""
    meeting: dict[Force, list[str]] = defaultdict(list)
    for beam in scene.beams:
        for end in ENDS:
            meeting[scene.place(f"{beam.name}.{end}")].append(f"{beam.name}.{end}")
    return [ends for ends in meeting.values() if len(ends) > 1]


def weights(scene: Scene) -> Iterator[tuple[str, int, tuple[Force, ...]]]:
    """Yield the weights as name of the beam, stage, and coefficients of the force per length along the beam."""
    for beam in scene.beams:
        if beam.density is None:
            continue
        for stage, (gx, gy) in enumerate(scene.stage_gravities):
            if gx or gy:
                yield beam.name, stage, tuple((gx * mass, gy * mass) for mass in beam.mass_coefficients())


def rows(found: Any, width: int) -> Array:
    """Return a list of vectors as an array (n, width), also where the list is empty."""
    return np.array(found, dtype=np.float64).reshape(-1, width)


def history(item: Any, **more: Any) -> ContactHistory:
    """Return the contact history of a solver's result, with what else the model states."""
    return ContactHistory(force=item.force, arc_position=item.arc_position, gap=item.gap, **more)


def of_result(
    model: Model,
    scene: Scene,
    result: Any,
    axis_line: Callable[[str, int], Axis],
    line: Callable[[str, int], Array],
    **more: Any,
) -> Response:
    """Return the response of one of the solvers; `line(beam, k)` has the positions at both ends of the axis, `more` what is its own."""
    tips = {beam.name: 0 if scene.tip(beam.name) == "start" else -1 for beam in scene.beams}
    steps = range(len(result.load_parameter))
    supports = {item.node: result.supports[item.node] for item in scene.all_supports}
    held, springs = (
        {end: SupportHistory(force=one.force, moment=one.moment) for end, one in items.items()}
        for items in (supports, result.springs)
    )
    return Response(
        model=model.name,
        continuum=model.continuum,
        scene=scene.name,
        status=result.status.name,
        message=result.message,
        load_parameter=result.load_parameter,
        supports=held,
        springs=springs,
        tips={beam: rows([line(beam, k)[end] for k in steps], 2) for beam, end in tips.items()},
        newton_iterations=result.newton_iterations,
        cutbacks=result.cutbacks,
        unknowns=result.unknowns,
        wall_seconds=result.wall_seconds,
        axis_line=axis_line,
        index=result.index,
        critical=tuple(
            CriticalPoint(kind=str(point.kind), load_parameter=point.load_parameter, mode=point.mode)
            for point in result.critical
        ),
        **more,
    )

"""A scene as one strip in its own frame, clamped at the origin along +x, for adapters of solid programs."""

from typing import Any, NamedTuple

import numpy as np

from comparisons.models.outside.adapters.exchange import Table, rough


def one_strip(scene: Table) -> str | None:
    """Return why a scene is no strip without friction, clamped at rest at its start; None if it is one."""
    beam, support = scene["beams"][0], scene["supports"][0]
    if len(scene["beams"]) > 1 or len(scene["supports"]) > 1 or beam["height"] is None:
        return "the adapter has one strip of rectangular section with one support"
    if support["motion"] != [0.0, 0.0, 0.0] or support["end"] != "start":
        return "the adapter has a strip that is clamped at rest at its start"
    return rough(scene)


def axes(beam: Table) -> Any:
    """Return the directions along and across a beam as rows: ``axes @ v`` is in the strip's frame, ``v @ axes`` in the scene's."""
    (c, s) = beam["direction"]
    return np.array([[c, s], [-s, c]])


def way(beam: Table, pin: Table) -> tuple[list[float], Any]:
    """Return the load parameters of the corners of a pin's path, and its positions there in the strip's frame, ``(p, 2)``."""
    path = (np.array(pin["path"]) - beam["start"]) @ axes(beam).T
    return [0.0, *pin["corners"], 1.0], path


class Foot(NamedTuple):
    """The foot of a point on a line of quadratic elements."""

    first: int  #: Index of the first of three nodes.
    xi: float  #: Place on the element, from -1 to 1 and beyond the ends of the line outside.
    shape: Any  #: Shape functions (3,).
    normal: Any  #: Unit normal (2,) to the left.
    away: Any  #: Vector (2,) from the foot to the point.


def foot_on(nodes: Any, point: Any, first: int = 0) -> Foot:
    """Return the foot of a point on one quadratic element, nodes (3, 2)."""
    xi = 0.0
    for _ in range(30):
        shape = np.array([xi * (xi - 1.0) / 2.0, 1.0 - xi * xi, xi * (xi + 1.0) / 2.0])
        slope, away = np.array([xi - 0.5, -2.0 * xi, xi + 0.5]) @ nodes, point - shape @ nodes
        step = float(slope @ away / (slope @ slope))
        xi += min(max(step, -1.0), 1.0)
    normal = np.array([-slope[1], slope[0]]) / np.hypot(*slope)
    return Foot(first=first, xi=xi, shape=shape, normal=normal, away=away)


def foot(line: Any, point: Any) -> Foot:
    """Return the foot of a point on a line of quadratic elements, nodes (m, 2)."""
    feet = (foot_on(line[k : k + 3], point, k) for k in range(0, len(line) - 2, 2))
    return min(feet, key=lambda item: abs(item.xi))

"""The deflected axis of a beam at a configuration."""

from __future__ import annotations

import numpy as np

from tsm.elements.properties import Array
from tsm.model.model import Model
from tsm.system.system import Linearisation


def axis_line(
    model: Model, system: Linearisation, beam: str, points_per_element: int | None = None
) -> tuple[Array, Array]:
    """Distances (m,) along the undeformed axis of a beam, and deformed positions (m, 2).

    ``points_per_element``: intervals in every element: 10, and of exact elements so many that the beam has 100.
    """
    place = model.beams[beam]
    group = model.group_of(place)
    xi = np.linspace(0, 1, (points_per_element or group.intervals(place.beam.elements)) + 1)
    axes = group.axes(place, system.state, system.groups[group.number], xi)
    arcs = np.array(place.arcs[:-1])[:, None] + xi * np.array(place.lengths)[:, None]
    return np.append(arcs[:, :-1], place.beam.length), np.concatenate([*axes[:, :-1], axes[-1, -1:]])

"""Deformed axes, sampled at fixed stations for comparison and storage."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from comparisons.answer.record import Array, Grid, not_kept
from comparisons.answer.response import Response
from comparisons.frozen import Frozen
from comparisons.scene import Scene

STATIONS = np.linspace(0.0, 1.0, 101)
"""Arc lengths of the stations, over the length of the beam."""


class SampledAxes(Frozen):
    """Deformed axes as arrays; callable like `Response.axis_line`."""

    arc_length: dict[str, Array]  #: Arc lengths along the undeformed axes, shape (m,), by beam.
    position: dict[str, Array]  #: Deformed positions at the s load parameters (s, m, 2), by beam.

    def __call__(self, beam: str, k: int) -> tuple[Array, Array]:
        """Return arc length (m,) and deformed positions (m, 2) of a beam's axis at load parameter k."""
        return self.arc_length[beam], self.position[beam][k]


def place_of(response: Response, scene: Scene, node: str, k: int) -> Array:
    """Return the position (2,) of a pin, or of a beam's end such as ``upper.end``, at load parameter number k; at rest for k = -1."""
    name, _, end = node.partition(".")
    if end and k >= 0:
        return np.asarray(response.axis_line(name, k)[1][0 if end == "start" else -1])
    t = float(response.load_parameter[k]) if k >= 0 else 0.0
    return np.array(scene.place(node) if end else scene.pin(node).position(t))


def axes_at_stations(response: Response, beam: str, steps: Iterable[int], at: Array = STATIONS) -> Array:
    """Return the deformed axes of a beam at n load parameters and m parts of its length, shape (n, m, 2), by cubic splines through the model's points."""
    from scipy.interpolate import CubicSpline

    lines = [response.axis_line(beam, k) for k in steps]
    if not lines:
        return np.empty((0, len(at), 2))
    first = lines[0][0]
    if all(np.array_equal(arc, first) for arc, _ in lines):
        found = CubicSpline(first, np.stack([line for _, line in lines]), axis=1)(_arcs(first, at))
    else:
        found = np.array([CubicSpline(arc, line)(_arcs(arc, at)) for arc, line in lines])
    # a spline passes through its points up to round-off only; the ends keep the exact values of the model
    found[:, 0], found[:, -1] = [line[0] for _, line in lines], [line[-1] for _, line in lines]
    return np.asarray(found)


def _arcs(arc: Array, at: Array = STATIONS) -> Array:
    return np.asarray(arc[0] + at * (arc[-1] - arc[0]))


def sampled_axes(response: Response) -> SampledAxes:
    """Return the deformed axes of all beams at `STATIONS`; axes that are sampled already are returned unchanged."""
    if isinstance(response.axis_line, SampledAxes):
        return response.axis_line
    steps = range(len(response.load_parameter))
    arcs = {beam: response.axis_line(beam, 0)[0] for beam in response.tips} if steps else {}
    return SampledAxes(
        arc_length={beam: _arcs(arc) for beam, arc in arcs.items()},
        position={beam: axes_at_stations(response, beam, steps) for beam in arcs},
    )


def axis_grid(scene: Scene, axis_line: Callable[[str, int], tuple[Array, Array]], beam: str, k: int) -> Grid:
    """Return the axis of a beam at load parameter k as lines, with its displacements."""
    spec, (arc, line) = scene.beam(beam), axis_line(beam, k)
    points = np.array([spec.place(part) for part in (arc / spec.length).tolist()])
    first = np.arange(len(arc) - 1)
    data = {"displacement": line - points, "deformed": line}
    return Grid(points=points, cells={"line": np.stack([first, first + 1], axis=1)}, point_data=data)


def storable(response: Response, *, axes: bool = True) -> Response:
    """Return a response of arrays only, which can be stored or sent to another process, with its axes at `STATIONS` or without axes.

    Meshes, section forces, the deformation of elements, the certificate and the scene are not kept.
    """
    kept = sampled_axes(response) if axes else SampledAxes(arc_length={}, position={})
    dropped: dict[str, Any] = dict.fromkeys(("sections", "deformation", "certificate", "definition"))
    forces = dict(response.material_force)
    return replace(response, material_force=forces, axis_line=kept, grid=not_kept, **dropped)

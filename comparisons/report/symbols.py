"""Symbols of mechanics as line segments of unit size: supports by what they hold, springs, hinges, moments as arcs.

Every symbol has its node at the origin. A picture turns, enlarges and moves its segments, so that the same symbols are in a picture
and in its legend.
"""

import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from comparisons.answer import Array
from comparisons.answer.table import unit_names
from comparisons.report import palette
from comparisons.scene import BeamSpec, HingeSpec, Scene, SpringSpec, SupportSpec
from comparisons.scene.conditions import COMPONENTS, LoadSpec

Segments = NDArray[np.float64]
"""Line segments, shape (n, 2, 2)."""
SYMBOL = 0.03
"""Size of a symbol over the size of a picture."""
LARGEST = 13.0
"""Largest size of a symbol in a legend, so that it stays in its row [point]."""
LEFT = np.array([[0.0, 1.0], [-1.0, 0.0]])
"""Turns rows of tangents to the left."""
Axis = tuple[Array, Array, Array]
"""Arc lengths (n,), points (n, 2), and unit normals to the left (n, 2)."""
HATCHES = 5
"""Strokes below a ground."""


def axis(beam: BeamSpec, points: int = 41) -> Axis:
    """Return the undeformed axis of a beam."""
    parts = np.linspace(0.0, 1.0, points)
    line, tangents = (np.array(list(map(read, parts.tolist()))) for read in (beam.place, beam.tangent))
    return beam.length * parts, line, tangents @ LEFT


def at_arcs(arc: Array, arcs: Array, line: Array) -> Array:
    """Return the points (n, 2) at arc lengths of a line that is given at others."""
    return np.stack([np.interp(arc, arcs, values) for values in line.T], axis=-1)


def chain(points: Any) -> Segments:
    """Return the segments between neighbouring points."""
    points = np.asarray(points, dtype=float)
    return np.stack([points[:-1], points[1:]], axis=1)


def arc(turn: float, points: int = 25, part: float = 0.75) -> Array:
    """Return a part of a unit circle about the node, shape (points, 2), in the sense of `turn`, anticlockwise if positive."""
    angle = np.linspace(-part * np.pi, part * np.pi, points)[:: 1 if turn > 0.0 else -1]
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _symbol(lines: list[Any], ground: tuple[float, float] = (0.0, 0.0), **_: Any) -> Segments:
    """Return the segments of lines, and of a ground at a height with strokes below it."""
    (y, half), drawn = ground, [chain(line) for line in lines]
    if half:
        strokes = [((x, y), (x - 0.3, y - 0.35)) for x in np.linspace(-half, half, HATCHES + 1)[1:]]
        drawn.append(np.array([((-half, y), (half, y)), *strokes]))
    return np.concatenate(drawn)


_DATA = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
_SPRING = _symbol(**_DATA["spring"])
_ANGLE = np.linspace(0.0, 4.0 * np.pi, 41)
_SPIRAL = chain((0.25 + 0.15 * _ANGLE / np.pi)[:, None] * np.stack([np.cos(_ANGLE), np.sin(_ANGLE)], axis=1))
HINGE = chain(0.35 * arc(1.0, points=17, part=1.0))
SUPPORTS: dict[tuple[str, ...], tuple[str, Segments]] = {
    tuple(held.split()): (words, _symbol(**one))
    for one in _DATA["support"]
    for held, words in one["named"].items()
}
"""Names and symbols of supports by the components that they hold."""


def _turned(segments: Segments, held: tuple[str, ...], away: Array) -> Segments:
    """Return segments turned such that their second axis points from the ground to the node: along the beam at a clamp, else along an axis."""
    up = away
    if held != COMPONENTS:
        up = np.array([1.0, 0.0] if held in (("x",), ("x", "rotation")) else [0.0, 1.0])
        up = -up if away @ up < -0.5 else up
    return np.asarray(segments @ np.array([up @ LEFT.T, up]))


def fixings(kinds: Iterable[int], away: Array) -> Iterator[tuple[tuple[str, ...], Segments]]:
    """Yield the symbols at an end of supports (kind 1) and springs (kind 2); `away` points into the beam."""
    named = list(zip(COMPONENTS, kinds, strict=True))
    held = tuple(name for name, kind in named if kind == 1)
    if held:
        yield held, _turned(SUPPORTS[held][1], held, away)
    for name in (name for name, kind in named if kind == 2):
        yield (name,), _SPIRAL if name == "rotation" else _turned(_SPRING, (name,), away)


def kinds(one: SupportSpec | SpringSpec) -> list[int]:
    """Return the kinds of `fixings` of the components of an end."""
    return [(1 + isinstance(one, SpringSpec)) * (name in one.held) for name in COMPONENTS]


class Symbol(NamedTuple):
    """The symbol of what is at a beam's end: segments (n, 2, 2) of unit size about the node, and its words."""

    item: SupportSpec | SpringSpec | HingeSpec
    words: str
    segments: Segments


def end_symbols(scene: Scene) -> list[Symbol]:
    """Return the symbols of the supports, springs and hinges of a scene."""
    units = unit_names(scene.units)
    stiff = f"{units['moment']}/rad"
    found = []
    for one in scene.holding:
        for names, segments in fixings(kinds(one), inward(scene, one)):
            words = SUPPORTS[names][0]
            if isinstance(one, SpringSpec):
                stiffness = dict(zip(COMPONENTS, (*one.stiffness, one.rotation), strict=True))[names[0]]
                unit = stiff if names == ("rotation",) else units["stiffness"]
                words = f"spring of {stiffness:.6g} {unit} in {names[0]}"
            found.append(Symbol(one, words, segments))
    for hinge in scene.hinges:
        words = f"hinge with a spring of {hinge.stiffness:.6g} {stiff}" if hinge.stiffness else "hinge"
        found.append(Symbol(hinge, words, HINGE))
    return found


def draw_symbols(
    axes: Any, scene: Scene, lines: Mapping[str, Sequence[Array]], size: float
) -> dict[str, Any]:
    """Draw the symbols at the ends of axes, arc lengths and points (m, 2), by beam; return their entries in a legend."""
    from matplotlib.collections import LineCollection

    symbols = end_symbols(scene)
    for one in symbols:
        drawn = lines[one.item.beam][1][0 if one.item.end == "start" else -1] + size * one.segments
        axes.add_collection(LineCollection(list(drawn), colors=palette.BLACK, linewidths=1.0, zorder=4))
        axes.update_datalim(drawn.reshape(-1, 2))
    return {one.words: legend_symbol(one.segments) for one in symbols}


def legend_symbol(segments: Segments, colour: str = palette.BLACK) -> Any:
    """Return an entry of a legend that shows segments of unit size."""
    from matplotlib.lines import Line2D
    from matplotlib.path import Path as Marker

    vertices = segments.reshape(-1, 2)
    vertices = vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    marker = Marker(vertices, [Marker.MOVETO, Marker.LINETO] * len(segments))
    size = min(13 * float(np.abs(vertices).max()), LARGEST)  # matplotlib enlarges all markers to one size
    style: dict[str, Any] = {"marker": marker, "markersize": size, "markerfacecolor": "none"}
    return Line2D([], [], color=colour, linestyle="none", **style)


def inward(scene: Scene, one: SupportSpec | SpringSpec | LoadSpec) -> Array:
    """Return the unit vector from an end, where there is a support, a spring or a load, into its beam."""
    beam = scene.beam(one.beam)
    return np.array(beam.tangent(0.0)) if one.end == "start" else -np.array(beam.tangent(1.0))

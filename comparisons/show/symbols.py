"""Symbols of mechanics as line segments of unit size: supports by what they hold, moments as arcs.

Every symbol has its node at the origin. A picture turns, enlarges and moves its segments, so that the same symbols are drawn by
matplotlib and by pyvista, and stand in a legend.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.response import Array
from comparisons.scene import HingeSpec, Scene, SpringSpec, SupportSpec
from comparisons.scene.conditions import COMPONENTS
from comparisons.show import palette

Segments = NDArray[np.float64]
"""Line segments, shape (n, 2, 2)."""
LARGEST = 13.0
"""Largest size of a symbol in a legend, so that it stays in its row [point]."""
HATCHES = 5
"""Strokes below a ground."""
NAMES = {
    ("x", "y", "rotation"): "clamped",
    ("x", "y"): "pinned",
    ("y",): "roller, free in x",
    ("x",): "roller, free in y",
    ("y", "rotation"): "guided, free in x",
    ("x", "rotation"): "guided, free in y",
    ("rotation",): "rotation held",
}
"""Names of supports by the components that they hold."""


def support_symbol(held: tuple[str, ...], away: Array) -> Segments:
    """Return the segments of the symbol of a support by what it holds, a key of `NAMES`.

    The unit vector `away` (2,) points from the support into its beam; the ground is on the other side.
    """
    return turned(_SHAPES[held], _up(held, away))


def _up(held: tuple[str, ...], away: Array) -> Array:
    """Return the unit vector from the ground to the node: along the beam at a clamp, else along an axis."""
    if held == ("x", "y", "rotation"):
        return away
    axis = np.array([1.0, 0.0]) if held in (("x",), ("x", "rotation")) else np.array([0.0, 1.0])
    return -axis if away @ axis < -0.5 else axis


def turned(segments: Segments, up: Array) -> Segments:
    """Return segments turned such that their second axis points along the unit vector `up`."""
    return np.asarray(segments @ np.array([[up[1], -up[0]], [up[0], up[1]]]))


def placed(segments: Segments, at: Array, size: float) -> Segments:
    """Return segments enlarged to `size` and moved to the node `at`."""
    return np.asarray(at + size * segments)


@dataclass(frozen=True, kw_only=True, eq=False)
class Symbol:
    """The symbol of what is at a beam's end: segments (n, 2, 2) of unit size about the node, and its words."""

    item: SupportSpec | SpringSpec | HingeSpec
    words: str
    segments: Segments

    def at(self, line: Array) -> Array:
        """Return the place of the node on its beam's deformed axis, a line of shape (m, 2)."""
        return np.asarray(line[0 if self.item.end == "start" else -1])


def end_symbols(scene: Scene) -> list[Symbol]:
    """Return the symbols of the supports, springs and hinges of a scene."""
    force, length = (unit.strip() for unit in scene.units.split(","))
    found = []
    for one in scene.all_supports:
        held = tuple(name for name in COMPONENTS if name in one.held)
        segments = support_symbol(held, inward(scene, one))
        found.append(Symbol(item=one, words=NAMES[held], segments=segments))
    for spring in scene.springs:
        stiffness = dict(zip(COMPONENTS, (*spring.stiffness, spring.rotation), strict=True))
        for name in spring.held:
            unit = f"{force} {length}/rad" if name == "rotation" else f"{force}/{length}"
            words = f"spring of {stiffness[name]:.6g} {unit} in {name}"
            segments = spring_symbol(name, inward(scene, spring))
            found.append(Symbol(item=spring, words=words, segments=segments))
    for hinge in scene.hinges:
        unit = f"{force} {length}/rad"
        words = f"hinge with a spring of {hinge.stiffness:.6g} {unit}" if hinge.stiffness else "hinge"
        found.append(Symbol(item=hinge, words=words, segments=hinge_symbol()))
    return found


def draw_symbols(axes: Any, scene: Scene, lines: Mapping[str, Array], size: float) -> dict[str, Any]:
    """Draw the symbols of supports, springs and hinges at their ends; return their entries in a legend.

    The `lines` (m, 2) are the deformed axes by beam. The `size` of a symbol is a length. The axes reach
    around the symbols.
    """
    from matplotlib.collections import LineCollection

    symbols = end_symbols(scene)
    for one in symbols:
        drawn = placed(one.segments, one.at(lines[one.item.beam]), size)
        axes.add_collection(LineCollection(list(drawn), colors=palette.BLACK, linewidths=1.0, zorder=4))
        axes.update_datalim(drawn.reshape(-1, 2))
    return {one.words: legend_symbol(one.segments) for one in symbols}


def inward(scene: Scene, support: SupportSpec | SpringSpec) -> Array:
    """Return the unit vector from a support or a spring into its beam."""
    beam = scene.beam(support.beam)
    return np.array(beam.tangent(0.0)) if support.end == "start" else -np.array(beam.tangent(1.0))


def spring_symbol(component: str, away: Array) -> Segments:
    """Return the segments of a spring against one of `COMPONENTS`; the ground is away from the beam.

    The unit vector `away` (2,) points from the spring into its beam.
    """
    if component == "rotation":
        angle = np.linspace(0.0, 4.0 * np.pi, 41)
        spiral = (0.25 + 0.15 * angle / np.pi)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return chain(spiral)
    coil = np.array(
        [(0, 0), (0, -0.4), (0.4, -0.6), (-0.4, -1.0), (0.4, -1.4), (-0.4, -1.8), (0, -2.0), (0, -2.4)]
    )
    return turned(np.concatenate([chain(coil), _ground(-2.4, 0.7)]), _up((component,), away))


def hinge_symbol() -> Segments:
    """Return a small circle."""
    angle = np.linspace(0.0, 2.0 * np.pi, 17)
    return chain(0.35 * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def legend_symbol(segments: Segments, colour: str = palette.BLACK) -> Any:
    """Return a symbol as an entry of a legend."""
    from matplotlib.lines import Line2D
    from matplotlib.path import Path

    vertices = segments.reshape(-1, 2)
    vertices = vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    marker = Path(vertices, [Path.MOVETO, Path.LINETO] * len(segments))
    size = min(13 * float(np.abs(vertices).max()), LARGEST)  # matplotlib enlarges all markers to one size
    return Line2D(
        [], [], color=colour, marker=marker, markersize=size, markerfacecolor="none", linestyle="none"
    )


def chain(points: Array) -> Segments:
    """Return the segments between neighbouring points."""
    return np.stack([points[:-1], points[1:]], axis=1)


def arc(turn: float, points: int = 25) -> Array:
    """Return three quarters of a unit circle about the node, shape (points, 2), in the sense of `turn`, anticlockwise if positive."""
    angle = np.linspace(-0.75 * np.pi, 0.75 * np.pi, points)
    angle = angle if turn > 0.0 else angle[::-1]
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _lines(*ends: Sequence[float]) -> Segments:
    return np.array(ends, dtype=float).reshape(-1, 2, 2)


def _ground(y: float, half: float) -> Segments:
    """Return a line with hatches below it."""
    x = np.linspace(-half, half, HATCHES + 1)[1:].tolist()
    return _lines((-half, y, half, y), *((at, y, at - 0.3, y - 0.35) for at in x))


_TRIANGLE = _lines((0, 0, -0.6, -1), (-0.6, -1, 0.6, -1), (0.6, -1, 0, 0))
_ROLLER = np.concatenate([_TRIANGLE, _ground(-1.25, 0.9)])
_GUIDE = np.concatenate([_lines((-0.9, 0, 0.9, 0), (-0.9, -0.25, 0.9, -0.25)), _ground(-0.25, 0.9)])
_SHAPES: dict[tuple[str, ...], Segments] = {
    ("x", "y", "rotation"): _ground(0.0, 1.0),
    ("x", "y"): np.concatenate([_TRIANGLE, _ground(-1.0, 0.9)]),
    ("x",): _ROLLER,
    ("y",): _ROLLER,
    ("x", "rotation"): _GUIDE,
    ("y", "rotation"): _GUIDE,
    ("rotation",): chain(0.5 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)])),
}
"""Symbols of supports by the components that they hold."""

"""Symbols of mechanics as line segments of unit size: supports by what they hold, moments as arcs.

Every symbol has its node at the origin. A picture turns, enlarges and moves its segments, so that the same symbols are drawn by
matplotlib and by pyvista, and stand in a legend.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from comparisons.response import Array
from comparisons.scene import Scene, SupportSpec
from comparisons.scene.conditions import COMPONENTS, SpringSpec

Segments = NDArray[np.float64]
"""Line segments, shape (n, 2, 2)."""
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


def support_name(support: SupportSpec) -> str:
    """Return the name of a support in a legend."""
    return NAMES[held_components(support)]


def held_components(support: SupportSpec) -> tuple[str, ...]:
    """Return the components that a support holds, in the order of `NAMES`."""
    return tuple(name for name in COMPONENTS if name in support.held)


def support_symbol(held: tuple[str, ...], away: Array) -> Segments:
    """Return the segments of a support's symbol.

    Parameters
    ----------
    held : tuple of str
        The components held, a key of `NAMES`.
    away : ndarray, shape (2,)
        Unit vector from the support into its beam; the ground is on the other side.
    """
    segments = _SHAPES[len(held), "rotation" in held]()
    return turned(segments, _up(held, away))


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


def support_symbols(scene: Scene, size: float) -> list[Segments]:
    """Return the symbols of all supports of a scene at their undeformed nodes, in the order of `Scene.all_supports`."""
    return [
        placed(
            support_symbol(held_components(one), inward(scene, one)), np.array(scene.place(one.node)), size
        )
        for one in scene.all_supports
    ]


def inward(scene: Scene, support: SupportSpec | SpringSpec) -> Array:
    """Return the unit vector from a support or a spring into its beam."""
    beam = scene.beam(support.beam)
    return np.array(beam.tangent(0.0)) if support.end == "start" else -np.array(beam.tangent(1.0))


def spring_symbol(component: str, away: Array) -> Segments:
    """Return the segments of a spring against x, y or the rotation, with the ground on the side away from the beam.

    Parameters
    ----------
    component : str
        One of `COMPONENTS`.
    away : ndarray, shape (2,)
        Unit vector from the spring into its beam.
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
    x = np.linspace(-half, half, HATCHES + 1)[1:]
    hatches = np.stack([np.stack([x, 0 * x + y], 1), np.stack([x - 0.3, 0 * x + y - 0.35], 1)], 1)
    return np.concatenate([_lines((-half, y, half, y)), hatches])


def _triangle() -> Segments:
    return _lines((0, 0, -0.6, -1), (-0.6, -1, 0.6, -1), (0.6, -1, 0, 0))


def _clamp() -> Segments:
    return _ground(0.0, 1.0)


def _hinge() -> Segments:
    return np.concatenate([_triangle(), _ground(-1.0, 0.9)])


def _roller() -> Segments:
    return np.concatenate([_triangle(), _ground(-1.25, 0.9)])


def _guide() -> Segments:
    return np.concatenate([_lines((-0.9, 0, 0.9, 0), (-0.9, -0.25, 0.9, -0.25)), _ground(-0.25, 0.9)])


def _box() -> Segments:
    corners = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])
    return np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)


_SHAPES = {
    (3, True): _clamp,
    (2, False): _hinge,
    (1, False): _roller,
    (2, True): _guide,
    (1, True): _box,
}
"""Symbols by the number of components held, and whether the rotation is one of them."""

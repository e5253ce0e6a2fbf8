"""A scene before it is solved: which models can state it, and a drawing of beams, supports, loads and pin paths."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.models import MODELS, find
from comparisons.models.options import ModelError
from comparisons.models.outside.programs import offered
from comparisons.scene import BeamSpec, Scene
from comparisons.show import palette
from comparisons.show.plot import figure, save

BEAM, PIN, HELD, LOAD = palette.BLUE, palette.PIN, palette.BLACK, palette.GREEN
MARKS = {3: "s", 2: "^", 1: "o"}
"""Marker of a support by the number of components that it holds."""


def stated(scene: Scene, others: Sequence[str] = ()) -> Iterator[str]:
    """Yield a line on what the scene has, and one for every model: whether it can state the scene, or why not.

    Parameters
    ----------
    scene : Scene
        The scene.
    others : sequence of str
        Adapters and program files that are asked besides the models of this package and of entry points.
    """
    counts = ((len(scene.beams), "beam"), (len(scene.pins), "pin"), (len(scene.contacts), "contact pair"))
    parts = (f"{count} {what}{'' if count == 1 else 's'}" for count, what in counts)
    yield f"{scene.name}: {', '.join(parts)}, {scene.load_parameters} load parameters, in {scene.units}"
    for name in dict.fromkeys((*MODELS, *offered(), *others)):
        try:
            model = find(name)
        except ModelError as error:
            yield f"  {name}: no, {error}"
            continue
        refused = model.refusal(scene)
        yield f"  {model.name}: yes" if refused is None else f"  {model.name}: no, {refused}"


def draw(scene: Scene, path: Path) -> None:
    """Draw the scene to `path`, in the format of its suffix: beams to scale, supports, loads, pins with their paths, contact sides."""
    fig = figure(figsize=(9.0, 6.0))
    axes = fig.subplots()
    size = _size(scene)
    for beam in scene.beams:
        _beam(axes, beam, size)
    for contact in scene.contacts:
        _side(axes, scene, contact.beam, contact.side, scene.offset(contact) - scene.radius(contact))
    for support in scene.all_supports:
        x, y = scene.place(support.node)
        shape = MARKS[len(support.held)]
        axes.plot(x, y, shape, color=HELD, markersize=11, fillstyle="none", markeredgewidth=1.6, zorder=4)
        if support.moves:
            dx, dy, _ = (value or 0.0 for value in support.motion)
            axes.annotate("", (x + dx, y + dy), (x, y), arrowprops={"arrowstyle": "->", "color": HELD})
    for load in scene.loads:
        (x, y), force = scene.place(load.node), np.array(load.force)
        if force.any():
            dx, dy = 0.15 * size * force / np.hypot(*force)
            axes.annotate(
                "", (x, y), (x - dx, y - dy), arrowprops={"arrowstyle": "-|>", "color": LOAD, "linewidth": 2}
            )
        if load.moment:
            turn = "\u21ba" if load.moment > 0 else "\u21bb"
            axes.annotate(turn, (x, y), (6, 6), textcoords="offset points", fontsize=22, color=LOAD)
    for pin in scene.pins:
        points = np.array(pin.points)
        axes.plot(*points.T, ":", color=PIN, linewidth=1.5)
        axes.annotate("", points[-1], points[-2], arrowprops={"arrowstyle": "->", "color": PIN})
        if pin.radius:
            from matplotlib.patches import Circle

            axes.add_patch(Circle(points[0], pin.radius, fill=False, color=PIN))
        axes.plot(*points[0], "*", color=PIN, markersize=10)
        axes.annotate(pin.name, points[0], (8, -14), textcoords="offset points", color=PIN, fontsize="medium")
    unit = scene.units.split(",")[1].strip()
    axes.set(xlabel=f"x [{unit}]", ylabel=f"y [{unit}]", title=scene.name)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.1)
    axes.grid(visible=True, linewidth=0.3)
    save(fig, path)


def _size(scene: Scene) -> float:
    points = np.array([point for beam in scene.beams for point in (beam.start, beam.end)])
    return float(np.ptp(points, axis=0).max())


def _beam(axes: Any, beam: BeamSpec, size: float) -> None:
    """Draw a beam as its outline, at least a line, with its name and direction."""
    start, end, left = np.array(beam.start), np.array(beam.end), _left(beam)
    half = (beam.height or 0.0) / 2 * left
    corners = np.array([start - half, end - half, end + half, start + half])
    axes.fill(*corners.T, facecolor=BEAM, edgecolor=BEAM, alpha=0.35, linewidth=1.5)
    axes.plot(*np.array([start, end]).T, color=BEAM, linewidth=0.8)
    middle = (start + end) / 2
    axes.annotate(
        "", middle + 0.03 * size * (end - start) / beam.length, middle, arrowprops={"arrowstyle": "->"}
    )
    axes.annotate(
        beam.name, middle, tuple(14 * left), textcoords="offset points", color=BEAM, ha="center", va="center"
    )


def _side(axes: Any, scene: Scene, name: str, side: str, offset: float) -> None:
    """Draw the surface of a contact, on its side of the beam."""
    beam = scene.beam(name)
    shift = (1.0 if side == "left" else -1.0) * offset * _left(beam)
    line = np.array([beam.start, beam.end]) + shift
    axes.plot(*line.T, color=PIN, linewidth=1.0, linestyle="--")


def _left(beam: BeamSpec) -> Any:
    tx, ty = beam.direction
    return np.array([-ty, tx])

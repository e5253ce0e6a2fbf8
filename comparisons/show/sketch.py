"""A scene before it is solved: which models can state it, and a drawing of beams, supports, loads and pin paths."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from math import hypot
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.models import MODELS, find
from comparisons.models.options import ModelError
from comparisons.models.outside.programs import offered
from comparisons.response import Array
from comparisons.scene import BeamSpec, ContactSpec, PinSpec, Scene
from comparisons.show import palette
from comparisons.show.plot import WIDTH, figure, save
from comparisons.show.symbols import arc, held_components, support_name, support_symbol, support_symbols

BEAM, PIN, SIDE, HELD, LOAD = palette.BLUE, palette.PIN, palette.PURPLE, palette.BLACK, palette.GREEN
SYMBOL, STROKE, ARROW, TURN, LABEL = 0.025, 0.012, 0.14, 0.05, 0.12
"""Sizes of a support, a stroke on the side of a contact, the arrow of a force, the arc of a moment and a label, over the size of the scene."""
STROKES = 40
"""Strokes along the side of a contact."""
UP = np.array([0.0, 1.0])


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
    stages = f" in {1 + len(scene.stages)} stages" if scene.stages else ""
    yield f"{scene.name}: {', '.join(parts)}, {len(scene.times)} load parameters{stages}, in {scene.units}"
    for name in dict.fromkeys((*MODELS, *offered(), *others)):
        try:
            model = find(name)
        except ModelError as error:
            yield f"  {name}: no, {error}"
            continue
        refused = model.refusal(scene)
        yield f"  {model.name}: yes" if refused is None else f"  {model.name}: no, {refused}"


def draw(scene: Scene, path: Path) -> None:
    """Draw the scene to `path`, in the format of its suffix, with a legend of everything in it.

    Beams and round pins have their true size. The symbols of supports, loads and contact sides have a size of their own; the value of
    a load stands beside its arrow.
    """
    low, high = _bounds(scene)
    size = float((high - low).max())
    width, height = np.maximum(high - low, 0.2 * size) + 0.2 * size
    fig = figure(figsize=(WIDTH, float(np.clip(0.85 * WIDTH * height / width, 1.6, 6.5)) + 1.4))
    axes = fig.subplots()
    axes.set_aspect("equal", adjustable="datalim")
    sketch = _Sketch(axes=axes, scene=scene, size=size)
    for beam in scene.beams:
        sketch.beam(beam)
    for contact in scene.contacts:
        sketch.side(contact)
    sketch.supports()
    sketch.loads()
    for pin in scene.pins:
        sketch.pin(pin)
    axes.set(xlabel=f"x [{sketch.units[1]}]", ylabel=f"y [{sketch.units[1]}]", title=scene.name)
    axes.margins(0.08)
    axes.autoscale_view()
    axes.grid(visible=True, linewidth=0.3)
    entries = sketch.legend
    fig.legend(
        entries.values(), entries.keys(), loc="outside lower center", ncols=2, fontsize="small", frameon=False
    )
    save(fig, path)


def _bounds(scene: Scene) -> tuple[Array, Array]:
    """Return the lowest and the highest coordinates of beams and pins."""
    points = [point for beam in scene.beams for point in (beam.start, beam.end)]
    for pin in scene.pins:
        reach = pin.radius or 0.0
        points += [(x + dx, y + dx) for x, y in pin.points for dx in (-reach, reach)]
    found = np.array(points)
    return found.min(axis=0), found.max(axis=0)


@dataclass(kw_only=True)
class _Sketch:
    """A drawing that grows, and its legend.

    Attributes
    ----------
    axes : Axes
        Where it is drawn.
    scene : Scene
        What is drawn.
    size : float
        Size of the scene [length].
    legend : dict
        What is drawn so far, by its words in the legend.
    """

    axes: Any
    scene: Scene
    size: float
    legend: dict[str, Any] = field(default_factory=dict)

    @property
    def units(self) -> tuple[str, str]:
        """Units of force and length."""
        force, length = (unit.strip() for unit in self.scene.units.split(","))
        return force, length

    def beam(self, beam: BeamSpec) -> None:
        """Draw a beam as its outline, at least a line, with its name and direction."""
        start, end, left = np.array(beam.start), np.array(beam.end), _left(beam)
        half = beam.height_at(0.5) / 2 * left
        corners = np.array([start - half, end - half, end + half, start + half])
        (outline,) = self.axes.fill(*corners.T, facecolor=BEAM, edgecolor=BEAM, alpha=0.35, linewidth=1.5)
        (axis,) = self.axes.plot(*np.array([start, end]).T, color=BEAM, linewidth=1.0)
        middle = (start + end) / 2
        self._arrow(middle, middle + 0.03 * self.size * (end - start) / beam.length, BEAM)
        sides = {contact.side for contact in self.scene.contacts if contact.beam == beam.name}
        clear = -left if sides == {"left"} else left
        self._label(beam.name, 0.75 * start + 0.25 * end + (half @ left) * clear, clear, BEAM)
        if beam.height is None:
            self.legend.setdefault("beam: axis, without a height", axis)
        else:
            self.legend.setdefault("beam, height to scale", outline)

    def side(self, contact: ContactSpec) -> None:
        """Draw the surface that a node touches, with strokes on the side from which the node comes."""
        beam = self.scene.beam(contact.beam)
        normal = (1.0 if contact.side == "left" else -1.0) * _left(beam)
        surface = (self.scene.offset(contact) - self.scene.radius(contact)) * normal
        line = np.array([beam.start, beam.end]) + surface
        part = np.linspace(0.0, 1.0, STROKES + 1)[:, None]
        feet = (1.0 - part) * line[0] + part * line[1]
        strokes = np.stack([feet, feet + STROKE * self.size * normal], axis=1)
        self._segments(np.concatenate([line[None], strokes]), SIDE, 0.9)
        friction = f", friction {contact.friction:g}" if contact.friction else ""
        words = f"side of contact: {contact.surface} of the beam{friction}"
        self.legend.setdefault(words, _line(SIDE, marker="|", markersize=6))

    def supports(self) -> None:
        """Draw the supports and their prescribed motions."""
        symbols = support_symbols(self.scene, SYMBOL * self.size)
        for support, segments in zip(self.scene.all_supports, symbols, strict=True):
            self._segments(segments, HELD, 1.1)
            self.legend.setdefault(
                support_name(support), _handle(support_symbol(held_components(support), UP))
            )
            if not support.moves:
                continue
            at = np.array(self.scene.place(support.node))
            dx, dy, turn = (value or 0.0 for value in support.motion)
            if dx or dy:
                path = np.array([dx, dy])
                self._arrow(at, at + path, HELD)
                self._label(f"{hypot(dx, dy):.6g} {self.units[1]}", at + path, path, HELD)
            if turn:
                self._turn(support.node, turn, f"{abs(turn):.6g} rad", HELD)
            self.legend.setdefault("motion of a support at load parameter 1", _line(HELD, marker=">"))

    def loads(self) -> None:
        """Draw the forces and moments at load parameter 1 with their values."""
        force, length = self.units
        for load in self.scene.loads:
            if load.end is None:
                continue
            at, vector = np.array(self.scene.place(load.node)), np.array(load.force)
            if vector.any():
                tail = at - ARROW * self.size * vector / np.hypot(*vector)
                self._arrow(tail, at, LOAD, 2.0)
                self._label(f"{np.hypot(*vector):.6g} {force}", tail, -vector, LOAD)
                self.legend.setdefault(
                    "force at load parameter 1, not to scale", _line(LOAD, marker=">", linewidth=2.0)
                )
            if load.moment:
                self._turn(load.node, load.moment, f"{abs(load.moment):.6g} {force} {length}", LOAD)
                self.legend.setdefault("moment at load parameter 1", _handle(_chain(arc(1.0)), LOAD))

    def pin(self, pin: PinSpec) -> None:
        """Draw a pin with its true radius, and its path."""
        from matplotlib.patches import Circle

        points = np.array(pin.points)
        behind = (points[0] - points[1]) / np.hypot(*(points[0] - points[1]))
        (path,) = self.axes.plot(*points.T, ":", color=PIN, linewidth=1.5)
        last = points[-1] - points[-2]
        self._arrow(points[-1] - 0.01 * self.size * last / np.hypot(*last), points[-1], PIN)
        (mark,) = self.axes.plot(*points[0], "*", color=PIN, markersize=9, linestyle="none", zorder=5)
        self._label(pin.name, points[0] + (pin.radius or 0.0) * behind, behind, PIN)
        if pin.radius:
            self.axes.add_patch(Circle(points[0], pin.radius, facecolor=PIN, edgecolor=PIN, alpha=0.35))
            self.axes.add_patch(Circle(points[-1], pin.radius, fill=False, edgecolor=PIN, linestyle=":"))
            disc = _line(PIN, marker="o", markersize=9, linestyle="none", alpha=0.5)
            self.legend.setdefault(f"pin of radius {pin.radius:.6g} {self.units[1]}, to scale", disc)
        else:
            self.legend.setdefault("pin, a point", mark)
        self.legend.setdefault("path of a pin", path)

    def _segments(self, segments: Array, colour: str, width: float) -> None:
        from matplotlib.collections import LineCollection

        self.axes.add_collection(LineCollection(list(segments), colors=colour, linewidths=width, zorder=4))
        self.axes.update_datalim(segments.reshape(-1, 2))

    def _arrow(self, tail: Array, tip: Array, colour: str, linewidth: float = 1.2) -> None:
        """Draw an arrow; the axes reach to its ends."""
        style = {"arrowstyle": "-|>", "color": colour, "linewidth": linewidth, "shrinkA": 0, "shrinkB": 0}
        self.axes.annotate("", tip, tail, arrowprops=style)
        self.axes.update_datalim([tail, tip])

    def _turn(self, node: str, turn: float, words: str, colour: str) -> None:
        """Draw a moment or a rotation as an arc about a node, with its value on the side without the arrow of a force."""
        at = np.array(self.scene.place(node))
        above = any(load.node == node and load.force[1] < 0.0 for load in self.scene.loads)
        points = at + TURN * self.size * arc(turn)
        self.axes.plot(*points.T, color=colour, linewidth=2.0)
        self._arrow(points[-2], points[-1], colour, 2.0)
        side = -UP if above else UP
        self._label(words, at + TURN * self.size * side, side, colour)

    def _label(self, words: str, at: Array, direction: Array, colour: str) -> None:
        """Write beside a place, in the direction given; the axes reach around the words."""
        x, y = direction / np.hypot(*direction)
        self.axes.update_datalim([at + LABEL * self.size * np.array([x, 0.5 * y])])
        self.axes.annotate(
            words,
            at,
            (7 * x, 7 * y),
            textcoords="offset points",
            color=colour,
            fontsize="medium",
            ha="left" if x > 0.5 else "right" if x < -0.5 else "center",
            va="bottom" if y > 0.5 else "top" if y < -0.5 else "center",
        )


def _left(beam: BeamSpec) -> Any:
    tx, ty = beam.direction
    return np.array([-ty, tx])


def _line(colour: str, **style: Any) -> Any:
    """Return an entry of a legend."""
    from matplotlib.lines import Line2D

    return Line2D([], [], color=colour, **style)


def _handle(segments: Array, colour: str = HELD) -> Any:
    """Return a symbol as an entry of a legend."""
    from matplotlib.path import Path as Outline

    vertices = segments.reshape(-1, 2)
    vertices = vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    marker = Outline(vertices, [Outline.MOVETO, Outline.LINETO] * len(segments))
    size = 13 * float(np.abs(vertices).max())  # matplotlib enlarges all markers to one size
    return _line(colour, marker=marker, markersize=size, markerfacecolor="none", linestyle="none")


def _chain(points: Array) -> Array:
    """Return the segments between neighbouring points."""
    return np.stack([points[:-1], points[1:]], axis=1)

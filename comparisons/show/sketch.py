"""Drawings of a scene: beams at their height, supports, loads and forces as arrows with their values, pins."""

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
from comparisons.response.table import unit_names
from comparisons.scene import BeamSpec, ContactSpec, PinSpec, Scene
from comparisons.scene.conditions import LoadSpec
from comparisons.show import palette
from comparisons.show.plot import WIDTH, arrow, figure, save
from comparisons.show.symbols import arc, chain, draw_symbols, legend_symbol

BEAM, PIN, SIDE, HELD, LOAD = palette.BLUE, palette.PIN, palette.PURPLE, palette.BLACK, palette.GREEN
SYMBOL, STROKE, ARROW, TURN = 0.025, 0.012, 0.14, 0.05
"""Sizes of a support, a stroke on the side of a contact, the arrow of a force and the arc of a moment, over the size of the scene."""
PULL = 0.7
"""Cosine of the angle between a force and its beam above which the force is drawn as one that pulls."""
ROUNDS = 3
"""Times that the labels are separated and the axes fitted around them, which change each other."""
PARTS: list[float] = np.linspace(0.0, 1.0, 41).tolist()
"""Fractions of the length at the points of an axis, and at the strokes along the side of a contact."""
ROW = 11
"""Arrows of a force per length."""
NAME, WEIGHT = 0.25, 0.65
"""Fractions of the length at which a beam's name and its weight stand."""
CORNER = np.array([1.0, 1.0])
"""Way from a moment to its value, which arrows along the axes leave free."""
SCALED = {True: "force per length, arrows not to scale", False: "force, arrow not to scale"}


def stated(scene: Scene, others: Sequence[str] = ()) -> Iterator[str]:
    """Yield a line on what the scene has, and one for every model: whether it can state the scene, or why not.

    The `others` are adapters and program files that are asked besides the models of this package and of entry
    points.
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


@dataclass(kw_only=True)
class Sketch:
    """A drawing of a scene that grows, of that `size`; a label that moves down in favour of others has -1 beside it.

    The `lines` are arc lengths (n,) and points (n, 2) of the axes by beam, deformed or not.
    """

    axes: Any
    scene: Scene
    size: float
    lines: dict[str, tuple[Array, Array]]
    letters: str = "medium"
    legend: dict[str, Any] = field(default_factory=dict)
    labels: list[tuple[Any, float]] = field(default_factory=list)

    def frame(self, title: str, size: str = "large") -> None:
        """Write what the axes show, in equal scales."""
        length = unit_names(self.scene.units)["length"]
        self.axes.set_aspect("equal", adjustable="datalim")
        self.axes.set(xlabel=f"x [{length}]", ylabel=f"y [{length}]")
        self.axes.set_title(title, fontsize=size)
        self.axes.margins(0.08)
        self.axes.grid(visible=True, linewidth=0.3)

    def named(self, words: str, colour: str, **style: Any) -> None:
        """Add a line or marker to the legend."""
        from matplotlib.lines import Line2D

        self.legend.setdefault(words, Line2D([], [], color=colour, **style))

    def body(self, beam: BeamSpec, normal: Array, colour: str, width: float) -> list[Any]:
        """Draw a beam of its height about its axis with unit normals (n, 2); return outline and axis."""
        arcs, line = self.lines[beam.name]
        heights = [beam.height_at(min(s / beam.length, 1.0)) for s in arcs]
        half = np.array(heights)[:, None] / 2.0 * normal
        outline = np.concatenate([line + half, (line - half)[::-1]])
        drawn = self.axes.fill(*outline.T, facecolor=colour, edgecolor=colour, alpha=0.35, linewidth=1.5)
        return [*drawn, *self.axes.plot(*line.T, color=colour, linewidth=width)]

    def at(self, beam: str, parts: Sequence[float]) -> Array:
        """Return the points (n, 2) of an axis at parts of the undeformed length."""
        arcs, points = self.lines[beam]
        arc = self.scene.beam(beam).length * np.array(parts)
        return np.stack([np.interp(arc, arcs, values) for values in points.T], axis=1)

    def _tips(self, load: LoadSpec) -> Array:
        """Return the points (n, 2) at which the arrows of a load end, more than one of a force per length."""
        if load.force_per_length is not None:
            return self.at(load.beam, np.linspace(*load.span, ROW).tolist())
        return self.at(load.beam, [load.at if load.at is not None else float(load.end == "end")])

    def symbols(self) -> None:
        """Draw supports, springs and hinges at the ends of the axes."""
        lines = {name: points for name, (_, points) in self.lines.items()}
        self.legend |= draw_symbols(self.axes, self.scene, lines, SYMBOL * self.size)

    def disc(self, at: Array, radius: float | None, **style: Any) -> None:
        """Draw a round pin with its true radius, nothing for a point."""
        from matplotlib.patches import Circle

        if radius:
            self.axes.add_patch(Circle(tuple(at), radius, **style))

    def arrows(
        self, tips: Array, vector: Array, words: str, colour: str, width: float, at_tip: bool = False
    ) -> None:
        """Draw equal arrows to the `tips` (n, 2), more than one with a line through their tails, and write beside the one in the middle."""
        tails = tips - vector
        for tail, tip in zip(tails, tips, strict=True):
            arrow(self.axes, tail, tip, colour, width)
        if len(tips) > 1:
            self.axes.plot(*tails.T, color=colour, linewidth=width)
        ends, way = (tips, vector) if at_tip else (tails, -vector)
        self.label(words, ends[len(tips) // 2], way, colour)

    def load(self, load: LoadSpec, amount: Sequence[float], stage: int = 1) -> None:
        """Draw a load of that amount, force or force per length and moment, as arrows of one length with their values."""
        units, after, tips = unit_names(self.scene.units), _after(stage), self._tips(load)
        along, (*force, moment) = load.force_per_length is not None, amount
        if any(force):
            length, width = (ARROW / 2, 0.9) if along else (ARROW, 2.0)
            vector, unit = length * self.size * _unit(force), f"/{units['length']}" if along else ""
            words = f"{hypot(*force):.6g} {units['force']}{unit}{after}"
            pulls = _pulls(self.scene, load, force)
            self.arrows(tips + pulls * vector, vector, words, LOAD, width, at_tip=pulls)
            self.named(SCALED[along], LOAD, marker=">", linewidth=width)
        if moment:
            self.turn(tips[0], moment, f"{abs(moment):.6g} {units['moment']}{after}", LOAD)
            self.legend.setdefault("moment", legend_symbol(chain(arc(1.0)), LOAD))

    def weights(self, gravity: Sequence[float], stage: int = 1) -> None:
        """Draw the weights of the beams under an acceleration."""
        for beam in self.scene.beams if any(gravity) else ():
            if beam.density:
                words = f"weight {hypot(*gravity) * beam.mass:.4g} {unit_names(self.scene.units)['force']}{_after(stage)}"
                self.arrows(
                    self.at(beam.name, [WEIGHT]), ARROW * self.size * _unit(gravity), words, LOAD, 2.0
                )
                self.named(SCALED[False], LOAD, marker=">", linewidth=2.0)

    def turn(self, at: Array, turn: float, words: str, colour: str) -> None:
        """Draw a moment or a rotation as an arc with its value."""
        points = at + TURN * self.size * arc(turn)
        self.axes.plot(*points.T, color=colour, linewidth=2.0)
        arrow(self.axes, points[-2], points[-1], colour, 2.0)
        self.label(words, at + TURN * self.size * _unit(CORNER), CORNER, colour)

    def label(self, words: str, at: Array, direction: Array, colour: str) -> None:
        """Write beside a place, in the direction given."""
        x, y = direction / np.hypot(*direction)
        sides = {
            "ha": "left" if x > 0.5 else "right" if x < -0.5 else "center",
            "va": "bottom" if y > 0.5 else "top" if y < -0.5 else "center",
        }
        style = {
            "textcoords": "offset points",
            "color": colour,
            "fontsize": self.letters,
            "zorder": 6,
            **sides,
        }
        label = self.axes.annotate(words, at, (7 * x, 7 * y), **style)
        self.labels.append((label, -1.0 if y < -0.5 else 1.0))

    def separate(self, rounds: int) -> None:
        """Move labels up or down that lie on others, and let the axes reach around all labels."""
        for _ in range(rounds):
            self.axes.figure.draw_without_rendering()
            free: list[Any] = []
            for label, way in self.labels:
                while any(label.get_window_extent().overlaps(other) for other in free):
                    x, y = label.xyann
                    label.xyann = (x, y + 4.0 * way)
                free.append(label.get_window_extent())
                corners = free[-1].transformed(self.axes.transData.inverted()).corners()
                self.axes.update_datalim(corners)
            self.axes.autoscale_view()


def axis(beam: BeamSpec) -> tuple[Array, Array, Array]:
    """Return arc lengths (n,), points (n, 2) of the undeformed axis, and the unit vectors (n, 2) to its left there."""
    left = [_across(beam.tangent(part)) for part in PARTS]
    return beam.length * np.array(PARTS), np.array([beam.place(part) for part in PARTS]), np.array(left)


def draw(scene: Scene, path: Path) -> None:
    """Draw the scene to `path`, in the format of its suffix, with a legend of everything in it.

    Beams and round pins have their true size. The symbols of supports, loads and contact sides have a size of their own; the value of
    a load stands beside its arrow.
    """
    points = np.concatenate([axis(beam)[1] for beam in scene.beams])
    for pin in scene.pins:
        reach = pin.radius or 0.0
        points = np.concatenate([points, np.array(pin.points) - reach, np.array(pin.points) + reach])
    size = float(np.ptp(points, axis=0).max())
    width, height = np.maximum(np.ptp(points, axis=0), 0.2 * size) + 0.2 * size
    fig = figure(figsize=(WIDTH, float(np.clip(0.85 * WIDTH * height / width, 1.6, 6.5)) + 1.4))
    lines = {beam.name: axis(beam)[:2] for beam in scene.beams}
    sketch = Sketch(axes=fig.subplots(), scene=scene, size=size, lines=lines)
    sketch.frame(scene.name)
    for beam in scene.beams:
        _beam(sketch, beam)
    for contact in scene.contacts:
        _side(sketch, contact)
    sketch.symbols()
    _motions(sketch)
    for number, load in scene.numbered_loads():
        sketch.load(load, load.amount, number + 1)
    for stage, gravity in enumerate(scene.stage_gravities, 1):
        sketch.weights(gravity, stage)
    for pin in scene.pins:
        _pin(sketch, pin)
    place = {"loc": "outside lower center", "ncols": 2, "fontsize": "small", "frameon": False}
    fig.legend(sketch.legend.values(), sketch.legend.keys(), **place)
    sketch.separate(ROUNDS)
    save(fig, path)


def _beam(sketch: Sketch, beam: BeamSpec) -> None:
    """Draw a beam as its outline, at least a line, with its name and direction."""
    outline, line = sketch.body(beam, axis(beam)[2], BEAM, 1.0)
    middle, tangent = np.array(beam.place(0.5)), np.array(beam.tangent(0.5))
    arrow(sketch.axes, middle, middle + 0.03 * sketch.size * tangent, BEAM)
    left = _across(beam.tangent(NAME))
    sketch.label(beam.name, beam.place(NAME) + beam.height_at(NAME) / 2 * left, left, BEAM)
    flat = beam.height is None
    words = "beam: axis, without a height" if flat else "beam, height to scale"
    sketch.legend.setdefault(words, line if flat else outline)


def _side(sketch: Sketch, contact: ContactSpec) -> None:
    """Draw the surface that a node touches, with strokes on the side from which the node comes."""
    from matplotlib.collections import LineCollection

    _, line, left = axis(sketch.scene.beam(contact.beam))
    normal, radius = left if contact.side == "left" else -left, sketch.scene.radius(contact)
    offsets = np.array([sketch.scene.offset(contact, part) for part in PARTS]) - radius
    feet = line + offsets[:, None] * normal
    drawn = np.concatenate([chain(feet), np.stack([feet, feet + STROKE * sketch.size * normal], axis=1)])
    sketch.axes.add_collection(LineCollection(list(drawn), colors=SIDE, linewidths=0.9, zorder=4))
    sketch.axes.update_datalim(drawn.reshape(-1, 2))
    friction = f", friction {contact.friction:g}" if contact.friction else ""
    sketch.named(f"side of contact: {contact.surface} of the beam{friction}", SIDE, marker="|", markersize=6)


def _motions(sketch: Sketch) -> None:
    """Draw the prescribed motions of the supports."""
    scene = sketch.scene
    for support in scene.all_supports:
        at = place = np.array(scene.place(support.node))
        for stage, (dx, dy, turn) in enumerate(scene.prescribed_motions[support.node].increments, 1):
            path = np.array([dx, dy])
            if path.any():
                at = at + path
                words = f"{hypot(dx, dy):.6g} {unit_names(scene.units)['length']}{_after(stage)}"
                sketch.arrows(at[None], path, words, HELD, 1.2, at_tip=True)
            if turn:
                sketch.turn(place, turn, f"{abs(turn):.6g} rad{_after(stage)}", HELD)
            if path.any() or turn:
                sketch.named("motion of a support", HELD, marker=">")


def _pulls(scene: Scene, load: LoadSpec, force: Sequence[float]) -> bool:
    """Whether a force on a beam's end points away from the beam, along which its arrow would lie."""
    if load.end is None:
        return False
    beam = scene.beam(load.beam)
    outward = np.array(beam.tangent(1.0)) if load.end == "end" else -np.array(beam.tangent(0.0))
    return float(_unit(force) @ outward) > PULL


def _pin(sketch: Sketch, pin: PinSpec) -> None:
    """Draw a pin with its true radius, and its path."""
    points = np.array(pin.points)
    behind = _unit(points[0] - points[1]) if len(points) > 1 else np.array([0.0, -1.0])
    for stage in map(np.array, pin.stage_points):
        if len(stage) > 1:
            arrow(sketch.axes, stage[-1] - 0.01 * sketch.size * _unit(stage[-1] - stage[-2]), stage[-1], PIN)
    (mark,) = sketch.axes.plot(*points[0], "*", color=PIN, markersize=9, linestyle="none", zorder=5)
    sketch.label(pin.name, points[0] + (pin.radius or 0.0) * behind, behind, PIN)
    sketch.disc(points[0], pin.radius, facecolor=PIN, edgecolor=PIN, alpha=0.35)
    if pin.radius:
        words = f"pin of radius {pin.radius:.6g} {unit_names(sketch.scene.units)['length']}, to scale"
        sketch.named(words, PIN, marker="o", markersize=9, linestyle="none", alpha=0.5)
    else:
        sketch.legend.setdefault("pin, a point", mark)
    if pin.moving:
        sketch.disc(points[-1], pin.radius, fill=False, edgecolor=PIN, linestyle=":")
        (path,) = sketch.axes.plot(*points.T, ":", color=PIN, linewidth=1.5)
        sketch.legend.setdefault("path of a pin", path)


def _after(stage: int) -> str:
    """Return the number of a stage after the first one."""
    return f" (stage {stage})" if stage > 1 else ""


def _unit(vector: Sequence[float] | Array) -> Array:
    return np.asarray(vector / np.hypot(*vector))


def _across(tangent: Sequence[float]) -> Array:
    """Return the unit vector to the left of a tangent."""
    return np.array([-tangent[1], tangent[0]])

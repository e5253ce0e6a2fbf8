"""Drawings of a scene: beams at their height, supports, pins, loads as arrows with their values."""

from collections.abc import Iterator, Mapping, Sequence
from math import hypot
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from comparisons.answer import Array
from comparisons.answer.page import counted
from comparisons.answer.table import unit_names
from comparisons.models import MODELS, find
from comparisons.models.model import ModelError
from comparisons.models.outside.programs import offered
from comparisons.report import palette, symbols
from comparisons.report.plot import WIDTH, arrow, figure, legend_below, save
from comparisons.scene import BeamSpec, ContactSpec, PinSpec, Scene
from comparisons.scene.conditions import LoadSpec

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


def stated(scene: Scene, others: Sequence[str] = ()) -> Iterator[str]:
    """Yield a line on what the scene has, and one for every model: whether it can state it, or why not."""
    stages = f" in {1 + len(scene.stages)} stages" if scene.stages else ""
    yield f"{scene.name}: {counted(scene)}, {len(scene.times)} load parameters{stages}, in {scene.units}"
    for name in dict.fromkeys((*MODELS, *offered(), *others)):
        try:
            model = find(name)
        except ModelError as error:
            yield f"  {name}: no, {error}"
            continue
        refused = model.refusal(scene)
        yield f"  {model.name}: yes" if refused is None else f"  {model.name}: no, {refused}"


class Sketch:
    """A drawing of a scene that grows, about axes by beam, deformed or not."""

    def __init__(
        self, axes: Any, scene: Scene, lines: Mapping[str, symbols.Axis], title: str, letters: str = "medium"
    ) -> None:
        self.axes, self.scene, self.lines, self.letters = axes, scene, lines, letters
        self.size, self.units = float(np.ptp(_reach(scene, lines), axis=0).max()), unit_names(scene.units)
        self.legend: dict[str, Any] = {}
        self.labels: list[Any] = []
        axes.set_aspect("equal", adjustable="datalim")
        axes.set(xlabel=f"x [{self.units['length']}]", ylabel=f"y [{self.units['length']}]")
        axes.set_title(title, fontsize="large" if letters == "medium" else "medium")
        axes.margins(0.08)
        axes.grid(visible=True, linewidth=0.3)

    def named(self, words: str, colour: str, **style: Any) -> None:
        """Add a line or marker to the legend."""
        from matplotlib.lines import Line2D

        self.legend.setdefault(words, Line2D([], [], color=colour, **style))

    def body(self, beam: BeamSpec, colour: str, width: float) -> list[Any]:
        """Draw a beam of its height; return outline and axis."""
        arcs, line, normal = self.lines[beam.name]
        half = np.array([beam.height_at(min(s / beam.length, 1.0)) for s in arcs])[:, None] / 2.0 * normal
        outline = np.concatenate([line + half, (line - half)[::-1]])
        drawn = self.axes.fill(*outline.T, facecolor=colour, edgecolor=colour, alpha=0.35, linewidth=1.5)
        return [*drawn, *self.axes.plot(*line.T, color=colour, linewidth=width)]

    def at(self, beam: str, parts: ArrayLike) -> Array:
        """Return the points (n, 2) of an axis at parts of the undeformed length."""
        return symbols.at_arcs(self.scene.beam(beam).length * np.asarray(parts), *self.lines[beam][:2])

    def symbols(self) -> None:
        """Draw supports, springs and hinges at the ends of the axes."""
        self.legend |= symbols.draw_symbols(self.axes, self.scene, self.lines, SYMBOL * self.size)

    def disc(self, at: Array, radius: float | None, **style: Any) -> None:
        """Draw a round pin with its true radius, nothing for a point."""
        from matplotlib.patches import Circle

        if radius:
            self.axes.add_patch(Circle(tuple(at), radius, **style))

    def arrows(
        self, tips: Array, vector: Array, words: str, colour: str, width: float, *, at_tip: bool = False
    ) -> None:
        """Draw equal arrows to the `tips` (n, 2), more than one with a line through their tails, and write beside the one in the middle."""
        tails = tips - vector
        for tail, tip in zip(tails, tips, strict=True):
            arrow(self.axes, tail, tip, colour, width)
        if len(tips) > 1:
            self.axes.plot(*tails.T, color=colour, linewidth=width)
        ends, way = (tips, vector) if at_tip else (tails, -vector)
        self.label(words, ends[len(tips) // 2], way, colour)

    def loads(
        self, loads: Sequence[tuple[LoadSpec, Sequence[float]]], gravity: Sequence[float], after: str = ""
    ) -> None:
        """Draw loads (force or force per length, and moment) and weights as arrows of one length."""
        for load, (*vector, moment) in loads:
            along, one = load.force_per_length is not None, load.end == "end" if load.at is None else load.at
            at = np.linspace(*load.span, ROW) if along else [one]
            tips, unit = self.at(load.beam, at), self.units["stiffness" if along else "force"]
            self._force(tips, vector, f"{hypot(*vector):.6g} {unit}{after}", load)
            if moment:
                self.turn(tips[0], moment, f"{abs(moment):.6g} {self.units['moment']}{after}", LOAD)
                self.legend.setdefault("moment", symbols.legend_symbol(symbols.chain(symbols.arc(1.0)), LOAD))
        for beam in (beam for beam in self.scene.beams if beam.density):
            words = f"weight {hypot(*gravity) * beam.mass:.4g} {self.units['force']}{after}"
            self._force(self.at(beam.name, [WEIGHT]), gravity, words)

    def _force(self, tips: Array, vector: Sequence[float], words: str, load: LoadSpec | None = None) -> None:
        """Draw the arrow of a force, or those of a force per length, shorter and thinner."""
        if not any(vector):
            return
        # an arrow along the beam would lie on it where the force points away from the end
        pulls = bool(load and load.end and np.dot(_unit(vector), symbols.inward(self.scene, load)) < -PULL)
        many = len(tips) > 1
        width, named = (0.9, "force per length, arrows") if many else (2.0, "force, arrow")
        drawn = ARROW / (1 + many) * self.size * _unit(vector)
        self.arrows(tips + pulls * drawn, drawn, words, LOAD, width, at_tip=pulls)
        self.named(f"{named} not to scale", LOAD, marker=">", linewidth=width)

    def turn(self, at: Array, turn: float, words: str, colour: str) -> None:
        """Draw a moment or a rotation as an arc with its value."""
        points = at + TURN * self.size * symbols.arc(turn)
        self.axes.plot(*points.T, color=colour, linewidth=2.0)
        arrow(self.axes, points[-2], points[-1], colour, 2.0)
        self.label(words, at + TURN * self.size * _unit(CORNER), CORNER, colour)

    def label(self, words: str, at: Array, direction: Array, colour: str) -> None:
        """Write beside a place, in the direction given."""
        x, y = map(int, np.round(_unit(direction)))
        style: dict[str, Any] = {"color": colour, "fontsize": self.letters, "zorder": 6}
        style |= {"ha": ("center", "left", "right")[x], "va": ("center", "bottom", "top")[y]}
        label = self.axes.annotate(words, at, 7 * _unit(direction), textcoords="offset points", **style)
        self.labels.append(label)

    def separate(self, rounds: int) -> None:
        """Move labels that lie on others up, those below their places down, and let the axes reach around all labels."""
        for _ in range(rounds):
            self.axes.figure.draw_without_rendering()
            free: list[Any] = []
            for label in self.labels:
                step = -4.0 if label.get_va() == "top" else 4.0
                while any(label.get_window_extent().overlaps(other) for other in free):
                    label.xyann = label.xyann[0], label.xyann[1] + step
                free.append(label.get_window_extent())
                corners = free[-1].transformed(self.axes.transData.inverted()).corners()
                self.axes.update_datalim(corners)
            self.axes.autoscale_view()


def _reach(scene: Scene, lines: Mapping[str, symbols.Axis]) -> Array:
    """Return points (n, 2) within which beams and pins are."""
    points = [line for _, line, _ in lines.values()]
    for pin in scene.pins:
        points += [np.array(pin.points) + way * (pin.radius or 0.0) for way in (-1.0, 1.0)]
    return np.concatenate(points)


def draw(scene: Scene, path: Path) -> None:
    """Draw the scene to `path` with a legend of everything in it; beams and pins have their true size."""
    lines = {beam.name: symbols.axis(beam) for beam in scene.beams}
    extent = np.ptp(_reach(scene, lines), axis=0)
    width, height = np.maximum(extent, 0.2 * extent.max()) + 0.2 * extent.max()
    fig = figure(figsize=(WIDTH, float(np.clip(0.85 * WIDTH * height / width, 1.6, 6.5)) + 1.4))
    sketch = Sketch(fig.subplots(), scene, lines, scene.name)
    for beam in scene.beams:
        _beam(sketch, beam)
    for contact in scene.contacts:
        _side(sketch, contact)
    sketch.symbols()
    _motions(sketch)
    for stage, gravity in enumerate(scene.stage_gravities):
        loads = [(load, load.amount) for number, load in scene.numbered_loads() if number == stage]
        sketch.loads(loads, gravity, _after(stage + 1))
    for pin in scene.pins:
        _pin(sketch, pin)
    legend_below(fig, sketch.legend)
    sketch.separate(ROUNDS)
    save(fig, path)


def _beam(sketch: Sketch, beam: BeamSpec) -> None:
    """Draw a beam as its outline, at least a line, with its name and direction."""
    outline, line = sketch.body(beam, BEAM, 1.0)
    middle, tangent = np.array(beam.place(0.5)), np.array(beam.tangent(0.5))
    arrow(sketch.axes, middle, middle + 0.03 * sketch.size * tangent, BEAM)
    left = np.array(beam.tangent(NAME)) @ symbols.LEFT
    sketch.label(beam.name, beam.place(NAME) + beam.height_at(NAME) / 2 * left, left, BEAM)
    flat = beam.height is None
    words = "beam: axis, without a height" if flat else "beam, height to scale"
    sketch.legend.setdefault(words, line if flat else outline)


def _side(sketch: Sketch, contact: ContactSpec) -> None:
    """Draw the surface that a node touches, with strokes on the side from which the node comes."""
    from matplotlib.collections import LineCollection

    _, line, left = sketch.lines[contact.beam]
    normal, radius = left if contact.side == "left" else -left, sketch.scene.radius(contact)
    offsets = np.array([sketch.scene.offset(contact, part) for part in PARTS]) - radius
    feet = line + offsets[:, None] * normal
    drawn = np.concatenate(
        [symbols.chain(feet), np.stack([feet, feet + STROKE * sketch.size * normal], axis=1)]
    )
    sketch.axes.add_collection(LineCollection(list(drawn), colors=SIDE, linewidths=0.9, zorder=4))
    sketch.axes.update_datalim(drawn.reshape(-1, 2))
    friction = f", friction {contact.friction:g}" if contact.friction else ""
    sketch.named(f"side of contact: {contact.surface} of the beam{friction}", SIDE, marker="|", markersize=6)


def _motions(sketch: Sketch) -> None:
    """Draw the prescribed motions of the supports."""
    scene = sketch.scene
    for support in scene.all_supports:
        at = place = np.array(scene.place(support.node))
        for stage, (*path, turn) in enumerate(scene.prescribed_motions[support.node].increments, 1):
            if any(path):
                at = at + path
                words = f"{hypot(*path):.6g} {sketch.units['length']}{_after(stage)}"
                sketch.arrows(at[None], np.array(path), words, HELD, 1.2, at_tip=True)
            if turn:
                sketch.turn(place, turn, f"{abs(turn):.6g} rad{_after(stage)}", HELD)
            if any(path) or turn:
                sketch.named("motion of a support", HELD, marker=">")


def _pin(sketch: Sketch, pin: PinSpec) -> None:
    """Draw a pin with its true radius, and its path."""
    points = np.array(pin.points)
    behind = _unit(points[0] - points[1]) if len(points) > 1 else np.array([0.0, -1.0])
    for stage in map(np.array, pin.stage_points):
        if len(stage) > 1:
            arrow(sketch.axes, stage[-1] - 0.01 * sketch.size * _unit(stage[-1] - stage[-2]), stage[-1], PIN)
    (mark,) = sketch.axes.plot(*points[0], "*", color=PIN, markersize=9, zorder=5)
    sketch.label(pin.name, points[0] + (pin.radius or 0.0) * behind, behind, PIN)
    sketch.disc(points[0], pin.radius, facecolor=PIN, edgecolor=PIN, alpha=0.35)
    if pin.radius:
        words = f"pin of radius {pin.radius:.6g} {sketch.units['length']}, to scale"
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

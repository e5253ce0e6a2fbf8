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
from comparisons.scene.conditions import LoadSpec
from comparisons.show import palette
from comparisons.show.plot import WIDTH, arrow, figure, ribbon, save
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
UP = np.array([0.0, 1.0])


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


def draw(scene: Scene, path: Path) -> None:
    """Draw the scene to `path`, in the format of its suffix, with a legend of everything in it.

    Beams and round pins have their true size. The symbols of supports, loads and contact sides have a size of their own; the value of
    a load stands beside its arrow.
    """
    points = np.concatenate([_axis(beam)[0] for beam in scene.beams])
    for pin in scene.pins:
        reach = pin.radius or 0.0
        points = np.concatenate([points, np.array(pin.points) - reach, np.array(pin.points) + reach])
    size = float(np.ptp(points, axis=0).max())
    width, height = np.maximum(np.ptp(points, axis=0), 0.2 * size) + 0.2 * size
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
    place = {"loc": "outside lower center", "ncols": 2, "fontsize": "small", "frameon": False}
    fig.legend(sketch.legend.values(), sketch.legend.keys(), **place)
    for _ in range(ROUNDS):
        fig.draw_without_rendering()
        sketch.separate()
    save(fig, path)


@dataclass(kw_only=True)
class _Sketch:
    """A drawing that grows; a label that moves down in favour of others has -1 beside it."""

    axes: Any
    scene: Scene
    size: float
    legend: dict[str, Any] = field(default_factory=dict)
    labels: list[tuple[Any, float]] = field(default_factory=list)

    @property
    def units(self) -> tuple[str, str]:
        """Units of force and length."""
        force, length = (unit.strip() for unit in self.scene.units.split(","))
        return force, length

    def beam(self, beam: BeamSpec) -> None:
        """Draw a beam as its outline, at least a line, with its name and direction."""
        axis, left = _axis(beam)
        heights = np.array([beam.height_at(part) for part in PARTS])
        colours = {"facecolor": BEAM, "edgecolor": BEAM, "alpha": 0.35, "linewidth": 1.5}
        (drawn,) = self.axes.fill(*ribbon(axis, left, heights).T, **colours)
        (line,) = self.axes.plot(*axis.T, color=BEAM, linewidth=1.0)
        middle, tangent = np.array(beam.place(0.5)), np.array(beam.tangent(0.5))
        arrow(self.axes, middle, middle + 0.03 * self.size * tangent, BEAM)
        sides = {contact.side for contact in self.scene.contacts if contact.beam == beam.name}
        taken = {1.0 if side == "left" else -1.0 for side in sides} | set(self._loaded_sides(beam))
        clear = (-1.0 if taken == {1.0} else 1.0) * _across(beam.tangent(NAME))
        self._label(beam.name, beam.place(NAME) + beam.height_at(NAME) / 2 * clear, clear, BEAM)
        flat = beam.height is None
        words = "beam: axis, without a height" if flat else "beam, height to scale"
        self.legend.setdefault(words, line if flat else drawn)

    def _loaded_sides(self, beam: BeamSpec) -> Iterator[float]:
        """Yield 1 for a load along a beam whose arrows stand on its left where its name is, and -1 for one on the right."""
        for load in (history.load for history in self.scene.load_histories):
            if load.beam == beam.name and load.force_per_length is not None:
                yield -float(np.sign(np.array(load.force_per_length) @ _across(beam.tangent(NAME))))

    def side(self, contact: ContactSpec) -> None:
        """Draw the surface that a node touches, with strokes on the side from which the node comes."""
        from matplotlib.collections import LineCollection

        axis, left = _axis(self.scene.beam(contact.beam))
        normal, radius = left if contact.side == "left" else -left, self.scene.radius(contact)
        offsets = np.array([self.scene.offset(contact, part) for part in PARTS]) - radius
        feet = axis + offsets[:, None] * normal
        strokes = np.stack([feet, feet + STROKE * self.size * normal], axis=1)
        drawn = np.concatenate([chain(feet), strokes])
        self.axes.add_collection(LineCollection(list(drawn), colors=SIDE, linewidths=0.9, zorder=4))
        self.axes.update_datalim(drawn.reshape(-1, 2))
        friction = f", friction {contact.friction:g}" if contact.friction else ""
        words = f"side of contact: {contact.surface} of the beam{friction}"
        self.legend.setdefault(words, _line(SIDE, marker="|", markersize=6))

    def supports(self) -> None:
        """Draw the supports, their prescribed motions, springs and hinges."""
        lines = {beam.name: _axis(beam)[0] for beam in self.scene.beams}
        self.legend |= draw_symbols(self.axes, self.scene, lines, SYMBOL * self.size)
        for support in self.scene.all_supports:
            place = self.scene.place(support.node)
            at = np.array(place)
            changes = self.scene.prescribed_motions[support.node].increments
            for stage, (dx, dy, turn) in enumerate(changes, 1):
                if dx or dy:
                    path = np.array([dx, dy])
                    arrow(self.axes, at, at + path, HELD)
                    words = f"{hypot(dx, dy):.6g} {self.units[1]}{_after(stage)}"
                    self._label(words, at + path, path, HELD)
                    at = at + path
                if turn:
                    self._turn(place, turn, f"{abs(turn):.6g} rad{_after(stage)}", HELD)
                if dx or dy or turn:
                    self.legend.setdefault("motion of a support", _line(HELD, marker=">"))

    def loads(self) -> None:
        """Draw the loads of every stage with their values, and the weights of the beams."""
        force, length = self.units
        for number, load in self.scene.numbered_loads():
            after = _after(number + 1)
            if load.force_per_length is not None:
                self._line_load(load, f"{hypot(*load.force_per_length):.6g} {force}/{length}{after}")
                continue
            at = self.scene.place(load.node) if load.at is None else self.scene.beam(load.beam).place(load.at)
            if any(load.force):
                words = f"{hypot(*load.force):.6g} {force}{after}"
                self._force(np.array(at), np.array(load.force), words, pulls=self._pulls(load))
            if load.moment:
                words = f"{abs(load.moment):.6g} {force} {length}{after}"
                self._turn(at, load.moment, words, LOAD)
                self.legend.setdefault("moment", legend_symbol(chain(arc(1.0)), LOAD))
        for stage, gravity in enumerate(self.scene.stage_gravities, 1):
            for beam in self.scene.beams if any(gravity) else ():
                if beam.density:
                    weight = np.array(gravity) * beam.mass
                    words = f"weight {hypot(*weight):.4g} {force}{_after(stage)}"
                    self._force(np.array(beam.place(WEIGHT)), weight, words, beside=True)

    def _force(
        self, at: Array, force: Array, words: str, *, beside: bool = False, pulls: bool = False
    ) -> None:
        """Draw a force as an arrow to the point where it acts, or away from it if it pulls; its value stands at the other end, or beside."""
        along = force / np.hypot(*force)
        tip = at + ARROW * self.size * along if pulls else at
        tail = tip - ARROW * self.size * along
        arrow(self.axes, tail, tip, LOAD, 2.0)
        if beside:
            self._label(words, (tail + tip) / 2, np.array([1.0, 0.0]), LOAD)
        else:
            self._label(words, tip if pulls else tail, along if pulls else -along, LOAD)
        self.legend.setdefault("force, arrow not to scale", _line(LOAD, marker=">", linewidth=2.0))

    def _pulls(self, load: LoadSpec) -> bool:
        """Whether a force on a beam's end points away from the beam, along which its arrow would lie."""
        if load.end is None:
            return False
        beam = self.scene.beam(load.beam)
        outward = np.array(beam.tangent(1.0)) if load.end == "end" else -np.array(beam.tangent(0.0))
        return float(np.array(load.force) @ outward) > PULL * float(np.hypot(*load.force))

    def _line_load(self, load: LoadSpec, words: str) -> None:
        """Draw a force per length as a row of arrows along a part of a beam."""
        beam, force = self.scene.beam(load.beam), np.array(load.force_per_length)
        along = force / np.hypot(*force)
        tips = np.array([beam.place(part) for part in np.linspace(*load.span, ROW).tolist()])
        tails = tips - ARROW / 2 * self.size * along
        for tail, tip in zip(tails, tips, strict=True):
            arrow(self.axes, tail, tip, LOAD, 0.9)
        self.axes.plot(*tails.T, color=LOAD, linewidth=0.9)
        self._label(words, tails[ROW // 2], -along, LOAD)
        entry = _line(LOAD, marker=">", linewidth=0.9)
        self.legend.setdefault("force per length, arrows not to scale", entry)

    def pin(self, pin: PinSpec) -> None:
        """Draw a pin with its true radius, and its path."""
        from matplotlib.patches import Circle

        points = np.array(pin.points)
        behind = points[0] - points[1] if len(points) > 1 else -UP
        behind = behind / np.hypot(*behind)
        for stage in map(np.array, pin.stage_points):
            if len(stage) > 1:
                last = (stage[-1] - stage[-2]) / np.hypot(*(stage[-1] - stage[-2]))
                arrow(self.axes, stage[-1] - 0.01 * self.size * last, stage[-1], PIN)
        (mark,) = self.axes.plot(*points[0], "*", color=PIN, markersize=9, linestyle="none", zorder=5)
        self._label(pin.name, points[0] + (pin.radius or 0.0) * behind, behind, PIN)
        if pin.radius:
            self.axes.add_patch(Circle(points[0], pin.radius, facecolor=PIN, edgecolor=PIN, alpha=0.35))
            if pin.moving:
                self.axes.add_patch(Circle(points[-1], pin.radius, fill=False, edgecolor=PIN, linestyle=":"))
            disc = _line(PIN, marker="o", markersize=9, linestyle="none", alpha=0.5)
            self.legend.setdefault(f"pin of radius {pin.radius:.6g} {self.units[1]}, to scale", disc)
        else:
            self.legend.setdefault("pin, a point", mark)
        if pin.moving:
            (path,) = self.axes.plot(*points.T, ":", color=PIN, linewidth=1.5)
            self.legend.setdefault("path of a pin", path)

    def _turn(self, place: Sequence[float], turn: float, words: str, colour: str) -> None:
        """Draw a moment or a rotation as an arc, with its value on the side without the arrow of a force."""
        at = np.array(place)
        ends = [load for load in self.scene.loads if load.end is not None and load.force[1] < 0.0]
        above = any(np.array_equal(at, self.scene.place(load.node)) for load in ends)
        points = at + TURN * self.size * arc(turn)
        self.axes.plot(*points.T, color=colour, linewidth=2.0)
        arrow(self.axes, points[-2], points[-1], colour, 2.0)
        side = -UP if above else UP
        self._label(words, at + TURN * self.size * side, side, colour)

    def _label(self, words: str, at: Array, direction: Array, colour: str) -> None:
        """Write beside a place, in the direction given."""
        x, y = direction / np.hypot(*direction)
        label = self.axes.annotate(
            words,
            at,
            (7 * x, 7 * y),
            textcoords="offset points",
            color=colour,
            fontsize="medium",
            ha="left" if x > 0.5 else "right" if x < -0.5 else "center",
            va="bottom" if y > 0.5 else "top" if y < -0.5 else "center",
        )
        self.labels.append((label, -1.0 if y < -0.5 else 1.0))

    def separate(self) -> None:
        """Move labels up or down that lie on others, and let the axes reach around all labels; the figure has been laid out."""
        free: list[Any] = []
        for label, way in self.labels:
            box = label.get_window_extent()
            while any(box.overlaps(other) for other in free):
                x, y = label.xyann
                label.xyann = (x, y + 4.0 * way)
                box = label.get_window_extent()
            free.append(box)
            self.axes.update_datalim(box.transformed(self.axes.transData.inverted()).corners())
        self.axes.autoscale_view()


def _after(stage: int) -> str:
    """Return the number of a stage after the first one."""
    return f" (stage {stage})" if stage > 1 else ""


def _axis(beam: BeamSpec) -> tuple[Array, Array]:
    """Return points of the undeformed axis, and the unit vectors to its left there."""
    left = [_across(beam.tangent(part)) for part in PARTS]
    return np.array([beam.place(part) for part in PARTS]), np.array(left)


def _across(tangent: Sequence[float]) -> Array:
    """Return the unit vector to the left of a tangent."""
    return np.array([-tangent[1], tangent[0]])


def _line(colour: str, **style: Any) -> Any:
    """Return an entry of a legend."""
    from matplotlib.lines import Line2D

    return Line2D([], [], color=colour, **style)

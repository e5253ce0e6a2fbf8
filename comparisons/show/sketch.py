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
from comparisons.scene.conditions import COMPONENTS, LoadSpec, SpringSpec
from comparisons.show import palette
from comparisons.show.plot import WIDTH, figure, save
from comparisons.show.symbols import (
    arc,
    chain,
    held_components,
    hinge_symbol,
    inward,
    legend_symbol,
    placed,
    spring_symbol,
    support_name,
    support_symbol,
)

BEAM, PIN, SIDE, HELD, LOAD = palette.BLUE, palette.PIN, palette.PURPLE, palette.BLACK, palette.GREEN
SYMBOL, STROKE, ARROW, TURN = 0.025, 0.012, 0.14, 0.05
"""Sizes of a support, a stroke on the side of a contact, the arrow of a force and the arc of a moment, over the size of the scene."""
PULL = 0.7
"""Cosine of the angle between a force and its beam above which the force is drawn as one that pulls."""
ROUNDS = 3
"""Times that the labels are separated and the axes fitted around them, which change each other."""
STROKES = 40
"""Strokes along the side of a contact, and pieces of an axis."""
ROW = 11
"""Arrows of a force per length."""
NAME, WEIGHT = 0.25, 0.65
"""Fractions of the length at which a beam's name and its weight stand."""
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
    for _ in range(ROUNDS):
        fig.draw_without_rendering()
        sketch.separate()
    save(fig, path)


def _bounds(scene: Scene) -> tuple[Array, Array]:
    """Return the lowest and the highest coordinates of beams and pins."""
    points = [point for beam in scene.beams for point in _axis(beam)[0].tolist()]
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
    labels : list of (Annotation, float)
        What is written so far, with 1 where it may move up and -1 where it may move down.
    """

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
        half = _heights(beam)[:, None] / 2 * left
        outline = np.concatenate([axis - half, (axis + half)[::-1]])
        (drawn,) = self.axes.fill(*outline.T, facecolor=BEAM, edgecolor=BEAM, alpha=0.35, linewidth=1.5)
        (line,) = self.axes.plot(*axis.T, color=BEAM, linewidth=1.0)
        middle, tangent = np.array(beam.place(0.5)), np.array(beam.tangent(0.5))
        self._arrow(middle, middle + 0.03 * self.size * tangent, BEAM)
        sides = {contact.side for contact in self.scene.contacts if contact.beam == beam.name}
        taken = {1.0 if side == "left" else -1.0 for side in sides} | set(self._loaded_sides(beam))
        clear = (-1.0 if taken == {1.0} else 1.0) * _across(beam.tangent(NAME))
        self._label(beam.name, beam.place(NAME) + beam.height_at(NAME) / 2 * clear, clear, BEAM)
        if beam.height is None:
            self.legend.setdefault("beam: axis, without a height", line)
        else:
            self.legend.setdefault("beam, height to scale", drawn)

    def _loaded_sides(self, beam: BeamSpec) -> Iterator[float]:
        """Yield 1 for a load along a beam whose arrows stand on its left where its name is, and -1 for one on the right."""
        for history in self.scene.load_histories:
            load = history.load
            if load.beam == beam.name and load.force_per_length is not None:
                yield -float(np.sign(np.array(load.force_per_length) @ _across(beam.tangent(NAME))))

    def side(self, contact: ContactSpec) -> None:
        """Draw the surface that a node touches, with strokes on the side from which the node comes."""
        beam = self.scene.beam(contact.beam)
        axis, left = _axis(beam, STROKES)
        normal = left if contact.side == "left" else -left
        radius = self.scene.radius(contact)
        offsets = [
            self.scene.offset(contact, part) - radius for part in np.linspace(0.0, 1.0, len(axis)).tolist()
        ]
        feet = axis + np.array(offsets)[:, None] * normal
        strokes = np.stack([feet, feet + STROKE * self.size * normal], axis=1)
        self._segments(np.concatenate([chain(feet), strokes]), SIDE, 0.9)
        friction = f", friction {contact.friction:g}" if contact.friction else ""
        words = f"side of contact: {contact.surface} of the beam{friction}"
        self.legend.setdefault(words, _line(SIDE, marker="|", markersize=6))

    def supports(self) -> None:
        """Draw the supports, their prescribed motions, springs and hinges."""
        scene = self.scene
        for support in scene.all_supports:
            symbol = support_symbol(held_components(support), inward(scene, support))
            self._segments(placed(symbol, np.array(scene.place(support.node)), SYMBOL * self.size), HELD, 1.1)
            symbol = support_symbol(held_components(support), UP)
            self.legend.setdefault(support_name(support), legend_symbol(symbol))
            at = np.array(scene.place(support.node))
            changes = scene.prescribed_motions[support.node].increments
            for stage, (dx, dy, turn) in enumerate(changes, 1):
                after = _after(stage)
                if dx or dy:
                    path = np.array([dx, dy])
                    self._arrow(at, at + path, HELD)
                    self._label(f"{hypot(dx, dy):.6g} {self.units[1]}{after}", at + path, path, HELD)
                    at = at + path
                if turn:
                    self._turn(scene.place(support.node), turn, f"{abs(turn):.6g} rad{after}", HELD)
                if dx or dy or turn:
                    self.legend.setdefault("motion of a support", _line(HELD, marker=">"))
        for spring in scene.springs:
            self._spring(spring)
        for hinge in scene.hinges:
            symbol = hinge_symbol()
            self._segments(placed(symbol, np.array(scene.place(hinge.node)), SYMBOL * self.size), HELD, 1.1)
            force, length = self.units
            stiff = f" of {hinge.stiffness:.6g} {force} {length}/rad" if hinge.stiffness else ""
            self.legend.setdefault(f"hinge{' with a spring' if stiff else ''}{stiff}", legend_symbol(symbol))

    def _spring(self, spring: SpringSpec) -> None:
        force, length = self.units
        stiffness = dict(zip(COMPONENTS, (*spring.stiffness, spring.rotation), strict=True))
        for component in spring.held:
            symbol = spring_symbol(component, inward(self.scene, spring))
            at = np.array(self.scene.place(spring.node))
            self._segments(placed(symbol, at, SYMBOL * self.size), HELD, 1.1)
            unit = f"{force} {length}/rad" if component == "rotation" else f"{force}/{length}"
            words = f"spring of {stiffness[component]:.6g} {unit} in {component}"
            self.legend.setdefault(words, legend_symbol(spring_symbol(component, UP)))

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
        self._arrow(tail, tip, LOAD, 2.0)
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
            self._arrow(tail, tip, LOAD, 0.9)
        self.axes.plot(*tails.T, color=LOAD, linewidth=0.9)
        self._label(words, tails[ROW // 2], -along, LOAD)
        self.legend.setdefault(
            "force per length, arrows not to scale", _line(LOAD, marker=">", linewidth=0.9)
        )

    def pin(self, pin: PinSpec) -> None:
        """Draw a pin with its true radius, and its path."""
        from matplotlib.patches import Circle

        points = np.array(pin.points)
        behind = points[0] - points[1] if len(points) > 1 else -UP
        behind = behind / np.hypot(*behind)
        for stage in map(np.array, pin.stage_points):
            if len(stage) > 1:
                last = (stage[-1] - stage[-2]) / np.hypot(*(stage[-1] - stage[-2]))
                self._arrow(stage[-1] - 0.01 * self.size * last, stage[-1], PIN)
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

    def _segments(self, segments: Array, colour: str, width: float) -> None:
        from matplotlib.collections import LineCollection

        self.axes.add_collection(LineCollection(list(segments), colors=colour, linewidths=width, zorder=4))
        self.axes.update_datalim(segments.reshape(-1, 2))

    def _arrow(self, tail: Array, tip: Array, colour: str, linewidth: float = 1.2) -> None:
        """Draw an arrow; the axes reach to its ends."""
        style = {"arrowstyle": "-|>", "color": colour, "linewidth": linewidth, "shrinkA": 0, "shrinkB": 0}
        self.axes.annotate("", tip, tail, arrowprops=style)
        self.axes.update_datalim([tail, tip])

    def _turn(self, place: Sequence[float], turn: float, words: str, colour: str) -> None:
        """Draw a moment or a rotation as an arc, with its value on the side without the arrow of a force."""
        at = np.array(place)
        ends = [load for load in self.scene.loads if load.end is not None and load.force[1] < 0.0]
        above = any(np.array_equal(at, self.scene.place(load.node)) for load in ends)
        points = at + TURN * self.size * arc(turn)
        self.axes.plot(*points.T, color=colour, linewidth=2.0)
        self._arrow(points[-2], points[-1], colour, 2.0)
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


def _parts(pieces: int) -> list[float]:
    return [float(part) for part in np.linspace(0.0, 1.0, pieces + 1)]


def _axis(beam: BeamSpec, pieces: int = STROKES) -> tuple[Array, Array]:
    """Return points of the undeformed axis, and the unit vectors to its left there."""
    parts = _parts(pieces)
    return np.array([beam.place(part) for part in parts]), np.array(
        [_across(beam.tangent(part)) for part in parts]
    )


def _heights(beam: BeamSpec, pieces: int = STROKES) -> Array:
    return np.array([beam.height_at(part) for part in _parts(pieces)])


def _across(tangent: Sequence[float]) -> Array:
    """Return the unit vector to the left of a tangent."""
    return np.array([-tangent[1], tangent[0]])


def _line(colour: str, **style: Any) -> Any:
    """Return an entry of a legend."""
    from matplotlib.lines import Line2D

    return Line2D([], [], color=colour, **style)

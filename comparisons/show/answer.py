"""The picture of one answer: deformed shape, section forces along the beams, and forces over the load parameter."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.quantities import forces, size
from comparisons.response import Array, Response
from comparisons.response.round_off import round_off
from comparisons.response.table import unit_names
from comparisons.scene import Scene
from comparisons.scene.stages import LoadHistory
from comparisons.show import palette
from comparisons.show.plot import WIDTH, arrow, figure, ribbon, save
from comparisons.show.symbols import draw_symbols
from comparisons.version import release

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = (palette.BLUE, palette.ORANGE, palette.GREEN, palette.PURPLE, palette.SKY, palette.GREY)
"""Colours of the beams, and of the forces, in turn."""
HEIGHT, DIAGRAM, HISTORY = 3.6, 1.25, 1.9
"""Heights of the shape, of each diagram and of the forces over the load parameter [inch]."""
SYMBOL, ARROW = 0.03, 0.16
"""Sizes of a support and of the largest force, over the size of the scene."""
SPREAD = 9
"""Arrows of a load along a beam."""
DIAGRAMS = (("N", "axial", "force"), ("V", "shear", "force"), ("M", "moment", "moment"))


class PictureError(ValueError):
    """An answer that cannot be drawn: one line."""


def plot_answer(response: Response, path: Path) -> None:
    """Draw an answer to `path`, in the format of its suffix; see `picture`."""
    save(picture(response), path)


def picture(response: Response, scene: Scene | None = None) -> "Figure":
    """Return the picture of an answer.

    It shows the deformed shape with supports, pins, loads and contact forces, the section forces along each beam, and the contact forces,
    without contact the reactions, over the load parameter. Shape and section forces are those of the last load parameter at which a
    force acts.

    Parameters
    ----------
    response : Response
        The answer. A model that states no section forces has no diagrams.
    scene : Scene, optional
        The scene that was solved; needed for an answer that was read from a file.

    Raises
    ------
    PictureError
        If the scene is not known, or no load parameter was reached.
    """
    scene = scene or response.definition
    if scene is None:
        raise PictureError("scene: must be given, the answer was read from a file")
    if not len(response.load_parameter):
        raise PictureError(f"{response.scene}: {response.status}, no load parameter was reached")
    diagrams = DIAGRAMS if response.sections is not None else ()
    heights = (HEIGHT, *(DIAGRAM for _ in diagrams), HISTORY)
    fig: Figure = figure(figsize=(WIDTH, sum(heights)))
    shape, *panels, history = fig.subplots(len(heights), 1, height_ratios=heights)
    k = _loaded(response, scene)
    _shape(shape, response, scene, k)
    for axes, (name, words, kind) in zip(panels, diagrams, strict=True):
        _diagram(axes, response, scene, (name, kind), k)
        axes.set_ylabel(f"{words} {name}\n[{unit_names(scene.units)[kind]}]", fontsize="small")
    for axes in panels[:-1]:
        axes.sharex(panels[-1])
        axes.tick_params(labelbottom=False)
    if panels:
        panels[-1].set_xlabel(f"distance from the start of the beam [{unit_names(scene.units)['length']}]")
        if len(scene.beams) > 1:
            panels[0].legend(loc="best", fontsize="x-small", ncols=len(scene.beams))
    _history(history, response, scene)
    fig.supxlabel(f"tsm-crossval {release()}", fontsize="xx-small", x=0.99, ha="right")
    return fig


def _loaded(response: Response, scene: Scene) -> int:
    """Return the number of the last load parameter at which a contact or support force acts; of the last one if none does."""
    least = round_off(response, scene).force
    held = [support.force for support in response.supports.values()]
    acting = [size(values) > least for values in (*forces(response).values(), *held)]
    numbers = np.flatnonzero(np.any(acting, axis=0))
    return int(numbers[-1]) if len(numbers) else len(response.load_parameter) - 1


def _shape(axes: "Axes", response: Response, scene: Scene, k: int) -> None:
    units, t = unit_names(scene.units), float(response.load_parameter[k])
    lines = {beam.name: response.axis_line(beam.name, k) for beam in scene.beams}
    places = np.concatenate([line for _, line in lines.values()])
    places = np.concatenate([places, [beam.place(part) for beam in scene.beams for part in (0.0, 0.5, 1.0)]])
    extent = float(np.ptp(places, axis=0).max())
    for number, beam in enumerate(scene.beams):
        arc, line = lines[beam.name]
        undeformed = np.array([beam.place(part) for part in np.linspace(0.0, 1.0, 41)])
        dashed: dict[str, Any] = {"color": "0.6", "linewidth": 0.9, "linestyle": "--"}
        axes.plot(*undeformed.T, label=None if number else "undeformed", **dashed)
        colour, tangent = COLOURS[number % len(COLOURS)], np.gradient(line, axis=0)
        normal = (
            np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
            / np.maximum(np.hypot(*tangent.T), 1e-300)[:, None]
        )
        height = np.array([beam.height_at(min(s / beam.length, 1.0)) for s in arc])
        axes.fill(*ribbon(line, normal, height).T, color=colour, alpha=0.35, linewidth=0.0)
        axes.plot(*line.T, color=colour, linewidth=1.6, label=beam.name)
    symbols = draw_symbols(axes, scene, {name: line for name, (_, line) in lines.items()}, SYMBOL * extent)
    for pin in scene.pins:
        _pin(axes, np.array(pin.position(t)), pin.radius, pin.name)
    _arrows(axes, response, scene, lines, k)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.08)
    title = " ".join(filter(None, (response.model, response.setting)))
    axes.set_title(f"{scene.name}, {title}: {response.status}, load parameter {t:.6g}", fontsize="medium")
    axes.set(xlabel=f"x [{units['length']}]", ylabel=f"y [{units['length']}]")
    axes.grid(visible=True, linewidth=0.3)
    handles, labels = axes.get_legend_handles_labels()
    short = {words.partition(" of ")[0]: entry for words, entry in symbols.items()}
    entries = ([*handles, *short.values()], [*labels, *short])
    place: dict[str, Any] = {
        "loc": "upper center",
        "bbox_to_anchor": (0.5, -0.17),
        "ncols": 5,
        "labelspacing": 1.2,
    }
    axes.legend(*entries, fontsize="x-small", frameon=False, **place)


def _pin(axes: "Axes", at: Array, radius: float | None, name: str) -> None:
    from matplotlib.patches import Circle

    if radius:
        axes.add_patch(Circle((at[0], at[1]), radius, facecolor=palette.PIN, alpha=0.5, label=name))
    axes.plot(*at, ".", color=palette.PIN, markersize=6, zorder=5, label=None if radius else name)


def _acting(
    response: Response, scene: Scene, lines: dict[str, tuple[Array, Array]], k: int
) -> Iterator[tuple[Array, Array, str, str]]:
    """Yield the point, the force, the colour and the value of every contact force and load; of a weight, its resultant."""
    units, t = unit_names(scene.units), float(response.load_parameter[k])
    for spec in scene.contacts:
        contact = response.contacts[spec.pair]
        if contact.vector is not None and contact.force[k] > 0.0:
            at = _at(lines[spec.beam], float(contact.arc_position[k]))
            yield at, contact.vector[k], palette.PIN, f"{_digits(contact.force[k])} {units['force']}"
    for history in scene.load_histories:
        x, y, _ = history.at(t)
        per = "" if history.load.force_per_length is None else f"/{units['length']}"
        words = f"{_digits(np.hypot(x, y))} {units['force']}{per}"
        yield from ((at, force, palette.BLACK, words) for at, force in _load(history, scene, lines, t))
    gravity = np.array(scene.gravity_at(t))
    for beam in scene.beams:
        weight = beam.mass * gravity
        if weight.any():
            words = f"weight {_digits(np.hypot(*weight))} {units['force']}"
            yield _at(lines[beam.name], beam.length / 2.0), weight, palette.BLACK, words


def _arrows(
    axes: "Axes", response: Response, scene: Scene, lines: dict[str, tuple[Array, Array]], k: int
) -> None:
    """Draw contact forces and loads as arrows with a common scale, and their values."""
    extent = float(np.ptp(np.concatenate([line for _, line in lines.values()]), axis=0).max())
    found = list(_acting(response, scene, lines, k))
    largest = max((float(np.hypot(*force)) for _, force, _, _ in found), default=0.0)
    shown: set[str] = set()
    for at, force, colour, words in found:
        if np.hypot(*force) <= 1e-6 * largest:
            continue
        tail = at - ARROW * extent * force / largest
        arrow(axes, tail, at, colour, 1.3)
        if words not in shown:
            place: dict[str, Any] = {"xytext": (3, 3), "textcoords": "offset points", "zorder": 6}
            axes.annotate(words, (tail[0], tail[1]), color=colour, fontsize="x-small", **place)
        shown.add(words)
    for colour, words in ((palette.PIN, "contact force on the beam"), (palette.BLACK, "load")):
        if any(own == colour for _, _, own, _ in found):
            axes.plot([], [], color=colour, marker=">", markersize=4, linewidth=1.3, label=words)


def _digits(value: float) -> str:
    """Return four significant digits, without an exponent below a million."""
    return f"{float(f'{value:.4g}'):.6g}"


def _load(
    history: LoadHistory, scene: Scene, lines: dict[str, tuple[Array, Array]], t: float
) -> list[tuple[Array, Array]]:
    """Return the points and forces of a load; of a force per length, its resultant in equal parts."""
    load, (x, y, _) = history.load, history.at(t)
    line, length, force = lines[load.beam], scene.beam(load.beam).length, np.array([x, y])
    if load.force_per_length is None:
        part = load.at if load.at is not None else float(load.end == "end")
        return [(_at(line, part * length), force)] if force.any() else []
    a, b = load.span
    share = force * (b - a) * length / SPREAD
    return [(_at(line, (a + (b - a) * (k + 0.5) / SPREAD) * length), share) for k in range(SPREAD)]


def _at(line: tuple[Array, Array], arc: float) -> Array:
    """Return the point of an axis at an arc length."""
    arcs, points = line
    return np.array([np.interp(arc, arcs, points[:, i]) for i in (0, 1)])


def _diagram(axes: "Axes", response: Response, scene: Scene, quantity: tuple[str, str], k: int) -> None:
    assert response.sections is not None, "diagrams are those of a model that states section forces"
    name, kind = quantity
    least = getattr(round_off(response, scene), kind)
    for number, beam in enumerate(scene.beams):
        at = response.sections(beam.name, k)
        colour, values = COLOURS[number % len(COLOURS)], getattr(at, name)
        values = np.where(np.abs(values) > least, values, 0.0)
        axes.fill_between(at.arc, values, color=colour, alpha=0.25, linewidth=0.0)
        axes.plot(at.arc, values, color=colour, linewidth=1.2, label=beam.name)
    axes.axhline(0.0, color="0.3", linewidth=0.6)
    axes.grid(visible=True, linewidth=0.3)
    axes.margins(x=0.01)


def _history(axes: "Axes", response: Response, scene: Scene) -> None:
    t, unit = response.load_parameter, unit_names(scene.units)["force"]
    for number, (name, values) in enumerate(forces(response).items()):
        colour, whole = COLOURS[number % len(COLOURS)], np.append(0.0, size(values))
        axes.plot(np.append(0.0, t), whole, label=name, color=colour, marker=".", markersize=3, linewidth=1.2)
    what = "contact force" if response.contacts else "reaction"
    axes.set_xlabel("load parameter")
    axes.set_ylabel(f"{what}\n[{unit}]", fontsize="small")
    axes.grid(visible=True, linewidth=0.3)
    axes.set_xlim(left=0.0)
    axes.legend(loc="best", fontsize="x-small")

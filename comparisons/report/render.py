"""Pictures, films and windows of stressed bodies: panels with one scale of stress and one of forces."""

from collections.abc import Sequence
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from comparisons.answer.table import unit_names
from comparisons.files import OutputError, replacing
from comparisons.models.model import Count, unwatched
from comparisons.report import palette
from comparisons.report.export import Series
from comparisons.report.panel import COLOURS, Panel, Scale, panel
from comparisons.report.plot import SHARP, WIDTH, arrow, figure, legend_below, save
from comparisons.scene import Scene

FRAMES = 40
"""Pictures of a film at most."""
PACE, REST = 80, 1500
"""Milliseconds that a GIF shows a picture, and the last one."""
LEAST = 0.04
"""Least length of an arrow, over half the size of the view."""
TALL = 4.5
"""Height of a panel at most [inch]."""
BODY = "#888888"
"""Colour of the rim of a body, seen on a light and on a dark ground."""


class Film(NamedTuple):
    """Panels side by side at a row of load parameters, and the scale of each, which all share but for a difference."""

    frames: Sequence[Sequence[Panel]]
    scales: Sequence[Scale]


def film(series: Sequence[Series], factor: float = 1.0) -> Film:
    """Return the film of at most `FRAMES` load parameters that all `series` reach; `OutputError` for none."""
    shared = sorted(set.intersection(*({*one.load_parameter.tolist()} for one in series)))
    if not shared:
        names = ", ".join(one.title for one in series)
        raise OutputError(f"{names}: no load parameter was reached, nothing to draw")
    kept = np.unique(np.linspace(0, len(shared) - 1, min(FRAMES, len(shared))).round().astype(int))
    frames = [[_panel(one, shared[k], factor) for one in series] for k in kept]
    units = series[0].units
    stress = units.get("axial_stress", units.get("axial_stress_left"))
    label = f"axial stress [{stress}]" if stress else "axial stress"
    scale = Scale.of(list(chain.from_iterable(frames)), label, units.get("contact_force", ""))
    return Film(frames, [scale] * len(series))


def _panel(series: Series, t: float, factor: float) -> Panel:
    k = series.load_parameter.tolist().index(t)
    return panel(series.blocks(k), f"{series.title}, t = {t:.3f}", factor)


def write_stress(panels: Sequence[Panel], wide: float, scene: Scene, t: float, path: Path) -> None:
    """Draw `mises_panels` of a load parameter, the difference with a scale of its own."""
    (*bodies, apart), unit = panels, unit_names(scene.units)["stress"]
    scale, top = Scale.of(bodies, f"von Mises stress [{unit}]"), float(np.abs(apart.stress).max())
    own = scale._replace(stress=(-top, top), label=f"{apart.title} [{unit}]")
    drawn = _Drawing(figure(), Film([panels], [scale] * len(bodies) + [own]))
    drawn.fill(panels)
    enlarged = f", heights enlarged {wide:g} times" if wide > 1.0 else ""
    drawn.figure.suptitle(f"{scene.name} at load parameter {t:.4g}{enlarged}", fontsize="small")
    save(drawn.figure, path)


def write_film(shown: Film, folder: Path, count: Count = unwatched) -> list[Path]:
    """Write ``view.png``, the last state, and ``view.gif``; `count` receives the pictures that are drawn."""
    from PIL import Image

    last, motion = files = [folder / "view.png", folder / "view.gif"]
    drawn, images = _Drawing(figure(dpi=SHARP), shown), []
    for number, panels in enumerate(shown.frames, 1):
        drawn.fill(panels)
        drawn.figure.canvas.draw()
        images.append(Image.fromarray(np.asarray(drawn.figure.canvas.buffer_rgba())[..., :3]))
        count(number, len(shown.frames))
    first, *rest = images
    pace = [PACE] * len(rest) + [REST]
    with replacing(last) as temporary:
        images[-1].save(temporary)
    with replacing(motion) as temporary:
        first.save(temporary, save_all=True, append_images=rest, duration=pace, loop=0, optimize=True)
    return files


def show(shown: Film) -> None:
    """Open a window with a slider over the frames; `OutputError` if it cannot be."""
    import matplotlib.pyplot as plt
    from matplotlib.widgets import Slider

    if plt.get_backend().lower() == "agg":
        raise OutputError("no window could be opened; --out DIR writes pictures instead")
    last = len(shown.frames) - 1
    drawn = _Drawing(plt.figure(layout="constrained"), shown)
    place = drawn.figure.add_axes((0.2, 0.01, 0.6, 0.03))
    slider = Slider(place, "load step", 0, last, valinit=last, valstep=1)

    def move(k: float) -> None:
        drawn.fill(shown.frames[int(k)])
        drawn.figure.canvas.draw_idle()

    slider.on_changed(move)
    move(last)
    plt.show()


class _Drawing:
    """A figure of panels, beside each other, or above each other where they are wide, which is filled again and again."""

    def __init__(self, made: Any, shown: Film) -> None:
        from matplotlib.lines import Line2D

        count, scale = len(shown.scales), shown.scales[0]
        states = {state for one in chain.from_iterable(shown.frames) for state in one.states}
        wide, tall = half = np.maximum(scale.extent, 0.15 * scale.half)
        columns = 1 if wide > 1.5 * tall else count
        named = {state: (".", COLOURS[state]) for state in COLOURS if state in states}
        named |= {scale.arrow: (">", palette.BLACK)} if scale.arrow else {}
        marks = {words: Line2D([], [], ls="none", marker=m, color=c) for words, (m, c) in named.items()}
        if marks:
            legend_below(made, marks, 4)
        height = min(TALL, WIDTH / columns * tall / wide) + 0.35
        self.figure, self.scales, self.labels = made, shown.scales, set[str]()
        self.view = np.transpose([scale.centre - 1.04 * half, scale.centre + 1.04 * half])
        rows = count // columns
        made.set_size_inches(WIDTH, rows * height + 1.4)
        self.panels = made.subplots(rows, columns, squeeze=False).ravel()

    def fill(self, panels: Sequence[Panel]) -> None:
        """Draw panels in place of what was there, and the colours of each scale once."""
        for axes, one, scale in zip(self.panels, panels, self.scales, strict=True):
            axes.clear()
            bodies = _draw(axes, one, scale)
            axes.set(xlim=self.view[0], ylim=self.view[1], aspect="equal")
            if scale.label not in self.labels:
                self.labels.add(scale.label)
                own = [own for own, other in zip(self.panels, self.scales, strict=True) if other is scale]
                place: dict[str, Any] = {"location": "bottom", "fraction": 0.05, "pad": 0.02}
                bar = self.figure.colorbar(bodies, ax=own, **place)
                bar.set_label(scale.label, fontsize="small")
                bar.ax.tick_params(labelsize="small")
                bar.ax.locator_params(nbins=3)


def _draw(axes: Any, one: Panel, scale: Scale) -> Any:
    """Draw a panel; return what has the colours."""
    from matplotlib.collections import LineCollection, PolyCollection
    from matplotlib.patches import Circle

    axes.set_axis_off()
    axes.set_title(one.title, fontsize="small")
    corners = np.arange(one.stress.size).reshape(-1, 4)
    triangles = np.concatenate([corners[:, :3], corners[:, [0, 2, 3]]])
    rim: dict[str, Any] = {"facecolor": BODY, "edgecolor": BODY, "linewidth": 1.0, "rasterized": True}
    axes.add_collection(PolyCollection(list(one.quads), **rim))
    style = {"cmap": scale.colours, "vmin": scale.stress[0], "vmax": scale.stress[1], "rasterized": True}
    x, y = one.quads.reshape(-1, 2).T
    bodies = axes.tripcolor(x, y, triangles, one.stress.ravel(), shading="gouraud", **style)
    axes.add_collection(LineCollection(list(one.supports), colors=palette.BLACK, linewidths=1.0))
    lengths = np.hypot(*one.forces.T)
    for state, colour in COLOURS.items():
        for k in np.flatnonzero(one.states == state):
            axes.add_patch(Circle(tuple(one.pins[k]), one.radii[k], facecolor=colour, alpha=0.35))
            axes.plot(*one.pins[k], ".", color=colour, markersize=6)
            if scale.force * lengths[k] > LEAST * scale.half:
                tip = one.pins[k] + one.radii[k] / lengths[k] * one.forces[k]
                arrow(axes, tip - scale.force * one.forces[k], tip, colour)
    return bodies

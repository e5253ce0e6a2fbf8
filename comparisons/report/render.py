"""Pictures of stressed bodies by pyvista, in a child process: without OpenGL, VTK ends its process.

``python -m comparisons.report.render`` draws the film that its standard input has.
"""

import os
import pickle
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from comparisons.answer import Array
from comparisons.extras import install
from comparisons.files import OutputError, replacing
from comparisons.models.model import Count, uncounted
from comparisons.report.export import Series
from comparisons.report.panel import COLOURS, Panel, Scale, panel

NO_OPENGL = (
    "pyvista cannot draw here: it needs OpenGL, as Debian's libegl1 and libgl1-mesa-dri or libosmesa6 have it; if "
    f"pyvista is missing, {install('pyvista')}"
)
FRAMES = 40
"""Pictures of a film at most."""
PACE, REST = 80, 1500
"""Milliseconds that a GIF shows a picture, and the last one."""
GIF, PANEL = 700, 900
"""Pixels of a panel's width in a GIF and in a picture."""
LOWEST, AROUND, TALLEST, RIM = 520, 380, 610, 1.12
"""Pixels of a panel's height at least, of title, legend and colours together, and of the tallest drawing; rim beside a wide drawing."""
TITLE, LABEL, LINE, BELOW_TITLE, BAR = 15, 30, 40, 85, 70
"""Sizes of the title in points of VTK, of other words, of a line and the place of the legend, and of the colours, in pixels."""
LEAST, POINT = 0.04, 0.014
"""Least length of an arrow and radius of a mark, over half the size of the view."""
LAYER = 0.01
"""Height of a drawing above the one that it covers, over half the size of the view."""


class NoOpenGLError(OutputError):
    """Nothing could be drawn, and what is missing: one line."""


class Film(NamedTuple):
    """Panels side by side at a row of load parameters, and the scale that they share."""

    frames: list[list[Panel]]
    scale: Scale


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
    return Film(
        frames, Scale.of([one for panels in frames for one in panels], label, units.get("contact_force", ""))
    )


def _panel(series: Series, t: float, factor: float) -> Panel:
    k = int(np.flatnonzero(series.load_parameter == t)[0])
    return panel([series.blocks(k)], f"{series.title}, t = {t:.3f}", factor)


def write_picture(panels: list[Panel], stress_label: str, path: Path) -> None:
    """Write the picture of `panels`; `NoOpenGLError` if it cannot be drawn."""
    with tempfile.TemporaryDirectory() as folder:
        (picture,) = _drawn(Film([panels], Scale.of(panels, stress_label)), Path(folder))
        with replacing(path) as temporary:
            temporary.write_bytes(picture.read_bytes())


def write_film(shown: Film, folder: Path, count: Count = uncounted) -> list[Path]:
    """Write ``view.png``, the last state, and ``view.gif``; `count` receives the pictures that are drawn."""
    from PIL import Image

    last, motion = files = [folder / "view.png", folder / "view.gif"]
    with tempfile.TemporaryDirectory() as scratch:
        images = [Image.open(picture).convert("RGB") for picture in _drawn(shown, Path(scratch), count)]
    with replacing(last) as temporary:
        images[-1].save(temporary)
    wide = GIF * len(shown.frames[0])
    first, *rest = (image.resize((wide, image.height * wide // image.width)) for image in images)
    pace = [PACE] * len(rest) + [REST]
    with replacing(motion) as temporary:
        first.save(temporary, save_all=True, append_images=rest, duration=pace, loop=0, optimize=True)
    return files


def _drawn(shown: Film, folder: Path, count: Count = uncounted) -> list[Path]:
    """Draw ``0.png`` and so on into a folder."""
    if not _child(shown, folder, count):
        raise NoOpenGLError(NO_OPENGL)
    return [folder / f"{k}.png" for k in range(len(shown.frames))]


def show(shown: Film) -> None:
    """Open a window with a slider over the frames; `OutputError` if it cannot be."""
    if not _child(shown, None):
        raise OutputError("no window could be opened; --out DIR writes pictures instead")


def renders() -> bool:
    """Whether off-screen rendering works on this machine: a trial."""
    trial = Film([[]], Scale(centre=(0.0, 0.0), extent=(1.0, 1.0), stress=(0.0, 1.0), force=0.0, label=""))
    with tempfile.TemporaryDirectory() as folder:
        return _child(trial, Path(folder))


def _child(shown: Film, folder: Path | None, count: Count = uncounted) -> bool:
    """Draw in a child process, which says a line for each frame; return whether it succeeded."""
    pipes: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    with tempfile.TemporaryFile() as given:
        pickle.dump((*shown, folder), given)
        given.seek(0)
        command = [sys.executable, "-m", "comparisons.report.render"]
        with subprocess.Popen(command, stdin=given, **pipes) as child:  # noqa: S603 our own module
            for number, _ in enumerate(child.stdout or (), 1):
                count(number, len(shown.frames))
    return child.returncode == 0


def _main(frames: list[list[Panel]], scale: Scale, folder: Path | None) -> None:
    """Draw every frame to a picture in the folder; without one, open a window."""
    import pyvista

    count, (height, pixels) = len(frames[-1]) or 1, _window(scale)
    size = (PANEL * count, height)
    plotter = pyvista.Plotter(off_screen=folder is not None, shape=(1, count), window_size=size, border=False)
    plotter.set_background("white")
    _draw(plotter, frames[-1], scale)
    plotter.link_views()
    camera = plotter.camera
    camera.parallel_projection, camera.parallel_scale = True, height / (2.0 * pixels)
    camera.focal_point, camera.up = (*scale.centre, 0.0), (0.0, 1.0, 0.0)
    camera.position = (*scale.centre, 10.0 * scale.half)
    camera.clipping_range = (0.1 * scale.half, 100.0 * scale.half)
    if folder is None:
        slider = {"value": len(frames) - 1, "title": "load step", "fmt": "%.0f", "color": "black"}
        plotter.subplot(0, 0)
        plotter.add_slider_widget(
            lambda value: _draw(plotter, frames[round(value)], scale), (0, len(frames) - 1), **slider
        )
        plotter.show()
        return
    for k, panels in enumerate(frames):
        _draw(plotter, panels, scale)
        plotter.render()
        plotter.screenshot(folder / f"{k}.png")
        os.write(1, b"\n")


def _draw(plotter: Any, panels: list[Panel], scale: Scale) -> None:
    """Put the panels into the plotter, in place of what was there."""
    import pyvista

    height, plain = plotter.window_size[1], {"lighting": False, "render": False}
    plotter.clear_actors()
    plotter.scalar_bars.clear()
    sizes = {
        "title_font_size": LABEL,
        "label_font_size": LABEL,
        "unconstrained_font_size": True,
        "fmt": "%.4g",
    }
    place = {"position_x": 0.15, "position_y": 0.01, "width": 0.7, "height": BAR / height}
    for i, one in enumerate(panels):
        plotter.subplot(0, i)
        # one bar in each panel takes different titles
        bar = {"title": f"{scale.label}{' ' * i}\n", "color": "black", "n_labels": 3, **sizes, **place}
        plotter.add_mesh(
            _bodies(one.quads),
            scalars=one.stress.ravel(),
            clim=scale.stress,
            cmap=scale.colours,
            scalar_bar_args=bar,
            **plain,
        )
        for layer, (colour, opacity, shapes) in enumerate(_shapes(one, scale), 1):
            shapes.points[:, 2] += layer * LAYER * scale.half
            plotter.add_mesh(shapes, color=colour, opacity=opacity, **plain)
        if len(one.supports):
            lines = pyvista.line_segments_from_points(_in_space(one.supports, LAYER * scale.half))
            plotter.add_mesh(lines, color="black", line_width=2, **plain)
        plotter.add_text(one.title, position="upper_edge", color="black", font_size=TITLE, render=False)
        entries = [[state, COLOURS[state]] for state in one.shown()]
        entries += [[scale.arrow, "black"]] if scale.arrow else []
        if entries:
            size = (0.45, LINE / height * len(entries))
            legend = plotter.add_legend(entries, face="circle", bcolor=None, size=size)
            legend.SetPosition(0.02, 1.0 - BELOW_TITLE / height - size[1])


def _shapes(one: Panel, scale: Scale) -> Iterator[tuple[str, float, Any]]:
    """Yield colour, opacity and meshes of discs, marks and arrows, from below."""
    import pyvista

    disc, lengths = pyvista.Disc(inner=0.0, outer=1.0, c_res=60), np.hypot(*one.forces.T)
    along = one.forces / np.where(lengths > 0.0, lengths, 1.0)[:, None]
    tails = one.pins + one.radii[:, None] * along - scale.force * one.forces
    for state in one.shown():
        own, colour = one.states == state, COLOURS[state]
        for opacity, radii in ((0.35, one.radii), (1.0, 0.0 * one.radii + POINT * scale.half)):
            nodes = pyvista.PolyData(_in_space(one.pins[own]))
            nodes["radius"] = radii[own]
            yield colour, opacity, nodes.glyph(orient=False, scale="radius", geom=disc)
        drawn = own & (scale.force * lengths > LEAST * scale.half)
        if drawn.any():
            forces = pyvista.PolyData(_in_space(tails[drawn]))
            forces["force"] = _in_space(one.forces[drawn])
            arrow = pyvista.Arrow(tip_radius=0.08, shaft_radius=0.025)
            yield colour, 1.0, forces.glyph(orient="force", scale="force", factor=scale.force, geom=arrow)


def _in_space(points: Array, height: float = 0.0) -> Array:
    """Return points (..., 2) in space, shape (n, 3)."""
    return np.insert(points.reshape(-1, 2), 2, height, axis=1)


def _bodies(quads: Array) -> Any:
    """Return quadrilaterals (n, 4, 2) in space."""
    import pyvista

    return pyvista.PolyData.from_regular_faces(_in_space(quads), np.arange(quads.size // 2).reshape(-1, 4))


def _window(scale: Scale) -> tuple[int, float]:
    """Return the height of a panel in pixels, flat for a flat drawing, and the pixels of a unit of length."""
    wide, tall = (max(half, 1e-3 * scale.half) for half in scale.extent)
    pixels = min(PANEL / (2.0 * RIM * wide), TALLEST / (2.0 * tall))
    return round(min(max(AROUND + 2.0 * tall * pixels, LOWEST), PANEL)), pixels


if __name__ == "__main__":
    _main(*pickle.load(sys.stdin.buffer))  # noqa: S301 our own caller's

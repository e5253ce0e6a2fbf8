"""Pictures of stressed bodies side by side, by pyvista in a child process, or by matplotlib where that cannot draw.

VTK ends its process where there is no OpenGL, so it never runs in the caller's: ``python -m comparisons.show.render
FRAMES FOLDER`` draws every frame to a picture, and without a folder it opens a window.
"""

import os
import pickle
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib.util import find_spec
from math import inf
from pathlib import Path
from time import monotonic
from typing import Any

import numpy as np

from comparisons.extras import install
from comparisons.files import replacing
from comparisons.models.progress import REDRAW, Count, uncounted
from comparisons.response import Array
from comparisons.show.panel import COLOURS, Panel, Scale
from comparisons.show.plot import WIDTH, figure, save

TIMEOUT, FRAME = 60.0, 5.0
"""Seconds for a picture, and for each frame: a machine whose processors are shared takes several of them."""
ENVIRONMENTS: tuple[dict[str, str], ...] = ({}, {"VTK_DEFAULT_OPENGL_WINDOW": "vtkOSOpenGLRenderWindow"})
"""Tried in turn: VTK's own choice, then drawing in memory by libOSMesa alone."""
INSTEAD = "off-screen rendering is not available here (no OpenGL, or a broken pyvista), matplotlib drew the picture instead"
NOT_INSTALLED = f"pyvista is not installed ({install('pyvista')}), matplotlib drew the picture instead"
TRIAL = "import pyvista; p = pyvista.Plotter(off_screen=True, window_size=(8, 8)); p.screenshot(); p.close()"

PANEL, LEAST = 900, 1400
"""Pixels of a panel's width, and of a picture's at least; the other sizes are of a panel of 900 pixels and grow with it."""
LOWEST, AROUND, TALLEST, RIM = 520, 380, 610, 1.12
"""Pixels of a panel's height at least, of title, legend and colours together, and of the tallest drawing; rim beside a wide drawing."""
TITLE, LABEL, LINE, BELOW_TITLE, BAR = 15, 30, 40, 85, 70
"""Sizes of the title in points of VTK, of other words, of a line and the place of the legend, and of the colours, in pixels."""
LAYER = 0.01
"""Height of a drawing above the one that it covers, over half the size of the view."""


def render_panels(panels: list[Panel], stress_label: str, path: Path) -> str | None:
    """Write the picture of `panels`; return one sentence if matplotlib had to draw it."""
    with tempfile.TemporaryDirectory() as folder, replacing(path) as temporary:
        pictures, sentence = render_frames([panels], Scale.of(panels, stress_label), Path(folder))
        temporary.write_bytes(pictures[0].read_bytes())
    return sentence


def render_frames(
    frames: Sequence[list[Panel]], scale: Scale, folder: Path, count: Count = uncounted
) -> tuple[list[Path], str | None]:
    """Write ``frame-0000.png`` and so on to `folder`, every one in the same view and scale; `count` receives how many there are.

    Return the pictures, and one sentence if matplotlib had to stand in.
    """
    pictures = [folder / f"frame-{k:04d}.png" for k in range(len(frames))]
    installed = find_spec("pyvista") is not None

    def drawn() -> None:
        count(sum(picture.is_file() for picture in pictures), len(pictures))

    command = [*_command(frames, scale, folder), str(folder)]
    for extra in ENVIRONMENTS if installed else ():
        if _run(command, extra, TIMEOUT + FRAME * len(frames), drawn) and pictures[-1].is_file():
            return pictures, None
        for picture in pictures:  # of a child that ended among them
            picture.unlink(missing_ok=True)
    for panels, picture in zip(frames, pictures, strict=True):
        plot_panels(panels, scale, picture)
        drawn()
    return pictures, INSTEAD if installed else NOT_INSTALLED


def show_frames(frames: Sequence[list[Panel]], scale: Scale) -> bool:
    """Open a window with a slider over the frames; whether it could be."""
    with tempfile.TemporaryDirectory() as folder:
        return _run(_command(frames, scale, Path(folder)), {}, inf)


def renders() -> bool:
    """Whether off-screen rendering works on this machine: a trial in a child process."""
    return any(_run(["-c", TRIAL], extra, TIMEOUT) for extra in ENVIRONMENTS)


def _command(frames: Sequence[list[Panel]], scale: Scale, folder: Path) -> list[str]:
    """Write what the child process draws; return its arguments."""
    path = folder / "frames"
    path.write_bytes(pickle.dumps((frames, scale)))
    return ["-m", "comparisons.show.render", str(path)]


def _run(
    arguments: list[str],
    environment: dict[str, str],
    seconds: float,
    meanwhile: Callable[[], None] = lambda: None,
) -> bool:
    """Run this interpreter in a child process, and `meanwhile` while it runs; return whether the process succeeded."""
    command, last = [sys.executable, *arguments], monotonic() + seconds
    silent: dict[str, Any] = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
    with subprocess.Popen(command, env={**os.environ, **environment}, **silent) as child:  # noqa: S603 our own module
        try:
            while child.poll() is None and monotonic() < last:
                meanwhile()
                with suppress(subprocess.TimeoutExpired):
                    child.wait(REDRAW)
        finally:
            child.kill()
    return child.returncode == 0


def plot_panels(panels: list[Panel], scale: Scale, path: Path) -> None:
    """Draw the panels by matplotlib, in place of the rendered picture."""
    from matplotlib.collections import LineCollection, PolyCollection
    from matplotlib.lines import Line2D

    wide, tall = (1.12 * max(half, 0.25 * scale.half) for half in scale.extent)
    fig = figure(figsize=(WIDTH, min(WIDTH / len(panels) * tall / wide, 7.0) + 1.7))
    frames = fig.subplots(1, len(panels), sharex=True, sharey=True, squeeze=False)[0]
    x, y = scale.centre
    for axes, panel in zip(frames, panels, strict=True):
        lines: dict[str, Any] = {"edgecolors": "face", "linewidths": 0.3}
        stress = panel.stress.mean(axis=1)
        bodies = PolyCollection(list(panel.quads), array=stress, cmap=scale.colours, **lines)
        bodies.set_clim(*scale.stress)
        axes.add_collection(bodies)
        axes.add_collection(LineCollection(list(panel.supports), colors="black", linewidths=0.8))
        for colour, opacity, polygons in panel.shapes(scale):
            axes.add_collection(PolyCollection(list(polygons), facecolors=colour, alpha=opacity))
        axes.set(aspect="equal", xlim=(x - wide, x + wide), ylim=(y - tall, y + tall))
        axes.set_title(panel.title, fontsize="medium")
        axes.tick_params(labelsize="small")
    fig.colorbar(bodies, ax=list(frames), label=scale.label, location="bottom", shrink=0.5)
    words = _legend(panels, scale)
    dots = [Line2D([], [], linestyle="none", marker="o", color=colour) for colour in words.values()]
    place = {"loc": "outside lower center", "ncols": len(words) or 1, "fontsize": "small", "frameon": False}
    fig.legend(dots, words, **place)
    save(fig, path)


def _legend(panels: Sequence[Panel], scale: Scale) -> dict[str, str]:
    """Return the colours of the contacts by their names, and what the longest arrow is."""
    words = {state: COLOURS[state] for panel in panels for state in panel.shown()}
    return {**words, scale.arrow: "black"} if scale.arrow else words


def _plotter(panels: list[Panel], scale: Scale, *, off_screen: bool) -> Any:
    """Return a plotter with the panels in one view."""
    import pyvista

    width, height, pixels = _window(panels, scale)
    size = (width * len(panels), height)
    plotter = pyvista.Plotter(off_screen=off_screen, shape=(1, len(panels)), window_size=size, border=False)
    plotter.set_background("white")
    _draw(plotter, panels, scale)
    for i in range(len(panels)):
        plotter.subplot(0, i)
        plotter.enable_parallel_projection()
        camera = plotter.camera
        camera.focal_point, camera.up = (*scale.centre, 0.0), (0.0, 1.0, 0.0)
        camera.position, camera.parallel_scale = (*scale.centre, 10.0 * scale.half), height / (2.0 * pixels)
        camera.clipping_range = (0.1 * scale.half, 100.0 * scale.half)
    plotter.link_views()
    return plotter


def _draw(plotter: Any, panels: list[Panel], scale: Scale) -> None:
    """Put the panels into the plotter, in place of what was there."""
    width, height, _ = _window(panels, scale)
    factor, plain = width / PANEL, {"lighting": False, "render": False}
    plotter.clear_actors()
    plotter.scalar_bars.clear()
    for i, panel in enumerate(panels):
        plotter.subplot(0, i)
        body = _mesh(panel.quads, 0.0)
        body.point_data["stress"] = panel.stress.ravel()
        # one bar in each panel takes different titles
        bar = {**_bar(factor * LABEL, factor * BAR / height), "title": scale.label + " " * i + "\n"}
        plotter.add_mesh(body, clim=scale.stress, cmap=scale.colours, scalar_bar_args=bar, **plain)
        for layer, (colour, opacity, polygons) in enumerate(panel.shapes(scale), 1):
            if len(polygons):
                mesh = _mesh(polygons, layer * LAYER * scale.half)
                plotter.add_mesh(mesh, color=colour, opacity=opacity, **plain)
        if len(panel.supports):
            lines = _mesh(panel.supports, LAYER * scale.half)
            plotter.add_mesh(lines, color="black", line_width=2, **plain)
        title = {"position": "upper_edge", "color": "black", "font_size": round(factor * TITLE)}
        plotter.add_text(panel.title, render=False, **title)
        entries = [list(item) for item in _legend([panel], scale).items()]
        if entries:
            size = (0.45, factor * LINE / height * len(entries))
            legend = plotter.add_legend(entries, face="circle", bcolor=None, size=size)
            legend.SetPosition(0.02, 1.0 - factor * BELOW_TITLE / height - size[1])


def _mesh(shapes: Array, height: float) -> Any:
    """Return polygons or, with two corners, lines (n, corners, 2) in space."""
    import pyvista

    count, corners = shapes.shape[:2]
    numbers = np.insert(np.arange(count * corners).reshape(count, corners), 0, corners, axis=1).ravel()
    points = np.insert(shapes.reshape(-1, 2), 2, height, axis=1)
    return pyvista.PolyData(points, **{"lines" if corners == 2 else "faces": numbers})


def _window(panels: list[Panel], scale: Scale) -> tuple[int, int, float]:
    """Return width and height of a panel in pixels, and the pixels of a unit of length: a flat drawing has a flat panel."""
    width = max(PANEL, LEAST // len(panels))
    factor = width / PANEL
    wide, tall = (max(half, 1e-3 * scale.half) for half in scale.extent)
    pixels = min(width / (2.0 * RIM * wide), factor * TALLEST / (2.0 * tall))
    height = min(max(factor * AROUND + 2.0 * tall * pixels, factor * LOWEST), float(width))
    return width, round(height), pixels


def _bar(letters: float, height: float) -> dict[str, Any]:
    """Return the options of the colours, for letters of that size in pixels and a part of the panel's height."""
    place = {"position_x": 0.15, "position_y": 0.01, "width": 0.7, "height": height}
    sizes = dict.fromkeys(("title_font_size", "label_font_size"), round(letters))
    return {"color": "black", "fmt": "%.4g", "n_labels": 3, "unconstrained_font_size": True, **place, **sizes}


def _main(frames: list[list[Panel]], scale: Scale, folder: Path | None) -> None:
    """Draw every frame to a picture in the folder; without one, open a window."""
    plotter = _plotter(frames[-1], scale, off_screen=folder is not None)
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
        plotter.screenshot(folder / f"frame-{k:04d}.png")
    plotter.close()


if __name__ == "__main__":
    given, scale = pickle.loads(Path(sys.argv[1]).read_bytes())  # noqa: S301 our own file, of the caller
    _main(given, scale, Path(sys.argv[2]) if len(sys.argv) > 2 else None)

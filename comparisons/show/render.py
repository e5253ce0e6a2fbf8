"""Pictures of stressed bodies side by side, by pyvista in a child process.

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
from numpy.typing import NDArray

from comparisons.extras import install
from comparisons.files import replacing
from comparisons.models.progress import REDRAW, Count, uncounted
from comparisons.show.panel import COLOURS, Panel, Scale
from comparisons.show.plot import plot_panels

TIMEOUT, FRAME = 60.0, 5.0
"""Seconds for a picture, and for each frame: a machine whose processors are shared takes several of them."""
ENVIRONMENTS: tuple[dict[str, str], ...] = ({}, {"VTK_DEFAULT_OPENGL_WINDOW": "vtkOSOpenGLRenderWindow"})
"""Tried in turn: VTK's own choice, then drawing in memory by libOSMesa alone."""
INSTEAD = "off-screen rendering is not available here (no OpenGL, or a broken pyvista), matplotlib drew the picture instead"
NOT_INSTALLED = f"pyvista is not installed ({install('pyvista')}), matplotlib drew the picture instead"

POINT = 0.014
"""Radius of the mark of a pin without radius, over half the size of the view."""
PANEL, LEAST = 900, 1400
"""Pixels of a panel's width, and of a picture's at least; the other sizes are of a panel of 900 pixels and grow with it."""
LOWEST, AROUND, TALLEST, RIM = 520, 380, 610, 1.12
"""Pixels of a panel's height at least, of title, legend and colours together, and of the tallest drawing; rim beside a wide drawing."""
TITLE, LABEL, LINE, BELOW_TITLE, BAR = 15, 30, 40, 85, 70
"""Sizes of the title in points of VTK, of other words, of a line and the place of the legend, and of the colours, in pixels."""


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
    pictures = [_picture(folder, k) for k in range(len(frames))]
    seconds = TIMEOUT + FRAME * len(frames)

    def drawn() -> None:
        count(sum(picture.is_file() for picture in pictures), len(pictures))

    installed = find_spec("pyvista") is not None
    if installed:
        command = _command(frames, scale, folder)
        for extra in ENVIRONMENTS:
            if _run([*command, str(folder)], extra, seconds, drawn) and pictures[-1].is_file():
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
        return _run(_command(frames, scale, Path(folder)), {}, None)


def renders() -> bool:
    """Whether off-screen rendering works on this machine: a trial in a child process."""
    trial = (
        "import pyvista; p = pyvista.Plotter(off_screen=True, window_size=(8, 8)); p.screenshot(); p.close()"
    )
    return any(_run(["-c", trial], extra, TIMEOUT) for extra in ENVIRONMENTS)


def _picture(folder: Path, k: int) -> Path:
    return folder / f"frame-{k:04d}.png"


def _command(frames: Sequence[list[Panel]], scale: Scale, folder: Path) -> list[str]:
    """Write what the child process draws; return its arguments."""
    path = folder / "frames"
    path.write_bytes(pickle.dumps((frames, scale)))
    return ["-m", "comparisons.show.render", str(path)]


def _run(
    arguments: list[str],
    environment: dict[str, str],
    seconds: float | None,
    meanwhile: Callable[[], None] = lambda: None,
) -> bool:
    """Run this interpreter in a child process, and `meanwhile` while it runs; return whether the process succeeded."""
    last = inf if seconds is None else monotonic() + seconds
    with subprocess.Popen(  # noqa: S603 our own interpreter and module
        [sys.executable, *arguments],
        env={**os.environ, **environment},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    ) as child:
        try:
            while child.poll() is None and monotonic() < last:
                meanwhile()
                with suppress(subprocess.TimeoutExpired):
                    child.wait(REDRAW)
        finally:
            if child.poll() is None:
                child.kill()
    return child.returncode == 0


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
        plotter.camera.focal_point = (*scale.centre, 0.0)
        plotter.camera.position = (*scale.centre, 10.0 * scale.half)
        plotter.camera.up = (0.0, 1.0, 0.0)
        plotter.camera.parallel_scale = height / (2.0 * pixels)
        plotter.camera.clipping_range = (0.1 * scale.half, 100.0 * scale.half)
    plotter.link_views()
    return plotter


def _draw(plotter: Any, panels: list[Panel], scale: Scale) -> None:
    """Put the panels into the plotter, in place of what was there."""
    import pyvista

    width, height, _ = _window(panels, scale)
    factor, plain = width / PANEL, {"lighting": False, "render": False}
    for renderer in plotter.renderers:  # a plotter that clears itself loses its slider, too
        for actor in list(renderer.actors.values()):
            renderer.remove_actor(actor, render=False)
    plotter.scalar_bars.clear()
    for i, panel in enumerate(panels):
        plotter.subplot(0, i)
        faces = np.insert(panel.quads, 0, 4, axis=1)
        body = pyvista.PolyData(np.pad(panel.points, ((0, 0), (0, 1))), faces.ravel())
        body.point_data["stress"] = panel.stress
        # one bar in each panel takes different titles
        bar = {**_bar(factor * LABEL, factor * BAR / height), "title": scale.label + " " * i + "\n"}
        plotter.add_mesh(body, clim=scale.stress, cmap=scale.colours, scalar_bar_args=bar, **plain)
        there = panel.pins_by_state()
        for state, numbers in there.items():
            discs, marks = _pins(panel, numbers, scale)
            if len(discs):
                plotter.add_mesh(_joined(discs), color=COLOURS[state], opacity=0.35, **plain)
            plotter.add_mesh(_joined(marks), color=COLOURS[state], **plain)
        if len(panel.supports):
            ends = np.insert(panel.supports.reshape(-1, 2), 2, 0.01 * scale.half, axis=1)
            lines = pyvista.line_segments_from_points(ends)
            plotter.add_mesh(lines, color="black", line_width=2, **plain)
        title = {"position": "upper_edge", "color": "black", "font_size": round(factor * TITLE)}
        plotter.add_text(panel.title, render=False, **title)
        entries = [[state, COLOURS[state]] for state in there]
        if scale.arrow:
            entries.append([scale.arrow, "black"])
        if entries:
            size = (0.45, factor * LINE / height * len(entries))
            legend = plotter.add_legend(entries, face="circle", bcolor=None, size=size)
            legend.SetPosition(0.02, 1.0 - factor * BELOW_TITLE / height - size[1])


def _pins(panel: Panel, numbers: NDArray[np.int64], scale: Scale) -> tuple[list[Any], list[Any]]:
    """Return the discs of round pins, and marks of all with their forces, which end where a pin touches."""
    import pyvista

    height = 0.01 * scale.half  # in front of the bodies
    discs, marks = [], []
    for pin, radius, force in zip(
        panel.pins[numbers], panel.radii[numbers], panel.forces[numbers], strict=True
    ):
        if radius:
            discs.append(pyvista.Disc(center=(*pin, height), inner=0.0, outer=radius, c_res=60))
        marks.append(pyvista.Sphere(radius=POINT * scale.half, center=(*pin, 4.0 * height)))
        length = float(np.hypot(*force)) * scale.force
        if length > 0.04 * scale.half:
            direction = force / np.hypot(*force)
            tail = (*(pin + (radius - length) * direction), 6.0 * height)
            thick = {"tip_length": 0.25, "tip_radius": 0.08, "shaft_radius": 0.025}
            marks.append(pyvista.Arrow(start=tail, direction=(*direction, 0.0), scale=length, **thick))
    return discs, marks


def _joined(parts: list[Any]) -> Any:
    import pyvista

    return pyvista.MultiBlock(parts).combine().extract_surface(algorithm=None)


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
    if folder is not None:
        for k, panels in enumerate(frames):
            _draw(plotter, panels, scale)
            plotter.render()
            plotter.screenshot(_picture(folder, k))
        plotter.close()
        return
    slider = {"value": len(frames) - 1, "title": "load step", "fmt": "%.0f", "color": "black"}
    plotter.subplot(0, 0)
    plotter.add_slider_widget(
        lambda value: _draw(plotter, frames[round(value)], scale), (0, len(frames) - 1), **slider
    )
    plotter.show()


if __name__ == "__main__":
    given, scale = pickle.loads(Path(sys.argv[1]).read_bytes())  # noqa: S301 our own file, of the caller
    _main(given, scale, Path(sys.argv[2]) if len(sys.argv) > 2 else None)

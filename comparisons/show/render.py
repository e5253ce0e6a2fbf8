"""Pictures of stressed bodies side by side, by pyvista in a child process.

VTK ends its process where there is no OpenGL, so it never runs in the caller's: ``python -m comparisons.show.render
FRAMES.npz FOLDER`` draws every frame to a picture, and without a folder it opens a window.
"""

import os
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
from comparisons.show.plot import plot_panels
from comparisons.show.stress import Panel, Scale

TIMEOUT = 60.0
"""Seconds for a picture; each further frame of a film has a second more."""
ENVIRONMENTS: tuple[dict[str, str], ...] = ({}, {"VTK_DEFAULT_OPENGL_WINDOW": "vtkOSOpenGLRenderWindow"})
"""Tried in turn: VTK's own choice, then drawing in memory by libOSMesa alone."""
INSTEAD = "off-screen rendering is not available here (no OpenGL, or a broken pyvista), matplotlib drew the picture instead"
NOT_INSTALLED = f"pyvista is not installed ({install('pyvista')}), matplotlib drew the picture instead"

BAR = {
    "color": "black",
    "fmt": "%.4g",
    "width": 0.6,
    "height": 0.07,
    "position_x": 0.2,
    "position_y": 0.03,
    "title_font_size": 18,
    "label_font_size": 16,
}
ARRAYS = ("points", "quads", "stress", "pins", "forces", "slip")


def render_panels(panels: list[Panel], stress_label: str, path: Path) -> str | None:
    """Write the picture of `panels`, rendered off screen if that works here, else by matplotlib.

    Returns
    -------
    str or None
        One sentence if matplotlib had to stand in.
    """
    with tempfile.TemporaryDirectory() as folder, replacing(path) as temporary:
        pictures, sentence = render_frames([panels], Scale.of(panels, stress_label), Path(folder))
        temporary.write_bytes(pictures[0].read_bytes())
    return sentence


def render_frames(
    frames: Sequence[list[Panel]], scale: Scale, folder: Path, count: Count = uncounted
) -> tuple[list[Path], str | None]:
    """Write ``frame-0000.png`` and so on to `folder`, every one in the same view and scale; `count` receives how many there are.

    Returns
    -------
    list of Path
        The pictures.
    str or None
        One sentence if matplotlib had to stand in.
    """
    data, pictures = folder / "frames.npz", [folder / f"frame-{k:04d}.png" for k in range(len(frames))]
    _write(data, frames, scale)
    command, seconds = ["-m", "comparisons.show.render", str(data), str(folder)], TIMEOUT + len(frames)
    installed = find_spec("pyvista") is not None

    def drawn() -> None:
        count(sum(picture.is_file() for picture in pictures), len(pictures))

    if installed and any(
        _run(command, extra, seconds, drawn) and pictures[-1].is_file() for extra in ENVIRONMENTS
    ):
        return pictures, None
    for panels, picture in zip(frames, pictures, strict=True):
        plot_panels(panels, scale, picture)
        drawn()
    return pictures, INSTEAD if installed else NOT_INSTALLED


def show_frames(frames: Sequence[list[Panel]], scale: Scale) -> bool:
    """Open a window with a slider over the frames; whether it could be."""
    with tempfile.TemporaryDirectory() as folder:
        data = Path(folder) / "frames.npz"
        _write(data, frames, scale)
        return _run(["-m", "comparisons.show.render", str(data)], {}, None)


def renders() -> bool:
    """Whether off-screen rendering works on this machine: a trial in a child process."""
    trial = (
        "import pyvista; p = pyvista.Plotter(off_screen=True, window_size=(8, 8)); p.screenshot(); p.close()"
    )
    return any(_run(["-c", trial], extra, TIMEOUT) for extra in ENVIRONMENTS)


def _run(
    arguments: list[str],
    environment: dict[str, str],
    seconds: float | None,
    meanwhile: Callable[[], None] = lambda: None,
) -> bool:
    """Whether a child process of our own interpreter came to its end; `meanwhile` is called while it runs."""
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


def _write(path: Path, frames: Sequence[list[Panel]], scale: Scale) -> None:
    arrays = {
        f"{name}-{k}-{i}": getattr(panel, name)
        for k, panels in enumerate(frames)
        for i, panel in enumerate(panels)
        for name in ARRAYS
    }
    titles = np.array([[panel.title for panel in panels] for panels in frames])
    numbers = np.array([*scale.centre, scale.half, *scale.stress, scale.force])
    np.savez(path, allow_pickle=False, titles=titles, label=np.array(scale.label), scale=numbers, **arrays)


def _read(path: Path) -> tuple[list[list[Panel]], Scale]:
    with np.load(path, allow_pickle=False) as data:
        frames = [
            [
                Panel(title=str(title), **{name: data[f"{name}-{k}-{i}"] for name in ARRAYS})
                for i, title in enumerate(titles)
            ]
            for k, titles in enumerate(data["titles"])
        ]
        x, y, half, low, high, force = data["scale"].tolist()
        label = str(data["label"])
    return frames, Scale(centre=(x, y), half=half, stress=(low, high), force=force, label=label)


def _plotter(panels: list[Panel], scale: Scale, *, off_screen: bool) -> Any:
    """Return a plotter with the panels in one view."""
    import pyvista

    plotter = pyvista.Plotter(
        off_screen=off_screen, shape=(1, len(panels)), window_size=(900 * len(panels), 900), border=False
    )
    plotter.set_background("white")
    _draw(plotter, panels, scale)
    for i in range(len(panels)):
        plotter.subplot(0, i)
        plotter.enable_parallel_projection()
        plotter.camera.focal_point = (*scale.centre, 0.0)
        plotter.camera.position = (*scale.centre, 10.0 * scale.half)
        plotter.camera.up = (0.0, 1.0, 0.0)
        plotter.camera.parallel_scale = 1.12 * scale.half
        plotter.camera.clipping_range = (0.1 * scale.half, 100.0 * scale.half)
    plotter.link_views()
    return plotter


def _draw(plotter: Any, panels: list[Panel], scale: Scale) -> None:
    """Put the panels into the plotter, in place of what was there."""
    import pyvista

    for i, panel in enumerate(panels):
        plotter.subplot(0, i)
        faces = np.insert(panel.quads, 0, 4, axis=1)
        body = pyvista.PolyData(np.pad(panel.points, ((0, 0), (0, 1))), faces.ravel())
        body.point_data["stress"] = panel.stress
        bar = {**BAR, "title": scale.label + " " * i + "\n"}  # one bar in each panel takes different titles
        plotter.add_mesh(
            body,
            name="body",
            clim=scale.stress,
            cmap=scale.colours,
            lighting=False,
            scalar_bar_args=bar,
            render=False,
        )
        for colour, numbers in panel.pin_colours().items():
            plotter.remove_actor(f"pins {i} {colour}", render=False)
            if len(numbers):
                plotter.add_mesh(
                    _pins(panel, numbers, scale),
                    name=f"pins {i} {colour}",  # a name is removed from all panels
                    color=colour,
                    lighting=False,
                    render=False,
                )
        plotter.add_text(
            panel.title, name="title", position="upper_edge", color="black", font_size=12, render=False
        )


def _pins(panel: Panel, numbers: NDArray[np.int64], scale: Scale) -> Any:
    """Return the surface of some pins, with their forces as arrows."""
    import pyvista

    height, marks = 0.01 * scale.half, pyvista.MultiBlock()
    for pin, force in zip(panel.pins[numbers], panel.forces[numbers], strict=True):
        marks.append(pyvista.Sphere(radius=0.014 * scale.half, center=(*pin, 4.0 * height)))
        length = float(np.hypot(*force)) * scale.force
        if length > 0.04 * scale.half:
            direction = force / np.hypot(*force)
            tail = pin - length * direction
            marks.append(
                pyvista.Arrow(
                    start=(*tail, 2.0 * height), direction=(*direction, 0.0), scale=length,
                    tip_length=0.25, tip_radius=0.08, shaft_radius=0.025,
                )
            )  # fmt: skip
    return marks.combine().extract_surface(algorithm=None)


def _draw_files(frames: list[list[Panel]], scale: Scale, folder: Path) -> None:
    plotter = _plotter(frames[0], scale, off_screen=True)
    for k, panels in enumerate(frames):
        _draw(plotter, panels, scale)
        plotter.render()
        plotter.screenshot(folder / f"frame-{k:04d}.png")
    plotter.close()


def _show(frames: list[list[Panel]], scale: Scale) -> None:
    plotter = _plotter(frames[-1], scale, off_screen=False)

    def move(value: float) -> None:
        _draw(plotter, frames[round(value)], scale)

    plotter.subplot(0, 0)
    plotter.add_slider_widget(
        move, (0, len(frames) - 1), value=len(frames) - 1, title="load step", fmt="%.0f", color="black"
    )
    plotter.show()


if __name__ == "__main__":
    if len(sys.argv) > 2:
        _draw_files(*_read(Path(sys.argv[1])), Path(sys.argv[2]))
    else:
        _show(*_read(Path(sys.argv[1])))

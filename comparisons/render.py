"""The picture of two stressed bodies side by side, by pyvista in a child process.

VTK ends its process where there is no OpenGL, so it never runs in the caller's: ``python -m comparisons.render
PANELS.npz PICTURE.png`` does the work.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from comparisons.files import replacing
from comparisons.plot import plot_panels
from comparisons.stress import Panel

TIMEOUT = 60.0
INSTEAD = "off-screen rendering is not available here (no OpenGL or no pyvista), matplotlib drew the picture instead"
SOFTWARE = {"VTK_DEFAULT_OPENGL_WINDOW": "vtkOSOpenGLRenderWindow"}
"""Makes VTK draw in memory by libOSMesa alone."""

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


def render_panels(panels: list[Panel], stress_label: str, path: Path) -> str | None:
    """Write the picture of `panels`, rendered off screen if that works here, else by matplotlib.

    Returns
    -------
    str or None
        One sentence if matplotlib had to stand in.
    """
    with tempfile.TemporaryDirectory() as folder, replacing(path) as temporary:
        data = Path(folder) / "panels.npz"
        _write(data, panels, stress_label)
        if not any(_rendered(data, temporary, extra) for extra in ({}, SOFTWARE)):
            plot_panels(panels, stress_label, temporary)
            return INSTEAD
    return None


def _rendered(data: Path, picture: Path, environment: dict[str, str]) -> bool:
    """Whether a child process wrote the picture."""
    command = [sys.executable, "-m", "comparisons.render", str(data), str(picture)]
    try:
        child = subprocess.run(  # noqa: S603 our own interpreter and module
            command, env={**os.environ, **environment}, capture_output=True, timeout=TIMEOUT, check=False
        )
    except subprocess.TimeoutExpired:
        return False
    return child.returncode == 0 and picture.is_file()


def _write(path: Path, panels: list[Panel], stress_label: str) -> None:
    arrays = {
        f"{name}{i}": getattr(panel, name)
        for i, panel in enumerate(panels)
        for name in ("points", "quads", "stress", "pins")
    }
    titles = np.array([panel.title for panel in panels])
    np.savez(path, allow_pickle=False, titles=titles, label=np.array(stress_label), **arrays)


def _read(path: Path) -> tuple[list[Panel], str]:
    with np.load(path, allow_pickle=False) as data:
        panels = [
            Panel(
                title=str(title),
                points=data[f"points{i}"],
                quads=data[f"quads{i}"],
                stress=data[f"stress{i}"],
                pins=data[f"pins{i}"],
            )
            for i, title in enumerate(data["titles"])
        ]
        return panels, str(data["label"])


def _draw(panels: list[Panel], stress_label: str, picture: Path) -> None:
    """Draw with one view and one colour scale for all panels."""
    import pyvista

    plotter = pyvista.Plotter(
        off_screen=True, shape=(1, len(panels)), window_size=(900 * len(panels), 900), border=False
    )
    plotter.set_background("white")
    top = max(float(panel.stress.max()) for panel in panels)
    radius = 0.008 * max(float(np.ptp(panel.points, axis=0).max()) for panel in panels)
    for i, panel in enumerate(panels):
        plotter.subplot(0, i)
        faces = np.insert(panel.quads, 0, 4, axis=1)
        body = pyvista.PolyData(np.pad(panel.points, ((0, 0), (0, 1))), faces.ravel())
        body.point_data["stress"] = panel.stress
        bar = {**BAR, "title": stress_label + " " * i + "\n"}  # one bar in each panel takes different titles
        plotter.add_mesh(body, clim=(0.0, top), cmap="viridis", lighting=False, scalar_bar_args=bar)
        for pin in panel.pins:
            ball = pyvista.Sphere(radius=radius, center=(*pin, 2.0 * radius))
            plotter.add_mesh(ball, color="#D55E00", lighting=False)
        plotter.add_text(panel.title, position="upper_edge", color="black", font_size=12)
        plotter.enable_parallel_projection()
        plotter.view_xy()
    plotter.link_views()
    plotter.camera.zoom(1.1)
    plotter.screenshot(picture)
    plotter.close()


if __name__ == "__main__":
    _draw(*_read(Path(sys.argv[1])), Path(sys.argv[2]))

"""The built-in scenes as small pictures of their beams on the way to the end, for the first page."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from comparisons.models import solve
from comparisons.scene import built_in_scenes, load_scene

STEPS = 10  # load parameters at most, of which four are drawn


def draw(name: str, path: Path) -> None:
    """Draw a scene's exact elements at four load parameters, and its pins with their paths."""
    from matplotlib.figure import Figure

    scene = load_scene(name)
    answer = solve(replace(scene, load_parameters=min(scene.load_parameters, STEPS)), "tsm")
    drawn = np.unique(np.linspace(0, len(answer.load_parameter) - 1, 4).astype(int))
    figure = Figure(figsize=(2.4, 1.8), layout="constrained")
    axes = figure.subplots()
    for beam in scene.beams:
        axes.plot(*np.array([beam.start, beam.end]).T, color="#888888", lw=0.8, ls=":")
        for k, step in enumerate(drawn):
            line = answer.axis_line(beam.name, step)[1]
            axes.plot(*line.T, color="#0072B2", lw=1.5, alpha=(k + 1) / len(drawn))
    for pin in scene.pins:
        axes.plot(*np.array(pin.points).T, color="#D55E00", lw=0.8, ls=":")
        axes.plot(*pin.position(answer.load_parameter[-1]), "o", color="#D55E00", ms=4)
    axes.set_aspect("equal")
    axes.set_axis_off()
    figure.savefig(path, transparent=True, metadata={"Date": None})


def write(folder: Path) -> None:
    """Write the pictures that are not there, and the gallery, a figure for every scene."""
    pictures = folder / "scenes"
    pictures.mkdir(parents=True, exist_ok=True)
    parts = []
    for name, text in built_in_scenes().items():
        path = pictures / f"{name}.svg"
        if not path.is_file():
            draw(name, path)
        title = text.partition("\n")[0].removeprefix("# ")
        parts.append(f"```{{figure}} /_generated/scenes/{path.name}\n:alt: {title}\n\n`{name}`\n```")
    page = "\n".join(["````{container} gallery", *parts, "````"])
    (folder / "gallery.md").write_text(f"{page}\n", encoding="utf-8")

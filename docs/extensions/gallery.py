"""The built-in scenes as small pictures of their beams on the way to the end, for the first page."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from comparisons.models import solve
from comparisons.scene import built_in_scenes, load_scene
from comparisons.scene.read import FOLDER


def stale(made: Path, sources: Iterable[Path]) -> bool:
    """Whether a file is not there or older than one of its sources."""
    return not made.is_file() or made.stat().st_mtime < max(path.stat().st_mtime for path in sources)


def draw(name: str, path: Path) -> None:
    """Draw a scene's exact elements at four of at most ten load parameters, and its pins with their paths."""
    scene = load_scene(name)
    answer = solve(replace(scene, load_parameters=min(scene.load_parameters, 10)), "tsm")
    last = len(answer.load_parameter) - 1
    axes = Figure(figsize=(2.4, 1.8), layout="constrained").subplots(subplot_kw={"aspect": "equal"})
    axes.set_axis_off()
    for beam in scene.beams:
        axes.plot(*np.array([beam.start, beam.end]).T, color="#888888", lw=0.8, ls=":")
        for step in {last // 4, last // 2, 3 * last // 4, last}:
            line = answer.axis_line(beam.name, step)[1]
            axes.plot(*line.T, color="#0072B2", lw=1.5, alpha=0.25 + 0.75 * step / last)
    for pin in scene.pins:
        axes.plot(*np.array(pin.points).T, color="#D55E00", lw=0.8, ls=":")
        axes.plot(*pin.position(answer.load_parameter[-1]), "o", color="#D55E00", ms=4)
    axes.figure.savefig(path, transparent=True)


def gallery(folder: Path) -> str:
    """Draw into `folder` what is older than its scene or this file, and return a figure for every scene."""
    folder.mkdir(exist_ok=True)
    parts = ["````{container} gallery"]
    for name, text in built_in_scenes().items():
        if stale(path := folder / f"{name}.svg", (FOLDER / f"{name}.toml", Path(__file__))):
            draw(name, path)
        title = text.partition("\n")[0].removeprefix("# ")
        parts.append(f"```{{figure}} /_generated/scenes/{path.name}\n:alt: {title}\n\n`{name}`\n```")
    return "\n".join([*parts, "````"])

"""The pictures of a motion: one for every load parameter, in one view and one scale."""

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from comparisons.files import OutputError, replacing
from comparisons.models.progress import Count, uncounted
from comparisons.show.export import Series
from comparisons.show.panel import Panel, Scale, panel
from comparisons.show.render import render_frames

FRAMES = 40
"""Pictures of a film at most."""
PACE, REST = 80, 1500
"""Milliseconds that a GIF shows a picture, and the last one."""
WIDTH = 700
"""Pixels of a panel of a GIF."""


class Film(NamedTuple):
    """Panels side by side at a row of load parameters, and the scale that they share."""

    frames: list[list[Panel]]
    scale: Scale


def film(series: Sequence[Series], factor: float = 1.0) -> Film:
    """Return the film of the load parameters that all `series` reach, with a panel for each series.

    It is evenly thinned to `FRAMES`, with the first and the last. The titles state the enlargement `factor`
    of the displacements. Without a common load parameter it raises `OutputError`.
    """
    shared = sorted(set.intersection(*({*one.load_parameter.tolist()} for one in series)))
    if not shared:
        names = ", ".join(one.title for one in series)
        raise OutputError(f"{names}: no load parameter was reached, nothing to draw")
    kept = np.unique(np.linspace(0, len(shared) - 1, min(FRAMES, len(shared))).round().astype(int))
    frames = [[_panel(one, shared[k], factor) for one in series] for k in kept]
    units = series[0].units
    stress = units.get("axial_stress", units.get("axial_stress_left"))
    label = f"axial stress [{stress}]" if stress else "axial stress"
    every = [item for panels in frames for item in panels]
    return Film(frames, Scale.of(every, label, units.get("contact_force", "")))


def _panel(series: Series, t: float, factor: float) -> Panel:
    k = int(np.flatnonzero(series.load_parameter == t)[0])
    return panel(series.blocks(k), f"{series.title}, t = {t:.3f}", factor)


def write(shown: Film, folder: Path, count: Count = uncounted) -> tuple[list[Path], str | None]:
    """Write ``view.png``, the last state, and ``view.gif``, the motion; `count` receives the pictures that are drawn.

    Return both files, and one sentence if matplotlib had to stand in for pyvista.
    """
    from PIL import Image

    last, motion = files = [folder / "view.png", folder / "view.gif"]
    with tempfile.TemporaryDirectory() as scratch:
        pictures, sentence = render_frames(*shown, Path(scratch), count)
        images = [Image.open(picture).convert("RGB") for picture in pictures]
    with replacing(last) as temporary:
        images[-1].save(temporary)
    wide = WIDTH * len(shown.frames[0])
    first, *rest = (image.resize((wide, image.height * wide // image.width)) for image in images)
    pace = [PACE] * len(rest) + [REST]
    with replacing(motion) as temporary:
        first.save(temporary, save_all=True, append_images=rest, duration=pace, loop=0, optimize=True)
    return files, sentence

"""``crossval view``: the motion of a scene, in a window or as a picture and a GIF."""

import os
import sys
from argparse import Namespace
from pathlib import Path

from comparisons.answer import Response
from comparisons.cli.command import DONE, report
from comparisons.cli.screen import ended, exit_status, staging, watching
from comparisons.files import writable_folder
from comparisons.models import SOLID, TSM, solve
from comparisons.models.model import ModelError, Options
from comparisons.report.export import Series, read_series, solved_series
from comparisons.report.render import film, show, write_film
from comparisons.scene import Scene, load_scene

BEAMS = Options(elements=20)


def run(given: Namespace) -> int:
    """Solve or read, then show or write."""
    folder, status = Path(given.what), DONE
    if folder.is_dir():
        out, series = _target(given.out, folder.resolve().name), read_series(folder)
    else:
        scene = load_scene(given.what)
        out, found = _target(given.out, scene.name), _solve(scene)
        series = [solved_series(one, scene, title) for title, one in found if len(one.load_parameter)]
        status = exit_status(scene, [(f"{title}: ", response) for title, response in found])
    if series:
        _present(series, given.scale, out)
    return status


def _target(out: Path | None, name: str) -> Path | None:
    """Return the folder to write to, tried out; None where a window is to be opened."""
    windows = "DISPLAY" in os.environ or "WAYLAND_DISPLAY" in os.environ
    if out is None and (windows or not sys.platform.startswith("linux")):
        return None
    return writable_folder(out or Path("out") / f"{name}-view", "view.png", "view.gif")


def _solve(scene: Scene) -> "list[tuple[str, Response]]":
    """Return the responses of the models that can state the scene."""
    found = []
    for model, options in ((TSM, BEAMS), (SOLID, Options())):
        report(f"solving: {model.label}")
        try:
            with watching(model.label) as watch:
                found.append((model.label, solve(scene, model.name, options, watch)))
        except ModelError as error:
            if model is TSM:
                raise
            report(f"{model.label}: left out, {error}")
    return found


def _present(series: "list[Series]", factor: float, out: Path | None) -> None:
    shown = film(series, factor)
    if out is None:
        report("opening a window")
        show(shown)
        return
    with staging(f"drawing {len(shown.frames)} pictures") as count:
        files = write_film(shown, out, count)
    ended(files)

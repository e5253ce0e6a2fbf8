"""``crossval compare``: one scene by every model, one model against bounds, or several scenes by every program."""

import argparse
from functools import partial
from pathlib import Path

from comparisons.cli.command import DONE, WRONG, told
from comparisons.cli.options import chosen, outputs, refuse, workers
from comparisons.cli.screen import exit_status, shown, staging, teller, watching
from comparisons.files import writable_folder, write_text
from comparisons.models import TSM, find
from comparisons.models.model import ModelError
from comparisons.scene import Scene, built_in_scenes, load_scene
from comparisons.suite.progress import running
from comparisons.suites.compare import Run, compare, run_of
from comparisons.suites.gate import gate
from comparisons.suites.league import FILES, league

MODEL = ("model", "element", "elements", "mesh")
"""The options that say which model is meant."""
FOREIGN = {
    "a single scene": ("against", "quick", "workers"),
    "--max-error": ("others", "quick", "workers"),
    "several scenes": (*MODEL, "against"),
}
"""The options that each of the three ways of comparing does not have."""


def run(given: argparse.Namespace) -> int:
    """Compare in one of the three ways."""
    names = list(built_in_scenes()) if given.scenes == ["all"] else given.scenes
    how = "--max-error" if given.max_error else "a single scene" if len(names) == 1 else "several scenes"
    refuse(given, FOREIGN[how], f"is no option of {how}")
    if len(dict(given.max_error)) < len(given.max_error):
        raise ModelError("--max-error: bounds a quantity twice")
    scenes = [load_scene(name) for name in names]
    if not given.max_error:
        return _compare(scenes[0], given) if len(scenes) == 1 else _league(scenes, given)
    if len(scenes) > 1:
        raise ModelError("--max-error: takes a single scene")
    return _held(scenes[0], given)


def _compare(scene: Scene, given: argparse.Namespace) -> int:
    """Compare all models, print the table and name the files."""
    tell = teller(quiet=given.quiet)
    more = [run_of(model, options) for model in map(find, given.others) for options in model.compared()]
    if any(getattr(given, option) is not None for option in MODEL):
        model, options = find(given.model or TSM.name), chosen(given)
        label = f"{model.label} {model.setting(scene, options)}".rstrip()
        more.append(Run(label=label, model=model.name, options=options))
    watch, stage = partial(watching, quiet=given.quiet), partial(staging, quiet=given.quiet)
    folder = given.out or Path("out") / scene.name
    return shown(compare(scene, folder, tell, watch, stage, more), folder)


def _held(scene: Scene, given: argparse.Namespace) -> int:
    """Measure one model, print its bounds and write them."""
    files = outputs([str(given.out)] if given.out else [], ".xml")
    found = gate(scene, given.model or TSM.name, chosen(given), dict(given.max_error), given.against)
    for _, file in files:
        write_text(file, found.junit())
    print(f"{scene.name}: {found.response.named} against {found.reference.model}")
    for item in found.bounds:
        sign = "<=" if item.holds else "> "
        bound = f"  {item.name:8s} {item.error:9.3g}  {sign} {item.allowed:<6g} {found.place(item.name)}"
        print(bound.rstrip())
    status = exit_status(scene, [("", found.response), ("reference: ", found.reference)])
    if status != DONE or found.held:
        return status
    beyond = ", ".join(item.name for item in found.bounds if not item.holds)
    return told(f"{beyond}: beyond the bound", WRONG)


def _league(scenes: list[Scene], given: argparse.Namespace) -> int:
    """Measure every program on every scene."""
    folder = writable_folder(given.out or Path("out/league"), *FILES)
    with running(folder / "results", workers(given, 1), quiet=given.quiet, process=True) as run_cases:
        found = league(scenes, given.others, run_cases, quick=given.quick)
    return shown(found, folder)

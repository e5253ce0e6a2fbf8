"""``crossval solve``: one scene, one model."""

from argparse import Namespace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy import isnan

from comparisons.answer import Response
from comparisons.answer.material import frictions_found
from comparisons.answer.page import text
from comparisons.cli.command import DONE, STOPPED, report
from comparisons.cli.options import STANDARD, chosen, outputs, refuse, write
from comparisons.cli.screen import exit_status, watching
from comparisons.files import writable_folder
from comparisons.models import TSM, certified, find, solve
from comparisons.scene import Scene, load_scene

if TYPE_CHECKING:
    from comparisons.suite.accuracy import Answer

PICTURES = (".png", ".svg", ".pdf")


def run(given: Namespace) -> int:
    """Solve, write what was asked for, and print the page."""
    scene = load_scene(given.scene)
    files = outputs(given.out, ".json", ".csv", ".html", *PICTURES, "")
    for folder in (path for kind, path in files if not kind):
        from comparisons.report.export import check_series

        check_series(writable_folder(folder), find(given.model or TSM.name).name, scene)
    answer = _answer(scene, given)
    more: dict[str, Any] = {}
    rule, lines = "", []
    if answer is None:
        model, options = find(given.model or TSM.name), chosen(given)
        rule = model.rule(scene, options)
        with watching(model.name, quiet=given.quiet) as watch:
            response = solve(scene, model.name, options, watch)
    else:
        scene, response = answer.scene, answer.response
        more, lines = {"accuracy": answer.as_dict()}, list(answer.lines())
    response = certified(response, scene, given.certify)
    for kind, path in files:
        _write(kind, path, response, scene, more)
    if (".json", STANDARD) not in files:
        print(text(response, [*_found(response, scene), *lines], rule))
    status = exit_status(scene, [("", response)])
    if answer is None or answer.reached or status != DONE:
        return status
    report(f"crossval: ACCURACY_NOT_REACHED: estimated error {answer.estimate:.2g}, asked {answer.asked:g}")
    return STOPPED


def _write(kind: str, path: Path, response: Response, scene: Scene, more: dict[str, Any]) -> None:
    """Write a file, or the files of a folder."""
    if kind == ".json":
        from comparisons.answer.file import as_json

        write(path, as_json(response, **more))
    elif kind == ".csv":
        from comparisons.answer.table import csv_history

        write(path, csv_history(response, scene.units))
    elif kind == ".html":
        from comparisons.report.answer import write_sheet

        write_sheet(path, response, scene)
    elif not kind:
        from comparisons.report.export import write_series

        write_series(path, response, scene)
    elif len(response.load_parameter):
        from comparisons.report.answer import picture
        from comparisons.report.plot import save

        save(picture(response), path)


def _found(response: Response, scene: Scene) -> list[tuple[str, str]]:
    """Return the coefficient of friction that a clamp's reactions show, at the last load parameter in contact, and the scene's."""
    given = {contact.beam: contact.friction for contact in scene.contacts}
    return [
        ("friction", f"{abs(value):.6g} by the reactions of {beam}, {given[beam]:g} in the scene")
        for beam, found in frictions_found(response, scene).items()
        for value in found[~isnan(found)][-1:]
    ]


def _answer(scene: Scene, given: Namespace) -> "Answer | None":
    """Return the answer to an accuracy, explained unless it is quiet; None where a model was chosen by hand."""
    if given.accuracy is None:
        return None
    chosen_by_it = ("elements", "integration_tolerance", "mesh", "branch")
    refuse(given, chosen_by_it, "is what --accuracy chooses, give one of the two")
    from comparisons.suite.accuracy import solve_to

    quantity, error = given.accuracy
    answer = solve_to(scene, error, quantity, model=given.model, element=given.element)
    for line in () if given.quiet else answer.decisions:
        report(line)
    return answer

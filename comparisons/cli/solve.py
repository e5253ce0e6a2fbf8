"""``crossval scenes`` and ``crossval solve``: one scene, one model."""

import sys
from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.cli import values
from comparisons.cli.options import ModelNames, add_options, argument, chosen
from comparisons.cli.outcome import DONE, EPILOG, STOPPED, exit_status, report
from comparisons.cli.progress import watching
from comparisons.files import writable_file, writable_folder, write_text
from comparisons.models import TSM, find
from comparisons.models.options import ModelError
from comparisons.quantities import QUANTITIES
from comparisons.scene import built_in_scenes, load_scene

if TYPE_CHECKING:
    import argparse

    from comparisons.accuracy import Answer
    from comparisons.cli.outcome import Commands
    from comparisons.response import Response
    from comparisons.scene import Scene


def add_to(commands: "Commands") -> None:
    """Add the commands to the parser."""
    scenes = commands.add_parser("scenes", help="list the built-in scenes")
    scenes.set_defaults(run=list_scenes)

    solve = commands.add_parser("solve", help="solve a scene with one model", epilog=EPILOG)
    solve.add_argument("scene", metavar="SCENE", help="a built-in scene or a TOML file")
    solve.add_argument("--model", choices=ModelNames(), help="left to the scene with --accuracy, else needed")
    solve.add_argument(
        "--accuracy",
        type=values.part,
        metavar="X",
        help="choose model and resolution for this relative error, in place of elements and meshes",
    )
    solve.add_argument(
        "--quantity", choices=QUANTITIES, help="the quantity whose error is meant: " + ", ".join(QUANTITIES)
    )
    solve.add_argument("--explain", action="store_true", help="with --accuracy: say what was decided and why")
    add_options(solve, "elements", "element", "integration_tolerance", "mesh", "branch")
    solve.add_argument(
        "--certify",
        choices=("last", "all", "none"),
        default="last",
        help="load parameters to hold against the exact equilibrium: the last of every stage and those beside events (the default), all, none",
    )
    solve.add_argument("--json", metavar="FILE", help="write the response as JSON; - is standard output")
    solve.add_argument("--vtk", type=Path, metavar="DIR", help="write VTU files and a PVD file")
    solve.add_argument("--quiet", action="store_true", help="no progress bar")
    solve.set_defaults(run=run)


def list_scenes(_: "argparse.Namespace") -> int:
    """Print the names of the built-in scenes."""
    for name in built_in_scenes():
        print(name)
    return DONE


def run(given: "argparse.Namespace") -> int:
    """Solve, write what was asked for, and print a summary."""
    scene = load_scene(given.scene)
    file = None if given.json in (None, "-") else writable_file(Path(given.json))
    if given.vtk is not None:
        from comparisons.show.export import check_series

        check_series(
            writable_folder(given.vtk), TSM.name if given.model is None else find(given.model).name, scene
        )
    from comparisons.models import certified, solve
    from comparisons.response.to_json import as_json, summary

    answer = _answer(scene, given)
    if answer is None:
        with watching(given.model, quiet=given.quiet) as watch:
            response = solve(scene, given.model, chosen(given), watch)
        more = {}
    else:
        scene = answer.found.scene
        response, more = answer.response, {"accuracy": answer.as_dict()}
    response = certified(response, scene, given.certify)
    if given.json == "-":
        sys.stdout.write(as_json(response, **more))
    elif file is not None:
        write_text(file, as_json(response, **more))
    if given.vtk is not None:
        from comparisons.show.export import write_series

        write_series(given.vtk, response, scene)
    if given.json != "-":
        print(summary(response, scene.units, [*_found(response, scene), *(answer.lines() if answer else ())]))
    status = exit_status(scene, [("", response)])
    if answer is None or answer.reached or status != DONE:
        return status
    report(
        f"crossval: ACCURACY_NOT_REACHED: estimated error {answer.found.estimate:.2g}, asked {answer.accuracy:g}"
    )
    return STOPPED


def _found(response: "Response", scene: "Scene") -> list[tuple[str, str]]:
    """Return the coefficient of friction that a clamp's reactions show, at the last load parameter in contact, and the scene's."""
    from comparisons.response.material import frictions_found

    given = {contact.beam: contact.friction for contact in scene.contacts}
    rows = []
    for beam, found in frictions_found(response, scene).items():
        known = [value for value in found.tolist() if not isnan(value)]
        if known:
            rows.append(
                (f"{beam} friction found", f"{abs(known[-1]):.9g} at the clamp, {given[beam]:g} given")
            )
    return rows


def _answer(scene: "Scene", given: "argparse.Namespace") -> "Answer | None":
    """Return the answer to an accuracy, explained if asked for; None where a model was chosen by hand."""
    if given.accuracy is None:
        for option in ("quantity", "explain"):
            if getattr(given, option):
                raise ModelError(f"--{option}: belongs to --accuracy")
        if given.model is None:
            raise ModelError("--model: must be given without --accuracy")
        return None
    for option in ("elements", "integration_tolerance", "mesh", "branch"):
        if getattr(given, option) is not None:
            raise ModelError(f"{argument(option)}: is what --accuracy chooses, give one of the two")
    from comparisons.accuracy import solve_to

    answer = solve_to(
        scene, given.accuracy, given.quantity or "force", model=given.model, element=given.element
    )
    if given.explain:
        for line in answer.decisions:
            report(line)
    return answer

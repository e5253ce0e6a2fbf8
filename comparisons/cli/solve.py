"""``crossval solve``: one scene, one model."""

import sys
from math import isnan
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from comparisons.cli import values
from comparisons.cli.options import ModelNames, add_options, argument, chosen
from comparisons.cli.outcome import DONE, EPILOG, STOPPED, exit_status, report
from comparisons.cli.progress import watching
from comparisons.files import OutputError, result_file, writable_folder, write_text
from comparisons.models import TSM, find
from comparisons.models.options import ModelError
from comparisons.scene import load_scene

if TYPE_CHECKING:
    import argparse

    from comparisons.accuracy import Answer
    from comparisons.cli.outcome import Commands
    from comparisons.response import Response
    from comparisons.scene import Scene

PICTURES = (".png", ".svg", ".pdf")
"""Formats of `--plot` by the end of the file's name."""


def add_to(commands: "Commands") -> None:
    """Add the command to the parser."""
    solve = commands.add_parser("solve", help="solve a scene with one model", epilog=EPILOG)
    solve.add_argument("scene", metavar="SCENE", help="a built-in scene or a TOML file")
    solve.add_argument(
        "--model", choices=ModelNames(), help=f"left to the scene with --accuracy, else {TSM.name}"
    )
    solve.add_argument(
        "--accuracy",
        type=values.part,
        metavar="X",
        help="choose model and resolution for this relative error, in place of elements and meshes",
    )
    solve.add_argument(
        "--quantity",
        choices=values.Quantities(path=False),
        metavar="QUANTITY",
        help="the quantity whose error is meant: %(choices)s",
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
    solve.add_argument(
        "--csv",
        type=Path,
        metavar="FILE",
        help="write all histories as CSV: a row a load parameter, columns with units",
    )
    solve.add_argument(
        "--plot",
        type=Path,
        metavar="FILE",
        help="draw shape, section forces and forces: " + ", ".join(PICTURES),
    )
    solve.add_argument("--vtk", type=Path, metavar="DIR", help="write VTU files and a PVD file")
    solve.add_argument("--times", action="store_true", help="print the time of each stage")
    solve.add_argument("--quiet", action="store_true", help="no progress bar")
    solve.set_defaults(run=run)


def run(given: "argparse.Namespace") -> int:
    """Solve, write what was asked for, and print the page."""
    stages = _Stages()
    scene = load_scene(given.scene)
    _check_files(given, scene)
    stages.end("read")
    from comparisons.models import certified

    answer = _answer(scene, given)
    if answer is None:
        response, rule = _solved(scene, given)
        more, lines = {}, []
    else:
        scene, response, rule = answer.scene, answer.response, ""
        more, lines = {"accuracy": answer.as_dict()}, list(answer.lines())
    stages.end("set up", less=response.wall_seconds)
    response = certified(response, scene, given.certify)
    stages.end("certify")
    _write(given, response, scene, more)
    if given.json != "-":
        from comparisons.response.page import text

        print(text(response, [*_found(response, scene), *lines], rule))
    stages.end("write")
    if given.times:
        print(f"\n{stages.line(response)}", file=sys.stderr if given.json == "-" else sys.stdout)
    status = exit_status(scene, [("", response)])
    if answer is None or answer.reached or status != DONE:
        return status
    report(f"crossval: ACCURACY_NOT_REACHED: estimated error {answer.estimate:.2g}, asked {answer.asked:g}")
    return STOPPED


class _Stages:
    """Wall times of the stages of one command [s]."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self.began = perf_counter()

    def end(self, stage: str, *, less: float = 0.0) -> None:
        """End a stage; `less` seconds of it are those of another one."""
        now = perf_counter()
        self.seconds[stage] = max(now - self.began - less, 0.0)
        self.began = now

    def line(self, response: "Response") -> str:
        """Return the times in one line, with that of the solution, what it took, and the version, whose look-up costs time itself."""
        from comparisons.version import release

        spent = {**self.seconds, "solve": response.wall_seconds}
        times = ", ".join(
            f"{stage} {spent[stage]:.3f}" for stage in ("read", "set up", "solve", "certify", "write")
        )
        steps = f"{response.iterations} Newton iterations, {response.cutbacks} cut-backs"
        return f"seconds: {times}; {steps}; tsm-crossval {release()}"


def _check_files(given: "argparse.Namespace", scene: "Scene") -> None:
    """Raise `OutputError` for a file that cannot be written, before anything is computed."""
    if given.json not in (None, "-"):
        given.json = result_file(Path(given.json))
    if given.csv is not None:
        given.csv = result_file(given.csv)
    if given.plot is not None:
        given.plot = result_file(given.plot)
        if given.plot.suffix not in PICTURES:
            raise OutputError(f"{given.plot}: must end in {', '.join(PICTURES)}")
    if given.vtk is not None:
        from comparisons.show.export import check_series

        check_series(
            writable_folder(given.vtk), TSM.name if given.model is None else find(given.model).name, scene
        )


def _solved(scene: "Scene", given: "argparse.Namespace") -> "tuple[Response, str]":
    """Return the answer of the model, and the rule by which its element was chosen."""
    from comparisons.models import solve

    name = given.model or TSM.name
    model = find(name)
    options = chosen(given)
    with watching(model.name, quiet=given.quiet) as watch:
        return solve(scene, name, options, watch), model.rule(scene, options)


def _write(given: "argparse.Namespace", response: "Response", scene: "Scene", more: dict[str, Any]) -> None:
    """Write the files that were asked for."""
    if given.json is not None:
        from comparisons.response.file import as_json

        if given.json == "-":
            sys.stdout.write(as_json(response, **more))
        else:
            write_text(given.json, as_json(response, **more))
    if given.csv is not None:
        from comparisons.response.table import csv_history

        write_text(given.csv, csv_history(response, scene.units))
    if given.plot is not None and len(response.load_parameter):
        from comparisons.show.answer import plot_answer

        plot_answer(response, given.plot)
    if given.vtk is not None:
        from comparisons.show.export import write_series

        write_series(given.vtk, response, scene)


def _found(response: "Response", scene: "Scene") -> list[tuple[str, str]]:
    """Return the coefficient of friction that a clamp's reactions show, at the last load parameter in contact, and the scene's."""
    from comparisons.response.material import frictions_found

    given = {contact.beam: contact.friction for contact in scene.contacts}
    rows = []
    for beam, found in frictions_found(response, scene).items():
        known = [value for value in found.tolist() if not isnan(value)]
        if known:
            rows.append(
                ("friction", f"{abs(known[-1]):.6g} by the reactions of {beam}, {given[beam]:g} in the scene")
            )
    return rows


def _answer(scene: "Scene", given: "argparse.Namespace") -> "Answer | None":
    """Return the answer to an accuracy, explained if asked for; None where a model was chosen by hand."""
    if given.accuracy is None:
        for option in ("quantity", "explain"):
            if getattr(given, option):
                raise ModelError(f"--{option}: belongs to --accuracy")
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

"""The command ``crossval``."""

import argparse
import os
import sys
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.files import OutputError, writable_file, writable_folder, write_text
from comparisons.options import OPTIONS, ModelError, Options
from comparisons.peers.ccx import CalculixError
from comparisons.scene import Scene, SceneError, built_in_scenes, load_scene
from comparisons.scene.rules import RuleError, whole_number
from comparisons.studies.figures import FIGURES
from comparisons.studies.questions import QUESTIONS

if TYPE_CHECKING:
    from comparisons.response import Response

DONE, BAD_INPUT, STOPPED, INTERRUPTED = 0, 2, 3, 130
EPILOG = """exit status: 0 completed and checked, 2 bad input, 3 the solution stopped (the reason is named)"""


def main(arguments: list[str] | None = None) -> int:
    """Run the command and return its exit status: 0 done, 2 bad input, 3 a solution that stopped."""
    given = _parser().parse_args(arguments)
    try:
        status: int = given.run(given)
    except (SceneError, ModelError, OutputError) as error:
        print(f"crossval: {error}", file=sys.stderr)
        return BAD_INPUT
    except CalculixError as error:
        print(f"crossval: {error}", file=sys.stderr)
        return BAD_INPUT if error.printed is None else STOPPED
    except BrokenPipeError:
        # whoever read the output has had enough; spare the interpreter its last flush
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except OSError as error:
        print(f"crossval: {error.filename or 'output'}: {error.strerror}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("crossval: interrupted", file=sys.stderr)
        return INTERRUPTED
    return status


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="crossval", description=_description(), epilog=EPILOG)
    parser.add_argument("--version", action="version", version=f"crossval {metadata.version('tsm-crossval')}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    scenes = commands.add_parser("scenes", help="list the built-in scenes")
    scenes.set_defaults(run=_scenes)

    solve = commands.add_parser("solve", help="solve a scene with one model", epilog=EPILOG)
    solve.add_argument("scene", metavar="SCENE", help="a built-in scene or a TOML file")
    solve.add_argument("--model", required=True, choices=OPTIONS)
    solve.add_argument("--elements", type=_count, metavar="N", help="tsm: elements of every beam")
    solve.add_argument("--element", metavar="NAME", help="tsm: type of the elements")
    solve.add_argument(
        "--tolerance",
        type=_part,
        metavar="X",
        help="tsm: error allowed to the integration inside exact elements (1e-9)",
    )
    solve.add_argument("--mesh", type=_mesh, metavar="NXxNY", help="solid: elements along and across")
    solve.add_argument("--json", metavar="FILE", help="write the response as JSON; - is standard output")
    solve.add_argument("--vtk", type=Path, metavar="DIR", help="write VTU files and a PVD file")
    solve.set_defaults(run=_solve)

    compare = commands.add_parser("compare", help="solve a scene with every model and compare", epilog=EPILOG)
    compare.add_argument("scene", metavar="SCENE", help="a built-in scene or a TOML file")
    compare.add_argument("--out", type=Path, metavar="DIR", help="folder of the results (out/SCENE)")
    compare.set_defaults(run=_compare)

    shown = "; ".join(f"{name}: {what}" for name, what in FIGURES.items())
    reproduce = commands.add_parser(
        "reproduce",
        help="reproduce the paper's figures and judge its claims",
        description=shown,
        epilog=EPILOG,
    )
    reproduce.add_argument(
        "figure", metavar="FIGURE", choices=(*FIGURES, "all"), help=f"{', '.join(FIGURES)} or all"
    )
    reproduce.add_argument(
        "--out",
        type=Path,
        default=Path("out/reproduce"),
        metavar="DIR",
        help="folder of the results (out/reproduce)",
    )
    reproduce.add_argument(
        "--quick", action="store_true", help="coarse settings, about half a minute for all"
    )
    reproduce.set_defaults(run=_reproduce)

    asked = "; ".join(f"{name}: {what}" for name, what in QUESTIONS.items())
    study = commands.add_parser(
        "study", help="measure how far the solid can be trusted", description=asked, epilog=EPILOG
    )
    study.add_argument("question", metavar="QUESTION", choices=tuple(QUESTIONS), help=", ".join(QUESTIONS))
    study.add_argument(
        "--out", type=Path, default=Path("out/study"), metavar="DIR", help="folder of the table (out/study)"
    )
    study.set_defaults(run=_study)
    return parser


def _description() -> str:
    return "Contact of beams: tangent stiffness method, 2D solid elements and exact answers on one scene."


def _count(text: str) -> int:
    try:
        return whole_number(int(text))
    except RuleError as error:
        raise argparse.ArgumentTypeError(f"{text}: {error}") from None


def _part(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 < value < 1:
        raise argparse.ArgumentTypeError(f"{text}: must lie between 0 and 1")
    return value


def _mesh(text: str) -> tuple[int, int]:
    along, separator, across = text.partition("x")
    if not separator:
        raise argparse.ArgumentTypeError(f"{text}: must be NXxNY, as 50x2")
    return _count(along), _count(across)


def _scenes(_: argparse.Namespace) -> int:
    for name in built_in_scenes():
        print(name)
    return DONE


def _solve(given: argparse.Namespace) -> int:
    scene = load_scene(given.scene)
    file = None if given.json in (None, "-") else writable_file(Path(given.json))
    if given.vtk is not None:
        writable_folder(given.vtk)
    from comparisons.models import solve
    from comparisons.statement import as_json, summary

    options = Options(
        elements=given.elements, element=given.element, tolerance=given.tolerance, mesh=given.mesh
    )
    response = solve(scene, given.model, options)
    if given.json == "-":
        sys.stdout.write(as_json(response))
    elif file is not None:
        write_text(file, as_json(response))
    if given.vtk is not None:
        from comparisons.export import write_series

        write_series(given.vtk, response, scene)
    if given.json != "-":
        print(summary(response, scene.units))
    return _status(scene, [("", response)])


def _compare(given: argparse.Namespace) -> int:
    scene = load_scene(given.scene)
    from comparisons.compare import ROD, compare
    from comparisons.table import table_text

    found = compare(scene, given.out or Path("out") / scene.name, _report)
    print(table_text(found.rows, ROD.label))
    print("\nfiles:", *(f"  {path}" for path in found.files), sep="\n")
    return _status(scene, [(f"{row.label}: ", row.response) for row in found.rows])


def _reproduce(given: argparse.Namespace) -> int:
    writable_folder(given.out)
    from comparisons.studies.reproduce import reproduce

    done = reproduce(given.figure, given.out, quick=given.quick, report=_report)
    print("files:", *(f"  {path}" for path in done.files), sep="\n")
    for reason in done.stopped:
        print(f"crossval: {reason}", file=sys.stderr)
    return STOPPED if done.stopped else DONE


def _study(given: argparse.Namespace) -> int:
    writable_folder(given.out)
    from comparisons.studies.output import write_rows
    from comparisons.studies.solid_accuracy import STUDIES, tabulated

    rows = STUDIES[given.question](_report)
    print(tabulated(rows))
    print("file:", write_rows(given.out / f"{given.question}.csv", rows))
    return DONE


def _report(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


def _status(scene: Scene, responses: "list[tuple[str, Response]]") -> int:
    """Name every solution that stopped and what was reached."""
    stopped = [(label, response) for label, response in responses if not response.completed]
    for label, response in stopped:
        reached = f"{len(response.load_parameter)} of {scene.load_parameters} load parameters reached"
        print(f"crossval: {label}{response.status}: {response.message}; {reached}", file=sys.stderr)
    return STOPPED if stopped else DONE

"""``crossval scenes`` and ``crossval solve``: one scene, one model."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.cli import values
from comparisons.cli.outcome import DONE, EPILOG, exit_status
from comparisons.files import writable_file, writable_folder, write_text
from comparisons.options import OPTIONS, Options
from comparisons.scene import built_in_scenes, load_scene

if TYPE_CHECKING:
    import argparse

    from comparisons.cli.outcome import Commands


def add_to(commands: "Commands") -> None:
    """Add the commands to the parser."""
    scenes = commands.add_parser("scenes", help="list the built-in scenes")
    scenes.set_defaults(run=list_scenes)

    solve = commands.add_parser("solve", help="solve a scene with one model", epilog=EPILOG)
    solve.add_argument("scene", metavar="SCENE", help="a built-in scene or a TOML file")
    solve.add_argument("--model", required=True, choices=OPTIONS)
    solve.add_argument("--elements", type=values.count, metavar="N", help="tsm: elements of every beam")
    solve.add_argument("--element", metavar="NAME", help="tsm: type of the elements")
    solve.add_argument(
        "--tolerance",
        type=values.part,
        metavar="X",
        help="tsm: error allowed to the integration inside exact elements (1e-9)",
    )
    solve.add_argument("--mesh", type=values.mesh, metavar="NXxNY", help="solid: elements along and across")
    solve.add_argument("--json", metavar="FILE", help="write the response as JSON; - is standard output")
    solve.add_argument("--vtk", type=Path, metavar="DIR", help="write VTU files and a PVD file")
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
    return exit_status(scene, [("", response)])

"""``crossval scenes``, ``new`` and ``check``: scene files before anything is solved."""

import json
import sys
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.cli.options import add_others
from comparisons.cli.outcome import DONE
from comparisons.files import OutputError, result_file, writable_file, write_text
from comparisons.scene import built_in_scenes, load_scene
from comparisons.scene.ends import near_ends
from comparisons.scene.rules import RuleError, name
from comparisons.scene.tables import InputError

if TYPE_CHECKING:
    import argparse

    from comparisons.cli.outcome import Commands


def add_to(commands: "Commands") -> None:
    """Add the commands to the parser."""
    scenes = commands.add_parser("scenes", help="list the built-in scenes")
    scenes.add_argument(
        "--schema", action="store_true", help="print the JSON Schema of scene files, for editors"
    )
    scenes.set_defaults(run=run_scenes)

    new = commands.add_parser("new", help="write a commented scene file to start from")
    new.add_argument("name", metavar="NAME", help="of the scene; the file is NAME.toml")
    new.add_argument(
        "--like", metavar="SCENE", choices=built_in_scenes(), help="a built-in scene to start from"
    )
    new.set_defaults(run=run_new)

    check = commands.add_parser(
        "check", help="validate a scene file, ask all models whether they can state it, draw it"
    )
    check.add_argument("scene", metavar="SCENE", help="a built-in scene or a TOML file")
    check.add_argument("--out", metavar="FILE", help="draw it, as PNG or SVG")
    add_others(check)
    check.add_argument(
        "--json", metavar="FILE", help="write the resolved scene, which programs read; - is standard output"
    )
    check.set_defaults(run=run_check)


def run_scenes(given: "argparse.Namespace") -> int:
    """Print the names of the built-in scenes, or the schema."""
    if not given.schema:
        print(*built_in_scenes(), sep="\n")
        return DONE
    from comparisons.scene.toml import json_schema

    sys.stdout.write(json.dumps(json_schema(), indent=1) + "\n")
    return DONE


def run_new(given: "argparse.Namespace") -> int:
    """Write the file, never over another."""
    try:
        name(given.name)
    except RuleError as error:
        raise InputError("NAME", f"{given.name}: {error}") from None
    path = writable_file(Path(f"{given.name}.toml"))
    if path.exists():
        raise OutputError(f"{path.name}: is there already")
    if given.like is None:
        template = resources.files("comparisons.scene").joinpath("template.toml").read_text("utf-8")
        text = template.replace('name = "NAME"', f'name = "{given.name}"')
    else:
        text = built_in_scenes()[given.like].replace(f'name = "{given.like}"', f'name = "{given.name}"', 1)
    with path.open("x", encoding="utf-8") as file:
        file.write(text)
    print(f"{path.name}: edit it, then: crossval check {path.name}")
    return DONE


def run_check(given: "argparse.Namespace") -> int:
    """Say which models can state the scene, and draw it."""
    scene = load_scene(given.scene)
    picture = None if given.out is None else result_file(Path(given.out))
    file = None if given.json in (None, "-") else result_file(Path(given.json))
    if picture is not None and picture.suffix not in (".png", ".svg"):
        raise OutputError(f"{given.out}: must end in .png or .svg")
    from comparisons.models.options import Options
    from comparisons.models.outside.request import request
    from comparisons.show.sketch import draw, stated

    if given.json is not None:
        resolved = request(scene, Options(), scene.times)
    if given.json == "-":
        sys.stdout.write(resolved)
    else:
        print(*stated(scene, given.others), *near_ends(scene), sep="\n")
    if file is not None:
        write_text(file, resolved)
        print(f"resolved scene: {given.json}")
    if picture is not None:
        draw(scene, picture)
        print(f"drawn: {given.out}", file=sys.stderr if given.json == "-" else sys.stdout)
    return DONE

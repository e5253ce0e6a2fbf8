"""``crossval new``, ``check`` and ``schema``: scene files before anything is solved."""

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
    new = commands.add_parser("new", help="write a commented scene file to start from")
    new.add_argument("name", metavar="NAME", help="of the scene; the file is NAME.toml")
    new.add_argument(
        "--like", metavar="SCENE", choices=built_in_scenes(), help="a built-in scene to start from"
    )
    new.set_defaults(run=run_new)

    check = commands.add_parser(
        "check", help="validate a scene file, ask all models whether they can state it, and draw it"
    )
    check.add_argument("scene", metavar="SCENE", help="a built-in scene or a TOML file")
    check.add_argument("--out", metavar="FILE", help="the picture, PNG or SVG (SCENE.png)")
    add_others(check)
    check.add_argument("--json", metavar="FILE", help="write the resolved scene, which programs read")
    check.set_defaults(run=run_check)

    schema = commands.add_parser("schema", help="print the JSON Schema of scene files, for editors")
    schema.set_defaults(run=run_schema)


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
    picture = result_file(Path(given.out or f"{scene.name}.png"))
    file = None if given.json is None else result_file(Path(given.json))
    if picture.suffix not in (".png", ".svg"):
        raise OutputError(f"{given.out}: must end in .png or .svg")
    from comparisons.models.options import Options
    from comparisons.models.outside.request import request
    from comparisons.show.sketch import draw, stated

    for line in stated(scene, given.others):
        print(line)
    for line in near_ends(scene):
        print(line)
    if file is not None:
        write_text(file, request(scene, Options(), scene.times))
        print(f"resolved scene: {given.json}")
    draw(scene, picture)
    print(f"drawn: {given.out or picture.name}")
    return DONE


def run_schema(_: "argparse.Namespace") -> int:
    """Print the schema."""
    from comparisons.scene.toml import json_schema

    sys.stdout.write(json.dumps(json_schema(), indent=1) + "\n")
    return DONE

"""``crossval scenes``, ``new`` and ``check``: scene files before anything is solved."""

import json
import re
import sys
from argparse import Namespace
from pathlib import Path

from comparisons.cli.options import STANDARD, outputs, write
from comparisons.cli.screen import DONE
from comparisons.files import OutputError
from comparisons.scene import InputError, built_in_scenes, load_scene
from comparisons.scene.ends import near_ends
from comparisons.scene.read import FOLDER, json_schema
from comparisons.scene.rules import RuleError, name

TEMPLATE = FOLDER.with_name("template.toml")


def run_scenes(given: Namespace) -> int:
    """Print the names of the built-in scenes and what they are, or the schema."""
    if given.schema:
        print(json.dumps(json_schema(), indent=1))
        return DONE
    for scene, text in built_in_scenes().items():
        said = re.split(r"(?<!al)[:.]\s", text)[0].replace("\n# ", " ").removeprefix("# ")
        print(f"{scene:26s} {said}")
    return DONE


def run_new(given: Namespace) -> int:
    """Write the file, never over another."""
    try:
        name(given.name)
    except RuleError as error:
        raise InputError("NAME", f"{given.name}: {error}") from None
    path, like, known = Path(f"{given.name}.toml"), given.like, built_in_scenes()
    if path.exists():
        raise OutputError(f"{path.name}: is there already")
    if like is not None and load_scene(like) and like not in known:
        raise InputError(like, "must be a built-in scene, crossval scenes lists them")
    old, text = (like, known[like]) if like else ("NAME", TEMPLATE.read_text(encoding="utf-8"))
    with path.open("x", encoding="utf-8") as file:
        file.write(text.replace(f'name = "{old}"', f'name = "{given.name}"', 1))
    print(f"{path.name}: edit it, then: crossval check {path.name}")
    return DONE


def run_check(given: Namespace) -> int:
    """Say which models can state the scene, and draw it."""
    scene = load_scene(given.scene)
    files = outputs(given.out, ".json", ".png", ".svg")
    from comparisons.models.options import Options
    from comparisons.models.outside.exchange import request
    from comparisons.report.sketch import draw, stated

    printed = (".json", STANDARD) in files
    if not printed:
        print(*stated(scene, given.others), *near_ends(scene), sep="\n")
    for file, (kind, path) in zip(given.out, files, strict=True):
        if kind == ".json":
            write(path, request(scene, Options(), scene.times))
        else:
            draw(scene, path)
        if path != STANDARD:
            print(f"written: {file}", file=sys.stderr if printed else sys.stdout)
    return DONE

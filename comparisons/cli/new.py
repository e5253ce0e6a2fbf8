"""``crossval new``: a scene file to start from."""

from argparse import Namespace
from pathlib import Path

from comparisons.cli.command import DONE
from comparisons.files import OutputError
from comparisons.scene import FieldError, InputError, built_in_scenes, load_scene, rules
from comparisons.scene.read import FOLDER

TEMPLATE = FOLDER.with_name("template.toml")


def run(given: Namespace) -> int:
    """Write the file, never over another."""
    try:
        rules.name(given.name)
    except FieldError as error:
        raise InputError("NAME", f"{given.name}: {error.rule}") from None
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

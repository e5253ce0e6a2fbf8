"""Scene files before anything is solved: ``crossval new``, ``check``, ``scenes --schema``, and files that cannot be read."""

import json
import os
import re
import tomllib
from collections.abc import Iterator
from importlib import resources
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from comparisons.cli import main
from comparisons.scene import InputError, built_in_scenes, load_scene, read_scene, to_toml
from tests.comparisons.scene.test_special_keys import KEYS as ALL
from tests.comparisons.scene.test_special_keys import SCHEMA
from tests.fuzz.world import toml_text

TEMPLATE = resources.files("comparisons.scene").joinpath("template.toml").read_text()
VALIDATOR = Draft202012Validator(SCHEMA)
KEYS = {kind: {key for table, key in ALL if table == kind} for kind in SCHEMA["properties"]}
KS = built_in_scenes()["ks-cantilever"]
Output = pytest.CaptureFixture[str]
pytestmark = pytest.mark.usefixtures("in_folder")


def refused(arguments: list[str], capsys: Output) -> str:
    """Return the one line of a command that does nothing."""
    assert main(arguments) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    return err.removeprefix("crossval: ").rstrip("\n")


def test_the_template_names_every_key_and_every_line_can_be_read():
    text = re.sub(r"^# (?=\[|\w+ = )", "", TEMPLATE, flags=re.MULTILINE)
    named: dict[str, set[str]] = {kind: set() for kind in KEYS}
    for part in re.split(r"^(?=\[)", text, flags=re.MULTILINE)[1:]:
        head, *lines = part.splitlines()
        named[head.partition("]")[0].strip("[")] |= set(re.findall(r"^(\w+) = ", part, re.MULTILINE))
        for line in lines:
            tomllib.loads(line.removeprefix("# "))
    assert named == KEYS


def test_a_new_scene_is_like_a_built_in_one():
    for name, text in built_in_scenes().items():
        assert main(["new", "mine", "--like", name]) == 0
        mine = Path("mine.toml")
        assert to_toml(load_scene("mine.toml")) == to_toml(load_scene(name)).replace(f'"{name}"', '"mine"', 1)
        assert mine.read_text().count("#") == text.count("#")
        mine.unlink()


def test_every_built_in_scene_obeys_the_schema(capsys):
    assert main(["scenes", "--schema"]) == 0
    assert json.loads(capsys.readouterr().out) == json.loads(json.dumps(SCHEMA))
    Draft202012Validator.check_schema(SCHEMA)
    for text in (TEMPLATE, *built_in_scenes().values()):
        VALIDATOR.validate(tomllib.loads(text))


VALUES: tuple[Any, ...] = (
    *(-1, 0, 0.5, 1, 7.5, True, "", "x", "start", [], [1.0], [1, 2], [[0, 0], [1, 1]], ["start"], None),
)


def edits() -> Iterator[dict[str, Any]]:
    """Yield the template with one value exchanged, added or left out."""
    for kind, keys in KEYS.items():
        for key, value in product(sorted(keys), VALUES):
            tables = tomllib.loads(TEMPLATE)
            table = tables.setdefault(kind, [{"beam": "strip", "end": "end"}])
            entry = table if kind == "scene" else table[0]
            entry.pop(key, None)
            if value is not None:
                entry[key] = value
            yield tables


def accepted(tables: dict[str, Any]) -> bool:
    try:
        read_scene(toml_text(tables), "edited")
    except InputError:
        return False
    return True


@pytest.mark.slow_at("1")
@pytest.mark.parametrize("every", [7, 1])
def test_what_the_schema_refuses_the_reader_refuses(every):
    refused = [tables for tables in list(edits())[::every] if not VALIDATOR.is_valid(tables)]
    assert len(refused) > 200 / every
    assert not [json.dumps(tables) for tables in refused if accepted(tables)]


@pytest.mark.parametrize(
    ("command", "case"),
    [*product(["check"], ["null", "/dev/zero", "pipe", "large"]), ("solve", "pipe"), ("run", "missing")],
)
def test_a_file_that_cannot_be_read_is_named_in_one_line(case, command, capsys):
    path = Path("my.toml")
    if case == "pipe":
        os.mkfifo(path)
    elif case == "large":
        with path.open("wb") as sparse:
            sparse.write(KS.encode())
            sparse.truncate(2 * 10**9)
    name = {"null": "no\0file", "/dev/zero": "/dev/zero"}.get(case, "my.toml")
    more = {"solve": ["--model", "tsm"], "check": [], "run": ["--out", "out"]}[command]
    said = {
        "/dev/zero": "cannot be read: is not a regular file",
        "pipe": "cannot be read: is not a regular file",
        "large": "cannot be read: has more than 16 MB",
    }
    line = refused([command, name, *more], capsys)
    assert line.startswith((f"{name}: ", name.replace("\0", r"\x00")))
    assert line.endswith(said.get(case, ""))


@pytest.mark.parametrize(
    "arguments",
    [
        ["solve", "{}.toml", "--model", "tsm"],
        ["view", "./{}"],
        ["solve", "ks-cantilever", "--model", "tsm", "--out", "/proc/{}"],
        ["solve", "ks-cantilever", "--model", "tsm", "--out", "/proc/{}/a.json"],
    ],
)
def test_a_name_commands_no_terminal(arguments, capsys):
    name = "a\x1b[31m\n\u202eb\udcff"
    line = refused([part.format(name) for part in arguments], capsys)
    assert r"a\x1b[31m\n\u202eb\udcff" in line or r"a\x1b[31m \u202eb\udcff" in line
    assert line.isprintable()

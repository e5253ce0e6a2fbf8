"""Scene files before anything is solved: ``crossval new``, ``check``, ``schema``."""

import json
import re
import tomllib
from collections.abc import Iterator
from dataclasses import fields
from importlib import resources
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from matplotlib.image import imread

from comparisons.cli import main
from comparisons.scene import Scene, SceneError, built_in_scenes, load_scene, read_scene, to_toml
from comparisons.scene.json_schema import json_schema, json_schema_text
from comparisons.scene.read import LISTS
from comparisons.scene.values import toml_value

SHIPPED = resources.files("comparisons.scene")
TEMPLATE = SHIPPED.joinpath("template.toml").read_text()
THERE = TEMPLATE.replace('side = "right"', 'side = "below"')
VALIDATOR = Draft202012Validator(json_schema())
Output = pytest.CaptureFixture[str]


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def sections() -> Iterator[tuple[str, str]]:
    """Yield the tables of the template with their lines, the commented ones too."""
    text = re.sub(r"^# (?=\[|\w+ = )", "", TEMPLATE, flags=re.MULTILINE)
    for part in re.split(r"^(?=\[)", text, flags=re.MULTILINE)[1:]:
        yield part.partition("]")[0].strip("["), part


@pytest.mark.parametrize("kind", ["scene", *LISTS])
def test_the_template_names_every_key(kind: str) -> None:
    named = {
        key
        for table, text in sections()
        if table == kind
        for key in re.findall(r"^(\w+) = ", text, re.MULTILINE)
    }
    assert named == keys_of(kind)


def test_every_line_of_the_template_can_be_read() -> None:
    for _, part in sections():
        for line in part.splitlines()[1:]:
            tomllib.loads(line.removeprefix("# "))


def test_a_new_scene_can_be_solved_and_checked(capsys: Output) -> None:
    assert main(["new", "strip"]) == 0
    scene = load_scene("strip.toml")
    assert scene.name == "strip"
    assert main(["check", "strip.toml"]) == 0
    assert capsys.readouterr().out.count(": yes") == 3
    assert imread("strip.png").shape[2] == 4
    assert main(["solve", "strip.toml", "--model", "tsm"]) == 0
    assert "COMPLETED" in capsys.readouterr().out


@pytest.mark.parametrize("name", built_in_scenes())
def test_a_new_scene_is_like_a_built_in_one(name: str) -> None:
    assert main(["new", "mine", "--like", name]) == 0
    mine = Path("mine.toml").read_text()
    assert to_toml(load_scene("mine.toml")) == to_toml(load_scene(name)).replace(f'"{name}"', '"mine"', 1)
    assert mine.count("#") == built_in_scenes()[name].count("#")


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["new", "a/b"], "NAME: a/b: must consist of letters, digits"),
        (["new", "there"], "there.toml: is there already"),
        (["check", "there.toml"], "there.toml: "),
        (["check", "ks-cantilever", "--out", "picture.pdf"], "picture.pdf: must end in .png or .svg"),
        (["check", "ks-cantilever", "--out", "nowhere/p.png"], "nowhere"),
    ],
)
def test_what_cannot_be_done_is_one_line(
    arguments: list[str], line: str, capsys: Output, in_a_folder: Path
) -> None:
    (in_a_folder / "there.toml").write_text(THERE)
    assert main(arguments) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"crossval: {line}")
    assert len(error.splitlines()) == 1
    assert [path.name for path in in_a_folder.iterdir()] == ["there.toml"]
    assert (in_a_folder / "there.toml").read_text() == THERE


def test_check_says_why_a_model_cannot_state_a_scene(capsys: Output) -> None:
    assert main(["check", "double-beam", "--out", "double.svg"]) == 0
    out = capsys.readouterr().out
    assert "2 beams, 1 pin, 3 contact pairs" in out
    assert "  elastica: no, " in out
    drawn = Path("double.svg").read_text()
    assert drawn.startswith("<?xml")


def test_the_shipped_schema_is_that_of_the_records(capsys: Output) -> None:
    """Written by ``python -m comparisons.scene.json_schema``."""
    assert SHIPPED.joinpath("scene.schema.json").read_text() == json_schema_text()
    Draft202012Validator.check_schema(json_schema())
    assert main(["schema"]) == 0
    assert capsys.readouterr().out == json_schema_text()


@pytest.mark.parametrize("text", [TEMPLATE, *built_in_scenes().values()])
def test_scenes_keep_the_schema(text: str) -> None:
    VALIDATOR.validate(tomllib.loads(text))


VALUES: tuple[Any, ...] = (
    -1,
    0,
    0.5,
    1,
    7.5,
    True,
    "",
    "x",
    "start",
    [],
    [1.0],
    [1, 2],
    [[0, 0], [1, 1]],
    ["start"],
)


def keys_of(kind: str) -> set[str]:
    return {item.name for item in fields(LISTS.get(kind, Scene))} - {f"{name}s" for name in LISTS}


def edits() -> Iterator[dict[str, Any]]:
    """Yield the template with one value exchanged, added or left out."""
    for kind in ("scene", *LISTS):
        for key, value in product(sorted(keys_of(kind)), (*VALUES, None)):
            tables = tomllib.loads(TEMPLATE)
            table = tables.setdefault(kind, [{"beam": "strip", "end": "end"}])
            entry = table if kind == "scene" else table[0]
            entry.pop(key, None)
            if value is not None:
                entry[key] = value
            yield tables


def accepted(tables: dict[str, Any]) -> bool:
    lines = []
    for kind, entries in tables.items():
        for entry in entries if isinstance(entries, list) else [entries]:
            lines.append(f"[[{kind}]]" if isinstance(entries, list) else f"[{kind}]")
            lines += [f"{key} = {toml_value(value)}" for key, value in entry.items()]
    try:
        read_scene("\n".join(lines), "edited")
    except SceneError:
        return False
    return True


def test_what_the_schema_refuses_the_reader_refuses() -> None:
    refused = [tables for tables in edits() if not VALIDATOR.is_valid(tables)]
    assert len(refused) > 200
    assert not [json.dumps(tables) for tables in refused if accepted(tables)]

"""The pages that are made from the code say what the code does."""

import json
import re
from dataclasses import fields, replace
from pathlib import Path

import jsonschema
import pytest

import comparisons
import fem_reference
import tsm
from comparisons.cli import main
from comparisons.models.options import ModelError, Options
from comparisons.models.outside.request import request
from comparisons.models.outside.status import ProgramStatus
from comparisons.referee import Verdict
from comparisons.scene import SPECIAL, LoadSpec, Scene, built_in_scenes, load_scene, to_toml, unstated
from comparisons.scene.keys import PROGRAMS, special_keys
from comparisons.scene.read import LIST_FIELDS, LISTS, STAGE_LISTS
from comparisons.scene.words import NOT_MODELLED
from docs.extensions import response, scene_file, scope, statuses
from docs.extensions.generated import PAGES, write_pages

FINDINGS = Path(__file__).parents[1] / "comparisons" / "findings"


def test_every_key_of_a_scene_is_listed() -> None:
    sections = dict(part.partition("\n")[::2] for part in scene_file.page().split("## ")[1:])
    moves = {
        f"`{name} of [[stage]]`": record for name, record in STAGE_LISTS.items() if record is not LoadSpec
    }
    records = {**{f"`[[{kind}]]`": record for kind, record in LISTS.items()}, **moves}
    assert set(sections) == {"`[scene]`", *records}
    for header, record in records.items():
        rows = [line for line in sections[header].splitlines() if line.startswith("| `")]
        assert [row.split("`")[1] for row in rows] == [item.name for item in fields(record)]
        assert all(row.rstrip(" |").rpartition("|")[2].strip() for row in rows), "a key without a meaning"


NUMERICS = {
    *(
        "elements",
        "nodes",
        "mesh",
        "solid_clamp",
        "solid_mesh_file",
        "solid_element",
        "penalty",
        "penetration",
    ),
    *(
        "name",
        "units",
        "load_parameters",
        "beam",
        "end",
        "keep",
        "node",
        "free",
        "start",
        "stiffness",
        "surface",
    ),
}
"""Keys that say what something is called, where it is or how it is computed."""


def test_every_key_answers_a_question() -> None:
    page = scope.page()
    named = set(re.findall(r"`(?:\[\[)?(\w+)", page.partition("## What is not modelled")[0]))
    keys = {item.name for record in (*LISTS.values(), Scene) for item in fields(record)} - LIST_FIELDS
    assert keys - NUMERICS <= named
    assert set(LISTS) - {"beam"} <= named
    assert all(f"`{word}`" in page for topic in NOT_MODELLED for word in topic.words.split())


def test_a_question_has_a_scene_that_says_it() -> None:
    questions = [item for group in scope.GROUPS.values() for item in group]
    assert {key for item in questions for key in special_keys(item.scene)} == set(SPECIAL)
    friction = next(item for item in questions if item.wish == "friction")
    assert friction.scene.contacts[0].friction > 0
    assert len({to_toml(item.scene) for item in questions}) == len(questions) - 1, "two pins answer twice"


IN_CODE = (
    r'^([A-Z_]{4,}) = "\1"',
    r'\bstatus\b[^\n]*?"([A-Z][A-Z_]{2,})"',
    r'^ +"([A-Z_]{4,})": "',
    r'return \(?"([A-Z_]{4,})"',
    r"^ +\w+State\.([A-Z_]+): \"",
    r"crossval: .*?\b([A-Z]+_[A-Z_]+): ",
)
"""How a status stands in a module, besides as a member of a class of statuses."""


def test_every_status_in_the_code_is_on_the_page() -> None:
    page = statuses.page()
    modules = [Path(package.__path__[0]) for package in (comparisons, tsm, fem_reference)]
    texts = [path.read_text(encoding="utf-8") for module in modules for path in module.rglob("*.py")]
    found = {name for text in texts for one in IN_CODE for name in re.findall(one, text, re.MULTILINE)}
    found |= {one.name for kind in (tsm.Status, fem_reference.Status, ProgramStatus, Verdict) for one in kind}
    assert not [name for name in sorted(found) if f"`{name}`" not in page]
    assert set(statuses.CHECKS) | set(statuses.CASES) | {"LOST", "JAMMED", "SLIPPED_OFF"} <= found


@pytest.mark.slow_at(
    "double-beam --model tsm --elements 5",
    "ks-cantilever --model rod",
    "ks-cantilever --model solid --mesh 16x1",
    "ks-cantilever --model tsm --elements 5",
    "ks-tied-tip --model tsm --element exact",
)
@pytest.mark.parametrize(
    "arguments",
    [
        "ks-cantilever --model tsm --elements 5",
        "ks-cantilever --model rod",
        "ks-cantilever --model elastica",
        "ks-cantilever --model solid --mesh 16x1",
        "double-beam --model tsm --elements 5",
        "ks-tied-tip --model tsm --element exact",
        "ks-cantilever --accuracy 1e-3",
    ],
)
def test_json_output_obeys_its_schema(arguments: str, tmp_path: Path) -> None:
    path = tmp_path / "response.json"
    assert main(["solve", *arguments.split(), "--json", str(path)]) == 0
    found = json.loads(path.read_text())
    jsonschema.Draft202012Validator.check_schema(response.SCHEMA)
    jsonschema.Draft202012Validator(response.SCHEMA).validate(found)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.Draft202012Validator(response.SCHEMA).validate({**found, "unheard_of": 1})


@pytest.mark.slow
@pytest.mark.parametrize("model", ["tsm", pytest.param("rod", marks=pytest.mark.slow), "solid"])
def test_json_output_with_friction_obeys_its_schema(
    model: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    scene = load_scene("ks-face")
    rough = replace(scene, contacts=(replace(scene.contacts[0], friction=0.3),))
    Path("rough.toml").write_text(to_toml(rough))
    assert main(["solve", "rough.toml", "--model", model, "--json", "rough.json"]) == 0
    found = json.loads(Path("rough.json").read_text())
    jsonschema.Draft202012Validator(response.SCHEMA).validate(found)
    (contact,) = found["contacts"].values()
    assert set(contact["friction"]["slip"]) == {-1, 0, 1}
    assert contact["friction"]["dissipated"][-1] > 0.0
    assert ("work" in found) is (model != "solid")


def test_every_kind_of_event_is_in_the_schema() -> None:
    kinds = response.SCHEMA["properties"]["events"]["items"]["properties"]["kind"]["enum"]
    assert set(kinds) == {kind.value for kind in tsm.EventKind}


@pytest.mark.parametrize("scene", [*built_in_scenes(), *map(str, sorted(FINDINGS.glob("*.toml")))])
def test_a_resolved_scene_obeys_its_schema(scene: str) -> None:
    found = load_scene(scene)
    if unstated(found, "the resolved scene", PROGRAMS) is not None:
        with pytest.raises(ModelError, match="the resolved scene does not state"):
            request(found, Options(), found.times)
        return
    data = json.loads(request(found, Options(elements=7), found.times))
    jsonschema.Draft202012Validator.check_schema(response.SCENE)
    jsonschema.Draft202012Validator(response.SCENE).validate(data)
    assert [beam["elements"] for beam in data["beams"]] == [7] * len(found.beams)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.Draft202012Validator(response.SCENE).validate({**data, "unheard_of": 1})


def test_pages_are_written_and_an_unchanged_one_keeps_its_time(tmp_path: Path) -> None:
    write_pages(tmp_path)
    times = {name: (tmp_path / name).stat().st_mtime_ns for name in PAGES}
    (tmp_path / "messages.md").write_text("stale")
    write_pages(tmp_path)
    changed = [name for name, time in times.items() if (tmp_path / name).stat().st_mtime_ns != time]
    assert changed == ["messages.md"]

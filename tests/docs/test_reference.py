"""The pages that are made from the code say what the code does."""

import json
import re
from dataclasses import replace
from pathlib import Path

import jsonschema
import pytest

import tsm
from comparisons.scene import SPECIAL, built_in_scenes, load_scene, to_toml, unstated
from docs.extensions.generated import PAGES, SCHEMAS, STATUSES, questions, write_pages
from tests.docs.snippets import ROOT, run_line

FINDINGS = ROOT / "tests" / "comparisons" / "findings"
NUMERICS = {
    "elements", "nodes", "mesh", "solid_clamp", "solid_mesh_file", "solid_element", "penalty", "penetration", "name", "units",
    "load_parameters", "beam", "end", "keep", "node", "free", "start", "stiffness", "surface",
}  # fmt: skip
"""Keys that say what something is called, where it is or how it is computed."""


@pytest.fixture(scope="module")
def tables() -> dict[str, dict[str, dict]]:
    """The tables of a scene file and their keys, as the schema has them."""
    found = json.loads(run_line("crossval scenes --schema"))["properties"]
    lists = {f"[[{name}]]": one["items"] for name, one in found.items() if name != "scene"}
    return {header: one["properties"] for header, one in {"[scene]": found["scene"], **lists}.items()}


def test_every_key_of_a_scene_is_listed_with_a_meaning(tables):
    sections = dict(part.partition("`\n")[::2] for part in PAGES["scene-file.md"]().split("## `")[1:])
    row = re.compile(r"(?m)^\| `(\w+)` .*\| (.*?) *\|$")
    rows = {header: row.findall(text) for header, text in sections.items()}
    for header, keys in tables.items():
        assert [key for key, _ in rows[header]] == list(keys), header
    assert sections.keys() - tables.keys() == {"support of [[stage]]", "pin of [[stage]]"}
    assert all(meaning for listed in rows.values() for _, meaning in listed)


def test_every_key_answers_a_question_that_a_scene_asks(tables):
    named = set(re.findall(r"`(?:\[\[)?(\w+)", PAGES["scope.md"]().partition("## What is not modelled")[0]))
    keys = {key for own in tables.values() for key in own} | {header.strip("[]") for header in tables}
    assert keys - NUMERICS - {"scene"} <= named
    asked = [item for group in questions().values() for item in group]
    for key in SPECIAL:
        assert any(unstated(item.scene, "", SPECIAL.keys() - {key}) for item in asked), key
    friction = next(item for item in asked if item.wish == "friction")
    assert friction.scene.contacts[0].friction > 0
    assert len({to_toml(item.scene) for item in asked}) == len(asked) - 1, "two pins answer twice"


IN_CODE = (
    r'^([A-Z_]{4,}) = "\1"',
    r'\bstatus\b[^\n]*?"([A-Z][A-Z_]{2,})"',
    r'^ +"([A-Z_]{4,})": "',
    r'return \(?"([A-Z_]{4,})"',
    r"^ +\w+State\.([A-Z_]+): \"",
    r"crossval: .*?\b([A-Z]+_[A-Z_]+): ",
)
"""How a status stands in a module, besides as a member of a class of statuses."""


def test_every_status_in_the_code_is_on_the_page():
    page = (ROOT / "docs/reference/exit-statuses.md").read_text(encoding="utf-8").partition("### Checks")[2]
    by_hand = set(re.findall(r"(?m)^\| `(\w+)` \|", page))
    listed = by_hand | {name for rows in STATUSES.values() for name in rows}
    packages = [ROOT / name for name in ("comparisons", "tsm", "fem_reference")]
    files = [file for package in packages for file in package.rglob("*.py")]
    text = "\n".join(file.read_text(encoding="utf-8") for file in files)
    found = {name for one in IN_CODE for name in re.findall(one, text, re.MULTILINE)}
    assert by_hand <= found <= listed


def check_schema(schema: dict, data: dict) -> None:
    """The data obeys a schema that is one, and that allows nothing else."""
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.Draft202012Validator(schema).validate(data)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.Draft202012Validator(schema).validate({**data, "unheard_of": 1})


@pytest.mark.parametrize(
    ("scene", "options"),
    [
        ("ks-cantilever", "--model tsm --elements 5"),
        ("ks-cantilever", "--model elastica"),
        ("ks-cantilever", "--accuracy 1e-3"),
        ("double-beam", "--model tsm --elements 5"),
        pytest.param("ks-friction", "--model tsm --elements 5 --certify none", marks=pytest.mark.slow),
        pytest.param("ks-friction", "--model rod", marks=pytest.mark.slow),
        pytest.param("ks-friction", "--model solid", marks=pytest.mark.slow),
    ],
)
def test_json_output_obeys_its_schema(scene, options, in_folder):
    """With friction, which slips both ways."""
    Path("my.toml").write_text(to_toml(replace(load_scene(scene), load_parameters=15)))
    run_line(f"crossval solve my.toml {options} --out a.json")
    found = json.loads(Path("a.json").read_text())
    check_schema(SCHEMAS["response"], found)
    if scene == "ks-friction":
        (contact,) = found["contacts"].values()
        assert set(contact["friction"]["slip"]) == {-1, 0, 1}
        assert contact["friction"]["dissipated"][-1] > 0.0
        assert ("work" in found) is ("solid" not in options)
    kinds = SCHEMAS["response"]["$defs"]["event"]["properties"]["kind"]["enum"]
    assert set(kinds) == {kind.value for kind in tsm.EventKind}


@pytest.mark.parametrize("scene", [*built_in_scenes(), *map(str, sorted(FINDINGS.glob("*.toml")))])
def test_a_resolved_scene_obeys_its_schema(scene):
    found = load_scene(scene)
    if unstated(found, "the resolved scene") is not None:
        said = run_line(f"crossval check {scene} --out -  # exit status 2")
        assert "the resolved scene does not state" in said
        return
    data = json.loads(run_line(f"crossval check {scene} --out -"))
    check_schema(SCHEMAS["resolved-scene"], data)
    assert len(data["beams"]) == len(found.beams)


def test_pages_are_written_and_an_unchanged_one_keeps_its_time(tmp_path):
    write_pages(tmp_path)
    times = {name: (tmp_path / name).stat().st_mtime_ns for name in PAGES}
    (tmp_path / "messages.md").write_text("stale")
    write_pages(tmp_path)
    changed = [name for name, time in times.items() if (tmp_path / name).stat().st_mtime_ns != time]
    assert changed == ["messages.md"]

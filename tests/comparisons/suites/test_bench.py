"""The benchmark set is made anew. The scorer needs no library and names lies. The clients do not import the package."""

import importlib.util
import json
import math
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from jsonschema import Draft202012Validator

from comparisons.scene import load_scene
from comparisons.suites import bench
from tests.comparisons.suite.conftest import crossval

BENCH = Path(__file__).parents[3] / "bench"
SCENES, QUERIES, RIGHT = (
    json.loads((BENCH / f"{name}.json").read_text()) for name in ("scenes", "queries", "answers")
)
CLIENTS = {
    "shooting.py": [sys.executable, "-I", "-S"],
    "frames.py": [sys.executable, "-P"],
    "closed_form.mjs": ["node"],
}
ALL = bench.scenes()
FORCE = {"scene": "ks-face", "of": "pin->cantilever", "what": "force_y", "at": 2}


@pytest.fixture(scope="module")
def make():
    spec = importlib.util.spec_from_file_location("make", BENCH / "make.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def mine(**changes):
    """The right answers as a program gives them."""
    rows = [
        {**query, "value": row["value"]}
        for query, row in zip(QUERIES["queries"], RIGHT["answers"], strict=True)
    ]
    return {"set": RIGHT["set"], "program": "mine", "answers": rows, **changes}


def scored(folder, *given, options=()):
    """Score files by Python alone, without any package; return the exit status, and what is printed."""
    files = [folder / f"{k}.json" for k in range(len(given))]
    for file, one in zip(files, given, strict=True):
        file.write_text(one if isinstance(one, str) else json.dumps(one))
    line = [sys.executable, "-I", "-S", BENCH / "score.py", *files, *options]
    done = subprocess.run(line, capture_output=True, text=True, check=False, env={})
    return done.returncode, done.stdout + done.stderr


def few(monkeypatch, *names):
    """Let the set have some scenes only."""
    monkeypatch.setattr(bench, "scenes", lambda: {name: ALL[name] for name in names})
    stated = [row for row in bench.SET["scene"] if row["name"] in names]
    monkeypatch.setattr(bench, "SET", bench.SET | {"scene": stated})
    return names


def row_of(given, query):
    return next(row for row in given["answers"] if query.items() <= row.items())


def right(query):
    return row_of(RIGHT, query)["value"]


def test_the_set_is_what_its_page_says():
    digits = Counter(row["digits"] for row in RIGHT["answers"])
    count, page = sum(digits.values()), (BENCH / "README.md").read_text()
    assert (len(SCENES["scenes"]), count, digits[12], min(digits)) == (20, 961, 949, 9)
    assert "961 numbers that are certain: 949 to twelve digits" in page
    assert sum(n for d, n in digits.items() if d >= 10) >= 0.95 * count
    for name, data in (("scenes", SCENES), ("queries", QUERIES), ("answers", RIGHT), ("mine", mine())):
        schema = json.loads((BENCH / f"schemas/{name}.schema.json").read_text())
        Draft202012Validator(schema).validate(data)
    assert "elements" not in json.dumps(SCENES["scenes"])
    # what a resolved scene could not say
    for scene in (load_scene(row["name"]) for row in SCENES["scenes"]):
        assert not any(load.at is not None for load in scene.loads)
        assert not any(stage.load or stage.support or any(stage.gravity) for stage in scene.stages)
        assert not any(hinge.stiffness for hinge in scene.hinges)
    assert {path.name for path in (BENCH / "clients").iterdir()} == set(CLIENTS)
    lines = {
        path: len(path.read_text().splitlines())
        for path in BENCH.rglob("*.[pm][yj]*")
        if path.parent.name != "__pycache__"
    }
    assert max(n for path, n in lines.items() if path.parent.name == "clients") <= 80
    assert sum(n for path, n in lines.items() if path.suffix == ".py") <= 450
    assert not any(
        re.search("comparisons|tsm", path.read_text()) for path in lines if path.parent.name == "clients"
    )


@pytest.mark.slow
def test_the_set_is_made_anew_byte_for_byte(make, tmp_path):
    """And from nothing to the digits that are stated."""
    made = make.texts(BENCH)
    assert made == {name: (BENCH / name).read_text() for name in made}
    fresh = json.loads(make.texts(tmp_path)["answers.json"])["answers"]
    for row in fresh:
        kept = row_of(RIGHT, bench.query_of(row))
        assert abs(row["value"] - kept["value"]) <= 2.0 * 10.0 ** -kept["digits"] * kept["scale"]
        assert row["digits"] >= kept["digits"] - 1


def test_right_and_refused_are_no_failure(tmp_path):
    """Three programs, on the screen, as JUnit XML and as a table; what is refused needs no rows."""
    none = mine(answers=[], refused={one["name"]: "no beams" for one in SCENES["scenes"]})
    some = mine()
    some["answers"] = [
        {**bench.query_of(row), "refused": "no events"} if "number" in row else row for row in some["answers"]
    ]
    files = tmp_path / "j.xml", tmp_path / "r.md"
    status, out = scored(
        tmp_path, mine(), some, none, options=["--junit", files[0], "--results", files[1], "--every"]
    )
    assert status == 0
    assert re.search(r"^all +961 +961 +0 +0 +0\.0e\+00 +0\.0e\+00 +12\.0 / 9\.0$", out, re.M)
    assert "ks-face: pin->cantilever force_y at 2" in out
    suites = ET.parse(files[0]).getroot()  # noqa: S314 our own file
    assert [len(suite) for suite in suites] == [961] * 3
    events = sum("number" in row for row in some["answers"])
    assert [len(list(suite.iter("skipped"))) for suite in suites] == [0, events, 961]
    assert "| ks-face | 12.0 / 12.0 | 12.0 / 12.0 | - |" in files[1].read_text()


SCALE = row_of(RIGHT, FORCE)["scale"]
LIES = {
    "not a number: not finite": (math.nan, "not a finite number"),
    "zero": (0.0, "zero"),
    "swapped axes": (right({**FORCE, "what": "force_x"}), "x and y are swapped"),
    "sign": (-right(FORCE), "wrong sign"),
    "unit": (1e3 * right(FORCE), "wrong unit: 10^3"),
    "another load parameter": (
        right({**FORCE, "at": 3}),
        "the value of ks-face: pin->cantilever force_y at 3",
    ),
    "text": ("1.5", 'not a number: "1.5"'),
    "1e-3 off": (right(FORCE) + 1e-3 * SCALE, "off by 1.0e-03"),
    "truth value": (True, "not a number: true"),
    "huge": (10**400, "not a finite number"),
}


@pytest.mark.parametrize(("value", "name"), LIES.values(), ids=LIES)
def test_a_lie_is_told_by_name(value, name, tmp_path):
    given = mine()
    row_of(given, FORCE)["value"] = value
    status, out = scored(tmp_path, given)
    assert status == 1
    (line,) = [line for line in out.splitlines() if line.startswith("ks-face: pin->cantilever force_y at 2")]
    assert line.endswith(f"  {name}")


def test_a_file_that_cannot_be_scored_is_told_by_name(tmp_path):
    given = mine()
    one, *rest = given["answers"]
    for changes, status, name in (
        ({"set": "0" * 16}, 2, f"stale: it answers the set '{'0' * 16}', this is '{RIGHT['set']}'"),
        ({"answers": rest}, 1, "missing"),
        ({"answers": [one, *given["answers"]]}, 2, "answered twice: ks-cantilever: "),
        ({"answers": [{**one, "at": 99}]}, 2, 'not asked: {"scene": "ks-cantilever"'),
        ({"answers": {}}, 2, "must have a list of answers"),
    ):
        found, out = scored(tmp_path, given | changes)
        assert (found, name in out) == (status, True), out
    assert scored(tmp_path, "{")[0] == scored(tmp_path, "[]")[0] == 2


@pytest.mark.parametrize(
    "name",
    ["closed_form.mjs", *(pytest.param(one, marks=pytest.mark.slow) for one in ("shooting.py", "frames.py"))],
)
def test_a_client_is_right_on_what_it_answers(name, tmp_path):
    done = subprocess.run(
        [*CLIENTS[name], BENCH / "clients" / name], capture_output=True, text=True, check=True
    )
    digits = {"closed_form.mjs": 11, "shooting.py": 7, "frames.py": 3}[name]
    status, out = scored(tmp_path, done.stdout, options=["--digits", str(digits)])
    assert status == 0, out
    least = {"closed_form.mjs": 42, "shooting.py": 112, "frames.py": 100}[name]
    assert re.search(rf"^all +961 +{least} +{961 - least} +0 ", out, re.M)


@pytest.mark.slow
def test_the_command_answers_for_models(in_folder, monkeypatch, capsys):
    """With their settings; what a model cannot state is refused, what it does not reach has the reason, and one that states nothing ends it."""
    few(monkeypatch, "straightened-arc", "clamped-column", "ks-friction")
    words = ("tsm mixed 3", "tsm timoshenko", "rod")
    assert crossval("run", "bench", *words, "--out", "o") == 0
    coarse, paper, exact = (
        json.loads(Path(f"o/{name.replace(' ', '-')}.json").read_text()) for name in words
    )
    assert (coarse["program"], coarse["refused"], exact["refused"]) == ("TSM mixed 3", {}, {})
    assert paper["refused"].keys() == {"straightened-arc", "ks-friction"}
    wanted = json.loads(Path("o/queries.json").read_text())["queries"]
    assert list(map(bench.query_of, coarse["answers"])) == wanted
    for row in (row for row in exact["answers"] if "refused" not in row):
        kept = row_of(RIGHT, bench.query_of(row))
        assert row["value"] == pytest.approx(kept["value"], abs=1e-9 * kept["scale"])
    capsys.readouterr()
    assert crossval("run", "bench", "tsm 25x2", "--out", "p") == 2
    assert capsys.readouterr().err == "crossval: tsm: mesh = (25, 2): not an option of this model\n"


@pytest.mark.slow
def test_the_table_of_results_is_that_of_the_scorer(in_folder):
    """The column of `tsm mixed 20`, but for round-off."""
    assert crossval("run", "bench", "tsm mixed 20", "--out", "o") == 0
    status, _ = scored(
        in_folder, Path("o/tsm-mixed-20.json").read_text(), options=["--digits", "3", "--results", "r.md"]
    )
    tables = [
        path.read_text().split("| --- |\n")[-1].splitlines() for path in (Path("r.md"), BENCH / "RESULTS.md")
    ]
    assert status == 0
    for made, stated in zip(*tables, strict=True):
        (name, own, *_), (kept, _, column, *_) = made.split(" | "), stated.split(" | ")
        assert name == kept
        digits = [list(map(float, re.findall(r"\d+\.\d", cell))) for cell in (own, column)]
        assert all(abs(x - y) <= 0.1 or min(x, y) > 9.0 for x, y in zip(*digits, strict=True))

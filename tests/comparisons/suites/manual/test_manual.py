"""The verification manual: every problem with every model, how answers are judged, and what is written."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from comparisons.cli import main
from comparisons.scene import read_scene
from comparisons.suites.manual import judged, problems, read_problem

# not public: measures that no model has
from comparisons.suites.manual.measures import MEASURES, StoppedError
from tests.comparisons.report.pages.markup import check_alone
from tests.laws.transform import Change

PROBLEMS = {path.stem: path for path in problems()}
FAST = (
    "clamped-column", "dead-load", "elastica-identity", "euler-column", "force-limit", "pinned-column", "portal-frame", "post-buckling",
    "roll-up", "sleeve", "touch-again", "two-pins",
)  # fmt: skip
"""Problems of less than a second."""


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] * (name not in FAST)) for name in PROBLEMS]
)
def test_a_problem_of_the_table_passes(name):
    """With every model, whose tolerance has a reason and exceeds the uncertainty of the value."""
    problem = read_problem(PROBLEMS[name])
    assert [item.failure for item in judged(problem) if not item.passed] == []
    for quantity in problem.quantities:
        assert math.isfinite(quantity.exact)
        assert problem.uncertainty < min(trial.allowed for trial in problem.trials)
    for trial in problem.trials:
        assert 0.0 < trial.allowed <= 0.3
        assert trial.why


def test_the_page_counts_the_problems_and_their_answers(stated):
    stated("manual.problems", len(PROBLEMS))
    assert sum(len(read_problem(path).trials) for path in PROBLEMS.values()) == 96


MADE_UP = """
title = "Made | up"
purpose = "a"
statement = "b"
source = "c"
uncertainty = 0.0
scene = "tip-load"
measure = "told"
quantities = [{ name = "a", exact = 2.0 }, { name = "|b|", exact = 0.0, scale = 4.0 }]
trials = [
"""


def made_up(folder, count):
    """The file of a problem with the exact values 2 and 0, and a bar in a name, for some models."""
    trial = '  { model = "tsm exact", setting = "NUMBER", allowed = 0.01, why = "d" },\n'
    path = folder / "made-up.toml"
    path.write_text(MADE_UP + "".join(trial.replace("NUMBER", str(k)) for k in range(count)) + "]\n")
    return path


def telling(*answers):
    """A measure by which the models answer so."""

    def measure(given):
        answer = answers[int(given.trial.setting)]
        if isinstance(answer, StoppedError):
            raise answer
        return answer

    return measure


JUDGED = [
    ((2.0, 0.0), (0.0, 0.0), None),
    ((2.01, -0.03), (0.005, 0.0075), None),
    ((1.97, 0.0), (0.015, 0.0), "a: 1.97, exact 2, error 0.015 > 0.01"),
    ((2.1, 1.0), (0.05, 0.25), "|b|: 1, exact 0, error 0.25 > 0.01"),
    ((math.nan, 1.0), (math.nan, 0.25), "a: nan, exact 2, error nan > 0.01"),
    ((math.inf, 0.0), (math.inf, 0.0), "a: inf, exact 2, error inf > 0.01"),
    (StoppedError("CUTBACK_FLOOR: too small"), (math.inf, math.inf), "CUTBACK_FLOOR: too small"),
]


def test_errors_are_relative_and_the_worst_is_named_on_every_way_out(tmp_path, monkeypatch, capsys):
    """Screen, exit status, JUnit, JSON and page; what is no number fails, and a page escapes bars."""
    monkeypatch.setitem(MEASURES, "told", telling(*(answer for answer, *_ in JUDGED)))
    files = [made_up(tmp_path, len(JUDGED)), PROBLEMS["roll-up"]]
    monkeypatch.setattr("comparisons.cli.run.problems", lambda _: files)
    folder = tmp_path / "m"
    junit = folder / "junit.xml"
    assert main(["run", "manual", "--out", str(folder), "--quiet"]) == 1
    out, err = capsys.readouterr()
    failures = [failure for *_, failure in JUDGED]
    assert "2 cases, 10 answers, 5 beyond their tolerance" in out
    assert str(junit) in out
    for line, failure in zip(err.splitlines(), filter(None, failures), strict=True):
        assert re.fullmatch(rf"crossval: made-up, tsm exact.*: {re.escape(failure)}", line)
    root = ET.parse(junit).getroot()  # noqa: S314 our own file
    assert (root.get("tests"), root.get("failures")) == ("10", "5")
    assert [item[0].get("message") if len(item) else None for item in root[:7]] == failures
    assert root[0].get("classname") == "manual.made-up"
    data = json.loads((folder / "manual.json").read_text())
    assert data["passed"] is False
    assert [run["passed"] for run in data["cases"][0]["runs"]] == [failure is None for failure in failures]
    assert data["cases"][1]["passed"] is True
    for run, (_, errors, _) in zip(data["cases"][0]["runs"], JUDGED, strict=True):
        assert [error is None for error in run["errors"]] == [not math.isfinite(error) for error in errors]
        for found, error in zip(run["errors"], errors, strict=True):
            assert found is None or found == pytest.approx(error, rel=1e-12)
    page = (folder / "index.md").read_text()
    assert "2 problems with exact answers" in page
    assert "5 of 10 answers within their tolerances" in page
    assert page.count("**FAILED**") == 10
    assert "Stopped: CUTBACK_FLOOR: too small" in page
    assert "![Made | up](made-up.svg)" in page
    tables = [line for line in page.splitlines() if line.startswith("|")]
    assert {len(re.findall(r"(?<!\\)\|", line)) for line in tables} == {9, 10, 6}
    for target in re.findall(r"\]\(#(.*?)\)", page):
        assert f'<a id="{target}"></a>' in page
    for picture in re.findall(r"\]\((\S+\.svg)\)", page):
        assert ET.parse(folder / picture).getroot().tag.endswith("svg")  # noqa: S314 our own file
    html = (folder / "report.html").read_text()
    check_alone(html, folder)
    assert html.count(">FAILED<") == 10
    assert html.count("data:image/svg+xml") == 2
    # lines that agree are all seen
    widths = re.findall(r"stroke-width: ([\d.]+)", (folder / "roll-up.svg").read_text())
    assert {"1.5", "3.5", "5.5"} <= set(widths)
    monkeypatch.setitem(MEASURES, "told", telling((2.0,)))
    with pytest.raises(ValueError, match="argument 2 is shorter"):
        judged(read_problem(made_up(tmp_path, 1)))


def test_a_scene_that_is_moved_is_the_scene():
    """Turned by .7 and shifted, mirrored, reversed: paths and sides are where they must be; the answers show the rest."""
    places = {"objectivity": lambda z: np.exp(0.7j) * z + 2 - 3j, "mirror": np.conj, "reversal": lambda z: z}
    for name, place in places.items():
        scene = (problem := read_problem(PROBLEMS[name])).scene
        other = read_scene(problem.settings["other"], name)
        given, found = (np.array(one.pins[0].points) @ [1.0, 1.0j] for one in (scene, other))
        assert found == pytest.approx(place(given), abs=1e-15)
        assert (other.beams != scene.beams) == (name != "mirror")
        assert [one.side for one in other.contacts] == ["right" if name == "objectivity" else "left"]


def test_a_greatest_load_is_read_without_units():
    problem, change = read_problem(PROBLEMS["force-limit"]), Change(length=7.0, force=0.3)
    trials = tuple(replace(one, scene=change.scene(one.scene)) for one in problem.trials)
    assert all(item.passed for item in judged(replace(problem, trials=trials)))


def test_a_new_problem_is_one_file():
    (path,) = problems(folder=Path(__file__).with_name("new"))
    assert [item.passed for item in judged(read_problem(path))] == [True, False]

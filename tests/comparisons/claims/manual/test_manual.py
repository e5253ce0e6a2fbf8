"""The verification manual: how answers are judged, what is written, and that all of it passes."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from comparisons.claims.claim import Allowance, Quantity, StoppedError, Verdict
from comparisons.claims.manual import Case, Problem, Trial, write_manual
from comparisons.claims.manual import problems as manual_problems
from comparisons.claims.manual.elastica import identity
from comparisons.claims.manual.judge import answered
from comparisons.claims.manual.loads import dead_load, roll_up
from comparisons.claims.manual.pictures import STYLES
from comparisons.claims.manual.problems import PROBLEMS
from comparisons.claims.manual.record import Curve, Measured, Picture
from comparisons.claims.manual.scenes import ks, mirrored, moved, reversed_
from comparisons.claims.manual.text import junit_cases, markdown
from comparisons.cli import main
from comparisons.models import solve
from comparisons.scene import Scene, load_scene


def problem(*answers: "tuple[float, ...] | StoppedError", tolerance: float = 0.01) -> Problem:
    """A problem with the exact values 2 and 0, and models that answer so."""

    def trial(answer: "tuple[float, ...] | StoppedError") -> Trial:
        def measure(_: Scene) -> Measured:
            if isinstance(answer, StoppedError):
                raise answer
            return Measured(values=answer, curves=(Curve(style="rod", points=np.eye(2)),))

        allowance = Allowance(error=tolerance, why="made up")
        return Trial(model="rod", setting="", allowance=allowance, measure=measure)

    return Problem(
        name="made-up",
        title="Made | up",
        purpose="None.",
        uncertainty=0.0,
        scene=load_scene("tip-load"),
        statement="Nothing.",
        source="nowhere",
        quantities=(Quantity(name="a", exact=2.0), Quantity(name="|b|", exact=0.0, scale=4.0)),
        trials=tuple(trial(answer) for answer in answers),
        picture=Picture(),
    )


def judged(*answers: "tuple[float, ...] | StoppedError") -> Case:
    return answered(problem(*answers), "made-up.svg")[0]


@pytest.mark.parametrize(
    ("values", "errors", "passed"),
    [
        ((2.0, 0.0), (0.0, 0.0), True),
        ((2.01, -0.03), (0.005, 0.0075), True),
        ((1.97, 0.0), (0.015, 0.0), False),
        ((2.0, 0.05), (0.0, 0.0125), False),
        ((math.nan, 0.0), (math.nan, 0.0), False),
        ((math.inf, 0.0), (math.inf, 0.0), False),
    ],
)
def test_errors_are_relative_and_what_is_no_number_fails(values, errors, passed):
    case = judged(values)
    (item,) = case.judgements
    assert [one.error for one in item.findings] == pytest.approx(errors, rel=1e-12, nan_ok=True)
    assert case.passed is item.passed is passed
    assert item.verdict is (Verdict.RIGHT if passed else Verdict.WRONG)
    assert (item.failure is None) is passed


def test_a_failure_names_the_worst_quantity_with_its_numbers():
    case = judged((2.1, 1.0), (math.nan, 1.0), StoppedError("CUTBACK_FLOOR: too small"))
    first, second, third = (item.failure for item in case.judgements)
    assert first == "|b|: 1, exact 0, error 0.25 > 0.01"
    assert second is not None
    assert second.startswith("a: nan, exact 2")
    assert third == "CUTBACK_FLOOR: too small"
    assert all(map(math.isnan, case.judgements[2].values))
    assert case.judgements[2].verdict is Verdict.STOPPED


def test_a_model_must_answer_every_quantity():
    with pytest.raises(ValueError, match="argument 2 is shorter"):
        judged((2.0,))


def test_one_junit_check_for_each_case_and_model():
    case = judged((2.0, 0.0), (3.0, 0.0))
    passed, failed = junit_cases([case])
    assert passed.failure is None
    assert failed.failure == "a: 3, exact 2, error 0.5 > 0.01"
    assert passed.classname == failed.classname == "manual.made-up"


def test_the_page_has_every_answer_and_escapes_bars():
    case = judged((2.0, 0.0), (3.0, 0.0), StoppedError("LOST: gone"))
    page = markdown([case])
    assert "1 problems with exact answers" in page
    assert "1 of 3 answers within their tolerances" in page
    assert page.count("**FAILED**") == 4
    assert "Stopped: LOST: gone" in page
    assert "![Made | up](made-up.svg)" in page
    tables = [line for line in page.splitlines() if line.startswith("|")]
    widths = {len(re.findall(r"(?<!\\)\|", line)) for line in tables}
    assert widths == {9, 6}


QUICK = (dead_load, identity)


def test_a_manual_of_two_cases(tmp_path: Path):
    lines: list[str] = []
    manual = write_manual(tmp_path / "new", lines.append, QUICK)
    assert manual.passed
    assert [case.problem.name for case in manual.cases] == ["dead-load", "elastica-identity"]
    assert len(lines) == 2
    assert sorted(path.name for path in (tmp_path / "new").glob("[!.]*")) == sorted(
        path.name for path in manual.files
    )
    for case in manual.cases:
        picture = ET.parse(tmp_path / "new" / case.picture)  # noqa: S314 our own file
        assert picture.getroot().tag.endswith("svg")
    data = json.loads((tmp_path / "new" / "manual.json").read_text())
    assert data["passed"] is True
    run = data["cases"][0]["runs"][0]
    assert run["passed"] is True
    assert run["values"] == pytest.approx([0.3017207738, 0.4934574804, 0.7137915236, 0.8106090249], abs=3e-9)
    page = (tmp_path / "new" / "index.md").read_text()
    for target in re.findall(r"\]\(#(.*?)\)", page):
        assert f'<a id="{target}"></a>' in page
    assert set(re.findall(r"\]\((\S+\.svg)\)", page)) == {case.picture for case in manual.cases}


def spoilt(state):
    """The problem with its first exact value off by a hundredth."""

    def wrong() -> Problem:
        right = state()
        first, *others = right.quantities
        return replace(right, quantities=(replace(first, exact=1.01 * first.exact), *others))

    return wrong


def test_a_wrong_value_ends_the_command_with_status_1(tmp_path: Path, monkeypatch, capsys):
    monkeypatch.setattr(manual_problems, "PROBLEMS", {"dead-load": spoilt(dead_load), "roll-up": roll_up})
    junit = tmp_path / "junit.xml"
    assert main(["manual", "--out", str(tmp_path / "m"), "--junit", str(junit), "--quiet"]) == 1
    reported = capsys.readouterr()
    assert "2 cases, 6 answers, 3 beyond their tolerance" in reported.out
    assert str(junit) in reported.out
    for line in reported.err.splitlines():
        assert re.fullmatch(r"crossval: dead-load, tsm .*: v/L .*, exact 0\.304\d*, error .* > .*", line)
    assert len(reported.err.splitlines()) == 3
    root = ET.parse(junit).getroot()  # noqa: S314 our own file
    assert root.get("failures") == "3"
    assert len(root.findall("testcase")) == 6
    assert json.loads((tmp_path / "m" / "manual.json").read_text())["passed"] is False


def test_what_passes_ends_with_status_0(tmp_path: Path, capsys):
    names = ["dead-load", "elastica-identity"]
    assert main(["manual", "--out", str(tmp_path), "--only", *names]) == 0
    reported = capsys.readouterr()
    assert "2 cases, 5 answers, 0 beyond their tolerance" in reported.out
    assert [line.split(",")[0] for line in reported.err.splitlines()] == [
        "dead-load: passed",
        "elastica-identity: passed",
    ]


def test_a_name_that_no_problem_has_is_bad_input(tmp_path: Path, capsys):
    assert main(["manual", "--out", str(tmp_path / "m"), "--only", "roll-up", "rollup"]) == 2
    assert capsys.readouterr().err.startswith(
        "crossval: --only: rollup: no such problem (dead-load, roll-up, "
    )
    assert not (tmp_path / "m").exists()


def test_a_scene_that_is_moved_is_the_scene():
    """Turned by a quarter, mirrored, reversed: beams, pins and sides are where they must be."""
    scene = ks("ks-face", 4)
    turned = moved(scene, math.pi / 2, (1.0, 2.0))
    assert turned.beams[0].end == pytest.approx((1.0, 3.0), abs=1e-15)
    assert turned.pins[0].points[0] == pytest.approx((1.01, 3.0), abs=1e-15)
    assert turned.contacts == scene.contacts
    image = mirrored(scene)
    assert image.pins[0].points[1] == (0.0, 0.01 - 0.6366197723675814)
    assert image.contacts[0].side == reversed_(scene).contacts[0].side == "left"
    assert reversed_(scene).beams[0].clamped == ("end",)
    moments = [solve(one, "rod").supports["cantilever.start"].moment for one in (scene, turned, image)]
    assert moments[1] == pytest.approx(moments[0], rel=1e-9)
    assert moments[2] == pytest.approx(-moments[0], rel=1e-12)


FAST = {
    "clamped-column",
    "euler-column",
    "force-limit",
    "pinned-column",
    "portal-frame",
    "post-buckling",
    "sleeve",
    "three-point-bending",
    "touch-again",
    "two-pins",
}
"""Problems of less than a second; the golden answers have three more."""


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] * (name not in FAST)) for name in PROBLEMS]
)
def test_a_problem_of_the_table_passes(name: str):
    """Every exact value is finite, every trial has a colour, a tolerance and its reason."""
    case, _ = answered(PROBLEMS[name](), "p.svg")
    assert [item.failure for item in case.judgements if not item.passed] == []
    assert case.problem.name == name
    for quantity in case.problem.quantities:
        assert math.isfinite(quantity.exact)
        assert quantity.exact or quantity.scale
    for trial in case.problem.trials:
        assert trial.model in STYLES
        assert 0.0 < trial.allowance.error <= 0.3
        assert trial.allowance.why


def test_the_page_counts_the_problems(stated):
    stated("manual.problems", len(PROBLEMS))

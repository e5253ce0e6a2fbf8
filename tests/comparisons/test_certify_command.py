"""``crossval certify``: scenes and stored responses, the verdict and the exit status."""

import json
from pathlib import Path

import pytest

from comparisons.cli import main
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.referee import certify
from comparisons.response.from_json import read_response
from comparisons.response.to_json import as_json
from comparisons.scene import load_scene

PAIR = "pin->cantilever"


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("stored") / "answer.json"
    path.write_text(
        as_json(solve(load_scene("ks-cantilever"), "tsm", Options(elements=10))), encoding="utf-8"
    )
    return path


def changed(stored: Path, change: object) -> Path:
    data = json.loads(stored.read_text(encoding="utf-8"))
    change(data)  # type: ignore[operator]
    path = stored.with_name("changed.json")
    path.write_text(json.dumps(data), encoding="utf-8")
    return path


def test_a_scene_is_solved_and_certified(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["certify", "cantilever-critical-area", "--elements", "18"]) == 0
    out = capsys.readouterr().out
    assert "CERTIFIED" in out
    assert "index 0" in out


def test_a_stored_response_is_judged_as_the_response_itself(
    stored: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = load_scene("ks-cantilever")
    assert main(["certify", str(stored), "--json", "-"]) == 0
    read = json.loads(capsys.readouterr().out)
    whole = certify(solve(scene, "tsm", Options(elements=10)), scene)
    assert read["verdict"] == "CERTIFIED"
    for name in ("force", "arc_position", "reaction", "tip"):
        assert read["judged"][-1]["distance"][name] == pytest.approx(
            getattr(whole.judged[-1].distance, name), rel=1e-6
        )
    exact = whole.judged[-1].exact.contacts[PAIR]
    assert read["judged"][-1]["exact"]["contacts"][PAIR]["arc_position"] == pytest.approx(
        exact.arc_position, rel=1e-13
    )


def test_a_forged_file_is_a_wrong_answer(stored: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def forge(data: dict) -> None:
        data["tips"]["cantilever"] = [[x + 7.0, y] for x, y in data["tips"]["cantilever"]]

    assert main(["certify", str(changed(stored, forge))]) == 1
    assert "NOT_AN_EQUILIBRIUM: tip off by 7" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda data: data.pop("axes"), "axes = (missing): must be a table"),
        (
            lambda data: data["contacts"][PAIR].update(force=[1.0]),
            "force = [1.0]: must be a list of 50 numbers, one for each load parameter, has 1",
        ),
        (
            lambda data: data.update(load_parameter="x"),
            'load_parameter = "x": must be a list of numbers',
        ),
        (
            lambda data: data["axes"]["cantilever"]["arc_length"].reverse(),
            "must be two or more increasing numbers",
        ),
        (lambda data: data.update(scene="nowhere"), "nowhere: no such file or built-in scene"),
    ],
)
def test_a_damaged_file_is_one_line(
    stored: Path, change: object, reason: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["certify", str(changed(stored, change))]) == 2
    error = capsys.readouterr().err
    assert reason in error
    assert error.count("\n") == 1


def test_what_does_not_belong_together_is_refused(stored: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["certify", str(stored), "--elements", "3"]) == 2
    assert "--elements: belongs to a scene" in capsys.readouterr().err
    assert main(["certify", "ks-cantilever", "--scene", "ks-face"]) == 2
    assert "--scene: belongs to a response" in capsys.readouterr().err


def test_a_response_read_back_is_the_response(stored: Path) -> None:
    own, read = solve(load_scene("ks-cantilever"), "tsm", Options(elements=10)), read_response(str(stored))
    assert list(read.contacts[PAIR].force) == list(own.contacts[PAIR].force)
    assert read.contacts[PAIR].vector.tolist() == own.contacts[PAIR].vector.tolist()
    assert read.events == own.events
    arc, line = read.axis_line("cantilever", 49)
    assert len(arc) == 101
    assert line[-1].tolist() == own.axis_line("cantilever", 49)[1][-1].tolist()

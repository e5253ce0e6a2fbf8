"""``crossval certify``: scenes and stored responses, the verdict and the exit status."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from comparisons.cli import main
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.referee import certify
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


def forged(**tables: object) -> Callable[[dict[str, Any]], None]:
    return lambda data: data.update(tables)


def inside(*path: str | int, value: object) -> Callable[[dict[str, Any]], None]:
    """Return what puts a value at the end of a path of keys and numbers."""

    def change(data: Any) -> None:
        for key in path[:-1]:
            data = data[key]
        data[path[-1]] = value

    return change


DAMAGED: dict[str, tuple[Callable[[dict[str, Any]], object], str]] = {
    "no axes": (lambda data: data.pop("axes"), "axes = (missing): must be a table"),
    "empty axes": (forged(axes={}), "axes: must have cantilever, has none"),
    "empty tips": (forged(tips={}), "tips: must have cantilever, has none"),
    "no status": (lambda data: data.pop("status"), "status = (missing): must be given"),
    "a renamed beam": (
        lambda data: data["axes"].update(column=data["axes"].pop("cantilever")),
        "axes: must have cantilever, has column",
    ),
    "a short list": (
        inside("contacts", PAIR, "force", value=[1.0]),
        "force = [1.0]: must be a list of 50 numbers, one for each load parameter, has 1",
    ),
    "no list": (forged(load_parameter="x"), 'load_parameter = "x": must be a list of numbers'),
    "texts": (inside("contacts", PAIR, "force", 0, value="1.5"), "must be a list of 50 numbers"),
    "a truth value": (inside("tips", "cantilever", 3, 0, value=True), "must be a list of 50 x 2 numbers"),
    "no number": (
        inside("supports", "cantilever.start", "moment", 7, value=None),
        "supports.cantilever.start.moment[7] = nan: must be a finite number",
    ),
    "no gap at a closed contact": (
        inside("contacts", PAIR, "gap", 20, value=None),
        "gap[20] = nan: must be a finite number",
    ),
    "a huge whole number": (forged(cutbacks=10**40), "must be a whole number"),
    "a huge place": (inside("contacts", PAIR, "slip_off", value=10**400), "slip_off = 1"),
    "half a whole number": (forged(index=[0.5] * 50), "index = [0.5"),
    "a falling arc": (
        lambda data: data["axes"]["cantilever"]["arc_length"].reverse(),
        "must be two or more increasing numbers",
    ),
    "no such scene": (forged(scene="nowhere"), "nowhere: no such file or built-in scene"),
    "another scene": (forged(scene="double-beam"), "load_parameter: must be those of the scene"),
    "a misspelt key": (
        lambda data: data.update(evnts=data.pop("events")),
        "unknown key, did you mean events?",
    ),
    "half an answer": (
        lambda data: data.update(halved(data)),
        "load_parameter: has 25 of 50 load parameters, and the status is COMPLETED",
    ),
}


def halved(data: Any) -> Any:
    if isinstance(data, dict):
        return {key: halved(value) for key, value in data.items()}
    return data[:25] if isinstance(data, list) and len(data) == 50 else data


def refused(arguments: list[str], reason: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["certify", *arguments]) == 2
    out, error = capsys.readouterr()
    assert out == ""
    assert reason in error
    assert error.startswith("crossval: ")
    assert (error.count("\n"), len(error) < 800) == (1, True)


@pytest.mark.parametrize("damage", DAMAGED)
def test_a_damaged_file_is_one_line(stored: Path, damage: str, capsys: pytest.CaptureFixture[str]) -> None:
    change, reason = DAMAGED[damage]
    refused([str(changed(stored, change))], reason, capsys)


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (lambda text: text[: len(text) // 2], "must be valid JSON: "),
        (lambda _: "", "must be valid JSON: "),
        (lambda _: "[" * 100_000, "must be valid JSON: "),
        (lambda _: '{"status": ' + "[" * 900 + "]" * 900 + "}", "must be"),
        (lambda _: "[1, 2]", "file = [1, 2]: must be a table"),
        (lambda _: "\x1b[31m", "must be valid JSON: "),
        (lambda text: " " * 17_000_000 + text, "has more than 16 MB"),
        (lambda text: text.rstrip()[:-1] + ', "cutbacks": 0}', "cutbacks = 0: must stand once in its table"),
        (lambda text: text.replace("0.02", "1e400", 1), "load_parameter[0] = inf: must be a finite number"),
        (lambda text: text.replace("0.02", "NaN", 1), "load_parameter[0] = nan: must be a finite number"),
        (lambda text: text.replace("0.02", "1" * 5000, 1), "must be valid JSON: "),
    ],
)
def test_a_file_that_is_no_table_of_numbers_is_one_line(
    stored: Path, damage: Callable[[str], str], reason: str, capsys: pytest.CaptureFixture[str]
) -> None:
    text = stored.read_text(encoding="utf-8")
    path = stored.with_name("damaged.json")
    path.write_text(damage(text), encoding="utf-8")
    assert path.read_text(encoding="utf-8") != text
    refused([str(path)], reason, capsys)


def test_an_answer_to_another_scene_is_one_line(stored: Path, capsys: pytest.CaptureFixture[str]) -> None:
    reason = "scene = ks-cantilever: the scene was ks-friction"
    refused([str(stored), "--scene", "ks-friction"], reason, capsys)


def test_what_does_not_belong_together_is_refused(stored: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["certify", str(stored), "--elements", "3"]) == 2
    assert "--elements: belongs to a scene" in capsys.readouterr().err
    assert main(["certify", "ks-cantilever", "--scene", "ks-face"]) == 2
    assert "--scene: belongs to a response" in capsys.readouterr().err

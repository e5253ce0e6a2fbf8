"""The whole comparison on a short path."""

import csv
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from comparisons import compare as compared
from comparisons import models
from comparisons.cli import main
from comparisons.compare import PAPER, RUNS, Comparison, compare
from comparisons.files import WRITTEN
from comparisons.models.options import Options
from comparisons.response import Response
from comparisons.scene import Scene, built_in_scenes, load_scene, read_scene, to_toml
from comparisons.scene.keys import special_keys
from comparisons.show.table import Row

PAIR = "pin->cantilever"
KS = replace(load_scene("ks-cantilever"), load_parameters=10)
FILES = {
    "summary.json", "table.csv", "shapes.png", "shapes.svg", "side-by-side.png", "tsm/tsm.pvd", "solid/solid.pvd",
    "budget.png", "budget.svg", "budget.json", "report.html",
}  # fmt: skip


@pytest.mark.slow
def test_compare_writes_every_file_and_the_same_numbers(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene, out = tmp_path / "short.toml", tmp_path / "out"
    scene.write_text(to_toml(KS))
    assert main(["compare", str(scene), "--out", str(out)]) == 0
    printed, progress = capsys.readouterr()
    assert {
        str(path.relative_to(out))
        for path in out.rglob("*")
        if path.suffix not in (".vtu", ".vtm") and path.is_file() and path.name != WRITTEN
    } == FILES
    assert len(list(out.rglob("*.vtm"))) == 20
    assert len(list(out.rglob("*.vtu"))) == 60
    for name in FILES:
        assert str(out / name) in printed
    for number, run in enumerate(RUNS, 1):
        assert f"[{number}/{len(RUNS)}] {run.label}: " in progress
        assert f"\n{run.label} " in printed
    assert progress.endswith("measuring the error budget\ndrawing and writing files\n")
    data = json.loads((out / "summary.json").read_text())
    assert set(data["files"]) == FILES
    assert read_scene(data["scene_file"], "summary") == KS
    by_label = {run["label"]: run for run in data["runs"]}
    rows = {row["label"]: row for row in csv.DictReader((out / "table.csv").read_text().splitlines())}
    assert set(by_label) == set(rows) == {run.label for run in RUNS}
    for label, run in by_label.items():
        assert run["status"] == "COMPLETED"
        if run["errors"] is not None:
            assert run["errors"]["path"]["force"] == float(rows[label]["error_path_force"])
    force = {label: run["errors"]["end"]["force"] for label, run in by_label.items() if run["errors"]}
    assert [force[run.label] < bar for run, bar in zip(PAPER, (1e-2, 3e-3, 6e-4), strict=True)] == [True] * 3
    assert force["TSM mixed, 10 elements"] < 1e-4
    assert force["TSM mixed, 20 elements"] < 5e-6
    assert force["solid"] < 6e-3


@pytest.mark.slow
def test_a_model_that_cannot_state_the_scene_is_left_out(tmp_path: Path) -> None:
    beam = replace(KS.beams[0], width=None, height=None, area=4e-4, second_moment=4e-6 / 3.0)
    lines: list[str] = []
    found = compare(replace(KS, beams=(beam,), load_parameters=2), tmp_path, lines.append)
    assert "solid" not in {row.label for row in found.rows}
    assert any("solid: left out, solid: the solid model needs" in line for line in lines)
    assert any(line.startswith("side-by-side.png: left out") for line in lines)
    assert any(line.startswith("budget.json: left out") for line in lines)
    assert not (tmp_path / "solid").exists()
    assert (tmp_path / "tsm" / "tsm.pvd").is_file()


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in built_in_scenes() if any(special_keys(load_scene(name)))])
def test_scenes_with_special_keys_are_compared(name: str, tmp_path: Path) -> None:
    found = compare(load_scene(name), tmp_path, print)
    rods = [row for row in found.rows if row.label == "TSM exact, 1 element"]
    assert all(row.errors and row.errors["path"]["tip"] < 1e-8 for row in rods)
    assert len(rods) == 1


@pytest.mark.slow
def test_a_run_that_stops_is_named_and_the_rest_goes_on(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pin = replace(KS.pins[0], start=(0.9, 0.0), displacement=(0.0, 0.6))
    scene = tmp_path / "slip.toml"
    contact = replace(KS.contacts[0], keep=True)
    scene.write_text(to_toml(replace(KS, pins=(pin,), contacts=(contact,), load_parameters=4)))
    assert main(["compare", str(scene), "--out", str(tmp_path / "out")]) == 3
    printed, progress = capsys.readouterr()
    assert "crossval: solid: LOST_CONTACT" in progress
    assert "solid (LOST_CONTACT)" in printed
    assert (tmp_path / "out" / "summary.json").is_file()


@pytest.mark.slow_at("False-True-")
@pytest.mark.parametrize(
    ("other", "refereed", "status"),
    [
        (False, True, ""),
        (True, True, "NOT_AN_EQUILIBRIUM: reaction"),
        (True, False, "OTHER_BRANCH: ends in another equilibrium than the exact rod"),
    ],
)
def test_models_on_different_branches_end_with_status_3(
    other: bool,
    refereed: bool,
    status: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Beams bent to the other side under the same force, which the referee sees, and so does the comparison without it."""
    scene = tmp_path / "short.toml"
    scene.write_text(to_toml(replace(KS, load_parameters=2)))

    def answer(scene: Scene, model: str, *more: Any) -> Response:
        response = models.solve(scene, model, *more)
        if model != "tsm" or not other:
            return response
        support = response.supports["cantilever.start"]
        return replace(response, supports={"cantilever.start": replace(support, moment=-support.moment)})

    monkeypatch.setattr(compared, "RUNS", (compared.MIXED, compared.ROD))
    monkeypatch.setattr(compared, "solve", answer)
    monkeypatch.setattr(compared, "_write_picture", lambda *_: [])
    if not refereed:
        monkeypatch.setattr(compared, "certified", lambda response, _: response)
    ended = main(["compare", str(scene), "--out", str(tmp_path / "out"), "--quiet"])
    said = capsys.readouterr().err
    assert ended == (3 if other else 0)
    assert (
        said.startswith(f"crossval: TSM mixed, 20 elements: {status}") if other else "BRANCH" not in said
    ), said


def test_a_scene_without_exact_rods_is_refused_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The errors of all models are measured against the exact rods, which follow the path of beams."""
    leaf = load_scene("tapered-spring")
    rubbed = replace(
        leaf, contacts=tuple(replace(one, surface="face", friction=0.2) for one in leaf.contacts)
    )
    scene, out = tmp_path / "rubbed.toml", tmp_path / "out"
    scene.write_text(to_toml(rubbed))
    assert main(["compare", str(scene), "--out", str(out)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "errors are measured against the exact rod; contact " in line
    assert not out.exists()


def test_an_event_that_the_reference_does_not_have_is_a_line() -> None:
    """The first one of each completed run, and none where the events are the same."""
    true = models.solve(
        replace(load_scene("touch-again"), load_parameters=4), "tsm", Options(element="exact")
    )
    assert true.events is not None
    touch = replace(true.events[0], load_parameter=0.25)
    more = replace(true, events=(touch, *true.events))
    rows = [
        Row(label=label, response=response, errors=None)
        for label, response in (("exact rod", true), ("same", true), ("other", more))
    ]
    assert Comparison(rows=rows, files=[]).other_events == [
        "other has a touch of pin->cantilever at load parameter 0.25, which exact rod does not have"
    ]

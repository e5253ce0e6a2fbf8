"""Comparisons that leave something out, stop, or find models on different branches; `report/pages` has a whole one."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from comparisons import models
from comparisons.answer import Response
from comparisons.cli import main
from comparisons.models.model import Options
from comparisons.scene import Scene, load_scene, to_toml
from comparisons.suites import compare as compared
from comparisons.suites.compare import ROD, compare
from tests.comparisons.report.pages.markup import check_alone

KS = load_scene("ks-cantilever")


@pytest.fixture
def short(in_folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A scene file that a comparison of beams and rods alone is quick for."""
    monkeypatch.setattr(compared, "RUNS", (compared.MIXED, compared.ROD))
    path = Path("short.toml")
    path.write_text(to_toml(replace(KS, load_parameters=2)))
    return path


@pytest.mark.slow
def test_a_model_that_cannot_state_the_scene_is_left_out(tmp_path):
    beam = replace(KS.beams[0], width=None, height=None, area=4e-4, second_moment=4e-6 / 3.0)
    lines: list[str] = []
    found = compare(replace(KS, beams=(beam,), load_parameters=2), tmp_path, lines.append)
    found.write(tmp_path)
    assert "solid" not in {row["label"] for row in found.files["table.csv"]}
    for left_out in (
        "solid: left out, the solid model needs",
        "stress.svg: left out",
        "budget.json: left out",
    ):
        assert any(left_out in line for line in lines)
    assert not (tmp_path / "solid").exists()
    assert (tmp_path / "tsm" / "tsm.pvd").is_file()


@pytest.mark.slow
def test_a_run_that_stops_is_named_and_the_rest_goes_on(in_folder, capsys):
    pin = replace(KS.pins[0], start=(0.9, 0.0), displacement=(0.0, 0.6))
    contact = replace(KS.contacts[0], keep=True)
    Path("slip.toml").write_text(to_toml(replace(KS, pins=(pin,), contacts=(contact,), load_parameters=4)))
    assert main(["compare", "slip.toml", "--out", "out"]) == 3
    printed, progress = capsys.readouterr()
    assert "crossval: solid: LOST_CONTACT" in progress
    assert "solid (LOST_CONTACT)" in printed
    assert Path("out/summary.json").is_file()


@pytest.mark.parametrize(
    ("refereed", "told"),
    [
        (True, "NOT_AN_EQUILIBRIUM: reaction"),
        (False, "OTHER_BRANCH: ends in another equilibrium than the exact rod"),
    ],
)
def test_models_on_different_branches_end_with_status_3(refereed, told, short, monkeypatch, capsys):
    """Beams bent to the other side under the same force, which the referee sees, and so does the comparison without it."""

    def answer(scene: Scene, model: str, *more: Any) -> Response:
        response = models.solve(scene, model, *more)
        if model != "tsm":
            return response
        support = response.supports["cantilever.start"]
        return replace(response, supports={"cantilever.start": replace(support, moment=-support.moment)})

    monkeypatch.setattr(compared, "solve", answer)
    if not refereed:
        monkeypatch.setattr(compared, "certified", lambda response, _: response)
    assert main(["compare", str(short), "--out", "out", "--quiet"]) == 3
    assert capsys.readouterr().err.startswith(f"crossval: TSM mixed, 20 elements: {told}")
    out = Path("out")
    check_alone((out / "report.html").read_text(), out)
    assert [
        name for name in json.loads((out / "summary.json").read_text())["files"] if not (out / name).is_file()
    ] == []


LINE = f"{compared.MIXED.label} has a touch of pin->cantilever at load parameter 0.25, which {ROD.label} does not have"


def test_an_event_that_the_reference_does_not_have_is_a_line(short, monkeypatch):
    """The first one of each completed run, and none where the events are the same."""
    scene = replace(load_scene("touch-again"), load_parameters=4)
    true = models.solve(scene, "tsm", Options(element="exact"))
    touch = replace(true.events[0], load_parameter=0.25)
    answers = {"rod": true, "tsm": replace(true, events=(touch, *true.events))}
    monkeypatch.setattr(compared, "solve", lambda _, model, *_more: answers[model])
    monkeypatch.setattr(compared, "certified", lambda response, _: response)
    found = compare(scene, Path("out"), lambda _: None)
    *_, blank, line = found.text.splitlines()
    assert (blank, line) == ("", LINE)


def test_a_scene_without_exact_rods_is_refused_in_one_line(short, capsys):
    """The errors of all models are measured against the exact rods, which follow the path of beams."""
    leaf = load_scene("tapered-spring")
    contacts = tuple(replace(one, surface="face", friction=0.2) for one in leaf.contacts)
    short.write_text(to_toml(replace(leaf, contacts=contacts)))
    assert main(["compare", str(short), "--out", "out"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "errors are measured against the exact rod; contact " in line
    assert not Path("out").exists()

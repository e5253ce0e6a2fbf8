"""The league: what is run, how it ends, what is stored, and its files."""

import csv
import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from comparisons.cases.workers import local
from comparisons.cli import main
from comparisons.league import entries as league_entries
from comparisons.league.entries import MOST, measure_league
from comparisons.scene import load_scene, to_toml
from comparisons.scene.conditions import LoadSpec
from tests.comparisons.models.outside.conftest import KS, PROGRAM, stored
from tests.comparisons.show.pages.markup import check_alone

WRONG = 'contact["force"] = [0.0 for _ in contact["force"]]'
"""What the program says in place of its forces."""


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only beams: the solid's meshes take most of the time."""
    models = {name: model for name, model in league_entries.MODELS.items() if name != "solid"}
    monkeypatch.setattr(league_entries, "MODELS", models)


@pytest.mark.slow
@pytest.mark.usefixtures("few")
def test_programs_are_measured_and_a_false_success_is_named(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    loaded = replace(
        KS,
        name="loaded",
        pins=(),
        contacts=(),
        loads=(LoadSpec(beam="cantilever", end="end", force=(0.0, 1e-4)),),
    )
    scenes = [tmp_path / "ks.toml", tmp_path / "loaded.toml"]
    for path, scene in zip(scenes, (KS, loaded), strict=True):
        path.write_text(to_toml(scene))
    (tmp_path / "truth.json").write_text(stored(KS))
    (tmp_path / "liar.py").write_text(PROGRAM.format(lines=WRONG))
    liar_file = tmp_path / "liar.toml"
    liar_file.write_text(
        f'[program]\nname = "liar"\ncommand = {json.dumps([sys.executable, "-I", "liar.py"])}\n'
    )
    out = tmp_path / "out"
    command = ["league", *map(str, scenes), "--with", str(liar_file), "--quick", "--out", str(out)]
    assert main(command) == 0
    printed = capsys.readouterr().out
    rows = list(csv.DictReader((out / "league.csv").read_text().splitlines()))
    by = {(row["scene"], row["setting"]): row for row in rows}
    ours = {key: row["outcome"] for key, row in by.items() if row["program"].startswith("TSM")}
    assert ours.pop(("ks-cantilever", "tsm timoshenko 5")) == "wrong", "a reaction off by more than 5 %"
    assert list(ours.values()) == ["certified"] * 11
    liar = by["ks-cantilever", "liar"]
    assert (liar["outcome"], liar["said_success_and_was_wrong"]) == ("wrong", "True")
    exact, coarse = by["ks-cantilever", "tsm exact 1"], by["ks-cantilever", "tsm timoshenko 5"]
    assert float(exact["error_force"]) < 1e-10
    assert float(exact["error_friction"]) < 1e-9
    assert 1e-3 < float(coarse["error_friction"]) < 1e-1
    assert float(exact["process_seconds"]) > 0.0
    assert "loaded: elastica: left out, the exact models" in printed
    [line] = (line for line in printed.splitlines() if line.startswith("liar"))
    assert line.split()[-1] == "2", "it gives the same answer to the other scene"
    numbers = json.loads((out / "league.json").read_text())
    assert ["loaded", "elastica"] in [item[:2] for item in numbers["left_out"]]
    check_alone((out / "report.html").read_text(), out)
    assert "said success and was wrong" in (out / "report.html").read_text()


@pytest.mark.slow
@pytest.mark.usefixtures("few")
def test_a_second_run_measures_nothing_again(tmp_path: Path) -> None:
    scene = replace(load_scene("ks-cantilever"), load_parameters=2)
    begun: list[list[int]] = [[], []]
    first, second = (
        measure_league(
            [scene],
            [],
            tmp_path / "results.sqlite",
            local(1),
            quick=True,
            progress=lambda tally, done=done: done.append(tally.done),  # type: ignore[misc]
        )
        for done in begun
    )
    assert str([entry.row() for entry in first.entries]) == str([entry.row() for entry in second.entries])
    assert begun[0][0] == 0
    assert begun[1] in ([], [begun[0][-1]])


def test_every_program_has_three_to_five_resolutions_or_one() -> None:
    scene = replace(load_scene("ks-cantilever"), load_parameters=2)
    for name, model in league_entries.MODELS.items():
        counts: dict[str, int] = {}
        for case, family in league_entries._cases(scene, name, model, quick=False):
            counts[family] = counts.get(family, 0) + 1
            assert np.isnan(model.resolution(case.options)) or model.resolution(case.options) > 0
        assert all(count == 1 or 3 <= count <= MOST for count in counts.values()), counts

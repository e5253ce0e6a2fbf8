"""`crossval compare` of several scenes: what is run, how it ends, and its files."""

import csv
import json
import sys
from dataclasses import replace

import pytest

from comparisons.cli import main
from comparisons.scene import BeamSpec, LoadSpec, load_scene, to_toml
from tests.comparisons.models.outside.conftest import PROGRAM, stored
from tests.comparisons.report.pages.markup import check_alone

SCENE = load_scene("ks-cantilever")
BEAM = BeamSpec(
    name="cantilever", start=(0.0, 0.0), end=(1.0, 0.0), clamped=("start",), area=SCENE.beams[0].EA,
    second_moment=SCENE.beams[0].EI, youngs_modulus=1.0, shear_modulus=SCENE.beams[0].GA / SCENE.beams[0].EA,
)  # fmt: skip
KS = replace(SCENE, beams=(BEAM,), load_parameters=5)
"""Without a height, so that the solid, whose meshes take most of the time, is left out."""
WRONG = 'contact["force"] = [0.0 for _ in contact["force"]]'
"""What the program says in place of its forces."""


@pytest.mark.slow
def test_programs_are_measured_and_a_false_success_is_named(tmp_path, capsys):
    load = LoadSpec(beam="cantilever", end="end", force=(0.0, 1e-4))
    loaded = replace(KS, name="loaded", pins=(), contacts=(), loads=(load,))
    scenes = [tmp_path / "ks.toml", tmp_path / "loaded.toml"]
    for path, scene in zip(scenes, (KS, loaded), strict=True):
        path.write_text(to_toml(scene))
    (tmp_path / "truth.json").write_text(stored(KS))
    (tmp_path / "liar.py").write_text(PROGRAM.format(lines=WRONG))
    liar_file, run = tmp_path / "liar.toml", json.dumps([sys.executable, "-I", "liar.py"])
    liar_file.write_text(f'[program]\nname = "liar"\ncommand = {run}\n')
    out = tmp_path / "out"
    assert main(["compare", *map(str, scenes), "--with", str(liar_file), "--quick", "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    found = csv.DictReader((out / "league.csv").read_text().splitlines())
    by = {(row["scene"], row["label"]): row for row in found}
    ours = {key: row["outcome"] for key, row in by.items() if row["family"].startswith("TSM")}
    assert ours.pop(("ks-cantilever", "tsm timoshenko 5")) == "wrong", "a reaction off by more than 5 %"
    assert list(ours.values()) == ["certified"] * 11
    liar = by["ks-cantilever", "liar"]
    assert liar["outcome"] == "wrong"
    exact, coarse = by["ks-cantilever", "tsm exact 1"], by["ks-cantilever", "tsm timoshenko 5"]
    assert float(exact["error_path_force"]) < 1e-10
    assert float(exact["error_path_friction"]) < 1e-9
    assert 1e-3 < float(coarse["error_path_friction"]) < 1e-1
    assert float(exact["process_seconds"]) > 0.0
    assert "loaded: elastica: left out, the exact models" in printed
    [line] = (line for line in printed.splitlines() if line.startswith("liar"))
    assert line.split()[-1] == "2", "it gives the same answer to the other scene"
    numbers = json.loads((out / "league.json").read_text())
    left_out = [item[:2] for item in numbers["left_out"]]
    assert left_out == [["ks-cantilever", "solid"], ["loaded", "solid"], ["loaded", "elastica"]]
    html = (out / "report.html").read_text()
    check_alone(html, out)
    assert "said success and was wrong" in html

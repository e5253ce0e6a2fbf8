"""A new quantity is one row: the table, the files and the page of a comparison, the bounds and the documentation have it."""

import csv
import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from comparisons.answer.quantities import QUANTITIES, Quantity
from comparisons.cli import main
from comparisons.scene import load_scene, to_toml

# the registry, and the runs of a comparison, of which two are enough here
from comparisons.suites import compare
from docs.extensions import generated


def rises(response):
    return {beam: tip[:, 1] for beam, tip in response.tips.items()}


ROW = Quantity(
    meaning="rise of the tips over the length", words="rise", column=6, read=rises, drawn=lambda response, _: rises(response)
)  # fmt: skip


@pytest.fixture
def scene(in_folder, monkeypatch):
    monkeypatch.setitem(QUANTITIES, "rise", ROW)
    monkeypatch.setattr(compare, "RUNS", (compare.MIXED, compare.ROD))
    Path("short.toml").write_text(to_toml(replace(load_scene("ks-cantilever"), load_parameters=2)))
    return "short.toml"


def test_every_place_has_a_new_quantity(scene, capsys):
    assert main(["compare", scene, "--out", "out", "--quiet"]) == 0
    table, page = capsys.readouterr().out, Path("out/report.html").read_text().replace("\u2011", "-")
    assert re.search(r" friction +rise +stable ", table)
    run, _ = json.loads(Path("out/summary.json").read_text())["runs"]
    row, _ = csv.DictReader(Path("out/table.csv").read_text().splitlines())
    error = run["errors"]["path"]["rise"]
    assert 0.0 < error < 1e-5
    assert float(row["error_path_rise"]) == error
    assert f"{error:.1e}" in table
    assert f">{error:.1e}<" in page
    assert "rise [m]" in page
    assert "over the length" in page
    for bound, status in ((2.0 * error, 0), (0.5 * error, 1)):
        line = f"compare {scene} --elements 20 --element mixed --max-error rise={bound}"
        assert main(line.split()) == status
        assert f"  rise {error:13.3g}  " in capsys.readouterr().out
    assert "| `rise` | length | rise of the tips over the length |" in generated.PAGES["quantities.md"]()
    with pytest.raises(SystemExit):
        main(["compare", "--help"])
    assert "rise" in capsys.readouterr().out.rpartition("--max-error")[2].partition("--against")[0]

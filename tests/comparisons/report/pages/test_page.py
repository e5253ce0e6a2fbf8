"""A comparison and its page: every file, the same numbers in all of them, whole markup, nothing from elsewhere."""

import csv
import json
import re
from dataclasses import replace
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from comparisons.answer.errors import error_columns, errors
from comparisons.models import MODELS, solve
from comparisons.report.brief import Brief  # of markup
from comparisons.report.motion import motion_section, tracks  # of answers that no comparison has
from comparisons.report.pages import Section, page, table, whole
from comparisons.scene import read_scene
from comparisons.suites.compare import RUNS
from tests.comparisons.report.pages.conftest import KS
from tests.comparisons.report.pages.markup import block, check_alone

FILES = {
    "report.html", "summary.json", "table.csv", "shapes.png", "stress.svg", "tsm/tsm.pvd", "solid/solid.pvd",
    "budget.svg", "budget.json",
}  # fmt: skip
LABELS = [run.label for run in RUNS]


def summarised(folder: Path) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    """The summary, and its runs by label."""
    summary = json.loads((folder / "summary.json").read_text())
    return summary, {run["label"]: run for run in summary["runs"]}


@pytest.mark.slow
def test_a_comparison_writes_every_file_and_names_it(compared):
    folder = compared.folder
    there = {str(path.relative_to(folder)) for path in folder.rglob("[!.]*") if path.is_file()}
    blocks = sorted(name[-3:] for name in there - FILES)
    assert there >= FILES
    assert blocks == ["vtm"] * 2 * len(KS.times) + ["vtu"] * 6 * len(KS.times)
    assert [name for name in FILES if str(folder / name) not in compared.printed] == []
    for number, label in enumerate(LABELS, 1):
        assert f"[{number}/{len(RUNS)}] {label}: " in compared.progress
        assert f"\n{label} " in compared.printed


@pytest.mark.slow
def test_summary_table_and_page_have_the_same_numbers(compared):
    folder = compared.folder
    summary, runs = summarised(folder)
    assert set(summary["files"]) == FILES
    assert read_scene(summary["scene_file"], "summary") == KS
    rows = {row["label"]: row for row in csv.DictReader((folder / "table.csv").read_text().splitlines())}
    (data,) = block((folder / "report.html").read_text()).values()
    assert list(runs) == list(rows) == LABELS
    assert {run["label"] for run in data["runs"]} == set(LABELS)
    drawn = dict(zip(("force", "arc", "moment", "friction"), data["tracks"], strict=True))
    for label, run in runs.items():
        assert run["status"] == "COMPLETED"
        assert data["load_parameter"] == run["load_parameter"]
        contact = run["contacts"]["pin->cantilever"]
        assert drawn["force"]["values"][label] == contact["force"]
        assert drawn["arc"]["values"][label] == contact["arc_position"]
        assert drawn["moment"]["values"][label] == run["supports"]["cantilever.start"]["moment"]
        friction = np.array(run["material_force"]["cantilever"]) / contact["force"]
        assert drawn["friction"]["values"][label] == pytest.approx(friction)
        if run["errors"]:
            for name, track in drawn.items():
                assert max(track["errors"][label]) == run["errors"]["path"][name]
            assert run["errors"]["path"]["force"] == float(rows[label]["error_path_force"])
    for line in data["runs"]:
        tips = [lines[0][-1] for lines in line["lines"]]
        assert np.allclose(tips, runs[line["label"]]["tips"]["cantilever"], rtol=0.0, atol=1e-5)
        assert {len(lines[0]) for lines in line["lines"]} == {41}


@pytest.mark.slow
def test_a_page_is_alone_and_begins_with_the_findings(compared):
    html, (_, runs) = (compared.folder / "report.html").read_text(), summarised(compared.folder)
    check_alone(html, compared.folder)
    assert html.count('href="tsm/tsm.pvd"') == html.count('href="solid/solid.pvd"') == 1
    (data,) = block(html).values()
    for pattern in data["vtu"].values():
        linked = [compared.folder / pattern.replace("{}", f"{k + 1:04d}") for k in range(len(KS.times))]
        assert all(file.is_file() for file in linked)
    lead = re.search(r'<p class="lead"><strong>(.*?)</strong></p>', html, re.DOTALL)
    points = re.findall(r"<li>(.*?)</li>", html[lead.end() : html.index("<table")])
    worst = max(runs["solid"]["errors"]["path"][name] for name in ("force", "arc", "moment", "tip"))
    assert lead[1].startswith(
        "Beam and solid differ in the contact force by 0.38\u00a0% of its largest value, most of it by the material law ("
    )
    assert f"solid Q2 ({100 * worst:.2g}\u00a0%)" in points[0]
    assert points[-1].startswith("The referee, an independent solver, certified every answer.")
    assert len(points) <= 5
    lines = " ".join(compared.printed.split("\n\n")[0].split())
    assert whole(lines) == unescape(" - ".join([lead[1], *points])), "the terminal says the same"


def test_text_is_escaped_and_data_cannot_end_the_script():
    sections = [
        Section(
            title="A & B <x>", html=table("<c>", [{"<h>": "<r>", "n": 0.123456}, {"<h>": "s", "n": None}])
        ),
        Section(title="data", html="", data={"text": "</script><b>", "nan": np.array([np.nan, 1.0])}),
    ]
    html = page("<t>", Brief("a < b"), sections)
    check_alone(html, Path())
    for part in ('<section id="a-b-x"', "<td>0.123</td>", "<td>-</td>"):
        assert part in html
    assert block(html) == {"data": {"text": "</script><b>", "nan": [None, 1.0]}}


def test_a_run_that_stopped_is_shown_as_far_as_it_came():
    rod, beams = solve(KS, "rod"), solve(KS, "tsm")
    cut, none = (replace(beams, load_parameter=beams.load_parameter[:k]) for k in (2, 0))
    responses = {"TSM mixed": cut, "exact rod": rod}
    made = tracks(responses, "exact rod", KS)
    data = motion_section("t", KS, responses, made, focus="exact rod").data
    assert [len(run["lines"]) for run in data["runs"]] == [2, len(KS.times)]
    (whole,) = error_columns(beams, rod, KS, "force").values()
    assert np.array_equal(made[0].errors["TSM mixed"], whole[:2])
    assert errors(beams, rod, KS)["path"]["force"] == whole.max()
    section = motion_section("t", KS, {"TSM mixed": none}, [], focus="TSM mixed")
    assert "No run reached" in section.html
    assert section.data is None


def test_colours_stay_apart_for_the_colour_blind():
    """Full protanopia, deuteranopia and tritanopia by Machado, Oliveira, Fernandes, IEEE TVCG 15 (2009) 1291."""
    rows = """1 0 0, 0 1 0, 0 0 1
        0.152286 1.052583 -0.204868, 0.114503 0.786281 0.099216, -0.003882 -0.048116 1.051998
        0.367322 0.860646 -0.227968, 0.280085 0.672501 0.047413, -0.011820 0.042940 0.968881
        1.255528 -0.076749 -0.178779, -0.078411 0.930809 0.147602, 0.004733 0.691367 0.303900"""
    machado = np.array(rows.replace(",", " ").split(), float).reshape(4, 3, 3)
    codes = sorted({style.colour for model in MODELS.values() for style in model.styles().values()})
    assert len(codes) == 8
    rgb = np.array([[int(code[i : i + 2], 16) for i in (1, 3, 5)] for code in codes]) / 255.0
    seen = np.clip(np.einsum("kij,mj->kmi", machado, rgb), 0.0, 1.0)
    apart = np.linalg.norm(seen[:, :, None] - seen[:, None], axis=-1)
    apart[:, np.arange(len(rgb)), np.arange(len(rgb))] = np.inf
    assert apart.min() > 0.1, apart.min(axis=(1, 2))

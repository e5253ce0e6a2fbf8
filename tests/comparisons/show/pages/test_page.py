"""What pages hold: the numbers of the other files, whole markup, nothing from elsewhere."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from comparisons.errors import error_histories, errors
from comparisons.models import MODELS, solve
from comparisons.response import SLIPS
from comparisons.scene import load_scene
from comparisons.show.pages import Section, motion_section, page, table, tracks
from comparisons.show.pages.states import band, states_section
from comparisons.show.palette import colour
from tests.comparisons.show.pages.markup import block, check_alone

KS = replace(load_scene("ks-cantilever"), load_parameters=4)


def test_supports_springs_and_hinges_are_drawn_where_their_ends_are() -> None:
    """A run that stopped keeps its last places; a run that reached nothing has the undeformed ones."""
    springs = replace(load_scene("beam-on-springs"), load_parameters=2)
    whole = solve(springs, "tsm")
    half = replace(whole, load_parameter=whole.load_parameter[:1])
    nothing = replace(whole, load_parameter=whole.load_parameter[:0])
    places = {}
    for name, focus in {"whole": whole, "half": half, "nothing": nothing}.items():
        section = motion_section(
            "Drawn", springs, {"TSM mixed": focus, "exact rod": whole}, [], focus="TSM mixed"
        )
        roller, left, right = section.data["symbols"]
        assert len(left["lines"]) == len(right["lines"]) != len(roller["lines"])
        np.testing.assert_array_equal(roller["at"], left["at"])
        places[name] = np.array([left["at"], right["at"]])
    ends = np.array([[whole.axis_line("beam", k)[1][n] for k in range(2)] for n in (0, -1)])
    np.testing.assert_allclose(places["whole"], ends, atol=1e-3)
    np.testing.assert_array_equal(places["half"], places["whole"][:, [0, 0]])
    np.testing.assert_array_equal(places["nothing"], [[[0.0, 0.0]] * 2, [[200.0, 0.0]] * 2])
    truss = replace(load_scene("hinged-truss"), load_parameters=1)
    section = motion_section("Drawn", truss, {"TSM mixed": solve(truss, "tsm")}, [], focus="TSM mixed")
    assert len(section.data["symbols"]) == len(truss.all_supports) + len(truss.hinges)


def test_the_page_of_a_comparison_holds_the_numbers_of_the_summary(compared: Path) -> None:
    html = (compared / "report.html").read_text()
    summary = json.loads((compared / "summary.json").read_text())
    assert "report.html" in summary["files"]
    (data,) = block(html).values()
    runs = {run["label"]: run for run in summary["runs"]}
    force, arc, moment, friction = data["tracks"]
    assert set(force["values"]) == set(runs) == {run["label"] for run in data["runs"]}
    for label, run in runs.items():
        assert data["load_parameter"] == run["load_parameter"]
        assert force["values"][label] == run["contacts"]["pin->cantilever"]["force"]
        assert arc["values"][label] == run["contacts"]["pin->cantilever"]["arc_position"]
        assert moment["values"][label] == run["supports"]["cantilever.start"]["moment"]
        size = np.array(run["contacts"]["pin->cantilever"]["force"])
        assert friction["values"][label] == pytest.approx(run["material_force"]["cantilever"] / size)
        if run["errors"]:
            stated = [run["errors"]["path"][name] for name in ("force", "arc", "moment", "friction")]
            assert [max(track["errors"][label]) for track in data["tracks"]] == stated
    for drawn in data["runs"]:
        tips = [lines[0][-1] for lines in drawn["lines"]]
        assert np.allclose(tips, runs[drawn["label"]]["tips"]["cantilever"], rtol=0.0, atol=1e-5)
        assert {len(lines[0]) for lines in drawn["lines"]} == {61}
        assert drawn["colour"] in {colour(drawn["label"]), "var(--ink)", "var(--grey)"}
    assert len({(run["colour"], run["dash"], run["width"]) for run in data["runs"]}) == len(runs)
    assert len({run["dash"] for run in data["runs"]}) == len(runs) - 1, "the solid is the wide one"


def test_the_page_of_a_comparison_is_alone(compared: Path) -> None:
    html = (compared / "report.html").read_text()
    check_alone(html, compared)
    for title in (
        "Errors",
        "Shapes and histories",
        "Error budget",
        "Stress",
        "Input",
        "Versions and machine",
        "Files",
    ):
        assert f">{title}</h2>" in html
    assert html.count('href="tsm/tsm.pvd"') == html.count('href="solid/solid.pvd"') == 1
    (data,) = block(html).values()
    for pattern in data["vtu"].values():
        assert all((compared / pattern.replace("{}", f"{k:04d}")).is_file() for k in range(1, 11))


def test_the_page_begins_with_the_findings(compared: Path) -> None:
    """Before any table, with the numbers of the table."""
    html = (compared / "report.html").read_text()
    lead = re.search(r'<p class="lead">(.*?)</p>', html, re.DOTALL)
    assert lead
    assert lead.start() < html.index("<table")
    runs = {run["label"]: run for run in json.loads((compared / "summary.json").read_text())["runs"]}
    worst = max(runs["solid"]["errors"]["path"][name] for name in ("force", "arc", "moment", "tip"))
    assert f"The solid Q2 is off by at most {100 * worst:.2g} %" in lead[1]
    assert "In the error budget, beams and solid differ most in the contact force" in lead[1]
    assert lead[1].endswith("The referee certified every answer.")


def test_bands_of_stick_and_slip_differ_without_colour() -> None:
    """The slip to the start is hatched."""
    scene = replace(load_scene("ks-friction"), load_parameters=4)
    beams = solve(scene, "tsm")
    states = dict.fromkeys(state for state, _, _ in band(beams, "pin->cantilever"))
    assert list(states) == [SLIPS[-1], SLIPS[1]] or set(states) == set(SLIPS.values())
    section = states_section({"TSM mixed": beams})
    assert section is not None
    legend, drawn = section.html.split('aria-label="contact states over')
    assert legend.count("<path") == 1
    assert drawn.count("<path") == 1
    assert f"{SLIPS[-1]} from 0 to " in drawn
    widths = [float(width) for width in re.findall(r'width="([\d.]+)" height="16"', drawn)]
    assert max(widths) <= 600.0


def test_text_is_escaped_and_data_cannot_end_the_script() -> None:
    sections = [
        Section(title="A & B <x>", html=table("<c>", ("<h>", "n"), [("<r>", 0.123456), ("s", None)])),
        Section(title="data", html="", data={"text": "</script><b>", "nan": np.array([np.nan, 1.0])}),
    ]
    html = page("<t>", "a < b", sections)
    check_alone(html, Path())
    assert '<section id="a-b-x"' in html
    assert "<td>0.123</td>" in html
    assert "<td>-</td>" in html
    assert block(html) == {"data": {"text": "</script><b>", "nan": [None, 1.0]}}


def test_a_run_that_stopped_is_shown_as_far_as_it_came() -> None:
    rod, beams = solve(KS, "rod"), solve(KS, "tsm")
    cut = replace(beams, load_parameter=beams.load_parameter[:2])
    responses = {"TSM mixed": cut, "exact rod": rod}
    made = tracks(responses, "exact rod", KS)
    data = motion_section("t", KS, responses, made, focus="exact rod").data
    assert [len(run["lines"]) for run in data["runs"]] == [2, 4]
    _, whole = error_histories(beams, rod, KS)
    assert np.array_equal(made[0].errors["TSM mixed"], whole["force"][:2])
    assert errors(beams, rod, KS)["path"]["force"] == whole["force"].max()


def test_nothing_reached_is_said() -> None:
    beams = solve(KS, "tsm")
    none = replace(beams, load_parameter=beams.load_parameter[:0])
    section = motion_section("t", KS, {"TSM mixed": none}, [], focus="TSM mixed")
    assert "No run reached" in section.html
    assert section.data is None


def test_colours_stay_apart_for_the_colour_blind() -> None:
    """Full protanopia, deuteranopia and tritanopia by Machado, Oliveira, Fernandes, IEEE TVCG 15 (2009) 1291."""
    machado = np.array(
        [
            np.eye(3),
            [
                [0.152286, 1.052583, -0.204868],
                [0.114503, 0.786281, 0.099216],
                [-0.003882, -0.048116, 1.051998],
            ],
            [
                [0.367322, 0.860646, -0.227968],
                [0.280085, 0.672501, 0.047413],
                [-0.011820, 0.042940, 0.968881],
            ],
            [
                [1.255528, -0.076749, -0.178779],
                [-0.078411, 0.930809, 0.147602],
                [0.004733, 0.691367, 0.303900],
            ],
        ]
    )
    codes = sorted({style.colour for model in MODELS.values() for style in model.styles().values()})
    assert len(codes) == 8
    rgb = np.array([[int(code[i : i + 2], 16) for i in (1, 3, 5)] for code in codes]) / 255.0
    seen = np.clip(np.einsum("kij,mj->kmi", machado, rgb), 0.0, 1.0)
    apart = np.linalg.norm(seen[:, :, None] - seen[:, None], axis=-1)
    apart[:, np.arange(len(rgb)), np.arange(len(rgb))] = np.inf
    assert apart.min() > 0.1, apart.min(axis=(1, 2))

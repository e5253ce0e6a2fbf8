"""One answer as a page, as columns and as a picture."""

import csv
import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from comparisons.answer import Response
from comparisons.cli import main
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.report.answer import picture  # what is drawn, before it is a file
from comparisons.scene import load_scene

EXACT = Options(element="exact")
FORCES, STRESSES = ("axial_force", "shear_force", "bending_moment"), ("tensile_stress", "compressive_stress")
ALONG = {*FORCES, *STRESSES, "displacement"}


@cache
def answer(scene: str, model: str = "tsm", load_parameters: int = 10) -> Response:
    asked = replace(load_scene(scene), load_parameters=load_parameters)
    return solve(asked, model, EXACT if model == "tsm" else None)


@pytest.mark.slow_at("two-pins")
@pytest.mark.parametrize("scene", ["two-pins", "portal-frame"])
def test_extremes_are_those_of_the_referee(scene):
    """Elements with 100 stations a beam, and the referee's own equations with 401: equal to the sixth digit."""
    own, other = answer(scene).table(), answer(scene, "rod").table()
    assert own.keys() == other.keys()
    columns = [name for name in own if name.partition(".")[2] in ALONG]
    assert columns
    for name in columns:
        np.testing.assert_allclose(own[name], other[name], rtol=0, atol=1e-7 * np.abs(other[name]).max())


def test_extremes_of_the_solid_reach_its_clamps():
    """The reaction is the section force at a clamp, where the stress of the solid is singular: h/L is .01, and forces differ by 1e-4."""
    own, other = (answer("portal-frame", model, 2).table() for model in ("tsm", "solid"))
    for name in ALONG - {"shear_force"}:
        assert other[f"left.{name}"] == pytest.approx(own[f"left.{name}"], rel=3e-4)
    assert np.all(other["left.bending_moment_at"] == 0.0)


def test_extremes_by_statics():
    response = answer("tip-load")
    found, beam = response.table(), response.definition.beams[0]
    clamp, tip = response.supports["cantilever.start"], response.tips["cantilever"]
    area, inertia, _ = beam.section()
    expected = {"bending_moment": -clamp.moment, "displacement": np.hypot(*(tip - beam.end).T)}
    for name, sign in (("tensile_stress", 1.0), ("compressive_stress", -1.0)):
        expected[name] = -clamp.force[:, 0] / area - sign * clamp.moment * beam.height / (2.0 * inertia)
    for name, values in expected.items():
        np.testing.assert_allclose(found[f"cantilever.{name}"], values, rtol=1e-9)
    assert np.all(found["cantilever.bending_moment_at"] == 0.0)
    assert np.all(found["cantilever.displacement_at"] == beam.length)


def test_a_small_load_keeps_its_digits():
    """The rule of what is 0 goes by stiffness: 1e-6 of the load is no round-off, and its reaction has four digits and more."""
    scene, part = load_scene("tip-load"), 1e-6
    load = replace(scene.loads[0], force=(0.0, part * 175.0))
    response = solve(replace(scene, loads=(load,), load_parameters=1), "tsm", EXACT)
    line = next(line for line in response.page().splitlines() if line.startswith("  cantilever.start"))
    y, moment = map(float, line.split()[-2:])
    assert y == pytest.approx(-part * 175.0, rel=1e-4)
    assert moment == pytest.approx(-part * 175.0 * 100.0, rel=1e-3)


def test_beams_at_rest_again_have_no_forces_and_what_was_largest_is_kept(monkeypatch):
    """Residuals of 1e-13 are 0 on the page; a contact that is open again keeps its largest and last force."""
    monkeypatch.setenv("COLUMNS", "120")
    response = answer("double-beam", load_parameters=19)
    page = response.page()
    assert 0.0 < np.abs(response.supports["lower.start"].force[-1]).max() < 1e-9
    assert "  lower.start  x, y, rotation      0      0             0\n" in page
    slip = next(event for event in response.events if event.kind == "slip-off")
    assert slip.force > response.contacts["pin->upper"].force.max()
    (line,) = [line for line in page.splitlines() if "contact force pin->upper, largest and last" in line]
    force, _, t, *place = line.split()[6:]
    assert [float(force), float(t)] == pytest.approx([slip.force, slip.load_parameter], rel=5e-6)
    assert place == ["arc", "position", "1", "m"]
    assert f"pin slips off upper at arc position 1 m; contact force before {slip.force:.6g} N" in page


def test_a_picture_has_shape_diagrams_and_forces():
    response = answer("portal-frame")
    shape, *diagrams, _ = picture(response).axes
    lines = [line.get_xydata() for line in shape.get_lines()]
    for beam in ("left", "girder", "right"):
        assert any(np.array_equal(line, response.axis_line(beam, -1)[1]) for line in lines)
    drawn = diagrams[2].get_lines()[0].get_ydata()
    assert drawn == pytest.approx(response.sections("left", -1).M)
    without = replace(response, definition=None)
    assert "  left.start  " in without.page()
    assert not any("bending_moment" in name for name in without.table())
    with pytest.raises(ValueError, match="scene: must be given"):
        picture(without)


def test_solve_writes_a_history_and_a_picture(in_folder, capsys):
    files = ["--out", "a.csv", "--out", "a.svg", "--out", "a.json"]
    assert main(["solve", "ks-cantilever", *files]) == 0
    rows = list(csv.DictReader(Path("a.csv").read_text().splitlines()))
    assert [float(row["load_parameter"]) for row in rows] == pytest.approx(np.arange(1, 51) / 50)
    reaction = json.loads(Path("a.json").read_text())["supports"]["cantilever.start"]["force"]
    assert [float(row["cantilever.start.force_y [N]"]) for row in rows] == [force[1] for force in reaction]
    assert main(["certify", "a.json", "--scene", "ks-cantilever"]) == 0
    assert "CERTIFIED" in capsys.readouterr().out
    assert "</svg>" in Path("a.svg").read_text(encoding="utf-8")


def test_an_answer_of_the_solid_that_is_read_back_is_in_balance(tmp_path, capsys):
    """A strip that moves as a whole: rounded positions alone make forces, and the file has how large they are."""
    scene = str(Path(__file__).parent / "referee" / "scenes" / "unloaded.toml")
    file = str(tmp_path / "a.json")
    assert main(["solve", scene, "--model", "solid", "--mesh", "8x1", "--out", file, "--quiet"]) == 0
    capsys.readouterr()
    main(["certify", file, "--scene", scene])
    assert "NOT_JUDGED: nothing to judge" in capsys.readouterr().out


def test_a_solution_that_stops_has_a_page(capsys):
    assert main(["solve", str(Path(__file__).with_name("arch.toml")), "--certify", "none"]) == 3
    out = capsys.readouterr().out
    for told in (
        "  status       BIFURCATION: ", " of 10 load parameters, the last ", "bifurcation of the path",
        "  certificate  not judged; crossval certify judges it",
    ):  # fmt: skip
        assert told in out

"""One answer as a page, as columns and as a picture."""

import csv
import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from comparisons.cli import main
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.response import Response
from comparisons.response.along import ALONG, extremes_along
from comparisons.response.events import last_force, peak_force
from comparisons.response.from_json import restated
from comparisons.response.round_off import round_off
from comparisons.response.to_json import as_json
from comparisons.scene import LoadSpec, Scene, load_scene
from comparisons.show.answer import PictureError, picture

EXACT = Options(element="exact")


@cache
def answer(scene: str, model: str = "tsm", load_parameters: int = 10) -> Response:
    asked = replace(load_scene(scene), load_parameters=load_parameters)
    return solve(asked, model, EXACT if model == "tsm" else None)


@pytest.mark.parametrize("scene", ["two-pins", "lees-frame", "portal-frame"])
def test_extremes_are_those_of_the_referee(scene: str) -> None:
    """Elements with 100 stations a beam, and the referee's own equations with 401: equal to the sixth digit."""
    beams, rods = answer(scene), answer(scene, "rod")
    assert beams.definition is not None
    own, other = extremes_along(beams, beams.definition), extremes_along(rods, beams.definition)
    for beam, extremes in own.items():
        for name, extreme in extremes.items():
            scale = np.abs(other[beam][name].value).max()
            np.testing.assert_allclose(extreme.value, other[beam][name].value, rtol=0, atol=1e-7 * scale)
    assert own.keys() == other.keys()


def test_extremes_of_the_solid_reach_its_clamps() -> None:
    """The reaction is the section force at a clamp, where the stress of the solid is singular: h/L is .01, and forces differ by 1e-4."""
    beams, solid = answer("portal-frame", load_parameters=2), answer("portal-frame", "solid", 2)
    assert beams.definition is not None
    own, other = (extremes_along(one, beams.definition)["left"] for one in (beams, solid))
    for name in ("bending_moment", "tensile_stress", "compressive_stress", "axial_force", "displacement"):
        assert other[name].value == pytest.approx(own[name].value, rel=3e-4)
    assert np.all(other["bending_moment"].arc_position == 0.0)


def test_extremes_by_statics() -> None:
    response = answer("tip-load")
    scene = response.definition
    assert scene is not None
    (found,) = extremes_along(response, scene).values()
    clamp, tip, beam = response.supports["cantilever.start"], response.tips["cantilever"], scene.beams[0]
    area, inertia, _ = beam.cross_section
    assert isinstance(beam.height, float)
    np.testing.assert_allclose(found["bending_moment"].value, -clamp.moment, rtol=1e-12)
    np.testing.assert_allclose(found["displacement"].value, np.hypot(*(tip - beam.end).T), rtol=1e-12)
    assert np.all(found["bending_moment"].arc_position == 0.0)
    assert np.all(found["displacement"].arc_position == beam.length)
    N = -clamp.force[:, 0]
    for name, sign in (("tensile_stress", 1.0), ("compressive_stress", -1.0)):
        nominal = N / area - sign * clamp.moment * beam.height / (2.0 * inertia)
        np.testing.assert_allclose(found[name].value, nominal, rtol=1e-9)


@pytest.mark.parametrize("part", [1e-3, 1e-6])
def test_a_small_load_keeps_its_digits(part: float) -> None:
    """The rule of what is 0 goes by stiffness: 1e-6 of the load is no round-off, and its reaction has four digits and more."""
    scene = load_scene("tip-load")
    load = replace(scene.loads[0], force=(0.0, part * 175.0))
    response = solve(replace(scene, loads=(load,), load_parameters=1), "tsm", EXACT)
    line = next(line for line in response.page().splitlines() if line.startswith("  cantilever.start"))
    y, moment = map(float, line.split()[-2:])
    assert y == pytest.approx(-part * 175.0, rel=1e-4)
    assert moment == pytest.approx(-part * 175.0 * 100.0, rel=1e-3)


def test_what_is_below_round_off_is_zero_and_only_that() -> None:
    """The double beam at rest again: residuals of 1e-13 are 0 on the page, and no number of a loaded state is."""
    response = answer("double-beam", load_parameters=19)
    assert 0.0 < np.abs(response.supports["lower.start"].force[-1]).max() < 1e-9
    assert "  lower.start  x, y, rotation      0      0             0\n" in response.page()
    assert response.definition is not None
    least = round_off(response, response.definition)
    loaded = response.load_parameter < 0.9
    assert np.abs(response.supports["lower.start"].force[loaded][5:]).min() > 1e3 * least.force


def test_a_contact_that_is_open_again_keeps_its_forces() -> None:
    response = answer("double-beam", load_parameters=19)
    assert response.events is not None
    slip = next(event for event in response.events if event.kind == "slip-off")
    peak, last = peak_force(response, "pin->upper"), last_force(response, "pin->upper")
    assert peak == last == (slip.force, slip.load_parameter, slip.arc_position)
    assert slip.force > response.contacts["pin->upper"].force.max()
    page = response.page()
    assert "contact force pin->upper, largest and last" in page
    assert "pin slips off upper at arc position 1 m; contact force before" in page


def test_columns_have_one_length_and_the_names_have_units() -> None:
    response = answer("ks-friction")
    columns = response.table()
    assert {values.shape for values in columns.values()} == {(10,)}
    assert columns["pin->cantilever.force_y"] == pytest.approx(
        -columns["cantilever.start.force_y"], abs=1e-12
    )
    assert {f"cantilever.{name}{at}" for name in ALONG for at in ("", "_at")} <= columns.keys()
    assert "pin->cantilever.dissipated" in columns


def test_a_stored_answer_has_a_page_and_columns_without_its_scene() -> None:
    response = answer("two-pins")
    again = restated(json.loads(as_json(response)))
    assert "  beam.start  " in again.page()
    assert again.table()["p1->beam.force"] == pytest.approx(response.table()["p1->beam.force"])
    assert not any("bending_moment" in name for name in again.table())
    with pytest.raises(PictureError, match="scene: must be given"):
        again.plot()
    assert len(again.plot(response.definition).axes) == 2


def test_the_picture_has_shape_diagrams_and_forces() -> None:
    response = answer("portal-frame")
    shape, *diagrams, history = response.plot().axes
    assert [axes.get_ylabel() for axes in diagrams] == ["axial N\n[N]", "shear V\n[N]", "moment M\n[N mm]"]
    lines = [line.get_xydata() for line in shape.get_lines()]
    for beam in ("left", "girder", "right"):
        assert any(np.array_equal(line, response.axis_line(beam, -1)[1]) for line in lines)
    assert response.sections is not None
    drawn = diagrams[2].get_lines()[0].get_ydata()
    assert drawn == pytest.approx(response.sections("left", -1).M)
    assert [text.get_text() for text in shape.texts if text.get_text()] == ["400 N"]
    assert [line.get_label() for line in history.get_lines()] == ["left.start", "right.end"]


def arrows(scene: Scene) -> set[str]:
    return {text.get_text() for text in picture(solve(scene, "tsm")).axes[0].texts}


def test_the_picture_has_the_weights_of_the_beams_and_numbers_without_an_exponent() -> None:
    heavy = replace(load_scene("heavy-strip"), load_parameters=2)
    stiff = replace(heavy.beams[0], height=0.1, youngs_modulus=2.1e14)
    pressed = LoadSpec(beam="strip", force_per_length=(0.0, -20000.0))
    beam = heavy.beams[0]
    weight = beam.density * beam.width * beam.height * beam.length * 9.81
    assert f"weight {weight:.4g} N" in arrows(heavy)
    loaded = arrows(replace(heavy, beams=(stiff,), loads=(pressed,)))
    assert {"20000 N/m", f"weight {weight * 0.1 / beam.height:.4g} N"} <= loaded


def test_solve_writes_a_history_and_a_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table, picture = tmp_path / "a.csv", tmp_path / "a.svg"
    assert main(["solve", "two-pins", "--csv", str(table), "--plot", str(picture), "--times"]) == 0
    out = capsys.readouterr().out
    with table.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["load_parameter"]) for row in rows] == pytest.approx(np.arange(1, 11) / 10)
    response = solve(load_scene("two-pins"), "tsm", EXACT)
    assert [float(row["beam.start.force_y [N]"]) for row in rows] == list(
        response.supports["beam.start"].force[:, 1]
    )
    assert "</svg>" in picture.read_text(encoding="utf-8")
    stages = out.splitlines()[-1].removeprefix("seconds: ").partition(";")[0].split(", ")
    assert [stage.rpartition(" ")[0] for stage in stages] == ["read", "set up", "solve", "certify", "write"]


@pytest.mark.parametrize(
    ("options", "setting"),
    [
        ([], "exact 1, 14 unknowns"),
        (["--elements", "4"], "mixed 4, 18 unknowns"),
        (["--element", "timoshenko", "--elements", "4"], "timoshenko 4,"),
    ],
)
def test_the_element_suits_and_is_named(
    options: list[str], setting: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["solve", "two-pins", *options]) == 0
    out = capsys.readouterr().out
    assert f"  model        tsm, {setting}" in out
    assert ("  element      " in out) == ("--element" not in options)


def test_a_solution_that_stops_has_a_page(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    scene = tmp_path / "arch.toml"
    scene.write_text(
        """
scene = { name = "arch", units = "N, mm", load_parameters = 10 }
beam = [
  { name = "a", start = [0, 0], end = [100, 4], width = 10.0, height = 2.0, youngs_modulus = 2.1e5, poissons_ratio = 0.3 },
  { name = "b", start = [100, 4], end = [200, 0], width = 10.0, height = 2.0, youngs_modulus = 2.1e5, poissons_ratio = 0.3 },
]
support = [{ beam = "a", end = "start", kind = "pinned" }, { beam = "b", end = "end", kind = "pinned" }]
load = [{ beam = "a", end = "end", force = [0, -500] }]
"""
    )
    assert main(["solve", str(scene), "--certify", "none"]) == 3
    out = capsys.readouterr().out
    assert "  status       BIFURCATION: " in out
    assert " of 10 load parameters, the last " in out
    assert "  certificate  not judged; crossval certify judges it" in out
    assert "bifurcation of the path" in out

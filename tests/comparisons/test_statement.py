"""JSON, summary, errors and table of a response."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest

from comparisons.cases import Case, Measurement, measure
from comparisons.claims.gate import gate
from comparisons.errors import difference, errors
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.quantities import KEPT
from comparisons.response import Response
from comparisons.response.from_json import restated
from comparisons.response.to_json import as_json
from comparisons.scene import PinSpec, Scene, load_scene
from comparisons.scene.rules import FieldError
from comparisons.show.pages import tracks
from comparisons.show.table import Row, table_csv, table_text

SCENE = replace(load_scene("ks-cantilever"), load_parameters=5)
PAIR, BEAM = "pin->cantilever", "cantilever"


@pytest.fixture(scope="module")
def rod() -> Response:
    return solve(SCENE, "rod")


@pytest.fixture(scope="module")
def beams() -> Response:
    return solve(SCENE, "tsm", Options(elements=5))


def test_json_has_the_stated_fields_and_every_digit(beams: Response) -> None:
    data = json.loads(as_json(beams))
    assert list(data) == [
        "status", "message", "reported_success", "model", "continuum", "outside", "scene", "load_parameter", "stage",
        "contacts", "supports", "material_force", "tips", "axes",
        "events", "index", "critical", "certificate", "newton_iterations", "cutbacks", "unknowns", "wall_seconds", "versions",
    ]  # fmt: skip
    assert list(data["contacts"][PAIR]) == ["force", "vector", "arc_position", "gap", "slip_off"]
    assert list(data["supports"][f"{BEAM}.start"]) == ["moment", "force"]
    assert list(data["versions"]) == ["python", "numpy", "scipy", "scikit-fem", "tsm-crossval"]
    assert (data["status"], data["model"], data["scene"]) == ("COMPLETED", "tsm", "ks-cantilever")
    assert data["contacts"][PAIR]["force"] == list(beams.contacts[PAIR].force)
    assert np.shape(data["supports"][f"{BEAM}.start"]["force"]) == (5, 2)
    assert np.shape(data["tips"][BEAM]) == (5, 2)
    assert all(isinstance(count, int) for count in data["newton_iterations"])


def test_json_writes_nan_as_null() -> None:
    pin = PinSpec(name="pin", start=(0.5, -0.1), displacement=(0.0, 0.2))
    text = as_json(solve(replace(SCENE, pins=(pin,)), "rod"))
    assert "NaN" not in text
    assert json.loads(text)["contacts"][PAIR]["arc_position"][0] is None
    assert json.loads(text)["contacts"][PAIR]["gap"][0] == pytest.approx(0.06)


def test_events_are_listed_where_the_model_locates_them(rod: Response) -> None:
    pin = PinSpec(name="pin", start=(0.85, -0.06), displacement=(0.0, 0.6))
    response = solve(replace(SCENE, pins=(pin,)), "tsm", Options(elements=10))
    assert response.completed, response.message
    events = json.loads(as_json(response))["events"]
    assert list(events[0]) == [
        "kind",
        "load_parameter",
        "pair",
        "element",
        "arc_position",
        "force",
        "released",
        "stage",
    ]
    touch, *passes, slip = events
    assert (touch["kind"], touch["pair"], touch["element"]) == ("touch", PAIR, 8)
    assert touch["load_parameter"] == pytest.approx(0.1, abs=1e-9)
    assert touch["arc_position"] == pytest.approx(0.85, abs=1e-9)
    assert [event["kind"] for event in passes] == ["pass-through"]
    assert (slip["kind"], slip["element"], slip["arc_position"]) == ("slip-off", 9, pytest.approx(1.0))
    assert slip["released"] > 0.0
    assert response.contacts[PAIR].slip_off == slip["load_parameter"]
    happened = response.page().partition("\nEvents\n")[2].splitlines()[1:]
    assert ["touches" in line for line in happened] == [True, False]
    assert "slips off" in happened[1]
    assert happened[1].endswith(" N m released")
    assert json.loads(as_json(rod))["events"] is None


def test_a_file_that_names_the_beam_of_a_reaction_is_refused(beams: Response) -> None:
    data = json.loads(as_json(beams))
    data["supports"] = {BEAM: data["supports"][f"{BEAM}.start"]}
    with pytest.raises(FieldError, match=r"supports.cantilever.*as cantilever.start; .* solve again$"):
        restated(data)


def test_errors_are_relative_to_the_largest_reference(rod: Response) -> None:
    contact = rod.contacts[PAIR]
    off = replace(
        contact, force=contact.force + 0.01 * contact.force.max(), arc_position=contact.arc_position - 0.03
    )
    tips = {BEAM: rod.tips[BEAM] + np.array([0.03, 0.04])}
    twice_as_long = replace(SCENE, beams=(replace(SCENE.beams[0], end=(2.0, 0.0)),))
    found = errors(replace(rod, contacts={PAIR: off}, tips=tips), rod, twice_as_long)
    assert found["path"]["force"] == pytest.approx(0.01)
    assert found["end"]["force"] == pytest.approx(0.01)
    assert found["path"]["arc"] == pytest.approx(0.015)
    assert found["path"]["tip"] == pytest.approx(0.025)
    assert found["path"]["moment"] == 0.0


def test_errors_of_a_stopped_run_are_unknown(rod: Response) -> None:
    stopped = replace(rod, load_parameter=rod.load_parameter[:2])
    assert np.isnan(errors(stopped, rod, SCENE)["path"]["force"])


def test_a_contact_lost_by_one_model_alone_is_no_agreement(rod: Response) -> None:
    lost = replace(rod.contacts[PAIR], arc_position=np.full(5, np.nan))
    found = errors(replace(rod, contacts={PAIR: lost}), rod, SCENE)
    assert found["path"]["arc"] == np.inf


def test_table_and_csv_hold_the_same_rows(rod: Response, beams: Response) -> None:
    found = errors(beams, rod, SCENE)
    stopped = replace(beams, completed=False, status="CUTBACK_FLOOR")
    rows = [
        Row(label="beams", response=beams, errors=found),
        Row(label="stopped", response=stopped, errors=found),
        Row(label="rod", response=rod, errors=None),
    ]
    lines = table_text(rows, "exact rod").splitlines()
    assert f"{found['path']['force']:.1e}" in lines[-3]
    assert "stopped (CUTBACK_FLOOR)" in lines[-2]
    assert lines[-1].split()[:4] == ["rod", "2", "-", "-"]
    assert len({len(line) for line in lines[3:]}) == 1
    records = list(csv.DictReader(table_csv(rows).splitlines()))
    assert float(records[0]["error_path_force"]) == found["path"]["force"]
    assert records[2]["error_path_force"] == ""


@pytest.mark.parametrize("scene", [SCENE, replace(load_scene("ks-tied-tip"), load_parameters=5)])
def test_one_run_has_one_error_wherever_it_is_stated(scene: Scene) -> None:
    """The difference of an accuracy and a gate, the errors of a comparison, a page's history and a stored case."""
    case = Case(scene=scene, model="tsm", options=Options(elements=5))
    rod, beams = solve(scene, "rod"), solve(scene, "tsm", Options(elements=5))
    asked = [name for name in KEPT if scene.contacts or name != "friction"]
    bounds = gate(scene, "tsm", case.options, dict.fromkeys(asked, 1.0)).bounds
    stored = Measurement.from_json(measure(case, repeats=1).to_json()).response
    exact = Measurement.from_json(measure(Case(scene=scene, model="rod"), repeats=1).to_json()).response
    compared, kept = errors(beams, rod, scene)["path"], errors(stored, exact, scene)["path"]
    for item in bounds:
        name = item.name
        assert item.error == difference(beams, rod, scene, name)
        if name == "arc" and not scene.contacts:
            assert np.isnan([compared[name], kept[name]]).all()
            continue
        assert compared[name] == item.error
        assert kept[name] == pytest.approx(item.error, rel=1e-9, abs=1e-14)
    touched = {"force": 0, "arc": 1, "moment": 2, "friction": 3}
    shown = touched if scene.contacts else {"force": 0, "moment": -1}
    page = tracks({"rod": rod, "beams": beams}, "rod", scene)
    for name, track in shown.items():
        assert page[track].errors["beams"].max() == compared[name]

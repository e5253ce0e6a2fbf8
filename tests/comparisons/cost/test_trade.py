"""The cases of the sweep, the cheapest settings, and a whole trade-off from scene to files."""

import csv
import json
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from comparisons.cases import Case, Measurement, measure
from comparisons.cli import main
from comparisons.cost.cases import family, limit_cases, load_steps, refined, resolution, sweep_cases
from comparisons.cost.orders import orders
from comparisons.cost.points import TARGETS, Point, Trade, cheapest, front
from comparisons.cost.references import NoReferenceError, best_reference, reference_cases
from comparisons.cost.sweep import measure_trade, write_trade
from comparisons.cost.tables import cheapest_text, setting_rows, stopped_text
from comparisons.models import MODELS
from comparisons.models.options import Options
from comparisons.quantities import KEPT, SCOPES
from comparisons.scene import load_scene
from comparisons.show.pages import text
from tests.comparisons.show.pages.markup import check_alone

KS = replace(load_scene("ks-cantilever"), load_parameters=10)


@cache
def measured(case: Case) -> Measurement:
    return measure(case, repeats=1)


def few(cases: Sequence[Case]) -> dict[Case, Measurement]:
    """Measure beams and coarse solids; the others stop by name."""
    stopped = changed(measured(cases[0]), status="LEFT_OUT", completed=False)
    return {
        case: stopped if case.model == "solid" and resolution(case) > 10 else measured(case) for case in cases
    }


def changed(measurement: Measurement, **response: object) -> Measurement:
    return replace(measurement, response=replace(measurement.response, **response))  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def trade() -> Trade:
    return measure_trade(KS, few, quick=True)


@pytest.mark.parametrize("quick", [False, True])
def test_cases_are_complete_and_once(quick: bool) -> None:
    cases = sweep_cases(KS, quick=quick)
    assert len({case.key for case in cases}) == len(cases) == len(set(cases))
    assert len(cases) >= (40 if quick else 75)
    assert {case.model for case in cases} == {"tsm", "solid", "elastica"} < set(MODELS)
    solids = [case for case in cases if case.model == "solid"]
    assert {case.scene.beams[0].solid_element for case in solids} == {"Q1", "Q2", "Q2-full"}
    assert len({case.scene.contacts[0].penalty for case in solids}) > 2
    assert {case.scene.load_parameters for case in cases} >= {1, 10}
    assert set(limit_cases(KS, quick=quick)) <= set(cases)


def test_load_steps_hit_a_part_of_the_load_parameters() -> None:
    for count, steps in ((50, (1, 5, 10, 50)), (76, (1, 4, 19, 76)), (7, (1, 7))):
        assert load_steps(replace(KS, load_parameters=count)) == steps


def test_families_are_refined_alike() -> None:
    cases = sweep_cases(KS)
    base = Case(scene=KS, model="solid", options=Options(mesh=(25, 1)))
    assert [case.options.mesh for case in refined(base, cases)] == [(25, 1), (50, 2), (100, 4), (200, 8)]
    beams = refined(Case(scene=KS, model="tsm", options=Options(element="mixed", elements=5)), cases)
    assert [case.options.elements for case in beams] == [2, 3, 5, 10, 20, 40, 80, 160]
    assert {family(case) for case in beams} == {"TSM mixed"}


@pytest.mark.slow
def test_the_rod_is_the_reference_and_exact_elements_agree(trade: Trade) -> None:
    assert trade.reference.name == "exact rod"
    assert trade.reference.uncertainty["path"]["force"] < 1e-10
    exact = next(point for point in trade.points if point.case.label == "tsm exact 1")
    assert exact.errors["path"]["force"] < 1e-9
    elastica = next(point for point in trade.points if point.case.model == "elastica")
    assert 1e-4 < elastica.errors["path"]["force"] < 2e-3


@pytest.mark.slow
def test_two_beams_have_the_exact_rods_as_reference_and_none_if_these_stop() -> None:
    scene = replace(load_scene("double-beam"), load_parameters=4)
    mixed = Case(scene=scene, model="tsm", options=Options(element="mixed", elements=10))
    found = {case: measured(case) for case in (*reference_cases(scene), mixed)}
    reference = best_reference(scene, found)
    assert reference.name == "exact rod"
    assert reference.uncertainty["path"]["force"] < 1e-10
    assert 1e-9 < reference.errors(found[mixed])["path"]["force"] < 1e-6
    with pytest.raises(NoReferenceError, match="double-beam: the exact rods stopped"):
        best_reference(scene, {case: changed(one, completed=False) for case, one in found.items()})


@pytest.mark.slow
def test_what_stopped_is_listed_and_not_ranked(trade: Trade) -> None:
    assert "LEFT_OUT" in {point.measured.response.status for point in trade.stopped}
    assert len(setting_rows(trade)) == len(trade.points)
    assert stopped_text(trade).count("\n") == len(trade.stopped)
    assert not set(trade.stopped) & {point for model in MODELS for point in trade.of_model(model, "end")}
    assert trade.limit is None
    assert "not told" in cheapest_text(trade, "force")


def synthetic(trade: Trade) -> Trade:
    """Points with known seconds and errors, the solid's limit known to 1e-4."""
    rod, solid = trade.points[0], Case(scene=KS, model="solid")
    beam = Case(scene=KS, model="tsm")

    def point(case: Case, seconds: float, error: float, own: float) -> Point:
        tables = [{scope: dict.fromkeys(KEPT, value) for scope in SCOPES} for value in (error, own)]
        return Point(
            case=case,
            measured=replace(changed(rod.measured, unknowns=round(100 * seconds)), seconds=seconds),
            errors=tables[0],
            own_errors=tables[1],
        )

    points = [
        point(beam, 1.0, 1e-2, 1e-2),
        point(beam, 2.0, 1e-4, 1e-4),
        point(beam, 3.0, 1e-3, 1e-3),
        point(solid, 10.0, 1e-3, 3e-2),
        point(solid, 30.0, 3e-2, 1e-3),
        point(solid, 90.0, 3e-2, 1e-5),
        point(replace(solid, scene=replace(KS, load_parameters=1)), 5.0, 1e-5, 1e-5),
    ]
    known = {scope: dict.fromkeys(KEPT, 1e-4) for scope in SCOPES}
    return replace(trade, points=points, limit=replace(trade.reference, uncertainty=known))


@pytest.mark.slow
def test_cheapest_settings_and_their_ratio(trade: Trade) -> None:
    made = synthetic(trade)
    path = [cheapest(made, "path", "force", target) for target in TARGETS]

    def seconds(name: str) -> list[float | None]:
        chosen = [getattr(one, name) for one in path]
        return [point and point.measured.seconds for point in chosen]

    assert seconds("tsm") == [1.0, 1.0, 2.0, 2.0, None]
    assert seconds("solid") == [10.0, 30.0, 30.0, 90.0, None]
    assert [one.ratio for one in path[:4]] == [10.0, 30.0, 15.0, 45.0]
    assert [one.untold for one in path] == [False, False, False, False, True]
    # a coarse solid that hits the reference by chance does not count
    assert seconds("solid_against_reference") == [10.0, None, None, None, None]
    assert cheapest(made, "end", "force", 1e-3).ratio == 2.5


@pytest.mark.slow
def test_front_ends_at_the_uncertainty(trade: Trade) -> None:
    made = synthetic(trade)
    beams = front(made, "tsm", "path", "force", "seconds")
    assert [(one.cost, one.error) for one in beams] == [(1.0, 1e-2), (2.0, 1e-4)]
    assert [one.cost for one in front(made, "solid", "path", "force", "unknowns")] == [1000, 3000, 9000]
    assert front(made, "solid", "path", "force", "seconds")[-1].error == 1e-4


def test_order_of_mixed_elements(trade: Trade) -> None:
    rows = {row["family"]: row for row in orders(trade, "force")}
    assert rows["TSM mixed"]["order"] == pytest.approx(4.0, abs=0.2)
    assert rows["TSM mixed"]["order_points"] >= 3


@pytest.mark.slow
def test_files_hold_every_setting(trade: Trade, tmp_path: Path) -> None:
    files = write_trade(trade, tmp_path)
    assert all(file.stat().st_size for file in files)
    assert {file.suffix for file in files} == {".csv", ".html", ".json", ".png", ".svg"}
    with (tmp_path / "trade.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(trade.points)
    assert {row["status"] for row in rows} >= {"COMPLETED", "LEFT_OUT"}
    html = (tmp_path / "report.html").read_text()
    check_alone(html, tmp_path)
    assert html.count("data:image/svg+xml") == len(list(tmp_path.glob("*.svg")))
    assert all(
        text(f"{one.measured.response.status}: {one.measured.response.message}") in html
        for one in trade.stopped
    )
    numbers = json.loads((tmp_path / "trade.json").read_text())
    assert len(numbers["cheapest"]) == len(SCOPES) * len(KEPT) * len(TARGETS)
    assert {row["model"] for row in numbers["pareto"]} == {"tsm"}


def run(*arguments: str) -> int:
    try:
        return main(list(arguments))
    except SystemExit as exit_:
        return int(exit_.code or 0)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["no-such-scene"], "no-such-scene"),
        (["ks-cantilever", "--workers", "0"], "--workers"),
        (["ks-cantilever", "--workers", "1", "--cluster", "tcp://127.0.0.1:1"], "--cluster"),
    ],
)
def test_bad_input_is_one_line_and_computes_nothing(
    arguments: list[str], told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("trade", *arguments, "--out", str(tmp_path / "out")) == 2
    assert told in capsys.readouterr().err.splitlines()[-1]
    assert not (tmp_path / "out").exists()


def test_a_file_in_place_of_the_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("mine")
    assert run("trade", "ks-cantilever", "--out", str(tmp_path / "file")) == 2
    assert "cannot be written" in capsys.readouterr().err
    assert (tmp_path / "file").read_text() == "mine"


@pytest.mark.slow
def test_the_quick_trade_of_ks(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("trade", "ks-cantilever", "--quick", "--out", str(tmp_path)) == 0
    with (tmp_path / "trade.csv").open() as file:
        rows = list(csv.DictReader(file))
    completed = [row for row in rows if row["status"] == "COMPLETED" and row["model"] in {"tsm", "solid"}]
    assert len(completed) >= 25
    known = [float(row["own_error_end_force"]) for row in completed]
    assert np.log10(max(known) / max(min(known), 1e-15)) >= 6.0
    out = capsys.readouterr().out
    stopped = [row for row in rows if row["status"] != "COMPLETED"]
    assert stopped
    assert all(f"{row['label']} [{row['load_steps']}]: {row['status']}: " in out for row in stopped)
    numbers = json.loads((tmp_path / "trade.json").read_text())
    whole = max(int(row["load_steps"]) for row in rows)
    told = 0
    for chosen in numbers["cheapest"]:
        for model, error in (("tsm", "error"), ("solid", "own_error")):
            column = f"{error}_{chosen['scope']}_{chosen['quantity']}"
            good = [
                (float(row["seconds"]), row["label"], int(row["load_steps"]))
                for row in completed
                if row["model"] == model
                and row[column]
                and float(row[column]) <= chosen["target"]
                and (chosen["scope"] == "end" or int(row["load_steps"]) == whole)
            ]
            if chosen[model] is not None:
                told += 1
                assert (chosen[model], chosen[f"{model}_load_steps"]) == min(good)[1:], chosen
        if chosen["tsm"] is not None and chosen["solid"] is not None:
            assert chosen["ratio"] == pytest.approx(chosen["solid_seconds"] / chosen["tsm_seconds"])
    assert told > 20
    # what is there is not run again, and says the same
    before = (tmp_path / "trade.csv").read_text()
    assert run("trade", "ks-cantilever", "--quick", "--out", str(tmp_path)) == 0
    assert (tmp_path / "trade.csv").read_text() == before
    assert capsys.readouterr().out == out

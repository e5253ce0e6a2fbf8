"""The trade-off: fits and fronts on numbers whose answer is known, limits by extrapolation, and `crossval run trade`."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest

from comparisons.answer import ContactHistory, Response, SupportHistory
from comparisons.answer.axis import STATIONS, SampledAxes
from comparisons.answer.quantities import KEPT, SCOPES
from comparisons.cli import main
from comparisons.models import MODELS
from comparisons.models.model import Options
from comparisons.scene import built_in_scenes, load_scene
from comparisons.suite import Case, Row, measure

# not public: the least of known seconds and the order of known errors, which no measured time can show
from comparisons.suite.measure import unmeasured
from comparisons.suites.trade.cases import (
    NoReferenceError,
    Reference,
    best_reference,
    chains,
    extrapolated,
    limit_cases,
    load_steps,
    reference_cases,
    sweep_cases,
)
from comparisons.suites.trade.trade import (
    TARGETS,
    Trade,
    cheapest,
    convergence,
    front,
    orders,
    pareto,
    power_law,
)
from tests.comparisons.report.pages.markup import check_alone

KS = replace(load_scene("ks-cantilever"), load_parameters=10)
PAIR, BEAM = "pin->cantilever", "cantilever"
CLAMP, TIP = "cantilever.start", "cantilever.end"
TIMES = np.array([0.2, 0.4, 0.6, 0.8, 1.0])
N = np.array([5.0, 10.0, 20.0, 40.0, 80.0])


def test_fronts_and_orders():
    """An order is that of the finest four above the floor: not from a coarse mesh that is right by chance, nor from round-off."""
    points = np.random.default_rng(0).random((60, 2)).round(1)
    beaten = [any((other <= point).all() and (other < point).any() for other in points) for point in points]
    best = sorted({tuple(point) for point, worse in zip(points, beaten, strict=True) if not worse})
    assert [tuple(points[k]) for k in pareto(*points.T)] == best
    assert pareto([np.nan, 1.0, 2.0], [0.0, np.nan, 0.5]) == [2]
    for y in ([1.0, 2.0], [1.0, 0.0, 2.0]):
        assert power_law([1.0, 2.0, 4.0][: len(y)], y).exponent is None
    spoilt = N**-4.0
    spoilt[0], spoilt[4] = 1.1e-4, spoilt[3] / 1.5
    cases = [(order, 7.0 * N**-order, (10.0, 80.0, 4)) for order in (1.0, 2.0, 4.0)]
    for order, error, where in (*cases, (4.0, spoilt, (10.0, 40.0, 3))):
        fit = convergence(list(N), list(error), 0.0)
        assert (-fit.exponent, fit.scatter) == pytest.approx((order, 0.0), rel=1e-12, abs=1e-12)
        assert (fit.first, fit.last, fit.points) == where
    unknown = [0.1, 0.01, np.nan, np.nan, np.nan]
    for error, uncertainty in ((N**-4.0, 1e-4), (N**1.0, 0.0), (unknown, 0.0)):
        assert convergence(list(N), list(error), uncertainty).exponent is None


def response_of(h, order=2.0):
    """A response that converges with the order, the contact open at first, and two supports."""
    s, off = np.arange(1.0, 6.0), h**order
    force = np.arange(10.0).reshape(5, 2) + off
    axis = np.ones((5, 101, 2)) * (1.0 + off * STATIONS)[:, None]
    arc = np.where(s < 2.0, np.nan, 0.5 + off * s)
    return replace(
        Response(status="COMPLETED", message=""),
        load_parameter=TIMES,
        contacts={PAIR: ContactHistory(force=s * (1.0 + off), arc_position=arc, gap=0.0 * s)},
        supports={
            CLAMP: SupportHistory(force=force, moment=-2.0 * (s + off)),
            TIP: SupportHistory(force=-force, moment=np.zeros(5)),
        },
        material_force={BEAM: off * s},
        tips={BEAM: np.stack([s, 1.0 - off * s], axis=-1)},
        axis_line=SampledAxes(arc_length={BEAM: STATIONS}, position={BEAM: axis}),
    )


@pytest.mark.parametrize("order", [1.0, 2.0, 3.5])
def test_the_limit_of_a_series_of_any_order(order):
    """Supports have a limit of their forces where there is no contact; a series that does not converge has its last member."""
    series, exact = [response_of(h, order) for h in (0.2, 0.1, 0.05)], response_of(0.0)
    found, held = extrapolated(series), extrapolated([replace(one, contacts={}) for one in series])
    for read in (
        lambda one: one.supports[CLAMP].moment,
        lambda one: one.material_force[BEAM],
        lambda one: one.tips[BEAM],
        lambda one: np.array([one.axis_line(BEAM, k)[1] for k in range(5)]),
        lambda one: one.contacts[PAIR].force if one.contacts else one.supports[CLAMP].force,
        lambda one: one.contacts[PAIR].arc_position if one.contacts else one.supports[TIP].force,
    ):
        assert read(found) == pytest.approx(read(exact), abs=1e-12, nan_ok=True)
        assert read(held) == pytest.approx(read(replace(exact, contacts={})), abs=1e-12)
    rest = extrapolated([response_of(h) for h in (0.05, 0.06, 0.1)])
    assert np.array_equal(rest.contacts[PAIR].force, response_of(0.1).contacts[PAIR].force)
    # errors at the end are those at the last load parameter with a force
    for force, end in ((np.where(TIMES > 0.7, 0.0, TIMES), 0.6), (np.zeros(5), 1.0)):
        assert known(replace(exact, contacts={PAIR: replace(exact.contacts[PAIR], force=force)})).end == end


def table_of(value):
    return {scope: dict.fromkeys(KEPT, value) for scope in SCOPES}


def known(response, to=0.0):
    return Reference(response=response, uncertainty=table_of(to), sentence="")


def test_the_cases_of_a_sweep_are_complete_and_once():
    """Load steps hit a part of the scene's load parameters; families are refined alike."""
    for quick, least in ((True, 40), (False, 75)):
        cases = sweep_cases(KS, quick=quick)
        assert least <= len(cases) == len({case.key for case in cases}) == len(set(cases))
        assert {case.model for case in cases} == {"tsm", "solid", "elastica"} < set(MODELS)
        solids = [case for case in cases if case.model == "solid"]
        assert {case.scene.beams[0].solid_element for case in solids} == {"Q1", "Q2", "Q2-full"}
        assert len({case.scene.contacts[0].penalty for case in solids}) > 2
        assert {case.scene.load_parameters for case in cases} >= {1, 10}
        assert set(limit_cases(KS, quick=quick)) <= set(cases)
    found = {
        (chain[0].model, chain[0].scene.load_parameters, chain[0].family): chain for chain in chains(cases)
    }
    meshes = [case.options.mesh for case in found["solid", 10, "solid Q2-full"]]
    assert meshes == [(25, 1), (50, 2), (100, 4), (200, 8)]
    counts = [case.options.elements for case in found["tsm", 10, "TSM mixed"]]
    assert counts == [2, 3, 5, 10, 20, 40, 80, 160]
    for count, steps in ((50, (1, 5, 10, 50)), (76, (1, 4, 19, 76)), (7, (1, 7))):
        assert load_steps(replace(KS, load_parameters=count)) == steps


def point(case, seconds, error, own, status="COMPLETED"):
    """A case with known seconds, unknowns and errors."""
    response = Response(status=status, message="", unknowns=round(100 * seconds))
    return Row(
        case=case, response=response, seconds=seconds, errors=table_of(error), own_errors=table_of(own)
    )


def traded(points):
    """A trade-off whose reference is known to round-off, the solid's limit to 1e-4."""
    one = response_of(0.0)
    return Trade(scene=KS, rows=points, reference=known(one, 1e-15), limit=known(one, 1e-4))


def test_the_cheapest_settings_their_ratio_and_the_front():
    """A coarse solid that hits the reference by chance does not count; a front ends at the uncertainty of the limit."""
    solid, beam = Case(scene=KS, model="solid"), Case(scene=KS, model="tsm")
    beams = [point(beam, seconds, error, error) for seconds, error in ((1.0, 1e-2), (2.0, 1e-4), (3.0, 1e-3))]
    solids = [(10.0, 1e-3, 3e-2), (30.0, 3e-2, 1e-3), (90.0, 3e-2, 1e-5)]
    once = point(replace(solid, scene=replace(KS, load_parameters=1)), 5.0, 1e-5, 1e-5)
    stopped = point(beam, 0.5, 0.0, 0.0, "LEFT_OUT")
    made = traded([*beams, *(point(solid, *one) for one in solids), once, stopped])
    path = [cheapest(made, "path", "force", target) for target in TARGETS]
    assert [row["tsm_seconds"] for row in path] == [1.0, 1.0, 2.0, 2.0, None]
    assert [row["solid_seconds"] for row in path] == [10.0, 30.0, 30.0, 90.0, None]
    assert [row["ratio"] for row in path] == [10.0, 30.0, 15.0, 45.0, None]
    against = [row["solid_against_reference_seconds"] for row in path]
    assert against == [10.0, None, None, None, None]
    assert cheapest(made, "end", "force", 1e-3)["ratio"] == 2.5
    assert cheapest(replace(made, limit=None), "path", "force", 1e-2)["solid"] is None
    found = front(made, "tsm", "path", "force", "seconds")
    assert [(row["spent"], row["own_error"]) for row in found] == [(1.0, 1e-2), (2.0, 1e-4)]
    assert [row["spent"] for row in front(made, "solid", "path", "force", "unknowns")] == [1000, 3000, 9000]
    assert front(made, "solid", "path", "force", "seconds")[-1]["own_error"] == 1e-4


@pytest.mark.slow
def test_orders_and_exponents_of_families_and_no_reference_where_the_rods_stop():
    counts = (2, 3, 5, 10, 20, 40, 80, 160)
    cases = [Case(scene=KS, model="tsm", options=Options(element="mixed", elements=n)) for n in counts]
    errors_of = [0.1 * n**-4.0 for n in counts]
    made = traded([point(case, n, e, e) for case, n, e in zip(cases, counts, errors_of, strict=True)])
    (row,) = orders(made, "force")
    assert (row["family"], row["settings"], row["order_points"]) == ("TSM mixed", 8, 4)
    assert (row["order"], row["cost_exponent"]) == pytest.approx((4.0, 1.0), rel=1e-9)
    few = replace(KS, load_parameters=2)
    reference = best_reference(few, {case: measure(case, repeats=1) for case in reference_cases(few)})
    assert reference.end == 1.0
    assert reference.uncertainty["path"]["force"] < 1e-10
    scene = load_scene("double-beam")
    with pytest.raises(NoReferenceError, match="double-beam: the exact rods stopped: gone"):
        best_reference(scene, {case: unmeasured(case, "LOST", "gone") for case in reference_cases(scene)})


@pytest.mark.slow
def test_the_quick_trade_of_ks(tmp_path, capsys):
    scene, folder = tmp_path / "ks.toml", tmp_path / "out"
    scene.write_text(
        built_in_scenes()["ks-cantilever"].replace("load_parameters = 50", "load_parameters = 10")
    )
    assert main(["run", "trade", str(scene), "--quick", "--out", str(folder)]) == 0
    with (folder / "trade.csv").open() as file:
        rows = list(csv.DictReader(file))
    whole = [row for row in rows if row["scene.load_parameters"] == "10" and row["status"] == "COMPLETED"]
    errors_of = {row["label"]: float(row["error_path_force"]) for row in whole}
    assert errors_of["tsm exact 1"] < 1e-9
    assert 1e-4 < errors_of["elastica"] < 2e-3
    completed = [row for row in rows if row["status"] == "COMPLETED" and row["model"] in {"tsm", "solid"}]
    assert len(completed) >= 25
    out = capsys.readouterr().out
    stopped = [row for row in rows if row["status"] != "COMPLETED"]
    assert stopped
    html = (folder / "report.html").read_text()
    check_alone(html, folder)
    for row in stopped:
        assert f"{row['label']} [{row['scene.load_parameters']}]: {row['status']}: " in out
        assert f"{row['status']}: " in html
    assert html.count("data:image/svg+xml") == len(list(folder.glob("*.svg"))) > 0
    numbers = json.loads((folder / "trade.json").read_text())
    assert numbers["references"]["error"]["uncertainty"]["path"]["force"] < 1e-10
    assert len(numbers["cheapest"]) == len(SCOPES) * len(KEPT) * len(TARGETS)
    assert {row["model"] for row in numbers["pareto"]} == {"tsm", "solid"}
    (mixed,) = (row for row in numbers["orders"]["force"] if row["family"] == "TSM mixed")
    assert mixed["order"] == pytest.approx(4.0, abs=0.2)

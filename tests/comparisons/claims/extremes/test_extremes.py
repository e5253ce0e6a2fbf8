"""`crossval run extremes`: what is right, stopped, withdrawn and wrong, what theory allows, which places there are, and what is written."""

import csv
import json
import math
import re
from collections import Counter
from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import get_args

import numpy as np
import pytest

from comparisons.cases import Case, measure

# not public: answers off by a known part, allowances before any run, and the whole matrix without its hour of solutions
from comparisons.claims.claim import Allowance, Verdict
from comparisons.claims.extremes import run as runner
from comparisons.claims.extremes.axes import AXES, matrix
from comparisons.claims.extremes.cell import Cell, judged
from comparisons.claims.extremes.checks import LARGEST, Against, Check, allowance
from comparisons.claims.extremes.rows import against_rod, beam_case, exact_rod, kinds
from comparisons.claims.extremes.scenes import cantilever, half_circle, sheared
from comparisons.cli import main
from comparisons.models.options import Options
from comparisons.models.theory import Bending
from tests.comparisons.show.pages.markup import check_alone
from tsm import ELEMENTS

SCENE = half_circle(cantilever())
CASE = beam_case(SCENE, ELEMENTS["mixed"], 10)
CELL = Cell(axis="elements", row="mixed", column="10", case=CASE, checks=(against_rod(CASE),))
ROD = exact_rod(SCENE)
BENT = Bending(force=8.0, curvature=4.0, turn=2.5, nearest=0.6)
NAMES = [axis.name for axis in AXES]


@cache
def measured(case):
    return measure(case, repeats=0)


def judge(own, cell=CELL):
    return judged(cell, {**{case: measured(case) for case in cell.cases[1:]}, cell.case: own})


def off(measurement, part):
    """Return a measurement whose contact forces are off by `part` of themselves."""
    response = measurement.response
    contacts = {pair: replace(one, force=(1 + part) * one.force) for pair, one in response.contacts.items()}
    return replace(measurement, response=replace(response, contacts=contacts))


def stopped(measurement, status="CUTBACK_FLOOR", reached=5):
    """Return what is left of a measurement that stopped."""
    response = measurement.response
    few = replace(response, status=status, load_parameter=response.load_parameter[:reached])
    return replace(measurement, response=few)


BECOMES = {
    "as it is": (lambda m: m, Verdict.RIGHT, False),
    "off": (lambda m: off(m, 1e-3), Verdict.WRONG, False),
    "not a number": (lambda m: off(m, np.nan), Verdict.WRONG, False),
    "stopped": (stopped, Verdict.STOPPED, False),
    "stopped, and off before": (lambda m: stopped(off(m, 1e-3)), Verdict.WRONG, False),
    "stopped at the start": (lambda m: stopped(m, "SINGULAR_TANGENT", 0), Verdict.STOPPED, False),
    "off and withdrawn": (lambda m: stopped(off(m, 1e-3), "CHECK_FAILED"), Verdict.WITHDRAWN, False),
    "right and withdrawn": (lambda m: stopped(m, "CHECK_FAILED"), Verdict.WITHDRAWN, True),
    "withdrawn at the start": (lambda m: stopped(m, "CHECK_FAILED", 0), Verdict.WITHDRAWN, False),
    "raised": (lambda m: stopped(m, "ERROR"), Verdict.WRONG, False),
    "died": (lambda m: stopped(m, "WORKER_LOST"), Verdict.WRONG, False),
}


@pytest.mark.parametrize("case", BECOMES)
def test_a_verdict_and_whether_a_check_refused_needlessly(case):
    change, verdict, needless = BECOMES[case]
    found = judge(change(measured(CASE)))
    assert (found.verdict, found.needless) == (verdict, needless)
    assert found.status in found.sentence
    assert (found.reached == 0.0) == (found.findings == ()) == case.endswith("start")
    rod = stopped(measured(ROD), "LOST")
    assert judged(CELL, {CASE: measured(CASE), ROD: rod}).verdict is Verdict.WRONG, (
        "it goes on where its reference stopped"
    )
    if case == "as it is":
        assert 1e-6 < found.decisive.error < found.decisive.allowed < 1e-3
        assert found.reached == 1.0


@pytest.mark.parametrize("kind", get_args(Check))
def test_every_check_holds_a_true_answer_and_finds_a_spoiled_one(kind):
    """Forces and tips a thousandth too large, in the first cell that has the check."""
    cell, check = next(
        (cell, check) for cell in matrix(quick=True) for check in cell.checks if type(check) is kind
    )
    true, needed = measured(cell.case).response, {case: measured(case) for case in check.needs}
    spoiled = replace(
        off(measured(cell.case), 1e-3).response,
        supports={node: replace(one, force=1.001 * one.force) for node, one in true.supports.items()},
        tips={beam: 1.001 * place for beam, place in true.tips.items()},
    )
    for response, held in ((true, True), (spoiled, False)):
        found = check.finding(cell.case, response, needed)
        assert (found.error <= found.allowed) == held, (cell.row, cell.column, found)


def test_round_off_is_allowed_where_a_stiffness_multiplies_it():
    """Lengths 1 : 1e6: `mixed`, whose force is an unknown, may be off by its order alone; a force changed by 5 or 19 % is wrong."""
    lengths = np.logspace(0, 6, 20)
    nodes = tuple((1 - np.cumsum(lengths / lengths.sum())[:-1][::-1]).tolist())
    scene = half_circle(cantilever(nodes=nodes))
    mixed, paper = (beam_case(scene, ELEMENTS[element], None) for element in ("mixed", "timoshenko"))
    assert allowance(mixed, BENT).why == "fourth order of the element"
    assert allowance(mixed, BENT).error == pytest.approx(2 * (4.0 * nodes[0]) ** 4 / 1920, rel=1e-2)
    assert allowance(paper, BENT).error == LARGEST
    cell = Cell(axis="ratio", row="mixed", column="1e6", case=mixed, checks=(against_rod(mixed),))
    assert judge(measured(mixed), cell).verdict is Verdict.RIGHT
    for part in (0.19, 0.05):
        assert judge(off(measured(mixed), part), cell).verdict is Verdict.WRONG


def test_allowed_errors_fall_with_the_order_of_the_element_and_have_a_cap():
    slender = half_circle(cantilever(slenderness=1e4))

    def allowed(element, elements):
        return allowance(beam_case(slender, ELEMENTS[element], elements), BENT).error

    assert allowed("timoshenko", 10) / allowed("timoshenko", 20) == pytest.approx(4, rel=0.01)
    assert allowed("mixed", 10) / allowed("mixed", 20) == pytest.approx(16, rel=0.01)
    assert allowed("exact", 1) == allowed("exact", 7) < 1e-7
    most = allowance(beam_case(half_circle(sheared(25.0)), ELEMENTS["mixed"], 20), BENT)
    assert most.error == LARGEST
    assert "third power of the shear strain" in most.why


def test_the_inner_moment_counts_where_the_beam_turns_by_more_than_a_right_angle():
    """At the end of the half circle the clamp's moment is pi EI/L, the largest is the square root of 2 F EI."""
    last = half_circle(cantilever(slenderness=1e5), steps=1)
    check = Against(case=exact_rod(last))
    coarse = Case(scene=last, model="tsm", options=Options(element="timoshenko", elements=20))
    found = check.finding(coarse, measured(coarse).response, {check.case: measured(check.case)})
    assert found.allowed == pytest.approx(4 * (np.sqrt(2 * 8.18212814018414) / 20) ** 2 / 24, rel=1e-3)


ENDS = {
    "units": {"L 1e-09, E 1e-06", "L 1e+06, E 1e+15"},
    "slenderness": {"2", "1e+06"},
    "shear": {"1e-14", "1e4", "[P] 4.2"},
    "elements": {"1", "2", "3", "5", "5000"},
    "ratio": {"1e6, fine at clamp", "1e6, fine at tip"},
    "contact": {"at node", "node +ulp", "node -ulp", "at clamp", "at tip", "clamp +1e-16 l"},
    "load-step": {"1", "2", "5", "10000"},
    "penalty": {"1e-6", "1e12"},
    "poissons-ratio": {"-0.9", "0.4999"},
    "depth": {"roll-up, 2"},
    "time": {"10000"},
}


def test_every_place_is_there_once_and_axes_reach_their_ends():
    """A pin an ulp beside a node is not on it; lengths of elements differ by the ratio; the quick cells are a part."""
    places = []
    for quick in (True, False):
        cells = matrix(quick=quick)
        assert list(dict.fromkeys(cell.axis for cell in cells)) == NAMES == list(ENDS)
        places.append({(cell.axis, cell.row, cell.column) for cell in cells})
        assert len(places[-1]) == len(cells)
        assert all(cell.checks for cell in cells)
        models = {cell.case.options.element or cell.case.model for cell in cells}
        assert models == {*(kind.name for kind in kinds()), "solid", "rod", "elastica"}
    few, every = places
    assert few < every
    assert len(few) < 0.6 * len(every)
    for name, ends in ENDS.items():
        assert ends <= {column for axis, _, column in every if axis == name}
    starts = {one.column: one.case.scene.pins[0].points[0][0] for one in cells if one.axis == "contact"}
    assert starts["node -ulp"] < starts["at node"] == 0.5 < starts["node +ulp"]
    assert math.nextafter(starts["node -ulp"], 1) == 0.5 == math.nextafter(starts["node +ulp"], 0)
    for cell in (cell for cell in cells if cell.axis == "ratio"):
        nodes = (0.0, *(cell.case.scene.beams[0].nodes or ()), 1.0)
        lengths = [b - a for a, b in pairwise(nodes)]
        assert len(lengths) == 20
        assert max(lengths) / min(lengths) == pytest.approx(float(cell.column.split(",")[0]), rel=1e-6)


def test_the_files_hold_every_cell(tmp_path):
    changes = ("as it is", "stopped", "off", "right and withdrawn")
    found = [
        replace(judge(BECOMES[change][0](measured(CASE))), cell=replace(CELL, column=str(k)))
        for k, change in enumerate(changes)
    ]
    verdicts = ["right", "stopped", "wrong", "withdrawn"]
    files = runner.write(tmp_path, found, quick=True)
    assert [path.name for path in files] == ["extremes.html", "extremes.csv", "extremes.json"]
    data = json.loads((tmp_path / "extremes.json").read_text())
    assert data["verdicts"] == {"elements": dict.fromkeys(verdicts, 1)}
    assert [cell["error"] for cell in data["cells"]] == [one.decisive and one.decisive.error for one in found]
    html = files[0].read_text()
    check_alone(html, tmp_path)
    cells = re.findall(r'<td class="(\w+)"[^>]* title="([^"]*)"', html)
    assert [name for name, _ in cells] == verdicts
    assert all(re.search(r"allowed \d\.\de-\d", title) for _, title in cells)
    text = re.sub(r"<[^>]*>", "", html)
    assert "■ CUTBACK_FLOOR" in text
    for k, mark in ((2, "✗"), (3, "□")):
        assert f"{mark} {data['cells'][k]['error']:.1e}".replace("e-0", "e-") in text
    counted = "4 cells: 1 right, 1 stopped, 1 withdrawn (1 needlessly), 1 wrong"
    assert f"{counted}, a part of the matrix (quick)." in html
    with (tmp_path / "extremes.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [row["verdict"] for row in rows] == verdicts


@pytest.mark.slow
def test_the_command_fails_where_a_cell_is_wrong(tmp_path, capsys, monkeypatch):
    """Five elements of the paper against the rod, of which too little is allowed."""
    scene = half_circle(cantilever(), steps=5)
    cell = replace(
        CELL,
        case=beam_case(scene, ELEMENTS["timoshenko"], 5),
        checks=(Against(case=exact_rod(scene), allowed=Allowance(error=1e-4, why="too little")),),
    )
    monkeypatch.setattr(runner, "matrix", lambda **_: [cell])
    assert main(["run", "extremes", "--quick", "--workers", "1", "--out", str(tmp_path / "out")]) == 1
    out, err = capsys.readouterr()
    assert "extremes.html" in out
    assert "elements 10, tsm timoshenko 5: wrong: COMPLETED" in err
    files = [".crossval", "extremes.csv", "extremes.html", "extremes.json"]
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == files


STOP = {
    ("shear", "mixed", "1e4"),
    ("slenderness", "mixed", "2"),
    ("elements", "mixed", "1"),
    ("depth", "mixed", "behind the clamp"),
    ("depth", "exact", "behind the clamp"),
    *(("contact", model, place) for model in ("mixed", "exact") for place in ("at clamp", "clamp +1e-16 l")),
}
"""Where elements of this project, not of the paper, do not complete: too few, sheared beyond small strains, nothing to move, no equilibrium."""


@pytest.mark.slow
@pytest.mark.long
def test_quick_matrix(tmp_path, capsys, stated):
    """Nothing is wrong, and no more stops or is withdrawn than what must."""
    assert main(["run", "extremes", "--quick", "--out", str(tmp_path)]) == 0, capsys.readouterr().err
    cells = json.loads((tmp_path / "extremes.json").read_text())["cells"]
    at = {(cell["axis"], cell["model"], cell["value"]): cell for cell in cells}
    hold = [
        cell
        for cell in cells
        if cell["axis"] in ("units", "load-step", "penalty") and cell["value"] != "1e-6"
    ]
    assert {cell["verdict"] for cell in hold} == {"right"}
    own = {place: cell for place, cell in at.items() if cell["model"] in ("mixed", "exact")}
    assert {place for place, cell in own.items() if cell["verdict"] != "right"} == STOP
    verdicts = Counter(cell["verdict"] for cell in cells)
    stated("extremes.cells", len(cells))
    for verdict in ("right", "stopped", "withdrawn"):
        stated(f"extremes.{verdict}", verdicts[verdict])
    stated("extremes.needless", sum(cell["needless"] for cell in cells))
    stated("extremes.not-completed", len(STOP))

    def worst(axis, *values, model="mixed"):
        return max(at[axis, model, value]["error"] for value in values)

    stated("extremes.slenderness", worst("slenderness", "50", "1000", "100000", "1e+06"))
    stated("extremes.shear", worst("shear", "1e-14", "1e-4", "[P] 4.2"))
    stated("extremes.shear-1", worst("shear", "1e0"))
    stated("extremes.elements", *(worst("elements", count) for count in ("2", "5", "50")))
    stated("extremes.ratio", *(worst("ratio", f"1e6, fine at {end}") for end in ("clamp", "tip")))
    places = [f"{place} {by}" for place in ("node", "tip") for by in ("+ulp", "-ulp")]
    stated("extremes.contact", worst("contact", "at node", "at tip", *places))
    stated("extremes.load-step", worst("load-step", "1", "5", "100"))
    stated("extremes.time", worst("time", "1", "20"))
    ratios = (worst("poissons-ratio", nu, model="solid") for nu in ("-0.9", "0", "0.4999"))
    stated("extremes.poissons-ratio", *ratios)
    exact = [cell for cell in own.values() if cell["model"] == "exact" and cell["verdict"] == "right"]
    assert max(cell["error"] for cell in exact) < 1e-11


@pytest.mark.slow
def test_many_elements_leave_what_the_page_says(stated):
    """5,000 elements of `mixed`: 2e-10, and 19 % off would be wrong by eight powers of ten."""
    (cell,) = (one for one in matrix() if (one.axis, one.row, one.column) == ("elements", "mixed", "5000"))
    found = judged(cell, {case: measure(case, repeats=0) for case in cell.cases})
    assert found.verdict is Verdict.RIGHT
    stated("extremes.elements-5000", found.decisive.error)
    assert found.decisive.allowed < 3e-9

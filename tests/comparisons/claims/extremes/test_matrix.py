"""The matrix, its maps, and the command."""

import csv
import json
import math
from collections import Counter
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path

import pytest

from comparisons.cases.measure import measure
from comparisons.claims.claim import Finding, Verdict
from comparisons.claims.extremes import run as runner
from comparisons.claims.extremes.allowance import Allowance
from comparisons.claims.extremes.axes import AXES, matrix
from comparisons.claims.extremes.cell import Cell, Judgement, judged
from comparisons.claims.extremes.checks import Against
from comparisons.claims.extremes.rows import against_rod, beam_case, exact_rod, kinds
from comparisons.claims.extremes.scenes import cantilever, half_circle
from comparisons.cli import main
from tsm.elements import ELEMENTS

NAMES = [axis.name for axis in AXES]


@pytest.mark.parametrize("quick", [False, True])
def test_every_place_is_there_once(quick: bool) -> None:
    cells = matrix(quick=quick)
    assert list(dict.fromkeys(cell.axis for cell in cells)) == NAMES
    assert max(Counter((cell.axis, cell.row, cell.column) for cell in cells).values()) == 1
    assert all(cell.checks for cell in cells)
    models = {cell.case.options.element or cell.case.model for cell in cells}
    assert models == {*(kind.name for kind in kinds()), "solid", "rod", "elastica"}


def test_quick_is_a_part() -> None:
    few, all_of_them = (
        {(cell.axis, cell.row, cell.column) for cell in matrix(quick=quick)} for quick in (True, False)
    )
    assert few < all_of_them
    assert len(few) < 0.6 * len(all_of_them)


def columns(name: str) -> set[str]:
    return {cell.column for cell in matrix() if cell.axis == name}


@pytest.mark.slow
def test_axes_reach_their_ends() -> None:
    assert {"L 1e-09, E 1e-06", "L 1e+06, E 1e+15"} <= columns("units")
    assert {"2", "1e+06"} <= columns("slenderness")
    assert {"1e-14", "1e4", "[P] 4.2"} <= columns("shear")
    assert {"1", "2", "3", "5", "5000"} <= columns("elements")
    assert {"1e6, fine at clamp", "1e6, fine at tip"} <= columns("ratio")
    assert {"at node", "node +ulp", "node -ulp", "at clamp", "at tip", "clamp +1e-16 l"} <= columns("contact")
    assert {"1", "2", "5", "10000"} <= columns("load-step")
    assert {"1e-6", "1e12"} <= columns("penalty")
    assert {"-0.9", "0.4999"} <= columns("poissons-ratio")
    assert "roll-up, 2" in columns("depth")
    assert "10000" in columns("time")


def test_a_pin_an_ulp_beside_a_node_is_not_on_it() -> None:
    starts = {
        cell.column: cell.case.scene.pins[0].points[0][0]
        for cell in matrix(quick=True)
        if cell.axis == "contact"
    }
    assert starts["node -ulp"] < starts["at node"] == 0.5 < starts["node +ulp"]
    assert math.nextafter(starts["node -ulp"], 1) == 0.5 == math.nextafter(starts["node +ulp"], 0)


def test_element_lengths_differ_by_the_ratio() -> None:
    for cell in matrix(quick=True):
        if cell.axis == "ratio":
            nodes = (0.0, *(cell.case.scene.beams[0].nodes or ()), 1.0)
            lengths = [b - a for a, b in pairwise(nodes)]
            assert len(lengths) == 20
            assert max(lengths) / min(lengths) == pytest.approx(float(cell.column.split(",")[0]), rel=1e-6)


def judgement(verdict: Verdict, error: float, column: str, status: str = "COMPLETED") -> Judgement:
    case = beam_case(half_circle(cantilever()), ELEMENTS["mixed"], 10)
    finding = Finding(name="exact rod", error=error, allowed=1e-3, why="h < 1 & h > 0")
    return Judgement(
        cell=Cell(axis="elements", row="mixed", column=column, case=case, checks=(against_rod(case),)),
        verdict=verdict,
        status=status,
        message="<what happened>",
        reached=1.0,
        findings=(finding,),
        iterations=3,
        cutbacks=0,
        seconds=0.1,
    )


FOUR = (
    judgement(Verdict.RIGHT, 1e-5, "1"),
    judgement(Verdict.STOPPED, 1e-5, "2", "CUTBACK_FLOOR"),
    judgement(Verdict.WRONG, 2e-2, "3"),
    judgement(Verdict.WITHDRAWN, 1e-5, "4", "CHECK_FAILED"),
)


class Tags(HTMLParser):
    """Collects cells, and checks that tags are closed in order."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.cells: list[dict[str, str | None]] = []
        self.text: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in ("meta", "link"):
            self.open.append(tag)
        if tag == "td" and "title" in dict(attrs):
            self.cells.append(dict(attrs))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text.append(data)


def test_maps_are_one_file_that_needs_nothing_else(tmp_path: Path) -> None:
    html = runner.write(tmp_path, FOUR, quick=True)[0].read_text()
    tags = Tags()
    tags.feed(html)
    assert tags.open == []
    assert not any(word in html for word in ("://", "src=", "@import", "url("))
    assert [cell["class"] for cell in tags.cells] == ["right", "stopped", "wrong", "withdrawn"]
    assert all("allowed 1.0e-3" in (cell["title"] or "") for cell in tags.cells)
    text = "".join(tags.text)
    assert "■ CUTBACK_FLOOR" in text
    assert "✗ 2.0e-2" in text
    assert "□ 1.0e-5" in text
    assert (
        "4 cells: 1 right, 1 stopped, 1 withdrawn (1 needlessly), 1 wrong, a part of the matrix (quick)."
        in text
    )


def test_files_hold_every_cell(tmp_path: Path) -> None:
    files = runner.write(tmp_path, FOUR, quick=True)
    assert [path.name for path in files] == ["extremes.html", "extremes.csv", "extremes.json"]
    with (tmp_path / "extremes.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [row["verdict"] for row in rows] == ["right", "stopped", "wrong", "withdrawn"]
    data = json.loads((tmp_path / "extremes.json").read_text())
    assert data["verdicts"] == {"elements": {"right": 1, "stopped": 1, "withdrawn": 1, "wrong": 1}}
    assert data["cells"][2]["error"] == 2e-2


def two_cells(allowed: Allowance | None) -> list[Cell]:
    """An exact element, and five of the paper's, against the rod."""
    scene = half_circle(cantilever(), steps=5)
    return [
        Cell(
            axis="elements",
            row=element,
            column="5",
            case=beam_case(scene, ELEMENTS[element], 5),
            checks=(Against(case=exact_rod(scene), allowed=None if element == "exact" else allowed),),
        )
        for element in ("exact", "timoshenko")
    ]


@pytest.mark.slow
@pytest.mark.parametrize(("allowed", "status"), [(None, 0), (Allowance(error=1e-4, why="too little"), 1)])
def test_the_command_fails_where_a_cell_is_wrong(
    allowed: Allowance | None,
    status: int,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(runner, "matrix", lambda **_: two_cells(allowed))
    assert main(["extremes", "--quick", "--workers", "1", "--out", str(tmp_path / "out")]) == status
    out, err = capsys.readouterr()
    assert "extremes.html" in out
    assert ("elements 5, tsm timoshenko 5: wrong: COMPLETED" in err) == bool(status)
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        ".crossval",
        "extremes.csv",
        "extremes.html",
        "extremes.json",
    ]


def test_a_place_that_cannot_be_used_is_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert main(["extremes", "--quick", "--out", str(tmp_path / "file")]) == 2
    assert "cannot be written" in capsys.readouterr().err


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
def test_quick_matrix(tmp_path: Path, capsys: pytest.CaptureFixture[str], stated) -> None:
    """Nothing is wrong, and no more stops or is withdrawn than what must."""
    assert main(["extremes", "--quick", "--out", str(tmp_path)]) == 0, capsys.readouterr().err
    cells = json.loads((tmp_path / "extremes.json").read_text())["cells"]
    at = {(cell["axis"], cell["model"], cell["value"]): cell for cell in cells}
    assert all(cell["verdict"] == "right" for cell in cells if cell["axis"] == "units")
    assert all(cell["verdict"] == "right" for cell in cells if cell["axis"] == "load-step")
    assert all(
        cell["verdict"] == "right" for cell in cells if cell["axis"] == "penalty" and cell["value"] != "1e-6"
    )
    own = {place: cell for place, cell in at.items() if cell["model"] in ("mixed", "exact")}
    assert {place for place, cell in own.items() if cell["verdict"] != "right"} == STOP
    verdicts = Counter(cell["verdict"] for cell in cells)
    stated("extremes.cells", len(cells))
    for verdict in ("right", "stopped", "withdrawn"):
        stated(f"extremes.{verdict}", verdicts[verdict])
    stated("extremes.needless", sum(cell["needless"] for cell in cells))
    stated("extremes.not-completed", len(STOP))

    def worst(axis: str, *values: str, model: str = "mixed") -> float:
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
    stated(
        "extremes.poissons-ratio",
        *(worst("poissons-ratio", nu, model="solid") for nu in ("-0.9", "0", "0.4999")),
    )
    assert (
        max(cell["error"] for cell in own.values() if cell["model"] == "exact" and cell["verdict"] == "right")
        < 1e-11
    )


@pytest.mark.slow
def test_many_elements_leave_what_the_page_says(stated) -> None:
    """5,000 elements of `mixed`: 2e-10, and 19 % off would be wrong by eight powers of ten."""
    (cell,) = (one for one in matrix() if (one.axis, one.row, one.column) == ("elements", "mixed", "5000"))
    found = judged(cell, {case: measure(case, repeats=0) for case in cell.cases})
    assert found.verdict is Verdict.RIGHT
    assert found.decisive is not None
    stated("extremes.elements-5000", found.decisive.error)
    assert found.decisive.allowed < 3e-9

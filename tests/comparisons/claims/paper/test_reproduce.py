"""``crossval reproduce``: files, numbers, verdicts. One figure at a time with coarse settings; all of it in the slow tier."""

import csv
import json
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.image import imread

from comparisons.claims.paper import turned_frame
from comparisons.claims.paper.approach import NEAREST
from comparisons.claims.paper.claims import CLAIMS, Findings, claims_text
from comparisons.claims.paper.figures import FIGURES
from comparisons.claims.paper.reproduce import STUDIES, reproduce
from comparisons.claims.paper.verdict import Verdict
from comparisons.cli import main
from tests.comparisons.show.pages.markup import block, check_alone

PICTURES = {
    "fig7a": ["fig7a"],
    "fig7b": ["fig7b", "fig7b-tolerance", "fig7b-floor"],
    "fig8": ["fig8", "fig8-tied-tip"],
    "fig9": ["fig9", "fig9-forces"],
}
TABLES = {
    "fig7a": ["fig7a"],
    "fig7b": ["fig7b", "fig7b-tolerance", "fig7b-floor"],
    "fig8": ["fig8", "fig8-shapes"],
    "fig9": ["fig9"],
}
IN_THE_PAPER = {
    "abstract": ("critical area", "cantilever", "Shear deformation", "any geometrically nonlinear"),
    "4.1": ("singular", "7.749", "2.164", "0.067 % to 0.501", "ordered", "reduces", "Timoshenko", "pass", "six starting"),
    "4.2": ("not significantly different", "10 and 20 divisions", "sufficient"),
    "4.3": ("come into contact", "shifts", "exceeds", "every element edge"),
    "conclusion 1": ("effectiveness", "discontinuous", "0.067 %"),
    "conclusion 2": ("fewer elements", "cost"),
    "conclusion 3": ("without any divergence", "same time"),
}  # fmt: skip
"""A word of every claim, read off [P]."""


FULL = {
    **dict.fromkeys(
        ("exists", "shear_effective", "singular", "followed", "order", "shear_reduces", "passes", "discontinuity_solved", "alike",
         "few_elements", "begins", "hands_over", "leaves", "less_division", "cheaper", "simultaneous"),
        Verdict.REPRODUCED,
    ),
    "cantilever_reduces": Verdict.IN_DIRECTION,
    **dict.fromkeys(("cantilever_effective", "anything"), Verdict.NOT_REPRODUCED),
    **dict.fromkeys(
        ("_printed_range.<locals>.judge", "every_edge", "simple_enough", "passes_every_edge"), Verdict.CANNOT_BE_TOLD
    ),
}  # fmt: skip
"""Verdicts of full settings, by judge."""


def verdicts(folder: Path, name: str = "claims.md") -> dict[str, str]:
    """Verdict by the claim's text, from the Markdown table."""
    rows = [
        line.split(" | ") for line in (folder / name).read_text().splitlines() if line.startswith("| ") and line[2].isdigit()
    ]  # fmt: skip
    return {row[2]: row[3].strip("*") for row in rows}


def check_files(folder: Path, figure: str) -> None:
    for stem in PICTURES[figure]:
        assert imread(folder / f"{stem}.png").std() > 0.03
        assert "<svg" in (folder / f"{stem}.svg").read_text()
    for stem in TABLES[figure]:
        with (folder / f"{stem}.csv").open() as file:
            rows = list(csv.DictReader(file))
        assert len(rows) > 5
        assert all(set(row) == set(rows[0]) and None not in row for row in rows)


def run(figure: str, folder: Path) -> dict[str, Any]:
    done = reproduce(figure, folder, quick=True, report=lambda _: None)
    check_files(folder, figure)
    assert done.stopped == ()
    assert sorted(done.files) == sorted(folder.glob("[!.]*"))
    assert set(verdicts(folder, f"claims-{figure}.md")) == {
        claim.text for claim in CLAIMS if claim.figure == figure
    }
    check_page(folder, figure)
    return json.loads((folder / f"{figure}.json").read_text())


def check_page(folder: Path, figure: str) -> None:
    """The page has every picture, every claim, and the shapes that move."""
    html = (folder / "report.html").read_text()
    check_alone(html, folder)
    assert html.count(f"({figure})</td>") == len(verdicts(folder, f"claims-{figure}.md")) > 0
    assert html.count("data:image/svg+xml") == len(PICTURES[figure])
    moving = block(html)
    assert len(moving) == {"fig8": 3, "fig9": 1}.get(figure, 0)
    if figure == "fig9":
        (double,) = moving.values()
        titles = [track["title"] for track in double["tracks"][:2]]
        assert titles == ["force, pin on upper", "arc position, pin on upper"]
        assert all(len(lines) == 2 for lines in double["runs"][0]["lines"])


@pytest.mark.slow
def test_fig7a(tmp_path):
    """Slip-off displacements of theory section 7; bar 5e-4 with 18 elements."""
    found = {one["start"]: one for one in run("fig7a", tmp_path)["starting_positions"]}
    for start, exact in ((4.05, 1.7814439389), (4.35, 1.0524732309)):
        assert found[start]["slip_off_rod"] == pytest.approx(exact, rel=1e-10)
        assert found[start]["slip_off"]["18"] == pytest.approx(exact, rel=5e-4)
        assert found[start]["slip_off"]["72"] == pytest.approx(exact, rel=2e-4)
        assert found[start]["force_error"] < 5e-4
        assert found[start]["reached_in_contact"]["mixed"] == pytest.approx(exact, rel=5e-4)


@pytest.mark.slow
def test_fig8(tmp_path):
    """Bars: shapes of TSM and solid alike within 1 % of the length, `mixed` on the exact rod in every reading."""
    runs = {(one["reading"], one["label"]): one for one in run("fig8", tmp_path)["runs"]}
    paper = [runs["ks-cantilever", f"TSM timoshenko, {n} elements"] for n in (10, 20, 50)]
    assert [one["status"] for one in paper] == ["COMPLETED"] * 3
    assert max(one["shape_difference"] for one in paper) < 1e-2
    assert runs["ks-cantilever", "solid"]["error_path_shape"] < 1e-3
    assert runs["ks-cantilever", "TSM mixed, 20 elements"]["error_path_force"] < 1e-5
    assert runs["ks-printed-shear", "TSM mixed, 20 elements"]["error_path_force"] < 1e-5
    assert {reading for reading, _ in runs} == {"ks-cantilever", "ks-printed-shear", "ks-tied-tip"}
    assert runs["ks-tied-tip", "TSM mixed, 20 elements"]["error_path_shape"] < 1e-5


@pytest.mark.slow
def test_fig9(tmp_path, stated):
    """Exact depths of the coupled rods and, for the last, of the elastica (theory sections 7 and 8)."""
    found = run("fig9", tmp_path)
    assert found["exact_events"]["touch"] == pytest.approx(0.149786, abs=1e-6)
    stated("double-beam.hand-over", found["exact_events"]["hand-over"])
    assert found["exact_events"]["slip-off"] == pytest.approx(0.2 + 0.538697355, abs=1e-4)
    depth = {(event["kind"], event["pair"]): event["depth"] for event in found["events"]}
    assert depth["touch", "upper.end->lower"] == pytest.approx(found["exact_events"]["touch"], abs=1e-5)
    hand_over = depth["touch", "pin->lower"], depth["slip-off", "pin->upper"]
    error = np.abs(np.array(hand_over) - found["exact_events"]["hand-over"]).max()
    assert error <= 1e-5
    stated("double-beam.hand-over-error", error)
    assert depth["slip-off", "pin->lower"] == pytest.approx(found["exact_events"]["slip-off"], abs=1e-5)
    assert [check["stage"] for check in found["checks"]] == [
        "one rod under the pin", "coupled", "coupled", "the other rod under the pin",
    ]  # fmt: skip
    stated("paper.double-beam", max(max(check["force"], check["arc"]) for check in found["checks"]))
    assert [stage["key"] for stage in found["stages"]] == list("abcdef")
    depths = [stage["depth"] for stage in found["stages"]]
    assert depths == sorted(depths)
    decided = verdicts(tmp_path, "claims-fig9.md")
    for claim in (claim for claim in CLAIMS if claim.figure == "fig9"):
        assert decided[claim.text] == FULL[claim.judge.__qualname__], claim.text
    beside = {one["place"]: (one["status"], one["at_hand_over"]) for one in found["attempts"]}
    assert beside == {0.8: ("CUTBACK_FLOOR", False), 0.81: ("TWO_CONTACTS", True)}


def test_every_claim_of_the_paper_is_judged_once():
    wanted = [(source, word) for source, words in IN_THE_PAPER.items() for word in words]
    sections = list(IN_THE_PAPER)
    stated = sorted(
        ((place, text, claim.figure) for claim in CLAIMS for place, text in claim.stated),
        key=lambda one: sections.index(one[0].split(",")[0]),
    )
    assert len(wanted) == 27
    for (place, text, figure), (source, word) in zip(stated, wanted, strict=True):
        assert place.startswith(source)
        assert word in text
        assert figure in FIGURES
    assert list(FIGURES) == list(STUDIES)


def test_nothing_is_judged_without_its_study():
    assert "0 of 25 claims judged (27 statements)." in claims_text(Findings(quick=True))


@pytest.mark.slow
def test_command(tmp_path, capsys):
    assert main(["reproduce", "fig9", "--quick", "--out", str(tmp_path / "new")]) == 0
    out, err = capsys.readouterr()
    assert str(tmp_path / "new" / "claims-fig9.md") in out
    assert "fig9" in err
    (tmp_path / "file").write_text("kept")
    assert main(["reproduce", "fig9", "--quick", "--out", str(tmp_path / "file")]) == 2
    assert (tmp_path / "file").read_text() == "kept"
    with pytest.raises(SystemExit) as stop:
        main(["reproduce", "fig10"])
    assert stop.value.code == 2


@pytest.mark.slow
@pytest.mark.long
def test_all_with_full_settings(tmp_path, stated):
    done = reproduce("all", tmp_path, quick=False, report=lambda _: None)
    assert done.stopped == ()
    for figure in FIGURES:
        check_files(tmp_path, figure)
    found = verdicts(tmp_path)
    assert set(found) == {claim.text for claim in CLAIMS}
    assert set(found.values()) <= set(Verdict)
    for claim in CLAIMS:
        assert found[claim.text] == FULL[claim.judge.__qualname__], claim.text
    counts = Counter(FULL[claim.judge.__qualname__] for claim in CLAIMS)
    stated("paper.claims", len(CLAIMS))
    for verdict, name in ((Verdict.REPRODUCED, "reproduced"), (Verdict.IN_DIRECTION, "in-direction"),
                          (Verdict.NOT_REPRODUCED, "not-reproduced"), (Verdict.CANNOT_BE_TOLD, "open")):  # fmt: skip
        stated(f"paper.{name}", counts[verdict])
    summary = "; ".join(f"{counts[verdict]} {verdict}" for verdict in Verdict if counts[verdict])
    assert summary in (tmp_path / "claims.md").read_text()
    critical = json.loads((tmp_path / "fig7b.json").read_text())
    for element, slope, within in (
        ("euler-bernoulli-simple", -3, 0.05), ("euler-bernoulli-cantilever", -3, 0.05), (turned_frame.NAME, -3, 0.05),
        ("timoshenko", -1, 0.05), ("mixed", 0, 0.05),
    ):  # fmt: skip
        assert critical["slopes_of_the_floor"][element] == pytest.approx([slope, slope], abs=within)
    for element in ("euler-bernoulli-simple", "euler-bernoulli-cantilever", "timoshenko"):
        # round-off decides them, so another processor may differ
        stated(f"paper.tolerance-{element}", critical["tolerance_for_the_printed"][element], relative=0.5)
    simple, cantilever = (
        np.array([one["median"] for one in critical["critical_area"][f"euler-bernoulli-{form}"].values()])
        for form in ("simple", "cantilever")
    )
    assert 2.0 < (simple / cantilever).max() < 2.55
    stated("paper.gain", (simple / cantilever).max(), relative=0.2)
    assert (simple / cantilever)[-2:] == pytest.approx(1.0, abs=0.1)
    for tolerance, areas in critical["critical_area"]["mixed"].items():
        assert areas["largest"] <= NEAREST, tolerance

"""`crossval run paper`: files, numbers, verdicts. A figure with coarse settings, and all of them."""

import csv
import json
import re
from collections import Counter

import numpy as np
import pytest
from matplotlib.image import imread

from comparisons.cli import main
from comparisons.suites.paper.fig7 import PRINTED
from comparisons.suites.paper.reproduce import CLAIMS  # that each is on the page is the contract
from tests.comparisons.report.pages.markup import block, check_alone
from tests.comparisons.suites.paper.test_claims import CANTILEVER, SIMPLE, SLOPES, TIMOSHENKO

REPRODUCED, IN_DIRECTION = "reproduced", "reproduced in direction, not in size"
NOT, OPEN = "not reproduced", "cannot be told"
FILES = {
    "fig7a": (("fig7a",), ("fig7a",)),
    "fig7b": (("fig7b", "fig7b-tolerance", "fig7b-floor"),) * 2,
    "fig8": (("fig8", "fig8-tied-tip"), ("fig8", "fig8-shapes")),
    "fig9": (("fig9", "fig9-forces"), ("fig9",)),
}
"""Pictures and tables of a figure."""
VERDICTS = dict.fromkeys(CLAIMS, REPRODUCED) | {
    **dict.fromkeys(("cantilever-effective", "anything"), NOT),
    **dict.fromkeys((f"range-{element}" for element in PRINTED), OPEN),
    "cantilever-reduces": IN_DIRECTION,
    **dict.fromkeys(("simple-enough", "passes-every-edge", "every-edge"), OPEN),
}
"""What full settings make of every claim of [P]."""


def check_claims(page, *figures):
    """The page has every claim of some figures once, in the order of the paper, with its verdict."""
    found = re.findall(
        r"^\| (\d+) \| .* \| (.*?) \| [^|]* \((\w+)\) \| [^|]* \|$", page.read_text(), re.MULTILINE
    )
    wanted = {name: claim["figure"] for name, claim in CLAIMS.items() if claim["figure"] in figures}
    expected = [(VERDICTS[name], figure) for name, figure in wanted.items()]
    assert found == [(str(number), *one) for number, one in enumerate(expected, 1)]


def check_files(folder, figure):
    pictures, tables = FILES[figure]
    for stem in pictures:
        assert imread(folder / f"{stem}.png").std() > 0.03
        assert "<svg" in (folder / f"{stem}.svg").read_text()
    for stem in tables:
        with (folder / f"{stem}.csv").open() as file:
            rows = list(csv.DictReader(file))
        assert len(rows) > 5
        assert all(set(row) == set(rows[0]) and None not in row for row in rows)


@pytest.mark.slow
def test_fig9(tmp_path, capsys, stated):
    """Exact depths of the coupled rods and, for the last, of the elastica; every picture, claim and shape that moves is on the page."""
    assert main(["run", "fig9", "--quick", "--out", str(tmp_path)]) == 0
    out, err = capsys.readouterr()
    assert "fig9" in err
    assert out.startswith("4 of 5 claims of the paper are reproduced with coarse settings.\n")
    files = out.partition("files:\n")[2].splitlines()
    assert sorted(map(str, tmp_path.glob("[!.]*"))) == sorted(map(str.strip, files))
    check_files(tmp_path, "fig9")
    check_claims(tmp_path / "claims-fig9.md", "fig9")
    html = (tmp_path / "report.html").read_text()
    check_alone(html, tmp_path)
    assert html.count("(fig9)</td>") == sum(claim["figure"] == "fig9" for claim in CLAIMS.values())
    assert html.count("data:image/svg+xml") == len(FILES["fig9"][0])
    (moving,) = block(html).values()
    assert all(len(lines) == 2 for lines in moving["runs"][0]["lines"])
    found = json.loads((tmp_path / "fig9.json").read_text())
    exact = found["exact_events"]
    assert exact["touch"] == pytest.approx(0.149786, abs=1e-6)
    stated("double-beam.hand-over", exact["hand-over"])
    assert exact["slip-off"] == pytest.approx(0.2 + 0.538697355, abs=1e-4)
    depth = {(event["kind"], event["pair"]): event["depth"] for event in found["events"]}
    assert depth["touch", "upper.end->lower"] == pytest.approx(exact["touch"], abs=1e-5)
    hand_over = depth["touch", "pin->lower"], depth["slip-off", "pin->upper"]
    error = np.abs(np.array(hand_over) - exact["hand-over"]).max()
    assert error <= 1e-5
    stated("double-beam.hand-over-error", error)
    assert depth["slip-off", "pin->lower"] == pytest.approx(exact["slip-off"], abs=1e-5)
    stages = ["one rod under the pin", "coupled", "coupled", "the other rod under the pin"]
    assert [check["stage"] for check in found["checks"]] == stages
    stated("paper.double-beam", max(max(check["force"], check["arc"]) for check in found["checks"]))
    assert [stage["key"] for stage in found["stages"]] == list("abcdef")
    depths = [stage["depth"] for stage in found["stages"]]
    assert depths == sorted(depths)
    with (tmp_path / "fig9.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["pin->upper paper_force"]]
    forces = np.array([[row[f"pin->upper {of}force"] for of in ("exact_", "paper_")] for row in rows], float)
    assert forces[:, 1] == pytest.approx(forces[:, 0], rel=5e-3)
    paper = {"setting": "timoshenko 11", "status": "TWO_CONTACTS", "depth": float(rows[-1]["depth"])}
    assert found["paper"] == paper
    assert 0.0 < exact["hand-over"] - paper["depth"] < 0.01
    beside = {one["place"]: (one["status"], one["at_hand_over"]) for one in found["attempts"]}
    assert beside == {0.8: ("CUTBACK_FLOOR", False), 0.81: ("TWO_CONTACTS", True)}


@pytest.mark.slow
@pytest.mark.long
def test_all_with_full_settings(tmp_path, stated):
    assert main(["run", "paper", "--out", str(tmp_path)]) == 0
    for figure in FILES:
        check_files(tmp_path, figure)
    check_claims(tmp_path / "claims.md", *FILES)
    counts = Counter(VERDICTS.values())
    stated("paper.claims", len(CLAIMS))
    names = {"reproduced": REPRODUCED, "in-direction": IN_DIRECTION, "not-reproduced": NOT, "open": OPEN}
    for name, verdict in names.items():
        stated(f"paper.{name}", counts[verdict])
    summary = "; ".join(f"{counts[verdict]} {verdict}" for verdict in names.values())
    assert summary in (tmp_path / "claims.md").read_text()
    critical = json.loads((tmp_path / "fig7b.json").read_text())
    for element, slope in SLOPES.items():
        assert critical["slopes_of_the_floor"][element] == pytest.approx([slope, slope], abs=0.05)
    for element in (SIMPLE, CANTILEVER, TIMOSHENKO):
        # round-off decides them, so another processor may differ
        stated(f"paper.tolerance-{element}", critical["tolerance_for_the_printed"][element], relative=0.5)
    areas = critical["critical_area"]
    simple, clamped = (np.array(areas[element]["median"]) for element in (SIMPLE, CANTILEVER))
    assert (simple / clamped).max() > 2.0
    stated("paper.gain", (simple / clamped).max(), relative=0.2)
    # at 1e-11 this ratio is one of round-off, too: 1.00 and 1.13 on two processors
    assert (simple / clamped)[-2:] == pytest.approx(1.0, abs=0.2)
    assert max(areas["mixed"]["largest"]) <= 2e-8

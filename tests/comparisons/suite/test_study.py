"""`crossval run FILE.toml`: what a study file states, what is found, and one line for whatever is wrong."""

import pytest

from comparisons.cli import main
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.scene import load_scene
from docs.extensions.messages import SCENES
from tests.comparisons.suite.conftest import MANY, crossval, rows

HEAD = '[study]\nname = "mine"\nscene = "ks-cantilever"\nrepeats = 1\n'


@pytest.mark.slow
def test_cases_are_all_combinations_in_the_order_of_the_file(many):
    found = rows(many)
    assert [
        (row["model"], row["element"], row["elements"], row["mesh"], row["status"], row["verdict"])
        for row in found
    ] == [
        *[("tsm", "mixed", n, "", "COMPLETED", "CERTIFIED") for n in "248"],
        *[("tsm", "timoshenko", n, "", "CHECK_FAILED", "NOT_AN_EQUILIBRIUM") for n in "24"],
        ("tsm", "timoshenko", "8", "", "COMPLETED", "CERTIFIED"),
        ("rod", "", "", "", "COMPLETED", "CERTIFIED"),
        *[("solid", "", "", "10x1", "COMPLETED", "CERTIFIED")] * 3,
        ("tsm", "mixed", "", "", "REFUSED", ""),
        ("tsm", "", "5", "", "SLIPPED_OFF", "NOT_JUDGED"),
    ]
    solids = found[7:10]
    assert [float(row["beam.height"]) for row in solids] == pytest.approx([0.01, 0.02, 0.03])
    for row in solids:
        assert (row["beam.width"], row["contact.penalty"]) == ("0.5", "1000.0")
        assert row["pin.displacement"] == "-0.5 0.3"


def test_a_row_is_the_answer_at_the_last_load_parameter(many):
    row = next(row for row in rows(many) if (row["element"], row["elements"]) == ("mixed", "4"))
    answer = solve(load_scene("ks-cantilever"), "tsm", Options(elements=4, element="mixed"))
    contact = answer.contacts["pin->cantilever"]
    expected = {
        "load_parameter": 1.0,
        "force:pin->cantilever": contact.force[-1],
        "arc_position:pin->cantilever": contact.arc_position[-1],
        "moment:cantilever.start": answer.supports["cantilever.start"].moment[-1],
        "tip_x:cantilever": answer.tips["cantilever"][-1, 0],
        "tip_y:cantilever": answer.tips["cantilever"][-1, 1],
    }
    assert {name: float(row[name]) for name in expected} == pytest.approx(expected, rel=1e-9)


def test_the_table_and_what_is_done_is_not_done_again(many, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "300")
    before, kept = many.read_text(), {file.name for file in many.with_suffix("").iterdir()}
    assert crossval("run", MANY, "--out", many.parent, "--workers", "1") == 0
    out, err = capsys.readouterr()
    lines = out.splitlines()
    assert lines[0].split()[:4] == ["model", "element", "elements", "integration_tolerance"]
    assert lines[14].startswith("version ")
    assert lines[18].startswith("ks-cantilever, tsm mixed 20 tolerance 1e-09: REFUSED: tsm: ")
    assert lines[20:] == [
        "",
        "many: 12 cases: CHECK_FAILED 2, COMPLETED 8, REFUSED 1, SLIPPED_OFF 1",
        "files:",
        f"  {many}",
    ]
    assert err == "12 of 12 cases done, 4 failed\n"
    assert many.read_text() == before
    assert {file.name for file in many.with_suffix("").iterdir()} == kept
    assert len(kept) == 12


@pytest.mark.slow
def test_the_scene_is_varied_through_its_records(tmp_path, monkeypatch):
    """A scene beside the study; all beams or one by name; records without a name by their place."""
    (tmp_path / "scenes").mkdir()
    (tmp_path / "scenes" / "hinged.toml").write_text(
        SCENES["portal"]
        + '[[hinge]]\nbeam = "girder"\nend = "start"\n[[spring]]\nbeam = "girder"\nend = "start"\nstiffness = [0, 5]\n'
        + '[[load]]\nbeam = "girder"\nat = 0.5\nforce = [0, -1]\n'
        + '[[stage]]\nload_parameters = 3\nload = [{ beam = "column", end = "end", force = [1, 0] }]\n'
    )
    changes = {
        'hinge."girder.start".stiffness': "2.0",
        'spring."girder.start".rotation': "3.0",
        'load."girder at 0.5".moment': "4.0",
        "stage.2.load_parameters": "5",
        "beam.girder.elements": "7",
        "beam.elements": "3",
    }
    run = '[[run]]\nmodel = "tsm"\n'
    lines = "".join(f"{key} = {value}\n" for key, value in changes.items())
    study = tmp_path / "study.toml"
    study.write_text(HEAD.replace("ks-cantilever", "scenes/hinged.toml") + run + run + lines)
    monkeypatch.chdir("/")
    assert main(["run", str(study), "--out", str(tmp_path), "--workers", "1", "--quiet"]) == 0
    _, row = sorted(rows(tmp_path / "mine.csv"), key=lambda row: row["hinge.stiffness"] == "2.0")
    named = {key for key in row if key.count(".") and row[key] in changes.values()}
    assert {row[key] for key in named} == set(changes.values())
    assert (row["beam.girder.elements"], row["beam.column.elements"]) == ("7", "3")

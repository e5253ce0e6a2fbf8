"""`crossval run FILE.toml`: what a study file states, what is found, and one line for whatever is wrong."""

import io
import json
import re
import shutil
import sys

import pytest

from comparisons.cli import main
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.scene import load_scene
from docs.extensions.messages import SCENES
from tests.comparisons.cases.conftest import crossval, rows

HEAD = '[study]\nname = "mine"\nscene = "ks-cantilever"\nrepeats = 1\n'
RUN = '[[run]]\nmodel = "tsm"\n'


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


def test_the_table_and_what_is_done_is_not_done_again(many, capsys):
    before, kept = many.read_text(), {file.name for file in many.with_suffix("").iterdir()}
    study = many.with_suffix(".toml")
    assert crossval("run", study, "--out", many.parent, "--workers", "1") == 0
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


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.mark.slow
def test_progress_is_a_bar_on_a_terminal_and_lines_elsewhere(many, tmp_path, monkeypatch):
    """Two cases are left to do."""
    for stream in (Terminal(), io.StringIO()):
        folder = tmp_path / type(stream).__name__
        shutil.copytree(many.with_suffix(""), folder / "many")
        for file in folder.glob("many/*"):
            told = json.loads(file.read_text())
            if told["model"] == "rod" or told["response"]["status"] == "REFUSED":
                file.unlink()
        monkeypatch.setattr(sys, "stderr", stream)
        assert crossval("run", many.with_suffix(".toml"), "--out", folder, "--workers", "1") == 0
        text = stream.getvalue()
        if stream.isatty():
            first, *_, last = text.split("\r")[1:]
            assert [picture.count("#") for picture in (first, last)] == [25, 30]
            assert last.endswith("12 of 12 cases done, 4 failed\x1b[K\n")
        else:
            assert text.splitlines()[0] == "10 of 12 cases done, 3 failed"
            assert text.splitlines()[-1] == "12 of 12 cases done, 4 failed"
            assert re.search(r"^\d+ of 12 cases done, \d failed, \d:\d\d left$", text, re.MULTILINE)


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


BAD = {
    "run[0].beam.height = -1: must be a positive number": "beam.height = [0.1, -1]",
    "run[0].beam.heigth = 1: unknown key, did you mean height?": "beam.heigth = 1",
    "run[0].beam.area = 1.0: give either width and height or area and second_moment, not both": "beam.area = 1",
    "run[0].beam.cantilevr = {height = 1}: unknown key, did you mean cantilever?": "beam.cantilevr.height = 1",
    "run[0].elemnts = 1: unknown key, did you mean elements?": "elemnts = 1",
    "run[0].elements = 0: must be a whole number from 1 to 100000": "elements = [1, 0]",
    "run[0].elements = 7.5: must be a whole number": "elements = { from = 5, to = 10, count = 3 }",
    "run[0].elements = []: must not be empty": "elements = []",
    "run[1].model = []: must not be empty": "[[run]]\nmodel = []",
    'run[0].elements.spacing = "lin": must be one of': 'elements = { from = 5, to = 10, count = 3, spacing = "lin" }',
    "run[0].elements.count = 1: must be at least 2": "elements = { from = 5, to = 6, count = 1 }",
    "run[0].beam.height.from = 0: must be positive in a range": 'beam.height = { from = 0, to = 1, count = 3, spacing = "log" }',
    'run[0].element = "mixd": must be one of': 'element = "mixd"',
    "run[0].integration_tolerance = 2: must be a number between 0 and 1": "integration_tolerance = 2",
    'run[0].mesh = "25x2": is no option of model = "tsm"': 'mesh = "25x2"',
    "run[1].mesh = 25: must be NXxNY": '[[run]]\nmodel = "solid"\nmesh = [25]',
    'run[1].model = "fem": must be one of': '[[run]]\nmodel = "fem"',
    "run[0].scene = 3: unknown key": "scene = 3",
    "run[0].scene.units = {a = 3}: unknown key": "scene.units.a = 3",
    "run[0].load = {moment = 1}: the scene has no load": "load.moment = 1",
    "run[0].contact[0].beam = ": 'beam.name = "other"',
    "run = 1000000: must be at most 100000 cases": "elements = { from = 1, to = 10000, count = 10000 }\n"
    "scene.load_parameters = { from = 1, to = 100, count = 100 }",
    "must be valid TOML": "[[run]",
}
BAD_HEADS = {
    "study.scene = (missing): must be given": '[study]\nname = "a"\n',
    "study.name = ": '[study]\nname = "a b"\nscene = "ks-face"\n',
    "study.repeats = 0: must be a whole number": HEAD.replace("repeats = 1", "repeats = 0"),
    "study.repeat = 3: unknown key, did you mean repeats?": HEAD + "repeat = 3\n",
    "study = 3: must be a table": "study = 3\n",
    "": HEAD.replace("ks-cantilever", "nosuch"),
}


TEXTS = (
    {"run = (missing): must be given": HEAD}
    | {reason: HEAD + RUN + text for reason, text in BAD.items()}
    | {reason: head + RUN for reason, head in BAD_HEADS.items()}
)


@pytest.mark.parametrize("reason", TEXTS)
def test_what_is_wrong_in_a_study_is_one_line(reason, tmp_path, capsys):
    path = tmp_path / "study.toml"
    path.write_text(TEXTS[reason])
    assert main(["run", str(path), "--out", str(tmp_path / "out")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    found = f"{path}: {reason}" if reason else f"{tmp_path / 'nosuch'}: no such file or built-in scene"
    assert line.startswith(f"crossval: {found}")
    assert [item.name for item in tmp_path.iterdir()] == ["study.toml"]


ARGUMENTS = {
    "nosuch: must be a study file, NAME.toml, or one of paper, fig7a": ["run", "nosuch"],
    "nosuch.toml: no such file": ["run", "nosuch.toml"],
    "argument --workers: 0: must be a whole number": ["run", "STUDY", "--workers", "0"],
    "--cluster: is no longer an option, see --workers ADDRESS": ["run", "STUDY", "--cluster", "tcp://a:1"],
    "results: is no longer a command, see": ["results", "a.sqlite"],
    "STUDY: cannot be written": ["run", "STUDY", "--out", "STUDY"],
    "--workers: is no option of locking": ["run", "locking", "--workers", "2"],
    "SCENE: is missing: crossval run trade SCENE": ["run", "trade"],
    "SCENE: is no option of extremes": ["run", "extremes", "ks-cantilever"],
    "gate: is no longer a command, see crossval compare": ["gate", "ks-cantilever"],
    "nosuch: no such file or built-in scene": ["run", "trade", "nosuch", "--out", "DIR/out"],
    "argument --workers: 0: must": ["run", "trade", "ks-cantilever", "--workers", "0", "--out", "DIR/out"],
    "STUDY/x: cannot be written": ["run", "trade", "ks-cantilever", "--out", "STUDY/x"],
    "STUDY: cannot be written:": ["run", "extremes", "--quick", "--out", "STUDY"],
    "STUDY/y: cannot be written": ["run", "cards", "--out", "STUDY/y"],
    "rollup: no such problem (dead-load, roll-up, ": ["run", "manual", "rollup", "--out", "DIR/m"],
    "STUDY/z: cannot be written": ["run", "fig9", "--quick", "--out", "STUDY/z"],
}


@pytest.mark.parametrize("reason", ARGUMENTS)
def test_bad_arguments_of_a_command_are_one_line_and_compute_nothing(reason, tmp_path, capsys):
    path = tmp_path / "study.toml"
    path.write_text(HEAD + RUN)

    def filled(text):
        return text.replace("STUDY", str(path)).replace("DIR", str(tmp_path))

    assert crossval(*map(filled, ARGUMENTS[reason])) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert filled(reason) in err.splitlines()[-1]
    assert [item.name for item in tmp_path.iterdir()] == ["study.toml"]
    assert path.read_text() == HEAD + RUN

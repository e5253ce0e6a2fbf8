"""`crossval study` and `crossval results`: what a study file states, what is found, and one line for whatever is wrong."""

import io
import re
import sqlite3
import sys
import zlib
from pathlib import Path

import pytest

from comparisons.cli import main
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.scene import load_scene
from docs.extensions.messages import SCENES
from tests.comparisons.cases.conftest import asked, crossval, rows

HEAD = '[study]\nname = "mine"\nscene = "ks-cantilever"\nrepeats = 1\n'
RUN = '[[run]]\nmodel = "tsm"\n'


def test_cases_are_all_combinations_sorted_by_what_varies(many):
    found = rows(many)
    assert [
        (row["model"], row["element"], row["elements"], row["mesh"], row["status"], row["verdict"])
        for row in found
    ] == [
        ("rod", "", "", "", "COMPLETED", "CERTIFIED"),
        *[("solid", "", "", "10x1", "COMPLETED", "CERTIFIED")] * 3,
        ("tsm", "", "", "", "REFUSED", ""),
        ("tsm", "", "5", "", "SLIPPED_OFF", "NOT_JUDGED"),
        *[("tsm", "mixed", n, "", "COMPLETED", "CERTIFIED") for n in "248"],
        *[("tsm", "timoshenko", n, "", "CHECK_FAILED", "NOT_AN_EQUILIBRIUM") for n in "24"],
        ("tsm", "timoshenko", "8", "", "COMPLETED", "CERTIFIED"),
    ]
    solids = found[1:4]
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
    assert float(row["seconds"]) > 0.0


def test_the_table_of_one_scene_of_several_and_of_none(many, copy, capsys):
    assert main(["results", str(many)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split()[:4] == ["model", "element", "elements", "integration_tolerance"]
    assert "version" not in lines[0]
    assert lines[14].startswith("version ")
    assert lines[16].startswith("ks-cantilever, tsm mixed 20 tolerance 1e-09: REFUSED: tsm: ")
    assert len(lines) == 20
    assert set(rows(many)[0]) - set(rows(many, "--no-timings")[0]) == {"seconds", "repeats", "peak_memory"}
    asked(copy, "UPDATE result SET scene = 'another' WHERE model = 'rod'")
    assert [row["scene"] for row in rows(copy)] == ["another", *["ks-cantilever"] * 11]
    assert main(["results", str(copy)]) == 0
    assert capsys.readouterr().out.startswith("scene")
    asked(copy, "DELETE FROM result")
    assert (main(["results", str(copy)]), capsys.readouterr().out, rows(copy)) == (0, "no results yet\n", [])


def test_what_is_done_is_not_done_again(many, capsys):
    before = rows(many)
    study = many.with_suffix(".toml")
    assert main(["study", str(study), "--out", str(many.parent), "--workers", "1"]) == 0
    out, err = capsys.readouterr()
    assert out.splitlines() == [
        "many: 12 cases: CHECK_FAILED 2, COMPLETED 8, REFUSED 1, SLIPPED_OFF 1",
        f"file: {many}",
        f"crossval results {many} shows them",
    ]
    assert err == ""
    assert rows(many) == before
    assert sorted(path.name for path in many.parent.iterdir()) == ["many.sqlite", "many.toml"]


def test_results_of_another_version(many, copy, capsys):
    """Are kept where that is asked for, with one line; the table has a column of versions then."""
    own = rows(copy)[0]["version"]
    asked(copy, "UPDATE result SET version = '0.1.0', key = 'x' || key WHERE model != 'rod'")
    study = str(many.with_suffix(".toml"))
    assert main(["study", study, "--results", str(copy), "--quiet", "--keep-old-versions"]) == 0
    assert capsys.readouterr().err == "crossval: 11 results of other versions (0.1.0) were kept\n"
    assert main(["results", str(copy)]) == 0
    text = capsys.readouterr().out
    assert f"\nversion 0.1.0, {own}\n" in text
    assert [line.split()[-1] for line in text.splitlines()[:3]] == ["version", own, "0.1.0"]


@pytest.mark.slow
def test_wrong_results_of_another_version_are_computed_anew(many, copy, capsys):
    right = rows(many, "--no-timings")
    change = "UPDATE result SET version = '0.1.0', key = 'x' || key, status = 'WRONG' WHERE label LIKE ?"
    asked(copy, change, "%mixed 4")
    command = ["study", str(many.with_suffix(".toml")), "--results", str(copy), "--workers", "1", "--quiet"]
    told = "crossval: 1 results of other versions (0.1.0) were left aside, and the cases computed anew\n"
    for said in (told, ""):
        assert main(command) == 0
        out, err = capsys.readouterr()
        assert err == said
        assert "WRONG" not in out
    assert [row for row in rows(copy, "--no-timings") if row["version"] != "0.1.0"] == right


@pytest.mark.parametrize(
    "blob",
    [b"", b"mine", zlib.compress(b"{}"), zlib.compress(b"[1]"), zlib.compress(b"\xff"), "text", None, 7],
)
def test_a_damaged_result_is_one_line(blob, copy, capsys):
    if blob is None:
        (blob,) = asked(copy, "SELECT substr(measurement, 1, 40) FROM result WHERE model = 'rod'")[0]
    asked(copy, "UPDATE result SET measurement = ? WHERE model = 'rod'", blob)
    assert main(["results", str(copy)]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err == f"crossval: {copy}: cannot be read: the result of 'ks-cantilever, rod' is damaged\n"


def other_database(path):
    sqlite3.connect(path).execute("CREATE TABLE result (key TEXT)").connection.commit()


OTHER_FILES = {
    "file is not a database": lambda path: path.write_text("key,status\n" * 100),
    "is no results file of crossval, but another SQLite database": other_database,
    "has schema 99, this version of crossval reads 3: choose another file": lambda path: asked(
        path, "PRAGMA user_version = 99"
    ),
    "has schema 1, this version of crossval reads 3: choose another file": lambda path: asked(
        path, "PRAGMA user_version = 1"
    ),
    "is not a regular file": Path.mkdir,
    "there is no such file": lambda _: None,
}


@pytest.mark.parametrize("reason", OTHER_FILES)
def test_other_files_are_refused_and_left_alone(reason, many, tmp_path, capsys):
    path = tmp_path / "a.sqlite"
    if "schema" in reason:
        path.write_bytes(many.read_bytes())
    OTHER_FILES[reason](path)
    before = path.read_bytes() if path.is_file() else None
    commands = [["study", many.with_suffix(".toml"), "--results", path]] * path.exists()
    for command in (*commands, ["results", path]):
        assert crossval(*command) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert line.startswith(f"crossval: {path}: ")
        assert reason in line or (path.is_dir() and "there is no such file" in line)
    assert (path.read_bytes() if path.is_file() else None) == before
    assert [item.name for item in tmp_path.iterdir()] == [path.name] * path.exists()


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_progress_is_a_bar_on_a_terminal_and_lines_elsewhere(many, copy, monkeypatch):
    """Two cases are left to do; the message of a file that is none of ours stands in a line of its own."""
    study = str(many.with_suffix(".toml"))
    asked(copy, "DELETE FROM result WHERE model = 'rod' OR status = 'REFUSED'")
    for schema, status in ((3, 0), (1, 2)):
        for stream in (Terminal(), io.StringIO()):
            monkeypatch.setattr(sys, "stderr", stream)
            file = copy.with_name(f"{type(stream).__name__}.sqlite")
            file.write_bytes(copy.read_bytes())
            asked(file, f"PRAGMA user_version = {schema}")
            assert main(["study", study, "--results", str(file), "--workers", "1"]) == status
            text = stream.getvalue()
            if status:
                assert (
                    text.strip("\n")
                    == f"crossval: {file}: has schema 1, this version of crossval reads 3: choose another file"
                )
                assert text.startswith("\n") is stream.isatty()
            elif stream.isatty():
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
    assert main(["study", str(study), "--out", str(tmp_path), "--workers", "1", "--quiet"]) == 0
    _, row = sorted(rows(tmp_path / "mine.sqlite"), key=lambda row: row["hinge.stiffness"] == "2.0")
    named = {key for key in row if key.count(".") and row[key] in changes.values()}
    assert {row[key] for key in named} == set(changes.values())
    assert (row["beam.girder.elements"], row["beam.column.elements"]) == ("7", "3")


BAD = {
    "run[0].beam.height = -1: must be positive": "beam.height = [0.1, -1]",
    "run[0].beam.heigth = 1: unknown key, did you mean height?": "beam.heigth = 1",
    "run[0].beam.area = 1.0: give either width and height or area and second_moment, not both": "beam.area = 1",
    "run[0].beam.cantilevr = {height = 1}: unknown key, did you mean cantilever?": "beam.cantilevr.height = 1",
    "run[0].elemnts = 1: unknown key, did you mean elements?": "elemnts = 1",
    "run[0].elements = 0: must lie between 1 and 100000": "elements = [1, 0]",
    "run[0].elements = 7.5: must be a whole number": "elements = { from = 5, to = 10, count = 3 }",
    "run[0].elements = []: must not be empty": "elements = []",
    'run[0].elements.spacing = "lin": must be one of': 'elements = { from = 5, to = 10, count = 3, spacing = "lin" }',
    "run[0].elements.count = 1: must be at least 2": "elements = { from = 5, to = 6, count = 1 }",
    "run[0].beam.height.from = 0: must be positive in a range": 'beam.height = { from = 0, to = 1, count = 3, spacing = "log" }',
    'run[0].element = "mixd": must be one of': 'element = "mixd"',
    "run[0].integration_tolerance = 2: must lie between 0 and 1": "integration_tolerance = 2",
    'run[0].mesh = "25x2": is no option of model = "tsm"': 'mesh = "25x2"',
    "run[1].mesh = 25: must be NXxNY": '[[run]]\nmodel = "solid"\nmesh = [25]',
    'run[1].model = "fem": must be one of': '[[run]]\nmodel = "fem"',
    "run[0].scene = 3: must be followed by a key, scene.KEY": "scene = 3",
    "run[0].load = {moment = 1}: the scene has no load": "load.moment = 1",
    "run[0].contact[0].beam = ": 'beam.name = "other"',
    "run = 1000000: must be at most 100000 cases": "elements = { from = 1, to = 10000, count = 10000 }\n"
    "scene.load_parameters = { from = 1, to = 100, count = 100 }",
    "must be valid TOML": "[[run]",
}
BAD_HEADS = {
    "study.scene = (missing): must be given": '[study]\nname = "a"\n',
    "study.name = ": '[study]\nname = "a b"\nscene = "ks-face"\n',
    "study.repeats = 0: must lie between": HEAD.replace("repeats = 1", "repeats = 0"),
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
    assert main(["study", str(path), "--out", str(tmp_path / "out")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    found = f"{path}: {reason}" if reason else f"{tmp_path / 'nosuch'}: no such file or built-in scene"
    assert line.startswith(f"crossval: {found}")
    assert [item.name for item in tmp_path.iterdir()] == ["study.toml"]


ARGUMENTS = {
    "nosuch: must be a study file, NAME.toml, or one of locking": ["study", "nosuch"],
    "nosuch.toml: no such file": ["study", "nosuch.toml"],
    "argument --workers: 0: must lie between 1": ["study", "STUDY", "--workers", "0"],
    "not allowed with argument --workers": ["study", "STUDY", "--workers", "2", "--cluster", "tcp://a:1"],
    "there is no folder": ["study", "STUDY", "--results", "DIR/none/a.sqlite"],
    "file is not a database": ["study", "STUDY", "--results", "STUDY"],
    "STUDY: cannot be written": ["study", "STUDY", "--out", "STUDY"],
    "--workers: belongs to a study file, locking is a question": ["study", "locking", "--workers", "2"],
    "nosuch: no such file or built-in scene": ["trade", "nosuch", "--out", "DIR/out"],
    "argument --workers: 0: must": ["trade", "ks-cantilever", "--workers", "0", "--out", "DIR/out"],
    "--cluster: not allowed": [
        "trade",
        "ks-face",
        "--workers",
        "1",
        "--cluster",
        "tcp://a:1",
        "--out",
        "DIR/out",
    ],
    "STUDY/x: cannot be written": ["trade", "ks-cantilever", "--out", "STUDY/x"],
    "STUDY: cannot be written:": ["extremes", "--quick", "--out", "STUDY"],
    "STUDY/y: cannot be written": ["manual", "--cards", "STUDY/y"],
    "--only: rollup: no such problem (dead-load, roll-up, ": ["manual", "--out", "DIR/m", "--only", "rollup"],
    "STUDY/z: cannot be written": ["reproduce", "fig9", "--quick", "--out", "STUDY/z"],
    "invalid choice: 'fig10'": ["reproduce", "fig10"],
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

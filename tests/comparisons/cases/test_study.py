"""Study files: what they state, and one line for everything that is wrong."""

import sys
from pathlib import Path

import pytest

from comparisons.cases.study import Study, read_study
from comparisons.cli import main
from comparisons.models.options import Options
from comparisons.scene import InputError, built_in_scenes, load_scene
from docs.extensions.messages import SCENES

HEAD = '[study]\nname = "mine"\nscene = "ks-cantilever"\n'


def read(tmp_path: Path, runs: str, head: str = HEAD) -> Study:
    path = tmp_path / "study.toml"
    path.write_text(head + runs)
    return read_study(path)


def test_cases_are_all_combinations_in_order_each_once(tmp_path: Path) -> None:
    study = read(
        tmp_path,
        """
        [[run]]
        model = "tsm"
        element = ["mixed", "timoshenko"]
        elements = { from = 5, to = 20, count = 3, spacing = "log" }
        [[run]]
        model = ["tsm", "rod"]
        [[run]]
        model = "tsm"
        elements = 10
        element = "mixed"
        """,
    )
    assert (study.name, study.repeats) == ("mine", 3)
    assert [(case.model, case.options.element, case.options.elements) for case in study.cases] == [
        *(("tsm", "mixed", n) for n in (5, 10, 20)),
        *(("tsm", "timoshenko", n) for n in (5, 10, 20)),
        ("tsm", None, None),
        ("rod", None, None),
    ]
    assert {case.scene for case in study.cases} == {load_scene("ks-cantilever")}


def test_the_scene_is_varied_through_its_records(tmp_path: Path) -> None:
    study = read(
        tmp_path,
        """
        [[run]]
        model = "solid"
        mesh = ["25x2", "50x2"]
        scene.load_parameters = 10
        beam.height = { from = 0.01, to = 0.03, count = 3 }
        beam.cantilever.width = 0.5
        beam.solid_element = "Q1"
        contact."pin->cantilever".penalty = 1e3
        pin.displacement = [[-0.5, 0.3]]
        """,
    )
    heights = [0.01, 0.02, 0.03]
    assert [case.scene.beams[0].height for case in study.cases] == [pytest.approx(h) for h in 2 * heights]
    assert [case.options for case in study.cases] == [
        Options(mesh=mesh) for mesh in ((25, 2), (50, 2)) for _ in heights
    ]
    (scene, *_) = (case.scene for case in study.cases)
    assert (scene.load_parameters, scene.contacts[0].penalty) == (10, 1e3)
    assert (scene.beams[0].width, scene.beams[0].solid_element) == (0.5, "Q1")
    assert scene.pins[0].displacement == (-0.5, 0.3)


def test_all_beams_or_one_by_name(tmp_path: Path) -> None:
    head = '[study]\nname = "two"\nscene = "double-beam"\nrepeats = 1\n'
    runs = '[[run]]\nmodel = "tsm"\nbeam.upper.elements = 7\nbeam.elements = [3, 4]\n'
    study = read(tmp_path, runs, head)
    assert study.repeats == 1
    assert [[beam.elements for beam in case.scene.beams] for case in study.cases] == [[7, 3], [7, 4]]


def test_a_scene_beside_the_study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "scenes").mkdir()
    (tmp_path / "scenes" / "mine.toml").write_text(
        built_in_scenes()["ks-cantilever"].replace('name = "ks-cantilever"', 'name = "mine"')
    )
    monkeypatch.chdir("/")
    study = read(tmp_path, '[[run]]\nmodel = "rod"\n', HEAD.replace("ks-cantilever", "scenes/mine.toml"))
    assert study.cases[0].scene.name == "mine"


def test_records_without_a_name_are_addressed_by_their_place(tmp_path: Path) -> None:
    (tmp_path / "hinged.toml").write_text(
        SCENES["portal"]
        + '[[hinge]]\nbeam = "girder"\nend = "start"\n[[spring]]\nbeam = "girder"\nend = "start"\nstiffness = [0, 5]\n'
        + '[[load]]\nbeam = "girder"\nat = 0.5\nforce = [0, -1]\n'
        + '[[stage]]\nload_parameters = 3\nload = [{ beam = "column", end = "end", force = [1, 0] }]\n'
    )
    study = read(
        tmp_path,
        """
        [[run]]
        model = "tsm"
        hinge."girder.start".stiffness = 2.0
        spring."girder.start".rotation = 3.0
        load."girder at 0.5".moment = 4.0
        stage.2.load_parameters = 5
        """,
        HEAD.replace("ks-cantilever", "hinged.toml"),
    )
    (scene,) = (case.scene for case in study.cases)
    assert (scene.hinges[0].stiffness, scene.springs[0].rotation) == (2.0, 3.0)
    assert [load.moment for load in scene.loads] == [0.0, 4.0]
    assert scene.stages[0].load_parameters == 5


RUN = '[[run]]\nmodel = "tsm"\n'
BAD = {
    "run[0].beam.height = -1: must be positive": RUN + "beam.height = [0.1, -1]",
    "run[1].beam.height = -1.0: must be positive": RUN
    + RUN
    + "beam.height = { from = 1.0, to = -1.0, count = 2 }",
    "run[0].beam.cantilever.height = -1: must be positive": RUN + "beam.cantilever.height = -1",
    "run[0].beam.heigth = 1: unknown key, did you mean height?": RUN + "beam.heigth = 1",
    "run[0].beam.area = 1.0: give either width and height or area and second_moment, not both": RUN
    + "beam.area = 1",
    "run[0].beam.cantilevr = {height = 1}: unknown key, did you mean cantilever?": RUN
    + "beam.cantilevr.height = 1",
    "run[0].elemnts = 1: unknown key, did you mean elements?": RUN + "elemnts = 1",
    "run[0].elements = 0: must lie between 1 and 100000": RUN + "elements = [1, 0]",
    "run[0].elements = 7.5: must be a whole number": RUN + "elements = { from = 5, to = 10, count = 3 }",
    "run[0].elements = []: must not be empty": RUN + "elements = []",
    'run[0].elements.spacing = "lin": must be one of': RUN
    + 'elements = { from = 5, to = 10, count = 3, spacing = "lin" }',
    "run[0].elements.to = (missing): must be given": RUN + "elements = { from = 5, count = 3 }",
    "run[0].elements.count = 1: must be at least 2": RUN + "elements = { from = 5, to = 6, count = 1 }",
    "run[0].beam.height.from = 0: must be positive in a range": RUN
    + 'beam.height = { from = 0, to = 1, count = 3, spacing = "log" }',
    'run[0].element = "mixd": must be one of': RUN + 'element = "mixd"',
    "run[0].integration_tolerance = 2: must lie between 0 and 1": RUN
    + 'element = "exact"\nintegration_tolerance = 2',
    'run[0].mesh = "25x2": is no option of model = "tsm"': RUN + 'mesh = "25x2"',
    "run[0].mesh = 25: must be NXxNY": '[[run]]\nmodel = "solid"\nmesh = [25]',
    'run[0].model = "fem": must be one of': '[[run]]\nmodel = "fem"',
    "run[0].model = (missing): must be given": "[[run]]\nelements = 3",
    "run[0].scene.load_parameters = 0: must lie between": RUN + "scene.load_parameters = 0",
    "run[0].scene.steps = 3: unknown key": RUN + "scene.steps = 3",
    "run[0].scene = 3: must be followed by a key, scene.KEY": RUN + "scene = 3",
    "run[0].load = {moment = 1}: the scene has no load": RUN + "load.moment = 1",
    "run[0].contact[0].beam = ": RUN + 'beam.name = "other"',
    "run = 1000000: must be at most 100000 cases": RUN
    + "elements = { from = 1, to = 10000, count = 10000 }\nscene.load_parameters = { from = 1, to = 100, count = 100 }",
    "run = (missing): must be given": "",
    "must be valid TOML": "[[run]\n",
}


@pytest.mark.parametrize("reason", BAD)
def test_what_is_wrong_is_one_line(reason: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, BAD[reason])
    message = str(caught.value)
    assert message.startswith(f"{tmp_path / 'study.toml'}: {reason}")
    assert "\n" not in message


@pytest.mark.parametrize(
    ("head", "reason"),
    [
        ('[study]\nname = "a"\n', "study.scene = (missing): must be given"),
        ('[study]\nname = "a b"\nscene = "ks-face"\n', "study.name = "),
        (HEAD + "repeats = 0\n", "study.repeats = 0: must lie between"),
        (HEAD + "repeat = 3\n", "study.repeat = 3: unknown key, did you mean repeats?"),
        ("study = 3\n", "study = 3: must be a table"),
        (HEAD.replace("ks-cantilever", "nosuch"), "no such file or built-in scene"),
    ],
)
def test_a_wrong_head_is_one_line(head: str, reason: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, RUN, head)
    assert reason in str(caught.value)


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["nosuch"], "nosuch: must be a study file, NAME.toml, or one of locking"),
        (["nosuch.toml"], "nosuch.toml: no such file"),
        (["STUDY", "--workers", "0"], "argument --workers: 0: must lie between 1"),
        (["STUDY", "--workers", "2", "--cluster", "tcp://a:1"], "not allowed with argument --workers"),
        (["STUDY", "--results", "DIR/none/a.sqlite"], "there is no folder"),
        (["STUDY", "--results", "STUDY"], "file is not a database"),
        (["STUDY", "--out", "STUDY"], "cannot be written"),
        (["locking", "--workers", "2"], "--workers: belongs to a study file, locking is a question"),
    ],
)
def test_bad_arguments_are_status_2_with_one_reason(
    arguments: list[str], reason: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "study.toml"
    path.write_text(HEAD + RUN)
    given = [part.replace("STUDY", str(path)).replace("DIR", str(tmp_path)) for part in arguments]
    try:
        status = main(["study", *given])
    except SystemExit as exit_:
        status = int(exit_.code or 0)
    assert status == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert reason in err.splitlines()[-1]
    assert [item.name for item in tmp_path.iterdir()] == ["study.toml"]
    assert path.read_text() == HEAD + RUN


def test_a_study_from_file_to_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "study.toml"
    runs = 'elements = [2, 3]\nscene.load_parameters = 2\n[[run]]\nmodel = "rod"\nscene.load_parameters = 2\n'
    path.write_text(HEAD + "repeats = 1\n" + RUN + runs)
    for reported in ("0 of 3 cases done", ""):
        assert main(["study", str(path), "--out", str(tmp_path / "out"), "--workers", "1"]) == 0
        out, err = capsys.readouterr()
        file = tmp_path / "out" / "mine.sqlite"
        assert out.splitlines()[:2] == ["mine: 3 cases: COMPLETED 3", f"file: {file}"]
        assert err.startswith(reported)
    assert [item.name for item in file.parent.iterdir()] == ["mine.sqlite"]
    assert main(["results", str(file)]) == 0
    *table, blank, of = capsys.readouterr().out.splitlines()
    assert (len(table), blank) == (4, "")
    assert of.startswith("version ")


def test_a_cluster_without_its_extra(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    path = tmp_path / "study.toml"
    path.write_text(HEAD + RUN)
    assert main(["study", str(path), "--out", str(tmp_path / "out"), "--cluster", "tcp://a:1"]) == 2
    expected = "crossval: cluster tcp://a:1: needs distributed: install tsm-crossval[cluster]\n"
    assert capsys.readouterr().err == expected

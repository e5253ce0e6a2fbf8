"""A program of others in a child process: limits, named failures, its file, and every command that takes a model."""

import contextlib
import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import psutil
import pytest

from comparisons.cases import measure
from comparisons.cases.case import Case
from comparisons.cases.measure import Measurement
from comparisons.cli import main
from comparisons.models import find, solve
from comparisons.models.options import ModelError, Options
from comparisons.models.outside.child import ENVIRONMENT
from comparisons.models.outside.program_file import ProgramFileError, read_program
from comparisons.response.material import frictions
from comparisons.scene import load_scene
from tests.comparisons.models.outside.conftest import KS, PAIR

Make = Callable[..., str]

FAILURES = {
    "no output": ("sys.exit()", "INVALID_JSON", "Expecting value"),
    "an exit status": ("sys.exit('no luck')", "CRASHED", "ended with exit status 1: no luck"),
    "a signal": ("os.kill(os.getpid(), 9)", "CRASHED", "was ended by SIGKILL: no message"),
    "an exception": ("1 / 0", "CRASHED", "ZeroDivisionError: division by zero"),
    "memory": (
        "x = bytearray(400_000_000); time.sleep(60)",
        "OUT_OF_MEMORY",
        "took more than 200 MB of memory",
    ),
    "a list": ("answer = [answer]", "INVALID_RESPONSE", "the output must be a table"),
    "bytes": ("sys.stdout.buffer.write(bytes([255])); sys.exit()", "INVALID_JSON", "codec can't decode"),
    "another scene": ("answer['scene'] = 'other'", "INVALID_RESPONSE", "scene = other: the scene was ks-"),
    "a key less": ("del answer['axes']", "INVALID_RESPONSE", "axes = (missing): must be a table"),
    "a pair less": (
        "answer['contacts'] = {}",
        "INVALID_RESPONSE",
        "contacts: must have pin->cantilever, has none",
    ),
    "another beam": (
        "answer['axes']['b'] = axis",
        "INVALID_RESPONSE",
        "axes: must have cantilever, has b, cant",
    ),
    "a second support": (
        "answer['supports']['cantilever.end'] = dict(support)",
        "INVALID_RESPONSE",
        "supports: must have cantilever.start, has cantilever.end, cantilever.start",
    ),
    "another material force": (
        "answer['material_force'] = {'other': contact['force']}",
        "INVALID_RESPONSE",
        "material_force: must have none, has other",
    ),
    "a force less": ("contact['force'].pop()", "INVALID_RESPONSE", "must be a list of 5 numbers"),
    "a word": ("contact['force'][0] = 'many'", "INVALID_RESPONSE", "must be a list of 5 numbers"),
    "a huge number": ("contact['force'][0] = 10**400", "INVALID_RESPONSE", "must be a list of 5 numbers"),
    "a transposed axis": (
        "axis['position'] = [list(zip(*line)) for line in axis['position']]",
        "INVALID_RESPONSE",
        "x and y of each point for each load parameter, has 5 x 2 x ",
    ),
    "the last axis only": (
        "axis['position'] = axis['position'][-1]",
        "INVALID_RESPONSE",
        "axes.cantilever.position = [[0.0, 0.0], [",
    ),
    "a misspelt key": (
        "answer['axis'] = answer.pop('axes')",
        "INVALID_RESPONSE",
        "unknown key, did you mean axes?",
    ),
    "small letters": (
        "answer['status'] = 'completed'",
        "INVALID_RESPONSE",
        'status = "completed": must be COMPLETED, in capitals',
    ),
    "a verdict": (
        "answer['status'] = 'CERTIFIED'",
        "INVALID_RESPONSE",
        "another word in capitals that is no verdict",
    ),
    "a verdict alone": (
        "answer = {'status': 'UNSTABLE'}",
        "INVALID_RESPONSE",
        'status = "UNSTABLE": must be',
    ),
    "a coloured status": (
        "answer['status'] = '\\x1b[32mCOMPLETED'",
        "INVALID_RESPONSE",
        'status = "\\U0000001b[32mCOMPLETED": must be COMPLETED',
    ),
    "a misspelt key of a contact": (
        "contact['vektor'] = contact.pop('vector')",
        "INVALID_RESPONSE",
        "contacts.pin->cantilever.vektor = [[",
    ),
    "a truth value": ("contact['force'][0] = True", "INVALID_RESPONSE", "must be a list of 5 numbers"),
    "a number as a text": ("contact['force'][0] = '1'", "INVALID_RESPONSE", "must be a list of 5 numbers"),
    "a closed contact without a gap": (
        "contact['gap'][2] = None",
        "NOT_FINITE",
        "contacts.pin->cantilever.gap[2] = nan: must be a finite number",
    ),
    "a key twice": (
        'print(json.dumps(answer)[:-1] + \', "status": "COMPLETED"}\'); sys.exit()',
        "INVALID_RESPONSE",
        'status = "COMPLETED": must stand once in its table',
    ),
    "a greeting": ("print('hello there')", "INVALID_JSON", "bytes written, they begin with: hello there {"),
    "a short beam": ("axis['arc_length'][-1] = 0.995", "INVALID_RESPONSE", "must run from 0 to the length 1"),
    "other load parameters": (
        "answer['load_parameter'][1] = .5",
        "INVALID_RESPONSE",
        "must be those of the scene",
    ),
    "a load parameter more": (
        "answer['load_parameter'].append(1.2)",
        "INVALID_RESPONSE",
        "must be a list of 6",
    ),
    "an early end": (
        """
for item in (contact, support):
    for key in ("force", "vector", "arc_position", "gap", "moment"):
        item[key] = item.get(key, [0] * 5)[:3]
axis["position"] = axis["position"][:3]
del support["vector"], support["arc_position"], support["gap"], contact["moment"]
answer["load_parameter"], answer["newton_iterations"] = answer["load_parameter"][:3], [1, 1, 1]
""",
        "INVALID_RESPONSE",
        "has 3 of 5 load parameters, and the status is COMPLETED",
    ),
    "iterations": (
        "answer['newton_iterations'][0] = 1e300",
        "INVALID_RESPONSE",
        "must be a list of whole numbers",
    ),
    "no whole number": (
        "answer['unknowns'] = 1.5",
        "INVALID_RESPONSE",
        "unknowns = 1.5: must be a whole number",
    ),
    "events": ("answer['events'] = 3", "INVALID_RESPONSE", "events = 3: must be a list"),
    "a critical point": (
        "answer['critical'] = [4]",
        "INVALID_RESPONSE",
        "critical = 4: must be a table",
    ),
    "an infinite axis": (
        "axis['position'][1][3][0] = math.inf",
        "NOT_FINITE",
        "axes.cantilever.position[1][3][0] = inf: must be a finite number",
    ),
    "null in a support": (
        "support['moment'][0] = None",
        "NOT_FINITE",
        "supports.cantilever.start.moment[0] = nan: must be a finite number",
    ),
    "its own failure": ("answer = {'status': 'DIVERGED', 'message': 'at .3'}", "DIVERGED", "at .3"),
}


@pytest.mark.slow_at("memory")
@pytest.mark.parametrize("failure", FAILURES)
def test_a_failure_has_its_name(failure: str, program: Make) -> None:
    lines, status, message = FAILURES[failure]
    response = solve(KS, program(lines, memory=200))
    assert (response.status, response.completed) == (status, False), response.message
    assert message in response.message
    assert "\n" not in response.message
    assert len(response.load_parameter) == 0
    assert response.contacts.keys() == {PAIR}


CONTROLS = "\x1b]0;owned\x07\x1b[31m\u202e\r\x9b2J\u2066"


@pytest.mark.parametrize("model", ["answers", "refuses", "crashes"])
def test_control_characters_of_a_program_reach_no_terminal_and_no_file(
    model: str,
    program: Make,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    words = repr(f"ready {CONTROLS} {'x' * 100_000}")
    lines = {
        "answers": f"answer = {{'status': 'DIVERGED', 'message': {words}}}",
        "refuses": f"answer = {{'status': 'REFUSED', 'message': {words}}}",
        "crashes": f"sys.exit({words})",
    }
    file = program(lines[model])
    status = 2 if model == "refuses" else 3
    assert main(["solve", "ks.toml", "--model", file, "--json", "a.json", "--quiet"]) == status
    out, err = capfd.readouterr()
    said = out + err + (Path("a.json").read_text() if status == 3 else "")
    assert "ready" in said or model == "crashes"
    assert {letter for letter in said if not letter.isprintable()} == {"\n"}
    assert max(map(len, (out + err).splitlines())) < 700


def test_a_program_that_ends_early_keeps_what_it_reached(program: Make) -> None:
    lines = FAILURES["an early end"][0] + "answer['status'], answer['message'] = 'DIVERGED', 'late'"
    response = solve(KS, program(lines))
    assert (response.status, response.completed, response.reported_success) == ("DIVERGED", False, False)
    assert list(response.load_parameter) == list(KS.times[:3])


def test_a_limit_ends_the_whole_family(program: Make, tmp_path: Path) -> None:
    lines = """
import subprocess
child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
Path("pids").write_text(f"{os.getpid()} {child.pid}")
time.sleep(600)
"""
    response = solve(KS, program(lines, seconds=1.5))
    assert (response.status, response.message) == ("TIMED_OUT", "ran longer than 1.5 s")
    assert not [pid for pid in map(int, (tmp_path / "pids").read_text().split()) if psutil.pid_exists(pid)]


def test_load_parameters_with_few_digits_are_those_of_the_scene(program: Make) -> None:
    scene = replace(KS, load_parameters=5)
    response = solve(
        scene, program("answer['load_parameter'] = [t + 4e-7 for t in answer['load_parameter']]")
    )
    assert response.completed, response.message
    assert tuple(response.load_parameter) == scene.times


def test_the_material_force_of_a_rod_is_computed_and_of_a_solid_stated(program: Make) -> None:
    """A program's own value of a rod does not count; a solid that states none has none, and what it is its file says alone."""
    rods = solve(KS, program("answer['material_force'] = {'cantilever': contact['force']}"))
    assert np.abs(frictions(rods, KS)["cantilever"]).max() < 1e-11
    assert solve(KS, program()).material_force.keys() == {"cantilever"}
    claimed = solve(KS, program("answer['continuum'] = True"))
    assert (claimed.continuum, claimed.material_force.keys()) == (False, {"cantilever"})
    stated = program("answer['material_force'] = {'cantilever': contact['force']}", continuum=True)
    assert frictions(solve(KS, stated), KS)["cantilever"] == pytest.approx(1.0)
    assert solve(KS, program(continuum=True)).material_force == {}


def test_a_penetration_is_that_of_a_penalty(program: Make) -> None:
    response = solve(KS, program("contact['gap'] = [-2e-6, -1e-6, 0.0, -1e-6, 0.0]"))
    assert response.completed, response.message
    deep = solve(KS, program("contact['gap'] = [-2e-2, -1e-6, 0.0, -1e-6, 0.0]"))
    assert (deep.status, deep.completed) == ("CHECK_FAILED", False)
    assert "penetration" in deep.message


def test_a_refusal_has_its_reason_and_is_asked_without_load_parameters(program: Make, tmp_path: Path) -> None:
    lines = """
if not scene["load_parameters"]:
    with open("asked", "a") as file:
        file.write("once ")
if len(scene["beams"]) > 1:
    answer = {"status": "REFUSED", "message": "one\\nbeam only"}
"""
    double, model = load_scene("double-beam"), find(program(lines))
    assert model.refusal(double) == "one beam only"
    assert model.refusal(double) == "one beam only"
    assert model.refusal(KS) is None
    assert (tmp_path / "asked").read_text() == "once once "
    with pytest.raises(ModelError, match=r"^liar: one beam only$"):
        solve(double, "liar")


def test_a_program_that_is_not_there(tmp_path: Path) -> None:
    file = tmp_path / "none.toml"
    file.write_text('[program]\nname = "none"\ncommand = ["no-such-program"]\n')
    assert find(str(file)).refusal(KS) == "there is no program no-such-program"
    with pytest.raises(ModelError, match=r"^none: there is no program no-such-program$"):
        solve(KS, str(file))
    (tmp_path / "empty").write_text("")
    (tmp_path / "empty").chmod(0o755)
    file.write_text('[program]\nname = "none"\ncommand = ["./empty"]\n')
    if os.name == "posix":
        assert solve(KS, str(file)).status == "NOT_STARTED"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "program = (missing): must be given"),
        ("program = 3", "program = 3: must be a table, [program]"),
        ("[program]\nname = 'a'", "program.command = (missing): must be given"),
        ("[program]\nname = 'a b'\ncommand = ['c']", 'program.name = "a b": must consist of letters'),
        ("[program]\nname = 'a'\ncommand = 'c'", 'program.command = "c": must be a list'),
        ("[program]\nname = 'a'\ncommand = []", "program.command = []: must have a program"),
        ("[program]\nname = 'a'\ncommand = ['c']\nseconds = 0", "program.seconds = 0: must be positive"),
        ("[program]\nname = 'a'\ncommand = ['c']\ncolour = 'red'", "must be a colour, as #AA3377"),
        ("[program]\nname = 'a'\ncommand = ['c']\nsecond = 1", "unknown key, did you mean seconds?"),
        ("[program]\nname = 'rod'\ncommand = ['c']", "must not be the name of a model"),
        ("[program", "must be valid TOML"),
    ],
)
def test_a_program_file_is_refused_in_one_line(
    text: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "wrong.toml"
    file.write_text(text)
    with pytest.raises(ProgramFileError) as error:
        find(str(file))
    assert message in str(error.value)
    assert main(["solve", "ks-cantilever", "--model", str(file)]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err == f"crossval: {error.value}\n"


def test_an_unknown_model_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["solve", "ks-cantilever", "--model", "nosuch"])
    assert "invalid choice: 'nosuch'" in capsys.readouterr().err


def test_elements_are_an_option_where_the_file_has_them(program: Make, tmp_path: Path) -> None:
    file = program("Path('seen').write_text(str(scene['beams'][0]['elements']))", elements=[5, 10, 20])
    model = find(file)
    assert solve(KS, file, Options(elements=10)).completed
    assert (tmp_path / "seen").read_text() == "10"
    assert model.run_label(Options(elements=10)) == "liar, 10 elements"
    assert (model.setting(KS, Options()), model.resolution(Options(elements=10))) == ("20", 10.0)
    assert [item.elements for item in model.resolutions(quick=True)] == [5, 10]
    plain = read_program(Path(program()))
    assert (plain.options, plain.setting(KS, Options())) == ((), "")
    assert list(plain.resolutions(quick=False)) == [Options()]
    with pytest.raises(ModelError, match="elements = 10: not an option of this model"):
        solve(KS, program(), Options(elements=10))


def test_solve_and_gate_have_it(
    program: Make, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    program()
    bounds = ["--max-error", "force=1e-9"]
    assert main(["solve", "ks.toml", "--model", "liar.toml", "--json", "a.json", "--vtk", "vtk"]) == 0
    assert main(["gate", "ks.toml", "--model", "liar.toml", *bounds]) == 0
    assert main(["gate", "ks.toml", "--model", "tsm", "--against", "liar.toml", *bounds]) == 1
    assert "tsm against liar" in capsys.readouterr().out
    data = json.loads((tmp_path / "a.json").read_text())
    assert (data["model"], data["status"], data["reported_success"]) == ("liar", "COMPLETED", True)
    assert (tmp_path / "vtk" / "liar-0005.vtm").is_file()
    program("support['moment'] = [2 * m for m in support['moment']]")
    assert main(["solve", "ks.toml", "--model", "liar.toml", "--json", "a.json"]) == 3
    data = json.loads((tmp_path / "a.json").read_text())
    assert (data["status"], data["reported_success"]) == ("NOT_AN_EQUILIBRIUM", True)
    assert main(["certify", "a.json", "--scene", "ks.toml"]) == 1


@pytest.mark.slow
def test_a_study_has_it_and_sees_a_changed_program(program: Make, tmp_path: Path) -> None:
    file = program("contact['gap'] = [0.0] * 5")
    case = Case(scene=KS, model=file)
    key = case.key
    found = measure(case, repeats=1)
    assert (case.label, case.model_name) == ("liar", "liar")
    assert (found.response.status, found.verdict) == ("COMPLETED", "CERTIFIED")
    assert found.seconds > 0.005, "the processor time of the child process counts"
    again = Measurement.from_json(found.to_json())
    assert again.response.reported_success
    np.testing.assert_array_equal(again.response.contacts[PAIR].force, found.response.contacts[PAIR].force)
    program("contact['gap'] = [0.0 for _ in range(5)]")
    assert Case(scene=KS, model=file).key != key
    (tmp_path / "study.toml").write_text(
        '[study]\nname = "s"\nscene = "ks.toml"\nrepeats = 1\n[[run]]\nmodel = ["liar.toml", "tsm"]\n'
    )
    study = ["study", str(tmp_path / "study.toml"), "--results", str(tmp_path / "s.sqlite"), "--workers", "1"]
    assert main([*study, "--quiet"]) == 0


@pytest.mark.slow
def test_a_comparison_has_it(program: Make, tmp_path: Path) -> None:
    file, out = program(), tmp_path / "out"
    assert main(["compare", str(tmp_path / "ks.toml"), "--with", file, "--out", str(out), "--quiet"]) == 0
    rows = {row["label"]: row for row in json.loads((out / "summary.json").read_text())["runs"]}
    assert rows["liar"]["errors"]["path"]["force"] < 1e-8
    assert "liar" in (out / "report.html").read_text()


LEAVES = r"""
import subprocess
sleep = [sys.executable, "-I", "-c", "import os, time; os.chdir('/'); time.sleep(600)"]
daemon = (
    "import os, subprocess, sys\n"
    "if os.fork(): os._exit(0)\n"
    "os.setsid()\n"
    "if os.fork(): os._exit(0)\n"
    "os.execve(sys.executable, [sys.executable, '-I', '-c', 'import time; time.sleep(600)', 'MARK'], {})\n"
)
for k in range(5):
    subprocess.Popen([*sleep, "MARK"])
    subprocess.Popen([*sleep, "MARK"], start_new_session=True)
    subprocess.Popen(["/bin/sh", "-c", 'nohup "$@" >/dev/null 2>&1 & exit', "sh", *sleep, "MARK"])
    subprocess.Popen([sys.executable, "-I", "-c", daemon])
time.sleep(0.5)
"""


def running(mark: str) -> list[int]:
    found = []
    for process in psutil.process_iter():
        with contextlib.suppress(psutil.Error):
            if mark in process.cmdline() and process.status() != psutil.STATUS_ZOMBIE:
                found.append(process.pid)
    return found


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere a process can leave its family")
@pytest.mark.slow_at("killed")
@pytest.mark.parametrize("ending", ["done", "failed", "killed"])
def test_a_program_leaves_no_process(ending: str, program: Make, tmp_path: Path) -> None:
    """Children, children in sessions of their own, orphans, and daemons without an environment: none is left."""
    mark = f"left-{ending}-{os.getpid()}"
    more = {"done": "", "failed": "sys.exit(1)", "killed": "time.sleep(600)"}[ending]
    count = f"Path('count').write_text(os.popen('pgrep -cf {mark}').read())\n"
    lines = LEAVES.replace("MARK", mark) + count + more
    before = {child.pid for child in psutil.Process().children()}
    other = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"], start_new_session=True)
    try:
        response = solve(KS, program(lines, seconds=20 if ending != "killed" else 5))
        assert response.status == {"done": "COMPLETED", "failed": "CRASHED", "killed": "TIMED_OUT"}[ending]
        assert int((tmp_path / "count").read_text()) >= 20
        assert not running(mark)
        assert other.poll() is None, "not one of the program's"
        left = {child.pid for child in psutil.Process().children()} - before
        assert left == {other.pid}, "no zombie is left"
    finally:
        other.kill()
        other.wait()


def test_a_command_that_is_ended_ends_the_program(program: Make, tmp_path: Path) -> None:
    file = program("Path('pid').write_text(str(os.getpid())); time.sleep(600)")
    code = "import sys; from comparisons.cli import main; sys.exit(main(sys.argv[1:]))"
    command = [sys.executable, "-c", code, "solve", str(tmp_path / "ks.toml"), "--model", file]
    with subprocess.Popen(command, stderr=subprocess.PIPE) as child:
        pid = tmp_path / "pid"
        while not (pid.exists() and pid.read_text()):
            assert child.poll() is None
            time.sleep(0.05)
        child.terminate()
        assert child.wait(60) == 143
    assert not psutil.pid_exists(int(pid.read_text()))


def test_a_program_gets_the_stated_environment_alone(
    program: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No token; and what its file asks for."""
    monkeypatch.setenv("GITHUB_TOKEN", "secret")
    monkeypatch.setenv("LICENSE_SERVER", "here")
    seen = "Path('seen').write_text(json.dumps(dict(os.environ)))"
    assert solve(KS, program(seen)).completed
    got = json.loads((tmp_path / "seen").read_text())
    assert got.keys() - {"LC_CTYPE"} == {name for name in ENVIRONMENT if name in os.environ}
    assert solve(KS, program(seen, environment=["LICENSE_SERVER", "NOT_THERE"])).completed
    more = json.loads((tmp_path / "seen").read_text())
    assert more == {**got, "LICENSE_SERVER": "here"}
    page = (Path(__file__).parents[4] / "docs" / "how-to" / "program.md").read_text(encoding="utf-8")
    _, _, said = page.partition("The environment of the program has the variables")
    assert re.findall(r"`([A-Z_]+)`", said.partition("as far as")[0]) == list(ENVIRONMENT)

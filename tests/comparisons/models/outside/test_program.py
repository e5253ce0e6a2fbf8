"""A program of others in a child process: limits, named failures, its file, and every command that takes a model."""

import json
import os
import re
import subprocess
import sys
import time
import tomllib
from pathlib import Path

import numpy as np
import pytest

from comparisons.cli import main
from comparisons.models import find, solve
from comparisons.models.model import ModelError, Options

# the registry of the statuses, for the contract that each is forced here
from comparisons.models.outside.child import ProgramStatus
from comparisons.scene import load_scene
from comparisons.suite import Case, Row, measure
from tests.comparisons.models.outside.conftest import KS, PAIR
from tests.comparisons.processes import COMMAND, begun

EARLY = """
for item in (contact, support):
    for key in item.keys() & {"force", "vector", "arc_position", "gap", "moment"}:
        item[key] = item[key][:3]
axis["position"] = axis["position"][:3]
answer["load_parameter"], answer["newton_iterations"] = answer["load_parameter"][:3], [1, 1, 1]
"""
FAILURES = tomllib.loads(Path(__file__).with_name("failures.toml").read_text(encoding="utf-8"))
"""By status, the last lines of a program that spoil its answer, and part of the message."""


@pytest.mark.slow_at("OUT_OF_MEMORY", "TOO_MUCH_OUTPUT", "TIMED_OUT")
@pytest.mark.parametrize("status", FAILURES)
def test_a_failure_has_its_name(status, program):
    for lines, said in FAILURES[status].items():
        file = program(lines.replace("EARLY", EARLY), memory=200, seconds=1 if status == "TIMED_OUT" else 60)
        response = solve(KS, file)
        assert (response.status, response.completed) == (status, False), (lines, response.message)
        assert said in response.message
        assert "\n" not in response.message
        assert len(response.load_parameter) == 0
        assert response.contacts.keys() == {PAIR}


def test_every_status_of_a_program_is_forced():
    elsewhere = {ProgramStatus.NOT_STARTED.name}  # test_a_program_that_is_not_there
    assert {item.name for item in ProgramStatus} - elsewhere == FAILURES.keys() - {"DIVERGED"}


CONTROLS = "\x1b]0;owned\x07\x1b[31m\u202e\r\x9b2J\u2066"


@pytest.mark.parametrize(
    ("lines", "status"),
    [
        ("answer = {{'status': 'DIVERGED', 'message': {}}}", 3),
        ("answer = {{'status': 'REFUSED', 'message': {}}}", 2),
        ("sys.exit({})", 3),
    ],
    ids=["answers", "refuses", "crashes"],
)
def test_control_characters_of_a_program_reach_no_terminal_and_no_file(
    lines, status, program, in_folder, capfd
):
    file = program(lines.format(repr(f"ready {CONTROLS} {'x' * 100_000}")))
    assert main(["solve", "ks.toml", "--model", file, "--out", "a.json", "--quiet"]) == status
    out, err = capfd.readouterr()
    said = out + err + (Path("a.json").read_text() if status == 3 else "")
    assert "ready" in said or "exit" in lines
    assert {letter for letter in said if not letter.isprintable()} == {"\n"}
    assert max(map(len, (out + err).splitlines())) < 700


def test_an_answer_keeps_what_was_reached_and_takes_the_scenes_load_parameters(program):
    """An early end; load parameters of six digits; the penetration of a penalty."""
    early = solve(KS, program(EARLY + "answer['status'], answer['message'] = 'DIVERGED', 'late'"))
    assert (early.status, early.completed, early.reported_success) == ("DIVERGED", False, False)
    assert tuple(early.load_parameter) == KS.times[:3]
    rounded = "answer['load_parameter'] = [t + 4e-7 for t in answer['load_parameter']]\n"
    response = solve(KS, program(rounded + "contact['gap'] = [-2e-6, -1e-6, 0.0, -1e-6, 0.0]"))
    assert response.completed, response.message
    assert tuple(response.load_parameter) == KS.times
    deep = solve(KS, program("contact['gap'] = [-2e-2, -1e-6, 0.0, -1e-6, 0.0]"))
    assert (deep.status, deep.completed) == ("CHECK_FAILED", False)
    assert "penetration" in deep.message


def test_the_material_force_of_a_rod_is_computed_and_of_a_solid_stated(program):
    """A program's own value of a rod does not count; a solid that states none has none, and what it is its file says alone."""
    lines = "answer['material_force'] = {'cantilever': contact['force']}"
    rod, solid = solve(KS, program(lines)), solve(KS, program(lines, continuum=True))
    force = rod.contacts[PAIR].force
    assert np.abs(rod.material_force["cantilever"]).max() < 1e-11 * force.max()
    np.testing.assert_array_equal(solid.material_force["cantilever"], force)
    claimed = solve(KS, program("answer['continuum'] = True"))
    assert (claimed.continuum, claimed.material_force.keys()) == (False, {"cantilever"})
    assert solve(KS, program(continuum=True)).material_force == {}


def test_a_refusal_has_its_reason_and_is_asked_without_load_parameters(program, tmp_path):
    lines = """
if not scene["load_parameters"]:
    with open("asked", "a") as file:
        file.write("once ")
if len(scene["beams"]) > 1:
    answer = {"status": "REFUSED", "message": "one\\nbeam only"}
"""
    double, model = load_scene("double-beam"), find(program(lines))
    assert [model.refusal(scene) for scene in (double, double, KS)] == ["one beam only"] * 2 + [None]
    assert (tmp_path / "asked").read_text() == "once once "
    with pytest.raises(ModelError, match=r"^liar: one beam only$"):
        solve(double, "liar")


def test_a_program_that_is_not_there(tmp_path):
    file, empty = tmp_path / "none.toml", tmp_path / "empty"
    file.write_text('[program]\nname = "none"\ncommand = ["no-such-program"]\n')
    assert find(str(file)).refusal(KS) == "there is no program no-such-program"
    with pytest.raises(ModelError, match=r"^none: there is no program no-such-program$"):
        solve(KS, str(file))
    empty.touch(mode=0o755)
    file.write_text('[program]\nname = "none"\ncommand = ["./empty"]\n')
    if os.name == "posix":
        assert solve(KS, str(file)).status == ProgramStatus.NOT_STARTED.name


def test_elements_are_an_option_where_the_file_has_them(program, tmp_path):
    file = program("Path('seen').write_text(str(scene['beams'][0]['elements']))", elements=[5, 10, 20])
    model = find(file)
    assert solve(KS, file, Options(elements=10)).completed
    assert (tmp_path / "seen").read_text() == "10"
    assert model.run_label(Options(elements=10)) == "liar, 10 elements"
    assert (model.setting(KS, Options()), model.resolution(Options(elements=10))) == ("20", 10.0)
    assert [item.elements for item in model.resolutions(quick=True)] == [5, 10]
    assert list(find(program()).resolutions(quick=False)) == [Options()]


def test_solve_and_gate_have_it(program, in_folder, capsys):
    program()
    bounds = ["--max-error", "force=1e-9"]
    assert main(["solve", "ks.toml", "--model", "liar.toml", "--out", "a.json", "--out", "vtk"]) == 0
    assert main(["compare", "ks.toml", "--model", "liar.toml", *bounds]) == 0
    assert main(["compare", "ks.toml", "--elements", "20", "--against", "liar.toml", *bounds]) == 1
    assert "tsm mixed 20 against liar" in capsys.readouterr().out
    data = json.loads(Path("a.json").read_text())
    assert (data["model"], data["status"], data["reported_success"]) == ("liar", "COMPLETED", True)
    assert Path("vtk/liar-0005.vtm").is_file()
    program("support['moment'] = [2 * m for m in support['moment']]")
    assert main(["solve", "ks.toml", "--model", "liar.toml", "--out", "a.json"]) == 3
    data = json.loads(Path("a.json").read_text())
    assert (data["status"], data["reported_success"]) == ("NOT_AN_EQUILIBRIUM", True)
    assert main(["certify", "a.json", "--scene", "ks.toml"]) == 1


@pytest.mark.slow
def test_studies_have_it_and_see_a_changed_program(program):
    file = program("contact['gap'] = [0.0] * 5")
    key, found = Case(scene=KS, model=file).key, measure(Case(scene=KS, model=file), repeats=1)
    assert (found.response.status, found.verdict) == ("COMPLETED", "CERTIFIED")
    assert found.seconds > 0.005, "the processor time of the child process counts"
    assert Row.from_json(found.case, found.to_json()).response.reported_success
    program("contact['gap'] = [0.0 for _ in range(5)]")
    assert Case(scene=KS, model=file).key != key


LEAVES = Path(__file__).with_name("leaves.txt").read_text()


def children() -> set[str]:
    found = subprocess.run(["pgrep", "-P", str(os.getpid())], check=False, capture_output=True, text=True)
    return set(found.stdout.split())


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere a process can leave its family")
@pytest.mark.slow_at("done", "killed")
@pytest.mark.parametrize(
    ("more", "status", "count"),
    [("", "COMPLETED", 5), ("sys.exit(1)", "CRASHED", 1), ("time.sleep(600)", "TIMED_OUT", 5)],
    ids=["done", "failed", "killed"],
)
def test_a_program_leaves_no_process(more, status, count, program, tmp_path):
    """Children, children in sessions of their own, orphans, and daemons without an environment: none is left."""
    mark = f"left-{status}-{os.getpid()}"
    lines = LEAVES.replace("MARK", mark).replace("COUNT", str(count)) + more
    before = children()
    other = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"], start_new_session=True)
    try:
        response = solve(KS, program(lines, seconds=5 if status == "TIMED_OUT" else 20))
        assert response.status == status
        assert int((tmp_path / "count").read_text()) >= 4 * count
        assert subprocess.run(["pgrep", "-f", mark], check=False).returncode == 1, "none runs"
        assert other.poll() is None, "not one of the program's"
        assert children() - before == {str(other.pid)}, "no zombie is left"
    finally:
        other.kill()
        other.wait()


def test_a_command_that_is_ended_ends_the_program(program, tmp_path):
    file = program("Path('pid').write_text(str(os.getpid())); time.sleep(600)")
    with begun(COMMAND, "solve", tmp_path / "ks.toml", "--model", file) as child:
        pid = tmp_path / "pid"
        while not (pid.exists() and pid.read_text()):
            assert child.poll() is None
            time.sleep(0.05)
        child.terminate()
        assert child.wait(60) == 143
    with pytest.raises(ProcessLookupError):
        os.kill(int(pid.read_text()), 0)


def test_a_program_gets_the_stated_environment_alone(program, tmp_path, monkeypatch):
    """The variables that the page names, no token, and what its file asks for."""
    page = (Path(__file__).parents[4] / "docs" / "how-to" / "program.md").read_text(encoding="utf-8")
    _, _, said = page.partition("The environment of the program has the variables")
    named = re.findall(r"`([A-Z_]+)`", said.partition("as far as")[0])
    assert {"PATH", "HOME", "PYTHONPATH"} < set(named)
    for name in (*named[2:], "GITHUB_TOKEN", "LICENSE_SERVER"):
        monkeypatch.setenv(name, os.environ.get(name, "here"))
    seen = "Path('seen').write_text(json.dumps(dict(os.environ)))"
    assert solve(KS, program(seen)).completed
    got = json.loads((tmp_path / "seen").read_text())
    assert got.keys() - {"LC_CTYPE"} == {name for name in named if name in os.environ}
    assert solve(KS, program(seen, environment=["LICENSE_SERVER", "NOT_THERE"])).completed
    assert json.loads((tmp_path / "seen").read_text()) == {**got, "LICENSE_SERVER": "here"}


def test_a_stored_answer_is_judged_as_what_the_file_of_its_program_says(program, in_folder, capsys):
    """Only the answer of a program that is not known here says itself that it is of a body, which is allowed more."""
    file, more = program(continuum=True), ["--scene", "ks.toml"]
    assert main(["solve", "ks.toml", "--model", file, "--certify", "none", "--out", "a.json"]) == 0
    stated = json.loads(Path("a.json").read_text())
    body = ", a two-dimensional body, COMPLETED\n  CERTIFIED within 7 %"
    for model, continuum, said in (
        ("liar", False, f"liar{body}"),
        ("other", True, f"other{body}"),
        ("other", False, "other, COMPLETED\n  CERTIFIED within 5 %"),
        ("tsm", True, "tsm, COMPLETED\n  CERTIFIED within 5 %"),
    ):
        Path("b.json").write_text(json.dumps(stated | {"model": model, "continuum": continuum}))
        capsys.readouterr()
        assert main(["certify", "b.json", *more]) == 0
        assert said in capsys.readouterr().out
    assert main(["certify", "ks.toml"]) == 0
    assert capsys.readouterr().out.startswith("ks-cantilever, model tsm exact 1, COMPLETED\n")

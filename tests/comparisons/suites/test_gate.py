"""``crossval compare --max-error``: bounds hold or break, on the screen, in the exit status and as JUnit XML."""

import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from comparisons.answer.errors import errors, worst_place
from comparisons.cli import main
from comparisons.models import solve
from comparisons.scene import built_in_scenes, load_scene, read_scene
from tests.comparisons.suite.conftest import crossval

KS = built_in_scenes()["ks-cantilever"].replace("load_parameters = 50", "load_parameters = 4")


def gate(scene, *bounds, **options):
    given = [word for name, value in options.items() for word in (f"--{name}", value)]
    return crossval("compare", scene, *given, *(f"--max-error={bound}" for bound in bounds))


@pytest.fixture
def scene(tmp_path):
    (tmp_path / "my.toml").write_text(KS)
    return str(tmp_path / "my.toml")


@pytest.mark.parametrize(
    ("bounds", "status"),
    [(["force=1e-3", "tip=1e-3", "moment=1e-3", "arc=1e-3"], 0), (["force=1e-3", "tip=1e-15"], 1)],
)
def test_bounds(scene, bounds, status, tmp_path, capsys):
    file = tmp_path / "gate.xml"
    assert gate(scene, *bounds, elements=20, out=file) == status
    out, error = capsys.readouterr()
    assert out.startswith("ks-cantilever: tsm mixed 20 against rod\n")
    assert out.count("<=") == len(bounds) - status
    assert error == ("crossval: tip: beyond the bound\n" if status else "")
    suite = ET.parse(file).getroot()  # noqa: S314 - our own
    assert (suite.get("tests"), suite.get("failures")) == (str(len(bounds)), str(status))
    assert [case.get("name") for case in suite] == [bound.partition("=")[0] for bound in bounds]
    assert [case.find("failure") is None for case in suite] == [True] * (len(bounds) - status) + [
        False
    ] * status
    assert all("against rod" in failure.get("message") for failure in suite.iter("failure"))
    assert all("allowed" in case.findtext("system-out") for case in suite)


@pytest.mark.slow_at("nodes = [0.3, 0.5]-options2-mixed 3", "elements = 7-options4-exact 1")
@pytest.mark.parametrize(
    ("line", "options", "said"),
    [
        ("", (), "exact 1"),
        ("elements = 7", (), "mixed 7"),
        ("nodes = [0.3, 0.5]", (), "mixed 3"),
        ("elements = 7", ("--elements", "5"), "mixed 5"),
        ("elements = 7", ("--element", "exact"), "exact 1"),
    ],
)
def test_every_command_obeys_the_number_of_elements_of_the_file(line, options, said, tmp_path, capsys):
    file = tmp_path / "my.toml"
    file.write_text(KS.replace("clamped =", f"{line}\nclamped ="))
    if not options:
        assert solve(read_scene(file.read_text(), "my"), "tsm").setting == said
    assert main(["solve", str(file), *options, "--quiet"]) == 0
    assert f"tsm, {said}, " in capsys.readouterr().out
    assert main(["compare", str(file), *options, "--max-error", "tip=1"]) == 0
    assert f"tsm {said} against rod" in capsys.readouterr().out


@pytest.mark.slow
def test_a_bound_names_where_the_error_is_largest_and_a_slip_off_is_an_event(capsys):
    """The pin slips off the upper beam at .707 and off the lower one at .972; four elements are not as exact as twenty."""
    assert gate("double-beam", "event=1e-6", "gap=1e-6", elements=20) == 0
    capsys.readouterr()
    assert gate("double-beam", "force=1e-12", "tip=1e-12", "event=1e-8", elements=4) == 1
    force, tip, event = capsys.readouterr().out.splitlines()[1:]
    assert re.search(r" >  1e-12 +pin->lower at load parameter 0\.9605", force)
    assert re.search(r" >  1e-12 +(upper|lower) at load parameter \d", tip)
    told = r"tsm has a slip-off of pin->(upper|lower) at load parameter \S+, which rod has at"
    assert re.search(told, event)


def test_a_solution_that_stops_holds_no_bound(tmp_path, capsys):
    scene = tmp_path / "stops.toml"
    kept = KS.replace("[[contact]]", "[[contact]]\nkeep = true").replace("0.6366197723675814]", "3.0]")
    scene.write_text(kept)
    assert gate(str(scene), "force=1", elements=10) == 3
    out, error = capsys.readouterr()
    assert "inf" in out
    assert error.startswith("crossval: ")


def test_gaps_and_events_tell_of_another_path(capsys):
    """The pin is .02 below the arm and moves up by .05, so that it touches at .4 and is .0075 away at the first load parameter."""
    file = Path(__file__).with_name("arm.toml")
    scene = load_scene(str(file))
    assert gate(str(file), "event=1e-9", "gap=1e-9", element="mixed", against="tsm") == 0
    assert gate(str(file), "event=1e-9", against="tsm") == 2
    assert "tsm: is measured against itself" in capsys.readouterr().err
    assert gate(str(file), "event=1e-9", model="solid", mesh="10x1", against="tsm") == 2
    assert "event: solid states no events of this scene" in capsys.readouterr().err
    true = solve(scene, "tsm")
    [touch] = [event for event in true.events if event.kind == "touch"]
    assert touch.load_parameter == pytest.approx(0.4, abs=1e-12)
    contact = true.contacts["pin->arm"]
    other = {"pin->arm": replace(contact, gap=contact.gap + np.array([0.01, 0.0, 0.0, 0.0]))}
    late = replace(true, contacts=other, events=(replace(touch, load_parameter=0.45),))
    found = errors(late, true, scene, quantities=["gap", "event"])["path"]
    assert found == {"gap": pytest.approx(0.01), "event": pytest.approx(0.05)}
    assert worst_place(late, true, scene, "gap") == "pin->arm at load parameter 0.25"
    never = replace(true, events=())
    said = "tsm has a touch of pin->arm at load parameter 0.4, which tsm does not have"
    for one, two in ((never, true), (true, never)):
        assert errors(one, two, scene, quantities=["event"])["path"]["event"] == np.inf
        assert worst_place(one, two, scene, "event") == said

"""Models that other packages offer as entry points."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.comparisons.cases.conftest import COMMAND

MODULE = """
from dataclasses import replace
from comparisons.models import TSM, Model, Style

class Borrowed(Model):
    name = "borrowed"
    label = "borrowed"
    libraries = ("tsm",)

    def refusal(self, scene):
        return None if len(scene.beams) == 1 else "one beam only"

    def solve(self, scene, options, watch):
        response = TSM.solve(scene, TSM.reference, watch)
        return replace(response, model=self.name) if len(scene.beams) == 1 else response

    def styles(self):
        return {self.label: Style(colour="#AA3377")}

MODEL, OTHER = Borrowed(), 3
"""
FUNCTIONS = """
from comparisons.models.outside import Functions, Program, StoppedError, points_along

def refusal(scene):
    return "one beam only" if len(scene["beams"]) > 1 else None

def states(scene, histories):
    print("chatter")
    beam, = scene["beams"]
    for t in scene["load_parameters"]:
        if scene["contacts"]:
            raise {stopped}
        histories.axis(beam["name"], *points_along(beam, beam["elements"]))
        histories.support(scene["supports"][0]["node"], (0.0, 0.0), -t * scene["loads"][0]["moment"])
        yield t

MODEL = Program(Functions(name="stiff", elements=(4, 8), refusal=refusal, states=states))
"""
POINTS = "[crossval.models]\nborrowed = lender:MODEL\nnumber = lender:OTHER\nabsent = no_such_module:MODEL\nwrong = lender:MODEL\nstiff = functions:MODEL\n"
STUDY = '[study]\nname = "s"\nscene = "ks-cantilever"\nrepeats = 1\n[[run]]\nmodel = ["borrowed", "tsm"]\nscene.load_parameters = 2\n'


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with an installed package that offers models."""
    folder = tmp_path_factory.mktemp("lender")
    (folder / "lender.py").write_text(MODULE)
    (folder / "functions.py").write_text(FUNCTIONS.format(stopped='StoppedError("no luck")'))
    info = folder / "lender-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: lender\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(POINTS)
    (folder / "study.toml").write_text(STUDY)
    return folder


def crossval(place: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", COMMAND, *arguments],
        cwd=place,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(place), *sys.path])},
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )


@pytest.mark.slow
def test_commands_have_it(place: Path) -> None:
    solved = crossval(place, "solve", "ks-cantilever", "--model", "borrowed", "--quiet")
    assert re.search(r"model +borrowed, ", solved.stdout), solved.stderr
    assert "CERTIFIED" in solved.stdout
    gate = crossval(place, "gate", "ks-cantilever", "--model", "borrowed", "--max-error", "force=1e-8")
    assert gate.returncode == 0, gate.stderr
    study = crossval(place, "study", "study.toml", "--results", "s.sqlite", "--workers", "1", "--quiet")
    assert "2 cases: COMPLETED 2" in study.stdout, study.stderr


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("number", "entry point number = lender:OTHER: must be a Model of this name"),
        ("wrong", "entry point wrong = lender:MODEL: must be a Model of this name"),
        ("absent", "entry point absent = no_such_module:MODEL: ModuleNotFoundError: No module named"),
    ],
)
def test_an_entry_point_without_a_model_is_named(name: str, line: str, place: Path) -> None:
    found = crossval(place, "solve", "ks-cantilever", "--model", name)
    assert found.returncode == 2
    assert found.stderr.startswith(f"crossval: {line}")
    assert found.stderr.count("\n") == 1


@pytest.mark.slow
def test_functions_are_a_model(place: Path) -> None:
    """A stiff strip that does not bend is refused by the referee; a stop and an exception have their names, and output goes aside."""
    solved = crossval(place, "solve", "roll-up", "--model", "stiff", "--elements", "4", "--quiet")
    assert solved.returncode == 3, solved.stderr
    assert "NOT_AN_EQUILIBRIUM: tip off by 39 % (cantilever)" in solved.stdout
    assert "chatter" not in solved.stdout
    stopped = crossval(place, "solve", "ks-cantilever", "--model", "stiff", "--quiet")
    assert "STOPPED: no luck; 0 of 50 load parameters reached" in stopped.stderr
    refused = crossval(place, "solve", "double-beam", "--model", "stiff")
    assert (refused.returncode, refused.stderr) == (2, "crossval: stiff: one beam only\n")


def test_an_exception_of_a_function_is_a_status(place: Path, tmp_path: Path) -> None:
    for file in place.iterdir():
        if file.is_dir():
            shutil.copytree(file, tmp_path / file.name)
    (tmp_path / "functions.py").write_text(FUNCTIONS.format(stopped="ZeroDivisionError('by hand')"))
    solved = crossval(tmp_path, "solve", "ks-cantilever", "--model", "stiff", "--quiet")
    assert solved.returncode == 3, solved.stderr
    assert "CRASHED: ZeroDivisionError: by hand; 0 of 50" in solved.stderr


def test_check_lists_every_model(place: Path) -> None:
    (place / "own.toml").write_text('[program]\nname = "own"\ncommand = ["no-such-program"]\n')
    found = crossval(
        place, "check", "double-beam", "--with", "own.toml", "--with", "opensees", "--json", "scene.json", "--out", "a.svg"
    )  # fmt: skip
    assert found.returncode == 0, found.stderr
    lines = dict(line.strip().split(": ", 1) for line in found.stdout.splitlines()[1:])
    assert lines["stiff"] == lines["borrowed"] == "no, one beam only"
    assert lines["opensees"].startswith("no, BeamContact2D touches beams with pins only")
    assert lines["absent"].startswith("no, entry point absent = no_such_module:MODEL: ModuleNotFoundError")
    assert lines["own"] == "no, there is no program no-such-program"
    assert lines["resolved scene"] == "scene.json"
    assert json.loads((place / "scene.json").read_text())["name"] == "double-beam"

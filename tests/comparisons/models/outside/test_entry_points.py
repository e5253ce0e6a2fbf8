"""Models that other packages offer as entry points."""

import os
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
POINTS = "[crossval.models]\nborrowed = lender:MODEL\nnumber = lender:OTHER\nabsent = no_such_module:MODEL\nwrong = lender:MODEL\n"
STUDY = '[study]\nname = "s"\nscene = "ks-cantilever"\nrepeats = 1\n[[run]]\nmodel = ["borrowed", "tsm"]\nscene.load_parameters = 2\n'


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with an installed package that offers models."""
    folder = tmp_path_factory.mktemp("lender")
    (folder / "lender.py").write_text(MODULE)
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


def test_commands_have_it(place: Path) -> None:
    solved = crossval(place, "solve", "ks-cantilever", "--model", "borrowed", "--quiet")
    assert "ks-cantilever, model borrowed" in solved.stdout, solved.stderr
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

"""A new model is one file and one name in the registry: every command then has it."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import comparisons

MODEL = """
from dataclasses import replace

from comparisons.models.base import Model, Style
from comparisons.models.tsm import TSM


class Chain(Model):
    name = "chain"
    label = "chain"
    libraries = ("tsm",)
    meshed = False

    def refusal(self, scene):
        return None if len(scene.beams) == 1 else "the chain has one beam"

    def solve(self, scene, options, watch):
        return replace(TSM.solve(scene, TSM.reference, watch), model=self.name)

    def styles(self):
        return {self.label: Style(colour="#AA3377", marker="x")}


MODELS = (Chain(),)
"""
STUDY = """
[study]
name = "both"
scene = "ks-cantilever"
[[run]]
model = ["chain", "rod"]
scene.load_parameters = 4
"""
ASKED = """
from comparisons.claims.extremes.axes import matrix
from comparisons.compare import RUNS
from comparisons.cost.cases import sweep_cases
from comparisons.scene import load_scene
from comparisons.show.palette import colour
print(sum(run.model == "chain" for run in RUNS))
print(sum(case.model == "chain" for case in sweep_cases(load_scene("ks-cantilever"), quick=True)))
print(any(cell.row == "chain" for cell in matrix(quick=True)))
print(colour("chain"))
"""


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("new-model")
    package = shutil.copytree(Path(comparisons.__file__).parent, folder / "comparisons")
    (package / "models" / "chain.py").write_text(MODEL)
    registry = package / "models" / "registry.py"
    listed = 'FILES = ("tsm", "solid", "rod")'
    assert listed in registry.read_text()
    registry.write_text(registry.read_text().replace(listed, 'FILES = ("tsm", "solid", "rod", "chain")'))
    (folder / "study.toml").write_text(STUDY)
    return folder


def python(place: Path, *arguments: str) -> str:
    environment = {**os.environ, "PYTHONPATH": str(place)}
    run = subprocess.run(
        [sys.executable, *arguments], cwd=place, env=environment, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
    return run.stdout


def crossval(place: Path, *arguments: str) -> str:
    return python(place, "-c", "import sys; from comparisons.cli import main; sys.exit(main())", *arguments)


@pytest.mark.slow
def test_commands_have_it(place: Path) -> None:
    assert "chain: yes" in crossval(place, "check", "ks-cantilever")
    assert "chain: no, the chain has one beam" in crossval(place, "check", "double-beam")
    assert "COMPLETED" in crossval(place, "solve", "ks-cantilever", "--model", "chain", "--quiet")
    gate = ("gate", "ks-cantilever", "--model", "chain", "--max-error", "force=1e-9")
    assert "chain" in crossval(place, *gate)
    assert "chain" in crossval(place, "completion", "bash")


@pytest.mark.slow
def test_studies_have_it(place: Path) -> None:
    crossval(place, "study", "study.toml", "--results", "results.sqlite", "--quiet")
    table = crossval(place, "results", "results.sqlite")
    assert "chain" in table


def test_comparison_cost_extremes_and_pictures_have_it(place: Path) -> None:
    assert python(place, "-c", ASKED).split() == ["1", "1", "True", "#AA3377"]

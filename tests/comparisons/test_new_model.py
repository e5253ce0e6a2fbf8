"""A new model is one file and one name in the registry, or an entry point of another package: every command then has it."""

import json
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import comparisons
import tsm
from comparisons.models import solve
from comparisons.scene import load_scene
from comparisons.suite.accuracy import solve_to
from tests.comparisons.processes import COMMAND, ended

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "model.md"
CHAIN = PAGE.read_text(encoding="utf-8").partition("```python\n")[2].partition("```")[0]
"""The complete model of the page."""
LENDER = Path(__file__).with_name("lender")
"""A package that offers models and elements by entry points, some of them wrong."""
# what is drawn and measured by the registry: the modules have no command that answers at once
ASKED = """
from comparisons.suites.extremes.axes import matrix
from comparisons.suites.compare import RUNS
from comparisons.suites.trade.cases import sweep_cases
from comparisons.scene import load_scene
from comparisons.report.palette import style
print(sum(run.model == "chain" for run in RUNS))
print(sum(case.model == "chain" for case in sweep_cases(load_scene("ks-cantilever"), quick=True)))
print(any(cell.row == "chain" for cell in matrix(quick=True)))
print(style("chain").colour)
"""


@pytest.fixture(scope="module")
def registered(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a copy of the package that has the model in its registry."""
    folder = tmp_path_factory.mktemp("registered")
    package = shutil.copytree(Path(comparisons.__file__).parent, folder / "comparisons")
    (package / "models" / "chain.py").write_text(CHAIN)
    registry = package / "models" / "registry.py"
    listed, count = re.subn(r"^(FILES = .*)\)$", r'\1, "chain")', registry.read_text(), flags=re.MULTILINE)
    assert count == 1
    registry.write_text(listed)
    return folder


@pytest.fixture
def offered(tmp_path: Path) -> Path:
    """A folder with an installed package that offers the model."""
    shutil.copytree(LENDER, tmp_path, dirs_exist_ok=True)
    (tmp_path / "lender.py").write_text(CHAIN + (LENDER / "lent.txt").read_text())
    return with_functions(tmp_path, 'StoppedError("no luck")')


def with_functions(folder: Path, stopped: str) -> Path:
    text = (LENDER / "functions.txt").read_text()
    (folder / "functions.py").write_text(text.replace("STOPPED", stopped))
    return folder


def crossval(place: Path, *arguments: str, code: str = COMMAND) -> subprocess.CompletedProcess[str]:
    return ended(code, *arguments, cwd=place, first=place)


@pytest.mark.slow
def test_commands_have_it(offered):
    for arguments, line in {
        ("check", "ks-cantilever"): "chain: yes",
        ("check", "double-beam"): "chain: no, the chain has one beam",
        ("solve", "ks-cantilever", "--model", "chain", "--quiet"): "CERTIFIED",
        ("compare", "ks-cantilever", "--model", "chain", "--max-error", "force=1e-8"): "chain",
        ("run", "study.toml", "--out", "s", "--workers", "1", "--quiet"): "2 cases: COMPLETED 2",
    }.items():
        found = crossval(offered, *arguments)
        assert found.returncode == 0, found.stderr
        assert line in found.stdout


def test_comparison_cost_extremes_and_pictures_have_it(registered):
    found = crossval(registered, code=ASKED)
    assert found.stdout.split() == ["1", "1", "True", "#AA3377"], found.stderr


def test_an_element_of_another_package(offered):
    def solved(element: str) -> subprocess.CompletedProcess[str]:
        return crossval(offered, "solve", "ks-cantilever", "--element", element, "--elements", "5", "--quiet")

    found = solved("unsheared")
    assert found.returncode == 0, found.stderr
    assert "tsm, unsheared 5, " in found.stdout
    for name, said in {
        "number": "entry point number = lender:OTHER: must be an ElementType of this name",
        "none": "element = none: must be one of mixed, ",
    }.items():
        wrong = solved(name)
        assert (wrong.returncode, wrong.stderr.count("\n")) == (2, 1)
        assert wrong.stderr.startswith(f"crossval: tsm: {said}")


def test_accuracy_grades_the_mesh_of_a_new_element_by_its_order_and_keeps_the_promise(monkeypatch):
    kind, given = replace(tsm.ELEMENTS["mixed"], name="new", sheared=False), load_scene("ks-cantilever")
    monkeypatch.setitem(tsm.ELEMENTS, kind.name, kind)
    stiff = replace(given.beams[0], shear_modulus=1e9 * given.beams[0].youngs_modulus, poissons_ratio=None)
    rigid = replace(given, beams=(stiff,), load_parameters=4)
    answer = solve_to(rigid, 1e-5, element=kind.name)
    own, exact = (one.contacts["pin->cantilever"].force for one in (answer.response, solve(rigid, "rod")))
    assert answer.reached
    assert np.abs(own - exact).max() <= 1e-5 * exact.max()


@pytest.mark.slow
def test_functions_are_a_model(offered):
    """A stiff strip that does not bend is refused by the referee; a stop has its name, and output goes aside."""
    solved = crossval(offered, "solve", "roll-up", "--model", "stiff", "--elements", "4", "--quiet")
    assert solved.returncode == 3, solved.stderr
    assert "NOT_AN_EQUILIBRIUM: tip off by 39 % (cantilever)" in solved.stdout
    assert "chatter" not in solved.stdout
    stopped = crossval(offered, "solve", "ks-cantilever", "--model", "stiff", "--quiet")
    assert "STOPPED: no luck; 0 of 50 load parameters reached" in stopped.stderr
    refused = crossval(offered, "solve", "double-beam", "--model", "stiff")
    assert (refused.returncode, refused.stderr) == (2, "crossval: stiff: one beam only\n")


def test_an_exception_of_a_function_is_a_status(offered):
    with_functions(offered, "ZeroDivisionError('by hand')")
    solved = crossval(offered, "solve", "ks-cantilever", "--model", "stiff", "--quiet")
    assert solved.returncode == 3, solved.stderr
    assert "CRASHED: ZeroDivisionError: by hand; 0 of 50" in solved.stderr


def test_check_lists_every_model_and_an_entry_point_without_one_is_named(offered):
    (offered / "own.toml").write_text('[program]\nname = "own"\ncommand = ["no-such-program"]\n')
    found = crossval(
        offered, "check", "double-beam", "--with", "own.toml", "--with", "opensees", "--out", "scene.json", "--out", "a.svg"
    )  # fmt: skip
    assert found.returncode == 0, found.stderr
    lines = dict(line.strip().split(": ", 1) for line in found.stdout.splitlines()[1:])
    assert lines["stiff"] == "no, one beam only"
    assert lines["chain"] == "no, the chain has one beam"
    assert lines["opensees"].startswith("no, BeamContact2D touches beams with pins only")
    assert lines["absent"].startswith("no, entry point absent = no_such_module:MODEL: ModuleNotFoundError")
    for name, value in {"number": "OTHER", "wrong": "MODEL"}.items():
        assert lines[name] == f"no, entry point {name} = lender:{value}: must be a Model of this name"
    assert lines["own"] == "no, there is no program no-such-program"
    assert found.stdout.count("\nwritten: ") == 2
    assert json.loads((offered / "scene.json").read_text())["name"] == "double-beam"
    solved = crossval(offered, "solve", "ks-cantilever", "--model", "number")
    assert solved.returncode == 2
    assert solved.stderr == "crossval: entry point number = lender:OTHER: must be a Model of this name\n"

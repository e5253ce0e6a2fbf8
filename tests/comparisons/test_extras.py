"""What works without the libraries of the extras."""

import re
import sys
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

from comparisons import compare as compared
from comparisons.compare import MIXED, ROD, SOLID, compare
from comparisons.extras import EXTRAS
from comparisons.models import solve
from comparisons.models.options import ModelError
from comparisons.scene import load_scene

ROOT = Path(__file__).parents[2]
KS = load_scene("ks-cantilever")


@pytest.fixture
def bare(monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither pyvista nor meshio can be imported."""
    for library in ("pyvista", "meshio"):
        monkeypatch.setitem(sys.modules, library, None)


def test_every_library_belongs_to_the_extra_that_the_package_states() -> None:
    stated = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = stated["optional-dependencies"]

    def libraries(name: str) -> set[str]:
        return {re.split(r"[>=\[]", line)[0] for line in extras[name]}

    assert {(library, extra.name) for library, extra in EXTRAS.items()} == {
        (library, name) for name in ("view", "io", "cluster", "peers") for library in libraries(name)
    }
    assert extras["all"] == ["tsm-crossval[view,io,cluster,peers]"]
    # a plain installation draws by VTK and writes VTU files
    assert {*extras["view"], *extras["io"]} <= set(stated["dependencies"])


@pytest.mark.usefixtures("bare")
def test_a_comparison_draws_by_matplotlib(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compared, "RUNS", (MIXED, SOLID, ROD))
    monkeypatch.setattr(compared, "_budget", lambda *_: None)
    lines: list[str] = []
    beam = replace(KS.beams[0], mesh=(16, 1))
    found = compare(replace(KS, beams=(beam,), load_parameters=2), tmp_path, lines.append)
    assert [row.response.status for row in found.rows] == ["COMPLETED"] * 3
    names = {"report.html", "summary.json", "table.csv", "shapes.png", "shapes.svg", "side-by-side.png"}
    assert {path.name for path in found.files} == names | {"tsm.pvd", "solid.pvd"}
    assert {path.name for path in tmp_path.iterdir()} == names | {"tsm", "solid", ".crossval"}
    assert [line for line in lines if "install" in line] == [
        "side-by-side.png: pyvista is not installed (install tsm-crossval[view]), matplotlib drew the picture instead",
    ]


@pytest.mark.usefixtures("bare")
def test_a_mesh_file_is_refused_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "strip.msh").touch()
    beam = replace(KS.beams[0], mesh=(16, 1), solid_mesh_file=str(tmp_path / "strip.msh"))
    with pytest.raises(ModelError) as refused:
        solve(replace(KS, beams=(beam,)), "solid")
    assert str(refused.value) == "solid: meshio is needed: install tsm-crossval[io]"

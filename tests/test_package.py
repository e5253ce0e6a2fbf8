"""What is built can be installed by itself and runs from anywhere."""

import re
import subprocess
import sys
import sysconfig
import venv
from collections.abc import Callable
from importlib import metadata
from importlib.util import cache_from_source
from pathlib import Path

import pytest
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the sdist and the wheel that is built of it."""
    folder = tmp_path_factory.mktemp("dist")
    subprocess.run(
        [sys.executable, "-m", "build", "--no-isolation", "--outdir", str(folder), str(ROOT)],
        check=True,
        capture_output=True,
    )
    return folder


@pytest.fixture(scope="module")
def python(built: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Interpreter of an environment that has the wheel, and of this one the libraries but not the project."""
    home = tmp_path_factory.mktemp("environment")
    site = environment(home, built)
    (site / "libraries.pth").write_text(sysconfig.get_path("purelib"))
    return home / "bin" / "python"


@pytest.fixture(scope="module")
def bare(built: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Interpreter of an environment with the wheel and what it requires, and nothing else: no pyvista, no meshio."""
    home = tmp_path_factory.mktemp("bare")
    site = environment(home, built)
    for name in required("tsm-crossval"):
        for entry in {file.parts[0] for file in metadata.files(name) or ()} - {"..", "__pycache__"}:
            (site / entry).symlink_to(Path(str(metadata.distribution(name).locate_file(entry))))
    return home / "bin" / "python"


def environment(home: Path, built: Path) -> Path:
    """Make an environment with the wheel alone; return its folder of packages."""
    venv.create(home, with_pip=False)
    [site] = home.glob("lib/python*/site-packages")
    [wheel] = built.glob("*.whl")
    target = ["--target", str(site), "--no-deps", "--no-index"]
    subprocess.run([sys.executable, "-m", "pip", "install", "-q", *target, str(wheel)], check=True)
    return site


OPTIONAL = {"pyvista", "meshio"}
"""Libraries of a plain installation that everything but their own pictures and files works without."""


def required(*names: str) -> set[str]:
    """Return the distributions that some require, however indirectly, but for the optional ones."""
    found: set[str] = set()
    wanted = list(names)
    while wanted:
        for line in metadata.requires(wanted.pop()) or ():
            requirement = Requirement(line)
            name = re.sub(r"[-_.]+", "-", requirement.name).lower()
            needed = requirement.marker is None or requirement.marker.evaluate({"extra": ""})
            if needed and name not in found | OPTIONAL:
                found.add(name)
                wanted.append(name)
    return found


def installed_size(name: str) -> int:
    """Return the bytes of a distribution, with the bytecode that an installation compiles."""
    sources = {Path(str(file.locate())) for file in metadata.files(name) or () if file.suffix != ".pyc"}
    compiled = {Path(cache_from_source(path)) for path in sources if path.suffix == ".py"}
    return sum(path.stat().st_size for path in sources | compiled if path.is_file())


def crossval(python: Path, folder: Path, *arguments: str) -> "subprocess.CompletedProcess[str]":
    code = "import sys; from comparisons.cli import main; sys.exit(main())"
    return subprocess.run(
        [str(python), "-I", "-c", code, *arguments], cwd=folder, check=False, capture_output=True, text=True
    )


def run(python: Path, folder: Path, *arguments: str) -> str:
    done = crossval(python, folder, *arguments)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.slow
def test_the_wheel_is_what_runs(python: Path, tmp_path: Path) -> None:
    code = "import comparisons, tsm, fem_reference; print(comparisons.__file__, tsm.__file__, fem_reference.__file__)"
    where = subprocess.run(
        [str(python), "-I", "-c", code], cwd=tmp_path, check=True, capture_output=True, text=True
    )
    assert all(file.startswith(str(python.parents[1])) for file in where.stdout.split())


@pytest.mark.slow
def test_new_check_and_compare_run_from_the_wheel(python: Path, tmp_path: Path) -> None:
    run(python, tmp_path, "new", "strip")
    run(python, tmp_path, "check", "strip.toml")
    assert '"$schema"' in run(python, tmp_path, "schema")
    out = run(python, tmp_path, "compare", "ks-cantilever", "--out", "out")
    assert "exact rod" in out
    assert (tmp_path / "out" / "report.html").stat().st_size < 3e6


@pytest.mark.slow
def test_an_installation_without_pyvista_and_meshio(
    bare: Path, tmp_path: Path, stated: Callable[..., None]
) -> None:
    """It compares and views by matplotlib, refuses to read VTU files, and is small."""
    lines = run(bare, tmp_path, "doctor").splitlines()
    assert {line.split()[1] for line in lines if line.startswith("-")} >= OPTIONAL
    assert not [line for line in lines if line.startswith("MISSING")]
    done = crossval(bare, tmp_path, "compare", "ks-cantilever", "--out", "out")
    assert done.returncode == 0
    assert [line for line in done.stderr.splitlines() if "tsm-crossval[" in line] == [
        "side-by-side.png: pyvista is not installed (install tsm-crossval[view]), matplotlib drew the picture instead",
    ]
    assert {path.name for path in (tmp_path / "out").iterdir() if path.name[0] != "."} == {
        "report.html", "summary.json", "table.csv", "shapes.png", "shapes.svg", "side-by-side.png",
        "budget.png", "budget.svg", "budget.json", "tsm", "solid",
    }  # fmt: skip
    run(bare, tmp_path, "view", "tip-load", "--mesh", "20x1", "--out", "view")
    assert (tmp_path / "view" / "view.gif").stat().st_size > 1000
    done = crossval(bare, tmp_path, "view", "out/tsm", "--out", "view")
    assert done.returncode == 2
    assert done.stderr == "crossval: meshio: cannot be imported, install tsm-crossval[io]\n"
    size = sum(map(installed_size, required("tsm-crossval"))) / 1e6
    assert size <= 330
    stated("install.without-pyvista", size, relative=0.2)


@pytest.mark.slow
def test_the_sdist_has_what_its_tests_need(built: Path) -> None:
    import tarfile

    [sdist] = built.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert {
        "README.md",
        "CHANGELOG.md",
        "LICENSE",
        "CITATION.cff",
        "Makefile",
        ".constraints.txt",
        "pyproject.toml",
    } <= names
    for folder in ("tsm", "comparisons", "fem_reference", "tests", "docs"):
        assert any(name.startswith(f"{folder}/") for name in names)
    assert not [name for name in names if "__pycache__" in name or "_generated" in name]

"""What is built can be installed by itself and runs from anywhere."""

import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

import pytest

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
    venv.create(home, with_pip=False)
    [site] = home.glob("lib/python*/site-packages")
    (site / "libraries.pth").write_text(sysconfig.get_path("purelib"))
    [wheel] = built.glob("*.whl")
    target = ["--target", str(site), "--no-deps", "--no-index"]
    subprocess.run([sys.executable, "-m", "pip", "install", "-q", *target, str(wheel)], check=True)
    return home / "bin" / "python"


def run(python: Path, folder: Path, *arguments: str) -> str:
    code = "import sys; from comparisons.cli import main; sys.exit(main())"
    done = subprocess.run(
        [str(python), "-I", "-c", code, *arguments], cwd=folder, check=True, capture_output=True, text=True
    )
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

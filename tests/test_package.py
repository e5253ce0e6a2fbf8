"""What is built can be installed by itself and runs from anywhere; what is said of it in its files for others agrees."""

import ast
import importlib
import re
import subprocess
import sys
import tarfile
import tomllib
import venv
from importlib import metadata
from importlib.util import cache_from_source
from pathlib import Path

import pytest
import yaml
from markdown_it import MarkdownIt
from packaging.requirements import Requirement

from docs.extensions.description import description

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
SYSTEMS = {"ubuntu": "POSIX :: Linux", "macos": "MacOS", "windows": "Microsoft :: Windows"}
PACKAGES = ("tsm", "fem_reference", "comparisons")


def run(*command: object, folder: Path = ROOT, status: int = 0) -> "subprocess.CompletedProcess[str]":
    words = list(map(str, command))
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == status, done.stderr
    return done


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the sdist and the wheel that is built of it."""
    folder = tmp_path_factory.mktemp("dist")
    run(sys.executable, "-m", "build", "--no-isolation", "--outdir", folder)
    return folder


def environment(home: Path, built: Path) -> Path:
    """Make an environment with the wheel alone; return its folder of packages."""
    venv.create(home, with_pip=False)
    [site] = home.glob("lib/python*/site-packages")
    [wheel] = built.glob("*.whl")
    run(sys.executable, "-m", "pip", "install", "-q", "--target", site, "--no-deps", "--no-index", wheel)
    return site


def required(*names: str) -> set[str]:
    """Return the distributions that some require, however indirectly."""
    found: set[str] = set()
    wanted = list(names)
    while wanted:
        for requirement in map(Requirement, metadata.requires(wanted.pop()) or ()):
            name = re.sub(r"[-_.]+", "-", requirement.name).lower()
            needed = requirement.marker is None or requirement.marker.evaluate({"extra": ""})
            if needed and name not in found:
                found.add(name)
                wanted.append(name)
    return found


def installed_size(name: str) -> int:
    """Return the bytes of a distribution, with the bytecode that an installation compiles."""
    sources = {Path(str(file.locate())) for file in metadata.files(name) or () if file.suffix != ".pyc"}
    compiled = {Path(cache_from_source(path)) for path in sources if path.suffix == ".py"}
    return sum(path.stat().st_size for path in sources | compiled if path.is_file())


def crossval(home: Path, folder: Path, line: str, status: int = 0) -> "subprocess.CompletedProcess[str]":
    code = "import sys; from comparisons.cli import main; sys.exit(main())"
    return run(home / "bin" / "python", "-I", "-c", code, *line.split(), folder=folder, status=status)


@pytest.mark.slow
def test_a_plain_installation_is_small_and_runs(built, tmp_path, stated):
    """An environment that has the wheel, what it requires and no more."""
    home = tmp_path / "environment"
    site = environment(home, built)
    for name in required("tsm-crossval"):
        for entry in {file.parts[0] for file in metadata.files(name) or ()} - {"..", "__pycache__"}:
            (site / entry).symlink_to(Path(str(metadata.distribution(name).locate_file(entry))))
    code = f"import {', '.join(PACKAGES)}; print(tsm.__file__, fem_reference.__file__, comparisons.__file__)"
    where = run(home / "bin" / "python", "-I", "-c", code, folder=tmp_path).stdout.split()
    assert all(file.startswith(str(home)) for file in where)
    assert "MISSING" not in crossval(home, tmp_path, "--version").stdout
    crossval(home, tmp_path, "new strip")
    crossval(home, tmp_path, "check strip.toml")
    assert '"$schema"' in crossval(home, tmp_path, "scenes --schema").stdout
    assert "exact rod" in crossval(home, tmp_path, "compare ks-cantilever --out out").stdout
    assert (tmp_path / "out" / "report.html").stat().st_size < 3e6
    size = sum(map(installed_size, required("tsm-crossval"))) / 1e6
    assert size <= 330
    stated("install.size", size, relative=0.2)


@pytest.mark.slow
def test_the_sdist_has_what_its_tests_need(built):
    [sdist] = built.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    files = "README.md CHANGELOG.md LICENSE CITATION.cff Makefile .constraints.txt pyproject.toml tests docs"
    assert {*files.split(), *PACKAGES} <= names | {name.partition("/")[0] for name in names}
    assert not [name for name in names if "__pycache__" in name or "_generated" in name]


FRONTS = [
    file.parent.relative_to(ROOT)
    for package in PACKAGES
    for file in (ROOT / package).rglob("__init__.py")
    if "__all__" in file.read_text()
]


@pytest.mark.parametrize("folder", FRONTS, ids=str)
def test_a_package_shows_its_public_names_only_and_knows_its_version(folder):
    package = importlib.import_module(".".join(folder.parts))
    assert set(dir(package)) - {"__version__"} == set(package.__all__)
    assert all(hasattr(package, name) for name in dir(package))
    with pytest.raises(AttributeError, match="has no attribute 'nosuch'"):
        package.nosuch  # noqa: B018
    if len(folder.parts) == 1:
        assert package.__version__ == metadata.version("tsm-crossval")
        assert "__version__" in dir(package)


def test_few_tests_look_inside_and_each_says_why():
    """At most 40 files import what the pages of the API and the fronts of packages do not show, so that a room can be rebuilt under its tests."""
    pages = "".join(page.read_text() for page in (ROOT / "docs/api").glob("*.md"))
    public = {"comparisons", *re.findall(r":: ([\w.]+)", pages), *(".".join(front.parts) for front in FRONTS)}
    inside = {
        file.relative_to(ROOT / "tests").with_suffix("").as_posix()
        for file in (ROOT / "tests").rglob("*.py")
        for node in ast.walk(ast.parse(file.read_text()))
        if isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] in PACKAGES
        if node.module not in public and any(f"{node.module}.{one.name}" not in public for one in node.names)
    }
    reasons = tomllib.loads((ROOT / "tests/inside.toml").read_text())
    stated = [file for files in reasons.values() for file in files.split()]
    assert len(stated) <= 40
    assert sorted(inside) == sorted(stated)


COMMAND = "from comparisons.cli import main\ntry:\n    main({})\nexcept SystemExit:\n    pass"
SOLVE = ["solve", "ks-cantilever", "--model", "tsm", "--elements", "4"]
CHECK = ["check", "ks-cantilever"]
UNUSED = {"scipy.linalg", "scipy.optimize", "scipy.sparse", "fem_reference", "comparisons.referee.friction"}
"""Modules that a frictionless solution and its certificate do without."""


@pytest.mark.parametrize(
    ("code", "there", "absent"),
    [
        ("import tsm", "numpy", {"scipy", "importlib.metadata"}),
        (COMMAND.format(["-h"]), "comparisons.cli", {"numpy", "importlib.metadata"}),
        (COMMAND.format(SOLVE), "comparisons.referee.certify", UNUSED),
        (COMMAND.format(CHECK), "fem_reference", {"scipy.linalg", "scipy.optimize", "skfem"}),
    ],
    ids=["tsm", "help", "solve", "check"],
)
def test_a_start_imports_what_it_uses(code, there, absent):
    """The modules that cost most only where they are used; `make bench` measures the times."""
    done = run(sys.executable, "-c", f"{code}\nimport sys\nprint(*sys.modules, file=sys.stderr)")
    modules = set(done.stderr.split())
    assert there in modules
    assert not modules & absent


def classified(kind: str) -> set[str]:
    return {line.removeprefix(kind) for line in PROJECT["classifiers"] if line.startswith(kind)}


def workflow(name: str) -> dict:
    return yaml.safe_load((ROOT / ".github" / "workflows" / name).read_text())


def test_every_system_and_the_oldest_and_newest_python_are_tried_at_one_version():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text())["version"]
    released = re.search(r"^## (\d\S*)", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert cited == released[1] == PROJECT["version"] == metadata.version("tsm-crossval")
    named = {item for item in classified("Programming Language :: Python :: ") if "." in item}
    oldest, *_, newest = pythons = sorted(named, key=lambda version: int(version.partition(".")[2]))
    assert PROJECT["requires-python"] == f">={oldest}"
    for job in ("wheel", "fast"):
        matrix = workflow("tests.yml")["jobs"][job]["strategy"]["matrix"]
        assert matrix["python"] == [oldest, newest]
        systems = {SYSTEMS[system.partition("-")[0]] for system in matrix["os"]}
        assert systems == classified("Operating System :: ")
    assert yaml.safe_load((ROOT / ".readthedocs.yaml").read_text())["build"]["tools"]["python"] in pythons
    platforms = re.search(r"(?m)^PYTHONS = (.*)$", (ROOT / "tests/platforms/noxfile.py").read_text())
    assert list(ast.literal_eval(platforms[1])) == pythons


def test_a_workflow_runs_what_there_is():
    jobs = [job for name in ("tests.yml", "docs.yml") for job in workflow(name)["jobs"].values()]
    runs = [step["run"] for job in jobs for step in job["steps"] if "run" in step]
    targets = set(re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    assert {line.split()[1] for line in runs if line.startswith("make ")} <= targets
    assert ".ci/run" in runs
    assert (ROOT / ".ci" / "run").is_file()


def test_the_description_is_whole_without_the_repository():
    readme = (ROOT / "README.md").read_text()
    text = description(readme)
    tokens = [part for one in MarkdownIt("commonmark").parse(text) for part in (one, *(one.children or ()))]
    assert not [part for part in tokens if part.type in {"image", "html_inline", "html_block"}]
    links = [str(part.attrs["href"]) for part in tokens if part.type == "link_open"]
    assert [link for link in links if not link.startswith("https://")] == []
    for kept in (r"(?m)^#+ .*", r"(?s)```.*?```"):
        assert re.findall(kept, text) == re.findall(kept, readme)

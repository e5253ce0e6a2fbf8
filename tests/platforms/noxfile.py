"""The same answers on every Python and the oldest and newest libraries: ``nox -f tests/platforms/noxfile.py``."""

import os
import re
import tomllib
from pathlib import Path

import nox

ROOT = Path(__file__).parents[2]
PYTHONS = ["3.11", "3.12", "3.13"]
LIBRARIES = ("numpy", "scipy", "scikit-fem", "meshio")
FIRST = {"3.13": {"numpy": "2.1.0", "scipy": "1.14.1"}}
"""First versions with wheels for a Python that is younger than the lowest."""
# the commands that pyenv puts on the path find one Python only; the others lie beside it
PYENV = Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv")
os.environ["PATH"] = os.pathsep.join([*map(str, PYENV.glob("versions/3.*/bin")), os.environ["PATH"]])
# a Python that is not here is skipped with a line, and a failure where continuous integration runs
nox.options.error_on_missing_interpreters = os.environ.get("CI") == "true"
nox.options.default_venv_backend = "venv"
nox.options.envdir = str(ROOT / ".nox")


def lowest(python):
    """Return the lowest versions that pyproject.toml allows and that have wheels."""
    stated = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    bounds = dict(re.fullmatch(r"([\w-]+)>=([\d.]+)", line).groups() for line in stated)
    return [f"{name}=={FIRST.get(python, {}).get(name, bounds[name])}" for name in LIBRARIES]


@nox.session(python=PYTHONS)
@nox.parametrize("versions", ["oldest", "newest"])
def numbers(session, versions):
    """Compare answers with the golden files."""
    session.chdir(ROOT)
    if versions == "oldest":
        session.install("--only-binary", ":all:", *lowest(str(session.python)))
    else:
        session.install("--upgrade", *LIBRARIES)
    session.install("--no-deps", "--editable", ".")  # its version is stated in the answers
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
    session.run("python", "-m", "tests.platforms.numbers", env=threads)

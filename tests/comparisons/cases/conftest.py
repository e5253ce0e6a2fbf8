"""Studies for the tests: small cases, and the command in this process or one of its own."""

import csv
import io
import os
import sqlite3
import subprocess
import sys
from contextlib import closing, redirect_stdout
from time import monotonic, sleep

import pytest

from comparisons.cli import main

COMMAND = "import sys; from comparisons.cli import main; sys.exit(main())"
CASES = 30
"""Of the tiny study, about 10 ms each."""
TINY = f"""
[study]
name = "tiny"
scene = "ks-cantilever"
repeats = 1

[[run]]
model = "tsm"
element = ["mixed", "exact", "timoshenko"]
elements = {{ from = 5, to = {CASES // 3 + 4}, count = {CASES // 3} }}
scene.load_parameters = 5
"""
MANY = """
[study]
name = "many"
scene = "ks-cantilever"
repeats = 1
[[run]]
model = "tsm"
element = ["mixed", "timoshenko"]
elements = { from = 2, to = 8, count = 3, spacing = "log" }
scene.load_parameters = 2
[[run]]
model = "tsm"
elements = 4
element = "mixed"
scene.load_parameters = 2
[[run]]
model = "rod"
scene.load_parameters = 2
[[run]]
model = "solid"
mesh = "10x1"
scene.load_parameters = 2
beam.height = { from = 0.01, to = 0.03, count = 3 }
beam.cantilever.width = 0.5
contact."pin->cantilever".penalty = 1e3
pin.displacement = [[-0.5, 0.3]]
[[run]]
model = "tsm"
integration_tolerance = 1e-9
scene.load_parameters = 2
[[run]]
model = "tsm"
elements = 5
contact.keep = true
pin.start = [[0.9, 0.0]]
pin.displacement = [[0.0, 0.6]]
scene.load_parameters = 2
"""
"""All ends a case can have; one case is stated twice."""


def crossval(*arguments):
    """Run the command here; return its exit status, also where the reading of its arguments ends it."""
    try:
        return main(list(map(str, arguments)))
    except SystemExit as end:
        return int(end.code or 0)


def rows(file, *options):
    """Return what ``crossval results --csv`` says of a file."""
    text = io.StringIO()
    with redirect_stdout(text):
        assert crossval("results", file, "--csv", *options) == 0
    return list(csv.DictReader(io.StringIO(text.getvalue())))


def asked(file, query, *values):
    """Ask or change a results file behind the program's back."""
    with closing(sqlite3.connect(file)) as connection, connection:
        return connection.execute(query, values).fetchall()


def recorded(file):
    """Number of results in a file that may not be there yet."""
    try:
        with closing(sqlite3.connect(f"{file.as_uri()}?mode=ro", uri=True)) as connection:
            return int(connection.execute("SELECT count(*) FROM result").fetchone()[0])
    except sqlite3.Error:
        return 0


def wait_for(condition, seconds=60):
    deadline = monotonic() + seconds
    while not condition():
        assert monotonic() < deadline, "waited in vain"
        sleep(0.01)


@pytest.fixture
def tiny(tmp_path):
    (tmp_path / "tiny.toml").write_text(TINY)
    return tmp_path / "tiny.toml"


@pytest.fixture(scope="session")
def many(tmp_path_factory):
    """The results of `MANY`."""
    folder = tmp_path_factory.mktemp("many")
    (folder / "many.toml").write_text(MANY)
    assert crossval("study", folder / "many.toml", "--out", folder, "--workers", "1", "--quiet") == 0
    return folder / "many.sqlite"


@pytest.fixture
def copy(many, tmp_path):
    """A copy of these results, which a test may spoil."""
    (tmp_path / "copy.sqlite").write_bytes(many.read_bytes())
    return tmp_path / "copy.sqlite"


@pytest.fixture
def start():
    """Start the command as the leader of its own group of processes."""

    def begin(*arguments, **options):
        return subprocess.Popen(
            [sys.executable, "-c", COMMAND, *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
            **options,
        )

    return begin

"""Studies for the tests: small cases, and the command in this process or one of its own."""

import csv
import json
from functools import partial
from time import monotonic, sleep

import pytest

from comparisons.cli import main
from tests.comparisons.processes import COMMAND, begun

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
element = "mixed"
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


def rows(table):
    """Return the rows of a study's table, without what differs from run to run."""
    with table.open() as file:
        return [
            {name: text for name, text in row.items() if name not in {"seconds", "peak_memory"}}
            for row in csv.DictReader(file)
        ]


def recorded(folder):
    """Number of results in a folder that may not be there yet."""
    return len(list(folder.glob("*.json")))


def histories(folder):
    """Every number of every result of the tiny study but seconds and memory, by key."""
    texts = {file.stem: json.loads(file.read_text()) for file in (folder / "tiny").glob("*.json")}
    return {key: text | {"seconds": 0.0, "peak_memory": 0} for key, text in texts.items()}


def check_finished(study, folder, whole):
    """The same command goes on to the table of a run that was left alone."""
    assert crossval("run", study, "--out", folder, "--workers", "1") == 0
    assert rows(folder / "tiny.csv") == rows(whole / "tiny.csv")
    assert histories(folder) == histories(whole)


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
def whole(tmp_path_factory):
    """The folder of the tiny study, uninterrupted."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "tiny.toml").write_text(TINY)
    assert crossval("run", folder / "tiny.toml", "--out", folder, "--workers", "1") == 0
    return folder


@pytest.fixture(scope="session")
def many(tmp_path_factory):
    """The table of `MANY`, beside the folder of its results."""
    folder = tmp_path_factory.mktemp("many")
    (folder / "many.toml").write_text(MANY)
    assert crossval("run", folder / "many.toml", "--out", folder, "--workers", "1", "--quiet") == 0
    return folder / "many.csv"


@pytest.fixture
def start():
    """Start the command as the leader of its own group of processes."""
    return partial(begun, COMMAND, start_new_session=True)

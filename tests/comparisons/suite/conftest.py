"""Studies for the tests: small cases, and the command in this process or one of its own."""

import csv
import json
from functools import partial
from pathlib import Path
from time import monotonic, sleep

import pytest

from comparisons.cli import main
from tests.comparisons.processes import COMMAND, begun

CASES = 30
"""Number of cases in the tiny study."""
TINY, MANY = (Path(__file__).with_name(f"{name}.toml") for name in ("tiny", "many"))


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


def check_finished(folder, whole):
    """The same command goes on to the table of a run that was left alone."""
    assert crossval("run", TINY, "--out", folder, "--workers", "1") == 0
    assert rows(folder / "tiny.csv") == rows(whole / "tiny.csv")
    assert histories(folder) == histories(whole)


def wait_for(condition, seconds=60):
    deadline = monotonic() + seconds
    while not condition():
        assert monotonic() < deadline, "waited in vain"
        sleep(0.01)


@pytest.fixture(scope="session")
def whole(tmp_path_factory):
    """The folder of the tiny study, uninterrupted."""
    folder = tmp_path_factory.mktemp("whole")
    assert crossval("run", TINY, "--out", folder, "--workers", "1") == 0
    return folder


@pytest.fixture(scope="session")
def many(tmp_path_factory):
    """The table of `MANY`, beside the folder of its results."""
    folder = tmp_path_factory.mktemp("many")
    assert crossval("run", MANY, "--out", folder, "--workers", "1", "--quiet") == 0
    return folder / "many.csv"


@pytest.fixture
def start():
    """Start the command as the leader of its own group of processes."""
    return partial(begun, COMMAND, start_new_session=True)

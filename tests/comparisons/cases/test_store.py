"""The results file: claims, results, and every file that cannot be used."""

import os
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing
from dataclasses import replace
from importlib import metadata
from multiprocessing import get_context
from pathlib import Path
from time import time

import pytest

from comparisons.cases import owner as owners
from comparisons.cases.case import Case
from comparisons.cases.measure import Measurement, measure, unmeasured
from comparisons.cases.owner import Owner
from comparisons.cases.results import read_results
from comparisons.cases.store import WORKER_LOST, Store
from comparisons.files import OutputError
from comparisons.models.options import Options
from comparisons.scene import load_scene
from comparisons.version import version
from tests.comparisons.cases.faults import write_many

KS = replace(load_scene("ks-cantilever"), load_parameters=2)
CASE = Case(scene=KS, model="tsm", options=Options(elements=3))
NOBODY = 65534


@pytest.fixture(scope="module")
def measured() -> Measurement:
    return measure(CASE, repeats=1)


def intact(path: Path) -> int:
    """Check the whole file; return its number of results."""
    with closing(sqlite3.connect(path)) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        (count,) = connection.execute("SELECT count(*) FROM result").fetchone()
    return int(count)


def test_a_result_comes_back_as_it_was(tmp_path: Path, measured: Measurement) -> None:
    with Store(tmp_path / "a.sqlite") as store:
        store.record(CASE.key, CASE, measured)
        assert store.statuses() == {CASE.key: "COMPLETED"}
    (result,) = read_results(tmp_path / "a.sqlite")
    assert (result.key, result.scene, result.label) == (CASE.key, "ks-cantilever", CASE.label)
    assert result.measurement.to_json() == measured.to_json()


def test_two_runs_never_hold_the_same_case(tmp_path: Path, measured: Measurement) -> None:
    with Store(tmp_path / "a.sqlite") as one, Store(tmp_path / "a.sqlite") as other:
        assert one.claim("abc", limit=2).claimed == ["a", "b"]
        found = other.claim("abc", limit=3)
        assert (found.claimed, found.taken, found.done) == (["c"], ["a", "b"], {})
        one.record("a", CASE, measured)
        found = other.claim("abc", limit=3)
        assert (found.claimed, found.taken, found.done) == (["c"], ["b"], {"a": "COMPLETED"})
        assert other.claim("a", limit=1, again=frozenset("a")).claimed == ["a"]
        one.__exit__(None, None, None)
        assert other.claim("b", limit=1).claimed == ["b"]


@pytest.mark.slow
def test_four_writers_share_the_cases(tmp_path: Path) -> None:
    path, keys = tmp_path / "a.sqlite", 600
    with ProcessPoolExecutor(4, mp_context=get_context("spawn")) as pool:
        shares = list(pool.map(write_many, [str(path)] * 4, [keys] * 4))
    assert sorted(key for share in shares for key in share) == [f"{n:05}" for n in range(keys)]
    assert sum(bool(share) for share in shares) > 1, "one writer was alone"
    assert intact(path) == keys


def dead() -> int:
    child = subprocess.Popen([sys.executable, "-c", ""])
    child.wait()
    return child.pid


@pytest.mark.parametrize(
    ("owner", "heard", "free"),
    [
        (Owner.this_process, 0, False),
        (lambda: replace(Owner.this_process(), pid=dead()), 0, True),
        (lambda: replace(Owner.this_process(), born=0.0), 0, True),
        (lambda: replace(Owner.this_process(), host="elsewhere", pid=dead()), 0, False),
        (Owner.this_process, -owners.LEASE - 1, True),
    ],
    ids=["alive", "dead", "number used again", "another machine", "lease over"],
)
def test_claims_of_the_dead_are_free(
    owner: Callable[[], Owner], heard: float, free: bool, tmp_path: Path
) -> None:
    with Store(tmp_path / "a.sqlite") as one, Store(tmp_path / "a.sqlite") as other:
        one.claim("a", limit=1)
        who = owner()
        one._connection.execute(
            "UPDATE run SET host = ?, pid = ?, born = ?, heard = ? WHERE id = ?",
            (who.host, who.pid, who.born, time() + heard, one._run),
        )
        found = other.claim("a", limit=1)
        assert (found.claimed, found.taken) == (["a"], []) if free else ([], ["a"])


def test_a_settled_result_stands_and_a_lost_one_does_not(tmp_path: Path, measured: Measurement) -> None:
    with Store(tmp_path / "a.sqlite") as store:
        store.record("a", CASE, unmeasured(WORKER_LOST, "it died"))
        store.record("a", CASE, measured)
        assert store.statuses() == {"a": "COMPLETED"}
        store.record(
            "a", CASE, replace(measured, response=replace(measured.response, status="STEP_TOO_SMALL"))
        )
        store.record("a", CASE, unmeasured(WORKER_LOST, "it died"))
        assert store.statuses() == {"a": "COMPLETED"}
    assert intact(tmp_path / "a.sqlite") == 1


def test_a_full_file_is_one_line_and_stays_whole(tmp_path: Path, measured: Measurement) -> None:
    path = tmp_path / "a.sqlite"
    store = Store(path)
    store._connection.execute("PRAGMA max_page_count = 20")
    recorded = 0

    def fill() -> None:
        nonlocal recorded
        with store:
            while recorded < 100:
                store.record(str(recorded), CASE, measured)
                recorded += 1

    with pytest.raises(OutputError, match=r"a\.sqlite: cannot be written: database or disk is full$"):
        fill()
    assert 0 < recorded == intact(path) == len(read_results(path))


def other_database(path: Path) -> None:
    connection = sqlite3.connect(path)
    connection.execute("CREATE TABLE result (key TEXT)")
    connection.close()


def of_schema(path: Path, number: int) -> None:
    with Store(path) as store:
        store._connection.execute(f"PRAGMA user_version = {number}")


@pytest.mark.parametrize(
    ("make", "reason"),
    [
        (lambda path: path.write_text("key,status\n" * 100), "file is not a database"),
        (other_database, "is no results file of crossval, but another SQLite database"),
        (
            lambda path: of_schema(path, 99),
            "has schema 99, this version of crossval reads 3: choose another file",
        ),
        (
            lambda path: of_schema(path, 1),
            "has schema 1, this version of crossval reads 3: choose another file",
        ),
        (Path.mkdir, "is not a regular file|there is no such file"),
    ],
    ids=["text", "another database", "newer", "older", "folder"],
)
def test_other_files_are_refused_and_left_alone(
    make: Callable[[Path], object], reason: str, tmp_path: Path
) -> None:
    path = tmp_path / "a.sqlite"
    make(path)
    before = path.read_bytes() if path.is_file() else None
    for use in (Store, read_results):
        with pytest.raises(OutputError, match=reason):
            use(path)
    assert (path.read_bytes() if path.is_file() else None) == before
    assert [item.name for item in tmp_path.iterdir()] == ["a.sqlite"]


def test_no_file_is_no_results(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="there is no such file"):
        read_results(tmp_path / "a.sqlite")
    with pytest.raises(OutputError, match="there is no folder"):
        Store(tmp_path / "none" / "a.sqlite")
    assert not list(tmp_path.iterdir())


def as_nobody(action: Callable[[], None]) -> bool:
    """Whether `action` passes in a process that may write nothing of this user's."""
    child = os.fork()
    if child == 0:
        try:
            if os.getuid() == 0:
                os.setgid(NOBODY)
                os.setuid(NOBODY)
            action()
        except BaseException as error:  # noqa: BLE001 - the child must not go on with the tests
            os.write(2, f"{error!r}\n".encode())
            os._exit(1)
        os._exit(0)
    return os.waitpid(child, 0)[1] == 0


@pytest.mark.filterwarnings("ignore:.*multi-threaded.*:DeprecationWarning")
def test_a_folder_that_is_only_read(tmp_path: Path, measured: Measurement) -> None:
    path = tmp_path / "a.sqlite"
    with Store(path) as store:
        store.record(CASE.key, CASE, measured)
    before = path.read_bytes()
    if os.getuid() == 0:
        for folder in (tmp_path, *list(tmp_path.parents)[:3]):
            folder.chmod(0o755)
    tmp_path.chmod(0o555)

    def use() -> None:
        for file in (path, tmp_path / "new.sqlite"):
            with pytest.raises(OutputError, match="cannot be written: Permission denied"):
                Store(file)
        assert len(read_results(path)) == 1

    try:
        assert as_nobody(use)
    finally:
        tmp_path.chmod(0o755)
    assert path.read_bytes() == before
    assert [item.name for item in tmp_path.iterdir()] == ["a.sqlite"]


def of_version(path: Path, version: str, *, key: str | None = None) -> None:
    """Let the results in a file be those of another version, whose keys differ."""
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute("UPDATE result SET version = ?, key = coalesce(?, key)", (version, key))


@pytest.mark.parametrize("key", [None, "other"])
def test_a_result_of_another_version_is_none(key: str | None, tmp_path: Path, measured: Measurement) -> None:
    path = tmp_path / "a.sqlite"
    with Store(path) as store:
        store.record(CASE.key, CASE, replace(measured, response=replace(measured.response, cutbacks=12345)))
    of_version(path, "0.1.0", key=key)
    with Store(path) as store:
        assert store.statuses() == {}
        assert store.older({CASE.key: CASE}) == {CASE.key: ("0.1.0", "COMPLETED")}
        assert store.claim([CASE.key], limit=1).claimed == [CASE.key]
        store.record(CASE.key, CASE, measured)
        assert store.statuses() == {CASE.key: "COMPLETED"}
    found = {result.version: result.measurement.response.cutbacks for result in read_results(path)}
    assert found[version()] == measured.response.cutbacks
    assert ("0.1.0" in found) is (key is not None)


def test_older_results_are_those_of_the_same_case(tmp_path: Path, measured: Measurement) -> None:
    path = tmp_path / "a.sqlite"
    cases = {
        "scene": replace(CASE, scene=replace(KS, load_parameters=3)),
        "model": replace(CASE, model="rod", options=Options()),
        "options": replace(CASE, options=Options(elements=4)),
        "file": replace(CASE, scene=replace(KS, beams=(replace(KS.beams[0], solid_mesh_file="a.msh"),))),
    }
    with Store(path) as store:
        store.record(CASE.key, CASE, measured)
        store.record("file", cases["file"], measured)
        of_version(path.resolve(), "0.1.0")
        assert store.older({"same": CASE, **cases}) == {"same": ("0.1.0", "COMPLETED")}


def test_the_version_tells_sources_apart(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "version_probe"
    package.mkdir()
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr("comparisons.version.PACKAGES", ("version_probe",))
    seen = []
    for text in ("a = 1\n", "a = 2\n", "a = 1\r\n"):
        (package / "__init__.py").write_text(text)
        seen.append(version.__wrapped__())
    assert seen[0] == seen[2] != seen[1]
    assert seen[0].startswith(f"{metadata.version('tsm-crossval')}+")

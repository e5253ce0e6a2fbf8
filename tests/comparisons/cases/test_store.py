"""The results file between runs, and what a case measures: what no command can bring about alone."""

import os
import pickle
import subprocess
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from time import time

import numpy as np
import psutil  # noqa: F401 - on Unix it takes `resource` itself, so it is there before that is hidden
import pytest

# not public: the races of two runs, the death of an owner and a worker's exception cannot be timed from outside
from comparisons.cases import Case, Measurement, measure, memory
from comparisons.cases import owner as owners
from comparisons.cases import run as run_module
from comparisons.cases.measure import unmeasured
from comparisons.cases.owner import Owner
from comparisons.cases.store import WORKER_LOST, Store
from comparisons.cases.workers import Workers
from comparisons.files import OutputError
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.scene import load_scene
from comparisons.version import version
from tests.comparisons.cases.conftest import asked, crossval, recorded, rows

KS = replace(load_scene("ks-cantilever"), load_parameters=2)
CASE = Case(scene=KS, model="tsm", options=Options(elements=3))
NOBODY = 65534


@pytest.fixture(scope="module")
def measured() -> Measurement:
    return measure(CASE, repeats=1)


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


def dead() -> int:
    child = subprocess.Popen([sys.executable, "-c", ""])
    child.wait()
    return child.pid


OWNERS: dict[str, tuple[Callable[[], Owner], float, bool]] = {
    "alive": (Owner.this_process, 0, False),
    "dead": (lambda: replace(Owner.this_process(), pid=dead()), 0, True),
    "number used again": (lambda: replace(Owner.this_process(), born=0.0), 0, True),
    "another machine": (lambda: replace(Owner.this_process(), host="elsewhere", pid=dead()), 0, False),
    "lease over": (Owner.this_process, -owners.LEASE - 1, True),
}


@pytest.mark.parametrize("case", OWNERS)
def test_claims_of_the_dead_are_free(case: str, tmp_path: Path) -> None:
    owner, heard, free = OWNERS[case]
    path, who = tmp_path / "a.sqlite", owner()
    with Store(path) as one, Store(path) as other:
        one.claim("a", limit=1)
        change = "UPDATE run SET host = ?, pid = ?, born = ?, heard = ? WHERE id = (SELECT min(id) FROM run)"
        asked(path, change, who.host, who.pid, who.born, time() + heard)
        found = other.claim("a", limit=1)
        assert (found.claimed, found.taken) == (["a"], []) if free else ([], ["a"])


def test_a_settled_result_stands_and_a_lost_one_does_not(tmp_path: Path, measured: Measurement) -> None:
    with Store(tmp_path / "a.sqlite") as store:
        store.record("a", CASE, unmeasured(WORKER_LOST, "it died"))
        store.record("a", CASE, measured)
        assert store.statuses() == {"a": "COMPLETED"}
        store.record("a", CASE, unmeasured("STEP_TOO_SMALL", ""))
        store.record("a", CASE, unmeasured(WORKER_LOST, "it died"))
        assert store.statuses() == {"a": "COMPLETED"}


def test_older_results_are_those_of_the_same_case(tmp_path: Path, measured: Measurement) -> None:
    """One with a mesh file has none: nobody knows what was in it."""
    path = tmp_path / "a.sqlite"
    meshed = replace(CASE, scene=replace(KS, beams=(replace(KS.beams[0], solid_mesh_file="a.msh"),)))
    cases = {
        "same": CASE,
        "scene": replace(CASE, scene=replace(KS, load_parameters=3)),
        "model": replace(CASE, model="rod", options=Options()),
        "options": replace(CASE, options=Options(elements=4)),
        "file": meshed,
    }
    with Store(path) as store:
        store.record(CASE.key, CASE, measured)
        store.record("file", meshed, measured)
        asked(path, "UPDATE result SET version = '0.1.0'")
        assert store.statuses() == {}
        assert store.older(cases) == {"same": ("0.1.0", "COMPLETED")}
        assert store.claim([CASE.key], limit=1).claimed == [CASE.key]
        store.record(CASE.key, CASE, measured)
        assert store.statuses() == {CASE.key: "COMPLETED"}


def test_a_full_file_is_one_line_and_stays_whole(tmp_path: Path, measured: Measurement) -> None:
    path = tmp_path / "a.sqlite"
    store, count = Store(path), 0
    store._connection.execute("PRAGMA max_page_count = 20")

    def fill() -> None:
        nonlocal count
        with store:
            while count < 100:
                store.record(str(count), CASE, measured)
                count += 1

    with pytest.raises(OutputError, match=r"a\.sqlite: cannot be written: database or disk is full$"):
        fill()
    assert asked(path, "PRAGMA integrity_check") == [("ok",)]
    assert 0 < count == recorded(path) == len(rows(path))


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
def test_a_folder_that_is_only_read(tmp_path: Path, measured: Measurement, tiny: Path) -> None:
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
            assert crossval("study", tiny, "--results", file) == 2
        assert len(rows(path)) == 1

    try:
        assert as_nobody(use)
    finally:
        tmp_path.chmod(0o755)
    assert path.read_bytes() == before
    assert sorted(item.name for item in tmp_path.iterdir()) == ["a.sqlite", "tiny.toml"]


@contextmanager
def thread() -> Iterator[Executor]:
    with ThreadPoolExecutor(1) as executor:
        yield executor


def test_a_case_that_raises_is_listed_and_done_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, workers = tmp_path / "a.sqlite", Workers(width=1, start=thread)
    cases = [CASE, replace(CASE, options=Options(elements=4))]
    right = run_module.solve

    def raising(key: str, case: Case, **how: bool) -> Measurement:
        if case == CASE:
            raise ZeroDivisionError("a bug\nin two lines")
        return right(key, case, repeats=0, process=False)

    monkeypatch.setattr(run_module, "solve", raising)
    with Store(path) as store:
        tally = run_module.run(cases, store, workers, repeats=0)
        assert (tally.statuses, tally.failed) == ({"COMPLETED": 1, "ERROR": 1}, 1)
        assert [row["message"] for row in rows(path)][:1] == ["ZeroDivisionError: a bug in two lines"]
        monkeypatch.undo()
        reported = list[run_module.Tally]()
        assert run_module.run(cases, store, workers, repeats=0, progress=reported.append).failed == 0
        # on a slow machine the beat reports the same tally again
        assert list(dict.fromkeys((one.done, one.total) for one in reported)) == [(1, 2), (2, 2)]
        assert reported[-1].left == 0
    with pytest.raises(RuntimeError, match="another version"):
        run_module.solve("0" * 64, CASE, repeats=1, process=False)


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


def test_the_key_depends_on_everything_that_the_result_does(tmp_path: Path) -> None:
    file = tmp_path / "a.msh"
    file.write_text("one")
    meshed = replace(
        CASE, model="solid", scene=replace(KS, beams=(replace(KS.beams[0], solid_mesh_file=str(file)),))
    )
    others = [
        replace(CASE, options=Options(elements=5)),
        replace(CASE, options=Options(elements=3, element="timoshenko")),
        replace(CASE, model="solid", options=Options()),
        replace(CASE, scene=replace(KS, load_parameters=6)),
        replace(CASE, scene=replace(KS, contacts=(replace(KS.contacts[0], penalty=1e3),))),
        meshed,
    ]
    keys = {CASE.key, *(other.key for other in others)}
    file.write_text("two")
    assert len({*keys, meshed.key}) == 2 + len(others)
    again = pickle.loads(pickle.dumps(CASE))  # noqa: S301 made here
    assert (again, again.key) == (CASE, CASE.key)


SOFT = replace(KS, contacts=(replace(KS.contacts[0], penalty=1e-3),))
ENDS = {
    "COMPLETED": CASE,
    "REFUSED": replace(CASE, options=Options(mesh=(2, 1))),
    "CUTBACK_FLOOR": Case(scene=SOFT, model="solid", options=Options(mesh=(10, 1))),
}


@pytest.mark.slow_at("CUTBACK_FLOOR")
@pytest.mark.parametrize("status", ENDS)
def test_a_measurement_is_the_response_and_comes_back_as_it_was(status: str) -> None:
    """Without a timed run it has neither axes nor a verdict."""
    case = ENDS[status]
    timed, found = measure(case, repeats=1), measure(case, repeats=0)
    for one in (timed, found):
        again = Measurement.from_json(one.to_json())
        assert again.to_json() == one.to_json() == pickle.loads(pickle.dumps(one)).to_json()  # noqa: S301
        assert [type(value) for value in vars(again.response).values()] == [
            type(value) for value in vars(one.response).values()
        ]
    assert (found.response.status, found.response.completed) == (status, status == "COMPLETED")
    assert found.verdict == ""
    if status == "COMPLETED":
        response = solve(case.scene, case.model, case.options)
        assert (timed.verdict, timed.repeats) == ("CERTIFIED", 1)
        assert timed.response.iterations == response.newton_iterations.sum()
        assert np.array_equal(timed.response.tips["cantilever"], response.tips["cantilever"])
        line = timed.response.axis_line("cantilever", 1)[1]
        assert line.shape == (101, 2)
        assert line[[0, -1]] == pytest.approx(np.array([[0, 0], response.tips["cantilever"][1]]), abs=1e-3)
        assert len(found.to_json()) < len(timed.to_json()) / 5


def test_peak_memory_without_proc_and_resource(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As on Windows: psutil tells how much memory there is."""
    monkeypatch.setattr(memory, "CLEAR", tmp_path / "none" / "clear_refs")
    monkeypatch.setitem(sys.modules, "resource", None)
    size = 64 * 2**20
    kept, rise = memory.with_peak_memory(lambda: np.ones(size // 8))
    assert 0.9 * size < rise < 1.5 * size
    assert kept.nbytes == size

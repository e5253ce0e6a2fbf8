"""The results file between runs, and what a case measures: what no command can bring about alone."""

import os
import pickle
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from time import time

import numpy as np
import psutil  # noqa: F401 - on Unix it takes `resource` itself, so it is there before that is hidden
import pytest

# not public: the death of an owner on any machine, the races of two runs and a worker's exception cannot be timed from outside
from comparisons.cases import Case, Measurement, measure, memory
from comparisons.cases import run as run_module
from comparisons.cases.measure import unmeasured
from comparisons.cases.owner import LEASE, Owner
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
MESHED = replace(CASE, scene=replace(KS, beams=(replace(KS.beams[0], solid_mesh_file="a.msh"),)))


@pytest.fixture(scope="module")
def measured():
    return measure(CASE, repeats=1)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "a.sqlite"


def dead():
    child = subprocess.Popen([sys.executable, "-c", ""])
    child.wait()
    return child.pid


OWNERS = {
    "alive": (dict, 0, False),
    "dead": (lambda: {"pid": dead()}, 0, True),
    "number used again": (lambda: {"born": 0.0}, 0, True),
    "another machine": (lambda: {"host": "elsewhere", "pid": dead()}, 0, False),
    "lease over": (dict, -LEASE - 1, True),
}


@pytest.mark.parametrize("case", OWNERS)
def test_claims_of_the_dead_are_free(case, path, measured):
    change, heard, free = OWNERS[case]
    with Store(path) as one, Store(path) as other:
        assert one.claim("abc", limit=2).claimed == ["a", "b"]
        one.record("b", CASE, measured)
        who = replace(Owner.this_process(), **change())
        query = "UPDATE run SET host = ?, pid = ?, born = ?, heard = ? WHERE id = (SELECT min(id) FROM run)"
        asked(path, query, who.host, who.pid, who.born, time() + heard)
        found = other.claim("abc", limit=3)
        assert (found.claimed, found.taken) == (["a", "c"], []) if free else (["c"], ["a"])
        assert found.done == {"b": "COMPLETED"}
        assert other.claim("b", limit=1, again=frozenset("b")).claimed == ["b"]
        one.__exit__(None, None, None)
        assert other.claim("a", limit=1).claimed == ["a"]


def test_a_settled_result_stands_and_older_ones_are_those_of_the_same_case(path, measured):
    """A lost one does not stand; one with a mesh file is of no other version, as nobody knows what was in the file."""
    lost = unmeasured(WORKER_LOST, "it died")
    with Store(path) as store:
        for one in (lost, measured, unmeasured("STEP_TOO_SMALL", ""), lost):
            store.record(CASE.key, CASE, one)
        assert store.statuses() == {CASE.key: "COMPLETED"}
        store.record("file", MESHED, measured)
        asked(path, "UPDATE result SET version = '0.1.0'")
        assert store.statuses() == {}
        others = {
            "scene": replace(CASE, scene=replace(KS, load_parameters=3)),
            "model": replace(CASE, model="rod", options=Options()),
            "options": replace(CASE, options=Options(elements=4)),
        }
        assert store.older({"same": CASE, **others, "file": MESHED}) == {"same": ("0.1.0", "COMPLETED")}
        assert store.claim([CASE.key], limit=1).claimed == [CASE.key]
        store.record(CASE.key, CASE, measured)
        assert store.statuses() == {CASE.key: "COMPLETED"}


def test_a_full_file_is_one_line_and_stays_whole(path, measured):
    store, count = Store(path), 0
    store._connection.execute("PRAGMA max_page_count = 20")

    def fill():
        nonlocal count
        with store:
            while count < 100:
                store.record(str(count), CASE, measured)
                count += 1

    with pytest.raises(OutputError, match=r"a\.sqlite: cannot be written: database or disk is full$"):
        fill()
    assert asked(path, "PRAGMA integrity_check") == [("ok",)]
    assert 0 < count == recorded(path) == len(rows(path))


def as_nobody(action):
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
def test_a_folder_that_is_only_read(many, copy, capfd):
    before, folder = copy.read_bytes(), copy.parent
    if os.getuid() == 0:
        for one in (*list(folder.parents)[:3], *many.parents[:3]):
            one.chmod(0o755)
    folder.chmod(0o555)

    def use():
        for file in (copy, folder / "new.sqlite"):
            assert crossval("study", many.with_suffix(".toml"), "--results", file) == 2
        assert len(rows(copy)) == 12

    try:
        assert as_nobody(use)
    finally:
        folder.chmod(0o755)
    told = f"crossval: {folder}: cannot be written: Permission denied"
    assert capfd.readouterr().err.splitlines() == [told, told]
    assert copy.read_bytes() == before
    assert [item.name for item in folder.iterdir()] == ["copy.sqlite"]


@contextmanager
def thread():
    with ThreadPoolExecutor(1) as executor:
        yield executor


def test_a_case_that_raises_is_listed_and_done_again(path, monkeypatch):
    cases = [CASE, replace(CASE, options=Options(elements=4))]
    workers, right, reported = Workers(width=1, start=thread), run_module.solve, list[run_module.Tally]()

    def raising(key, case, **how):
        if case == CASE:
            raise ZeroDivisionError("a bug\nin two lines")
        return right(key, case, repeats=0, process=False)

    monkeypatch.setattr(run_module, "solve", raising)
    with Store(path) as store:
        tally = run_module.run(cases, store, workers, repeats=0)
        assert (tally.statuses, tally.failed) == ({"COMPLETED": 1, "ERROR": 1}, 1)
        assert [row["message"] for row in rows(path)][:1] == ["ZeroDivisionError: a bug in two lines"]
        monkeypatch.undo()
        assert run_module.run(cases, store, workers, repeats=0, progress=reported.append).failed == 0
    # on a slow machine the beat reports the same tally again
    assert list(dict.fromkeys((one.done, one.total) for one in reported)) == [(1, 2), (2, 2)]
    assert reported[-1].left == 0
    with pytest.raises(RuntimeError, match="another version"):
        run_module.solve("0" * 64, CASE, repeats=1, process=False)


def test_the_key_depends_on_everything_that_the_result_does(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    others = [
        replace(CASE, options=Options(elements=5)),
        replace(CASE, options=Options(elements=3, element="timoshenko")),
        replace(CASE, model="solid", options=Options()),
        replace(CASE, scene=replace(KS, load_parameters=6)),
        replace(CASE, scene=replace(KS, contacts=(replace(KS.contacts[0], penalty=1e3),))),
    ]
    keys = [CASE.key, *(other.key for other in others)]
    for text in ("one", "two"):
        Path("a.msh").write_text(text)
        keys.append(MESHED.key)
    package = tmp_path / "version_probe"
    package.mkdir()
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr("comparisons.version.PACKAGES", ("version_probe",))
    seen = []
    for text in ("a = 1\n", "a = 2\n", "a = 1\r\n"):
        (package / "__init__.py").write_text(text)
        seen.append(version.__wrapped__())
    assert seen[0] == seen[2] != seen[1]
    assert len(set(keys)) == len(keys)
    again = pickle.loads(pickle.dumps(CASE))  # noqa: S301 made here
    assert (again, again.key) == (CASE, CASE.key)


def test_a_measurement_is_the_response_and_comes_back_as_it_was(measured):
    """Without a timed run it has neither axes nor a verdict."""
    found, response = measured.response, solve(KS, "tsm", CASE.options)
    assert (measured.verdict, measured.repeats) == ("CERTIFIED", 1)
    assert found.iterations == response.newton_iterations.sum()
    assert np.array_equal(found.tips["cantilever"], response.tips["cantilever"])
    line = found.axis_line("cantilever", 1)[1]
    assert line.shape == (101, 2)
    assert line[[0, -1]] == pytest.approx(np.array([[0, 0], response.tips["cantilever"][1]]), abs=1e-3)
    refused, untimed = measure(replace(CASE, options=Options(mesh=(2, 1)))), measure(CASE, repeats=0)
    assert (refused.response.status, refused.response.completed) == ("REFUSED", False)
    assert refused.verdict == untimed.verdict == ""
    for one in (measured, refused, untimed):
        again = Measurement.from_json(one.to_json())
        assert again.to_json() == one.to_json() == pickle.loads(pickle.dumps(one)).to_json()  # noqa: S301
        types = [[type(value) for value in vars(each.response).values()] for each in (again, one)]
        assert types[0] == types[1]


def test_peak_memory_without_proc_and_resource(tmp_path, monkeypatch):
    """As on Windows: psutil tells how much memory there is."""
    monkeypatch.setattr(memory, "CLEAR", tmp_path / "none" / "clear_refs")
    monkeypatch.setitem(sys.modules, "resource", None)
    size = 64 * 2**20
    _, rise = memory.with_peak_memory(lambda: np.ones(size // 8))
    assert 0.9 * size < rise < 1.5 * size

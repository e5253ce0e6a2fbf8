"""Cases over executors: once each, resumed, and what happens when workers die."""

from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from comparisons.cases import run as run_module
from comparisons.cases.case import Case
from comparisons.cases.results import read_results
from comparisons.cases.run import Tally, run
from comparisons.cases.store import Store
from comparisons.cases.workers import Workers, local
from comparisons.models.options import Options
from comparisons.scene import load_scene
from tests.comparisons.cases import faults

KS = replace(load_scene("ks-cantilever"), load_parameters=2)
CASES = [Case(scene=KS, model="tsm", options=Options(elements=n)) for n in range(2, 8)]


@contextmanager
def thread() -> Iterator[Executor]:
    with ThreadPoolExecutor(1) as executor:
        yield executor


THREAD = Workers(width=1, start=thread)


def done(path: Path, cases: list[Case], workers: Workers = THREAD) -> Tally:
    with Store(path) as store:
        return run(cases, store, workers, repeats=1)


@pytest.mark.slow
def test_equal_cases_are_done_once_and_none_again(tmp_path: Path) -> None:
    path, reported = tmp_path / "a.sqlite", list[Tally]()
    assert done(path, CASES[:2]).statuses == {"COMPLETED": 2}
    before = {result.key: result.measurement.seconds for result in read_results(path)}
    with Store(path) as store:
        run([*CASES[:4], *CASES], store, THREAD, repeats=1, progress=reported.append)
    # on a slow machine the beat reports the same tally again
    assert list(dict.fromkeys((tally.done, tally.total) for tally in reported)) == [
        (n, 6) for n in range(2, 7)
    ]
    assert reported[-1].left == 0
    after = {result.key: result.measurement.seconds for result in read_results(path)}
    assert before.items() <= after.items()
    assert sorted(after) == sorted(case.key for case in CASES)


def test_what_stops_or_is_refused_is_a_result(tmp_path: Path) -> None:
    pin = replace(KS.pins[0], start=(0.9, 0.0), displacement=(0.0, 0.6))
    leaves = replace(KS, pins=(pin,), contacts=(replace(KS.contacts[0], keep=True),))
    cases = [
        *CASES[:1],
        Case(scene=KS, model="tsm", options=Options(integration_tolerance=1e-9)),
        Case(scene=leaves, model="tsm", options=Options(elements=4)),
    ]
    tally = done(tmp_path / "a.sqlite", cases)
    assert (tally.done, tally.failed) == (3, 2)
    assert tally.statuses == {"COMPLETED": 1, "REFUSED": 1, "SLIPPED_OFF": 1}
    again = done(tmp_path / "a.sqlite", cases)
    assert again == replace(tally, seconds=again.seconds)


@pytest.mark.slow
def test_a_case_that_kills_its_worker_is_tried_once_more_and_blamed_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.sqlite"
    monkeypatch.setattr(run_module, "solve", faults.killed)
    assert done(path, CASES, local(2)).statuses == {"COMPLETED": 5, "WORKER_LOST": 1}
    lost = next(result for result in read_results(path) if not result.measurement.response.completed)
    assert lost.settings["elements"] == faults.FATAL
    # it says nothing about the case, which the next run tries again
    monkeypatch.undo()
    assert done(path, CASES).statuses == {"COMPLETED": 6}


@pytest.mark.slow
def test_a_killed_worker_costs_one_retry(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    marker = tmp_path / "killed"
    monkeypatch.setenv("CROSSVAL_TEST_MARKER", str(marker))
    monkeypatch.setattr(run_module, "solve", faults.killed_once)
    assert done(tmp_path / "a.sqlite", CASES, local(2)).statuses == {"COMPLETED": 6}
    assert marker.exists()


@pytest.mark.slow
def test_a_case_that_raises_does_not_stop_the_others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.sqlite"
    monkeypatch.setattr(run_module, "solve", faults.raising)
    assert done(path, CASES).statuses == {"COMPLETED": 5, "ERROR": 1}
    wrong = next(result for result in read_results(path) if not result.measurement.response.completed)
    assert wrong.measurement.response.message == "ZeroDivisionError: a bug in two lines"


def test_a_worker_of_another_version_is_found_out() -> None:
    with pytest.raises(RuntimeError, match="another version"):
        run_module.solve("0" * 64, CASES[0], repeats=1, process=False)

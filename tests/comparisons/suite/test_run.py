"""What no command can bring about alone: a worker's exception, a result that is no result, the key and the measurement of a case."""

import pickle
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from comparisons.answer.quantities import KEPT, SCOPES
from comparisons.files import OutputError
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.scene import load_scene

# not public: a worker's exception cannot be brought about from outside, nor systems without /proc
from comparisons.suite import Case, Row, changed, measure
from comparisons.suite import run as run_module
from comparisons.suite.measure import unmeasured
from comparisons.version import version

KS = replace(load_scene("ks-cantilever"), load_parameters=2)
CASE = Case(scene=KS, model="tsm", options=Options(elements=3))
MESHED = replace(CASE, scene=replace(KS, beams=(replace(KS.beams[0], solid_mesh_file="a.msh"),)))


@pytest.fixture(scope="module")
def measured():
    return measure(CASE, repeats=1)


@contextmanager
def thread():
    with ThreadPoolExecutor(1) as executor:
        yield executor, 1


def test_a_case_that_raises_is_listed_and_done_again(tmp_path, monkeypatch):
    cases = [CASE, replace(CASE, options=Options(elements=4)), CASE]
    right, reported = run_module.solve, []

    def raising(key, case, **how):
        if case == CASE:
            raise ZeroDivisionError("a bug\nin two lines")
        return right(key, case, **how)

    monkeypatch.setattr(run_module, "solve", raising)
    found = run_module.run(cases, tmp_path, thread, repeats=0)
    assert next((one.response.status, one.response.message) for one in found.values()) == (
        "ERROR",
        "ZeroDivisionError: a bug in two lines",
    )
    monkeypatch.undo()
    again = run_module.run(
        cases, tmp_path, thread, repeats=0, progress=lambda total, rows: reported.append((len(rows), total))
    )
    assert [one.response.status for one in again.values()] == ["COMPLETED"] * 2
    assert reported == [(1, 2), (2, 2)]
    monkeypatch.setattr(run_module, "solve", None)
    kept = run_module.run(cases, tmp_path, thread)
    assert [one.to_json() for one in kept.values()] == [one.to_json() for one in again.values()]
    with pytest.raises(RuntimeError, match="another version"):
        right("0" * 64, CASE, repeats=1, process=False)


@pytest.mark.parametrize("content", [b"", b"{}", b"[1]", b"\xff", None])
def test_a_file_that_is_no_result_is_one_line_and_left_alone(content, measured, tmp_path):
    file = tmp_path / f"{CASE.key}.json"
    file.write_bytes(measured.to_json().encode()[:40] if content is None else content)
    before = file.read_bytes()
    with pytest.raises(OutputError, match=r"\.json: is damaged: delete it, and the case is solved again$"):
        run_module.run([CASE], tmp_path, thread)
    assert (file.read_bytes(), list(tmp_path.iterdir())) == (before, [file])


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
    assert (refused.response.status, refused.verdict, untimed.verdict) == ("REFUSED", "", "")
    for one in (measured, refused, untimed):
        again = Row.from_json(one.case, one.to_json())
        assert again.to_json() == one.to_json() == pickle.loads(pickle.dumps(one)).to_json()  # noqa: S301
        types = [[type(value) for value in vars(each.response).values()] for each in (again, one)]
        assert types[0] == types[1]


def test_a_case_without_an_answer_has_no_errors():
    lost, exact = unmeasured(CASE, "WORKER_LOST", "gone"), solve(KS, "rod")
    row = lost.against(exact, KEPT)
    assert np.isnan([row.error(scope, name) for scope in SCOPES for name in KEPT]).all()
    assert (row.outcome, row.wrong) == ("WORKER_LOST", False)


def test_a_change_of_a_kind_that_the_scene_does_not_have_changes_nothing():
    scene = load_scene("tip-load")
    assert changed(scene, {"contact.penalty": None, "pin.radius": 1.0}) == scene

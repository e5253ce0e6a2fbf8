"""Cases and what one of them measures."""

import pickle
import sys
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import psutil  # noqa: F401 - on Unix it takes `resource` itself, so it is there before that is hidden
import pytest

from comparisons.cases import Case, Measurement, measure, memory
from comparisons.cases.memory import with_peak_memory
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.response.axis import SampledAxes
from comparisons.scene import load_scene

KS = replace(load_scene("ks-cantilever"), load_parameters=5)
PAIR = "pin->cantilever"


def case(model: str = "tsm", **options: object) -> Case:
    return Case(scene=KS, model=model, options=Options(**options))  # type: ignore[arg-type]


def same(a: Measurement, b: Measurement) -> bool:
    return a.to_json() == b.to_json()


def test_key_depends_on_everything_that_the_result_does() -> None:
    base = case(elements=4)
    others = [
        case(elements=5),
        case(elements=4, element="timoshenko"),
        case("solid"),
        replace(base, scene=replace(KS, load_parameters=6)),
        replace(base, scene=replace(KS, contacts=(replace(KS.contacts[0], penalty=1e3),))),
    ]
    assert len({base.key, *(other.key for other in others)}) == 1 + len(others)
    assert pickle.loads(pickle.dumps(base)).key == case(elements=4).key  # noqa: S301 made here
    assert len({base, case(elements=4)}) == 1


def test_key_depends_on_the_mesh_file(tmp_path: Path) -> None:
    file = tmp_path / "a.msh"
    file.write_text("one")
    of_file = Case(scene=replace(KS, beams=(replace(KS.beams[0], solid_mesh_file=str(file)),)), model="solid")
    before = of_file.key
    file.write_text("two")
    assert of_file.key != before


@pytest.mark.slow_at("solid", "tsm")
@pytest.mark.parametrize(
    "one", [case(elements=4), case("solid", mesh=(10, 1)), case("rod")], ids=lambda one: one.model
)
def test_measurement_is_the_response(one: Case) -> None:
    measured, response = measure(one, repeats=2), solve(one.scene, one.model, one.options)
    found = measured.response
    assert (found.status, found.completed, measured.repeats) == ("COMPLETED", True, 2)
    assert measured.verdict == "CERTIFIED"
    assert 0.0 < measured.seconds < 60.0
    assert found.iterations == response.newton_iterations.sum()
    assert np.array_equal(found.load_parameter, response.load_parameter)
    assert np.array_equal(found.contacts[PAIR].force, response.contacts[PAIR].force)
    assert np.array_equal(found.tips["cantilever"], response.tips["cantilever"])
    line = np.array([found.axis_line("cantilever", k)[1] for k in range(5)])
    assert line.shape == (5, 101, 2)
    assert line[:, -1] == pytest.approx(found.tips["cantilever"], abs=1e-3)
    assert line[:, 0] == pytest.approx(np.zeros((5, 2)), abs=1e-3)
    again = Measurement.from_json(measured.to_json())
    assert same(measured, again)
    assert same(measured, pickle.loads(pickle.dumps(measured)))  # noqa: S301 made here
    for kept, read in ((measured, again), (measured.response, again.response)):
        assert {item.name: type(getattr(kept, item.name)) for item in fields(kept)} == {
            item.name: type(getattr(read, item.name)) for item in fields(read)
        }
    with pytest.raises(NotImplementedError, match="has no mesh"):
        again.response.grid(0)


def test_what_is_not_timed_keeps_no_axes() -> None:
    found = measure(case(elements=4), repeats=0)
    assert found.verdict == ""
    assert np.array_equal(
        found.response.tips["cantilever"], solve(KS, "tsm", Options(elements=4)).tips["cantilever"]
    )
    assert len(found.to_json()) < len(measure(case(elements=4), repeats=1).to_json()) / 5
    assert same(found, Measurement.from_json(found.to_json()))


def test_a_refused_case_is_measured_as_refused() -> None:
    found = measure(case("tsm", mesh=(2, 1)))
    assert (found.response.status, found.response.completed) == ("REFUSED", False)
    assert "not an option" in found.response.message
    assert same(found, Measurement.from_json(found.to_json()))


@pytest.mark.slow
def test_a_stopped_case_keeps_what_it_reached() -> None:
    soft = replace(KS, contacts=(replace(KS.contacts[0], penalty=1e-3),))
    found = measure(Case(scene=soft, model="solid", options=Options(mesh=(10, 1))), repeats=1)
    assert not found.response.completed
    assert found.response.status != "COMPLETED"
    assert len(found.response.load_parameter) < 5
    assert same(found, Measurement.from_json(found.to_json()))


def test_an_empty_history_keeps_its_shape() -> None:
    found = measure(case(elements=4), repeats=1)
    response, beam, clamp = found.response, "cantilever", "cantilever.start"
    support = response.supports[clamp]
    empty = replace(
        response,
        load_parameter=np.empty(0),
        contacts={},
        supports={clamp: replace(support, force=support.force[:0], moment=support.moment[:0])},
        material_force={},
        tips={beam: response.tips[beam][:0]},
        axis_line=SampledAxes(arc_length={}, position={}),
        newton_iterations=response.newton_iterations[:0],
        index=None,
    )
    again = Measurement.from_json(replace(found, response=empty).to_json()).response
    assert again.tips[beam].shape == again.supports[clamp].force.shape == (0, 2)


def test_peak_memory_without_proc_and_resource(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As on Windows: psutil tells how much memory there is."""
    monkeypatch.setattr(memory, "CLEAR", tmp_path / "none" / "clear_refs")
    monkeypatch.setitem(sys.modules, "resource", None)
    size = 64 * 2**20
    kept, rise = with_peak_memory(lambda: np.ones(size // 8))
    assert 0.9 * size < rise < 1.5 * size
    assert kept.nbytes == size

"""A result prints itself, draws itself, and comes as plain arrays."""

import io
import subprocess
import sys

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import tsm

STRIP = tsm.Section.rectangle(width=0.02, height=0.02, youngs_modulus=2.1e4, shear_modulus=8.0769e3)
KS = tsm.Structure(
    beams=(tsm.Beam(name="cantilever", start=(0, 0), end=(1, 0), section=STRIP, elements=10),),
    supports=(tsm.Support(beam="cantilever", end="start"),),
    pins=(tsm.Pin(name="pin", path=((1, 0), (0, 2 / np.pi))),),
    contacts=(tsm.ContactPair(node="pin", beam="cantilever", side="right"),),
)


@pytest.fixture(scope="module")
def result() -> tsm.Result:
    return tsm.solve(KS, np.linspace(0.1, 1, 10))


def test_a_result_prints_what_it_found(result: tsm.Result) -> None:
    lines = repr(result).splitlines()
    assert lines[0] == "COMPLETED: all load parameters were reached"
    assert lines[1].startswith("33 unknowns, ")
    assert lines[2] == "at load parameter 1, the last of 10:"
    contact = result.contacts["pin->cantilever"]
    assert f"force {contact.force[-1]:.9g} at arc position {contact.arc_position[-1]:.9g}" in lines[3]
    passes = sum(event.kind is tsm.EventKind.PASS_THROUGH for event in result.events)
    assert f"{passes} pass-through" in lines[-1]


def test_a_result_that_stopped_prints_its_reason() -> None:
    with pytest.raises(tsm.SolveError) as caught:
        tsm.solve(KS, [0.5], tsm.Settings(max_iterations=1, smallest_step=0.2))
    stopped = caught.value.result
    assert repr(stopped).splitlines()[0] == f"{stopped.status.name}: {stopped.message}"


def test_arrays_keep_names_and_shapes(result: tsm.Result) -> None:
    arrays = result.arrays()
    assert {len(array) for array in arrays.values()} == {10}
    assert arrays["cantilever.tip"].shape == (10, 2)
    assert arrays["pin->cantilever.force"] is result.contacts["pin->cantilever"].force
    file = io.BytesIO()
    np.savez(file, **arrays)
    file.seek(0)
    assert set(np.load(file)) == set(arrays)


def test_a_table_has_columns_of_one_length(result: tsm.Result) -> None:
    table = result.table()
    assert {values.shape for values in table.values()} == {(10,)}
    assert table["cantilever.tip_y"] == pytest.approx(result.tips["cantilever"][:, 1])
    assert table["cantilever.start.support_force_x"][-1] == result.supports["cantilever.start"].force[-1, 0]
    shown = result._repr_html_()
    assert f"<td>pin-&gt;cantilever.force</td><td>{table['pin->cantilever.force'][-1]:.6g}</td>" in shown


def test_a_result_draws_its_axes_and_pins(result: tsm.Result) -> None:
    figure = Figure()
    FigureCanvasAgg(figure)
    axes = result.plot(figure.subplots(), shown=3)
    lines = [line.get_xydata() for line in axes.get_lines()]
    for k in (0, 4, 9):
        assert any(np.array_equal(line, result.axis_line("cantilever", k)[1]) for line in lines)
    stars = next(line for line in axes.get_lines() if line.get_marker() == "*")
    assert stars.get_xydata()[-1] == pytest.approx(KS.pins[0].position(1.0))
    assert axes.get_title() == "COMPLETED"


@pytest.mark.slow
def test_it_draws_into_the_current_axes_of_a_notebook() -> None:
    code = """
import matplotlib
matplotlib.use("agg")
from matplotlib import pyplot
import tests.tsm.test_present as case, numpy as np, tsm
axes = tsm.solve(case.KS, [0.5]).plot()
assert axes is pyplot.gca() and axes.get_lines()
"""
    subprocess.run([sys.executable, "-c", code], check=True)


def test_tsm_imports_no_matplotlib() -> None:
    subprocess.run(
        [sys.executable, "-c", "import sys, tsm; assert 'matplotlib' not in sys.modules"], check=True
    )

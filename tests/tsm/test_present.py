"""A result prints itself, draws itself, and comes as plain arrays."""

import subprocess
import sys

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import tsm
from tests.tsm.structures import KS, KS_PATH, TENTHS, cantilever


@pytest.fixture(scope="module")
def result() -> tsm.Result:
    return tsm.solve(cantilever(KS_PATH, section=KS), TENTHS)


def test_a_result_prints_what_it_found_or_why_it_stopped(result: tsm.Result) -> None:
    lines = repr(result).splitlines()
    assert lines[0] == "COMPLETED: all load parameters were reached"
    assert lines[1].startswith("33 unknowns, ")
    assert lines[2] == "at load parameter 1, the last of 10:"
    contact = result.contacts["p0->b"]
    assert f"force {contact.force[-1]:.9g} at arc position {contact.arc_position[-1]:.9g}" in lines[3]
    assert f"{len(result.events)} pass-through" in lines[-1]
    stopped = tsm.solve(
        cantilever(KS_PATH), [0.5], tsm.Settings(max_iterations=1, smallest_step=0.2), throw=False
    )
    assert repr(stopped).splitlines()[0] == f"{stopped.status.name}: {stopped.message}"


def test_arrays_and_columns_keep_names_and_shapes(result: tsm.Result) -> None:
    arrays, table = result.arrays(), result.table()
    assert {len(array) for array in arrays.values()} == {10}
    assert arrays["b.tip"].shape == (10, 2)
    assert arrays["p0->b.force"] is result.contacts["p0->b"].force
    assert {values.shape for values in table.values()} == {(10,)}
    assert table["b.tip_y"] == pytest.approx(result.tips["b"][:, 1])
    assert table["b.start.support_force_x"][-1] == result.supports["b.start"].force[-1, 0]
    assert f"<td>p0-&gt;b.force</td><td>{table['p0->b.force'][-1]:.6g}</td>" in result._repr_html_()


def test_a_result_draws_its_axes_and_pins(result: tsm.Result) -> None:
    figure = Figure()
    FigureCanvasAgg(figure)
    axes = result.plot(figure.subplots(), shown=3)
    lines = [line.get_xydata() for line in axes.get_lines()]
    for k in (0, 4, 9):
        assert any(np.array_equal(line, result.axis_line("b", k)[1]) for line in lines)
    stars = next(line for line in axes.get_lines() if line.get_marker() == "*")
    assert stars.get_xydata()[-1] == pytest.approx(KS_PATH[-1])
    assert axes.get_title() == "COMPLETED"


@pytest.mark.slow
def test_it_draws_into_the_current_axes_of_a_notebook() -> None:
    code = (
        "import matplotlib; matplotlib.use('agg')\nfrom matplotlib import pyplot\n"
        "from tests.tsm.structures import KS_PATH, cantilever\nimport sys, tsm\n"
        "axes = tsm.solve(cantilever(KS_PATH), [0.5]).plot()\nassert axes is pyplot.gca() and axes.get_lines()"
    )
    subprocess.run([sys.executable, "-c", code], check=True)

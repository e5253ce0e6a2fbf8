"""A result prints itself, draws itself, and comes as plain arrays."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import tsm
from tests.tsm.structures import KS, KS_PATH, TENTHS, cantilever


@pytest.fixture(scope="module")
def result():
    return tsm.solve(cantilever(KS_PATH, section=KS), TENTHS)


def test_a_result_prints_its_status_and_has_columns_of_every_quantity(result):
    first, counts, *lines = repr(result).splitlines()
    contact, moment = result.contacts["p0->b"], result.supports["b.start"].moment[-1]
    x, y = result.tips["b"][-1]
    assert (first, counts[:13]) == ("COMPLETED: all load parameters were reached", "33 unknowns, ")
    assert lines[:4] == [
        "at load parameter 1, the last of 10:",
        f"  p0->b: force {contact.force[-1]:.9g} at arc position {contact.arc_position[-1]:.9g}",
        f"  b.start: support moment {moment:.9g}",
        f"  b: end at ({x:.9g}, {y:.9g})",
    ]
    arrays, table = result.arrays(), result.table()
    assert {len(array) for array in arrays.values()} == {len(column) for column in table.values()} == {10}
    assert arrays["p0->b.force"] is result.contacts["p0->b"].force
    assert table["b.tip_y"] == pytest.approx(result.tips["b"][:, 1])
    assert f"<td>p0-&gt;b.force</td><td>{table['p0->b.force'][-1]:.6g}</td>" in result._repr_html_()


def test_a_result_draws_its_axes_and_pins(result):
    figure = Figure()
    FigureCanvasAgg(figure)
    axes = result.plot(figure.subplots(), shown=3)
    lines = [line.get_xydata() for line in axes.get_lines()]
    for k in (0, 4, 9):
        assert any(np.array_equal(line, result.axis_line("b", k)[1]) for line in lines)
    stars = next(line for line in axes.get_lines() if line.get_marker() == "*")
    assert stars.get_xydata()[-1] == pytest.approx(KS_PATH[-1])

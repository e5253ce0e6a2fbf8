"""What every registered element owes, asked of `tsm.solve`: linear limits, energy, section forces, axis, convergence; and what a result states."""

from __future__ import annotations

import os
import pickle
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import tsm
from tests.tsm.structures import KS, KS_PATH, TENTHS, cantilever, steps
from tsm.elements import CLOSED_FORM

SLACK = tsm.Section(EA=2e3, GA=100.0, EI=1.0)
ADDED = {"rigid in shear": replace(CLOSED_FORM["mixed"], name="rigid in shear", sheared=False)}
CORRECT = [*ADDED, *(name for name in tsm.ELEMENTS if not name.endswith("-as-printed"))]


@pytest.fixture(autouse=True)
def registered(monkeypatch):
    for name, kind in ADDED.items():
        monkeypatch.setitem(tsm.ELEMENTS, name, kind)


def pressed(element, *, pins=None, section=SLACK):
    """A cantilever pushed up by a pin, or by two on the same element where its matrix knows both."""
    pins = pins or (2 if tsm.ELEMENTS[element].contact_unknowns else 1)
    paths = [((x, -0.02), (x - 0.02, depth - 0.02)) for x, depth in ((0.55, 0.035), (0.95, 0.08))][:pins]
    return cantilever(*paths, section=section, element=element, elements=2, offset=0.02)


@pytest.mark.parametrize("element", CORRECT)
def test_the_work_of_a_pin_is_stored(element):
    """By Gauss's rule over its way. The contacts of the paper store a part of it, as springs, and lose some where beams shear."""
    structure, (t, weights) = pressed(element, pins=1), np.polynomial.legendre.leggauss(8)
    result = tsm.solve(structure, [*((1 + t) / 2), 1.0])
    push = -result.supports["b.start"].force[:-1] @ np.subtract(*structure.pins[0].path[::-1])
    lost = 2e-3 if element == "timoshenko" else 1e-5
    assert weights / 2 @ push == pytest.approx(result.strain_energy[-1], rel=lost)


def last_force(structure, t=(1.0,)):
    return tsm.solve(structure, t).contacts["p0->b"].force[-1]


@pytest.mark.parametrize("element", CORRECT)
def test_linear_beam_is_timoshenkos(element):
    """One element under a small force and moment at its tip, and under a small pull."""
    P, M, N = 1e-6, 2e-6, 3e-6
    load = tsm.Load(beam="b", end="end", force=(N, P), moment=M)
    result = tsm.solve(cantilever(section=SLACK, length=2.0, element=element, elements=1, load=load), [1.0])
    sheared = tsm.ELEMENTS[element].sheared
    x, y = result.tips["b"][-1]
    # the pull stiffens the bending by its part of EI/L^2
    assert x - 2.0 == pytest.approx(2.0 * N / SLACK.EA, rel=1e-2)
    assert y == pytest.approx(P * 8 / 3 + M * 2 + sheared * P * 2 / SLACK.GA, rel=1e-5)
    assert result.shape("b", -1)[-1, 2] == pytest.approx(P * 2 + M * 2, rel=1e-5)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-9])
def test_error_estimate_is_an_upper_bound(tolerance):
    """A long cantilever bends sharply at its clamp: what one exact element leaves is below what it says, and that below `integration_tolerance`."""
    load = tsm.Load(beam="b", end="end", force=(0.0, 5.0))
    structure = cantilever(
        section=tsm.Section(EA=1e4, GA=4e3, EI=1.0), length=10.0, element="exact", load=load
    )
    found, exact = (
        tsm.solve(structure, TENTHS, tsm.Settings(integration_tolerance=t)) for t in (tolerance, 1e-13)
    )
    error = np.abs(found.tips["b"] - exact.tips["b"]).max() / 10.0
    assert error <= found.integration_error <= tolerance
    assert found.integration_error <= 1e5 * error + 1e-12


def test_march_and_solve_agree_and_pass_throughs_are_listed():
    structure, t = cantilever(KS_PATH, section=KS), steps(50)
    taken = [step for step in tsm.march(structure, t) if step.requested]
    result = tsm.solve(structure, t)
    assert [step.equilibrium.state.load_parameter for step in taken] == result.load_parameter.tolist()
    assert (taken[-1].equilibrium.state.q == result.equilibria[-1].state.q).all()
    passes = [event for event in result.events if event.kind is tsm.EventKind.PASS_THROUGH]
    assert [event.element for event in passes[:3]] == [8, 7, 6]
    arcs = np.interp([e.load_parameter for e in passes], t, result.contacts["p0->b"].arc_position)
    assert arcs == pytest.approx([event.arc_position for event in passes], abs=1e-3)


def test_a_result_can_be_pickled():
    result = tsm.solve(pressed("exact"), [0.5, 1.0])
    other = pickle.loads(pickle.dumps(result))  # noqa: S301 - its own
    assert repr(other) == repr(result)
    assert other.shape("b", 1).tolist() == result.shape("b", 1).tolist()


def test_a_new_element_is_one_file(tmp_path):
    package = shutil.copytree(Path(tsm.__file__).parent, tmp_path / "tsm")
    (package / "elements" / "kinds" / "unsheared.py").write_text(
        "from dataclasses import replace\n"
        "from tsm.elements.kinds.mixed import MIXED\n"
        "ELEMENTS = (replace(MIXED, name='new', sheared=False),)\n"
    )
    # the child has the copy first on its path, and the tests behind it
    path = os.pathsep.join([str(tmp_path), str(Path(__file__).parents[2])])
    code = "import tests.tsm.test_contract as case; print(case.tsm.__file__, case.last_force(case.pressed('new')))"
    run = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env={**os.environ, "PYTHONPATH": path},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    file, force = run.stdout.split()
    assert file == str(package / "__init__.py")
    assert float(force) == pytest.approx(last_force(pressed("rigid in shear")), rel=1e-9)

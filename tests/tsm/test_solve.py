"""The Konyukhov-Schweizerhof cantilever: accuracy, order, independence of steps, what a result states."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import tsm
from tsm.model import Model
from tsm.stepping import Stepper

PAIR = "pin->cantilever"
RODS = tomllib.loads((Path(__file__).parents[1] / "reference" / "ks_rod.toml").read_text())
TWENTIETHS = np.arange(1, 21) / 20


def errors(result, surface="axis"):
    """Largest relative error of the force and error of the arc position over the tabulated load parameters."""
    rod = RODS[surface]
    at = [int(np.argmin(np.abs(result.load_parameter - t))) for t in rod["load_parameter"]]
    assert result.load_parameter[at] == pytest.approx(rod["load_parameter"], abs=1e-15)
    contact = result.contacts[PAIR]
    force = np.abs(contact.force[at] / rod["force"] - 1).max()
    return float(force), float(np.abs(contact.arc_position[at] - rod["arc_position"]).max())


@pytest.mark.parametrize(("elements", "bound"), [(5, 1.6e-3), (10, 1e-4), (20, 5e-6), (40, 1e-6)])
@pytest.mark.parametrize("surface", ["axis", "face"])
def test_mixed_meets_the_rod(ks, elements, bound, surface):
    result = tsm.solve(ks(elements, offset=RODS[surface]["offset"]), TWENTIETHS)
    assert max(errors(result, surface)) <= bound
    assert result.cutbacks == 0


@pytest.mark.parametrize(("element", "order", "within"), [("mixed", 4, 0.4), ("mixed-no-bow", 2, 0.4)])
def test_order_of_convergence(ks, element, order, within):
    found = [errors(tsm.solve(ks(n, element), TWENTIETHS))[0] for n in (5, 10, 20)]
    measured = np.log2(found[0] / found[2]) / 2
    assert abs(measured - order) <= within, (found, measured)


@pytest.mark.parametrize(("elements", "bound"), [(10, 1e-2), (20, 3e-3), (50, 6e-4)])
def test_the_papers_element_meets_the_rod_at_the_end(ks, elements, bound):
    result = tsm.solve(ks(elements, "timoshenko"), np.arange(1, 51) / 50)
    assert abs(result.contacts[PAIR].force[-1] / RODS["axis"]["force"][-1] - 1) <= bound


@pytest.mark.parametrize("x", [np.nextafter(1.0, 0.0), np.nextafter(1.0, 2.0)])
@pytest.mark.parametrize("y", [-5e-324, np.finfo(float).eps / 2, -np.finfo(float).eps])
def test_answers_do_not_depend_on_the_last_bit_of_the_pins_start(ks, x, y):
    plain, moved = (tsm.solve(ks(10, start=start), TWENTIETHS) for start in ((1.0, 0.0), (x, y)))
    for field in ("force", "arc_position"):
        a, b = (getattr(result.contacts[PAIR], field) for result in (plain, moved))
        assert np.abs(b / a - 1).max() <= 1e-9


def test_few_iterations_and_no_cutback(ks):
    result = tsm.solve(ks(10), np.arange(1, 51) / 50)
    assert result.cutbacks == 0
    assert result.newton_iterations.mean() <= 5


def test_newton_converges_quadratically(ks):
    """Once small, a residual falls to a hundred times its square or to round-off."""
    falls = []
    for step in tsm.march(ks(20), np.arange(1, 11) / 10):
        r = step.equilibrium.residuals
        falls += [(a, b) for a, b in pairwise(r) if 1e-6 < a < 1e-2]
    assert len(falls) >= 10
    assert np.mean([b <= 100 * a * a + 5e-10 for a, b in falls]) >= 0.95


def test_section_forces_follow_their_signs(ks):
    """Pushed up and back, the cantilever bends anticlockwise, most at the clamp, and not beyond the pin."""
    result = tsm.solve(ks(20), TWENTIETHS)
    forces = result.section_forces("cantilever", 9)
    assert forces[0, 0, 2] == pytest.approx(-result.supports["cantilever.start"].moment[9], rel=1e-9)
    assert forces[0, 0, 2] > 0
    assert forces[-1, 1] == pytest.approx([0, 0, 0], abs=1e-12)
    cut = np.hypot(forces[..., 0], forces[..., 1])
    assert cut[:-1, 1] == pytest.approx(cut[1:, 0], rel=1e-9, abs=1e-12)
    assert forces[:-1, 1, 2] == pytest.approx(forces[1:, 0, 2], rel=1e-9, abs=1e-12)


def test_march_and_solve_agree(ks):
    steps = [step for step in tsm.march(ks(10), TWENTIETHS) if step.requested]
    result = tsm.solve(ks(10), TWENTIETHS)
    assert [step.equilibrium.state.load_parameter for step in steps] == result.load_parameter.tolist()
    assert (steps[-1].equilibrium.state.q == result.equilibria[-1].state.q).all()


def test_a_solution_goes_on_from_accepted_states_as_if_it_had_not_stopped(ks):
    model = Model(ks(10))
    whole, first, second = (Stepper(model, tsm.Settings()) for _ in range(3))
    *_, end = whole.march(TWENTIETHS)
    *_, half = first.march(TWENTIETHS[:10])
    second.resume(list(first.track.history), first.control.step)
    *_, gone_on = second.march(TWENTIETHS)
    assert half.equilibrium.state.load_parameter == 0.5
    assert gone_on.equilibrium.state.load_parameter == 1.0
    np.testing.assert_array_equal(gone_on.equilibrium.state.q, end.equilibrium.state.q)
    assert gone_on.iterations == end.iterations


def test_pass_throughs_are_listed(ks):
    result = tsm.solve(ks(10), np.arange(1, 51) / 50)
    passes = [event for event in result.events if event.kind is tsm.EventKind.PASS_THROUGH]
    assert [event.element for event in passes[:3]] == [8, 7, 6]
    assert all(a.load_parameter <= b.load_parameter for a, b in pairwise(passes))
    arcs = np.interp(
        [e.load_parameter for e in passes], result.load_parameter, result.contacts[PAIR].arc_position
    )
    assert arcs == pytest.approx([event.arc_position for event in passes], abs=1e-3)


def test_stopped_solutions_say_so(ks):
    settings = tsm.Settings(max_iterations=1, smallest_step=0.01)
    with pytest.raises(tsm.SolveError, match="CUTBACK_FLOOR") as caught:
        tsm.solve(ks(10), TWENTIETHS, settings)
    assert caught.value.result.status is tsm.Status.CUTBACK_FLOOR
    result = tsm.solve(ks(10), TWENTIETHS, settings, throw=False)
    assert result.status is tsm.Status.CUTBACK_FLOOR
    assert len(result.load_parameter) < 20
    assert "stopped at load parameter" in result.message


@pytest.mark.parametrize("targets", [[], [0.0, 1.0], [0.5, 0.5], [0.5, 1.5], [float("nan")], [[0.5]]])
def test_load_parameters_are_checked(ks, targets):
    with pytest.raises(ValueError, match="must increase within"):
        tsm.solve(ks(2), np.array(targets))


def test_import_is_light():
    """`import tsm` needs NumPy and SciPy only."""
    code = (
        "import sys, tsm; "
        "print([m for m in ('skfem', 'meshio', 'pyvista', 'matplotlib', 'vtk') if m in sys.modules])"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"

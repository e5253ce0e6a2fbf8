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


def test_answers_do_not_depend_on_the_number_of_load_parameters(ks):
    results = [tsm.solve(ks(20), np.arange(1, n + 1) / n) for n in (10, 50, 400)]
    for result in results[1:]:
        every = len(result.load_parameter) // 10
        for field in ("force", "arc_position"):
            few = getattr(results[0].contacts[PAIR], field)
            many = getattr(result.contacts[PAIR], field)[every - 1 :: every]
            assert np.abs(many / few - 1).max() <= 1e-9


@pytest.mark.parametrize("x", [np.nextafter(1.0, 0.0), np.nextafter(1.0, 2.0)])
@pytest.mark.parametrize("y", [-5e-324, np.finfo(float).eps / 2, -np.finfo(float).eps])
def test_answers_do_not_depend_on_the_last_bit_of_the_pins_start(ks, x, y):
    plain, moved = (tsm.solve(ks(10, start=start), TWENTIETHS) for start in ((1.0, 0.0), (x, y)))
    for field in ("force", "arc_position"):
        a, b = (getattr(result.contacts[PAIR], field) for result in (plain, moved))
        assert np.abs(b / a - 1).max() <= 1e-9


@pytest.mark.parametrize(("elements", "bound"), [(10, 1e-4), (200, 1e-9), (2000, 1e-9)])
def test_many_elements_finish(ks, elements, bound):
    result = tsm.solve(ks(elements), TWENTIETHS)
    assert result.status is tsm.Status.COMPLETED
    assert errors(result)[0] <= bound


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


def test_supports_balance_the_pin(ks):
    result = tsm.solve(ks(10), TWENTIETHS)
    support, contact = result.supports["cantilever.start"], result.contacts[PAIR]
    assert np.hypot(*support.force.T) == pytest.approx(contact.force, rel=1e-9)
    pin = np.array([[1 - t, 2 / np.pi * t] for t in TWENTIETHS])
    # the support's force and moment hold the pin's force -support.force at the pin
    lever = pin[:, 0] * support.force[:, 1] - pin[:, 1] * support.force[:, 0]
    assert support.moment == pytest.approx(lever, rel=1e-7)
    assert (np.abs(contact.gap) <= 1e-12).all()
    assert (contact.force > 0).all()


def test_work_of_the_pin_is_the_strain_energy(ks):
    """Trapezoidal work over 400 steps against the energy in the axial, shear and bending of the elements."""
    structure = ks(40)
    result = tsm.solve(structure, np.arange(1, 401) / 400)
    direction = np.array([-1.0, 2 / np.pi])
    power = np.concatenate([[0.0], -result.supports["cantilever.start"].force @ direction])
    work = (power[1:] + power[:-1]).sum() / 2 / 400
    forces = result.section_forces("cantilever", -1)
    section, l0 = structure.beams[0].section, 1 / 40
    N, V, M = forces[..., 0], forces[..., 1], forces[..., 2]
    energy = l0 * (
        (N**2).mean(axis=1) / (2 * section.EA)
        + (V**2).mean(axis=1) / (2 * section.GA)
        + (M[:, 0] ** 2 + M[:, 0] * M[:, 1] + M[:, 1] ** 2) / (6 * section.EI)
    )
    assert work == pytest.approx(energy.sum(), rel=2e-3)


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


def test_a_beam_in_any_direction_and_from_either_side(ks):
    """Turned by 2 rad and mirrored, the answer is the same."""
    plain = tsm.solve(ks(10), TWENTIETHS)
    section = ks(10).beams[0].section
    turn = np.array([[np.cos(2.0), -np.sin(2.0)], [np.sin(2.0), np.cos(2.0)]])
    for mirror, side in ((1.0, "right"), (-1.0, "left")):
        map_ = turn @ np.diag([1.0, mirror])
        moved = [tuple((map_ @ p + [3.0, -1.0]).tolist()) for p in np.array([[0, 0], [1, 0], [0, 2 / np.pi]])]
        structure = tsm.Structure(
            beams=(tsm.Beam(name="cantilever", start=moved[0], end=moved[1], section=section, elements=10),),
            supports=(tsm.Support(beam="cantilever", end="start"),),
            pins=(tsm.Pin(name="pin", path=(moved[1], moved[2])),),
            contacts=(tsm.ContactPair(node="pin", beam="cantilever", side=side),),
        )
        result = tsm.solve(structure, TWENTIETHS)
        assert result.contacts[PAIR].force == pytest.approx(plain.contacts[PAIR].force, rel=1e-8)
        assert result.supports["cantilever.start"].moment == pytest.approx(
            mirror * plain.supports["cantilever.start"].moment, rel=1e-8
        )


def test_axis_line_runs_through_the_nodes(ks):
    result = tsm.solve(ks(10), TWENTIETHS)
    arc, xy = result.axis_line("cantilever", 12, points_per_element=7)
    assert arc == pytest.approx(np.linspace(0, 1, 71))
    assert xy[::7] == pytest.approx(result.shape("cantilever", 12)[:, :2])
    assert result.tips["cantilever"][12] == pytest.approx(xy[-1])


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

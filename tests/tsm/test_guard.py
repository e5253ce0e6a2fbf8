"""Branches and limit points under load and displacement control: the right branch, or a name."""

from __future__ import annotations

import numpy as np
import pytest

import tsm
from tsm.guard import PathGuard
from tsm.newton import Newton
from tsm.status import Status

SECTION = tsm.Section(EA=3e4, GA=9e3, EI=1.0)


def pushed_in(elements, element="mixed"):
    """Cantilever whose tip is pushed in by .5 and up by .3: it buckles at once."""
    return tsm.Structure(
        beams=(
            tsm.Beam(name="b", start=(0, 0), end=(1, 0), section=SECTION, elements=elements, element=element),
        ),
        supports=(
            tsm.Support(beam="b", end="start"),
            tsm.Support(beam="b", end="end", ux=-0.5, uy=0.3, rotation=None),
        ),
    )


@pytest.mark.parametrize("count", [5, 20, 50])
@pytest.mark.parametrize("elements", [5, 10, 20, 40])
def test_a_buckling_beam_stays_on_its_branch(elements, count):
    """The strain energy at the end is the same for any number of load parameters and elements."""
    reference = tsm.solve(pushed_in(40), np.arange(1, 101) / 100)
    result = tsm.solve(pushed_in(elements), np.arange(1, count + 1) / count)
    assert result.strain_energy[-1] == pytest.approx(reference.strain_energy[-1], rel=2e-3)
    assert result.supports["b"].moment[-1] == pytest.approx(reference.supports["b"].moment[-1], rel=2e-3)


@pytest.mark.parametrize("count", [1, 7, 50])
def test_load_control_ends_at_the_limit_point(count):
    """Williams' toggle under 40 lb, its limit at 33.87: UNREACHABLE there, not the far side of the snap."""
    section = tsm.Section(EA=1.885e6, GA=1.885e10, EI=9274.0)
    apex = (12.94328, 0.386)
    toggle = tsm.Structure(
        beams=(
            tsm.Beam(name="left", start=(0.0, 0.0), end=apex, section=section, elements=8),
            tsm.Beam(name="right", start=apex, end=(25.88656, 0.0), section=section, elements=8),
        ),
        supports=(tsm.Support(beam="left", end="start"), tsm.Support(beam="right", end="end")),
        loads=(tsm.Load(beam="left", end="end", force=(0.0, -40.0)),),
    )
    result = tsm.solve(toggle, np.arange(1, count + 1) / count, throw=False)
    assert result.status is Status.UNREACHABLE
    stopped = float(result.message.split("stopped at load parameter ")[1].split(",")[0])
    assert 40 * stopped == pytest.approx(33.87, rel=2e-3)


@pytest.mark.parametrize("element", ["mixed", "exact"])
def test_forces_change_at_the_rate_of_the_tangent(element):
    """Under a load and a pin that rises along a slant: against differences of equilibria on both sides."""
    problem = tsm.Structure(
        beams=(tsm.Beam(name="b", start=(0, 0), end=(1, 0), section=SECTION, elements=2, element=element),),
        supports=(tsm.Support(beam="b", end="start"),),
        pins=(tsm.Pin(name="p", path=((0.8, 0.0), (0.7, 0.4))),),
        contacts=(tsm.ContactPair(node="p", beam="b"),),
        loads=(tsm.Load(beam="b", end="end", force=(0.5, -1.0)),),
    )
    dt = 1e-4
    times = np.array([0.6 - dt, 0.6, 0.6 + dt])
    result = tsm.solve(problem, times, tsm.Settings(tolerance=1e-13))
    newton = Newton(result.model, tsm.Settings())
    before, at, after = (PathGuard(newton, e.state) for e in result.equilibria)
    slope = (after.force - before.force) / (2 * dt)
    assert np.abs(slope).max() > 1
    assert at.force_rate == pytest.approx(slope, abs=1e-4 * np.abs(slope).max())
    moved = (after.state.q - before.state.q) / (2 * dt)
    assert at.q_rate == pytest.approx(moved, abs=1e-4 * np.abs(moved).max())


@pytest.mark.parametrize("value", [np.inf, np.nan])
def test_a_tangent_without_finite_rates_is_not_followed(value, monkeypatch):
    """Stiffnesses a hundred decades apart: the factors are finite, the rates are not."""
    result = tsm.solve(pushed_in(5), [0.1])
    newton, state = Newton(result.model, tsm.Settings()), result.equilibria[-1].state
    solve = newton.assembler.solve

    def overflowing(system, right):
        solved = solve(system, right)
        solved.x[0, 1] = value
        return solved

    monkeypatch.setattr(newton.assembler, "solve", overflowing)
    guard = PathGuard(newton, state)
    assert guard.rates is None
    assert guard.speed == np.inf
    assert guard.reach(0.3) == 0.3
    assert np.isfinite(guard.predicted(0.2).q).all()

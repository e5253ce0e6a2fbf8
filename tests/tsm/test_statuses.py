"""Silent success is impossible: forced failures end in named statuses, with what was reached."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

import tsm
from tests.tsm.structures import CLAMP, SECTION, TENTHS, cantilever, raised, steps

# no structure reaches these statuses: a part of the solver is replaced by one that fails
from tsm.contact.contact_set import initial_state
from tsm.contact.events import EventKind
from tsm.model.model import Model
from tsm.model.state import Touch
from tsm.path.follow import Follower
from tsm.path.friction import with_grips
from tsm.path.margins import Margin
from tsm.statement.status import Status
from tsm.system.newton import Newton

WAY = raised(0.83, 0.2)
SETTINGS = tsm.Settings()


def sliding(element):
    """A clamp that slides along y and a load along -y: a pin carries both until the beam slips off it, at a third of its way."""
    load = tsm.Load(beam="b", end="end", force=(0.0, -0.1))
    return cantilever(
        ((0.9, 0.0), (1.2, 0.0)), element=element, elements=2, supports=(replace(CLAMP, uy=None),), load=load
    )


def into_a_round_pin():
    """A load lifts the tip from under a round pin, which slips off; the beam would rest within the pin."""
    load = tsm.Load(beam="b", end="end", force=(0.0, 6.0))
    section = tsm.Section(EA=1e4, GA=4e3, EI=1.0)
    path = ((0.8, 0.3), (1.4, 0.3))
    return cantilever(path, section=section, element="exact", side="left", offset=0.3, load=load)


JAMMING = cantilever(
    ((0.681, -0.019), (0.291, 0.559), (0.735, 0.173)),
    section=tsm.Section(EA=3e5, GA=1e5, EI=1.0), element="exact", friction=1.086,
)  # fmt: skip
# the place of the node is a binary number, so that no processor's rounding moves the contact off it
STUCK = cantilever(raised(0.5, 0.2), element="timoshenko", elements=4)
CASES = {  # structure, how many load parameters are reached, what the message says
    "cutback floor": (STUCK, 0, "the contact lies on a node, where elements \"timoshenko\" are rigid: try 5 elements"),
    # stiffnesses whose products overflow
    "not finite": (cantilever(WAY, section=tsm.Section(EA=1e308, GA=1e308, EI=1e308)), 0, ""),
    "lost contact": (cantilever(((0.83, 0.0), (0.83, 0.1), (0.83, -0.2)), keep=True), None, ""),
    "slipped off": (cantilever(raised(0.83, 1.0), keep=True), 5, ""),
    # the pin slides along the axis to the clamp and beyond it
    "folded": (cantilever(((0.5, 0.0), (-0.5, 0.0))), None, ""),
    "falling": (sliding("mixed"), 3, ""),
    "end contact": (into_a_round_pin(), 3, "p0 meets the end of b at load parameter 0.333"),
    "two contacts": (cantilever(WAY, raised(0.86, 0.2), element="timoshenko"), None, ""),
    # one of two pins with friction leaves the beam over its end; it falls onto the other one
    "rest unknown": (cantilever(raised(0.83, 1.0), raised(0.4, 0.35), element="exact", friction=0.3), None, ""),
    # the stick is released at the edge of the cone, where the forces of the slip would push the pin the other way;
    # `comparisons.exact.rod_under_pin` jams at 0.69395389
    "jammed": (JAMMING, 6, "stopped at load parameter 0.69395"),
    # beyond a polar angle of 99.57 degrees no equilibrium of the elastica under a pin is connected with the straight one
    "limit point": (
        cantilever(((1.0, 0.0), (-1.0, 2.0)), section=tsm.Section(EA=1e5, GA=1e5, EI=1.0), length=9.0, elements=45), 6, "",
    ),
}  # fmt: skip


@pytest.mark.slow_at("falling")
@pytest.mark.parametrize("name", CASES)
def test_a_failure_has_its_name_and_keeps_what_was_reached(name):
    problem, reached, said = CASES[name]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        result = tsm.solve(problem, TENTHS, throw=False)
    assert result.status is Status[name.upper().replace(" ", "_")], result.message
    assert len(next(iter(result.contacts.values())).force) == len(result.load_parameter) < 10
    assert reached in (None, len(result.load_parameter))
    assert said in result.message
    if name == "limit point":
        x, y = problem.pins[0].position(
            float(result.message.split("stopped at load parameter ")[1].split(",")[0])
        )
        assert np.degrees(np.arctan2(y, x)) == pytest.approx(99.57, abs=0.05)
    if name == "falling":
        assert result.contacts["p0->b"].force == pytest.approx(0.1 * result.load_parameter, rel=1e-4)


def test_a_failure_is_an_error_unless_it_is_asked_for():
    with pytest.raises(tsm.SolveError, match="CUTBACK_FLOOR") as caught:
        tsm.solve(STUCK, TENTHS)
    assert caught.value.result.status is Status.CUTBACK_FLOOR


def test_step_limit(monkeypatch):
    """The first step is too long for one iteration."""
    monkeypatch.setattr("tsm.path.follow._MOST_ATTEMPTS", 1)
    monkeypatch.setattr("tsm.system.newton.MAX_ITERATIONS", 1)
    result = tsm.solve(cantilever(WAY), TENTHS, throw=False)
    assert (result.status, len(result.load_parameter)) == (Status.STEP_LIMIT, 0)


@pytest.mark.parametrize(
    ("path", "turn", "element"),
    [(((0.0, -0.1), (0.0, 0.1)), 0.0, "mixed"), (((0.0, 0.0), (0.3, 0.1)), None, "exact")],
)
def test_a_contact_that_begins_on_a_held_end(path, turn, element):
    """The support takes any force there: the step length does not decide how this is named."""
    held = replace(CLAMP, rotation=turn), tsm.Support(beam="b", end="end", ux=None)
    for times in (TENTHS, TENTHS[9:]):
        assert (
            tsm.solve(cantilever(path, element=element, supports=held), times, throw=False).status
            is Status.FOLDED
        )


def test_two_slips(monkeypatch):
    """The check by rates is replaced by one that admits both slips."""

    def slipping(point, *given):
        return point.with_state(with_grips(point.state, given[-1])) if given[-1][0].slip else None

    monkeypatch.setattr("tsm.path.friction._going_on", slipping)
    assert tsm.solve(cantilever(WAY, friction=0.3), TENTHS, throw=False).status is Status.TWO_SLIPS


def test_inaccurate(monkeypatch):
    """Two turns ask for more Gauss nodes than are allowed."""
    monkeypatch.setattr("tsm.model.groups.exact.MOST_NODES", 14)
    load = tsm.Load(beam="b", end="end", moment=4 * np.pi * SECTION.EI)
    result = tsm.solve(cantilever(element="exact", load=load), steps(16), throw=False)
    assert result.integration_error <= 1e-9
    assert result.status is Status.INACCURATE


def test_nan_in_a_start_state():
    model = Model(cantilever(WAY))
    state = replace(initial_state(model), q=np.full(model.dof_count, np.nan))
    assert Newton(model, SETTINGS).solve(state).status is Status.NOT_FINITE


def test_iteration_limit(monkeypatch):
    """Newton's method alone; a march tries a shorter step."""
    model = Model(cantilever(WAY))
    moved = replace(initial_state(model), load_parameter=0.5)
    monkeypatch.setattr("tsm.system.newton.MAX_ITERATIONS", 1)
    assert Newton(model, SETTINGS).solve(moved).status is Status.ITERATION_LIMIT


def test_ping_pong(monkeypatch):
    """A search of the owner that always answers with the other of two elements."""
    monkeypatch.setattr(
        "tsm.model.contact.chord_owner",
        lambda *a: Touch(element=15 - a[-1].element, xi=0.5, force=a[-1].force),
    )
    model = Model(cantilever(WAY, element="timoshenko"))
    moved = replace(initial_state(model), load_parameter=0.5)
    assert Newton(model, SETTINGS).solve(moved).status is Status.PING_PONG


@pytest.mark.parametrize("allowed", [1, 5])
def test_chatter(allowed, monkeypatch):
    """A margin that opens whatever closes: so many events are allowed at one load parameter, not one more."""
    monkeypatch.setattr("tsm.path.follow._MOST_CHANGES", allowed)
    follower = Follower(Model(cantilever(WAY)), tsm.Settings())
    held = follower._measure

    def broken(point):
        kind = EventKind.TOUCH if point.state.touches[0] is None else EventKind.RELEASE
        value = -1.0 if point.t > 0 else 0.0
        return [Margin(m.kind, 0, value if m.kind is kind else 1.0) for m in held(point)]

    follower._measure = broken
    follower.margins = broken(follower.track.last)
    taken = list(follower.march(TENTHS))
    assert taken[-1].status is Status.CHATTER
    stopped = taken[-1].equilibrium.state.load_parameter
    assert sum(event.load_parameter == stopped for step in taken for event in step.events) == allowed

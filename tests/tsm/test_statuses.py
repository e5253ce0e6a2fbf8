"""Silent success is impossible: forced failures end in named statuses, with what was reached."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

import tsm
import tsm.friction
from tests.tsm.friction_scenes import Cantilever
from tsm.contact_set import initial_state
from tsm.model import Model
from tsm.newton import Newton
from tsm.settings import Settings
from tsm.state import Touch
from tsm.status import Status
from tsm.stepping import Stepper

SECTION = tsm.Section(EA=100.0, GA=40.0, EI=1.0)
BEAM = tsm.Beam(name="b", start=(0.0, 0.0), end=(1.0, 0.0), section=SECTION, elements=10)
CLAMP = tsm.Support(beam="b", end="start")
TENTHS = np.arange(1, 11) / 10


def structure(
    path=((0.83, 0.0), (0.83, 0.2)), *, element="mixed", keep=False, clamps=(CLAMP,), more=(), friction=0.0
):
    pins = (
        tsm.Pin(name="p", path=path),
        *(tsm.Pin(name=f"q{k}", path=extra) for k, extra in enumerate(more)),
    )
    return tsm.Structure(
        beams=(replace(BEAM, element=element),),
        supports=clamps,
        pins=pins,
        contacts=tuple(
            tsm.ContactPair(node=pin.name, beam="b", keep=keep, friction=friction) for pin in pins
        ),
    )


def ends_in(status, problem, t=TENTHS, **settings):
    result = tsm.solve(problem, t, tsm.Settings(**settings), throw=False)
    assert result.status is status, result.message
    with pytest.raises(tsm.SolveError, match=status.name) as caught:
        tsm.solve(problem, t, tsm.Settings(**settings))
    assert caught.value.result.status is status
    assert len(result.load_parameter) < len(t)
    assert len(result.contacts["p->b"].force) == len(result.load_parameter)
    return result


def test_not_finite():
    """Stiffnesses whose products overflow."""
    huge = tsm.Section(EA=1e308, GA=1e308, EI=1e308)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        ends_in(Status.NOT_FINITE, replace(structure(), beams=(replace(BEAM, section=huge),)))


def test_nan_in_a_start_state():
    model = Model(structure())
    state = replace(initial_state(model), q=np.full(model.dof_count, np.nan))
    assert (
        Newton(model, Settings(tolerance=1e-10, max_iterations=10)).solve(state).status is Status.NOT_FINITE
    )


def test_iteration_limit():
    ends_in(Status.ITERATION_LIMIT, structure(), max_iterations=1, smallest_step=0.9)


def test_cutback_floor():
    ends_in(Status.CUTBACK_FLOOR, structure(), max_iterations=1, smallest_step=0.01)


def test_step_limit():
    """The first step is too long for one iteration."""
    ends_in(Status.STEP_LIMIT, structure(), max_iterations=1, max_attempts=1)


def test_a_beam_that_nothing_holds_is_a_mechanism():
    """It is pushed at its end."""
    free = tsm.Structure(
        beams=(BEAM,), pins=structure().pins, contacts=(tsm.ContactPair(node="p", beam="b"),),
        loads=(tsm.Load(beam="b", end="end", force=(1.0, 0.0)),),
    )  # fmt: skip
    assert tsm.solve(free, TENTHS, throw=False).status is Status.MECHANISM


def test_lost_contact():
    ends_in(Status.LOST_CONTACT, structure(((0.83, 0.0), (0.83, 0.1), (0.83, -0.2)), keep=True))


def test_slipped_off():
    result = ends_in(Status.SLIPPED_OFF, structure(((0.83, 0.0), (0.83, 1.0)), keep=True))
    assert result.load_parameter[-1] > 0.4


def test_folded():
    """The pin slides along the axis to the clamp and beyond it."""
    ends_in(Status.FOLDED, structure(((0.5, 0.0), (-0.5, 0.0))))


@pytest.mark.parametrize(
    "path", [((0.0, -0.1), (0.0, 0.1)), ((0.0, 0.0), (0.3, 0.1)), ((0.0, 0.0), (0.0, 0.1))]
)
@pytest.mark.parametrize("turn", [0.0, None])
@pytest.mark.parametrize("element", ["mixed", "exact"])
def test_a_contact_that_begins_on_a_held_end(path, turn, element):
    """The support takes any force there: the step length does not decide how this is named."""
    held = tsm.Support(beam="b", end="start", rotation=turn), tsm.Support(beam="b", end="end", ux=None)
    beam = replace(BEAM, element=element, elements=1 if element == "exact" else 10)
    begun = replace(structure(path, element=element, clamps=held), beams=(beam,))
    begun = replace(begun, contacts=(tsm.ContactPair(node="p", beam="b", side="right"),))
    for times in (TENTHS, TENTHS[9:]):
        assert tsm.solve(begun, times, throw=False).status is Status.FOLDED


def test_a_pin_pulled_over_the_clamp_is_never_reported_as_done():
    for count in (10, 30, 100):
        t = np.arange(1, count + 1) / count
        result = tsm.solve(structure(((0.5, 0.0), (0.5, 0.01), (-0.5, 0.01))), t, throw=False)
        assert result.status is not Status.COMPLETED


def test_unreachable():
    """Beyond a polar angle of 99.57 degrees no equilibrium of the elastica under a pin is connected with the straight one."""
    stiff = tsm.Section(EA=1e5, GA=1e5, EI=1.0)
    long = tsm.Beam(name="b", start=(0.0, 0.0), end=(9.0, 0.0), section=stiff, elements=45)
    pin = tsm.Pin(name="p", path=((1.0, 0.0), (-1.0, 2.0)))
    problem = tsm.Structure(
        beams=(long,), supports=(CLAMP,), pins=(pin,), contacts=(tsm.ContactPair(node="p", beam="b"),)
    )
    result = tsm.solve(problem, np.arange(1, 41) / 40, throw=False)
    assert result.status is Status.LIMIT_POINT
    x, y = pin.position(float(result.message.split("stopped at load parameter ")[1].split(",")[0]))
    assert np.degrees(np.arctan2(y, x)) == pytest.approx(99.57, abs=0.05)


@pytest.mark.parametrize("element", ["mixed", pytest.param("exact", marks=pytest.mark.slow)])
def test_falling(element):
    """A clamp that slides along y and a load along -y: a pin carries both until the beam slips off it, at a third of its way."""
    slider = replace(
        structure(((0.9, 0.0), (1.2, 0.0)), clamps=(replace(CLAMP, uy=None),)),
        beams=(replace(BEAM, element=element, elements=2),),
        loads=(tsm.Load(beam="b", end="end", force=(0.0, -0.1)),),
    )
    result = ends_in(Status.FALLING, slider)
    assert len(result.load_parameter) == 3
    np.testing.assert_allclose(result.contacts["p->b"].force, 0.1 * result.load_parameter, rtol=1e-4)


def test_a_fall_into_a_round_pin():
    """A load lifts the tip from under a round pin, which slips off; the beam would rest within the pin."""
    section = tsm.Section(EA=1e4, GA=4e3, EI=1.0)
    pushed = tsm.Structure(
        beams=(replace(BEAM, section=section, element="exact", elements=1),),
        supports=(CLAMP,),
        pins=(tsm.Pin(name="p", path=((0.8, 0.3), (1.4, 0.3))),),
        contacts=(tsm.ContactPair(node="p", beam="b", side="left", offset=0.3),),
        loads=(tsm.Load(beam="b", end="end", force=(0.0, 6.0)),),
    )
    result = ends_in(Status.END_CONTACT, pushed)
    assert len(result.load_parameter) == 3
    assert "p meets the end of b at load parameter 0.333" in result.message


def test_two_contacts_on_an_element_of_the_paper():
    near = ((0.86, 0.0), (0.86, 0.2))
    ends_in(Status.TWO_CONTACTS, structure(element="timoshenko", more=(near,)))
    both = tsm.solve(structure(more=(near,)), TENTHS)
    assert both.status is Status.COMPLETED


def test_ping_pong():
    """A start that throws the contact to and fro between two elements of the paper's."""
    model = Model(structure(element="timoshenko"))
    newton = Newton(model, Settings(tolerance=1e-10, max_iterations=12))

    class Swing:
        """Owner search that always answers with the other element."""

        def __call__(self, _model, _pair, _state, touch):
            return Touch(element=8 if touch.element == 7 else 7, xi=0.5, force=touch.force)

    from tsm import newton as module

    held, module.chord_owner = module.chord_owner, Swing()
    try:
        moved = replace(initial_state(model), load_parameter=0.5)
        assert newton.solve(moved).status is Status.PING_PONG
    finally:
        module.chord_owner = held


@pytest.mark.parametrize("allowed", [1, 2, 5])
def test_chatter(allowed):
    """A margin that opens whatever closes: so many events are allowed at one load parameter, not one more."""
    stepper = Stepper(Model(structure()), tsm.Settings(max_chatter=allowed))
    from tsm.events import EventKind, Margin

    held = stepper._measure

    def broken(equilibrium):
        kind = EventKind.TOUCH if equilibrium.state.touches[0] is None else EventKind.RELEASE
        value = -1.0 if equilibrium.state.load_parameter > 0 else 0.0
        return [
            Margin(kind=m.kind, pair=0, value=value if m.kind is kind else 1.0) for m in held(equilibrium)
        ]

    stepper._measure = broken
    stepper.margins = broken(stepper.accepted)
    steps = list(stepper.march(TENTHS))
    assert steps[-1].status is Status.CHATTER
    stopped = steps[-1].equilibrium.state.load_parameter
    events = [event for step in steps for event in step.events]
    assert sum(event.load_parameter == stopped for event in events) == allowed


def test_unbalanced():
    stepper = Stepper(Model(structure()), tsm.Settings())
    solve = stepper.newton.solve

    def leaking(*arguments):
        found = solve(*arguments)
        return replace(found, system=replace(found.system, nodal=1.001 * found.system.nodal))

    stepper.newton.solve = leaking
    assert list(stepper.march(TENTHS))[-1].status is Status.UNBALANCED


@pytest.mark.parametrize("element", [pytest.param("mixed", marks=pytest.mark.slow), "exact"])
def test_jammed(element):
    """The stick is released at the edge of the cone, where the forces of the slip would push the pin the other way."""
    path = ((0.681, -0.019), (0.291, 0.559), (0.735, 0.173))
    section = tsm.Section(EA=3e5, GA=1e5, EI=1.0)
    stiff = replace(BEAM, section=section, element=element)
    result = ends_in(Status.JAMMED, replace(structure(path, friction=1.086), beams=(stiff,)))
    exact, _ = Cantilever(section=section, friction=1.086, path=path).exact(10)
    stopped = float(result.message.split("stopped at load parameter ")[1].split(",")[0])
    assert stopped == pytest.approx(exact.events[-1].load_parameter, abs=1e-4)


@pytest.mark.slow_at("mixed")
@pytest.mark.parametrize("element", ["mixed", "exact"])
def test_rest_unknown(element):
    """One of two pins with friction leaves the beam over its end; it falls onto the other one."""
    other = ((0.4, 0.0), (0.4, 0.35))
    problem = structure(((0.83, 0.0), (0.83, 1.0)), element=element, more=(other,), friction=0.3)
    result = ends_in(Status.REST_UNKNOWN, problem)
    assert result.events[-1].kind.value == "slip-off"


def test_two_slips(monkeypatch):
    """The check by rates is replaced by one that admits both slips."""
    monkeypatch.setattr(
        tsm.friction, "_admissible", lambda _newton, state, *_: state.touches[0].grip.slip != 0
    )
    ends_in(Status.TWO_SLIPS, structure(friction=0.3))


def test_contact_changed_under_arc_length():
    slips = replace(structure(((0.83, 0.0), (0.83, 1.0))))
    assert tsm.trace(slips, arc_length=0.3, steps=60, throw=False).status is Status.CONTACT_CHANGED


def test_every_status_has_its_sentence():
    assert len({status.value for status in Status}) == len(Status)
    assert all(status.value[0].islower() or status.value[0] == "N" for status in Status)
    assert all(not status.value.endswith(".") for status in Status)

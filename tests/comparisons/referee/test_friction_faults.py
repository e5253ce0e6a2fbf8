"""Forged answers with friction: every kind of fault is refused for its reason."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from comparisons.referee import Verdict, answer_state, certify, equilibrium
from comparisons.referee.friction import Grip
from comparisons.referee.history import History
from comparisons.response import ContactHistory, FrictionHistory, Response
from tests.comparisons.referee.forged import stated
from tests.comparisons.referee.test_friction import PAIR, answer, rough


def contact(response: Response, **changes: object) -> Response:
    history: ContactHistory = replace(response.contacts[PAIR], **changes)  # type: ignore[arg-type]
    return replace(response, contacts={PAIR: history})


def friction_of(response: Response) -> FrictionHistory:
    friction = response.contacts[PAIR].friction
    assert friction is not None
    return friction


def rubbed(response: Response, **changes: object) -> Response:
    return contact(response, friction=replace(friction_of(response), **changes))  # type: ignore[arg-type]


FAULTY = rough("ks-cantilever", 0.3, 20)


def other_friction(response: Response) -> Response:
    """The answer to a scene whose coefficient is one per cent larger."""
    del response
    return answer(rough("ks-cantilever", 0.303, 20))


def reversed_slip(response: Response) -> Response:
    return rubbed(response, slip=-friction_of(response).slip)


def reversed_drag(response: Response) -> Response:
    """Forces that drag the beam against the slip, without a change of the record of friction's sign."""
    friction = friction_of(response)
    return rubbed(response, tangential=-friction.tangential)


def held_elsewhere(response: Response) -> Response:
    """Exact equilibria that stick .001 beside the place where the slip ended, stated with their own numbers."""
    history = History(response, FAULTY)
    path = []
    for k in range(len(response.load_parameter)):
        grip = history.grips(k)[PAIR]
        if grip.hold is not None:
            grip = replace(grip, hold=replace(grip.hold, arc_position=grip.hold.arc_position + 1e-3))
        path.append(equilibrium(FAULTY, replace(answer_state(response, FAULTY, k), grips={PAIR: grip})))
    forged = stated(FAULTY, path)
    own = [item.contacts[PAIR] for item in path]
    friction = replace(
        friction_of(response),
        tangential=np.array([item.drag for item in own]),
        normal=np.array([item.push for item in own]),
    )
    return replace(contact(forged, friction=friction), events=response.events, work=response.work)


def stuck_outside(response: Response) -> Response:
    """A slip that is stated as stick, with the force outside the cone."""
    friction = friction_of(response)
    lean = np.arctan2(friction.tangential, friction.normal) * 1.05
    force = response.contacts[PAIR].force
    changes = {"tangential": force * np.sin(lean), "normal": force * np.cos(lean)}
    return rubbed(response, slip=np.zeros_like(friction.slip), **changes)


def frictionless(response: Response) -> Response:
    """The answer to the scene without friction, with all that a program without friction states."""
    del response
    return answer(rough("ks-cantilever", 0.0, 20))


def frictionless_stuck(response: Response) -> Response:
    """The same, called stick: its force is inside the cone."""
    smooth = frictionless(response)
    nothing = np.zeros(len(smooth.load_parameter))
    friction = FrictionHistory(
        tangential=nothing,
        normal=smooth.contacts[PAIR].force,
        slip=nothing.astype(np.int64),
        dissipated=nothing,
    )
    return contact(smooth, friction=friction)


def wrong_side(response: Response) -> Response:
    """The cone about the normal on the other side."""
    return rubbed(response, normal=-friction_of(response).normal)


def falling(response: Response) -> Response:
    spent = friction_of(response).dissipated.copy()
    spent[-1] = 0.9 * spent[-2]
    return rubbed(response, dissipated=spent)


FAULTS: dict[str, tuple[Callable[[Response], Response], Verdict, str]] = {
    "coefficient": (other_friction, Verdict.INADMISSIBLE, "slips with F_t"),
    "slip reversed": (reversed_slip, Verdict.INADMISSIBLE, "slips with F_t"),
    "drag reversed": (reversed_drag, Verdict.INADMISSIBLE, "slips with F_t"),
    "held elsewhere": (held_elsewhere, Verdict.INADMISSIBLE, "sticks and moves by 0.001 L"),
    "held elsewhere from the event on": (
        lambda r: replace(
            held_elsewhere(r),
            events=tuple(replace(e, arc_position=e.arc_position + 1e-3) if e.kind == "stick" else e for e in r.events or ()),
        ),
        Verdict.NOT_AN_EQUILIBRIUM, "force off by 10 %",
    ),
    "stick outside the cone": (stuck_outside, Verdict.INADMISSIBLE, "outside its cone"),
    "frictionless": (frictionless, Verdict.NOT_AN_EQUILIBRIUM, "off by"),
    "frictionless, stuck": (frictionless_stuck, Verdict.INADMISSIBLE, "sticks"),
    "wrong side": (wrong_side, Verdict.INADMISSIBLE, "slips with F_t"),
    "dissipation falls": (falling, Verdict.INADMISSIBLE, "the dissipation of pin->cantilever falls"),
    "work": (lambda r: replace(r, work=1.01 * r.work), Verdict.INADMISSIBLE, "the work is not strain energy and dissipation"),
    "dissipation": (
        lambda r: rubbed(replace(r, work=r.work + 0.01 * r.work), dissipated=friction_of(r).dissipated + 0.01 * r.work),
        Verdict.INADMISSIBLE, "the dissipation of pin->cantilever up to load parameter",
    ),
    "stick is not stated": (
        lambda r: replace(r, events=tuple(event for event in r.events or () if event.kind != "stick")),
        Verdict.INADMISSIBLE, "without an event",
    ),
    "stick is stated too early": (
        lambda r: replace(
            r, events=tuple(replace(e, load_parameter=e.load_parameter - 0.015) if e.kind == "stick" else e for e in r.events or ())
        ),
        Verdict.INADMISSIBLE, "sticks from load parameter 0.605498, exactly from 0.620498",
    ),
    "stick is stated elsewhere": (
        lambda r: replace(
            r, events=tuple(replace(e, load_parameter=e.load_parameter - 0.1) if e.kind == "stick" else e for e in r.events or ())
        ),
        Verdict.INADMISSIBLE, "slips after an event of kind stick",
    ),
}  # fmt: skip


@pytest.mark.slow_at(
    "some-coefficient", "some-held elsewhere from the event on", "some-stick outside the cone"
)
@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("every", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["some", "all"])
def test_seeded_faults_are_refused(fault: str, every: bool) -> None:
    spoil, verdict, reason = FAULTS[fault]
    spoilt = spoil(answer(FAULTY))
    at = range(len(spoilt.load_parameter)) if every else None
    found = certify(spoilt, FAULTY, at=at, allowance=1e-2)
    assert found.verdict is verdict, found.line()
    assert any(
        reason in words for words in (found.reason, *found.path, *(item.reason for item in found.judged))
    ), found.line()


def test_a_slip_against_the_pin_is_refused() -> None:
    """The exact equilibrium with the force leaning the wrong way obeys every equation but the sign of its slip rate."""
    response = answer(FAULTY)
    history, path = History(response, FAULTY), []
    for k in range(len(response.load_parameter)):
        grips = {PAIR: Grip(friction=0.3, slip=1)} if k == 5 else history.grips(k)
        path.append(equilibrium(FAULTY, replace(answer_state(response, FAULTY, k), grips=grips)))
    own = [item.contacts[PAIR] for item in path]
    slip = np.array(friction_of(response).slip)
    slip[5] = 1
    friction = replace(
        friction_of(response),
        tangential=np.array([item.drag for item in own]),
        normal=np.array([item.push for item in own]),
        slip=slip,
    )
    forged = contact(stated(FAULTY, path), friction=friction)
    found = certify(forged, FAULTY, at=[5])
    assert found.verdict is Verdict.INADMISSIBLE, found.line()
    assert "slips against the stated direction" in found.judged[0].reason

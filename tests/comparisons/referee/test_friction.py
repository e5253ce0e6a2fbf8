"""Contacts with Coulomb friction: true answers are certified, with and without what they state of slip and stick, and equilibria of another history are not."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from comparisons.answer import Response
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.referee import Certificate, Equilibrium, Verdict, answer_state, certify, equilibrium
from comparisons.referee.friction import History, dissipated
from comparisons.scene import ContactSpec, PinSpec, Scene, load_scene
from tests.comparisons.referee.forged import contact, scene_of, stated

PAIR = "pin->cantilever"


def rough(name: str, friction: float = 0.3, load_parameters: int = 20) -> Scene:
    """A built-in scene with the same friction at all contacts."""
    scene = load_scene(name)
    contacts = tuple(replace(spec, friction=friction) for spec in scene.contacts)
    return replace(scene, load_parameters=load_parameters, contacts=contacts)


@cache
def answer(scene: Scene) -> Response:
    return solve(scene, "tsm", Options(element="exact"))


def all_along(scene: Scene, response: Response) -> Certificate:
    return certify(response, scene, at=range(len(response.load_parameter)))


def as_it_is(response: Response) -> Response:
    return response


def without_events(response: Response) -> Response:
    return replace(response, events=None)


def forces_alone(response: Response) -> Response:
    return replace(contact(response, friction=None), events=None, work=None)


@pytest.mark.slow_at("ks-face-0.5-without_events", "ks-cantilever-0.1-as_it_is")
@pytest.mark.parametrize(
    ("name", "friction", "leave"),
    [
        ("ks-cantilever", 0.1, as_it_is),
        ("ks-face", 0.5, without_events),
        ("ks-cantilever", 0.3, forces_alone),
    ],
)
def test_exact_elements_are_certified_to_round_off_all_along(name, friction, leave):
    """The referee finds itself what they do not state."""
    scene = rough(name, friction)
    response = answer(scene)
    found = all_along(scene, leave(response))
    assert found.certified, found.line()
    assert "stability not judged (friction)" in found.line()
    said = f"friction of {PAIR} taken from the direction of its force" in found.line()
    assert said == (leave is forces_alone)
    assert found.judged[-1].index == -1
    assert max(item.distance.largest[1] for item in found.judged if item.distance) < 1e-11
    assert max(item.residual for item in found.judged) < 1e-12
    assert set(response.contacts[PAIR].friction.slip) == {-1, 0, 1}


@pytest.mark.slow
def test_the_solid_is_certified_all_along():
    """With its events, and without them, so that the referee finds slip and stick itself."""
    scene = rough("ks-cantilever")
    response = solve(scene, "solid", Options(mesh=(50, 2)))
    assert [event.kind for event in response.events] == ["touch", "stick", "slip"]
    assert all_along(scene, response).certified
    found = all_along(scene, without_events(response))
    assert found.certified, found.line()
    assert 1e-3 < max(item.distance.sizes["force"] for item in found.judged if item.distance) < 6e-3


@pytest.mark.slow
def test_the_dissipation_is_that_of_the_exact_elements():
    """Two quadratures of different programs."""
    scene = rough("ks-cantilever")
    response = answer(scene)
    found, history = all_along(scene, response), History(response, scene)
    own = np.cumsum([dissipated(history, k, item.exact)[PAIR] for k, item in enumerate(found.judged)])
    np.testing.assert_allclose(own, response.contacts[PAIR].friction.dissipated, rtol=1e-11)


def elsewhere(k: int, grip: Any) -> Any:
    """Sticks .001 beside the place where the slip ended."""
    hold = grip.hold
    return grip if hold is None else replace(grip, hold=replace(hold, arc_position=hold.arc_position + 1e-3))


def against(k: int, grip: Any) -> Any:
    """Slips against the pin at load parameter number 2."""
    return replace(grip, slip=1, hold=None) if k == 2 else grip


def of_another_history(response: Response, scene: Scene, other: Callable[[int, Any], Any]) -> Response:
    """Exact equilibria that another friction holds, stated with their own numbers."""
    history, path = History(response, scene), list[Equilibrium]()
    for k in range(len(response.load_parameter)):
        grips = {pair: other(k, grip) for pair, grip in history.grips(k).items()}
        path.append(equilibrium(scene, replace(answer_state(response, scene, k), grips=grips)))
    own = [item.contacts[PAIR] for item in path]
    slip = np.array(response.contacts[PAIR].friction.slip)
    slip[2] = 1 if other is against else slip[2]
    friction = replace(
        response.contacts[PAIR].friction,
        tangential=np.array([item.drag for item in own]), normal=np.array([item.push for item in own]), slip=slip,
    )  # fmt: skip
    return replace(
        contact(stated(scene, path), friction=friction), events=response.events, work=response.work
    )


@pytest.mark.slow
def test_equilibria_of_another_history_are_refused():
    """They obey every equation of their own: a stick from another place, and a force that leans the wrong way."""
    scene = rough("ks-cantilever")
    held = of_another_history(answer(scene), scene, elsewhere)
    found = certify(held, scene, allowance=1e-2)
    assert found.verdict is Verdict.INADMISSIBLE, found.line()
    assert any("sticks and moves by 0.001 L" in item.reason for item in found.judged)
    events = tuple(
        replace(e, arc_position=e.arc_position + 1e-3) if e.kind == "stick" else e for e in held.events or ()
    )
    found = certify(replace(held, events=events), scene, allowance=1e-2)
    assert found.verdict is Verdict.NOT_AN_EQUILIBRIUM, found.line()
    assert "force off by 10 %" in found.reason
    # however short the way
    short = replace(scene, pins=(replace(scene.pins[0], displacement=(-1e-3, 6e-4)),))
    for asked in (scene, short):
        forged = of_another_history(answer(asked), asked, against)
        found = certify(replace(forged, events=None), asked, at=[2])
        assert found.verdict is Verdict.INADMISSIBLE, found.line()
        assert "slips against the stated direction" in found.judged[0].reason


@pytest.mark.slow
def test_a_strut_buckles_in_stick_whatever_the_steps():
    """The strut of the crossed beams sticks on the lower beam; on the straight branch its force would be 5130 N instead of 2905 N."""
    for steps in (6, 12, 24):
        scene = rough("crossed-beams", 0.2, steps)
        response = answer(scene)
        assert all_along(scene, response).verdict is Verdict.CERTIFIED
        assert response.contacts["upper.end->lower"].force[-1] == pytest.approx(2904.509, rel=1e-6)


@pytest.mark.slow_at("axis-None-1.0-0.003-8", "face-0.1-20.0-0.003-8")
@pytest.mark.parametrize(
    ("surface", "radius", "friction", "gap", "steps"),
    [("axis", 0.1, 1.0, 0.0, 2), ("axis", None, 1.0, 0.003, 8), ("face", 0.1, 20.0, 0.003, 8)],
)
def test_a_pin_that_sticks_where_it_touches_is_certified(surface, radius, friction, gap, steps):
    """A round pin rolls. With and without events."""
    offset = (0.1 if surface == "face" else 0.0) + (radius or 0.0)
    scene = scene_of(
        "raised", load_parameters=steps,
        pins=(PinSpec(name="p", path=((0.7, -offset - gap), (0.7, 0.01 - offset)), radius=radius),),
        contacts=(ContactSpec(node="p", beam="b", side="right", surface=surface, friction=friction),),
    )  # fmt: skip
    response = answer(scene)
    assert not response.contacts["p->b"].friction.slip[-1]
    for given in (response, without_events(response)):
        found = all_along(scene, given)
        assert found.certified, found.line()
        # where a pin rolls, both integrate its place to 3e-14 L, which EA turns into a force
        rolls = radius is not None and surface == "axis"
        assert max(item.distance.largest[1] for item in found.judged if item.distance) < (
            4e-10 if rolls else 1e-11
        )

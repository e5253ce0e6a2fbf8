"""Spoiled answers: each fault is seen by its quantity, and refused by its check; and what is right or wrong as a whole."""

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from comparisons.answer import Response
from comparisons.answer.errors import errors
from comparisons.answer.quantities import KEPT
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.models.verify import CHECK_FAILED, CHECKS, verified
from comparisons.scene import ContactSpec, PinSpec, Scene, load_scene
from tests.comparisons.referee.forged import contact, deformed, support
from tests.comparisons.referee.test_thresholds import CASES as THRESHOLDS

SCENE = replace(load_scene("ks-cantilever"), load_parameters=5)
PAIR, BEAM, CLAMP = "pin->cantilever", "cantilever", "cantilever.start"
Change = Callable[[Response], Response]


@pytest.fixture(scope="module")
def good() -> Response:
    return solve(SCENE, "rod")


def at(values: np.ndarray, k: int, value: float) -> np.ndarray:
    changed = values.copy()
    changed[k] = value
    return changed


def without_force(response: Response) -> Response:
    """What a program reports that lost the contact on the way: no force, the beam straight, no word about it."""
    arc, none = np.linspace(0.0, 1.0, 11), np.full(5, np.nan)
    lost = contact(response, force=np.zeros(5), arc_position=none, gap=none)
    lost = support(lost, force=np.zeros((5, 2)), moment=np.zeros(5))
    return replace(lost, axis_line=lambda _, __: (arc, np.stack([arc, 0.0 * arc], axis=1)))


def opened(response: Response) -> Response:
    own = response.contacts[PAIR]
    arc, force = at(own.arc_position, 2, np.nan), at(own.force, 2, 0.0)
    return contact(response, arc_position=arc, force=force)


PERSISTENT = replace(SCENE, contacts=(replace(SCENE.contacts[0], keep=True),))
OVER = replace(SCENE, pins=(PinSpec(name="pin", path=((1.0, -0.2), (1.005, -0.005)), radius=0.02),))
BREAKS: dict[str, tuple[Change, str, Scene]] = {
    "load parameters": (lambda r: replace(r, load_parameter=r.load_parameter[:3]), "3 of 5 load parameters reached", SCENE),
    "finite numbers": (lambda r: replace(r, tips={BEAM: at(r.tips[BEAM], 2, np.inf)}), "tip of .* is not finite", SCENE),
    "contacts that persist": (opened, "must persist and is open at load parameter 0.6", PERSISTENT),
    "clear ends": (without_force, "pin overlaps the end of beam cantilever at load parameter 1", OVER),
    "sides of beams": (without_force, "open and its node goes through the beam up to load parameter 0.2", SCENE),
    "balance": (lambda r: support(r, force=-r.supports[CLAMP].force), "support moments do not balance", SCENE),
    "bend of elements": (lambda r: deformed(r, 0.6, turn=2.0), "too few elements: one bends by 2 rad, more than 1 at load parameter 0.6", SCENE),
}  # fmt: skip
"""For each check without a threshold: how an answer is spoiled, what is said then, and the scene."""
BOUNDED = {
    "pushing contacts": "PULL", "closed gaps": "CLOSED", "small penetration": "PENETRATION", "round pins outside": "INSIDE",
    "strain of elements": "STRAIN", "motion of pins": "MOTION",
}  # fmt: skip
"""The others, by their rows in the table of thresholds, where an answer just beyond each is refused."""


def test_every_check_is_tried():
    assert CHECKS.keys() == BREAKS.keys() | BOUNDED.keys()
    assert {f"verify.{name}" for name in BOUNDED.values()} == {
        name for name in THRESHOLDS if "verify" in name
    }


@pytest.mark.parametrize("name", BREAKS)
def test_every_check_refuses_a_spoiled_answer_by_its_sentence_and_no_true_one(name, good):
    change, sentence, scene = BREAKS[name]
    assert scene is OVER or not list(CHECKS[name](good, scene))
    spoiled = change(good)
    assert any(re.search(sentence, said) for said in CHECKS[name](spoiled, scene))
    checked = verified(spoiled, scene)
    assert (checked.status, checked.completed) == (CHECK_FAILED, False)


AROUND = [
    ((1.2, 0.01), (1.2, -0.1), (0.6, -0.1)),
    ((0.5, 0.01), (1.2, 0.0), (0.5, -0.1)),
    ((-0.2, 0.1), (-0.2, -0.1), (0.5, -0.1)),
]
THROUGH = [
    *(((x, 0.01), (x, -0.2)) for x in (0.0, 0.5, 1.0)),
    ((0.3, 0.1), (-0.7, -0.4)),
    ((0.3, 0.01), (-1.2, -0.1496)),
    ((1.2, 0.01), (0.9, 0.01), (0.9, -0.1), (1.2, -0.1)),
]
"""Ways of a pin that belongs above the beam: around an end to below it, whatever the load parameters, and through it, never closed."""


@pytest.mark.parametrize("path", AROUND + THROUGH)
def test_a_pin_may_come_around_an_end_and_not_through_the_beam(good, path):
    spec = ContactSpec(node="pin", beam=BEAM, side="left")
    scene = replace(SCENE, pins=(PinSpec(name="pin", path=path),), contacts=(spec,))
    for load_parameters in (1, 2, 7) if path in AROUND else ():
        response = solve(replace(scene, load_parameters=load_parameters), "tsm")
        assert response.completed, response.message
        assert not response.contacts[PAIR].force.any()
    assert path in AROUND or "through the beam" in verified(without_force(good), scene).message


def test_a_stopped_response_keeps_its_own_reason(good):
    stopped = replace(good, status="CUTBACK_FLOOR", load_parameter=good.load_parameter[:2])
    assert verified(stopped, SCENE) is stopped


@pytest.mark.slow_at("solid-options2-too few elements: one bends by 1.1 rad.*LIMIT_POINT")
@pytest.mark.parametrize(
    ("model", "options", "reason"),
    [
        ("tsm", Options(element="timoshenko", elements=2), "too few elements: one bends by 2.1 rad"),
        ("tsm", Options(element="mixed", elements=1), "too few elements: one bends by .* rad.*LIMIT_POINT"),
        ("solid", Options(mesh=(2, 2)), "too few elements: one bends by 1.1 rad.*LIMIT_POINT"),
    ],
)
def test_elements_that_bend_too_far_are_not_believed(model, options, reason):
    """Forces off by 60 %, 140 % and 100 %, whether the solution completed or stopped."""
    response = solve(replace(SCENE, load_parameters=10), model, options)
    assert response.status == CHECK_FAILED
    assert not response.completed
    assert re.search(reason, response.message)


def test_two_pins_balance_by_the_vectors_of_their_forces():
    scene = load_scene("two-pins")
    response = solve(scene, "tsm")
    for pair, history in response.contacts.items():
        assert np.all(history.force > 0.0)
        np.testing.assert_allclose(np.hypot(*history.vector.T), history.force, rtol=1e-12)
        for vector in (history.vector * (1 + 1e-4), None):
            forged = replace(response, contacts={**response.contacts, pair: replace(history, vector=vector)})
            assert "support reactions" in verified(forged, scene).message


def shifted(good: Response, way: np.ndarray) -> Response:
    def line(beam: str, k: int) -> tuple[np.ndarray, np.ndarray]:
        arc, place = good.axis_line(beam, k)
        return arc, place + way

    return replace(good, axis_line=line)


def changed(good: Response, name: str) -> tuple[Response, float]:
    """A response with a fault that one quantity sees, and its error on a beam twice as long."""
    own, held, way = good.contacts[PAIR], good.supports[CLAMP].moment, np.array([0.03, 0.04])
    return {
        "force": (contact(good, force=own.force + 0.01 * own.force.max()), 0.01),
        "arc": (contact(good, arc_position=own.arc_position - 0.03), 0.015),
        "moment": (support(good, moment=held + 0.01 * np.abs(held).max()), 0.01),
        "friction": (
            replace(good, material_force={BEAM: good.material_force[BEAM] + 0.02 * own.force}),
            0.02,
        ),
        "tip": (replace(good, tips={BEAM: good.tips[BEAM] + way}), 0.025),
        "shape": (shifted(good, way), 0.025),
    }[name]


LONG = replace(SCENE, beams=(replace(SCENE.beams[0], end=(2.0, 0.0)),))


@pytest.mark.parametrize("name", ["force", "arc", "moment", "friction", "tip", "shape"])
def test_every_quantity_sees_its_own_fault(name, good):
    """Relative to the largest of the reference, or to the length; the stress, which rods have not, has the solid's own tests."""
    response, error = changed(good, name)
    found = errors(response, good, LONG)
    assert found["path"].keys() == set(KEPT)
    seen = {"shape", "shape_mean"} if name == "shape" else {name}
    for quantity, value in found["path"].items():
        assert value == pytest.approx(error if quantity in seen else 0.0, abs=1e-9), quantity
    assert found["end"][name] == pytest.approx(error)


def test_errors_of_a_stopped_run_are_unknown_and_of_a_contact_lost_alone_infinite(good):
    stopped = replace(good, load_parameter=good.load_parameter[:2])
    assert np.isnan(errors(stopped, good, SCENE)["path"]["force"])
    lost = replace(contact(good, arc_position=np.full(5, np.nan)), material_force={})
    for own, true in ((lost, good), (good, lost)):
        found = errors(own, true, SCENE)["path"]
        assert found["arc"] == found["friction"] == np.inf

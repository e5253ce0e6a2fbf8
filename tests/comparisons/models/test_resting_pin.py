"""Pins at rest: stops and supports that a beam can leave, in all models."""

import json

import numpy as np
import pytest

from comparisons.models import MODELS, certified, solve
from comparisons.models.options import Options
from comparisons.models.outside.request import request
from comparisons.scene import Scene, SceneError, read_scene

STRIP = """
beam = [{ name = "strip", start = [0, 0], end = [1, 0], clamped = ["start"], width = 0.02, height = 0.01, youngs_modulus = 7e10, poissons_ratio = 0.3 }]
pin = [{ name = "stop", start = [0.7, 0], displacement = [0, 0] }]
contact = [{ node = "stop", beam = "strip", side = "right", friction = FRICTION }]
"""
HEAD = 'scene = { name = "prop", units = "N, m", load_parameters = 2 }\n'
LOAD = 'load = [{ beam = "strip", end = "end", force = [0, -1] }]\n'
MODELS_OF_STOPS = ("tsm", "rod", "solid")


def scene(*more: str, friction: float = 0.0) -> Scene:
    return read_scene(HEAD + STRIP.replace("FRICTION", str(friction)) + "".join(more), "prop")


def options(model: str) -> Options:
    return Options(element="exact") if model == "tsm" else Options()


@pytest.mark.parametrize("model", MODELS_OF_STOPS)
def test_a_propped_cantilever_has_the_reaction_of_statics_and_leaves_its_prop(model: str) -> None:
    """By linear theory the prop at a carries P (3 L - a)/(2 a) of the load at L; the strip is slender and the load small."""
    given = scene(
        LOAD, '[[stage]]\nload_parameters = 2\nload = [{ beam = "strip", end = "end", force = [0, 2] }]\n'
    )
    answer = certified(solve(given, model, options(model)), given)
    verdict = "NOT_JUDGED" if model == "rod" else "CERTIFIED"
    assert (answer.certificate.verdict.name, answer.completed) == (verdict, True)
    force = answer.contacts["stop->strip"].force
    assert force[1] == pytest.approx((3.0 - 0.7) / (2.0 * 0.7), rel=2e-3)
    assert force[3] == 0.0


def test_a_clamp_that_sinks_on_a_pin_at_rest_is_a_pin_that_rises() -> None:
    move = 'support = [{ beam = "strip", end = "start", kind = "clamped", displacement = [0, -0.1] }]\n'
    sinking = read_scene(
        HEAD + move + STRIP.replace("FRICTION", "0.3").replace('clamped = ["start"], ', ""), "prop"
    )
    rising = read_scene(
        HEAD + STRIP.replace("FRICTION", "0.3").replace("displacement = [0, 0]", "displacement = [0, 0.1]"),
        "prop",
    )
    for model in ("tsm", "rod"):
        one, other = (solve(given, model, options(model)) for given in (sinking, rising))
        assert one.completed
        assert other.completed
        np.testing.assert_allclose(
            one.contacts["stop->strip"].force, other.contacts["stop->strip"].force, rtol=1e-13
        )
    assert MODELS["elastica"].refusal(sinking) is not None


def test_a_stick_that_begins_as_a_stage_ends_is_certified_without_an_event() -> None:
    """The exact rods and the solid state no event at the corner, where the slip rate jumps through zero."""
    pressed = LOAD.replace("-1", "-100")
    back = '[[stage]]\nload_parameters = 2\nload = [{ beam = "strip", end = "end", force = [0, 1] }]\n'
    given = scene(pressed, back, friction=0.3)
    for model in ("rod", "solid"):
        answer = certified(solve(given, model, options(model)), given, "all")
        verdict = "NOT_JUDGED" if model == "rod" else "CERTIFIED"
        assert (answer.certificate.verdict.name, answer.completed) == (verdict, True)
        slip = answer.contacts["stop->strip"].friction.slip
        assert slip[1] != 0
        assert slip[2] == 0


def test_a_program_gets_a_path_of_two_points() -> None:
    """Programs pair the points of a path with load parameters: 0, the corners, and 1."""
    given = scene(LOAD)
    (pin,) = json.loads(request(given, Options(), given.times))["pins"]
    assert len(pin["path"]) == len(pin["corners"]) + 2
    assert {tuple(point) for point in (*pin["path"], *pin["positions"])} == {(0.7, 0.0)}


def test_a_pin_at_rest_alone_does_nothing() -> None:
    with pytest.raises(
        SceneError, match=r"pin\[0\]\.displacement = \[0\.0, 0\.0\]: give a load, or a pin or a support"
    ):
        scene()


def test_a_slipping_contact_dissipates_until_it_opens_in_the_solid() -> None:
    """The round stop of a strip slips back and opens between two load parameters, where exact elements state the event."""
    text = """
scene = { name = "stop", units = "N, mm", load_parameters = 10 }
beam = [{ name = "strip", start = [0, 0], end = [100, 0], clamped = ["start"], width = 10, height = 1, youngs_modulus = 2.1e5, poissons_ratio = 0.3 }]
pin = [{ name = "stop", start = [60, -3], displacement = [0, 0], radius = 2 }]
contact = [{ node = "stop", beam = "strip", side = "right", surface = "face", friction = 0.2 }]
load = [{ beam = "strip", end = "end", force = [0, -10] }]
[[stage]]
load_parameters = 10
load = [{ beam = "strip", end = "end", force = [0, 10] }]
"""
    given = read_scene(text, "stop")
    beams, solid = (solve(given, model, options(model)) for model in ("tsm", "solid"))
    assert (beams.events[-1].kind, beams.contacts["stop->strip"].force[-1]) == ("release", 0.0)
    spent = [answer.contacts["stop->strip"].friction.dissipated for answer in (beams, solid)]
    assert spent[0][-1] > spent[0][-2]
    assert np.diff(spent[1])[-1] == pytest.approx(np.diff(spent[0])[-1], rel=0.05)
    assert certified(solid, given).completed

"""Answers to scenes with weight, curvature, taper, hinges, springs and stages: right ones are certified, answers to other scenes are not."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.referee import Verdict, certify
from comparisons.referee.march import tangent
from comparisons.response import Response
from comparisons.scene import HingeSpec, LoadSpec, Scene, SpringSpec, StageSpec, SupportSpec
from tests.comparisons.referee.forged import stated
from tests.comparisons.referee.test_specimens import (
    ALONE,
    INSIDE,
    PART,
    SPRING,
    TIP,
    everything,
    found,
    strip,
    undeformed,
)

TIGHT = 1e-9
"""Allowance of answers that are exact: the stated ones are next to round-off."""
ROLLER = SupportSpec(beam="a", end="end", kind="roller", free="x")


def scene(**given: object) -> Scene:
    return Scene(name="specimen", load_parameters=2, **given)


def exactly(scene: Scene) -> Response:
    """The exact answer to a scene, by continuation from the undeformed state."""
    return stated(scene, [found(scene, undeformed(scene, t)) for t in scene.times])


CLAMPED = {"beams": (strip(end=(1.0, 0.0)),), "supports": (ROLLER,), "loads": (PART,)}
HINGED = CLAMPED | {"hinges": (HingeSpec(beam="a", end="start", stiffness=20.0),)}
UP, ALONG = LoadSpec(beam="a", end="end", force=(0.0, 5.0)), LoadSpec(beam="a", end="end", force=(-5.0, 1.0))
STAGED = {"beams": (strip(),), "loads": (UP,), "stages": (StageSpec(load_parameters=2, load=(ALONG,)),)}
RIGHT = {
    **{key: scene(**given) for key, given in ALONE.items()},
    "hinge": scene(**HINGED),
    "stage": scene(**STAGED),
}


def heavier(load: LoadSpec) -> LoadSpec:
    x, y = load.force_per_length or (0.0, 0.0)
    return replace(load, force_per_length=(x * (1.0 + 1e-6), y * (1.0 + 1e-6)))


WRONG = {
    "weight": replace(RIGHT["weight"], gravity=(2.0 * (1.0 + 1e-6), -20.0 * (1.0 + 1e-6))),
    "heavy taper": replace(RIGHT["heavy taper"], beams=(strip(density=3.0, height=0.04),)),
    "curvature": scene(beams=(strip(turn=-0.8),), **TIP),
    "taper": scene(beams=(strip(height=0.04, width=0.8),), **TIP),
    "load on a part": replace(RIGHT["load on a part"], loads=(heavier(PART),)),
    "force inside": replace(RIGHT["force inside"], loads=(replace(INSIDE, at=0.8001),)),
    "spring": replace(RIGHT["spring"], springs=(replace(SPRING, stiffness=(1.98, 4.95), rotation=0.396),)),
    "hinge": scene(**CLAMPED),
    "stage": replace(RIGHT["stage"], loads=(ALONG,), stages=(StageSpec(load_parameters=2, load=(UP,)),)),
}


@pytest.mark.parametrize("key", RIGHT)
def test_the_exact_answer_is_certified(key: str) -> None:
    found = certify(exactly(RIGHT[key]), RIGHT[key], allowance=TIGHT)
    assert found.verdict is Verdict.CERTIFIED, found.line()


@pytest.mark.parametrize("key", RIGHT)
def test_the_answer_to_another_scene_is_refused(key: str) -> None:
    found = certify(exactly(WRONG[key]), RIGHT[key], allowance=TIGHT)
    assert found.verdict is Verdict.NOT_AN_EQUILIBRIUM, found.line()


@pytest.mark.parametrize("key", ["curvature", "taper", "heavy taper", "hinge", "stage"])
def test_a_rough_answer_to_another_scene_is_refused_within_the_default_allowance(key: str) -> None:
    found = certify(exactly(WRONG[key]), RIGHT[key])
    assert found.verdict is Verdict.NOT_AN_EQUILIBRIUM, found.line()


def test_a_spring_that_an_answer_leaves_out_breaks_the_balance() -> None:
    """On two springs alone the forces of an answer balance only with the stiffnesses of the scene."""
    springs = tuple(SpringSpec(beam="a", end=end, stiffness=(0.0, 400.0)) for end in ("start", "end"))
    held = (SupportSpec(beam="a", end="start", fixed=("x",)),)
    right = scene(beams=(strip(end=(1.0, 0.0), clamped=()),), springs=springs, supports=held, loads=(INSIDE,))
    soft = replace(right, springs=(springs[0], replace(springs[1], stiffness=(0.0, 396.0))))
    assert certify(exactly(right), right).verdict is Verdict.CERTIFIED
    refused = certify(exactly(soft), right)
    assert refused.verdict is Verdict.NOT_AN_EQUILIBRIUM
    assert "do not balance" in refused.reason


def test_no_key_is_left_out_of_the_balance() -> None:
    """All keys at once with a pin in contact: the stated forces alone balance to 1e-6 with the scene's loads and springs."""
    right = everything()
    rough = {"arcs": {"pin->a": 0.62}, "forces": {"pin->a": (-3.0, 10.0)}}
    answer = stated(right, [found(right, undeformed(right, **rough))])
    assert certify(answer, right, allowance=TIGHT).verdict is Verdict.CERTIFIED
    lighter = replace(right, gravity=(2.0, -20.0 * (1.0 - 1e-3)))
    refused = certify(answer, lighter, allowance=1.0)
    assert refused.verdict is Verdict.NOT_AN_EQUILIBRIUM
    assert "do not balance" in refused.reason


def test_nothing_moves_in_a_stage_that_changes_nothing() -> None:
    """The round-off of an equilibrium does not count as a rate: over a short step it would lead the path elsewhere."""
    rest = StageSpec(load_parameters=1, load=(LoadSpec(beam="a", end="start", force=(0.0, 1.0)),))
    idle = replace(RIGHT["heavy taper"], stages=(rest,))
    solution = found(idle, undeformed(idle, 1.5)).solution
    change, inside = tangent(idle, solution, 1e-7)
    assert not np.any(change)
    assert not np.any(inside)

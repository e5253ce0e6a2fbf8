"""An answer moves with its scene: turned, shifted, mirrored, or stated with other starts of its beams."""

import math
from dataclasses import replace

import pytest

from comparisons.scene import SPECIAL
from tests.laws.scenes import SCENES, cases, keys, scene, stated, within
from tests.laws.transform import Change, apart, swapped, swapped_readings

MOTIONS = (
    Change(angle=math.pi / 2.0, shift=(3.0, -2.0)),
    Change(angle=0.7, shift=(-1.0, 2.0)),
    Change(angle=-2.0, mirror=True),
)


@pytest.mark.slow_at("referee-special-58", "mixed-friction-10")
@pytest.mark.parametrize(("model", "name"), cases())
def test_an_answer_moves_with_its_scene(model: str, name: str) -> None:
    own = scene(name)
    for motion in MOTIONS:
        change = motion if motion.fits(own) else replace(motion, angle=math.pi)
        moved = change.scene(own)
        off = apart(moved, change.readings(stated(own, model)), stated(moved, model))
        assert off[0] <= within(model), (change, off)


@pytest.mark.slow_at("referee-special-58")
@pytest.mark.parametrize(("model", "name"), cases())
def test_start_and_end_of_a_beam_are_names(model: str, name: str) -> None:
    """All beams are stated from the other end, and one of them."""
    own = scene(name)
    for beams in {tuple(beam.name for beam in own.beams), (own.beams[0].name,)}:
        other = swapped(own, beams)
        off = apart(other, swapped_readings(stated(own, model), own, beams), stated(other, model))
        assert off[0] <= within(model), (beams, off)


def test_the_scenes_have_every_special_key() -> None:
    assert {key for name in SCENES for key in keys(scene(name))} == set(SPECIAL)

"""Scenes that the elastica cannot state."""

from dataclasses import replace

import pytest

from comparisons.models import solve
from comparisons.models.options import ModelError
from comparisons.scene import LoadSpec, Scene, SupportSpec, load_scene

TIED = load_scene("ks-tied-tip")
BEAM = "cantilever"


CLAMP = SupportSpec(beam=BEAM, end="start", kind="clamped")


@pytest.mark.parametrize(
    ("scene", "reason"),
    [
        (TIED, 'one support, beam "cantilever" has two'),
        (
            replace(TIED, supports=(), loads=(LoadSpec(beam=BEAM, end="end", moment=1.0),)),
            'no dead loads, the scene loads "cantilever.end"',
        ),
        (
            replace(
                TIED, beams=(replace(TIED.beams[0], clamped=()),), supports=(replace(CLAMP, rotation=0.1),)
            ),
            'the clamp at rest, "cantilever.start" moves',
        ),
        (
            replace(
                TIED,
                beams=(replace(TIED.beams[0], clamped=()),),
                supports=(replace(CLAMP, kind="pinned"), TIED.supports[0]),
            ),
            'one end clamped, none of beam "cantilever" is',
        ),
        (
            replace(
                load_scene("ks-cantilever"),
                loads=(LoadSpec(beam=BEAM, end="end", moment=1.0),),
            ),
            'no dead loads, the scene loads "cantilever.end"',
        ),
        (
            replace(load_scene("ks-cantilever"), supports=TIED.supports),
            'one support, beam "cantilever" has two',
        ),
    ],
)
def test_scenes_that_the_elastica_cannot_state(scene: Scene, reason: str) -> None:
    with pytest.raises(ModelError) as caught:
        solve(scene, "elastica")
    line = str(caught.value)
    assert len(line.splitlines()) == 1
    assert reason in line

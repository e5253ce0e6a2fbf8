"""A beam stated as two that are rigidly joined is the same beam."""

import pytest

from comparisons.scene import BeamSpec, Scene
from tests.laws.scenes import ELEMENTS, REFEREE, cases, scene, stated, within
from tests.laws.transform import Readings, apart, split


def whole(found: Scene) -> BeamSpec | None:
    """The first beam that nothing touches and whose nodes are even."""
    touched = {contact.beam for contact in found.contacts}
    return next((beam for beam in found.beams if beam.name not in touched and not beam.nodes), None)


@pytest.mark.parametrize(
    ("model", "name"), cases(lambda found: whole(found) is not None, (*ELEMENTS, REFEREE))
)
def test_a_beam_may_be_stated_as_two(model: str, name: str) -> None:
    own, beam = scene(name), whole(scene(name))
    assert beam is not None
    one, two = stated(own, model), joined(stated(split(own, beam.name, 0.5), model), beam.name)
    one = {name: item for name, item in one.items() if name not in inside(beam.name)}
    off = apart(own, one, two)
    assert off[0] <= 10.0 * within(model), off


def inside(*beams: str) -> set[str]:
    """What is read of beams and not of their ends."""
    return {f"{what} {beam}" for what in ("axis", "N", "V", "M") for beam in beams}


def joined(found: Readings, beam: str) -> Readings:
    """The readings of the second half under the name of the whole, where it has its end."""
    second, own = f"{beam}-2", inside(beam, f"{beam}-2")
    return {
        name.replace(f"{second}.end", f"{beam}.end"): item for name, item in found.items() if name not in own
    }

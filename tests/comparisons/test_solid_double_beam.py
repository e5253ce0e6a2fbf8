"""Two solid strips in contact against TSM beams, stage by stage."""

from dataclasses import replace

import numpy as np
import pytest

import fem_reference
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.models.solid import to_solid
from comparisons.scene import Scene, load_scene

AXIS = load_scene("double-beam")
UPPER, TIP, LOWER = "pin->upper", "upper.end->lower", "pin->lower"


def on_faces() -> Scene:
    """Every contact on the upper faces, the pin from there; sections as the rectangles that the solid has."""
    strip = to_solid(AXIS).strips[0]
    size = {"area": None, "second_moment": None, "width": strip.width, "height": strip.height}
    contacts = tuple(replace(contact, surface="face") for contact in AXIS.contacts)
    return replace(
        AXIS, beams=tuple(replace(beam, **size) for beam in AXIS.beams), contacts=contacts,
        pins=(replace(AXIS.pins[0], start=(0.8, strip.height / 2)),),
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("surface", ["axis", "face"])
def test_forces_and_jumps_are_those_of_the_beams(surface, stated):
    """Forces except beside a jump, and jumps."""
    scene = AXIS if surface == "axis" else on_faces()
    solid, beams = solve(scene, "solid"), solve(scene, "tsm", Options(elements=20))
    forces, jumps = [], []
    for pair in (UPPER, TIP, LOWER):
        one, other = solid.contacts[pair], beams.contacts[pair]
        changes = np.flatnonzero(np.diff(other.force > 0)) + 1
        np.testing.assert_array_equal(np.flatnonzero(np.diff(one.force > 0)) + 1, changes, err_msg=pair)
        beside = np.min(np.abs(np.arange(one.force.size)[:, None] - changes), axis=1) <= 1
        away = (other.force > 0) & ~beside
        forces.append(np.abs(one.force[away] / other.force[away] - 1).max())
        if np.isfinite(other.slip_off):
            jumps.append(76 * abs(one.slip_off - other.slip_off))
    assert max(forces) <= 2e-3
    assert max(jumps) < 1
    stated(f"solid.double-beam-{surface}", max(forces), max(jumps))


@pytest.mark.slow
@pytest.mark.parametrize("penalty", [5e6, 1e9])
def test_on_axes_the_pin_presses_both_strips_before_it_leaves_the_upper_one(penalty, stated):
    """Where pin, upper tip and lower axis meet in one point the lower strip takes the tip's force over from the tip.

    The tip stays clenched, its force falls to zero, and only then, at .5386 instead of .5371, does the pin leave the upper
    strip. The penalty does not matter; on faces, which keep pin and lower strip half a height apart, there is no such stage.
    """
    depths = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.53, 0.536, 0.5375, 0.538, 0.5385, 0.54])
    contacts = tuple(replace(contact, penalty=penalty) for contact in AXIS.contacts)
    result = fem_reference.solve(to_solid(replace(AXIS, contacts=contacts)), depths / 0.76)
    upper, tip, lower = (result.contacts[pair].force for pair in (UPPER, TIP, LOWER))
    clenched = slice(7, 10)
    assert np.all(np.diff(tip[clenched]) < 0)
    assert np.all(np.diff(lower[clenched]) > 0)
    assert min(force[clenched].min() for force in (upper, tip, lower)) > 0
    assert upper[-1] == tip[-1] == 0
    assert 0.5385 < 0.76 * result.contacts[UPPER].slip_off < 0.539
    stated("solid.leaves-upper", 0.76 * result.contacts[UPPER].slip_off)

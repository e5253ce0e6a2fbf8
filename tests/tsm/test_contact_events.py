"""Touch, release, slip-off: defined at their edges, located, undone, and found however long the load step is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import tsm
from tests.tsm.structures import SECTION, TENTHS, cantilever, essentials, raised, steps, turned

TOUCH, RELEASE, OFF = tsm.EventKind.TOUCH, tsm.EventKind.RELEASE, tsm.EventKind.SLIP_OFF
SLENDER = tsm.Section(EA=3e6, GA=1e6, EI=1.0)
SCENES = {  # path, (kind, load parameter, arc position) of every event, more of the scene
    "touch of an offset": (((0.83, -0.3), (0.83, 0.1)), [(TOUCH, 0.625, 0.83)], {"offset": 0.05}),
    "again": (((0.83, 0.0), (0.83, 0.1), (0.83, -0.1), (0.83, 0.1)), [(RELEASE, 0.4, 0.83), (TOUCH, 0.8, 0.83)], {}),
    "away at once": (raised(0.83, -0.1), [(RELEASE, 0.0, 0.83)], {}),
    "along": (((0.8, 0.0), (0.3, 0.0)), [], {}),
    "beyond the tip": (((1.1, -0.2), (1.1, 0.2), (0.7, 0.2)), [], {}),
    "from beyond the tip": (((1.2, -0.2), (0.8, 0.1)), [(TOUCH, 2 / 3, 14 / 15)], {}),
    "slip-off of a slender beam": (((0.3, 0.0), (0.3, 0.3), (0.7, 0.8)), [(OFF, 0.85482, 1.0)], {"section": SLENDER}),
    "armed again": (
        ((0.9, 0.0), (0.9, 0.5), (1.3, 0.5), (1.3, -0.2), (0.9, -0.2), (0.9, 0.1)),
        [(OFF, 0.171826, 1.0), (TOUCH, 22 / 23, 0.9)], {},
    ),
    "over the clamp": (
        ((0.122, 0.0), (0.214, 0.471), (-0.212, 0.622), (0.088, 0.422)), [(OFF, 0.60374, 1.0)], {},
    ),
    "off and above": (
        ((0.5, -0.1), (0.8, 0.5), (1.1, 0.5), (0.7, 0.2)), [(TOUCH, 0.0760143113, 0.55), (OFF, 0.477688, 1.0)], {},
    ),
    "off at the tip": (((1.0, 0.0), (1.001, 0.085), (0.771, 0.085)), [(OFF, 0.0, 1.0)], {}),
    # where these end they are nowhere over the beam, and no gap tells of the contact
    "past the clamp": (((0.3, 0.1), (-0.7, -0.4)), [(TOUCH, 0.2, 0.1)], {"side": "left"}),
    "just past the clamp": (
        ((0.3, 0.1), (-0.19, -0.0667)), [(TOUCH, 0.1 / 0.1667, 0.3 - 0.49 * 0.1 / 0.1667)], {"side": "left"},
    ),
    "past the tip": (((0.3, 0.1), (1.4, -0.1)), [(TOUCH, 0.5, 0.85), (OFF, 0.6359615, 1.0)], {"side": "left"}),
}  # fmt: skip
ENDED = {"past the clamp": "LIMIT_POINT", "just past the clamp": "LIMIT_POINT"}
"""How exact elements stop."""
CASES = [
    (element, name)
    for name, (_, events, _) in SCENES.items()
    for element in ("mixed", "exact", "timoshenko")
    if element != "timoshenko" or name in ("touch of an offset", "again", "along")
]


@pytest.mark.slow_at("mixed-just past the clamp", "exact-past the clamp", "exact-over the clamp")
@pytest.mark.parametrize(("element", "name"), CASES)
def test_events_are_located_however_long_the_step(element, name):
    """A step ends where the path turns: what lies between its ends may be a slip-off, or the whole of a contact."""
    path, events, more = SCENES[name]
    # the round-off of a direction is a force, which elements of the paper do not bear at a node
    structure = turned(
        cantilever(path, element=element, elements=1 if element == "exact" else 20, **more),
        0.0 if element == "timoshenko" else 0.7,
    )
    one, many = (tsm.solve(structure, t, throw=False) for t in ([1.0], steps(20)))
    for result in (one, many):
        assert name in ENDED or result.status is tsm.Status.COMPLETED
        assert element != "exact" or result.status.name == ENDED.get(name, "COMPLETED")
        found = [event for event in result.events if event.kind in (TOUCH, RELEASE, OFF)]
        assert [event.kind for event in found] == [kind for kind, *_ in events]
        for event, (kind, t, arc) in zip(found, events, strict=True):
            assert event.load_parameter == pytest.approx(t, abs=1e-4 if kind is OFF else 1e-7)
            assert event.arc_position == pytest.approx(arc, abs=1e-9 if kind is TOUCH else 1e-6)
    contact, t = many.contacts["p0->b"], many.load_parameter
    closed = np.full(len(t), path[0][1] == 0 and name != "along")
    for kind, at, _ in events:
        closed = np.where(t > at - 1e-9, kind is TOUCH, closed)
        t = np.where(abs(t - at) < 1e-6, np.nan, t)
    known = ~np.isnan(t)
    assert ((contact.force > 1e-9) == closed)[known].all()
    assert np.abs(many.tips["b"][known & ~closed] - structure.beams[0].end).max(initial=0.0) <= 1e-9
    if name not in ENDED:
        assert one.contacts["p0->b"].force[-1] == pytest.approx(contact.force[-1], abs=1e-8)
    if "touch" in name:
        assert contact.gap[~closed] == pytest.approx(0.3 - 0.4 * t[~closed] - more.get("offset", 0.0))
        assert np.isnan(contact.arc_position[~closed]).all()


@pytest.mark.parametrize(("element", "elements"), [("mixed", 40), ("exact", 3)])
def test_the_gap_is_the_distance_to_the_closest_point_of_the_axis(element, elements):
    """A beam rolls up to three quarters of a circle around a pin, or away from it."""
    turn = 1.5 * np.pi
    load = tsm.Load(beam="b", end="end", moment=turn * SECTION.EI)
    for angle, part in ((0.02, 0.3), (0.02, 1.1), (0.45, 0.3), (0.97, 0.3)):
        x, y = np.array([np.sin(angle * turn), -np.cos(angle * turn)]) * part / turn + [0, 1 / turn]
        path, side = ((x + 1e-3, y), (x, y)), "left" if part < 1 else "right"
        structure = cantilever(path, element=element, elements=elements, load=load, side=side)
        result = tsm.solve(structure, steps(4))
        _, axis = result.axis_line("b", -1, 5000)
        assert result.contacts["p0->b"].gap[-1] == pytest.approx(np.hypot(*(axis - [x, y]).T).min(), abs=3e-7)
        if element == "exact":
            assert result.contacts["p0->b"].gap[-1] == pytest.approx(abs(1 - part) / turn, abs=1e-9)


def test_a_beam_that_springs_back_lands_on_the_pin_below():
    """When the outer pin slips off, the inner one is still below the bent beam and catches it."""
    inner, outer, t = ((0.93, -0.1), (0.93, 0.4)), raised(0.97, 0.5), steps(40)
    result, alone = (tsm.solve(cantilever(*paths), t) for paths in ((inner, outer), (inner,)))
    slip = next(event for event in result.events if event.kind is OFF)
    assert slip.pair == "p1->b"
    assert slip.released > 0
    before, caught = (t > 0.2) & (t < slip.load_parameter), (t > slip.load_parameter) & (t < 0.85)
    force = result.contacts["p0->b"].force
    assert (force[before] == 0).all()
    assert force[caught] == pytest.approx(alone.contacts["p0->b"].force[caught], rel=1e-8)
    assert (force[caught] > 0).all()


def test_a_beam_that_springs_back_leaves_the_pin_above():
    """When the pin at the tip slips off, the other one would have to pull: the beam is free, and all its energy released."""
    both = cantilever(raised(0.5, 0.01), raised(0.93, 0.6), elements=2, element="exact")
    both = replace(both, contacts=(replace(both.contacts[0], side="left"), both.contacts[1]))
    result = tsm.solve(both, TENTHS)
    slip, release = (event for event in result.events if event.kind in (OFF, RELEASE))
    assert essentials(result) == [(OFF, "p1->b"), (RELEASE, "p0->b")]
    assert slip.load_parameter == release.load_parameter
    before = tsm.solve(both, [slip.load_parameter * (1 - 1e-9)])
    assert release.force == pytest.approx(before.contacts["p0->b"].force[-1], rel=1e-6)
    assert slip.released == pytest.approx(before.strain_energy[-1], rel=1e-6)
    assert result.shape("b", -1)[:, 1] == pytest.approx(0.0, abs=1e-12)
    kept = replace(both, contacts=(replace(both.contacts[0], keep=True), both.contacts[1]))
    stopped = tsm.solve(kept, TENTHS, throw=False)
    assert stopped.status is tsm.Status.LOST_CONTACT
    assert stopped.load_parameter[-1] < slip.load_parameter

"""`exact` follows the same path of drawn scenes as an independent chain of small elements: closed contacts, forces, places, events."""

from collections.abc import Sequence
from dataclasses import replace

import pytest

from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.response import Response
from comparisons.scene import to_toml
from tests.fuzz.world import drawn
from tests.oracles.chain import LONGEST, Chain, NotStatedError, Path

COARSE, FINE = 16, 32
"""Elements along every beam; the error is of second order, so that a third of the difference is left and extrapolated."""
LEAST = 2e-3
"""Smallest allowance: of a force over the largest, of a place over the beam's length, of a load parameter."""
EARLY = 1e-6
"""Load parameter up to which contacts that touch from the beginning close."""
FAST, WITNESS, SLOW = (5, 13, 30, 60, 79, 377), 13, range(120, 840, 80)
"""Seeds of the fast tests, of the one whose answer is forged, and the first of every eighty of the slow ones, 206 of which are stated."""
SHORTER = 8.0
"""Part of the chain's longest step with which a path that differs is followed again: beside a bifurcation it may end on another branch."""
UNSEEN = 1e-6
"""Contact force over EI/L^2 that bends a beam by less than the chain resolves."""
COMPARED = ("touch", "release", "slip-off")


def paths(seed: int, longest: float = LONGEST) -> tuple[Path, Path] | None:
    """Return both paths of a scene with contacts; None if the chain cannot state it."""
    scene = drawn(seed)
    try:
        return (
            tuple(Chain(to_toml(scene), number).follow(longest) for number in (COARSE, FINE))
            if scene.contacts
            else None
        )
    except NotStatedError:
        return None


def near(found: float, coarse: float, fine: float, least: float) -> bool:
    """Whether a number is the extrapolated one, by the difference between two meshes."""
    return abs(found - (4.0 * fine - coarse) / 3.0) <= least + abs(fine - coarse)


def lasting(events: Sequence[tuple[str, str, float]]) -> list[tuple[str, str, float]]:
    """Return events after the beginning, without touches that end within a step of the chain, which does not see them."""
    short = [
        k
        for k, (kind, pair, t) in enumerate(events[:-1])
        if (kind, events[k + 1][:2]) == ("touch", ("release", pair)) and events[k + 1][2] - t < LONGEST
    ]
    return [e for k, e in enumerate(events) if e[2] > EARLY and k not in short and k - 1 not in short]


def differences(  # noqa: C901 - events, then states
    response: Response, coarse: Path, fine: Path, lengths: dict[str, float]
) -> list[str]:
    """Return where an answer leaves the path of the chain, as far as both meshes agree on the sequence of its events."""
    stated = [(e.kind, e.pair, e.load_parameter) for e in response.events or () if e.kind in COMPARED]
    own, rough, sharp = map(lasting, (stated, coarse.events, fine.events))
    end, wrong = min(coarse.end, fine.end) - LEAST, []
    for k in range(max(len(own), len(sharp))):
        if k >= len(rough) or k >= len(sharp) or rough[k][:2] != sharp[k][:2]:
            end = min([end, *(e[k][2] - LEAST for e in (own, rough, sharp) if k < len(e) and e is not own)])
            if (
                k < len(own)
                and own[k][2] < end
                and own[k][:2] not in [e[k][:2] for e in (rough, sharp) if k < len(e)]
            ):
                wrong.append(f"{own[k]} is not on the path of the chain")
            break
        if k >= len(own):
            if len(response.load_parameter) and sharp[k][2] < response.load_parameter[-1] - LEAST:
                wrong.append(f"{sharp[k]} is missing")
            break
        if own[k][:2] != sharp[k][:2] or not near(own[k][2], rough[k][2], sharp[k][2], LEAST):
            wrong.append(f"{own[k]}, by the chain {rough[k]}, {sharp[k]}")
            break
    times = [e[2] for path in (rough, sharp, own) for e in path]
    largest = max((force for state in fine.states for force, _ in state.values()), default=0.0)
    for k, (a, b) in enumerate(zip(coarse.states, fine.states, strict=False)):
        if k >= len(response.load_parameter) or (t := response.load_parameter[k]) > end:
            break
        if any(abs(t - time) < 5.0 * LEAST for time in times):
            continue
        closed = {pair for pair, item in response.contacts.items() if item.force[k] > 0.0}
        if closed != b.keys() or a.keys() != b.keys():
            wrong.append(f"at {t:.6g} closed: {sorted(closed)}, by the chain {sorted(b)}")
            break
        for pair in closed:
            force, arc = response.contacts[pair].force[k], response.contacts[pair].arc_position[k]
            length = lengths[pair.partition("->")[2]]
            if not near(force, a[pair][0], b[pair][0], LEAST * largest) or not near(arc, a[pair][1], b[pair][1], LEAST * length):  # fmt: skip
                wrong.append(
                    f"at {t:.6g} {pair}: {force:.6g} at {arc:.6g}, by the chain {a[pair]}, {b[pair]}"
                )
    return wrong


def told(seed: int) -> list[str] | None:
    """Return how the answer to a drawn scene leaves the path of the chain; None if the chain cannot state the scene or resolves none of it."""
    found, scene = paths(seed), drawn(seed)
    if found is None or not found[1].states:
        return None
    response = solve(scene, "tsm", Options(element="exact"))
    lengths = {beam.name: beam.length for beam in scene.beams}
    largest = max(contact.force.max(initial=0.0) for contact in response.contacts.values())
    if 0.0 < largest < UNSEEN * min(beam.EI / beam.length**2 for beam in scene.beams):
        return None
    wrong = differences(response, *found, lengths)
    if wrong and (found := paths(seed, LONGEST / SHORTER)):
        wrong = differences(response, *found, lengths)
    return wrong


@pytest.mark.parametrize("seed", FAST)
def test_a_drawn_scene_has_the_path_of_the_chain(seed: int) -> None:
    assert told(seed) == []


@pytest.mark.slow
@pytest.mark.parametrize("first", SLOW)
def test_drawn_scenes_have_the_path_of_the_chain(first: int) -> None:
    found = {seed: told(seed) for seed in range(first, first + 80)}
    assert {seed: words for seed, words in found.items() if words} == {}
    assert sum(words is not None for words in found.values()) >= 12


def test_the_chain_tells_a_wrong_path() -> None:
    """Forces off by a percent, a contact that stays open, an event that is not there, and one a hundredth too late."""
    (scene := drawn(WITNESS)), (found := paths(WITNESS))
    assert found is not None
    response = solve(scene, "tsm", Options(element="exact"))
    lengths = {beam.name: beam.length for beam in scene.beams}
    assert differences(response, *found, lengths) == []
    for factor in (0.0, 0.97, 1.03):
        contacts = {
            pair: replace(item, force=factor * item.force) for pair, item in response.contacts.items()
        }
        assert differences(replace(response, contacts=contacts), *found, lengths)
    events = [
        event for event in response.events or () if event.kind in COMPARED and event.load_parameter > EARLY
    ]
    assert events
    late = [replace(event, load_parameter=event.load_parameter + 0.02) for event in events]
    for wrong in ((), tuple(late)):
        assert differences(replace(response, events=wrong), *found, lengths)

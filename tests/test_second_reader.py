"""What all models take from a scene, held against a second reader that shares nothing with the first."""

import math

import pytest

from comparisons.scene import Scene, built_in_scenes, read_scene, to_toml
from tests.fuzz.special import drawn_special
from tests.second_reader import PLACES, Numbers, read

EXACT = 1e-14
"""Largest difference of two readings, over the largest number of the quantity, or the scene's largest coordinate for a place."""
DRAWN, CHUNK = 500, 50


def stated(scene: Scene) -> Numbers:
    """The same numbers by the scene's own interface."""
    times = scene.times
    found: Numbers = {"load parameters": times, "gravity": _flat(scene.gravity_at(t) for t in times)}
    for beam in scene.beams:
        EA, GA, EI = zip(*(beam.stiffness(part) for part in PLACES), strict=True)
        own: Numbers = {
            "length": (beam.length,),
            "axis": _flat(beam.place(part) for part in PLACES),
            "tangents": _flat(beam.tangent(part) for part in PLACES),
            "EA": EA, "GA": GA, "EI": EI,
            "mass": (beam.mass,),
            "mass per length": tuple(beam.mass_per_length(part) for part in PLACES),
        }  # fmt: skip
        found |= {f"{beam.name} {what}": value for what, value in own.items()}
    for node, motion in scene.prescribed_motions.items():
        moved = (math.nan if value is None else value for t in times for value in motion.at(t))
        found[f"{node} motion"] = tuple(moved)
    for history in scene.load_histories:
        load = history.load
        where = load.node.removeprefix(load.beam).lstrip(" .")
        found[f"{load.beam} {where} load"] = _flat(history.at(t) for t in times)
    for pin in scene.pins:
        found[f"{pin.name} positions"] = _flat(pin.position(t) for t in times)
        found[f"{pin.name} radius"] = (pin.radius or 0.0,)
    for contact in scene.contacts:
        found[f"{contact.pair} offset"] = tuple(scene.offset(contact, part) for part in PLACES)
        found[f"{contact.pair} friction"] = (contact.friction,)
        found[f"{contact.pair} side"] = (1.0 if contact.side == "left" else -1.0,)
    found |= {f"{hinge.node} hinge": (hinge.stiffness,) for hinge in scene.hinges}
    found |= {f"{spring.node} spring": (*spring.stiffness, spring.rotation) for spring in scene.springs}
    return found


def _flat(rows: object) -> tuple[float, ...]:
    return tuple(float(value) for row in rows for value in row)  # type: ignore[attr-defined]


def misread(text: str) -> dict[str, tuple[object, object]]:
    """Quantities that the two readers read differently, with both values."""
    scene, again = read_scene(text, "scene"), read(text)
    once = stated(scene)
    assert once.keys() == again.keys()
    sizes = [value for beam in scene.beams for value in (*beam.start, *beam.end, beam.length)]
    sizes += [value for pin in scene.pins for point in pin.points for value in point]
    reach = max(map(abs, sizes))
    wrong = {}
    for name, values in once.items():
        scale = max((abs(value) for value in values if math.isfinite(value)), default=0.0)
        scale = max(scale, reach) if name.endswith((" axis", " positions")) else scale
        pairs = zip(values, again[name], strict=True)
        apart = [abs(a - b) for a, b in pairs if not (math.isnan(a) and math.isnan(b))]
        if not max(apart, default=0.0) <= EXACT * scale:
            wrong[name] = (values, again[name])
    return wrong


@pytest.mark.parametrize("name", built_in_scenes())
def test_a_built_in_scene_is_read_as_it_stands(name):
    assert not misread(built_in_scenes()[name])


@pytest.mark.parametrize(
    "first", [0, *(pytest.param(k, marks=pytest.mark.slow) for k in range(CHUNK, DRAWN, CHUNK))]
)
def test_drawn_scenes_are_read_as_they_stand(first):
    for seed in range(first, first + CHUNK):
        assert not misread(to_toml(drawn_special(seed))), f"seed {seed}"

"""The referee on loads along a beam, weight, natural curvature, taper, hinges, springs, stages and forces inside a beam."""

import math
from dataclasses import replace

import numpy as np
import pytest

from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.referee import (
    AnswerState,
    Equilibrium,
    SearchStatus,
    Verdict,
    answer_state,
    certify,
    equilibrium,
)
from comparisons.scene import BeamSpec, LoadSpec, Scene, SpringSpec, load_scene
from tests.comparisons.referee.forged import scene_of, seen, stated
from tests.oracles.shooting import Rod, free, pinned

MATERIAL = {"youngs_modulus": 1e6, "poissons_ratio": 0.3}
GRAVITY = (2.0, -20.0)


def strip(**more: object) -> BeamSpec:
    given = {
        "name": "a",
        "start": (0.0, 0.0),
        "end": (1.0, 0.1),
        "height": 0.05,
        "width": 1.0,
        "clamped": ("start",),
    }
    return BeamSpec(**(given | MATERIAL | more))


def found(scene: Scene, given: AnswerState | None = None) -> Equilibrium:
    exact = equilibrium(scene, given or seen(scene))
    assert exact.status is SearchStatus.FOUND, exact.message
    return exact


TIP = {"loads": (LoadSpec(beam="a", end="end", force=(1.0, 6.0), moment=0.5),)}
PART = LoadSpec(beam="a", force_per_length=(5.0, -10.0), part=(0.15, 0.55))
INSIDE = LoadSpec(beam="a", at=0.8, force=(2.0, 3.0), moment=0.4)
SPRING = SpringSpec(beam="a", end="end", stiffness=(2.0, 5.0), rotation=0.4)
HEAVY_TAPER = {"beams": (strip(density=3.0, height=(0.05, 0.03)),), "gravity": GRAVITY}


def on_its_face() -> Scene:
    """The same with a thicker strip, whose face leans, under a round pin."""
    scene = scene_of("everything")
    return replace(
        scene,
        beams=(replace(scene.beams[0], height=(0.12, 0.06), poissons_ratio=0.4),),
        contacts=(replace(scene.contacts[0], surface="face"),),
        pins=(replace(scene.pins[0], radius=0.05, start=(0.6, -0.25)),),
    )


def nearest(scene: Scene) -> Equilibrium:
    """The equilibrium at the end next to the undeformed beam under a push, or to the answer of a model."""
    if scene.name == "everything":
        push = (-10.0, 60.0) if scene.pins[0].radius else (-3.0, 10.0)
        return found(scene, seen(scene, arcs={"pin->a": 0.62}, forces={"pin->a": push}))
    answer = solve(scene, "tsm", Options(element="exact"))
    return found(scene, answer_state(answer, scene, -1))


def by_shooting(scene: Scene, exact: Equilibrium) -> list[np.ndarray]:
    """Clamp, tip, contact force and arc position by shooting, from the referee's own. The spring bears the stretch that the referee has."""
    beam, t = scene.beams[0], exact.load_parameter
    chord, tip = np.subtract(beam.end, beam.start), exact.ends[f"{beam.name}.end"]
    direction = math.atan2(chord[1], chord[0]) - beam.turn / 2.0
    held = sum((t * np.array([*load.force, load.moment]) for load in scene.loads if load.end), np.zeros(3))
    for spring in scene.springs:
        turned = exact.shape(beam.name, np.array([beam.length])).rotation[0]
        held -= np.array([*spring.stiffness, spring.rotation]) * [*(tip - beam.end), turned]
    weight = np.array(scene.gravity or (0.0, 0.0))
    lines = [
        (t * np.array(load.force_per_length), load.span) for load in scene.loads if load.force_per_length
    ]
    loads = [(lambda x: t * beam.mass_per_length(x) * weight, 0.0, 1.0)]
    loads += [(lambda _, line=line: line, *span) for line, span in lines]
    widths, heights = (
        (given if isinstance(given, tuple) else (given, given)) for given in (beam.width, beam.height)
    )
    rod = Rod(
        length=beam.length, direction=direction, turn=beam.turn, height=heights, width=widths, loads=tuple(loads), tip=tuple(held),
        youngs_modulus=beam.youngs_modulus, shear_modulus=beam.shear_modulus or beam.youngs_modulus / (2.0 + 2.0 * beam.poissons_ratio),
    )  # fmt: skip
    clamp = -exact.reactions[f"{beam.name}.start"]
    if not scene.contacts:
        found = free(rod, clamp)
        return [found.clamp - clamp, found.tip[:2] - tip]
    (spec,), (contact,) = scene.contacts, exact.contacts.values()
    pin, face = scene.pin(spec.node), spec.surface == "face"
    tilt = math.atan((heights[1] - heights[0]) / 2.0 / beam.length)
    reach = tuple((pin.radius or 0.0) + face * height / 2.0 * math.cos(tilt) for height in heights)
    found = pinned(rod, np.array(pin.position(t)), reach, [*clamp, *contact.force, contact.arc_position])
    apart = [found.clamp - clamp, found.tip[:2] - tip]
    return [*apart, found.force - contact.force, np.array([found.arc - contact.arc_position])]


EVERYTHING = replace(scene_of("everything"), loads=(PART, *TIP["loads"]))
SHOT = {
    "everything": EVERYTHING,
    "everything under a round pin on its face": replace(on_its_face(), loads=EVERYTHING.loads),
    "strong shear": scene_of("shear"),
    "under a face": replace(load_scene("ks-face"), load_parameters=4),
}


@pytest.mark.parametrize("key", SHOT)
def test_the_equilibrium_is_that_of_shooting_to_1e_14(key):
    """Forces and moments over the largest, and places over the length; the equations are those of another program."""
    exact = nearest(SHOT[key])
    size = max(1.0, *(np.abs(held).max() for held in exact.reactions.values()))
    assert max(np.abs(apart).max() for apart in by_shooting(SHOT[key], exact)) < 1e-14 * size
    assert exact.index == 0


TIGHT = 1e-9
"""Allowance of answers that are exact: the stated ones are next to round-off."""


def test_no_key_is_left_out_of_the_balance():
    """All keys at once with a pin in contact: the stated forces alone balance to 1e-6 with the scene's loads and springs."""
    right = scene_of("everything")
    answer = stated(right, [nearest(right)])
    assert certify(answer, right, allowance=TIGHT).certified
    others = {"gravity": (2.0, -20.0 * (1.0 - 1e-3)), "springs": (replace(SPRING, stiffness=(2.0, 5.01)),)}
    for key, other in others.items():
        refused = certify(answer, replace(right, **{key: other}), allowance=1.0)
        assert refused.verdict is Verdict.NOT_AN_EQUILIBRIUM
        assert "do not balance" in refused.reason

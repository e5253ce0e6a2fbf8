"""The referee finds the equilibria of the exact answers and the oracles, with which it shares no equation, to 1e-12."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from comparisons.exact import elastica_under_pin, rod_under_pin
from comparisons.models import solve
from comparisons.referee import Equilibrium, certify
from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene, load_scene
from tests.oracles.coupled import pair_of
from tests.oracles.elastica import tip_under_dead_load
from tests.oracles.frames import lee

KS_PATH = ((1.0, 0.0), (0.0, 2.0 / np.pi))
BEAM = BeamSpec(
    name="cantilever", start=(0.0, 0.0), end=(1.0, 0.0), clamped=("start",),
    youngs_modulus=1.0, shear_modulus=1.0, area=1e14, second_moment=1.0, shear_area=1e14,
)  # fmt: skip
"""A beam with EI = L = 1 that neither stretches nor shears."""
PINNED = Scene(
    name="elastica-under-a-pin", load_parameters=2, beams=(BEAM,), pins=(PinSpec(name="pin", path=KS_PATH),),
    contacts=(ContactSpec(node="pin", beam="cantilever", side="right"),),
)  # fmt: skip
LOADED = Scene(
    name="dead-load", load_parameters=2, beams=(BEAM,),
    loads=(LoadSpec(beam="cantilever", end="end", force=(0.0, 10.0)),),
)  # fmt: skip


def section(scene: Scene) -> dict[str, float]:
    """Return the stiffnesses of a scene's first beam, whose length is 1."""
    return {name: getattr(scene.beams[0], name) for name in ("EA", "GA", "EI")}


def on_a_beam(exact: Equilibrium) -> list[Any]:
    """Return what a cantilever under a pin has, and places and directions along it."""
    (contact,) = exact.contacts.values()
    tip, clamp = exact.ends["cantilever.end"], exact.reactions["cantilever.start"]
    shape = exact.shape("cantilever", np.linspace(0.0, 1.0, 9))
    return [contact.force, contact.arc_position, clamp[2], tip, shape.position, shape.rotation]


def last(path: Any) -> list[Any]:
    """Return the same of the last state of an exact answer."""
    x, y, rotation = path.shape(-1, 9)[:, :3].T
    states = path.force, path.arc_position, path.clamp_moment, path.tip
    return [*(one[-1] for one in states), np.stack([x, y], 1), rotation]


def on_the_face(scene: Scene) -> list[Any]:
    points = [scene.pins[0].position(t) for t in (0.0, *scene.times)]
    return last(rod_under_pin(points, length=1.0, offset=scene.offset(scene.contacts[0]), **section(scene)))


def coupled(scene: Scene) -> list[Any]:
    """The oracle's depths are downwards."""
    stage, down = pair_of(scene).stage([0.38]), [1.0, -1.0]
    forces = stage.pin_force[0] * down, stage.tip_force[0] * down
    return [*forces, [stage.pin_arc[0], stage.tip_arc[0]], stage.tip[0] * down]


def on_two_beams(exact: Equilibrium) -> list[Any]:
    pin, tip = (exact.contacts[pair] for pair in ("pin->upper", "upper.end->lower"))
    return [pin.force, tip.force, [pin.arc_position, tip.arc_position], exact.ends["upper.end"]]


SCENES: dict[str, tuple[Scene, Callable[[Equilibrium], list[Any]], Callable[[Scene], list[Any]]]] = {
    "elastica": (PINNED, on_a_beam, lambda _: last(elastica_under_pin(KS_PATH))),
    "dead-load": (
        LOADED,
        lambda found: [found.ends["cantilever.end"]],
        lambda _: [tip_under_dead_load(10.0)],
    ),
    "face": (load_scene("ks-face"), on_a_beam, on_the_face),
    "friction": (
        load_scene("ks-friction"),
        on_a_beam,
        lambda scene: last(rod_under_pin(KS_PATH, friction=0.3, length=1.0, **section(scene))),
    ),
    "coupled": (load_scene("double-beam"), on_two_beams, coupled),
    "frame": (  # where Lee's frame has begun to fall
        load_scene("lees-frame"),
        lambda found: [-found.reactions["near.end"][1]],
        lambda _: [lee().load(np.linspace(6.0, 54.0, 9))[-1]],
    ),
}


@pytest.mark.slow_at("coupled", "friction")
@pytest.mark.parametrize("name", SCENES)
def test_the_referee_and_an_oracle_agree(name: str) -> None:
    scene, told, oracle = SCENES[name]
    scene = replace(scene, load_parameters=2)
    (judged,) = certify(solve(scene, "tsm"), scene, at=[0 if name == "coupled" else -1]).judged
    assert judged.exact is not None, judged
    for found, exact in zip(told(judged.exact), oracle(scene), strict=True):
        np.testing.assert_allclose(found, exact, rtol=0.0, atol=1e-12 * np.abs(exact).max())

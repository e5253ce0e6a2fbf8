"""The referee finds the equilibria of the exact answers and the oracles, with which it shares no equation, to 1e-12."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import ArrayLike

from comparisons.exact import elastica_under_pin, rod_under_pin, rod_with_friction
from comparisons.models import solve
from comparisons.referee import Equilibrium, certify
from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene, load_scene
from tests.oracles.coupled import pair_of
from tests.oracles.elastica import tip_under_dead_load
from tests.oracles.frames import lee
from tests.oracles.tied import rod_with_tied_tip

Pairs = list[tuple[ArrayLike, ArrayLike]]
"""What the referee found, and what is exact."""
STIFF = 1e14
"""EA and GA over EI/L^2 of a beam that neither stretches nor shears."""
KS_PIN = (0.0, 2.0 / np.pi)


def elastica(**more: object) -> Scene:
    """Return a beam along x with EI = L = 1 under what is given."""
    beam = BeamSpec(
        name="cantilever", start=(0.0, 0.0), end=(1.0, 0.0), clamped=("start",),
        youngs_modulus=1.0, shear_modulus=1.0, area=STIFF, second_moment=1.0, shear_area=STIFF,
    )  # fmt: skip
    return Scene(name="elastica", load_parameters=2, beams=(beam,), **more)  # type: ignore[arg-type]


def pinned() -> Scene:
    """Return the elastica on the path of Konyukhov and Schweizerhof."""
    pin = PinSpec(name="pin", path=((1.0, 0.0), KS_PIN))
    return elastica(pins=(pin,), contacts=(ContactSpec(node="pin", beam="cantilever", side="right"),))


def built_in(name: str, load_parameters: int) -> Scene:
    """Return a scene with fewer load parameters."""
    return replace(load_scene(name), load_parameters=load_parameters)


def section(scene: Scene) -> dict[str, float]:
    """Return the stiffnesses of a scene's first beam, whose length is 1."""
    return {name: getattr(scene.beams[0], name) for name in ("EA", "GA", "EI")}


def on_a_beam(scene: Scene, exact: Equilibrium, path: object, k: int) -> Pairs:
    """Return what a cantilever under a pin has: force, arc position, moment of the clamp, tip."""
    (contact,), beam = exact.contacts.values(), scene.beams[0].name
    kept = ("force", "arc_position", "clamp_moment", "tip")
    force, arc, moment, tip = (
        np.asarray(getattr(path, name))[k] if k else getattr(path, name) for name in kept
    )
    clamp = exact.reactions[f"{beam}.start"][2]
    return [
        (contact.force, force),
        (contact.arc_position, arc),
        (clamp, moment),
        (exact.ends[f"{beam}.end"], tip),
    ]


def on_the_face(scene: Scene, exact: Equilibrium) -> Pairs:
    points = np.array([scene.pins[0].position(t) for t in (0.0, *scene.times)]) - scene.beams[0].start
    offset = scene.offset(scene.contacts[0])
    return on_a_beam(scene, exact, rod_under_pin(points, length=1.0, offset=offset, **section(scene)), -1)


def with_friction(scene: Scene, exact: Equilibrium) -> Pairs:
    friction, points = scene.contacts[0].friction, [(1.0, 0.0), KS_PIN]
    return on_a_beam(
        scene, exact, rod_with_friction(points, friction=friction, length=1.0, **section(scene)), -1
    )


def tied(scene: Scene, exact: Equilibrium) -> Pairs:
    path = rod_with_tied_tip([(1.0, 0.0), KS_PIN], **section(scene))
    held, clamp = exact.reactions["cantilever.end"], exact.reactions["cantilever.start"]
    return [(held[:2], path.force[1]), (clamp[2], path.clamp_moment[1])]


def coupled(scene: Scene, exact: Equilibrium) -> Pairs:
    """The oracle's depths are downwards."""
    stage, down = pair_of(scene).stage([0.38]), [1.0, -1.0]
    pin, tip = (exact.contacts[pair] for pair in ("pin->upper", "upper.end->lower"))
    return [
        (pin.force, stage.pin_force[0] * down),
        (tip.force, stage.tip_force[0] * down),
        ([pin.arc_position, tip.arc_position], [stage.pin_arc[0], stage.tip_arc[0]]),
        (exact.ends["upper.end"], stage.tip[0] * down),
    ]


def pressed(scene: Scene, exact: Equilibrium) -> Pairs:
    """Lee's frame beyond its limit point, where the load has begun to fall."""
    down = abs(scene.supports[-1].displacement[1])
    load = lee().load(np.linspace(0.0, down, 9)[1:])
    return [(-exact.reactions["near.end"][1], load[-1])]


SCENES: dict[str, tuple[Scene, Callable[[Scene, Equilibrium], Pairs]]] = {
    "elastica-under-a-pin": (pinned(), lambda s, e: on_a_beam(s, e, elastica_under_pin(*KS_PIN), 0)),
    "dead-load": (
        elastica(loads=(LoadSpec(beam="cantilever", end="end", force=(0.0, 10.0)),)),
        lambda _, exact: [(exact.ends["cantilever.end"], tip_under_dead_load(10.0))],
    ),
    "rod-on-its-face": (built_in("ks-face", 4), on_the_face),
    "rod-with-friction": (built_in("ks-friction", 2), with_friction),
    "tied-tip": (built_in("ks-tied-tip", 2), tied),
    "coupled-rods": (built_in("double-beam", 2), coupled),
    "frame": (built_in("lees-frame", 4), pressed),
}


@pytest.mark.slow_at("coupled-rods", "elastica-under-a-pin", "rod-with-friction", "tied-tip")
@pytest.mark.parametrize("name", SCENES)
def test_the_referee_and_an_oracle_agree(name: str) -> None:
    scene, pairs = SCENES[name]
    k = 0 if name == "coupled-rods" else -1
    (judged,) = certify(solve(scene, "tsm"), scene, at=[k]).judged
    assert judged.exact is not None, judged
    for found, exact in pairs(scene, judged.exact):
        size = float(np.abs(exact).max())
        np.testing.assert_allclose(found, exact, rtol=0.0, atol=1e-12 * size)

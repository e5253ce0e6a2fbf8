"""The double beam of Nizam et al., section 4.3, by exact rods: two cantilevers, and a pin that is handed over from one to the other."""

import numpy as np
from numpy.typing import ArrayLike

from comparisons.exact.coupled import CoupledPath, coupled_rods
from comparisons.exact.rod import RodPath, rod_under_pin
from comparisons.scene import Scene

UPPER, TIP, LOWER = "pin->upper", "upper.end->lower", "pin->lower"
"""The contact pairs."""


def spacing(scene: Scene) -> float:
    """Return the distance of the beams."""
    return scene.beam("upper").start[1] - scene.beam("lower").start[1]


def _rod(scene: Scene) -> dict[str, float]:
    upper = scene.beam("upper")
    return {"EA": upper.EA, "GA": upper.GA, "EI": upper.EI, "length": upper.length}


def coupled(scene: Scene, depth: ArrayLike, place: float | None = None) -> CoupledPath:
    """Return the stage in which both contacts are closed, at depths of the pin.

    Parameters
    ----------
    scene : Scene
        The double beam.
    depth : array_like, shape (s,)
        Depths of the pin.
    place : float, optional
        Where the pin comes down, from the clamps; the scene's if not given.
    """
    x = scene.pins[0].points[0][0] - scene.beam("upper").start[0] if place is None else place
    return coupled_rods(depth, pin_x=x, spacing=spacing(scene), **_rod(scene))


def single(scene: Scene, depth: ArrayLike) -> RodPath:
    """Return one of the beams under the pin alone, at depths below that beam's undeformed axis; the undeformed state comes first."""
    x = scene.pins[0].points[0][0]
    return rod_under_pin([[x, 0.0], *([x, d] for d in np.asarray(depth, dtype=float))], **_rod(scene))


def event_depths(scene: Scene, both: CoupledPath) -> dict[str, float]:
    """Return the depths of the pin at the touch of the tips and at the hand-over, which the coupled stage has, and at the last slip-off."""
    far = abs(scene.pins[0].points[1][1]) - spacing(scene)
    return {
        "touch": both.touch_depth,
        "hand-over": both.end_depth,
        "slip-off": spacing(scene) + single(scene, [far]).slip_off * far,
    }

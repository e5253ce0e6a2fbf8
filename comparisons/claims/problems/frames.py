"""Frames by exact rods: limit loads of Lee's frame and Williams' toggle, which snap through, and the sway of a portal frame."""

import math
from dataclasses import replace
from functools import cache

import numpy as np

from comparisons.claims.problems.peaks import summit
from comparisons.exact.chain import Chain, load_path
from comparisons.response import Array
from comparisons.scene import LoadSpec, Scene, load_scene

LEE_UNIT = 120.0**2 / 1440.0
"""L^2/EI of Lee's frame [1/kN]."""
LEE_FORCE, TOGGLE_FORCE = 0.1, 1.0
"""Unit loads [kN], [lb]."""


def under_load(scene: Scene, force: float) -> Scene:
    """Return a frame with a downward dead force on the joint that a support presses down in the scene, in place of the support."""
    pressed = next(support for support in scene.supports if support.moves)
    return replace(
        scene,
        supports=tuple(support for support in scene.supports if support is not pressed),
        loads=(LoadSpec(beam=pressed.beam, end=pressed.end, force=(0.0, -force)),),
    )


def lee_scene() -> Scene:
    """Return Lee's frame under its unit load."""
    return under_load(load_scene("lees-frame"), LEE_FORCE)


def toggle_scene() -> Scene:
    """Return Williams' toggle under its unit load."""
    return under_load(load_scene("williams-toggle"), TOGGLE_FORCE)


@cache
def exact_path(scene: Scene, deflections: tuple[float, ...]) -> Array:
    """Return deflections of a frame's loaded joint and the load there, columns of one array, by exact rods."""
    first, loaded = scene.beams[0], scene.loads[0]
    size = math.hypot(*loaded.force)
    chain = Chain(
        joints=(first.start, *(beam.end for beam in scene.beams)),
        loaded=1 + [beam.name for beam in scene.beams].index(loaded.beam),
        direction=(loaded.force[0] / size, loaded.force[1] / size),
        clamped=bool(first.clamped),
        EA=first.EA,
        GA=first.GA,
        EI=first.EI,
    )
    return np.stack([np.array(deflections), load_path(chain, deflections)], axis=1)


LEE_DOWN = (*np.linspace(3.0, 45.0, 15).tolist(), *np.linspace(46.0, 51.5, 12).tolist())
"""Deflections of Lee's frame [cm], closer around its limit point."""
TOGGLE_DOWN = tuple((np.arange(1, 52) / 100.0).tolist())
"""Deflections of Williams' toggle [in]."""


def lee_limit() -> float:
    """Return ``P L^2/EI`` of Lee's frame at its limit point, by exact rods."""
    down, load = exact_path(lee_scene(), LEE_DOWN).T
    return LEE_UNIT * summit(down, load)[0]


def toggle_limits() -> tuple[float, float]:
    """Return the greatest load of Williams' toggle and the least one after it [lb], by exact rods."""
    down, load = exact_path(toggle_scene(), TOGGLE_DOWN).T
    return summit(down[:32], load[:32])[0], -summit(down[26:], -load[26:])[0]


PORTAL_ASIDE = (25.0, 50.0, 75.0, 95.0, *np.linspace(105.0, 127.5, 10).tolist())
"""Displacements of the portal frame's loaded corner [mm], closer around its displacement at the whole load."""


def portal_sway() -> float:
    """Return the displacement of the portal frame's loaded corner [mm], by the polynomial through ten loads of exact rods around it."""
    scene = load_scene("portal-frame")
    aside, load = exact_path(scene, PORTAL_ASIDE)[4:].T
    whole = scene.loads[0].force[0]
    return float(np.polynomial.Polynomial.fit(load - whole, aside, len(aside) - 1)(0.0))

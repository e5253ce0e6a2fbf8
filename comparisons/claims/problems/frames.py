"""Frames of exact rods: limit loads of Lee's frame and Williams' toggle, which snap through, and the sway of a portal frame.

`tests/oracles/frames.py` computes the values by shooting.
"""

from dataclasses import replace

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


LEE_LIMIT = 18.55672753366
"""``P L^2/EI`` of Lee's frame at its limit point."""
TOGGLE_LIMITS = (33.86960632638, 31.27796889252)
"""Greatest load of Williams' toggle and the least one after it [lb]."""
PORTAL_SWAY = 115.082367996049
"""Displacement of the portal frame's loaded corner [mm]."""

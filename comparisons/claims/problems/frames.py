"""Frames that snap through: Lee's frame and Williams' toggle, and their limit loads by exact rods."""

from functools import cache
from typing import Any

import numpy as np

from comparisons.claims.problems.peaks import summit
from comparisons.exact.chain import Chain, load_path
from comparisons.response import Array
from comparisons.scene import BeamSpec, LoadSpec, Scene, SupportSpec

LEE_UNIT = 120.0**2 / 1440.0
"""L^2/EI [1/kN]."""


def lee_scene() -> Scene:
    """Return Lee's frame."""
    section: dict[str, Any] = {
        "area": 6.0,
        "second_moment": 2.0,
        "youngs_modulus": 720.0,
        "shear_modulus": 7.2e8,
    }
    corner, loaded = (0.0, 120.0), (24.0, 120.0)
    return Scene(
        name="lees-frame",
        units="kN, cm",
        load_parameters=1,
        beams=(
            BeamSpec(name="column", start=(0.0, 0.0), end=corner, **section),
            BeamSpec(name="near", start=corner, end=loaded, **section),
            BeamSpec(name="far", start=loaded, end=(120.0, 120.0), **section),
        ),
        supports=(
            SupportSpec(beam="column", end="start", kind="pinned"),
            SupportSpec(beam="far", end="end", kind="pinned"),
        ),
        loads=(LoadSpec(beam="near", end="end", force=(0.0, -0.1)),),
    )


def toggle_scene() -> Scene:
    """Return Williams' toggle."""
    section: dict[str, Any] = {
        "youngs_modulus": 1.03e7,
        "area": 1.885e6 / 1.03e7,
        "second_moment": 9274.0 / 1.03e7,
        "shear_modulus": 1.03e11,
    }
    apex = (12.94328, 0.386)
    return Scene(
        name="williams-toggle",
        units="lb, in",
        load_parameters=1,
        beams=(
            BeamSpec(name="left", start=(0.0, 0.0), end=apex, clamped=("start",), **section),
            BeamSpec(name="right", start=apex, end=(25.88656, 0.0), clamped=("end",), **section),
        ),
        loads=(LoadSpec(beam="left", end="end", force=(0.0, -1.0)),),
    )


@cache
def exact_path(scene: Scene, deflections: tuple[float, ...]) -> Array:
    """Return deflections of a frame's loaded joint and its load there, columns of one array, by exact rods."""
    first, loaded = scene.beams[0], scene.loads[0]
    chain = Chain(
        joints=(first.start, *(beam.end for beam in scene.beams)),
        loaded=1 + [beam.name for beam in scene.beams].index(loaded.beam),
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

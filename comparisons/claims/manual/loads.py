"""Cases without contact: cantilevers and columns under loads at their ends."""

from collections.abc import Iterator

import numpy as np

from comparisons.claims.claim import Quantity
from comparisons.claims.manual.models import (
    EXACT,
    FOURTH,
    SECOND,
    mixed,
    on_scene,
    paper,
    undeformed,
)
from comparisons.claims.manual.record import Picture, Problem
from comparisons.claims.manual.scenes import MM, STRIP_TEXT, rigid
from comparisons.response import Response
from comparisons.scene import load_scene

TURNED = (0.25, 0.5, 1.0)
DEFLECTIONS = {1.0: 0.30172077379981, 2.0: 0.49345748039671, 5.0: 0.71379152361191, 10.0: 0.8106090248803}
"""Deflection of the tip over L by P L^2/EI; `tests/oracles/elastica.py` computes them."""
ROUND_OFF = "no mesh error: what is left is EI/(EA L^2) = 1e-10 and the tolerances of Newton's method and of the integration (1e-9)"


def dead_load() -> Problem:
    """Cantilever under a dead load at its tip."""
    scene = rigid(load_scene("tip-load"))
    length = scene.beams[0].length

    def deflections(response: Response) -> Iterator[float]:
        return (response.tips["cantilever"][round(load) - 1, 1] / length for load in DEFLECTIONS)

    return Problem(
        name="dead-load",
        title="Cantilever under a dead load at its tip",
        purpose="Large rotations of a beam under a force that keeps its direction.",
        uncertainty=1e-12,
        scene=scene,
        statement=f"A cantilever, {STRIP_TEXT}, carries a load P across its axis at its tip, which keeps its direction.",
        source="elastica by elliptic integrals (tests/oracles/elastica.py): Bisshopp and Drucker, Quarterly of Applied Mathematics 3 (1945), 272-275",
        quantities=tuple(
            Quantity(name=f"v/L of the tip at P L^2/EI = {load:g}", exact=deflection)
            for load, deflection in DEFLECTIONS.items()
        ),
        trials=(
            on_scene(EXACT, 2e-9, ROUND_OFF, deflections, (0.1, 0.2, 0.5, 1.0)),
            on_scene(mixed(20), 2e-6, FOURTH, deflections, (0.1, 0.2, 0.5, 1.0)),
            on_scene(paper(20), 1e-3, SECOND, deflections, (0.1, 0.2, 0.5, 1.0)),
        ),
        picture=Picture(axes=MM, curves=undeformed(scene)),
    )


def roll_up() -> Problem:
    """Cantilever rolled up by a moment at its tip."""
    scene = rigid(load_scene("roll-up"))
    length = scene.beams[0].length

    def tip(response: Response) -> tuple[float, ...]:
        at_quarter, at_half, at_whole = response.tips["cantilever"][[1, 3, 7]] / length
        return float(at_quarter[0]), float(at_half[1]), float(np.hypot(*at_whole))

    return Problem(
        name="roll-up",
        title="Roll-up by an end moment",
        purpose="Rotations by a full turn, without any force.",
        uncertainty=1e-14,
        scene=scene,
        statement=f"A cantilever, {STRIP_TEXT}, is bent to a full circle by the moment M = 2 pi EI/L at its tip.",
        source="closed form: an arc of the angle t = M L/EI, x/L = sin t / t, y/L = (1 - cos t)/t; Bathe and Bolourchi, "
        "International Journal for Numerical Methods in Engineering 14 (1979), 961-986",
        quantities=(
            Quantity(name="x/L of the tip, a quarter of a circle", exact=2.0 / np.pi),
            Quantity(name="y/L of the tip, half a circle", exact=2.0 / np.pi),
            Quantity(name="distance of the tip from the clamp over L, a full circle", exact=0.0, scale=1.0),
        ),
        trials=(
            on_scene(EXACT, 2e-9, ROUND_OFF, tip, TURNED),
            on_scene(mixed(20), 1e-6, FOURTH, tip, TURNED),
            on_scene(paper(20), 3e-3, SECOND, tip, TURNED),
        ),
        picture=Picture(axes=MM, curves=undeformed(scene)),
    )

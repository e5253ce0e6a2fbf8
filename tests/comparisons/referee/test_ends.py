"""Certificates where a round pin comes to the end of a beam, or a point into it from behind."""

import math

import numpy as np
import pytest

from comparisons.referee import Verdict, certify
from comparisons.response import Response
from comparisons.scene import Scene, read_scene
from tests.comparisons.referee.forged import bent, stated

SCENE = """
[scene]
name = "nose"
units = "N, mm"
load_parameters = 1
[[beam]]
name = "b"
start = [0, 0]
end = [40, 0]
clamped = ["start"]
width = 5
height = 0.8
youngs_modulus = 2e5
poissons_ratio = 0.3
[[pin]]
name = "ball"
start = [{x}, -4]
displacement = [0, {rise}]
{radius}
[[contact]]
node = "ball"
beam = "b"
side = "right"
surface = "{surface}"
"""
CORNER = 4.0 - 0.4 - math.sqrt(2.5**2 - 0.5**2)
"""Rise at which the ball touches the corner (40, -.4)."""


def untouched(x: float, rise: float, radius: float, surface: str) -> tuple[Response, Scene]:
    """Return the answer in which the beam has not moved."""
    stated_radius = f"radius = {radius}" if radius else ""
    scene = read_scene(SCENE.format(x=x, rise=rise, radius=stated_radius, surface=surface), "nose")
    line = np.stack([np.linspace(0.0, 40.0, 41), np.zeros(41)], axis=1)
    return stated(scene, [bent(scene, 1.0, {"b": line})]), scene


@pytest.mark.parametrize(
    ("x", "rise", "radius", "surface", "inside"),
    [
        (40.5, CORNER - 1e-7, 2.5, "face", False),
        (40.5, CORNER + 1e-7, 2.5, "face", True),
        (40.5, 4.0, 2.5, "face", True),
        (42.5 + 1e-7, 4.0, 2.5, "face", False),
        (42.5 - 1e-7, 4.0, 2.5, "face", True),
        (40.5, 4.0, 2.5, "axis", True),
        (42.5 + 1e-7, 4.0, 2.5, "axis", False),
        (39.5, 4.2, 0.0, "face", True),
        (40.5, 4.2, 0.0, "face", False),
    ],
)
def test_what_is_inside_the_end_of_a_beam_is_inadmissible(
    x: float, rise: float, radius: float, surface: str, inside: bool
) -> None:
    found = certify(*untouched(x, rise, radius, surface), at=[0])
    assert (found.judged[0].verdict is Verdict.INADMISSIBLE) == inside, found.line()
    if inside:
        assert (
            "overlaps the end of the beam" in found.judged[0].reason
            or "inside the beam" in found.judged[0].reason
        )

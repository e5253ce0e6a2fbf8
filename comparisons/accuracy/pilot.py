"""The few load parameters at which resolutions are compared before the scene is solved at all of them."""

from dataclasses import replace

from comparisons.scene import Scene

FEWEST = 8
"""Least number of load parameters of a pilot, if the scene has as many."""
SAFETY = 2.0
"""Safety factor of an estimate, because the error between the load parameters of a pilot may be larger than at them."""


def pilot(scene: Scene) -> Scene:
    """Return the scene with fewer load parameters. Their number is a divisor of the scene's, so that the scene has all of them."""
    n = scene.load_parameters
    return replace(scene, load_parameters=next(m for m in range(min(FEWEST, n), n + 1) if n % m == 0))

"""The few load parameters at which resolutions are compared before the scene is solved at all of them."""

from dataclasses import replace

from comparisons.scene import Scene

FEWEST = 8
"""Load parameters that a pilot has at least, if the scene has as many."""
SAFETY = 2.0
"""The error between a pilot's load parameters may be larger than at them."""


def pilot(scene: Scene) -> Scene:
    """Return the scene with some of its load parameters only: a divisor of their number, so that all are shared."""
    n = scene.load_parameters
    return replace(scene, load_parameters=next(m for m in range(min(FEWEST, n), n + 1) if n % m == 0))

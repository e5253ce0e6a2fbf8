"""The contact force at the end of the main scene over the coefficient of friction."""

from dataclasses import replace

import numpy as np

from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.response import Array
from comparisons.scene import Scene, load_scene

COEFFICIENTS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)


def rubbing(friction: float, load_parameters: int = 1, material: str | None = None) -> Scene:
    """Return the main scene with a coefficient of friction, and with another material of the solid."""
    scene = load_scene("ks-friction")
    beam = scene.beams[0]
    return replace(
        scene,
        load_parameters=load_parameters,
        beams=(replace(beam, material=material or beam.material),),
        contacts=(replace(scene.contacts[0], friction=friction),),
    )


def forces_over_friction(model: str, options: Options | None = None, material: str | None = None) -> Array:
    """Return the contact force at the end for every one of `COEFFICIENTS`; nan where the answer is not complete and checked."""
    found = []
    for friction in COEFFICIENTS:
        response = solve(rubbing(friction, material=material), model, options or Options())
        (contact,) = response.contacts.values()
        found.append(float(contact.force[-1]) if response.completed else np.nan)
    return np.array(found)

"""What beam theory itself leaves out, estimated from a solution."""

import numpy as np

from comparisons.accuracy.answer import Theory
from comparisons.response import Response
from comparisons.scene import Scene

LOOKED_AT = 8
"""States that are searched for the largest strain."""


def beam_theory(response: Response, scene: Scene) -> Theory | None:
    """Return the size of the difference between beams and the solids that they stand for.

    A section of height h that stays plane misses terms of second order in the strain ``h kappa/2`` at the faces and in ``h/l``,
    with l the beam's length; taken is the larger one of half the first square and the second. On the main scene it is
    measured (`crossval study thin-beams`): 8.6e-4, 2.1e-4, 5.7e-5 for h/L = .02, .01, .005, estimated 1.0e-3, 2.5e-4, 6.3e-5.
    The material's law is not in it.

    Returns
    -------
    Theory or None
        None where no beam's height is known, or nothing was reached.
    """
    heights = {beam.name: beam.height for beam in scene.beams if beam.height is not None}
    if not heights or not len(response.load_parameter):
        return None
    strain = kink = slender = 0.0
    for number, beam in enumerate(scene.beams):
        if beam.name not in heights:
            continue
        slender = max(slender, heights[beam.name] / beam.length)
        for k in np.unique(np.linspace(0, len(response.load_parameter) - 1, LOOKED_AT).astype(int)):
            data = response.grid(k).point_data
            moment = data["M"][data["beam"] == number]
            strain = max(strain, heights[beam.name] / 2 * float(np.abs(moment).max()) / beam.EI)
        for contact in scene.contacts:
            if contact.beam == beam.name:
                kink = max(kink, float(np.abs(response.contacts[contact.pair].force).max()) / beam.GA)
    return Theory(error=max(strain**2 / 2, slender**2), slenderness=slender, strain=strain, kink=kink)

"""Estimate of the error of beam theory, from a solution."""

import numpy as np

from comparisons.accuracy.answer import Theory
from comparisons.response import Response
from comparisons.scene import Scene

LOOKED_AT = 8
"""Number of states that are searched for the largest strain."""


def beam_theory(response: Response, scene: Scene) -> Theory | None:
    """Return an estimate of the difference between beams and the solid bodies that they approximate.

    Plane sections of height h neglect terms of second order in the face strain ``h kappa/2`` and in ``h/l``, with l the beam's length.
    The estimate is the larger of half the first square and the second square. The effect of the material law is not included.
    On the main scene, `crossval study thin-beams` prints the differences 8.6e-4, 2.1e-4 and 5.7e-5 for h/L = .02, .01 and .005.
    The estimates are 1.0e-3, 2.5e-4 and 6.3e-5.

    Returns
    -------
    Theory or None
        None if no beam's height is known, or no load parameter was reached.
    """
    heights = {beam.name: beam.rectangle_height for beam in scene.beams if beam.height is not None}
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

"""Estimate of the error of beam theory, from a solution."""

import numpy as np

from comparisons.accuracy.answer import Theory
from comparisons.response import Array, Response
from comparisons.scene import BeamSpec, Scene

LOOKED_AT = 8
"""Number of states that are searched for the largest strain."""


def beam_theory(response: Response, scene: Scene) -> Theory | None:
    """Return an estimate of the difference between beams and the solid bodies that they approximate.

    Plane sections of height h neglect terms of second order in the face strain ``h kappa/2`` and in ``h/l``, with l the beam's length,
    or the radius of its undeformed arc if that is smaller. A section that tapers has its own height and stiffness at every place.
    The estimate is the larger of half the first square and the second square. The effect of the material law is not included.
    On the main scene, `crossval run thin-beams` prints the differences 8.6e-4, 2.1e-4 and 5.7e-5 for h/L = .02, .01 and .005.
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
        slender = max(slender, heights[beam.name] * max(1.0 / beam.length, abs(beam.curvature)))
        for k in np.unique(np.linspace(0, len(response.load_parameter) - 1, LOOKED_AT).astype(int)):
            data = response.grid(k).point_data
            own = data["beam"] == number
            strain = max(strain, _face_strain(beam, data["arc"][own], data["M"][own]))
        for contact in scene.contacts:
            if contact.beam == beam.name:
                kink = max(kink, float(np.abs(response.contacts[contact.pair].force).max()) / beam.GA)
    return Theory(error=max(strain**2 / 2, slender**2), slenderness=slender, strain=strain, kink=kink)


def _face_strain(beam: BeamSpec, arc: Array, moment: Array) -> float:
    """Return the largest bending strain at a face, ``h M/(2 EI)``, at arc lengths with their moments, shape (m,)."""
    if not beam.tapers:
        return beam.rectangle_height / 2 * float(np.abs(moment).max()) / beam.EI
    parts = np.clip(arc / beam.length, 0.0, 1.0).tolist()
    compliance = [beam.height_at(part) / (2.0 * beam.stiffness(part)[2]) for part in parts]
    return float(np.abs(moment * compliance).max())

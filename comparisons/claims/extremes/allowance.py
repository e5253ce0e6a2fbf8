"""The allowed error of a model in a cell, fixed before any run."""

import numpy as np

from comparisons.cases.case import Case
from comparisons.claims.claim import Allowance
from comparisons.models import MODELS
from comparisons.models.theory import Bending
from comparisons.response import Response
from comparisons.scene import BeamSpec

LARGEST = 0.2
"""Largest allowed error for any model; an answer with a larger error should have stopped."""


def bending(beam: BeamSpec, exact: Response) -> Bending:
    """Return the bending of `beam`, clamped along +x, in the answer `exact`."""
    if not len(exact.load_parameter):
        return Bending()
    clamp = exact.supports[f"{beam.name}.start"]
    force, moment = -clamp.force, np.abs(clamp.moment)
    loaded = np.hypot(*force.T) > 0.0
    # beyond a right angle the moment is largest where the axis points along the force, and there m^2 = 2 F EI
    turn = np.abs(np.arctan2(-force[loaded, 0], force[loaded, 1]))
    inner = np.where(turn > np.pi / 2, np.sqrt(2 * np.hypot(*force[loaded].T) * beam.EI), 0.0)
    largest_moment = max(float(moment.max(initial=0.0)), float(inner.max(initial=0.0)))
    arcs = [np.fmin.reduce(contact.arc_position, initial=beam.length) for contact in exact.contacts.values()]
    return Bending(
        force=float(np.hypot(*force.T).max(initial=0.0)) * beam.length**2 / beam.EI,
        curvature=largest_moment * beam.length / beam.EI,
        turn=float(turn.max(initial=0.0)),
        nearest=float(min(arcs, default=beam.length)) / beam.length,
    )


def allowance(case: Case, bent: Bending) -> Allowance:
    """Return the error allowed to `case` against the Reissner rod that bends as `bent` says, `LARGEST` at most.

    A model of another rod, as the elastica, is allowed a larger error, because it does not approximate this rod.
    """
    model = MODELS[case.model]
    parts = model.error_parts(case.scene, case.options, bent)
    largest = max(parts, key=lambda why: parts[why])
    error = sum(parts.values())
    if model.rod and not error <= LARGEST:
        return Allowance(error=LARGEST, why=f"more is wrong, although theory allows it: {largest}")
    return Allowance(error=error, why=largest)

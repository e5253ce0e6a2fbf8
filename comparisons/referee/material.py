"""The balance of material force: how much friction an answer's reactions show."""

import math

import numpy as np

from comparisons.referee.start import Given
from comparisons.referee.state import Equilibrium
from comparisons.scene import Scene


def friction(scene: Scene, given: Given, exact: Equilibrium) -> float:
    """Return the sum of the tangential contact forces on a clamped beam, over its largest contact force; nan where it does not hold.

    Along a uniform rod ``H = m^2/2EI + N + N^2/2EA + Q^2/2GA`` is constant but for contacts, where it falls by the tangential force times
    ``|r'_- + r'_+|/2``; a free end has H = 0. So H at the clamp, from the three stated reactions alone, is what a frictionless
    answer must not have. It holds for one beam, clamped at one end, with nothing but contacts besides.
    """
    beam = scene.beams[0]
    if len(scene.beams) > 1 or scene.loads or len(scene.all_supports) != 1 or not exact.contacts:
        return math.nan
    clamp = scene.all_supports[0]
    if len(clamp.held) < 3:
        return math.nan
    x, y, moment = given.reactions[clamp.node]
    sign = -1.0 if clamp.end == "start" else 1.0
    turn = exact.turned(clamp.node)[2] + math.atan2(*beam.direction[::-1])
    n = sign * np.array([x, y])
    N, Q = n[0] * math.cos(turn) + n[1] * math.sin(turn), n[1] * math.cos(turn) - n[0] * math.sin(turn)
    H = moment**2 / (2.0 * beam.EI) + N + N**2 / (2.0 * beam.EA) + Q**2 / (2.0 * beam.GA)
    largest = max(float(np.hypot(*contact.force)) for contact in exact.contacts.values())
    return float(abs(H) / largest) if largest > 0.0 else math.nan

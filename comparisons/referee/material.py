"""The balance of material forces: the friction that the reactions of an answer imply."""

import math

import numpy as np

from comparisons.referee.start import AnswerState
from comparisons.referee.state import Equilibrium
from comparisons.scene import Scene


def friction(scene: Scene, answer: AnswerState, exact: Equilibrium) -> float:
    """Return the sum of the tangential contact forces on a beam over its largest contact force; nan if undefined.

    Along a uniform rod ``H = m^2/2EI + N + N^2/2EA + Q^2/2GA`` is constant, except at a contact, where it decreases by the tangential
    force times ``|r'_- + r'_+|/2``. At a free end H = 0. Without friction H therefore vanishes at the clamp, where it follows from
    the three reactions of the answer. The result is defined for one beam that is clamped at one end and loaded by contacts only.
    """
    beam = scene.beams[0]
    if len(scene.beams) > 1 or scene.loads or len(scene.all_supports) != 1 or not exact.contacts:
        return math.nan
    clamp = scene.all_supports[0]
    if len(clamp.held) < 3:
        return math.nan
    x, y, moment = answer.reactions[clamp.node]
    sign = -1.0 if clamp.end == "start" else 1.0
    turn = exact.pose(clamp.node)[2] + math.atan2(*beam.direction[::-1])
    n = sign * np.array([x, y])
    N, Q = n[0] * math.cos(turn) + n[1] * math.sin(turn), n[1] * math.cos(turn) - n[0] * math.sin(turn)
    H = moment**2 / (2.0 * beam.EI) + N + N**2 / (2.0 * beam.EA) + Q**2 / (2.0 * beam.GA)
    largest = max(float(np.hypot(*contact.force)) for contact in exact.contacts.values())
    return float(abs(H) / largest) if largest > 0.0 else math.nan

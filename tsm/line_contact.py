"""Where a contact surface stops touching at a single point.

A node at a distance d from the axis touches at one point while the beam bends less than a circle of radius d: for a round pin of radius R
on the face of a beam of height h, ``d = R + h/2``. Where the curvature reaches 1/d, the distance to the node is no longer least at the
contact point, and the beam would touch along a line.
"""

from __future__ import annotations

from tsm.model import Model
from tsm.newton import Equilibrium


def curvature(model: Model, equilibrium: Equilibrium, k: int) -> float:
    """Curvature of the axis at closed pair k, ``theta'/(1 + e)`` with ``theta' = m/EI``, positive where the beam bends round the node."""
    pair, touch = model.pairs[k], equilibrium.state.touches[k]
    assert touch is not None, "a closed pair has a touch"
    system = equilibrium.system
    forces, push = system.groups[pair.group.number], system.forces[k]
    return -pair.side * pair.group.curvature(k, touch, equilibrium.state, forces, push)

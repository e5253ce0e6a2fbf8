"""Where a contact surface stops touching at a single point.

A node at a distance d from the axis touches at one point while the beam bends less than a circle of radius d: for a round pin of radius R
on the face of a beam of height h, ``d = R + h/2``. Where the curvature reaches 1/d, the distance to the node is no longer least at the
contact point, and the beam would touch along a line.
"""

from __future__ import annotations

import math

from tsm.model import Model
from tsm.newton import Equilibrium
from tsm.state import Touch


def curvature(model: Model, equilibrium: Equilibrium, k: int) -> float:
    """Curvature of the axis at closed pair k, ``theta'/(1 + e)`` with ``theta' = m/EI``, positive where the beam bends round the node."""
    pair, touch = model.pairs[k], equilibrium.state.touches[k]
    assert touch is not None, "a closed pair has a touch"
    m, stretch = _cut(model, equilibrium, k, touch) if pair.cuts else _inside(model, equilibrium, k, touch)
    return float(-pair.side * m / model.element[touch.element].EI / (1 + stretch))


def _cut(model: Model, equilibrium: Equilibrium, k: int, touch: Touch) -> tuple[float, float]:
    """Moment and stretch where an exact element is cut."""
    balance, profile = equilibrium.system.rods, equilibrium.state.profile
    assert balance is not None, "an exact element has a balance"
    assert profile is not None, "an exact element has a profile"
    place = int(model.place[touch.element])
    pairs = dict(profile.cuts)[place]
    s = int(balance.entry.place.first[place]) + pairs.index(k)
    fx, fy = (float(row[s, 0] + row[s + 1, 0]) / 2 for row in balance.entry.at.force)
    axial = fx * math.cos(touch.angle) + fy * math.sin(touch.angle)
    return float(balance.entry.moment[s + 1, 0]), axial / model.element[touch.element].EA


def _inside(model: Model, equilibrium: Equilibrium, k: int, touch: Touch) -> tuple[float, float]:
    """Moment and stretch at a contact inside an element in closed form, from the forces at its end i and the lever of the contact."""
    state, pair, p = equilibrium.state, model.pairs[k], model.element[touch.element]
    x = state.q[model.dofs[:, touch.element]].tolist()
    fx, fy, moment = equilibrium.system.closed_force[:3, model.place[touch.element]].tolist()
    dx, dy = p.dx0 + x[3] - x[0], p.dy0 + x[4] - x[1]
    chord = math.hypot(dx, dy)
    push = equilibrium.system.forces[k]
    size = math.hypot(*push)
    away = (push[0] / size, push[1] / size) if size > 0 else (-pair.side * dy / chord, pair.side * dx / chord)
    cx, cy = model.node_position(pair, state.q, state.load_parameter)
    start_x, start_y = model.element_start[touch.element]
    rx = cx + pair.pair.offset * away[0] - start_x - x[0]
    ry = cy + pair.pair.offset * away[1] - start_y - x[1]
    return -moment + rx * fy - ry * fx, -(fx * dx + fy * dy) / (chord * p.EA)

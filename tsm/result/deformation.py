"""Largest bending and strain of the elements along the path, for comparison with the limits of their approximations."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tsm.contact.events import normal_force
from tsm.elements.properties import Array, Properties
from tsm.model.model import Model
from tsm.system.equilibrium import Equilibrium


@dataclass(frozen=True, kw_only=True, eq=False)
class Deformation:
    """The most deformed element at every accepted step, between the prescribed load parameters too; exact elements do not count.

    Turn is the largest angle by which an element bends between its ends [rad]. For an element in contact the
    angle is at least ``F min(a, b) l/EI``, the bend under a constant moment of the contact force, with the
    distances a and b of the contact from the ends of the element. Of a curved or tapered beam, or one with a
    load along it, it is the angle between the ends of a segment. Strain is the section force, or contact
    force inside the element, over the smaller of EA and GA; over EA where the element does not shear.
    """

    load_parameter: Array  # load parameter of every accepted step; shape (n,)
    turn: Array  # turn, strain: shape (n,)
    strain: Array
    bearable: float  # least turn up to which the elements are an approximation [rad]


def deformation(model: Model, equilibria: Sequence[Equilibrium]) -> Deformation | None:
    """Return turn and strain at every equilibrium; None if all elements are exact, because exact elements have no limit."""
    bearable = min(beam.kind.bearable_turn for beam in model.beams.values())
    if bearable == math.inf:
        return None
    turn, strain = np.zeros((2, len(equilibria)))
    for group in model.groups:
        if group.internal:
            entries = (one.system.groups[group.number].entry for one in equilibria)  # type: ignore[attr-defined]
            turn = np.maximum(turn, [np.abs(entry.end - entry.start).max() for entry in entries])
        else:
            turns, strain = _closed_form(model, equilibria, group.number)
            turn = np.maximum(turn, turns)
    return Deformation(
        load_parameter=np.array([one.state.load_parameter for one in equilibria]),
        turn=turn,
        strain=strain,
        bearable=bearable,
    )


def _closed_form(model: Model, equilibria: Sequence[Equilibrium], number: int) -> tuple[Array, Array]:
    """Turn and strain of the elements in closed form."""
    p = Properties(*(column[model.closed] for column in model.properties))
    with np.errstate(divide="ignore"):
        stiffness = np.minimum(p.EA, 12 * p.EI / (p.Phi * p.l0**2))
    start, end = model.element_nodes[model.closed].T
    turn, strain = np.zeros((2, len(equilibria)))
    for n, equilibrium in enumerate(equilibria):
        rotation, force = equilibrium.state.q[2::3], equilibrium.system.groups[number].ends
        turn[n] = np.abs(rotation[end] - rotation[start]).max(initial=0.0)
        at_ends = np.maximum(np.hypot(force[0], force[1]), np.hypot(force[3], force[4]))
        strain[n] = (at_ends / stiffness).max(initial=0.0)
        for k, touch in enumerate(equilibrium.state.touches):
            if touch is None or model.pairs[k].cuts:
                continue
            e, pressed = int(model.place[touch.element]), normal_force(equilibrium, k)
            arm = p.l0[e] * min(max(touch.xi, 0.0), max(1.0 - touch.xi, 0.0))
            turn[n] = max(turn[n], pressed * arm * p.l0[e] / p.EI[e])
            strain[n] = max(strain[n], pressed / stiffness[e])
    return turn, strain

"""Mechanisms: structures with hinges that can move without strain."""

from __future__ import annotations

import math

from tsm.contact_set import changed
from tsm.friction import rates
from tsm.newton import Equilibrium, Newton
from tsm.stability import IDLE, loose
from tsm.system import Drive


def mechanism(newton: Newton, equilibrium: Equilibrium, drive: Drive) -> bool:
    """Whether a structure can move without strain as a drive begins.

    A contact without force holds a structure only if it begins to push.

    Parameters
    ----------
    newton : Newton
        Solver of the structure.
    equilibrium : Equilibrium
        The equilibrium in which the drive begins.
    drive : Drive
        What changes.
    """
    model, assembler, state = newton.model, newton.assembler, equilibrium.state
    if loose(assembler, state, equilibrium.system):
        return True
    by = rates(newton, state, equilibrium.system, drive)
    edge = IDLE * model.force_scale
    for k, (pair, touch) in enumerate(zip(model.pairs, state.touches, strict=True)):
        if by is None or touch is None or pair.slot < 0 or math.hypot(*touch.force) > edge:
            continue
        x, y = pair.group.direction(touch, state.q)
        fx, fy, *_ = by.unknowns[model.equations :][pair.slots]
        if pair.side * (fy * x - fx * y) <= edge:
            state = changed(model, state, k, None, armed=True)
    return state is not equilibrium.state and loose(assembler, state, assembler.linearise(state))

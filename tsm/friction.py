"""Slip and stick of contacts with friction: the rates of the slips, and the state in which a contact goes on.

A contact without force, or whose force lies on the edge of the cone ``|F_t| <= mu F_n``, may stick or slip. Its next state follows from
rates: those of the structure with the contact in that state, as the load parameter grows. Stick is admissible if the force stays in the
cone, slip if the surfaces slip the way in which the friction was taken.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice, product
from typing import NamedTuple

from tsm.elements.properties import Array
from tsm.model import Model
from tsm.newton import Equilibrium, Newton
from tsm.state import UNDECIDED, Grip, State, Traction
from tsm.status import Status
from tsm.system import Drive, Linearisation

_EDGE = 1e-9
"""Distance of a force from the edge of the cone, over ``EI/L^2``, that counts as zero."""
_NOISE = 1e-13
"""Rate of a force, over the largest EA, that is round-off: that of a contact which turns a beam without bending it."""
_STILL = 1e-9
"""Slip rate, in longest beams per whole load, that counts as zero."""
_FLAT = 1e-6
"""Rate at which a force leaves its cone, in ``EI/L^2`` per whole load, that counts as zero. Where a slip ends, the force moves along the cone.
A slip at the rate `_STILL` moves the force of a stick by up to EA times this rate, which counts as zero where no other state is admissible."""
_MOST = 4096
"""Combinations of states that are tried: six contacts without force."""


class Rates(NamedTuple):
    """Derivatives in the load parameter."""

    system: Linearisation  # the configuration
    unknowns: Array  # derivatives of the unknowns; shape (equations + contact unknowns,)
    stage: int  # number of the stage, from 0


def traction(model: Model, state: State, system: Linearisation, k: int) -> Traction:
    """Force and place of closed pair k, which has friction."""
    pair = model.pairs[k]
    return pair.group.traction(k, state, system.groups[pair.group.number])


def cone(model: Model, state: State, system: Linearisation, k: int) -> float:
    """Distance of the force of closed pair k from the edge of its cone, ``mu F_n - |F_t|``."""
    here = traction(model, state, system, k)
    return model.pairs[k].pair.friction * here.normal - abs(here.tangential)


def rates(newton: Newton, system: Linearisation, drive: Drive) -> Rates | None:
    """Derivatives in the load parameter under a drive, None where the tangent is singular."""
    solved = newton.assembler.solve(system, -newton.assembler.rate(system, drive))
    return None if solved is None else Rates(system, solved[:, 1], drive.stage)


def slip_rate(newton: Newton, state: State, by: Rates, k: int) -> float:
    """Slip rate of closed pair k."""
    model = newton.model
    pair = model.pairs[k]
    dofs = newton.assembler.prescribed_rate(by.stage)
    dofs[model.free] = by.unknowns[: model.equations]
    tangent = by.system.tangent.groups[pair.group.number]
    return pair.group.slip_rate(k, state, tangent, dofs, by.unknowns[model.equations :])


def slip_rates(newton: Newton, equilibrium: Equilibrium, drive: Drive) -> dict[int, float]:
    """Rates of all pairs that slip, positive the way they slip; none where the tangent is singular."""
    state = equilibrium.state
    slipping = [(k, grip.slip) for k, grip in grips(state) if grip.slip]
    by = rates(newton, equilibrium.system, drive) if slipping else None
    return {} if by is None else {k: slip * slip_rate(newton, state, by, k) for k, slip in slipping}


def regripped(newton: Newton, state: State, drive: Drive, last: State) -> State | Status:
    """State in equilibrium whose contacts with friction slip or stick as the load parameter grows.

    Where a slip ends, its rate is zero, and the force of the stick that follows moves along the cone: its rate out of the cone is round-off.

    ``drive``: what changes. ``last``: the same configuration before its contacts changed. Returns JAMMED if
    no state of the contacts is admissible, TWO_SLIPS if a contact without force could slip either way.
    """
    system = newton.assembler.linearise(state)
    here = {k: traction(newton.model, state, system, k) for k, _ in grips(state)}
    # a contact that has just closed has a force of round-off, which may be considerable near a support
    here |= {k: here[k]._replace(tangential=0.0, normal=0.0) for k, grip in grips(state) if grip == UNDECIDED}
    choices = [[(k, grip) for grip in _choices(newton.model, k, grip, here[k])] for k, grip in grips(state)]
    stiff = max(beam.section.EA for beam in newton.model.structure.beams)
    # the round-off of a slip rate is a force in a stiff beam, so more is allowed where a slip ends, and where nothing else is admissible
    flat = _FLAT * newton.model.force_scale
    slipped = {k for k, grip in grips(last) if grip.slip}
    ended = {k for k, grip in grips(state) if not grip.slip and k in slipped}
    for least in (flat, flat + _STILL * stiff):
        leaving = {k: flat + _STILL * stiff if k in ended else least for k in here}
        for chosen in islice(product(*choices), _MOST):
            if not _admissible(newton, with_grips(state, chosen), drive, here, leaving):
                continue
            for other in _reversed(newton.model, chosen, here):
                if _admissible(newton, with_grips(state, other), drive, here, leaving):
                    return Status.TWO_SLIPS
            return with_grips(state, chosen)
    return Status.JAMMED


def turned(model: Model, state: State, system: Linearisation, k: int) -> State:
    """State in which pair k sticks where it slipped, or slips the way of its force where it stuck."""
    touch = state.touches[k]
    assert touch is not None, "only a closed contact slips or sticks"
    here = traction(model, state, system, k)
    slips = touch.grip is not None and touch.grip.slip
    return with_grips(state, ((k, Grip(0, here.place) if slips else Grip(here.way, None)),))


def same(before: Grip, after: Grip) -> bool:
    """Whether a contact goes on as before; one that has just closed has no state before."""
    return before == UNDECIDED or before.slip == after.slip


def grips(state: State) -> list[tuple[int, Grip]]:
    """Numbers and states of the closed contacts with friction."""
    return [
        (k, touch.grip)
        for k, touch in enumerate(state.touches)
        if touch is not None and touch.grip is not None
    ]


def with_grips(state: State, grips: tuple[tuple[int, Grip], ...]) -> State:
    """State whose contacts slip or stick otherwise."""
    touches = list(state.touches)
    for k, grip in grips:
        touch = touches[k]
        assert touch is not None, "only a closed contact slips or sticks"
        touches[k] = replace(touch, grip=grip)
    return replace(state, touches=tuple(touches))


def _idle(model: Model, here: Traction) -> bool:
    return math.hypot(here.tangential, here.normal) <= _EDGE * model.force_scale


def _choices(model: Model, k: int, grip: Grip, here: Traction) -> list[Grip]:
    """States in which a contact may go on, the likely one first. A contact without force that opens is undecided up to there."""
    stick = grip if grip.held is not None else Grip(0, here.place)
    if _idle(model, here):
        return [stick, Grip(1, None), Grip(-1, None), UNDECIDED]
    if model.pairs[k].pair.friction * here.normal - abs(here.tangential) > _EDGE * model.force_scale:
        return [stick]
    slip = Grip(here.way, None)
    return [slip, stick] if grip.slip else [stick, slip]


def _reversed(
    model: Model, chosen: tuple[tuple[int, Grip], ...], here: dict[int, Traction]
) -> Iterator[tuple[tuple[int, Grip], ...]]:
    """The same states with the slip of one contact without force reversed."""
    for n, (k, grip) in enumerate(chosen):
        if grip.slip and _idle(model, here[k]):
            yield (*chosen[:n], (k, Grip(-grip.slip, None)), *chosen[n + 1 :])


def _admissible(
    newton: Newton, state: State, drive: Drive, here: dict[int, Traction], leaving: dict[int, float]
) -> bool:
    """Whether the structure can go on with its contacts as they are stated; forces may leave their cones at the rates `leaving`."""
    model = newton.model
    by = rates(newton, newton.assembler.linearise(state), drive)
    if by is None:
        return not here
    for k, grip in grips(state):
        if _idle(model, here[k]) and not _grows(model, k, here[k], by, grip):
            return False
        if grip.slip:
            if grip.slip * slip_rate(newton, state, by, k) <= _STILL * model.length:
                return False
        elif not _idle(model, here[k]) and cone(model, state, by.system, k) <= _EDGE * model.force_scale:
            slipping = with_grips(state, ((k, Grip(here[k].way, None)),))
            if here[k].way * _row_rate(newton, slipping, by, k) > leaving[k]:
                return False
    return True


def _grows(model: Model, k: int, here: Traction, by: Rates, grip: Grip) -> bool:
    """Whether the force of a contact without force grows as its state says: into its cone, or below zero where it opens."""
    pair = model.pairs[k]
    fx, fy = by.unknowns[model.equations :][pair.slots][:2]
    c, s = math.cos(here.place.direction), math.sin(here.place.direction)
    tangential, normal = fx * c + fy * s, pair.side * (fy * c - fx * s)
    stiff = max(beam.section.EA for beam in model.structure.beams)
    edge = _EDGE * model.force_scale + _NOISE * stiff
    if grip == UNDECIDED:
        return bool(normal < -edge)
    return bool(normal >= -edge if grip.slip else abs(tangential) <= pair.pair.friction * normal + edge)


def _row_rate(newton: Newton, slipping: State, by: Rates, k: int) -> float:
    """Derivative of ``F_t - sigma mu F_n``, times a positive number, along rates that do not hold it at zero."""
    model, slot = newton.model, newton.model.pairs[k].slot + 2
    system, aside = newton.assembler.linearise(slipping), model.border_dofs
    held, tangent = newton.assembler.rate(system)[model.equations + slot], system.tangent
    along = tangent.below[aside + slot, : model.equations] @ by.unknowns[: model.equations]
    row = held + along + tangent.corner[aside + slot, aside:] @ by.unknowns[model.equations :]
    return float(row)

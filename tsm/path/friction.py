"""Slip and stick of contacts with friction: the rates of the slips, and the state in which a contact goes on.

A contact without force, or whose force lies on the edge of the cone ``|F_t| <= mu F_n``, may stick or slip.
Its next state follows from rates: those of the structure with the contact in that state, as the load
parameter grows. Stick is admissible if the force stays in the cone, slip if the surfaces slip the way in
which the friction was taken.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import islice, product

import numpy as np

from tsm.contact.events import ROUND_OFF, traction
from tsm.model import scales
from tsm.model.model import Model
from tsm.model.state import UNDECIDED, Grip, State, Traction, touch_of
from tsm.statement.status import Status, StopError
from tsm.system.equilibrium import Equilibrium, Rates
from tsm.system.system import Drive

_EDGE = 1e-9
"""Distance of a force from the edge of the cone, over ``EI/L^2``, that counts as zero, unless round-off is more."""
_NOISE = 1e-13
"""Rate of a force, over the largest EA, that is round-off: that of a contact which turns a beam without bending it."""
_STILL = 1e-9
"""Slip rate, in longest beams per whole load, that counts as zero, unless no other state is admissible."""
_FLAT = 1e-6
"""Rate at which a force leaves its cone, in ``EI/L^2`` per whole load, that counts as zero. Where a slip ends, the
force moves along the cone. A slip at the rate `_STILL` moves the force of a stick by up to EA times this
rate, which counts as zero where no other state is admissible."""
_MOST = 4096
"""Combinations of states that are tried: six contacts without force."""

Grips = dict[int, Grip]
"""States of contacts by their numbers."""


def cone(point: Equilibrium, k: int) -> float:
    """Distance of the force of closed pair k from the edge of its cone, ``mu F_n - |F_t|``."""
    return _inside(point.model, k, traction(point, k))


def _inside(model: Model, k: int, here: Traction) -> float:
    return model.pairs[k].pair.friction * here.normal - abs(here.tangential)


def least_push(point: Equilibrium, k: int) -> float:
    """Force of closed pair k that is round-off: of the touched beam, which may be far softer than others, unless a beam's end touches it."""
    newton, model, pair = point.newton, point.model, point.model.pairs[k]
    beam, section = pair.target.beam, pair.target.beam.section
    own = max(ROUND_OFF, newton.tolerance) * section.EI / beam.length**2
    # that of positions is a stretch of the beam
    places = max(beam.elements, float(np.abs(model.coordinates).max()) / beam.length)
    noise = scales.ROUND_OFF * section.EA * places
    return float(max(own, noise if pair.node < 0 else newton.noise * model.least_force))


def leaves_cone(point: Equilibrium, k: int, drive: Drive) -> bool:
    """Whether the force of closed pair k, which sticks on the edge of its cone but for round-off, leaves it by its rate."""
    by, stick, flat = point.rates(drive), grips(point.state)[k], _flat(point.model)[1]
    return by is not None and not _lasts(point, by, k, stick, traction(point, k), flat)


def slip_rate(point: Equilibrium, rates: Rates, k: int) -> float:
    """Slip rate of closed pair k."""
    rods = point.model.rods
    assert rods is not None, "a contact with friction cuts its element"
    return rods.slip_rate(k, point.system.tangent.groups[rods.number], rates.dofs, rates.contacts)


def regripped(point: Equilibrium, drive: Drive, last: State) -> Equilibrium:
    """Equilibrium whose contacts with friction slip or stick as the load parameter grows, after a state `last`.

    Where a slip ends, its rate is zero, and the force of the stick that follows moves along the cone: its
    rate out of the cone is round-off. Raises StopError with JAMMED if no state of the contacts is admissible,
    with TWO_SLIPS if a contact without force could slip either way.
    """
    model, now = point.model, grips(point.state)
    if not now:
        return point
    here = {k: traction(point, k) for k in now}
    # a contact that has just closed has a force of round-off, which may be considerable near a support
    here |= {k: here[k]._replace(tangential=0.0, normal=0.0) for k, grip in now.items() if grip == UNDECIDED}
    flat = _flat(model)
    ended = {k for k, grip in grips(last).items() if grip.slip and k in now and not now[k].slip}
    choices = (_choices(point, k, grip, here[k]) for k, grip in now.items())
    every = [dict(zip(now, chosen, strict=True)) for chosen in islice(product(*choices), _MOST)]
    for least, still in zip(flat, (_STILL * model.length, 0.0), strict=True):
        leaving = {k: flat[1] if k in ended else least for k in here}
        goes_on = partial(_going_on, point, drive, here, leaving, still)
        for chosen in every:
            if going := goes_on(chosen):
                if any(map(goes_on, _reversed(point, chosen, here))):
                    raise StopError(Status.TWO_SLIPS)
                return going
    raise StopError(Status.JAMMED)


def turned(point: Equilibrium, k: int) -> Grip:
    """State of pair k that sticks where it slipped, or slips the way of its force where it stuck, which round-off does not have."""
    here = traction(point, k)
    if grips(point.state)[k].slip:
        return Grip(0, here.place)
    return UNDECIDED if _idle(point, k, here) else Grip(here.way, None)


def grips(state: State) -> Grips:
    """States of the closed contacts with friction, by their numbers."""
    return {
        k: touch.grip for k, touch in enumerate(state.touches) if touch is not None and touch.grip is not None
    }


def with_grips(state: State, grips: Grips) -> State:
    """State whose contacts slip or stick otherwise."""
    touches = list(state.touches)
    for k, grip in grips.items():
        touches[k] = replace(touch_of(state, k), grip=grip)
    return replace(state, touches=tuple(touches))


def _stiffest(model: Model) -> float:
    return max(beam.section.EA for beam in model.structure.beams)


def _flat(model: Model) -> tuple[float, float]:
    """Rates at which a force may leave its cone. More is allowed where a slip ends, and where nothing else is admissible.

    The round-off of a slip rate is a force in a stiff beam.
    """
    flat = _FLAT * model.force_scale
    return flat, flat + _STILL * _stiffest(model)


def _edge(point: Equilibrium, k: int) -> float:
    return max(_EDGE * point.model.force_scale, least_push(point, k))


def _idle(point: Equilibrium, k: int, here: Traction) -> bool:
    return math.hypot(here.tangential, here.normal) <= _edge(point, k)


def _choices(point: Equilibrium, k: int, grip: Grip, here: Traction) -> list[Grip]:
    """States in which a contact may go on, the likely one first. A contact without force that opens is undecided up to there."""
    stick = grip if grip.held is not None else Grip(0, here.place)
    if _idle(point, k, here):
        return [stick, Grip(1, None), Grip(-1, None), UNDECIDED]
    if _inside(point.model, k, here) > _edge(point, k):
        return [stick]
    slip = Grip(here.way, None)
    return [slip, stick] if grip.slip else [stick, slip]


def _reversed(point: Equilibrium, chosen: Grips, here: dict[int, Traction]) -> Iterator[Grips]:
    """The same states with the slip of one contact without force reversed."""
    for k, grip in chosen.items():
        if grip.slip and _idle(point, k, here[k]):
            yield {**chosen, k: Grip(-grip.slip, None)}


def _going_on(
    point: Equilibrium,
    drive: Drive,
    here: dict[int, Traction],
    leaving: dict[int, float],
    still: float,
    chosen: Grips,
) -> Equilibrium | None:
    """Equilibrium with contacts in the chosen states, if they go on: forces leave cones at most at these rates, slips are not still."""
    state = with_grips(point.state, chosen)
    going = point if state.touches == point.state.touches else point.with_state(state)
    by = going.rates(drive)
    lasting = by and all(_lasts(going, by, k, grip, here[k], leaving[k], still) for k, grip in chosen.items())
    return going if lasting else None


def _lasts(
    point: Equilibrium, by: Rates, k: int, grip: Grip, here: Traction, leaving: float, still: float = 0.0
) -> bool:
    """Whether a contact can go on in its state."""
    model, idle = point.model, _idle(point, k, here)
    if idle and not _grows(model, k, here, by, grip):
        return False
    if grip.slip:
        return grip.slip * slip_rate(point, by, k) > still
    if idle or cone(point, k) > _edge(point, k):
        return True
    return here.way * _row_rate(point, by, k, here.way) <= leaving


def _grows(model: Model, k: int, here: Traction, by: Rates, grip: Grip) -> bool:
    """Whether the force of a contact without force grows as its state says: into its cone, or below zero where it opens."""
    pair = model.pairs[k]
    fx, fy = by.contacts[pair.slots][:2]
    c, s = math.cos(here.place.direction), math.sin(here.place.direction)
    tangential, normal = fx * c + fy * s, pair.side * (fy * c - fx * s)
    edge = _EDGE * model.force_scale + _NOISE * _stiffest(model)
    if grip == UNDECIDED:
        return bool(normal < -edge)
    return bool(normal >= -edge if grip.slip else abs(tangential) <= pair.pair.friction * normal + edge)


def _row_rate(point: Equilibrium, by: Rates, k: int, way: int) -> float:
    """Derivative of ``F_t - sigma mu F_n``, times a positive number, along rates that do not hold it at zero."""
    model, assembler = point.model, point.newton.assembler
    slipping, slot = with_grips(point.state, {k: Grip(way, None)}), model.pairs[k].slot + 2
    system, aside = assembler.linearise(slipping), model.border_dofs
    held, tangent = assembler.rate(system)[model.equations + slot], system.tangent
    along = tangent.below[aside + slot, : model.equations] @ by.unknowns[: model.equations]
    return float(held + along + tangent.corner[aside + slot, aside:] @ by.contacts)

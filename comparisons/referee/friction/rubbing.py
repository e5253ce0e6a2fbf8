"""Checks of Coulomb's law: in the numbers that an answer states, in the exact equilibrium, and along the path with what it dissipates."""

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander

from comparisons.answer import Array, Response
from comparisons.answer.round_off import LEAST, least_force
from comparisons.referee.friction.history import History, at_rest
from comparisons.referee.friction.phases import OPEN, UNKNOWN
from comparisons.referee.friction.slip import place, relative_slip_rate, slip_rate
from comparisons.referee.grip import Hold, UnknownFrictionError
from comparisons.referee.layout import Touch
from comparisons.referee.path import SAME, corners, reach
from comparisons.referee.rod import largest, units_of
from comparisons.referee.state import Equilibrium
from comparisons.scene import ContactSpec, Scene

LAW = 1e-6
"""Largest violation of Coulomb's law by the numbers of an answer, over the contact force; the models' tolerances are far smaller."""
ENERGY = 1e-4
"""Largest relative error of work and dissipation in an answer without other differences."""
FALL = 1e-8
"""Largest fall of a dissipation over the work, for the round-off of the models' integrals."""
_SPREAD = 10.0
"""Largest relative error of an energy over the largest difference of the answer, since energies are sums over the path."""
_MOST = 6
"""Number of changes between slip and stick, the latest ones, that are compared with the referee's own."""
_POINTS, _WEIGHTS = leggauss(6)
_LEGENDRE = np.linalg.inv(legvander(_POINTS, len(_POINTS) - 1))
"""From values at the Gauss points to the coefficients of Legendre's polynomials."""
_SMOOTH = 1e-5
"""Largest sum of the last two coefficients over the first; the error of the integral is about its square."""
_DEPTH = 8
"""Number of times that an interval is halved at most."""
_SHORTEST = 1e-12
"""Smallest interval of load parameters that is integrated."""


def unlawful(history: History, k: int, allowed: float) -> Iterator[str]:
    """Yield violations of Coulomb's law by the stated numbers up to a load parameter, the latest first, and moves in stick beyond rolling."""
    response, scene, law = history.response, history.scene, _law(history.response, allowed)
    rubbing = [spec for spec in scene.contacts if spec.friction]
    for earlier in range(k, -1, -1):
        where = "" if earlier == k else f" at load parameter {response.load_parameter[earlier]:.6g}"
        yield from (
            sentence + where for spec in rubbing for sentence in _unlawful(history, spec, earlier, law)
        )
    for spec in rubbing:
        if history.phase(spec.pair, k).slip == 0:
            length, moved = scene.beam(spec.beam).length, _moved(history, spec, k)
            if abs(moved) > law * length + math.pi * scene.offset(spec):
                yield f"{spec.pair} sticks and moves by {moved / length:.2g} L"


def _unlawful(history: History, spec: ContactSpec, k: int, law: float) -> Iterator[str]:
    """Yield the violations of one contact at one load parameter."""
    contact = history.response.contacts[spec.pair]
    force, friction = abs(float(contact.force[k])), contact.friction
    if friction is None or not force:
        return
    drag, push, slip = (float(x[k]) for x in (friction.tangential, friction.normal, friction.slip))
    if not abs(np.hypot(drag, push) - force) <= law * force:
        yield f"the force of {spec.pair} and its tangential and normal components differ"
    beyond = abs(drag) - spec.friction * push if slip == 0.0 else abs(drag - slip * spec.friction * push)
    if beyond > law * max(force, least_force(history.scene) / LEAST):
        does = "sticks with a force outside its cone," if slip == 0.0 else "slips with"
        end = "" if slip == 0.0 else f", not {slip * spec.friction:.6g} F_n"
        yield f"{spec.pair} {does} F_t = {drag / push:.6g} F_n{end}"


def rubs_wrongly(history: History, k: int, exact: Equilibrium, allowed: float) -> Iterator[str]:
    """Yield violations of Coulomb's law by more than `allowed` by the exact equilibrium next to an answer, and its moves in stick."""
    for pair, grip in exact.layout.grips.items():
        contact = exact.contacts[pair]
        outside = abs(contact.drag) - grip.friction * contact.push
        size = max(math.hypot(*contact.force), least_force(history.scene))
        if grip.hold is None:
            if _backwards(exact, pair) > allowed:
                yield f"{pair} slips against the stated direction"
            continue
        if outside > allowed * size:
            yield f"{pair} sticks with an exact force outside its cone, F_t = {contact.drag / contact.push:.6g} F_n"
        moved = _crept(history, k, exact.layout.touches[pair], grip.hold, exact, allowed)
        if moved:
            yield f"{pair} sticks and moves by {moved:.2g} L"


def _crept(history: History, k: int, touch: Touch, hold: Hold, exact: Equilibrium, allowed: float) -> float:
    """Move over the length of a held material point, ``A (s - s*) + lever (psi - psi*) + roll (phi - phi*) = 0``; zero within its bound."""
    # an answer states s alone; the angles are exact, and it knows each of the three terms to its accuracy only
    length = history.scene.beam(touch.spec.beam).length
    here, unit, face = place(exact, touch.spec.pair), exact.layout.length, touch.face
    rolled = unit * (here.arc_position - hold.arc_position)
    sheared = unit * face.lever(here.arc_position) * math.remainder(here.shear - hold.shear, math.tau)
    turned = unit * face.radius * (here.direction - hold.direction)
    moved, most = _moved(history, touch.spec, k) - rolled, max(abs(rolled), abs(sheared), abs(turned))
    return moved / length if abs(moved) > _law(history.response, allowed) * length + allowed * most else 0.0


def _moved(history: History, spec: ContactSpec, k: int) -> float:
    """Change of the stated arc position since the event at which a stick began, or since the start; nan without an event."""
    phase = history.phase(spec.pair, k)
    began = phase.event.arc_position if phase.event else math.nan
    if phase.before is None:
        began = units_of(history.scene)[0] * at_rest(history.scene, spec).arc_position
    return float(history.response.contacts[spec.pair].arc_position[k]) - began


def _law(response: Response, allowed: float) -> float:
    """Largest violation of Coulomb's law by the stated numbers."""
    return allowed if response.outside or response.continuum else LAW


def _backwards(exact: Equilibrium, pair: str) -> float:
    """Slip rate against the sign of the slip, over the speed; at a corner of a pin's path the smaller of those before and behind it."""
    corner = any(abs(exact.load_parameter - t) < SAME for t in corners(exact.scene))
    return min(-relative_slip_rate(exact, pair, behind=behind) for behind in (False, True)[: 1 + corner])


def _spent(history: History, k: int, exact: Equilibrium) -> tuple[float, float]:
    """Return the stated dissipation, and the largest energy up to a load parameter, to which the error of a sum over the path is relative."""
    response = history.response
    spent = sum(float(item.friction.dissipated[k]) for item in response.contacts.values() if item.friction)
    work = 0.0 if response.work is None else largest(response.work[: k + 1])
    return spent, max(work, exact.strain_energy, spent, _least_energy(history.scene))


def _unpaid(history: History, k: int, exact: Equilibrium, tolerance: float) -> Iterator[str]:
    """Yield an answer whose work is not its dissipation and the exact strain energy; jumps release energy, and end the comparison."""
    response, t = history.response, history.response.load_parameter[k]
    jumped = any(event.kind == "slip-off" and event.load_parameter <= t for event in response.events or ())
    if response.work is None or jumped or not any(item.friction for item in response.contacts.values()):
        return
    spent, largest = _spent(history, k, exact)
    missing = float(response.work[k]) - spent - exact.strain_energy
    if abs(missing) > tolerance * largest:
        yield f"the work is not strain energy and dissipation at load parameter {t:.6g}, off by {missing / largest:.2g}"


def _misspent(history: History, k: int, exact: Equilibrium, tolerance: float) -> Iterator[str]:
    """Yield contacts whose dissipation since the load parameter before is not that of the exact equilibria."""
    response, (_, largest) = history.response, _spent(history, k, exact)
    for pair, own in dissipated(history, k, exact).items():
        friction = response.contacts[pair].friction
        if friction is not None:
            missing = float(np.diff(friction.dissipated, prepend=0.0)[k]) - own
            if abs(missing) > tolerance * largest:
                t = response.load_parameter[k]
                yield f"the dissipation of {pair} up to load parameter {t:.6g} is off by {missing / largest:.2g} of the work"


def rubs_wrongly_on_the_way(
    history: History, found: Mapping[int, Equilibrium], apart: float, allowed: float
) -> Iterator[str]:
    """Yield changes of slip and stick that are unstated or elsewhere, and work and dissipation up to the equilibria `found` that are not exact.

    `apart` is the largest difference of the answer from them.
    """
    for spec in history.scene.contacts:
        if spec.friction:
            yield from _falls(history, spec)
            yield from _elsewhere(history, spec, allowed)
    for k, exact in found.items():
        yield from _unpaid(history, k, exact, ENERGY + _SPREAD * apart)
    for k, exact in [*found.items()][-_MOST:]:
        yield from _misspent(history, k, exact, ENERGY + _SPREAD * apart)


def _least_energy(scene: Scene) -> float:
    """Energy below which differences are round-off: of the least force that differences are relative to, ``LEAST^2 EI/L``."""
    return LEAST * least_force(scene) * min(beam.length for beam in scene.beams)


def _falls(history: History, spec: ContactSpec) -> Iterator[str]:
    """Yield the first load parameter at which the dissipation of a contact is smaller than before."""
    response, friction = history.response, history.response.contacts[spec.pair].friction
    if friction is None:
        return
    sizes = [largest(x) for x in (friction.dissipated, response.work) if x is not None]
    falls = np.diff(friction.dissipated, prepend=0.0) < -FALL * max(*sizes, _least_energy(history.scene))
    if falls.any():
        yield f"the dissipation of {spec.pair} falls up to load parameter {response.load_parameter[np.argmax(falls)]:.6g}"


def _elsewhere(history: History, spec: ContactSpec, allowed: float) -> Iterator[str]:
    """Yield changes between slip and stick without an event, or against it, or not where the referee's own equilibria change."""
    changes = [
        (before, phase)
        for before, phase in pairwise(history.phases[spec.pair])
        if OPEN not in (before.slip, phase.slip)
    ]
    for _, phase in changes if history.response.events is not None else ():
        if phase.event is None:
            yield f"{spec.pair} {phase.does} without an event up to load parameter {phase.high:.6g}"
        elif (phase.event.kind == "stick") != (phase.slip == 0):
            yield f"{spec.pair} {phase.does} after an event of kind {phase.event.kind} at load parameter {phase.stated:.6g}"
    for before, phase in changes[-_MOST:]:
        if UNKNOWN in (phase.slip, before.slip):
            continue
        try:
            begin = history.begin(phase).load_parameter
        except UnknownFrictionError as error:
            if error.wrong:
                yield str(error)
            continue
        width = phase.high - phase.low if phase.event is None else 0.0
        if abs(begin - phase.begin) > max(allowed, width):
            yield f"{spec.pair} {phase.does} from load parameter {phase.begin:.6g}, exactly from {begin:.6g}"


def dissipated(history: History, k: int, exact: Equilibrium) -> dict[str, float]:
    """Return what every contact with friction dissipates since the load parameter before number k; nan where a change is not found."""
    times = history.response.load_parameter
    begin, end = (float(times[k - 1]) if k else 0.0), float(times[k])
    spent: dict[str, float] = {spec.pair: 0.0 for spec in history.scene.contacts if spec.friction}
    cuts: dict[float, Equilibrium | None] = dict.fromkeys(
        t for t in corners(history.scene) if begin < t < end
    )
    try:
        for pair, own in history.phases.items():
            before = history.numbers[pair][k - 1] if k else 0
            for phase in own[before + 1 : history.numbers[pair][k] + 1]:
                if phase.before is not None and phase.slip != phase.before.slip:
                    change = history.begin(phase)
                    cuts[change.load_parameter] = change
        cuts |= {begin: None, end: exact}
        there: Equilibrium | None = None
        for first, last in reversed(list(pairwise(sorted(cuts)))):
            there = cuts[last] or there
            if last - first > _SHORTEST:
                there = _between(history, first, last, there, spent)
    except UnknownFrictionError:
        return dict.fromkeys(spent, math.nan)
    return spent


def _between(
    history: History, first: float, last: float, there: Equilibrium | None, spent: dict[str, float]
) -> Equilibrium | None:
    """Add the dissipation between two load parameters without a change; `there` is an equilibrium next to them, as is the returned one."""
    middle = (first + last) / 2.0
    grips, closed = history.around(middle), history.closed(middle)
    slipping = [pair for pair, grip in grips.items() if grip.slip]
    if not slipping:
        return None
    now = history.near(middle, closed, grips) if there is None or closed != there.closed.keys() else there

    def power(t: float) -> Array:
        nonlocal now
        now = reach(now, t, grips)
        if not now.found:
            raise UnknownFrictionError(f"no equilibrium was found at load parameter {t:.6g}")
        rates = [slip_rate(now, pair) * now.layout.length for pair in slipping]
        return np.array([now.contacts[pair].drag for pair in slipping]) * rates

    def energy(low: float, high: float, depth: int) -> Array:
        places = (low + high) / 2.0 + _POINTS * (high - low) / 2.0
        powers = np.array([power(float(t)) for t in places[::-1]])[::-1]
        terms, half = np.abs(_LEGENDRE @ powers), (low + high) / 2.0
        if depth and np.any(terms[-2:].sum(axis=0) > _SMOOTH * terms[0]):
            return energy(half, high, depth - 1) + energy(low, half, depth - 1)
        return np.asarray(_WEIGHTS @ powers * (high - low) / 2.0)

    for pair, lost in zip(slipping, energy(first, last, _DEPTH).tolist(), strict=True):
        spent[pair] += lost
    return now

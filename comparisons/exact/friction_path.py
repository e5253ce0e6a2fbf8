"""Equilibrium of a cantilever along the path of a pin with Coulomb friction, with all changes of state.

Steps end at the first event. The answer depends on history only through the contact at which a stick began, so that it does not
depend on the steps. Where a contact begins, where the path of the pin turns and where a phase ends, the state that follows is
the one whose forces and slip have admissible rates.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from comparisons.exact.checks import path_points
from comparisons.exact.friction_law import Equations, Linear, Phase, Real, linearise
from comparisons.exact.friction_result import FrictionEvent, FrictionPath, FrictionState
from comparisons.exact.friction_step import AT_ONCE, EDGE, Ending, Piece, Problem, node_at, take

_TOUCH = 1e-12  # distance, in lengths of the rod, below which the pin touches
_FIRST_STEP, _SMALLEST_STEP = 0.05, 1e-11  # of the path
_SAME_DIRECTION = 1e-9
_NO_RATE, _SHORT_STEP = (
    1e-9,
    1e-5,
)  # a rate below the first is zero; the next order shows after the second, in load parameters
_SINGULAR = 1e13
_STATES = {1: FrictionState.SLIP_TO_TIP, -1: FrictionState.SLIP_TO_CLAMP, 0: FrictionState.STICK}


@dataclass(frozen=True, kw_only=True)
class Standing:
    """State, unknowns, phase of a contact and energies at a load parameter."""

    t: float
    state: FrictionState
    z: Real
    phase: Phase | None = None
    work: float = 0.0
    dissipated: float = 0.0
    released: float = 0.0
    events: tuple[FrictionEvent, ...] = ()


def require_friction(friction: float) -> None:
    """Raise `ValueError` if a coefficient of friction is negative or not finite."""
    if not (np.isfinite(friction) and friction >= 0.0):
        raise ValueError(f"friction = {friction}: must be finite and not negative")


def follow(
    equations_of_side: Callable[[int], Equations],
    points: ArrayLike,
    friction: float,
    *,
    EI: float,
    length: float,
    side: int | None = None,
) -> FrictionPath:
    """Return the equilibria at the vertices of a path, in the units of `EI` and `length`.

    `side` is 1 for a pin on the right of the rod and -1 on its left; without it, the beginning of the path decides.

    Raises
    ------
    ValueError
        If the friction is negative, the path is not finite, or its start is inside the rod.
    """
    require_friction(friction)
    pins = path_points(points) / length
    reach = equations_of_side(1).reach
    problem = Problem(equations=equations_of_side(side or _side(pins)), friction=friction)
    if 0.0 < pins[0, 0] <= 1.0 and abs(pins[0, 1]) < reach - _TOUCH:
        raise ValueError(f"points[0] = {pins[0]} length: the path must not start inside the rod")
    distance = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(pins, axis=0).T))])
    t = distance / (distance[-1] or 1.0)
    standing = Standing(t=0.0, state=FrictionState.OPEN, z=np.zeros(0))
    at_vertices = [standing]
    velocity = np.zeros(2)
    for (start, end), (begin, finish) in zip(pairwise(pins), pairwise(t), strict=True):
        if finish > begin:
            piece = Piece(start, (end - start) / (finish - begin), begin)
            turns = np.linalg.norm(piece.velocity - velocity) > _SAME_DIRECTION * np.linalg.norm(velocity)
            walk = _Walk(problem, piece)
            at_vertices[-1] = walk.begin(standing, finish, turns=bool(turns))
            standing = walk.along(at_vertices[-1], finish)
            velocity = piece.velocity
        at_vertices.append(standing)
    return _collect(problem.equations, at_vertices, t, EI=EI, length=length)


def _side(pins: Real) -> int:
    """Return 1 where the path starts below the rod, or on its surface and then rises; -1 in the mirror image."""
    start, away = pins[0, 1], pins[np.abs(pins[:, 1]) > _TOUCH, 1]
    if abs(start) > _TOUCH:
        return 1 if start < 0.0 else -1
    return -1 if len(away) and away[0] < 0.0 else 1


@dataclass(frozen=True)
class _Walk:
    """One straight piece of the pin's path."""

    problem: Problem
    piece: Piece

    def begin(self, standing: Standing, finish: float, *, turns: bool) -> Standing:
        """State at the beginning of the piece, after a corner of the path or a touch there."""
        if standing.state.touches:
            return self._turned(standing) if turns else standing
        touch = self._until_touch(standing, finish)
        return touch if touch.t == standing.t else standing

    def along(self, standing: Standing, finish: float) -> Standing:
        """Equilibrium at the end of the piece."""
        step, growth = _FIRST_STEP, 2.0
        while finish - standing.t > AT_ONCE and not standing.state.ends:
            if not standing.state.touches:
                standing = self._until_touch(standing, finish)
                continue
            assert standing.phase is not None
            start = node_at(self.problem, self.piece, standing.phase, standing.t, standing.z)
            end = finish if finish - standing.t <= 1.001 * step else standing.t + step
            found = None if start is None else take(self.problem, self.piece, standing.phase, start, end)
            if found is None:
                step, growth = (end - standing.t) / 3.0, 1.0
                if step < _SMALLEST_STEP:
                    standing = self._change(standing, FrictionState.LOST)
                continue
            standing = replace(
                standing,
                t=found.node.t,
                z=found.node.z,
                phase=found.phase,
                work=standing.work + found.work,
                dissipated=standing.dissipated + found.dissipated,
            )
            if found.ending is not None:
                standing = self._after(standing, found.ending)
            step, growth = growth * step, 2.0
        return replace(standing, t=finish)

    def _until_touch(self, standing: Standing, finish: float) -> Standing:
        """Pin at its touch with the straight rod, or at the end of the piece."""
        equations = self.problem.equations
        start, end = self.piece.pin(standing.t), self.piece.pin(finish)
        gaps = [-equations.side * pin[1] - equations.reach for pin in (start, end)]
        state = standing.state
        if state is FrictionState.SLIPPED and gaps[1] > _TOUCH:
            state = FrictionState.OPEN
        resting = state is FrictionState.OPEN and abs(gaps[0]) <= _TOUCH and gaps[1] < -_TOUCH
        if not resting and (gaps[0] <= _TOUCH or gaps[1] > _TOUCH):
            return replace(standing, t=finish, state=state)
        share = 0.0 if resting else min(gaps[0] / (gaps[0] - gaps[1]), 1.0)
        t = standing.t + share * (finish - standing.t)
        x = float(self.piece.pin(t)[0])
        if t >= finish or not 0.0 < x <= 1.0 + _TOUCH:
            return replace(standing, t=finish, state=state)
        return self._touched(replace(standing, t=t, state=state), min(x, 1.0))

    def _touched(self, standing: Standing, x: float) -> Standing:
        """Return the state whose rates raise the force from zero, in the cone or with slip in the sense of its friction."""
        friction, possible = self.problem.friction, list[tuple[int, Real]]()
        for sense in (0, 1, -1) if friction else (1,):
            z = self.problem.equations.touching(x, sense, friction)
            phase, linear = self._begin(z, standing.t, sense)
            rates = self._rates(linear)
            if rates is None or linear.normal @ rates <= 0.0:
                continue
            margin = float(sense * (linear.slip @ rates)) if friction else 1.0
            if not sense:
                margin = float(friction * (linear.normal @ rates) - abs(linear.tangential @ rates))
            if abs(margin) < _NO_RATE * np.linalg.norm(self.piece.velocity):
                margin = self._margin_soon(standing.t, phase, z)
            if margin > 0.0:
                possible.append((sense, z))
        return self._one_of(standing, possible)

    def _margin_soon(self, t: float, phase: Phase, z: Real) -> float:
        """Slip rate or distance from the cone after a short step, where the rates at a touch do not decide."""
        node = node_at(self.problem, self.piece, phase, t + _SHORT_STEP, z)
        return -1.0 if node is None else float(node.margins[0])

    def _turned(self, standing: Standing) -> Standing:
        """Return the state after a corner of the pin's path; on the edge of the cone a slip goes on or begins, or the pin sticks."""
        old, friction = standing.phase, self.problem.friction
        assert old is not None
        contact = self._begin(standing.z, standing.t, 1)[1].contact
        sense = old.sense or (1 if contact.tangential > 0.0 else -1)
        if not friction or friction * contact.normal - sense * contact.tangential > EDGE:
            return standing
        possible = list[tuple[int, Real]]()
        for state in (sense, 0):
            linear = self._begin(standing.z, standing.t, state)[1]
            rates = self._rates(linear)
            if rates is None:
                continue
            excess = sense * linear.tangential - friction * linear.normal
            if (state * linear.slip @ rates if state else -excess @ rates) > 0.0:
                possible.append((state, standing.z))
        return self._one_of(standing, possible)

    def _after(self, standing: Standing, ending: Ending) -> Standing:
        """Return the state after the end of a phase."""
        phase = standing.phase
        assert phase is not None
        if ending is Ending.RELEASE:
            return self._change(standing, FrictionState.OPEN)
        if ending is Ending.SLIP_OFF:
            energy = self.problem.equations.observe(standing.z).energy
            return self._change(replace(standing, released=standing.released + energy), FrictionState.SLIPPED)
        if phase.sense:
            return self._one_of(standing, [(0, standing.z)])
        _, linear = self._begin(standing.z, standing.t, 1)
        sense = 1 if linear.contact.tangential > 0.0 else -1
        _, linear = self._begin(standing.z, standing.t, sense)
        rates = self._rates(linear)
        slips = rates is not None and sense * float(linear.slip @ rates) > 0.0
        return self._one_of(standing, [(sense, standing.z)] if slips else [])

    def _one_of(self, standing: Standing, possible: list[tuple[int, Real]]) -> Standing:
        """Return the only possible state."""
        if len(possible) != 1:
            return self._change(standing, FrictionState.JAMMED)
        sense, z = possible[0]
        old = standing.phase
        if standing.state.touches and old is not None and sense == old.sense:
            return standing
        phase, _ = self._begin(z, standing.t, sense)
        return self._change(replace(standing, z=z, phase=phase), _STATES[sense])

    def _begin(self, z: Real, t: float, sense: int) -> tuple[Phase, Linear]:
        """Phase that begins at unknowns, and the equations in it."""
        pin, phase = self.piece.pin(t), Phase(sense=sense or 1, since=t)
        linear = linearise(self.problem.equations, z, pin, phase, self.problem.friction)
        if sense:
            return phase, linear
        phase = Phase(sense=0, since=t, start=linear.contact)
        return phase, linearise(self.problem.equations, z, pin, phase, self.problem.friction)

    def _rates(self, linear: Linear) -> Real | None:
        """Rates of the unknowns; None where the pin's velocity does not determine them."""
        if not np.linalg.cond(linear.tangent) < _SINGULAR:
            return None
        return linear.rates(self.piece.velocity)

    def _change(self, standing: Standing, state: FrictionState) -> Standing:
        """Change the state and record the event."""
        force, arc = 0.0, np.nan
        if len(standing.z):
            _, linear = self._begin(standing.z, standing.t, 1)
            force, arc = float(np.hypot(*linear.contact.force)), float(linear.contact.arc)
        event = FrictionEvent(
            load_parameter=float(standing.t),
            before=standing.state,
            after=state,
            arc_position=arc,
            magnitude=force,
        )
        return replace(standing, state=state, events=(*standing.events, event))


class _Row(NamedTuple):
    """Dimensionless results at one position of the pin; by default the straight rod."""

    force: ArrayLike = (0.0, 0.0)
    tangential: ArrayLike = 0.0
    normal: ArrayLike = 0.0
    arc: ArrayLike = np.nan
    clamp_moment: ArrayLike = 0.0
    tip: ArrayLike = (1.0, 0.0)
    rotation: ArrayLike = 0.0
    stored: ArrayLike = 0.0


def _row(equations: Equations, standing: Standing) -> _Row:
    """Return the results at one position of the pin."""
    if standing.state.ends:
        return _Row(*(np.full(np.shape(value), np.nan) for value in _Row()))
    if not standing.state.touches:
        return _Row()
    contact = equations.contact(standing.z, np.zeros(2))
    observed, arc = equations.observe(standing.z), float(contact.arc.real)
    direction = np.array([np.cos(observed.rotation), np.sin(observed.rotation)])
    return _Row(
        force=observed.force,
        tangential=contact.tangential.real,
        normal=contact.normal.real,
        arc=arc,
        clamp_moment=observed.clamp_moment,
        tip=observed.position + (1.0 - arc) * direction,
        rotation=observed.rotation,
        stored=observed.energy,
    )


def _collect(
    equations: Equations, at_vertices: list[Standing], t: Real, *, EI: float, length: float
) -> FrictionPath:
    """Return the path in the units of the input."""
    rows = [_row(equations, standing) for standing in at_vertices]
    row = _Row(*(np.array(column, dtype=np.float64) for column in zip(*rows, strict=True)))
    unit, energy = EI / length**2, EI / length
    force, ended = unit * np.asarray(row.force), np.array([standing.state.ends for standing in at_vertices])
    work, dissipated, released = (
        energy * np.where(ended, np.nan, [getattr(standing, name) for standing in at_vertices])
        for name in ("work", "dissipated", "released")
    )
    return FrictionPath(
        load_parameter=t,
        state=tuple(standing.state for standing in at_vertices),
        force=force,
        magnitude=np.hypot(*force.T),
        tangential=unit * np.asarray(row.tangential),
        normal=unit * np.asarray(row.normal),
        arc_position=length * np.asarray(row.arc),
        clamp_force=-force,
        clamp_moment=energy * np.asarray(row.clamp_moment),
        tip=length * np.asarray(row.tip),
        tip_rotation=np.asarray(row.rotation),
        work=work,
        stored=energy * np.asarray(row.stored),
        dissipated=dissipated,
        released=released,
        events=tuple(
            replace(event, arc_position=length * event.arc_position, magnitude=unit * event.magnitude)
            for event in at_vertices[-1].events
        ),
    )

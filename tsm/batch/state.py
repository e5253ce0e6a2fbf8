"""State of every structure of a batch: its iterate, its accepted configurations, its step control."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tsm.batch.constants import BatchConstants
from tsm.batch.equations import Configurations, Equations
from tsm.batch.geometry import slide
from tsm.batch.record import touches_of
from tsm.elements.properties import Array
from tsm.predictor import weighted, weights_at
from tsm.projection import AT_NODE
from tsm.state import State
from tsm.track import MEMORY

_NEVER = 1e300 * np.arange(1, MEMORY + 1)
"""Load parameters of places that are not filled: their weights in a polynomial vanish, and they leave the others as they are."""


class History(NamedTuple):
    """The last accepted configurations, in a ring.

    Attributes
    ----------
    entered : ndarray of int, shape (N,)
        How many were entered; the newest is at ``(entered - 1) % MEMORY``.
    t : ndarray, shape (MEMORY, N)
        Load parameters.
    q, element, xi, force : ndarray, shape (MEMORY, ..., N)
        As in `Configurations`.
    """

    entered: Array
    t: Array
    q: Array
    element: Array
    xi: Array
    force: Array


class BatchState(NamedTuple):
    """N structures under way; all arrays are changed in place.

    Attributes
    ----------
    structure : ndarray of int, shape (N,)
        Which they are.
    constants : BatchConstants
        Their constants.
    iterate : Configurations
        Iterates.
    predicted : ndarray, shape (dofs, N)
        Displacements that the iterations began with.
    goal : ndarray, shape (N,)
        Load parameters of the iterates.
    normal, arc : ndarray, shape (p, N)
        Contact forces and arc positions of the last accepted configurations.
    armed : ndarray of bool, shape (p, N)
        Open pairs that may close.
    history : History
        Accepted configurations.
    target : ndarray of int, shape (N,)
        Next prescribed load parameters.
    step : ndarray, shape (N,)
        Longest next steps.
    iteration, spent : ndarray of int, shape (N,)
        Iterations of this step, and those before it since the last prescribed load parameter.
    residual : ndarray, shape (N,)
        Norms before the last iteration.
    orientation, first, last : ndarray, shape (N,)
        Signs of the determinants of the tangent: of the last accepted step, first and last of this one; 0 where there is none.
    """

    structure: Array
    constants: BatchConstants
    iterate: Configurations
    predicted: Array
    goal: Array
    normal: Array
    arc: Array
    armed: Array
    history: History
    target: Array
    step: Array
    iteration: Array
    spent: Array
    residual: Array
    orientation: Array
    first: Array
    last: Array


def undeformed(equations: Equations, constants: BatchConstants, structure: Array) -> BatchState:
    """Structures at rest, their pins at the start of their paths, all contacts open."""
    model, count = equations.model, len(structure)
    pairs, everywhere = len(model.pairs), np.arange(count)
    zero = np.zeros(count)
    owners = np.array([pair.target.first for pair in model.pairs])
    node = np.stack([constants.paths.position(k, zero, everywhere) for k in range(pairs)])
    iterate = Configurations(
        q=np.zeros((model.dof_count, count)),
        closed=np.zeros((pairs, count), dtype=bool),
        element=np.repeat(owners[:, None], count, axis=1),
        xi=np.zeros((pairs, count)),
        force=np.zeros((pairs, 2, count)),
        node=node,
    )
    history = History(
        entered=np.zeros(count, dtype=int),
        t=np.repeat(_NEVER[:, None], count, axis=1),
        q=np.zeros((MEMORY, *iterate.q.shape)),
        element=np.zeros((MEMORY, pairs, count), dtype=int),
        xi=np.zeros((MEMORY, pairs, count)),
        force=np.zeros((MEMORY, pairs, 2, count)),
    )
    return BatchState(
        structure=structure,
        constants=constants,
        iterate=iterate,
        predicted=np.zeros_like(iterate.q),
        goal=zero.copy(),
        normal=np.zeros((pairs, count)),
        arc=np.full((pairs, count), np.nan),
        armed=np.ones((pairs, count), dtype=bool),
        history=history,
        target=np.zeros(count, dtype=int),
        step=np.ones(count),
        iteration=np.zeros(count, dtype=int),
        spent=np.zeros(count, dtype=int),
        residual=np.full(count, np.inf),
        orientation=zero.copy(),
        first=zero.copy(),
        last=zero.copy(),
    )


def newest(history: History, which: Array) -> Array:
    """Places of the newest configurations of some structures in the ring."""
    place: Array = (history.entered[which] - 1) % MEMORY
    return place


def remember(batch: BatchState, which: Array) -> None:
    """Enter the iterates of some structures into their histories."""
    history, iterate = batch.history, batch.iterate
    history.entered[which] += 1
    place = newest(history, which)
    history.t[place, which] = batch.goal[which]
    for ring, now in (
        (history.q, iterate.q),
        (history.element, iterate.element),
        (history.xi, iterate.xi),
        (history.force, iterate.force),
    ):
        ring[place, ..., which] = np.moveaxis(now[..., which], -1, 0)


def replace_history(batch: BatchState, n: int, states: list[State]) -> None:
    """Take over the configurations that structure n was brought through alone, the last of them as its iterate."""
    history, iterate = batch.history, batch.iterate
    history.entered[n], history.t[:, n] = 0, _NEVER
    for state in states[-MEMORY:]:
        iterate.q[:, n] = state.q
        for k, touch in enumerate(state.touches):
            iterate.closed[k, n] = touch is not None
            if touch is not None:
                iterate.element[k, n], iterate.xi[k, n], iterate.force[k, :, n] = (
                    touch.element,
                    touch.xi,
                    touch.force,
                )
        batch.armed[:, n] = state.armed
        batch.goal[n] = state.load_parameter
        remember(batch, np.array([n]))


def states_of(batch: BatchState, n: int) -> list[State]:
    """Accepted configurations of structure n, oldest first."""
    history = batch.history
    count = int(history.entered[n])
    states = []
    for place in (age % MEMORY for age in range(max(count - MEMORY, 0), count)):
        touches = touches_of(
            batch.iterate.closed[:, n],
            history.element[place, :, n],
            history.xi[place, :, n],
            history.force[place, :, :, n],
        )
        states.append(
            State(
                load_parameter=float(history.t[place, n]),
                q=history.q[place, :, n].copy(),
                touches=touches,
                armed=tuple(batch.armed[:, n].tolist()),
            )
        )
    return states


def predict(equations: Equations, batch: BatchState, which: Array) -> None:
    """Set the iterates of some structures to the polynomials through their accepted configurations."""
    history, iterate, constants = batch.history, batch.iterate, batch.constants
    weights = weights_at(list(history.t[:, which]), batch.goal[which])
    iterate.q[:, which] = batch.predicted[:, which] = weighted(weights, history.q[..., which])
    l0 = constants.properties.l0
    place = newest(history, which)
    for k, pair in enumerate(equations.model.pairs):
        elements = history.element[:, k, which]
        arcs = constants.arc[elements, which] + history.xi[:, k, which] * l0[elements, which]
        last = history.element[place, k, which]
        xi = (weighted(weights, arcs) - constants.arc[last, which]) / l0[last, which]
        iterate.element[k, which], iterate.xi[k, which] = slide(l0, pair.target, last, xi, which, AT_NODE)
        iterate.force[k][:, which] = weighted(weights, history.force[:, k][..., which])
        if pair.pin is not None:
            iterate.node[k][:, which] = constants.paths.position(k, batch.goal[which], which)

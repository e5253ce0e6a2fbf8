"""The deflected axis of a beam at a configuration."""

from __future__ import annotations

import math

import numpy as np

from tsm.elements.axis import PointForce, deflected_axes
from tsm.elements.properties import Array, Properties
from tsm.model import BeamModel, Model
from tsm.rods.accuracy import deflected
from tsm.state import State
from tsm.system import Linearisation


def is_exact(model: Model, beam: str) -> bool:
    """Whether a beam has exact elements."""
    return bool(np.isin(model.beams[beam].first, model.exact))


def axis_line(
    model: Model, state: State, system: Linearisation, beam: str, points_per_element: int | None = None
) -> tuple[Array, Array]:
    """Deflected axis of a beam.

    Parameters
    ----------
    model : Model
        The structure.
    state, system : State, Linearisation
        A configuration and its forces.
    beam : str
        Name of the beam.
    points_per_element : int, optional
        Intervals in every element: 10, and of exact elements so many that the beam has 100.

    Returns
    -------
    arc : ndarray, shape (m,)
        Distance along the undeformed axis.
    xy : ndarray, shape (m, 2)
        Deformed position.
    """
    place, exact = model.beams[beam], is_exact(model, beam)
    default = max(10, math.ceil(100 / place.beam.elements)) if exact else 10
    xi = np.linspace(0, 1, (points_per_element or default) + 1)
    axes = _exact_axes(model, state, place, xi) if exact else _closed_axes(model, state, system, place, xi)
    arcs = np.array(place.arcs[:-1])[:, None] + xi * np.array(place.lengths)[:, None]
    return np.append(arcs[:, :-1], place.beam.length), np.concatenate([*axes[:, :-1], axes[-1, -1:]])


def _exact_axes(model: Model, state: State, place: BeamModel, xi: Array) -> Array:
    """Positions on all elements of a beam, shape (elements, m, 2)."""
    assert model.rods is not None, "an exact element has rods"
    shape = deflected(model.rods, state)
    return np.array(
        [
            shape.at(int(model.place[e]), xi * model.element[e].l0).position
            for e in range(place.first, place.last + 1)
        ]
    )


def _closed_axes(model: Model, state: State, system: Linearisation, place: BeamModel, xi: Array) -> Array:
    """Positions on all elements of a beam, shape (elements, m, 2)."""
    own = slice(place.first, place.last + 1)
    x, part = state.q[model.dofs[:, own]], model.place[own]
    p = Properties(*(np.asarray(values)[part] for values in model.properties))
    contacts = [
        PointForce(touch.element - place.first, touch.xi, touch.force)
        for k in model.pairs_on.get(place.beam.name, ())
        if (touch := state.touches[k]) is not None and model.pairs[k].slot >= 0
    ]
    axes = deflected_axes(p, x, system.closed_force[:, part], contacts, xi)
    starts: Array = np.array(model.element_start[own]) + x[:2].T
    return starts[:, None] + axes

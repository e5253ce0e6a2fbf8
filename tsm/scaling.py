"""Scales of the unknowns and equations, for the norms of residuals, steps and round-off.

Every function takes one structure, or many structures along the last axis.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tsm.elements.properties import Array, Properties
from tsm.model import Model
from tsm.sizes import Sizes

ROUND_OFF = 4 * float(np.finfo(float).eps)
SHARP = 1e-3
"""Scale of positions over the length. Positions are solved to a thousandth of the relative residual of forces. A stiff contact needs
this accuracy, and it has no cost."""
TURN, _WAY = 0.7, 0.3
"""Largest step: rotation [rad], and displacement in parts of the structure's extent."""


class Scales(NamedTuple):
    """Scales of a structure, or of many in the last axis."""

    # factors that make residuals comparable, over the equations, then the contacts' unknowns; shape
    # (unknowns, ...)
    residual: Array
    step: Array  # reciprocals of the largest Newton step; shape (unknowns, ...)
    noise: Array  # scaled round-off of the residual


def scales_of(model: Model, coordinates: Array, properties: Properties, sizes: Sizes) -> Scales:
    """Scales from the constants of the elements and the sizes; forces are counted in ``EI/L^2``, positions in L/1000.

    Round-off is ``4 eps (EA L/l0 + EI/l0^2)`` for an element in closed form, and ``4 eps`` of the node positions where positions are equations.
    """
    length, extent, _, force = sizes
    one = np.ones_like(length)
    sharp = 1 / (SHARP * length)
    free, held = 0 * one, (1 / force, 1 / force, 1 / (force * length))
    residual = np.array([*held, sharp, sharp, one / SHARP, sharp, sharp, 1 / force, one / SHARP])
    way, turn = 1 / (_WAY * extent), one / TURN
    step = np.array([way, way, turn, free, free, free, free, free, way, turn])
    EA, EI, l0 = (value[model.closed] for value in (properties.EA, properties.EI, properties.l0))
    noise = ROUND_OFF * (EA * extent / l0 + EI / l0**2).max(axis=0, initial=0.0) / force
    if len(model.kind) > model.equations or any(group.internal for group in model.groups):
        axes = tuple(range(coordinates.ndim - np.ndim(length)))
        noise = np.maximum(noise, ROUND_OFF * np.abs(coordinates).max(axis=axes) / (SHARP * length))
    return Scales(residual[model.kind], step[model.kind], noise)


def largest(values: Array, scale: Array) -> Array:
    """Largest scaled value, the norm of a residual or the size of a step, for each structure of the last axis."""
    size: Array = np.abs(values * scale).max(axis=0, initial=0.0)
    return size

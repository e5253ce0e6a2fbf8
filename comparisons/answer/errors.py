"""The measure of the difference between two responses to one scene, by every quantity of `comparisons.answer.quantities`.

A quantity is compared at the load parameters that both responses have; nothing is interpolated in the load parameter. The error
is the largest difference over all contacts, supports and beams. Forces, moments and stresses are relative to the largest value of
the reference, positions to the length of their beam.

A value that is not a number in one of the responses has an infinite error: the arc position where its pair is open in one response and
closed in the other, the friction where one of the responses has no material force. The error is nan where both have none: the arc
position of a pair that is open in both, every arc position of a scene without contact, the moment where no support has one.
"""

from collections.abc import Iterable, Mapping
from operator import itemgetter
from typing import Any

import numpy as np

from comparisons.answer import Response
from comparisons.answer.quantities import KEPT, QUANTITIES, SCOPES, Columns, Pair, Scales, scales
from comparisons.scene import Scene

Errors = Mapping[str, Mapping[str, float]]
"""Errors by scope and quantity."""


def errors(
    response: Response,
    reference: Response,
    scene: Scene,
    *,
    scale: Scales | None = None,
    end: float | None = None,
    quantities: Iterable[str] = KEPT,
    whole: bool = True,
) -> Errors:
    """Return the errors of a response by scope and quantity; nan for a response that does not reach the reference's end.

    Parameters
    ----------
    response, reference : Response
        Two responses to the same scene; the first may have fewer load parameters.
    scene : Scene
        Source of the beams' lengths.
    scale : mapping of float, optional
        Divisors of forces and moments; by default the largest values of the reference.
    end : float, optional
        The load parameter of the scope ``end``, the reference's last if not given.
    quantities : iterable of str
        Keys of `comparisons.answer.quantities.QUANTITIES`.
    whole : bool
        If false, a response that does not reach the end has the errors of the path as far as both came.
    """
    names, last = tuple(quantities), reference.load_parameter[-1:]
    shared = np.intersect1d(response.load_parameter, reference.load_parameter)
    if not np.isin(last if whole else shared, shared).any():
        return {scope: dict.fromkeys(names, np.nan) for scope in SCOPES}
    columns = {name: error_columns(response, reference, scene, name, scale) for name in names}
    chosen = {"end": shared == (last[0] if end is None else end), "path": slice(None)}
    return {scope: {name: largest(columns[name], at) for name in names} for scope, at in chosen.items()}


def difference(response: Response, reference: Response, scene: Scene, quantity: str) -> float:
    """Return the largest error of a quantity over the load parameters that both responses reached.

    Forces and moments are relative to the largest value of the reference at these load parameters. The error is infinite if the
    responses share no load parameter. It is nan if neither response has the quantity: a scene without contact has no arc position.
    """
    steps = np.flatnonzero(np.isin(reference.load_parameter, response.load_parameter))
    columns = error_columns(response, reference, scene, quantity, scales(reference, steps))
    return largest(columns) if len(steps) else np.inf


def worst_place(response: Response, reference: Response, scene: Scene, quantity: str) -> str:
    """Return the pair, support or beam, and the load parameter, where a quantity has its largest error; empty if there is none."""
    place = QUANTITIES[quantity].place
    if place is not None:
        return place(response, reference)
    shared = np.intersect1d(response.load_parameter, reference.load_parameter)
    columns = error_columns(response, reference, scene, quantity).items()
    found = [(x, name, t) for name, values in columns for x, t in zip(values, shared, strict=True) if x > 0.0]
    _, name, t = max(found, key=itemgetter(0), default=(0.0, "", 0.0))
    return f"{name} at load parameter {t:.6g}" if name else ""


def error_columns(
    response: Response, reference: Response, scene: Scene, quantity: str, scale: Scales | None = None
) -> Columns:
    """Return the errors of every pair, support or beam, shape (n,), at the n load parameters that both responses have."""
    _, own, true = np.intersect1d(response.load_parameter, reference.load_parameter, return_indices=True)
    sides = (response, own), (reference, true)
    return QUANTITIES[quantity].columns(Pair(sides=sides, scene=scene, scale=scale or scales(reference)))


def largest(columns: Columns, at: Any = slice(None)) -> float:
    """Return the largest of the errors that are numbers, at some of the load parameters; nan if none is."""
    return float(np.fmax.reduce([np.nan, *(error for values in columns.values() for error in values[at])]))

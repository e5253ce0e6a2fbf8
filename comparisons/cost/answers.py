"""Answers as arrays, their limits by extrapolation, and how far one is from another."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from comparisons.cases import Measurement
from comparisons.response import Array
from comparisons.scene import Scene

QUANTITIES = ("force", "arc_position", "clamp_moment", "tip", "shape_largest", "shape_mean")
DEPENDENT = ("force", "arc_position", "clamp_moment", "tip", "shape")
"""What an answer says, by the names of its attributes."""
SCOPES = ("end", "path")
"""Of the errors: at one state, and the largest over all load parameters of the scene that a setting has."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Answer:
    """What a solution says, without its cost, over s load parameters, of p contact pairs and b beams.

    Attributes
    ----------
    load_parameter : ndarray, shape (s,)
        The load parameters reached.
    force, arc_position : ndarray, shape (s, p)
        Contact forces and arc positions, nan where open. Without contact, `force` is the magnitude of the force on the moved end of a beam, or
        of its support, ``(s, b)``.
    clamp_moment : ndarray, shape (s, b)
        Moments of the supports.
    tip : ndarray, shape (s, b, 2)
        Tips.
    shape_at, shape : ndarray, shape (m,) and (m, b, 101, 2)
        Load parameters and deformed axes there at equal distances along the undeformed axes.
    """

    load_parameter: Array
    force: Array
    arc_position: Array
    clamp_moment: Array
    tip: Array
    shape_at: Array
    shape: Array


def answer(found: Measurement) -> Answer:
    """Return what a measured case says, pairs and beams in alphabetical order."""
    s = len(found.load_parameter)
    support = {**found.support_force, **found.other_end_force}
    magnitudes = {beam: np.hypot(*force.T) for beam, force in support.items()}
    return Answer(
        load_parameter=found.load_parameter,
        force=_columns(found.force or magnitudes, (s, 0)),
        arc_position=_columns(found.arc_position, (s, 0)),
        clamp_moment=_columns(found.moment, (s, 0)),
        tip=_columns(found.tip, (s, 0, 2)),
        shape_at=found.shape_at,
        shape=_columns(found.shape, (len(found.shape_at), 0, 0, 2)),
    )


def _columns(tables: dict[str, Array], empty: tuple[int, ...]) -> Array:
    return np.stack([tables[name] for name in sorted(tables)], axis=1) if tables else np.empty(empty)


def extrapolated(answers: Sequence[Answer]) -> tuple[Answer, Answer]:
    """Return the limit of three answers, coarse to fine with a constant ratio of refinement, and its uncertainty.

    The order is observed from the answers, in the largest norm of every quantity over the load parameters: with the differences
    ``d1, d2`` of neighbours, ``q = q3 + d2 / (|d1|/|d2| - 1)`` (Richardson, Aitken). Where the differences do not fall by a tenth
    at least, nothing is added. The uncertainty is the last difference ``|d2|``: what a constant order would leave is less, but a local
    singularity, as of a load on one node, lowers the order once the rest has converged.
    """
    values, doubts = {}, {}
    for item in fields(Answer):
        coarse, middle, fine = (getattr(one, item.name) for one in answers[-3:])
        values[item.name] = doubts[item.name] = fine
        if item.name in DEPENDENT:
            before, last = middle - coarse, fine - middle
            values[item.name] = fine + _remainder(before, last) * last
            doubts[item.name] = np.abs(last)
    return Answer(**values), Answer(**doubts)


def _remainder(before: Array, last: Array) -> float:
    """Sum of a geometric series after its second term, over that term."""
    d1, d2 = (float(np.nanmax(np.abs(part), initial=0.0)) for part in (before, last))
    return d2 / (d1 - d2) if 0.0 < 1.1 * d2 < d1 else 0.0


@dataclass(frozen=True, kw_only=True)
class Scales:
    """What errors are relative to: the largest force and moment of the reference, the length of the longest beam."""

    force: float
    moment: float
    length: float


def scales(reference: Answer, scene: Scene) -> Scales:
    """Return the scales of a scene and its reference."""
    force, moment = (
        float(np.abs(part).max(initial=0.0)) or 1.0 for part in (reference.force, reference.clamp_moment)
    )
    return Scales(force=force, moment=moment, length=max(beam.length for beam in scene.beams))


def end_state(reference: Answer) -> float:
    """Return the last load parameter at which the reference carries a force."""
    carries = (reference.force > 0.0).any(axis=1)
    loaded = reference.load_parameter[carries]
    return float(loaded[-1] if len(loaded) else reference.load_parameter[-1])


def errors(found: Answer, reference: Answer, scale: Scales, end: float) -> dict[str, dict[str, float]]:
    """Return the errors by scope and quantity; nan where `found` has none of the load parameters.

    ``|F - F_ref| / F*``, ``|s - s_ref| / L``, ``|M - M_ref| / M*``, distances of tips and of deformed axes at equal arc length over L;
    of several contacts and beams the largest. Compared are load parameters that both have, never interpolated.
    """
    if found.force.shape[1:] != reference.force.shape[1:]:
        return {scope: dict.fromkeys(QUANTITIES, np.nan) for scope in SCOPES}
    histories, at = _histories(found, reference, scale)
    return {
        "end": {name: _largest(values[at[name] == end]) for name, values in histories.items()},
        "path": {name: _largest(values) for name, values in histories.items()},
    }


def _histories(found: Answer, reference: Answer, scale: Scales) -> tuple[dict[str, Array], dict[str, Array]]:
    """Return the errors at every shared load parameter, and these, by quantity."""
    shared, ours, theirs = np.intersect1d(found.load_parameter, reference.load_parameter, return_indices=True)
    shapes_at, our_shapes, their_shapes = np.intersect1d(
        found.shape_at, reference.shape_at, return_indices=True
    )
    difference = {
        name: (getattr(found, name)[ours] - getattr(reference, name)[theirs])
        for name in ("force", "arc_position", "clamp_moment", "tip")
    }
    apart = np.hypot(*np.moveaxis(found.shape[our_shapes] - reference.shape[their_shapes], -1, 0))
    values = {
        "force": _worst(difference["force"]) / scale.force,
        "arc_position": _worst(difference["arc_position"]) / scale.length,
        "clamp_moment": _worst(difference["clamp_moment"]) / scale.moment,
        "tip": _worst(np.hypot(*np.moveaxis(difference["tip"], -1, 0))) / scale.length,
        "shape_largest": _worst(apart.max(axis=2, initial=0.0)) / scale.length,
        "shape_mean": _worst(apart.mean(axis=2)) / scale.length,
    }
    return values, {name: shapes_at if name.startswith("shape") else shared for name in values}


def _worst(columns: Array) -> Array:
    """Return the largest magnitude of every row, leaving out what is open."""
    known = np.where(np.isfinite(columns), np.abs(columns), -1.0)
    worst = known.max(axis=1, initial=-1.0)
    return np.where(worst < 0.0, np.nan, worst)


def _largest(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(known.max()) if len(known) else np.nan


def uncertainty(doubt: Answer, scale: Scales, end: float) -> dict[str, dict[str, float]]:
    """Return how well a limit is known, as `errors` states errors."""
    nothing = replace(doubt, **{name: np.zeros_like(getattr(doubt, name)) for name in DEPENDENT})
    return errors(doubt, nothing, scale, end)

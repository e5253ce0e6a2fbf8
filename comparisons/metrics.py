"""Errors of a response against a reference over the same load parameters."""

from dataclasses import dataclass

import numpy as np

from comparisons.response import Array, Response


@dataclass(frozen=True, kw_only=True)
class Errors:
    """Largest errors over all load parameters, and those at the last one.

    Forces and moments relative to the largest of the reference, positions relative to the beam's length:
    ``|F - F_ref| / max |F_ref|`` and ``|s - s_ref| / L``.
    """

    contact_force: float
    arc_position: float
    clamp_moment: float
    tip: float
    contact_force_end: float
    arc_position_end: float
    clamp_moment_end: float
    tip_end: float


def errors(response: Response, reference: Response, *, pair: str, beam: str, length: float) -> Errors:
    """Return the errors of `response` against `reference`; nan where they do not share all load parameters.

    Parameters
    ----------
    response, reference : Response
        Over the same load parameters; they are never interpolated.
    pair, beam : str
        Contact pair and beam compared.
    length : float
        Length of the beam.
    """
    if not np.array_equal(response.load_parameter, reference.load_parameter):
        return Errors(**dict.fromkeys(Errors.__dataclass_fields__, np.nan))
    ours, exact = response.contacts[pair], reference.contacts[pair]
    differences = {
        "contact_force": _relative(ours.force, exact.force),
        "arc_position": np.abs(ours.arc_position - exact.arc_position) / length,
        "clamp_moment": _relative(response.supports[beam].moment, reference.supports[beam].moment),
        "tip": np.hypot(*(response.tips[beam] - reference.tips[beam]).T) / length,
    }
    largest = {name: _largest(values) for name, values in differences.items()}
    return Errors(**largest, **{f"{name}_end": float(values[-1]) for name, values in differences.items()})


def _relative(values: Array, reference: Array) -> Array:
    return np.asarray(np.abs(values - reference) / np.abs(reference).max())


def _largest(values: Array) -> float:
    """Return the largest value, leaving out load parameters at which the pair is open in either."""
    known = values[np.isfinite(values)]
    return float(known.max()) if len(known) else np.nan

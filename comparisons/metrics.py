"""Errors of a response against a reference over the same load parameters."""

from dataclasses import dataclass

import numpy as np

from comparisons.response import Array, Response


@dataclass(frozen=True, kw_only=True)
class Errors:
    """Largest errors over all load parameters, and those at the last one.

    Forces and moments relative to the largest of the reference, positions relative to the beam's length:
    ``|F - F_ref| / max |F_ref|`` and ``|s - s_ref| / L``. Where a beam's tip is moved without a contact, `contact_force` is
    the error of the force on the tip and `arc_position` is nan.
    """

    contact_force: float
    arc_position: float
    clamp_moment: float
    tip: float
    contact_force_end: float
    arc_position_end: float
    clamp_moment_end: float
    tip_end: float


def errors(response: Response, reference: Response, *, pair: str | None, beam: str, length: float) -> Errors:
    """Return the errors of `response` against `reference`; nan where they do not share all load parameters.

    Parameters
    ----------
    response, reference : Response
        Over the same load parameters; they are never interpolated.
    pair, beam : str
        Contact pair, None without contact, and beam compared.
    length : float
        Length of the beam.
    """
    if not np.array_equal(response.load_parameter, reference.load_parameter):
        return Errors(**dict.fromkeys(Errors.__dataclass_fields__, np.nan))
    (ours, our_arc), (exact, exact_arc) = (_driven(item, pair, beam) for item in (response, reference))
    differences = {
        "contact_force": _relative(ours, exact),
        "arc_position": np.abs(our_arc - exact_arc) / length,
        "clamp_moment": _relative(response.supports[beam].moment, reference.supports[beam].moment),
        "tip": np.hypot(*(response.tips[beam] - reference.tips[beam]).T) / length,
    }
    largest = {name: _largest(values) for name, values in differences.items()}
    return Errors(**largest, **{f"{name}_end": float(values[-1]) for name, values in differences.items()})


def _driven(response: Response, pair: str | None, beam: str) -> tuple[Array, Array]:
    """Return the magnitude of the force that moves the beam, and its arc position."""
    if pair is not None:
        return response.contacts[pair].force, response.contacts[pair].arc_position
    at_tip = response.supports[beam].other_end
    assert at_tip is not None, "a beam without contact is moved by its other end"
    return np.hypot(*at_tip.force.T), np.full(len(at_tip.force), np.nan)


def _relative(values: Array, reference: Array) -> Array:
    return np.asarray(np.abs(values - reference) / np.abs(reference).max())


def _largest(values: Array) -> float:
    """Return the largest value, leaving out load parameters at which the pair is open in either."""
    known = values[np.isfinite(values)]
    return float(known.max()) if len(known) else np.nan

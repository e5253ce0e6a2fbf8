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
    differences = error_histories(response, reference, pair=pair, beam=beam, length=length)
    largest = {name: _largest(values) for name, values in differences.items()}
    return Errors(**largest, **{f"{name}_end": float(values[-1]) for name, values in differences.items()})


def error_histories(
    response: Response, reference: Response, *, pair: str | None, beam: str, length: float
) -> dict[str, Array]:
    """Return what `errors` takes the largest of, shape (s,) each, over the load parameters that both reached."""
    ours, exact = (histories(item, pair=pair, beam=beam) for item in (response, reference))
    s = min(len(response.load_parameter), len(reference.load_parameter))
    return {
        "contact_force": _relative(ours["contact_force"][:s], exact["contact_force"]),
        "arc_position": np.abs(ours["arc_position"][:s] - exact["arc_position"][:s]) / length,
        "clamp_moment": _relative(ours["clamp_moment"][:s], exact["clamp_moment"]),
        "tip": np.hypot(*(response.tips[beam][:s] - reference.tips[beam][:s]).T) / length,
    }


def histories(response: Response, *, pair: str | None, beam: str) -> dict[str, Array]:
    """Return contact force, arc position and clamp moment over the load parameters, as `Errors` names and means them."""
    force, arc = _driven(response, pair, beam)
    return {"contact_force": force, "arc_position": arc, "clamp_moment": response.supports[beam].moment}


def _driven(response: Response, pair: str | None, beam: str) -> tuple[Array, Array]:
    """Return the magnitude of the force that moves the beam, and its arc position."""
    if pair is not None:
        return response.contacts[pair].force, response.contacts[pair].arc_position
    at_tip = response.supports[beam].other_end
    assert at_tip is not None, "a beam without contact is moved by its other end"
    return np.hypot(*at_tip.force.T), np.full(len(at_tip.force), np.nan)


def _relative(values: Array, reference: Array) -> Array:
    return np.asarray(np.abs(values - reference[: len(values)]) / np.abs(reference).max(initial=0.0))


def _largest(values: Array) -> float:
    """Return the largest value, leaving out load parameters at which the pair is open in either."""
    known = values[np.isfinite(values)]
    return float(known.max()) if len(known) else np.nan

"""Element types by name: what a beam does between contacts, and what it does at one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tsm.elements import chord_contact, mixed_contact
from tsm.elements.beam import Coefficients, bowed_coefficients, linear_coefficients
from tsm.elements.properties import Array, Properties

ContactResponse = Callable[[Properties, Any, Any, Any, Any, float, float], tuple[Array, Array]]


@dataclass(frozen=True, kw_only=True)
class ElementType:
    """One way to write the element force equation.

    Attributes
    ----------
    source : str
        Where the equations stand.
    coefficients : callable
        Coefficients of the beam's energy from its constants, see `beam.Coefficients`.
    contact : callable
        ``(properties, x, lever, xi, force, side, offset) -> (gradient, tangent)`` over element (6), node (2) and,
        if `carries_force`, the force (2) and the arc position. See `mixed_contact.response`.
    carries_force : bool
        Whether contact force and arc position are unknowns and the response is added to the beam's. Otherwise the
        force follows from the displacements, and the response stands for the whole element.
    """

    source: str
    coefficients: Callable[[Properties], Coefficients]
    contact: ContactResponse
    carries_force: bool


def _chord_normal(stiffness: chord_contact.Stiffness) -> ContactResponse:
    def contact(
        p: Properties, x: Any, lever: Any, _xi: Any, _force: Any, side: float, offset: float
    ) -> tuple[Array, Array]:
        return chord_contact.response(stiffness, p, x, lever, side, offset)

    return contact


ELEMENTS: dict[str, ElementType] = {
    "mixed": ElementType(
        source="contact force as unknown, full derivative, strains of the Reissner rod to fourth order",
        coefficients=bowed_coefficients,
        contact=mixed_contact.response,
        carries_force=True,
    ),
    "mixed-no-bow": ElementType(
        source="`mixed` with the linear strains of the paper's element",
        coefficients=linear_coefficients,
        contact=mixed_contact.response,
        carries_force=True,
    ),
    "timoshenko": ElementType(
        source="[P] (9)-(12), corrected",
        coefficients=linear_coefficients,
        contact=_chord_normal(chord_contact.timoshenko),
        carries_force=False,
    ),
}

"""Element types by name: what a beam does between contacts, and what it does at one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tsm.elements import as_printed, cantilever, chord_contact, mixed_contact
from tsm.elements.beam import (
    Coefficients,
    bowed_coefficients,
    linear_coefficients,
    unsheared_coefficients,
)
from tsm.elements.chord_contact import ElementForce, simply_supported
from tsm.elements.properties import Array, Properties

ContactResponse = Callable[[Properties, Any, Any, Any, Any, float, float], tuple[Array, Array]]


@dataclass(frozen=True, kw_only=True)
class ElementType:
    """One way to write the element force equation.

    Attributes
    ----------
    source : str
        Where the equations stand.
    contact_unknowns : int
        Unknowns that a closed contact adds: force (2) and arc position, and the section's angle if the element is cut there; or
        none, where the force follows from the displacements.
    """

    source: str
    contact_unknowns: int


@dataclass(frozen=True, kw_only=True)
class ClosedForm(ElementType):
    """An element whose force follows from its nodes' displacements in closed form.

    Attributes
    ----------
    coefficients : callable
        Coefficients of the beam's energy from its constants, see `beam.Coefficients`.
    contact : callable
        ``(properties, x, lever, xi, force, side, offset) -> (gradient, tangent)`` over element (6), node (2) and
        the contact's unknowns. See `mixed_contact.response`. Where it has none, the response stands for the whole element,
        otherwise it is added to the beam's.
    """

    coefficients: Callable[[Properties], Coefficients]
    contact: ContactResponse

    @property
    def sheared(self) -> bool:
        """Whether the beam deforms in shear; the Euler-Bernoulli beam does not, whatever its section."""
        return self.coefficients is not unsheared_coefficients


def _chord_normal(element_force: ElementForce) -> ContactResponse:
    def contact(
        p: Properties, x: Any, lever: Any, _xi: Any, _force: Any, side: float, offset: float
    ) -> tuple[Array, Array]:
        try:
            with np.errstate(all="ignore"):
                return chord_contact.response(element_force, p, x, lever, side, offset)
        except ArithmeticError:
            # plain numbers raise where arrays overflow or divide by zero
            return np.full(8, np.nan), np.full((8, 8), np.nan)

    return contact


def _of_paper(
    source: str, coefficients: Callable[[Properties], Coefficients], element_force: ElementForce
) -> ClosedForm:
    return ClosedForm(
        source=source,
        coefficients=coefficients,
        contact=_chord_normal(element_force),
        contact_unknowns=0,
    )


EXACT = ElementType(
    source="the Reissner rod's own equations, integrated from load to load", contact_unknowns=4
)

CLOSED_FORM: dict[str, ClosedForm] = {
    "mixed": ClosedForm(
        source="contact force as unknown, full derivative, strains of the Reissner rod to fourth order",
        coefficients=bowed_coefficients,
        contact=mixed_contact.response,
        contact_unknowns=3,
    ),
    "mixed-no-bow": ClosedForm(
        source="`mixed` with the linear strains of the paper's element",
        coefficients=linear_coefficients,
        contact=mixed_contact.response,
        contact_unknowns=3,
    ),
    "timoshenko": _of_paper(
        "[P] (9)-(12), corrected", linear_coefficients, simply_supported(chord_contact.timoshenko)
    ),
    "euler-bernoulli-simple": _of_paper(
        "[P] (5)-(6), corrected", unsheared_coefficients, simply_supported(chord_contact.euler_bernoulli)
    ),
    "euler-bernoulli-cantilever": _of_paper(
        "[P] (7)-(8), corrected", unsheared_coefficients, cantilever.clamped(cantilever.euler_bernoulli)
    ),
    "timoshenko-as-printed": _of_paper(
        "[P] (9)-(12) with its misprints", linear_coefficients, simply_supported(as_printed.timoshenko)
    ),
    "euler-bernoulli-simple-as-printed": _of_paper(
        "[P] (5)-(6) with its misprint",
        unsheared_coefficients,
        simply_supported(as_printed.euler_bernoulli),
    ),
    "euler-bernoulli-cantilever-as-printed": _of_paper(
        "[P] (7)-(8) with its misprints",
        unsheared_coefficients,
        cantilever.clamped(as_printed.euler_bernoulli_cantilever),
    ),
}

ELEMENTS: dict[str, ElementType] = {**CLOSED_FORM, "exact": EXACT}

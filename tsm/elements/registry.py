"""Element types by name: what a beam does between contacts, and what it does at one."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

from tsm.elements import as_printed, cantilever, chord_contact, mixed_contact
from tsm.elements.beam import Coefficients, bowed_coefficients, linear_coefficients
from tsm.elements.chord_contact import ElementForce, simply_supported
from tsm.elements.contact_law import ContactLaw
from tsm.elements.properties import Properties


@dataclass(frozen=True, kw_only=True)
class ElementType(ABC):
    """One way to write the element force equation.

    Attributes
    ----------
    source : str
        Where the equations stand.
    sheared : bool
        Whether the beam deforms in shear. Otherwise its shear number is zero, whatever the section.
    """

    source: str
    sheared: bool = True

    @property
    @abstractmethod
    def contact_unknowns(self) -> int:
        """Number of unknowns that a closed contact adds to the system."""


@dataclass(frozen=True, kw_only=True)
class Integrated(ElementType):
    """An element whose equations are integrated. Contacts cut it: force (2), arc position and the section's angle are unknowns."""

    @property
    def contact_unknowns(self) -> int:
        """Number of unknowns that a closed contact adds to the system."""
        return 4


@dataclass(frozen=True, kw_only=True)
class ClosedForm(ElementType):
    """An element whose force follows from its nodes' displacements in closed form.

    Attributes
    ----------
    coefficients : callable
        Coefficients of the beam's energy from its constants, see `beam.Coefficients`.
    contact : ContactLaw
        What a contact inside the element does.
    order : int
        Order of the errors of forces and shapes in the element's length.
    bearable_turn : float
        Angle between its ends up to which the element is an approximation [rad]: there its first neglected term leaves a fifth of the
        force.
    shear_floor : (float, int)
        Factor and power of the shear strain F/GA that give the error that no number of elements removes. Measured on KS, F/GA 1e-3 to
        3e-2.
    """

    coefficients: Callable[[Properties], Coefficients]
    contact: ContactLaw
    order: int = 2
    bearable_turn: float = 1.0
    shear_floor: tuple[float, int] = (1.0, 2)

    @property
    def contact_unknowns(self) -> int:
        """Number of unknowns that a closed contact adds to the system."""
        return self.contact.unknowns

    def constants(self, p: Properties) -> Properties:
        """Return the section's constants as this element has them."""
        return p if self.sheared else p._replace(Phi=0.0 * p.Phi)


def _of_paper(source: str, element_force: ElementForce, *, sheared: bool) -> ClosedForm:
    return ClosedForm(
        source=source,
        coefficients=linear_coefficients,
        contact=chord_contact.law(element_force),
        sheared=sheared,
    )


EXACT = Integrated(source="the Reissner rod's own equations, integrated from load to load")

CLOSED_FORM: dict[str, ClosedForm] = {
    "mixed": ClosedForm(
        source="contact force as unknown, full derivative, strains of the Reissner rod to fourth order",
        coefficients=bowed_coefficients,
        contact=mixed_contact.LAW,
        order=4,
        bearable_turn=2.0,
        shear_floor=(0.3, 3),
    ),
    "mixed-no-bow": ClosedForm(
        source="`mixed` with the linear strains of the paper's element",
        coefficients=linear_coefficients,
        contact=mixed_contact.LAW,
    ),
    "timoshenko": _of_paper(
        "[P] (9)-(12), corrected", simply_supported(chord_contact.timoshenko), sheared=True
    ),
    "euler-bernoulli-simple": _of_paper(
        "[P] (5)-(6), corrected", simply_supported(chord_contact.euler_bernoulli), sheared=False
    ),
    "euler-bernoulli-cantilever": _of_paper(
        "[P] (7)-(8), corrected", cantilever.clamped(cantilever.euler_bernoulli), sheared=False
    ),
    "timoshenko-as-printed": _of_paper(
        "[P] (9)-(12) with its misprints", simply_supported(as_printed.timoshenko), sheared=True
    ),
    "euler-bernoulli-simple-as-printed": _of_paper(
        "[P] (5)-(6) with its misprint", simply_supported(as_printed.euler_bernoulli), sheared=False
    ),
    "euler-bernoulli-cantilever-as-printed": _of_paper(
        "[P] (7)-(8) with its misprints",
        cantilever.clamped(as_printed.euler_bernoulli_cantilever),
        sheared=False,
    ),
}

ELEMENTS: dict[str, ElementType] = {**CLOSED_FORM, "exact": EXACT}

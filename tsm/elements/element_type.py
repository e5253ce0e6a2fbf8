"""The contract of an element type. Solver, accuracy, extremes and pictures use an element through it alone."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

from tsm.elements.beam import Coefficients
from tsm.elements.contact_law import ContactLaw
from tsm.elements.properties import Properties


@dataclass(frozen=True, kw_only=True)
class ElementType(ABC):
    """One way to write the element force equation."""

    name: str  # key of `tsm.ELEMENTS`
    source: str  # source of the equations
    # whether the beam deforms in shear. Otherwise its shear number is zero, for any section
    sheared: bool = True
    # whether the element exists only for comparison with another one, as an element with misprints or
    # without a term. The matrix of extreme cases does not have it
    variant: bool = False
    # largest bend between the ends for which the element is an approximation [rad]; infinite for an element
    # that refines itself
    bearable_turn: float = math.inf
    # colour, marker: how figures draw its answers: a colour in hexadecimal digits, a marker of matplotlib
    colour: str = "#666666"
    marker: str = "v"

    @property
    @abstractmethod
    def meshed(self) -> bool:
        """Whether the error falls with the number of elements."""

    @property
    @abstractmethod
    def contact_unknowns(self) -> int:
        """Number of unknowns that a closed contact adds to the system."""

    @property
    @abstractmethod
    def on_varying(self) -> Integrated | None:
        """Type of the elements of a beam that is curved or tapered, has a load along it, or friction; None where they cannot state it."""


@dataclass(frozen=True, kw_only=True)
class Integrated(ElementType):
    """An integrated element. A contact cuts it; force (2), arc position and section angle are unknowns."""

    # Gauss nodes of every segment; None where their number follows from the accuracy
    nodes: int | None = None

    contact_unknowns = 4

    @property
    def meshed(self) -> bool:
        """Whether the number of nodes is fixed. Otherwise one element is as accurate as many."""
        return self.nodes is not None

    @property
    def on_varying(self) -> Integrated:
        """The same."""
        return self


@dataclass(frozen=True, kw_only=True)
class ClosedForm(ElementType):
    """An element whose force follows from its nodes' displacements in closed form."""

    # coefficients of the beam's energy from its constants, see `beam.Coefficients`
    coefficients: Callable[[Properties], Coefficients]
    contact: ContactLaw  # law of a contact inside the element
    order: int = 2  # order of the errors of forces and shapes in the element's length
    bearable_turn: float = 1.0  # the first neglected term is then a fifth of the force
    # type of the elements of a beam that is curved or tapered, has a load along it, or a contact with friction
    varying: Integrated | None = None
    # factor and power of the shear strain F/GA in the error that no number of elements removes, measured on
    # KS for F/GA from 1e-3 to 3e-2
    shear_floor: tuple[float, int] = (1.0, 2)

    meshed = True

    @property
    def contact_unknowns(self) -> int:
        """Number of unknowns that a closed contact adds to the system."""
        return self.contact.unknowns

    @property
    def on_varying(self) -> Integrated | None:
        """The type in `varying`, which shears."""
        return self.varying if self.sheared else None

    def constants(self, p: Properties) -> Properties:
        """Return the section's constants as this element has them."""
        return p if self.sheared else p._replace(Phi=0.0 * p.Phi)

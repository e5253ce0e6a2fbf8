"""The elements whose contact force is an unknown."""

from tsm.elements import mixed_contact
from tsm.elements.beam import bowed_coefficients, linear_coefficients
from tsm.elements.contact_law import ContactLaw
from tsm.elements.element_type import ClosedForm, Integrated

LAW = ContactLaw(
    response=mixed_contact.response, energy=mixed_contact.energy, cross=mixed_contact.cross_compliance
)
"""The contact law whose force and arc position are unknowns."""

_COLOUR = "#009E73"
VARYING = Integrated(
    name="mixed",
    source="the functional of the Reissner rod, a cubic rotation, three Gauss nodes from load to load",
    nodes=3,
    bearable_turn=2.0,
    colour=_COLOUR,
    marker="D",
)
"""The elements of a beam that is curved or tapered, has a load along it, or friction, for which there is no closed form."""
MIXED = ClosedForm(
    name="mixed",
    source="contact force as unknown, full derivative, strains of the Reissner rod to fourth order",
    coefficients=bowed_coefficients,
    contact=LAW,
    order=4,
    bearable_turn=2.0,
    shear_floor=(0.3, 3),
    varying=VARYING,
    colour=_COLOUR,
    marker="D",
)
MIXED_NO_BOW = ClosedForm(
    name="mixed-no-bow",
    source="`mixed` with the linear strains of the paper's element",
    coefficients=linear_coefficients,
    contact=LAW,
    variant=True,
    colour=_COLOUR,
    marker="v",
)

ELEMENTS = (MIXED, MIXED_NO_BOW)

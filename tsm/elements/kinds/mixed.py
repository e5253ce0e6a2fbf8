"""The elements whose contact force is an unknown."""

from tsm.elements import mixed_contact
from tsm.elements.beam import bowed_coefficients, linear_coefficients
from tsm.elements.element_type import ClosedForm

MIXED = ClosedForm(
    name="mixed",
    source="contact force as unknown, full derivative, strains of the Reissner rod to fourth order",
    coefficients=bowed_coefficients,
    contact=mixed_contact.LAW,
    order=4,
    bearable_turn=2.0,
    shear_floor=(0.3, 3),
    colour="#009E73",
    marker="D",
)
MIXED_NO_BOW = ClosedForm(
    name="mixed-no-bow",
    source="`mixed` with the linear strains of the paper's element",
    coefficients=linear_coefficients,
    contact=mixed_contact.LAW,
    variant=True,
    colour="#009E73",
    marker="v",
)

ELEMENTS = (MIXED, MIXED_NO_BOW)

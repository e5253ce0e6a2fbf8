"""The elements of the paper, corrected and as printed."""

from __future__ import annotations

from typing import Any

from tsm.elements import as_printed, cantilever, chord_contact
from tsm.elements.beam import linear_coefficients
from tsm.elements.chord_contact import ElementForce, simply_supported
from tsm.elements.element_type import ClosedForm


def _element(name: str, source: str, force: ElementForce, **more: Any) -> ClosedForm:
    return ClosedForm(
        name=name, source=source, coefficients=linear_coefficients, contact=chord_contact.law(force), **more
    )


TIMOSHENKO = _element(
    "timoshenko",
    "[P] (9)-(12), corrected",
    simply_supported(chord_contact.timoshenko),
    colour="#0072B2",
    marker="^",
)
EULER_BERNOULLI_SIMPLE = _element(
    "euler-bernoulli-simple",
    "[P] (5)-(6), corrected",
    simply_supported(chord_contact.euler_bernoulli),
    sheared=False,
    colour="#D55E00",
    marker="o",
)
EULER_BERNOULLI_CANTILEVER = _element(
    "euler-bernoulli-cantilever",
    "[P] (7)-(8), corrected",
    cantilever.clamped(cantilever.euler_bernoulli),
    sheared=False,
    colour="#E69F00",
    marker="s",
)
PAPER = (TIMOSHENKO, EULER_BERNOULLI_SIMPLE, EULER_BERNOULLI_CANTILEVER)

_PRINTED = (
    _element(
        "timoshenko-as-printed",
        "[P] (9)-(12) with its misprints",
        simply_supported(as_printed.timoshenko),
        variant=True,
        colour=TIMOSHENKO.colour,
    ),
    _element(
        "euler-bernoulli-simple-as-printed",
        "[P] (5)-(6) with its misprint",
        simply_supported(as_printed.euler_bernoulli),
        sheared=False,
        variant=True,
        colour=EULER_BERNOULLI_SIMPLE.colour,
    ),
    _element(
        "euler-bernoulli-cantilever-as-printed",
        "[P] (7)-(8) with its misprints",
        cantilever.clamped(as_printed.euler_bernoulli_cantilever),
        sheared=False,
        variant=True,
        colour=EULER_BERNOULLI_CANTILEVER.colour,
    ),
)

ELEMENTS = (*PAPER, *_PRINTED)

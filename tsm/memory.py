"""Estimate of the memory of a solution, before the solution starts."""

from __future__ import annotations

import os

from tsm.elements import ELEMENTS, Integrated
from tsm.structure import Structure

PART = 0.8
"""Part of the machine's memory that a solution may take."""
CLOSED, EXACT_ONE, BORDER = 500, 2100, 50
"""Measured memory of one accepted load parameter [byte]: for an element in closed form, for an exact element, and for each pair of an
element and a contact unknown."""


def needed(structure: Structure, load_parameters: int) -> int:
    """Return the memory of a solution [byte] for all its load parameters, plus one more load parameter that is being solved.

    The unknowns of the contacts couple with all other unknowns and with one another in dense columns.
    """
    kinds = [ELEMENTS[beam.element] for beam in structure.beams]
    elements = sum(beam.elements for beam in structure.beams)
    of_elements = sum(
        beam.elements * (EXACT_ONE if isinstance(kind, Integrated) else CLOSED)
        for beam, kind in zip(structure.beams, kinds, strict=True)
    )
    touched = {beam.name: kind for beam, kind in zip(structure.beams, kinds, strict=True)}
    contact_unknowns = sum(touched[pair.beam].contact_unknowns for pair in structure.contacts)
    dense = BORDER * contact_unknowns * elements + 8 * contact_unknowns**2
    return (load_parameters + 1) * (of_elements + dense)


def check_memory(structure: Structure, load_parameters: int) -> None:
    """Raise unless the solution fits into the memory of the machine.

    Raises ValueError, which says in one line how much it needs.
    """
    there = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    bytes_ = needed(structure, load_parameters)
    if bytes_ > PART * there:
        elements = sum(beam.elements for beam in structure.beams)
        raise ValueError(
            f"load_parameters = {load_parameters}: with {elements} elements and {len(structure.contacts)} contacts needs "
            f"{bytes_ / 1e9:.3g} GB, more than {PART:.0%} of the memory here ({there / 1e9:.3g} GB)"
        )

"""Structures that several tests solve."""

from __future__ import annotations

import tsm

SECTION = tsm.Section(EA=100.0, GA=40.0, EI=1.0)


def cantilever(path, *, elements=10, side="right", element="mixed", offset=0.0):
    """A beam of length 1 along x, clamped at its start, and a pin that pushes it along a path."""
    return tsm.Structure(
        beams=(
            tsm.Beam(
                name="b",
                start=(0.0, 0.0),
                end=(1.0, 0.0),
                section=SECTION,
                elements=elements,
                element=element,
            ),
        ),
        supports=(tsm.Support(beam="b", end="start"),),
        pins=(tsm.Pin(name="p", path=path),),
        contacts=(tsm.ContactPair(node="p", beam="b", side=side, offset=offset),),
    )

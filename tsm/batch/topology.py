"""The topology that structures of a batch must share: all that decides their numbering."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Any

from tsm.model import Model
from tsm.structure import Beam, Structure

_SIZES = {"start", "end", "section", "nodes", "turn", "end_section"}
_KIND = [field.name for field in fields(Beam) if field.name not in _SIZES]


def check_alike(structures: Sequence[Structure]) -> None:
    """Check that all structures are numbered as the first.

    They may differ in coordinates, lengths of elements, sections, pin paths, sides and offsets of their contacts and prescribed displacements.

    Raises
    ------
    ValueError
        Without structures, or naming the first structure that differs, in what, and its value.
    """
    if not structures:
        raise ValueError("structures = []: must not be empty")
    first = topology(structures[0])
    for n, structure in enumerate(structures):
        numbering = topology(structure)
        for what, value in numbering.items():
            if value != first[what]:
                raise ValueError(
                    f"structures[{n}].{what} = {value!r}: must be {first[what]!r}, as in structures[0]"
                )


def topology(structure: Structure) -> dict[str, Any]:
    """Everything that decides the numbering of a structure."""
    ends = [end for beam in structure.beams for end in (beam.start, beam.end)]
    return {
        "beams": [tuple(getattr(beam, name) for name in _KIND) for beam in structure.beams],
        "joints": [ends.index(end) for end in ends],
        "supports": [
            (s.beam, s.end, *(v is not None for v in (s.ux, s.uy, s.rotation))) for s in structure.supports
        ],
        "pins": [pin.name for pin in structure.pins],
        "contacts": [(pair.node, pair.beam) for pair in structure.contacts],
        "hinges": [(hinge.beam, hinge.end) for hinge in structure.hinges],
        "springs": [(spring.beam, spring.end) for spring in structure.springs],
        "stages": structure.stages,
        "loads": [(load.beam, load.end or "inside") for load in structure.loads],
        "line_loads": [load.beam for load in structure.line_loads],
    }


def covered(structures: Sequence[Structure], model: Model) -> bool:
    """Whether the structures can be solved at once: pins without friction drive them, and every contact has its force as unknown.

    Their beams are straight and uniform, without hinges and springs, and their load has one stage.
    """
    driven = any(
        structure.loads
        or structure.line_loads
        or structure.hinges
        or structure.springs
        or structure.stages > 1
        or any(s.ux or s.uy or s.rotation for s in structure.supports)
        for structure in structures
    )
    mixed = all(pair.slot >= 0 and not pair.cuts for pair in model.pairs)
    rubbed = any(pair.friction for structure in structures for pair in structure.contacts)
    varies = any(beam.varies for structure in structures for beam in structure.beams)
    whole = not driven and not rubbed and not varies
    return whole and model.rods is None and len(model.pairs) > 0 and mixed

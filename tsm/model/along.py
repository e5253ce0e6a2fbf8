"""What varies along the elements of a structure: natural curvature, sections of tapered beams, and loads along the beams."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.polynomial import Polynomial

from tsm.elements import ELEMENTS, EXACT, ElementType, Integrated
from tsm.elements.properties import Array
from tsm.elements.rod import Course
from tsm.statement.beam import Beam, LineLoad, check
from tsm.statement.stages import Increments


class Along:
    """Curvature, sections and loads over the elements of all beams, in the order of the structure.

    ``varies`` (e,): elements of the beams that are curved or tapered, or have a load along them.
    ``loaded``: whether there are loads along beams.
    ``length, curvature`` (e,): undeformed length and natural curvature.
    ``start, end`` (e,): angle of the undeformed axis at both ends.
    ``gauge, gyration`` (2, e): radius of gyration ``sqrt(EI/EA)``, in proportion to the height, and `gauge`,
        EA over this radius, in proportion to the width; at both ends. Both are linear between them.
    ``ratio`` (e,): GA/EA, infinite where the elements do not shear.
    ``resultants`` (stages, 2, d, e): resultants of the loads, ``P(s) = int_0^s q ds`` from the start of an
        element: coefficients of the powers 1 to d of the part of its length.
    """

    def __init__(self, beams: Sequence[Beam], loads: Sequence[LineLoad], stages: int = 1) -> None:
        self.loaded = bool(loads)
        laden = {load.beam for load in loads}
        spans = [(beam, *part) for beam in beams for part in pairwise(beam.parts)]
        own = [beam for beam, _, _ in spans]
        self.varies = np.array([beam.varies or beam.name in laden for beam in own])
        self.length = np.array([(b - a) * beam.length for beam, a, b in spans])
        self.curvature = np.array([beam.curvature for beam in own])
        self.start = np.array([beam.direction(a) for beam, a, _ in spans])
        self.end = np.array([beam.direction(b) for beam, _, b in spans])
        self.gauge, self.gyration = np.array([_sections(*span) for span in spans]).transpose(2, 1, 0)
        sections = ((beam.section, ELEMENTS[beam.element].sheared) for beam in own)
        self.ratio = np.array(
            [section.GA / section.EA if sheared else np.inf for section, sheared in sections]
        )
        degree = max((len(load.force) for load in loads), default=0)
        resultant = np.zeros((stages, 2, degree, len(spans)))
        names = [beam.name for beam in own]
        for load in loads:
            first = names.index(load.beam)
            for place in (first + element for element in load.elements(spans[first][0])):
                resultant[load.stage, :, : len(load.force), place] += _integral(load, *spans[place])
        self.resultants = Increments(resultant)

    def total(self, load_parameter: float) -> Array:
        """Sum (2,) of all loads along the beams at a load parameter."""
        return self.resultants.at(load_parameter).sum(axis=(1, 2))

    def course(self, elements: Array, part: Array, resultant: Array, resultant_rate: Array) -> Course:
        """What varies at parts (s, p) of the lengths of elements (s,), from resultants (2, d, s) and their rates."""
        length, own = self.length[elements, None], (self.gauge, self.gyration)
        (wide, wider), (high, higher) = (
            (a + (b - a) * part, b - a) for a, b in (x[:, elements, None] for x in own)
        )
        stretch = 1 / (wide * high)
        flexibility = np.array([stretch, stretch / self.ratio[elements, None], stretch / high**2])
        rise = (wider / wide + np.array([1, 1, 3])[:, None, None] * higher / high) / length
        degrees = np.arange(1, resultant.shape[1] + 1)[:, None, None]
        powers, risen = part**degrees, degrees * part ** (degrees - 1) / length
        pairs = (resultant, powers), (resultant, risen), (resultant_rate, powers)
        P, q, rate = (np.einsum("cds,dsp->csp", coefficients, on) for coefficients, on in pairs)
        return Course(flexibility, -flexibility * rise, P, q, rate)


def kind_of(beam: Beam, *, varies: bool, rubbed: bool) -> ElementType:
    """Type of a beam's elements; of one with friction the integrated one, if there is one.

    Raises ValueError if the beam has what its elements cannot state.
    """
    kind = ELEMENTS[beam.element]
    if not varies:
        return kind.on_varying or kind if rubbed else kind
    able = ", ".join(name for name, other in ELEMENTS.items() if other.on_varying)
    rule = f"such elements are straight and uniform, without loads along them; use {able}"
    check(kind.on_varying is not None, f"Beam({beam.name})", "element", beam.element, rule)
    return kind.on_varying or kind


def gauss_nodes(beams: Sequence[tuple[Beam, ElementType]]) -> int | None:
    """Fixed number of Gauss nodes of the elements that contacts cut, None where it follows from the accuracy.

    Raises ValueError if it is fixed for some of them only.
    """
    counts = {kind.nodes: beam for beam, kind in beams if isinstance(kind, Integrated)}
    fixed = next((beam for nodes, beam in counts.items() if nodes), beams[0][0])
    rule = f'must be "{EXACT.name}" as of other beams here, since the beam is curved or tapered, has a load along it, or friction'
    check(len(counts) < 2, f"Beam({fixed.name})", "element", fixed.element, rule)
    return next(iter(counts), None)


def _sections(beam: Beam, begin: float, end: float) -> Array:
    """``EA/sqrt(EI/EA)`` and ``sqrt(EI/EA)`` at two parts of the length of a beam."""
    both = beam.section, beam.end_section or beam.section
    gyrations = ((section.EI / section.EA) ** 0.5 for section in both)
    first, last = (np.array([one.EA / high, high]) for one, high in zip(both, gyrations, strict=True))
    return np.array([first + part * (last - first) for part in (begin, end)])


def _integral(load: LineLoad, beam: Beam, begin: float, end: float) -> Array:
    """Coefficients (2, d) of the powers 1 to d of the part of an element's length, of the load's integral from its start."""
    inside = Polynomial([begin, end - begin])
    length = beam.length * (end - begin)
    rows = [(Polynomial(force)(inside) * length).integ().coef[1:] for force in np.array(load.force).T]
    return np.array([np.pad(row, (0, len(load.force) - len(row))) for row in rows])

"""The allowed error of a model against Reissner's rod, from the theory of its elements, fixed before any run.

Discretisation. Let an element of length l bend by the angle t between its ends. Its chord has the length
``l 2 sin(t/2)/t = l (1 - t^2/24 + t^4/1920 - ...)``. The strain measures of an element keep the first terms of this series, and its
error is the first term that they neglect: t^2/24 for an element of second order, t^4/1920 for one of fourth order. The slopes of a
biquadratic solid have an error of at most t^2/12, and its error is the square of this number.

Allowance. A relative error of a length changes a force about twice as much. A mesh of straight elements or of solids has, besides,
the contact at a wrong place of a curved beam. Four times the neglected term is therefore allowed, and twice the term for elements
whose contact lies on a curve.

Round-off. Positions are accurate to eps L. The direction of an element of length l has therefore an error of eps L/l, a kink without
force. A contact force or position changes by `CHANGE` times the kink. In the paper's elements the contact force is a stiffness times a
deflection, and the round-off of a position is multiplied by the stiffness EI/l^3 instead. A contact force that is an unknown of the
system has no such factor.
"""

from math import factorial
from typing import Any, NamedTuple

import numpy as np

from comparisons.answer import Response
from comparisons.scene import BeamSpec

MESH = 4.0
"""Allowed error over the first neglected term, for a contact on straight elements or on solids."""
CURVED = 2.0
"""Allowed error over the first neglected term, for an element whose contact lies on a curve."""
EXACT = 1e-10
"""Allowed error of exact elements, a tenth of their default integration accuracy; the quadrature order that they choose leaves less."""
FLOOR = 1e-9
"""Error that Newton's method leaves at its tolerance: the least allowance of a discrete model."""
ROUND_OFF = 1e-11
"""Allowed difference between two exact answers."""
CHANGE = 10.0
"""Condition number: relative change of an answer over the change of a prescribed position in beam lengths. For the force that bends
a beam to a half circle, as a function of the half height, the number is 6."""


class Bending(NamedTuple):
    """Bending and shear of the exact answer, as dimensionless maxima over the load parameters."""

    force: float = 0.0  # force, curvature: ``F L^2/EI`` and ``kappa L``
    curvature: float = 0.0
    # angle by which the contact force turns, equal to the bending angle of the part between clamp and
    # contact [rad]
    turn: float = 0.0
    nearest: float = 1.0  # smallest distance between contact and clamp, over L


def bending(beam: BeamSpec, exact: Response) -> Bending:
    """Return the bending of `beam`, clamped along +x, in the answer `exact`."""
    if not len(exact.load_parameter):
        return Bending()
    clamp = exact.supports[f"{beam.name}.start"]
    x, y = -clamp.force.T
    force = np.hypot(x, y)
    turn = np.where(force > 0.0, np.abs(np.arctan2(-x, y)), 0.0)
    # beyond a right angle the moment is largest where the axis points along the force, and there m^2 = 2 F EI
    inner = np.where(turn > np.pi / 2, np.sqrt(2 * force * beam.EI), 0.0)
    arcs = [contact.arc_position for contact in exact.contacts.values()]
    return Bending(
        force=float(force.max()) * beam.length**2 / beam.EI,
        curvature=float(np.maximum(np.abs(clamp.moment), inner).max()) * beam.length / beam.EI,
        turn=float(turn.max()),
        nearest=float(np.fmin.reduce(np.ravel(arcs), initial=beam.length)) / beam.length,
    )


def chord_term(turn: Any, order: int) -> Any:
    """Return the magnitude of the term of order `order` in the series of ``2 sin(t/2)/t``: t^2/24 or t^4/1920.

    >>> 1 / chord_term(1.0, 2), 1 / chord_term(1.0, 4)
    (24.0, 1920.0)
    """
    return turn**order / (2.0**order * factorial(order + 1))


def ordinal(order: int) -> str:
    """Return the order of an element as a word."""
    words = {1: "first", 2: "second", 3: "third", 4: "fourth"}
    return words.get(order, f"{order}th")


def element_lengths(beam: BeamSpec, elements: int | None) -> tuple[float, float]:
    """Return the longest and the shortest of a beam's elements, or of another number of equal ones, over the length."""
    if elements or not beam.nodes:
        return (1 / (elements or beam.divisions),) * 2
    lengths = np.diff([0.0, *beam.nodes, 1.0])
    return float(lengths.max()), float(lengths.min())

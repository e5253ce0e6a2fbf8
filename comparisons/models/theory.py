"""The error that a model may have against Reissner's rod by its own theory, fixed before anything is run.

Let an element of length l turn by the angle t. Its chord is ``2 sin(t/2)/t = 1 - t^2/24 + t^4/1920 - ...`` of it: an element whose strain
measures stop before a term is off by that term, an element of second order by t^2/24, one of fourth order by t^4/1920; a
biquadratic solid, whose slopes are off by t^2/12 at most, by the square of that. Forces feel a length about twice, and a mesh of straight
elements or of solids puts the contact on the wrong place of a curved beam: four times the term is allowed to them, and twice to elements whose
contact lies on a curve.

Positions are good to their last bit, eps L. An element of length l between two of them turns by eps L/l without any force, a kink, and a
force or a place follows by `CHANGE` times that. Where the contact force is a stiffness times a deflection, as in the paper's elements, the last
bit is multiplied by the stiffness EI/l^3 instead. A contact force that is an unknown multiplies nothing.
"""

from dataclasses import dataclass
from math import factorial
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.models.options import Options
from comparisons.scene import Scene

if TYPE_CHECKING:
    from tsm.elements import ElementType

MESH = 4.0
"""Multiple of the first neglected term that is allowed."""
CURVED = 2.0
"""The same for an element whose contact lies on a curve."""
EXACT = 1e-10
"""A tenth of the accuracy that exact elements are asked for in their own scales: the rule of the order that they choose leaves less."""
FLOOR = 1e-9
"""What Newton's method leaves at its tolerance, where nothing else is larger."""
DEFAULT_PENALTY = 25.0
"""Penalty stiffness of the solid where none is given, over E b."""
ROUND_OFF = 1e-11
"""Between exact answers."""
CHANGE = 10.0
"""Relative change of an answer over the change of a place in lengths: a half circle's force over its half height has 6."""


@dataclass(frozen=True, kw_only=True)
class Bending:
    """How much the exact answer bends and shears the beam, largest over the load parameters; dimensionless.

    Attributes
    ----------
    force : float
        ``F L^2/EI``.
    curvature : float
        ``kappa L``.
    turn : float
        Angle of the contact force, the turn of the loaded part [rad].
    nearest : float
        Smallest distance of the contact from the clamp, over L.
    """

    force: float = 0.0
    curvature: float = 0.0
    turn: float = 0.0
    nearest: float = 1.0


def chord_term(turn: Any, order: int) -> Any:
    """Return the term of ``2 sin(t/2)/t`` with the power `order` of the turn t, without its sign: 1/24 of t^2, 1/1920 of t^4.

    >>> 1 / chord_term(1.0, 2), 1 / chord_term(1.0, 4)
    (24.0, 1920.0)
    """
    return turn**order / (2.0**order * factorial(order + 1))


def ordinal(order: int) -> str:
    """Return the order of an element as a word."""
    words = {1: "first", 2: "second", 3: "third", 4: "fourth"}
    return words.get(order, f"{order}th")


def element_lengths(scene: Scene, options: Options) -> tuple[float, float]:
    """Return the longest and the shortest beam element of the first beam, over the length."""
    beam = scene.beams[0]
    if options.elements or not beam.nodes:
        count = options.elements or beam.elements
        return 1 / count, 1 / count
    lengths = np.diff([0.0, *beam.nodes, 1.0])
    return float(lengths.max()), float(lengths.min())


def beam_errors(kind: "ElementType", scene: Scene, options: Options, bent: Bending) -> dict[str, float]:
    """Return the parts of the error of TSM elements, by reason."""
    from tsm.elements import ClosedForm

    if not isinstance(kind, ClosedForm):
        return {"accuracy of the integration": EXACT}
    beam = scene.beams[0]
    longest, shortest = element_lengths(scene, options)
    turn = min(bent.curvature * longest, bent.turn)
    force = bent.force * beam.EI / beam.length**2
    slip, stretch = force / beam.GA, force / beam.EA
    last_bit = 4 * np.finfo(float).eps
    term = float(chord_term(turn, kind.order))
    order = ordinal(kind.order)
    if not kind.contact_unknowns:
        return {
            f"{order} order of the element": MESH * term,
            "force normal to the chord, not to the mean tangent of the kink F/GA": slip
            if kind.sheared
            else 0.0,
            "stretch left out of the lever arms": stretch,
            "tolerance of Newton's method": FLOOR,
            "round-off of positions, felt by EI/l^3": last_bit / shortest**3 / max(bent.force, 1.0),
        }
    inside = min(longest / bent.nearest, 1.0)
    return {
        f"{order} order of the element": CURVED * term,
        "third power of the shear strain": slip**3,
        "jump of the shear strain within the element": inside * slip**2 / 2,
        "tolerance of Newton's method": FLOOR,
        "round-off of positions, a kink of eps/l": CHANGE * last_bit / shortest,
    }


def solid_errors(scene: Scene, options: Options, bent: Bending) -> dict[str, float]:
    """Return the parts of the difference between a solid of the rod's law and the rod, by reason."""
    beam = scene.beams[0]
    length = 1 / (options.mesh or beam.mesh)[0]
    turn = min(bent.curvature * length, bent.turn)
    assert beam.height is not None, "the strip is a rectangle"
    assert beam.width is not None, "the strip is a rectangle"
    slender = beam.height / beam.length
    strain = slender * bent.curvature / 2
    contraction = abs(beam.poissons_ratio or 0.0) * strain * slender / 4
    penalty = DEFAULT_PENALTY * beam.youngs_modulus * beam.width
    return {
        "a bent strip, softer by 4/5 of the square of its strain": strain**2,
        "shear and dent of a strip of this height": 2 * slender**2,
        "clamp at the middle of a section that contracts, nu kappa h^2/8 beside the fibre that keeps its length": CHANGE
        * contraction,
        "square of the slope's error in a biquadratic element": MESH * (turn**2 / 12) ** 2,
        "kink of the curvature at the contact, F/EI, rounded by the axis's spline": bent.force
        * (length / 2) ** 2
        / 12,
        "default penalty": MESH * bent.force * beam.EI / beam.length**3 / penalty,
        "tolerance of Newton's method": FLOOR,
    }


def elastica_errors(scene: Scene, bent: Bending) -> dict[str, float]:
    """Return the parts of the difference between elastica and rod."""
    beam = scene.beams[0]
    soft = beam.EI / beam.length**2 * (1 / beam.EA + 1 / beam.GA)
    return {
        "stretch and shear, EI/s^2 (1/EA + 1/GA) with the nearest s": CHANGE**2 * soft / bent.nearest**2,
        "round-off": ROUND_OFF,
    }

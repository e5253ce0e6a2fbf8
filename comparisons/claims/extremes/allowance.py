"""The error that a model may have by its own theory, fixed before anything is run: what "right" means in a cell.

Let an element of length l turn by the angle t. Its chord is ``2 sin(t/2)/t = 1 - t^2/24 + t^4/1920 - ...`` of it: an element whose strain
measures stop before a term is off by that term, the paper's (straight between their nodes) by t^2/24, `mixed` by t^4/1920; a
biquadratic solid, whose slopes are off by t^2/12 at most, by the square of that. Forces feel a length about twice, and a mesh of straight
elements or of solids puts the contact on the wrong place of a curved beam: four times the term is allowed to them, and twice to `mixed`, whose
contact lies on a curve.

Positions are good to their last bit, eps L. An element of length l between two of them turns by eps L/l without any force, a kink, and a
force or a place follows by `CHANGE` times that. Where the contact force is a stiffness times a deflection, as in the paper's elements, the last
bit is multiplied by the stiffness EI/l^3 instead. The force of `mixed` is an unknown: nothing is multiplied.
"""

from dataclasses import dataclass

import numpy as np

from comparisons.cases.case import Case
from comparisons.claims.claim import Allowance
from comparisons.response import Response
from comparisons.scene import BeamSpec

MESH = 4.0
"""Multiple of the first neglected term that is allowed."""
CURVED = 2.0
"""The same for `mixed`."""
EXACT = 1e-10
"""A tenth of the accuracy that exact elements are asked for in their own scales: the rule of the order that they choose leaves less."""
FLOOR = 1e-9
"""What Newton's method leaves at its tolerance, where nothing else is larger."""
DEFAULT_PENALTY = 25.0
"""Penalty stiffness of the solid where none is given, over E b."""
ROUND_OFF = 1e-11
"""Between exact answers."""
LARGEST = 0.2
"""An answer further off is wrong, whatever the theory of its model says: it should have stopped."""
CHANGE = 10.0
"""Relative change of an answer over that of a place, in lengths: that of the force of a half circle by its half height is 6."""
RIGID = ("euler-bernoulli-simple", "euler-bernoulli-cantilever")
"""The elements that do not shear."""
PAPER = ("timoshenko", *RIGID)
"""The elements of the paper, whose misprints are corrected."""


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


def bending(beam: BeamSpec, exact: Response) -> Bending:
    """Return how much the answer `exact` bends `beam`, clamped along +x."""
    if not len(exact.load_parameter):
        return Bending()
    force = -exact.supports[beam.name].force
    moment = np.abs(exact.supports[beam.name].moment)
    loaded = np.hypot(*force.T) > 0.0
    # beyond a right angle the moment is largest where the axis points along the force, and there m^2 = 2 F EI
    turn = np.abs(np.arctan2(-force[loaded, 0], force[loaded, 1]))
    inner = np.where(turn > np.pi / 2, np.sqrt(2 * np.hypot(*force[loaded].T) * beam.EI), 0.0)
    largest_moment = max(float(moment.max(initial=0.0)), float(inner.max(initial=0.0)))
    arcs = [np.fmin.reduce(contact.arc_position, initial=beam.length) for contact in exact.contacts.values()]
    return Bending(
        force=float(np.hypot(*force.T).max(initial=0.0)) * beam.length**2 / beam.EI,
        curvature=largest_moment * beam.length / beam.EI,
        turn=float(turn.max(initial=0.0)),
        nearest=float(min(arcs, default=beam.length)) / beam.length,
    )


def allowance(case: Case, bent: Bending) -> Allowance:
    """Return the error allowed to `case` against the Reissner rod that bends as `bent` says, to an approximation of it `LARGEST` at most."""
    parts = _PARTS[case.model](case, bent)
    largest = max(parts, key=lambda why: parts[why])
    error = sum(parts.values())
    if case.model != "elastica" and not error <= LARGEST:
        return Allowance(error=LARGEST, why=f"more is wrong, although theory allows it: {largest}")
    return Allowance(error=error, why=largest)


def _beams(case: Case, bent: Bending) -> dict[str, float]:
    """Return the parts of the error of TSM elements, by reason."""
    beam, element = case.scene.beams[0], case.options.element or "mixed"
    if element == "exact":
        return {"accuracy of the integration": EXACT}
    longest, shortest = element_lengths(case)
    turn = min(bent.curvature * longest, bent.turn)
    force = bent.force * beam.EI / beam.length**2
    slip, stretch = force / beam.GA, force / beam.EA
    last_bit = 4 * np.finfo(float).eps
    if element in PAPER:
        return {
            "second order of the element": MESH * turn**2 / 24,
            "force normal to the chord, not to the mean tangent of the kink F/GA": 0.0
            if element in RIGID
            else slip,
            "stretch left out of the lever arms": stretch,
            "tolerance of Newton's method": FLOOR,
            "round-off of positions, felt by EI/l^3": last_bit / shortest**3 / max(bent.force, 1.0),
        }
    inside = min(longest / bent.nearest, 1.0)
    return {
        "fourth order of the element": CURVED * turn**4 / 1920,
        "third power of the shear strain": slip**3,
        "jump of the shear strain within the element": inside * slip**2 / 2,
        "tolerance of Newton's method": FLOOR,
        "round-off of positions, a kink of eps/l": CHANGE * last_bit / shortest,
    }


def _solid(case: Case, bent: Bending) -> dict[str, float]:
    """Return the parts of the difference between a solid of the rod's law and the rod, by reason."""
    beam = case.scene.beams[0]
    length = element_lengths(case)[0]
    turn = min(bent.curvature * length, bent.turn)
    assert beam.height is not None, "solids of the matrix are rectangles"
    assert beam.width is not None, "solids of the matrix are rectangles"
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


def element_lengths(case: Case) -> tuple[float, float]:
    """Return the longest and the shortest element of a TSM or solid case, over the length."""
    beam = case.scene.beams[0]
    if case.model == "solid":
        along = (case.options.mesh or beam.mesh)[0]
        return 1 / along, 1 / along
    if case.options.elements or not beam.nodes:
        count = case.options.elements or beam.elements
        return 1 / count, 1 / count
    lengths = np.diff([0.0, *beam.nodes, 1.0])
    return float(lengths.max()), float(lengths.min())


def _elastica(case: Case, bent: Bending) -> dict[str, float]:
    """Return the parts of the difference between elastica and rod."""
    beam = case.scene.beams[0]
    soft = beam.EI / beam.length**2 * (1 / beam.EA + 1 / beam.GA)
    return {
        "stretch and shear, EI/s^2 (1/EA + 1/GA) with the nearest s": CHANGE**2 * soft / bent.nearest**2,
        "round-off": ROUND_OFF,
    }


_PARTS = {"tsm": _beams, "solid": _solid, "elastica": _elastica}

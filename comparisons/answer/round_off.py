"""Round-off of the numbers that an answer states, by the scale of each quantity."""

import math

import numpy as np

from comparisons.answer.record import Answer
from comparisons.frozen import Value
from comparisons.scene import BeamSpec, Scene

LAST_PLACES, UNRESOLVED = 8 * float(np.finfo(float).eps), 1e-4
"""Round-off of a force, over EA, and its limit, over the largest force. Positions have an error of a few units in the last place. A
stretch computed from them has the same error, and the axial force has EA times this error."""
LEAST = 1e-4
"""Smallest force, over ``EI/L^2``, that another force is relative to."""
RESIDUAL = 1e-10
"""Residual force at which Newton's methods end, over ``EI/L^2``."""
DIGITS = 6
"""Significant digits of a printed number."""


def force_round_off(scene: Scene, largest: float) -> float:
    """Return the round-off of a force where the largest force is `largest`: `LAST_PLACES` of EA, at most `UNRESOLVED` of the largest."""
    return min(LAST_PLACES * max(beam.EA for beam in scene.beams), UNRESOLVED * largest)


def least_force(scene: Scene) -> float:
    """Return the force below which nothing acts: `LEAST` times the smallest ``EI/L^2`` of the beams."""
    return LEAST * min(beam.EI / beam.length**2 for beam in scene.beams)


def residual_force(scene: Scene) -> float:
    """Return the force that Newton's methods leave unbalanced: `RESIDUAL` times the largest ``EI/L^2`` of the beams."""
    return RESIDUAL * max(beam.EI / beam.length**2 for beam in scene.beams)


class RoundOff(Value):
    """What is not resolved of each kind of quantity; a smaller number is printed as 0."""

    force: float = 0.0  #: `force_round_off` or, where it is larger, `RESIDUAL`.
    moment: float = 0.0  #: That of a force times the length of the longest beam.
    energy: float = 0.0  #: As of a moment.
    #: `LAST_PLACES` of the size of the scene, or the deflection ``F L^3/EI`` by that of a force.
    length: float = 0.0
    #: That of a force over the smallest area, and of a moment over the smallest section modulus.
    stress: float = 0.0
    number: float = 0.0  #: Zero: a number without a scale is printed as it is.

    def text(self, value: float, kind: str) -> str:
        """Return a number of a kind with `DIGITS` significant digits, fewer where the last ones are round-off; nan is a dash.

        Examples
        --------
        >>> found = RoundOff(force=1e-9)
        >>> [found.text(value, "force") for value in (2.0 / 3.0, 1.23456e-7, -3e-12, float("nan"))]
        ['0.666667', '1.23e-07', '0', '-']
        """
        if not math.isfinite(value):
            return "-" if math.isnan(value) else f"{value:g}"
        step = getattr(self, kind)
        if abs(value) <= step:
            return "0"
        resolved = DIGITS if step == 0.0 else min(DIGITS, 1 + math.floor(math.log10(abs(value) / step)))
        return f"{value:.{resolved}g}"


def round_off(response: Answer, scene: Scene) -> RoundOff:
    """Return the round-off of an answer to a scene."""
    acting = (response.contacts | response.supports).values()
    largest = max((float(np.abs(one.force).max(initial=0.0)) for one in acting), default=0.0)
    force = max(force_round_off(scene, max(largest, least_force(scene))), residual_force(scene))
    longest = max(beam.length for beam in scene.beams)
    places = [*scene.meeting, (longest, 0.0)]
    deflections = (force * beam.length**3 / beam.EI for beam in scene.beams)
    return RoundOff(
        force=force,
        moment=force * longest,
        energy=force * longest,
        length=max(LAST_PLACES * float(np.abs(places).max()), *deflections),
        stress=max(_stress(beam, force, force * longest) for beam in scene.beams),
    )


def _stress(beam: BeamSpec, force: float, moment: float) -> float:
    sections = [(beam.section(fraction), beam.height_at(fraction)) for fraction in (0.0, 1.0)]
    return max(force / area + moment * height / (2.0 * inertia) for (area, inertia, _), height in sections)

"""Constants of the elements and the rotation of their chords.

Axes: element first in every array of the package. An element has the six displacements
``(u_i, v_i, theta_i, u_j, v_j, theta_j)``; rotations are measured from the undeformed state.

The functions here take plain numbers, arrays, and complex values of either: derivatives are tested by complex steps.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

Array = np.ndarray[Any, np.dtype[Any]]


class Properties(NamedTuple):
    """Constants of elements: arrays (one entry per element) or plain numbers (one element)."""

    dx0: Any  # dx0, dy0: undeformed chord, from end i to end j [length]
    dy0: Any
    l0: Any  # undeformed length
    EA: Any  # EA, EI: axial and bending stiffness
    EI: Any
    Phi: Any  # shear number ``12 Psi / l0^2`` with ``Psi = EI/(G A_e)``


def chord_rotation(cross: Any, dot: Any) -> Any:
    """Angle of a chord from its undeformed direction, in (-pi, pi]."""
    if isinstance(cross, float):
        return math.atan2(cross, dot)
    if not np.iscomplexobj(cross):
        return np.arctan2(cross, dot)
    # an imaginary part is a step
    c, d = cross.real, dot.real
    angle: Any = np.arctan2(c, d) + 1j * ((cross.imag * d - c * dot.imag) / (c * c + d * d))
    return angle


def unwind(angle: Any) -> Any:
    """Angle less its whole turns."""
    if isinstance(angle, float):
        return math.remainder(angle, math.tau)
    return angle - math.tau * np.rint(np.real(angle) / math.tau)


def from_chord(p: Properties, x: Any) -> tuple[Any, Any, Any, Any]:
    """Chord (dx, dy) of elements with displacements x (6), and the rotations of both ends from it."""
    dx, dy = p.dx0 + (x[3] - x[0]), p.dy0 + (x[4] - x[1])
    turn = chord_rotation(p.dx0 * dy - p.dy0 * dx, p.dx0 * dx + p.dy0 * dy)
    return dx, dy, unwind(x[2] - turn), unwind(x[5] - turn)


def tangent_of(angle: Any) -> Any:
    """Tangent of an angle."""
    return math.tan(angle) if isinstance(angle, float) else np.tan(angle)


def cosine(angle: Any) -> Any:
    """Cosine of an angle."""
    return math.cos(angle) if isinstance(angle, float) else np.cos(angle)


def sine(angle: Any) -> Any:
    """Sine of an angle."""
    return math.sin(angle) if isinstance(angle, float) else np.sin(angle)

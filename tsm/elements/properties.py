"""Constants of the elements and the rotation of their chords.

Axes: element first in every array of the package. An element has the six displacements
``(u_i, v_i, theta_i, u_j, v_j, theta_j)``; rotations are measured from the undeformed state.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

Array = np.ndarray[Any, np.dtype[Any]]


class Properties(NamedTuple):
    """Constants of elements: arrays (one entry per element) or plain numbers (one element).

    Attributes
    ----------
    dx0, dy0 : float or ndarray
        Undeformed chord, from end i to end j [length].
    l0 : float or ndarray
        Undeformed length.
    EA, EI : float or ndarray
        Axial and bending stiffness.
    Phi : float or ndarray
        Shear number ``12 Psi / l0^2`` with ``Psi = EI/(G A_e)``.
    """

    dx0: Any
    dy0: Any
    l0: Any
    EA: Any
    EI: Any
    Phi: Any


def chord_rotation(cross: Any, dot: Any) -> Any:
    """Angle of a chord from its undeformed direction, in (-pi, pi], analytic for complex steps."""
    angle = np.arctan2(np.real(cross), np.real(dot))
    if np.iscomplexobj(cross) or np.iscomplexobj(dot):
        step = (np.imag(cross) * np.real(dot) - np.real(cross) * np.imag(dot)) / np.real(dot**2 + cross**2)
        return angle + 1j * step
    return angle


def unwind(angle: Any) -> Any:
    """Angle less its whole turns."""
    return angle - 2 * np.pi * np.round(np.real(angle) / (2 * np.pi))

"""A contact as rows of the equations: the direction of its face, slip or stick by Coulomb's law, and the couple of a face.

With the direction t of the face and its angle phi, its left normal n, the part ``a = t . (r'_- + r'_+)/2`` of the mean tangent, the
section's rotation theta from its undeformed direction beta, the natural curvature kappa0 and the whole one ``k = theta' + kappa0``, and
``lever``, the radius of the circle whose envelope is the face, and ``roll = R`` to the right of the beam, minus these values to its left::

    n . (r'_- + r'_+)/2 = -offset'          direction of the face
    F_t = F . t,  F_n = side F . n           tangential and normal force on the beam, side = 1 for a node on the right
    m_- - m_+ = C = lever F_t                couple on the section, since F acts on the face
    v = A s' + lever psi' + roll phi'        slip rate, A = a + lever k and psi = phi - theta - beta
    slip:   F_t = sigma mu F_n,  sigma = sign v
    stick:  v = 0,  or (A + A*)/2 (s - s*) + lever (psi - psi*) + roll (phi - phi*) = c

The power of the node is the rate of the strain energy and ``F_t v``. Starred values are those where the stick began, and c is the error of the
trapezium of v, which `friction.slip` finds along the path; where the height tapers the lever in stick is the mean of the two. Without a
taper t is along the mean tangent. The couple and the row of phi take the place of the two conditions of stationarity in arc position and
phi, which hold without friction only.
"""

import math
from typing import Any

import numpy as np

from comparisons.answer import Array
from comparisons.referee.elements import STEP
from comparisons.referee.grip import LOOSE
from comparisons.referee.layout import Layout, Touch
from comparisons.referee.rod import value


def rows(layout: Layout, touch: Touch, z: Array, moment: float) -> tuple[list[int], Array, Array]:
    """Return numbers; row of friction, couple, row of the direction, A and psi; and their derivatives (5, 8) by the numbers."""
    before, behind = layout.beside(touch)
    turn = int(layout.stations[touch.station].numbers[2])
    forces = [before.force, before.force + 1, behind.force, behind.force + 1]
    # theta, c before the contact and behind it, phi, the moment before it, which has no number, and s
    numbers = [turn, *forces, touch.angle, -1, touch.arc]
    real = layout.full(z)[numbers]
    real[6] = moment
    given = real[:, None] + 1j * STEP * np.eye(len(real))
    theta, phi, m, s = given[0], given[5], given[6], given[7]
    piece, face, grip = before.piece, touch.face, touch.grip or LOOSE
    mean = (piece.tangent(given[1:3], s, theta) + behind.piece.tangent(given[3:5], s, theta)) / 2.0
    force, lever = given[1:3] - given[3:5], face.lever(s)
    cos, sin = np.cos(phi), np.sin(phi)
    aligned = mean[1] * cos - mean[0] * sin + face.tilt
    a = mean[0] * cos + mean[1] * sin if face.slope else (mean[0] ** 2 + mean[1] ** 2) ** 0.5
    x, y = (cos, sin) if face.slope else mean / a
    drag, push = force[0] * x + force[1] * y, face.left * (force[0] * y - force[1] * x)
    couple = lever * drag
    stretch = a + lever * ((m - couple / 2.0) / value(piece.coefficients[:, 2], s) + piece.curvature)
    shear = phi - theta - piece.angle(s)
    row, hold = drag - grip.slip * grip.friction * push, grip.hold
    if hold is not None:
        row = (stretch + hold.stretch) / 2.0 * (s - hold.arc_position) - hold.area(layout.load_parameter)
        if touch.angle >= 0:
            lever = (lever + face.lever(hold.arc_position)) / 2.0
            row = row + lever * wrapped(shear - hold.shear)
            row = row - face.left * face.radius * (phi - hold.direction)
    values = np.array([row, couple, aligned, stretch, shear])
    return numbers, values[:, 0].real, values.imag / STEP


def wrapped(angle: Any) -> Any:
    """Angle less the multiple of 2 pi next to it; phi is measured from the axes of the scene, theta from the undeformed beam."""
    return angle - 2.0 * math.pi * np.round(np.real(angle) / (2.0 * math.pi))

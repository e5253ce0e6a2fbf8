"""Cantilevers of elements with a rubbing pin against exact answers: a dense Newton's method, no march and no events."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import root

from tsm.elements import beam
from tsm.elements.contact_law import Rub, Surface
from tsm.elements.mixed_friction import FRICTION
from tsm.elements.properties import Properties

# the cantilever of the KS scene, of length 1
EI, EA, GA = 2.1e4 * 0.02**4 / 12, 2.1e4 * 4e-4, 2.1e4 / 2.6 * 4e-4 * 5 / 6


class Cantilever:
    """Cantilever along +x of elements of one length, with a pin from the right that slides on it."""

    def __init__(self, elements, *, mu, sigma, face=0.0, radius=0.0):
        length = 1 / elements
        self.p = Properties(length, 0.0, length, EA, EI, 12 * EI / (GA * length**2))
        self.coefficients = beam.bowed_coefficients(Properties(*(np.full(elements, v) for v in self.p)))
        self.elements, self.mu, self.sigma = elements, mu, sigma
        self.face, self.surface = face, Surface(1.0, face + radius)
        self.q, self.force, self.arc = np.zeros(3 * elements + 3), np.zeros(2), 1 - 1e-3

    @property
    def rub(self):
        return Rub(self.sigma * self.mu, None, EI, self.face, self.surface.offset - self.face)

    def contact(self, pin):
        """Element and the contact's arguments there."""
        length = self.p.l0
        e = min(int(self.arc / length), self.elements - 1)
        x = self.q[3 * e : 3 * e + 6]
        lever = (e * length + x[0] - pin[0], x[1] - pin[1])
        return e, (self.p, x, lever, self.arc / length - e, self.force, self.surface, self.rub)

    def solve(self, pin):
        """Newton's method, in lengths and forces of 1 and EI."""
        count = 3 * self.elements + 3
        for _ in range(40):
            x = np.array([self.q[3 * e : 3 * e + 6] for e in range(self.elements)]).T
            forces, blocks = beam.response(self.coefficients, x)
            residual, tangent = np.zeros(count + 3), np.zeros((count + 3, count + 3))
            for e in range(self.elements):
                own = slice(3 * e, 3 * e + 6)
                residual[own] += forces[:, e]
                tangent[own, own] += blocks[:, e].reshape(6, 6)
            e, arguments = self.contact(pin)
            rows, block = FRICTION.response(*arguments)
            places = np.r_[3 * e : 3 * e + 6, count : count + 3]
            entries = np.r_[:6, 8:11]
            residual[places] += rows[entries]
            tangent[np.ix_(places, places)] += block[np.ix_(entries, entries)]
            step = np.linalg.solve(tangent[3:, 3:], -residual[3:])
            part = min(1.0, 0.2 / np.abs(step[:-3]).max(), max(self.p.l0, 0.04) / 2 / abs(step[-1]))
            self.q[3:] += part * step[:-3]
            self.force = self.force + part * step[-3:-1]
            self.arc = min(self.arc + part * step[-1], 1.0)
            if part == 1.0 and max(np.abs(step[:-3]).max(), abs(step[-1])) < 1e-10:
                return
        pytest.fail("Newton's method did not converge")

    def march(self, path, steps):
        for part in np.linspace(0, 1, steps + 1)[1:]:
            self.solve(path(part))
        return float(np.hypot(*self.force)), float(self.arc)


def exact_rod(pin, start, *, slide, face, radius):
    """Size of the force on a rod and its arc position, of Reissner's equations, with ``slide = sigma mu``.

    The tail beyond the pin is straight and without load; the couple ``face F_t`` is the moment before the pin.
    """

    def tangent(theta, force):
        c, s = np.cos(theta), np.sin(theta)
        stretch, shear = 1 + (force[0] * c + force[1] * s) / EA, (force[1] * c - force[0] * s) / GA
        return np.array([stretch * c - shear * s, stretch * s + shear * c])

    def residual(unknowns):
        force, arc, moment = unknowns[:2] * EI, unknowns[2], unknowns[3] * EI

        def rate(_, y):
            tx, ty = tangent(y[2], force)
            return arc * np.array([tx, ty, y[3] / EI, -(tx * force[1] - ty * force[0])])

        x, y, theta, last = solve_ivp(
            rate, (0, 1), [0, 0, 0, moment], method="DOP853", rtol=1e-11, atol=1e-14
        ).y[:, -1]
        mean = (tangent(theta, force) + np.array([np.cos(theta), np.sin(theta)])) / 2
        t = mean / np.hypot(*mean)
        n = np.array([-t[1], t[0]])
        along, across = force @ t, force @ n
        gap = np.array([x, y]) - (face + radius) * n - pin
        return [*gap, (last - face * along) / EI, (along - slide * across) / EI]

    found = root(residual, start, tol=1e-12)
    assert found.success
    return float(np.hypot(*found.x[:2])) * EI, float(found.x[2])


def test_sliding_pin_on_the_axis_has_the_force_of_the_rod():
    """KS scene at half of the pin's path, mu = 0.3: errors of fourth order, against the rod's 12 digits."""
    errors = []
    for elements in (8, 16, 32):
        structure = Cantilever(elements, mu=0.3, sigma=-1)
        force, arc = structure.march(lambda part: (1 - part / 2, part / np.pi), 20)
        errors.append((abs(force / 1.440282590723e-3 - 1), abs(arc - 0.613373425413)))
    assert (np.array(errors) < [(2e-6, 1e-6), (2.5e-7, 6e-8), (1e-8, 3e-9)]).all()


@pytest.mark.parametrize(
    ("mu", "force", "arc"),
    [
        (0.1, 2.1935803158557e-3, 0.873335466586),
        (0.3, 2.110304862086e-3, 0.847142560461),
        (0.5, 2.122282811362e-3, 0.831119109269),
    ],
)
def test_pin_that_slides_back_has_the_force_of_the_rod(mu, force, arc):
    """KS scene at the end of the pin's path, where it slides towards the tip."""
    structure = Cantilever(20, mu=0.0, sigma=1)
    structure.march(lambda part: (1 - part, part * 2 / np.pi), 40)
    for part in (0.5, 1.0):
        structure.mu = mu * part
        structure.solve((0, 2 / np.pi))
    assert np.hypot(*structure.force) == pytest.approx(force, rel=1e-6)
    assert structure.arc == pytest.approx(arc, abs=3e-7)


@pytest.mark.parametrize(("face", "radius"), [(0.01, 0.0), (0.05, 0.0), (0.05, 0.1)])
def test_pin_on_a_face_has_the_force_of_the_rod(face, radius):
    """The couple has the lever of the face, the place of the pin the whole offset."""
    pin = np.array([0.6, 0.25 - face - radius])
    for elements, bound in ((8, 1e-6), (16, 1e-7)):
        structure = Cantilever(elements, mu=0.3, sigma=-1, face=face, radius=radius)
        found = structure.march(lambda part: (1 - 0.4 * part, 0.25 * part - face - radius), 24)
        start = [*(structure.force / EI), structure.arc, 0.6 * structure.force[1] / EI]
        force, arc = exact_rod(pin, start, slide=-0.3, face=face, radius=radius)
        assert abs(found[0] / force - 1) < bound
        assert abs(found[1] - arc) < bound

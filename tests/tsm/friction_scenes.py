"""Cantilevers under a pin with friction, stated and drawn."""

from dataclasses import dataclass

import numpy as np

import tsm
from comparisons.exact import FrictionPath, Surface, rod_with_friction
from tests.tsm.structures import KS

LAST = (0.0, 2 / np.pi)
"""Where the pin of Konyukhov and Schweizerhof ends, for a beam of length 1."""


@dataclass(frozen=True, kw_only=True)
class Cantilever:
    """A cantilever of length 1 along x, under a pin below it."""

    section: tsm.Section
    friction: float
    path: tuple[tuple[float, float], ...]
    face: float = 0.0
    radius: float = 0.0

    def structure(self, element: str = "exact", elements: int = 1) -> tsm.Structure:
        beam = tsm.Beam(
            name="beam", start=(0.0, 0.0), end=(1.0, 0.0), section=self.section, elements=elements, element=element
        )  # fmt: skip
        pair = tsm.ContactPair(
            node="pin", beam="beam", side="right",
            offset=self.face + self.radius, friction=self.friction, radius=self.radius,
        )  # fmt: skip
        return tsm.Structure(
            beams=(beam,),
            supports=(tsm.Support(beam="beam", end="start"),),
            pins=(tsm.Pin(name="pin", path=self.path),),
            contacts=(pair,),
        )

    def solve(self, steps: int, element: str = "exact", elements: int = 1) -> tsm.Result:
        structure = self.structure(element, elements)
        return tsm.solve(structure, np.linspace(1 / steps, 1, steps), throw=False)

    def exact(self, steps: int) -> tuple[FrictionPath, np.ndarray]:
        """Independent answer, and its entries at the load parameters of `solve`."""
        (pin,) = self.structure().pins
        wanted = np.linspace(1 / steps, 1, steps)
        times = np.union1d([0.0, *wanted], pin.corners)
        path = rod_with_friction(
            [pin.position(float(t)) for t in times], friction=self.friction, length=1.0,
            EA=self.section.EA, GA=self.section.GA, EI=self.section.EI,
            surface=Surface(offset=self.face, radius=self.radius),
        )  # fmt: skip
        return path, np.searchsorted(times, wanted)


def ks(friction: float, section: tsm.Section = KS, face: float = 0.0, radius: float = 0.0) -> Cantilever:
    path = ((1.0, -face - radius), LAST)
    return Cantilever(section=section, friction=friction, path=path, face=face, radius=radius)


def drawn(seed: int) -> Cantilever:
    """Cantilever under a pin that goes one to three ways, starts on the beam or below it, on the axis, a face, or with a radius."""
    r = np.random.default_rng(seed)
    slender = 10 ** r.uniform(-4, -1.5)
    section = tsm.Section(EI=1.0, EA=1 / slender, GA=r.uniform(0.2, 0.5) / slender)
    friction = r.uniform(0, 1) if r.random() < 0.8 else 10 ** r.uniform(-4, 0)
    face, radius = r.choice([0, 0, 1]) * r.uniform(0, 0.05), r.choice([0, 0, 1]) * r.uniform(0, 0.05)
    start = r.uniform(0.3, 1.0) if r.random() < 0.7 else 1.0
    gap = 0.0 if r.random() < 0.6 else r.uniform(0, 0.05)
    way = [(r.uniform(-0.1, 1.0), r.uniform(0.05, 0.75)) for _ in range(r.integers(1, 4))]
    path = tuple((float(x), float(y)) for x, y in [(start, -face - radius - gap), *way])
    return Cantilever(
        section=section, friction=float(friction), path=path, face=float(face), radius=float(radius)
    )

"""Cantilevers under pins, drawn at random, at whose clamps the material force vanishes."""

import math
from collections.abc import Iterator

import numpy as np

from comparisons.scene import BeamSpec, ContactSpec, PinSpec, Scene, SupportSpec

BEAM = "b"


def drawn_cantilever(rng: np.random.Generator) -> Scene:
    """Return a beam of any length and direction, clamped at either end, under one or two pins from either side.

    h/L is .001 to .1, the pins touch the axis or the face, some are round, and some clamps move and turn.
    """
    length, height = 10 ** rng.uniform(-2, 2), 10 ** rng.uniform(-3, -1)
    way, mirror, backwards = rng.uniform(0.0, 2.0 * math.pi), rng.choice([-1.0, 1.0]), bool(rng.integers(2))
    place = rng.uniform(-5.0, 5.0, 2) * length
    face, count = bool(rng.integers(2)), 2 if rng.integers(4) == 0 else 1
    radius = 10 ** rng.uniform(-2, -1) if rng.integers(3) == 0 else 0.0
    turn = np.array([[math.cos(way), -math.sin(way)], [math.sin(way), math.cos(way)]])

    def point(x: float, y: float) -> tuple[float, float]:
        """Point of the scene at distances along and across the undeformed beam, seen from the clamp and over the length."""
        a, b = place + length * turn @ (x, mirror * y)
        return float(a), float(b)

    root, tip = point(0.0, 0.0), point(1.0, 0.0)
    moves = rng.integers(3) == 0
    drift = tuple(float(x) for x in length * rng.uniform(-0.02, 0.02, 2)) if moves else (0.0, 0.0)
    depth = (height / 2.0 if face else 0.0) + radius
    pins = []
    for number in range(count):
        x = rng.uniform(0.2, 1.0) if count == 1 else rng.uniform(0.3, 0.5) + 0.4 * number
        angle, far = math.radians(rng.uniform(20, 160)), rng.uniform(0.02, 0.6 if count == 1 else 0.2)
        ends = point(x, -depth), point(x + far * math.cos(angle), -depth + far * math.sin(angle))
        pins.append(PinSpec(name=f"p{number}", path=ends, radius=radius * length or None))
    return Scene(
        name="drawn",
        load_parameters=10,
        beams=(
            BeamSpec(
                name=BEAM,
                start=tip if backwards else root,
                end=root if backwards else tip,
                width=height * length,
                height=height * length,
                youngs_modulus=1.0,
                poissons_ratio=0.3,
            ),
        ),
        supports=(
            SupportSpec(
                beam=BEAM,
                end="end" if backwards else "start",
                kind="clamped",
                displacement=drift,
                rotation=float(rng.uniform(-0.2, 0.2)) if moves else None,
            ),
        ),
        pins=tuple(pins),
        contacts=tuple(
            ContactSpec(
                node=pin.name,
                beam=BEAM,
                side="right" if (mirror > 0.0) != backwards else "left",
                surface="face" if face else "axis",
            )
            for pin in pins
        ),
    )


def drawn_cantilevers(count: int, seed: int = 0) -> Iterator[Scene]:
    """Yield as many scenes."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        yield drawn_cantilever(rng)

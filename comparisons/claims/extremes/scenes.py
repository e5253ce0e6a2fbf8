"""The scenes of the matrix: one cantilever of length 1 and modulus 1 along +x, clamped at the origin, unless they say otherwise."""

import math
from dataclasses import replace
from typing import Any

from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene
from comparisons.scene.rules import Point

SLENDERNESS = 50.0
"""Default slenderness L/h, taken from Konyukhov and Schweizerhof's cantilever."""


def cantilever(
    *, length: float = 1.0, youngs_modulus: float = 1.0, slenderness: float = SLENDERNESS, **more: Any
) -> BeamSpec:
    """Return a beam of square section; `more` goes to `BeamSpec`."""
    h = length / slenderness
    section = {"width": h, "height": h, "poissons_ratio": 0.3, "material": "biot-linear"}
    return _clamped(length=length, youngs_modulus=youngs_modulus, **section | more)


def _clamped(*, length: float = 1.0, youngs_modulus: float = 1.0, **section: Any) -> BeamSpec:
    ends: dict[str, Any] = {"start": (0.0, 0.0), "end": (length, 0.0)}
    return BeamSpec(name="beam", **ends, youngs_modulus=youngs_modulus, clamped=("start",), **section)


def sheared(psi: float) -> BeamSpec:
    """Return the cantilever with ``psi = EI/(GA L^2)``, and with EA and EI of `cantilever`."""
    h = 1 / SLENDERNESS
    second_moment = h**4 / 12
    return _clamped(shear_modulus=second_moment / psi / h**2, area=h**2, second_moment=second_moment)


def rigid_in_shear(beam: BeamSpec) -> BeamSpec:
    """Return `beam` as an Euler-Bernoulli element sees it, rigid in shear."""
    return replace(beam, poissons_ratio=None, shear_modulus=1e9 * beam.youngs_modulus)


def pushed(beam: BeamSpec, *path: Point, steps: int, **contact: Any) -> Scene:
    """Return `beam` under a pin that follows `path` from below; `contact` goes to `ContactSpec`."""
    return Scene(
        name="pushed",
        load_parameters=steps,
        beams=(beam,),
        pins=(PinSpec(name="pin", path=path),),
        contacts=(ContactSpec(node="pin", beam="beam", side="right", **contact),),
    )


def half_circle(beam: BeamSpec, *, steps: int = 10, surface: str = "axis", **contact: Any) -> Scene:
    """Return the path of Konyukhov and Schweizerhof: from the tip to the end of a half circle with the beam's length."""
    L, below = beam.length, 0.0 if surface == "axis" else -beam.height_at(0.5) / 2
    return pushed(beam, (L, below), (0.0, below + 2 * L / math.pi), steps=steps, surface=surface, **contact)


def raised(beam: BeamSpec, x: float, lift: float, *, steps: int = 10) -> Scene:
    """Return a pin under the beam at `x` that moves straight up."""
    return pushed(beam, (x, 0.0), (x, lift), steps=steps)


def rolled_up(beam: BeamSpec, turns: int, *, steps: int = 8) -> Scene:
    """Return `beam` under a moment at its tip that bends it to `turns` circles."""
    moment = 2 * math.pi * turns * beam.EI / beam.length
    return Scene(
        name="rolled-up",
        load_parameters=steps,
        beams=(beam,),
        loads=(LoadSpec(beam="beam", end="end", moment=moment),),
    )


def cycles(beam: BeamSpec, count: int) -> Scene:
    """Return a pin under ``.9 L`` that touches, lifts the beam by ``.1 L`` and leaves it, `count` times; two states a cycle."""
    L = beam.length
    low, high = (0.9 * L, -0.1 * L), (0.9 * L, 0.1 * L)
    return pushed(beam, low, *(high, low) * count, steps=2 * count)

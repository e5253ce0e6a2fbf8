"""The Konyukhov-Schweizerhof cantilever, built with `tsm` alone."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

import tsm

YOUNGS_MODULUS = 2.1e4


@pytest.fixture(scope="session")
def ks() -> Callable[..., tsm.Structure]:
    def build(
        elements: int = 10,
        element: str = "mixed",
        *,
        offset: float = 0.0,
        start: tuple[float, float] = (1.0, 0.0),
        side: str = "right",
    ) -> tsm.Structure:
        section = tsm.Section.rectangle(
            width=0.02, height=0.02, youngs_modulus=YOUNGS_MODULUS, shear_modulus=YOUNGS_MODULUS / 2.6
        )
        x, y = start[0], start[1] - offset
        return tsm.Structure(
            beams=(
                tsm.Beam(
                    name="cantilever",
                    start=(0.0, 0.0),
                    end=(1.0, 0.0),
                    section=section,
                    elements=elements,
                    element=element,
                ),
            ),
            supports=(tsm.Support(beam="cantilever", end="start"),),
            pins=(tsm.Pin(name="pin", path=((x, y), (x - 1.0, y + 2 / math.pi))),),
            contacts=(tsm.ContactPair(node="pin", beam="cantilever", side=side, offset=offset),),
        )

    return build

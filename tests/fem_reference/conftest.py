"""Strips, pins and solutions that several tests share."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import fem_reference as fr
from fem_reference.model import Model, build

Make = Callable[..., Any]


def _strip(**changes: Any) -> fr.Strip:
    values: dict[str, Any] = {
        "name": "cantilever",
        "start": (0.0, 0.0),
        "end": (1.0, 0.0),
        "height": 0.02,
        "width": 0.02,
        "youngs_modulus": 2.1e4,
        "poissons_ratio": 0.3,
        "mesh": (50, 2),
    }
    return fr.Strip(**(values | changes))


def _problem(
    path: Any = None, side: str = "right", surface: str = "axis", penalty: float = 1e4, **changes: Any
) -> fr.SolidProblem:
    y = -0.01 if surface == "face" else 0.0
    ks = ((1.0, y), (0.0, y + 2 / np.pi))
    contact = fr.Contact(pin="pin", strip="cantilever", side=side, surface=surface, penalty=penalty)
    return fr.SolidProblem(strip=_strip(**changes), pin=fr.Pin(name="pin", path=path or ks), contact=contact)


@pytest.fixture(scope="session")
def strip() -> Make:
    return _strip


@pytest.fixture(scope="session")
def problem() -> Make:
    """The KS cantilever, or another path and other strips."""
    return _problem


@pytest.fixture(scope="session")
def small_model() -> Model:
    """A short strip on a coarse mesh."""
    return build(_problem(path=((0.95, 0.0), (0.5, 0.2)), height=0.2, mesh=(5, 2)))


@pytest.fixture(scope="session")
def ks_axis() -> fr.Result:
    return fr.solve(_problem(), np.arange(1, 51) / 50)


@pytest.fixture(scope="session")
def ks_face() -> fr.Result:
    return fr.solve(_problem(surface="face"), np.arange(1, 51) / 50)

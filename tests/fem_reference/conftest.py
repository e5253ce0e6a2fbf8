"""Strips, pins and solutions that several tests share."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import fem_reference as fr
from fem_reference.model import Model

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
    path: Any = None, radius: float = 0.0, contact: dict[str, Any] | None = None, **changes: Any
) -> fr.SolidProblem:
    values: dict[str, Any] = {"node": "pin", "strip": "cantilever", "penalty": 1e4} | (contact or {})
    y = (-0.01 if values.get("surface") == "face" else 0.0) - radius
    ks = ((1.0, y), (0.0, y + 2 / np.pi))
    return fr.SolidProblem(
        strips=(_strip(**changes),),
        pins=(fr.Pin(name="pin", path=path or ks, radius=radius),),
        contacts=(fr.Contact(**values),),
    )


@pytest.fixture(scope="session")
def strip() -> Make:
    return _strip


@pytest.fixture(scope="session")
def problem() -> Make:
    """The KS cantilever, or another path and other strips."""
    return _problem


def _with_pin(model: Model, point: Any, **changes: Any) -> Model:
    place = tuple(map(float, point))
    pin = fr.Pin(name="pin", path=(place, (place[0] + 1.0, place[1])), **changes)
    return replace(model, pairs=(replace(model.pairs[0], node=pin),))


@pytest.fixture(scope="session")
def with_pin() -> Callable[..., Model]:
    """The model with its pin at a point at the load parameter 0."""
    return _with_pin


@pytest.fixture(scope="session")
def ks_axis() -> fr.Result:
    return fr.solve(_problem(), np.arange(1, 51) / 50)


@pytest.fixture(scope="session")
def ks_face() -> fr.Result:
    return fr.solve(_problem(contact={"surface": "face"}), np.arange(1, 51) / 50)

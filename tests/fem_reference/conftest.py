"""Strips, pins, solutions and dense matrices that several tests share."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import fem_reference as fr
from fem_reference.arrays import Floats
from fem_reference.model import Model
from fem_reference.state import State

Make = Callable[..., Any]
STRIP, PAIR = "cantilever", "pin->cantilever"
E, B, NU, STEP = 2.1e4, 0.02, 0.3, 1e-30
surfaces = pytest.mark.parametrize("surface", ["axis", "face"])


def loads(n: int) -> Floats:
    """Load parameters ``1/n, 2/n, ..., 1``."""
    return np.arange(1, n + 1) / n


def rotation(angle: float) -> Floats:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def make_strip(**changes: Any) -> fr.Strip:
    ends = {"name": STRIP, "start": (0.0, 0.0), "end": (1.0, 0.0), "mesh": (50, 2)}
    section = {"height": 0.02, "width": B, "youngs_modulus": E, "poissons_ratio": NU}
    return fr.Strip(**(ends | section | changes))


def make_problem(path: Any = None, radius: float = 0.0, contact: Any = None, **changes: Any) -> Any:
    """The KS cantilever, or another path and other strips."""
    values: dict[str, Any] = {"node": "pin", "strip": STRIP, "penalty": 1e4} | (contact or {})
    y = (-0.01 if values.get("surface") == "face" else 0.0) - radius
    pin = fr.Pin(name="pin", path=path or ((1.0, y), (0.0, y + 2 / np.pi)), radius=radius)
    return fr.SolidProblem(strips=(make_strip(**changes),), pins=(pin,), contacts=(fr.Contact(**values),))


@pytest.fixture(scope="session")
def strip() -> Make:
    return make_strip


@pytest.fixture(scope="session")
def problem() -> Make:
    return make_problem


def place_pin(model: Model, point: Any, **changes: Any) -> Model:
    """The model with its pin at a point at the load parameter 0."""
    x, y = map(float, point)
    pin = fr.Pin(name="pin", path=((x, y), (x + 1.0, y)), **changes)
    return replace(model, pairs=(replace(model.pairs[0], node=pin),))


def dense_hessian(model: Model, state: State) -> tuple[Floats, list[Floats]]:
    """Hessian ``K - sum lam g''`` over the unknowns with constant contact forces, and the gaps' gradients."""
    A, start, gradients = np.zeros((model.unknowns, model.unknowns)), 0, []
    for body, part in model.bodies_and_nodes():
        block = body.tangent(state.u[part]).toarray()
        A[start : start + len(block), start : start + len(block)] = block
        start += len(block)
    for touch in state.closed:
        U = model.expansion.T @ touch.slopes
        A -= touch.force * U @ touch.curvature @ U.T
        gradients.append(U[:, 0])
    return A, gradients


@pytest.fixture(scope="session")
def ks_axis() -> fr.Result:
    return fr.solve(make_problem(), loads(50))


@pytest.fixture(scope="session")
def ks_face() -> fr.Result:
    return fr.solve(make_problem(contact={"surface": "face"}), loads(50))

"""Strips, pins, solutions and dense matrices that several tests share."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import fem_reference as fr
from fem_reference.arrays import Floats
from fem_reference.model import Model
from fem_reference.state import State, section_actions

Make = Callable[..., Any]
STRIP, PAIR, CLAMP = "cantilever", "pin->cantilever", "cantilever.start"
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


def make_portal(pin: fr.Pin, moment: float = 2e-5) -> fr.SolidProblem:
    """A portal frame on a moving clamp and a roller, with a moment at a corner and a pin on its girder."""
    part = {"mesh": (6, 1), "height": 0.06, "clamped": ()}
    corners = (0.0, 0.0), (0.0, 0.8), (1.0, 0.8), (1.1, 0.0)
    ends = {"left": corners[:2], "girder": corners[1:3], "right": corners[2:]}
    return fr.SolidProblem(
        strips=tuple(make_strip(name=name, start=a, end=b, **part) for name, (a, b) in ends.items()),
        pins=(pin,),
        contacts=(fr.Contact(node="pin", strip="girder", side="left", surface="face"),),
        supports=(
            fr.Support(strip="left", end="start", motion=(0.01, 0.02, -0.1)),
            fr.Support(strip="right", end="end", motion=(None, -0.01, None)),
        ),
        joints=(fr.Joint(ends=("left.end", "girder.start")), fr.Joint(ends=("right.start", "girder.end"))),
        loads=(fr.EndLoad(strip="girder", end="start", force=(1e-4, 0.0), moment=moment),),
    )


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
    """Hessian ``K - sum lam g'' - sum m theta''`` over the unknowns with constant forces, and the gradients of gaps and ties."""
    A, start, gradients = np.zeros((model.unknowns, model.unknowns)), 0, []
    for body, part in model.bodies_and_nodes():
        block = body.tangent(state.u[part]).toarray()
        A[start : start + len(block), start : start + len(block)] = block
        start += len(block)
    for touch in state.closed:
        U = model.expansion.T @ touch.slopes
        A -= touch.force * U @ touch.curvature @ U.T
        gradients.append(U[:, 0])
    columns = np.split(model.expansion.T @ model.columns, max(len(model.sections), 1), axis=1)
    for U, pose, action in zip(columns, state.poses, section_actions(model, state), strict=False):
        A -= action[2] * U @ pose.curvature @ U.T
    for tie in model.ties:
        gradient = columns[tie.section] @ state.poses[tie.section].gradient[:, tie.component]
        if tie.other is not None:
            gradient = gradient - columns[tie.other] @ state.poses[tie.other].gradient[:, tie.component]
        gradients.append(gradient)
    return A, gradients


@pytest.fixture(scope="session")
def ks_axis() -> fr.Result:
    return fr.solve(make_problem(), loads(50))


@pytest.fixture(scope="session")
def ks_face() -> fr.Result:
    return fr.solve(make_problem(contact={"surface": "face"}), loads(50))

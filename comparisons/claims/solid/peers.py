"""The solid against CalculiX: a dead load at the tip, and a pin on the face."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from comparisons.models import ROD
from comparisons.models.outside.adapters.calculix import Answer, pressed, tip_load
from comparisons.models.solid import to_solid
from comparisons.output import Report, Row
from comparisons.response import Array
from comparisons.scene import load_scene

if TYPE_CHECKING:
    from fem_reference import SolidProblem, Strip

LOADS = (1.0, 5.0)
"""Loads on the tip, in EI/L^2."""
MESHES = ((50, 2), (100, 4))
RUNS = ((50, 20.0), (100, 20.0), (200, 20.0), (400, 200.0))
"""Numbers of CalculiX's steps to the end of the pin's way, and its contact stiffness [N/m].

At 20 N/m the penetration takes some 5e-5 of the force; at 200 N/m longer steps lose the pin early.
"""
SHOWN = (0.1, 0.25, 0.5, 0.7)
"""Load parameters of the contact."""
PENETRATION = 1e-10
"""Penetration of the solid model, over the length."""


def peers(report: Report) -> list[Row]:
    """Tip displacement and contact force of the solid and of CalculiX, on the same meshes.

    Raises
    ------
    CalculixError
        If CalculiX is not there, or stops under the tip load.
    """
    problem = to_solid(load_scene("ks-face"))
    strip = problem.strips[0]
    rows: list[Row] = []
    for clamp in (ROD.name, "full"):
        for load in LOADS:
            for mesh in MESHES:
                rows.append(_tip_row(replace(strip, clamp=clamp, mesh=mesh), load))
                report(f"tip load {load:g}, {clamp} clamp, {mesh[0]}x{mesh[1]}")
    for steps, penalty in RUNS:
        rows += _pin_rows(problem, steps, penalty)
        report(f"pin on the face, step {1 / steps:g}, {penalty:g} N/m")
    return rows


def dead_load(strip: "Strip", force: float, steps: int = 10) -> tuple[Array, Array]:
    """Mean displacement of the free end and the clamp's force under a transverse dead load [N], by Newton's method.

    The solid's own elements, law, clamp and tangent; only the load is added, evenly over the edge.

    Raises
    ------
    ArithmeticError
        If an iteration does not converge.
    """
    from scipy.sparse.linalg import splu

    from fem_reference.body import build_body

    body = build_body(strip)
    end = body.mesh.sections[[-1]].toarray()[0]
    u = np.zeros_like(body.mesh.nodes)
    loads = np.multiply.outer(end, [0.0, force])
    for part in np.arange(1, steps + 1) / steps:
        for _ in range(20):
            R = body.expansion.T @ (body.internal_force(u) - part * loads).ravel()
            step = body.expansion @ splu(body.tangent(u)).solve(-R)
            u = u + step.reshape(-1, 2)
            if np.abs(step).max() < 1e-10 * strip.length:
                break
        else:
            raise ArithmeticError(f"no equilibrium under {part:g} of the tip load")
    reaction: Array = body.internal_force(u)[body.mesh.edges["start"]].sum(axis=0)
    return end @ u, reaction


def contact_forces(problem: "SolidProblem", steps: int, count: int) -> Array:
    """Contact force at the first `count` of `steps` equal load parameters."""
    import fem_reference

    contact = replace(problem.contacts[0], penetration=PENETRATION)
    result = fem_reference.solve(replace(problem, contacts=(contact,)), np.arange(1, count + 1) / steps)
    force: Array = result.contacts[contact.name].force
    return force


def press(problem: "SolidProblem", steps: int, penalty: float) -> Answer:
    """CalculiX's answer to the pin of a problem of one strip along the x axis from the origin."""
    (x, y), end = problem.pins[0].path
    return pressed(problem.strips[0], (x, y), (end[0] - x, end[1] - y), steps, penalty)


def _tip_row(strip: "Strip", load: float) -> Row:
    force = load * strip.bending_stiffness / strip.length**2
    (u, _), answer = dead_load(strip, force), tip_load(strip, force)
    other = answer.tip[-1]
    return _row(
        f"tip load {load:g} EI/L^2",
        strip,
        fem_reference=float(np.hypot(*u)),
        calculix=float(np.hypot(*other)),
        difference=float(np.hypot(*(other - u)) / np.hypot(*u)),
    )


def _pin_rows(problem: "SolidProblem", steps: int, penalty: float) -> list[Row]:
    """One row per load parameter shown: contact force as the clamp bears it, empty where CalculiX did not come.

    ``largest`` is the largest difference up to where it came.
    """
    answer = press(problem, steps, penalty)
    calculix = np.hypot(*answer.force.T)
    solid = contact_forces(problem, steps, max(calculix.size, round(steps * SHOWN[-1])))
    largest = float(np.abs(calculix / solid[: calculix.size] - 1.0).max())
    rows = []
    for t in SHOWN:
        k = round(steps * t) - 1
        there = k < calculix.size
        rows.append(
            _row(
                "pin on the face",
                problem.strips[0],
                penalty=penalty,
                step=1 / steps,
                load_parameter=t,
                reached=float(answer.load_parameter[-1]),
                fem_reference=float(solid[k]),
                calculix=float(calculix[k]) if there else None,
                difference=float(calculix[k] / solid[k] - 1.0) if there else None,
                largest=largest,
                message="" if there and t != SHOWN[-1] else answer.stopped,
            )
        )
    return rows


def _row(case: str, strip: "Strip", **values: float | str | None) -> Row:
    empty: Row = {
        "penalty": None,
        "step": None,
        "load_parameter": 1.0,
        "reached": 1.0,
        "fem_reference": None,
        "calculix": None,
    }
    start: Row = {"case": case, "clamp": strip.clamp, "mesh": "x".join(map(str, strip.mesh))}
    return {**start, **empty, "difference": None, "largest": None, "message": "", **values}

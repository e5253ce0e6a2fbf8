"""The solid against CalculiX: a dead load at the tip, and a pin on the face."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.models import ROD
from comparisons.models.outside.adapters.calculix import Answer, pressed, tip_load
from comparisons.models.solid import to_solid
from comparisons.output import Report, Row
from comparisons.response import Array
from comparisons.scene import load_scene

if TYPE_CHECKING:
    from fem_reference import Result, SolidProblem, Strip

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


def solved(
    problem: "SolidProblem", times: Sequence[float] | Array, *, throw: bool = True, **strip: Any
) -> "Result":
    """Return the result of a solid at the load parameters, with changes of its strip."""
    import fem_reference

    changed = replace(problem, strips=(replace(problem.strips[0], **strip),))
    return fem_reference.solve(changed, np.asarray(times), throw=throw)


def peers(report: Report) -> Iterator[Row]:
    """Tip displacement and contact force of the solid and of CalculiX on the same meshes."""
    problem = to_solid(load_scene("ks-face"))
    strip = problem.strips[0]
    for clamp in (ROD.name, "full"):
        for load in LOADS:
            for mesh in MESHES:
                yield _tip_row(replace(strip, clamp=clamp, mesh=mesh), load)
                report(f"tip load {load:g}, {clamp} clamp, {mesh[0]}x{mesh[1]}")
    for steps, penalty in RUNS:
        yield from _pin_rows(problem, steps, penalty)
        report(f"pin on the face, step {1 / steps:g}, {penalty:g} N/m")


def dead_load(strip: "Strip", force: float, steps: int = 10) -> tuple[Array, Array]:
    """Mean displacement of the free end and the clamp's force under a transverse dead load [N] that is spread over the end."""
    from fem_reference import EndLoad, SolidProblem

    load = EndLoad(strip=strip.name, end="end", force=(0.0, force))
    result = solved(SolidProblem(strips=(strip,), loads=(load,)), np.arange(1, steps + 1) / steps)
    (support,) = result.supports.values()
    return result.tips[strip.name][-1] - strip.end, support.force[-1]


def contact_forces(problem: "SolidProblem", steps: int, count: int) -> Array:
    """Contact force at the first `count` of `steps` equal load parameters."""
    contact = replace(problem.contacts[0], penetration=PENETRATION)
    result = solved(replace(problem, contacts=(contact,)), np.arange(1, count + 1) / steps)
    force: Array = result.contacts[contact.name].force
    return force


def press(problem: "SolidProblem", steps: int, penalty: float) -> Answer:
    """CalculiX's answer to the pin of a problem of one strip along the x axis from the origin."""
    (x, y), end = problem.pins[0].path
    return pressed(problem.strips[0], (x, y), (end[0] - x, end[1] - y), steps, penalty)


def _tip_row(strip: "Strip", load: float) -> Row:
    force = load * strip.bending_stiffness / strip.length**2
    (u, _), other = dead_load(strip, force), tip_load(strip, force).tip[-1]
    own, apart = float(np.hypot(*u)), float(np.hypot(*(other - u)))
    found = {"fem_reference": own, "calculix": float(np.hypot(*other)), "difference": apart / own}
    return _row(f"tip load {load:g} EI/L^2", strip, **found)


def _pin_rows(problem: "SolidProblem", steps: int, penalty: float) -> Iterator[Row]:
    """Yield a row per load parameter shown, with the contact force as the clamp bears it."""
    answer = press(problem, steps, penalty)
    calculix = np.hypot(*answer.force.T)
    solid = contact_forces(problem, steps, max(calculix.size, round(steps * SHOWN[-1])))
    differences = calculix / solid[: calculix.size] - 1.0
    ended = {"reached": float(answer.load_parameter[-1]), "largest": float(np.abs(differences).max())}
    for t in SHOWN:
        k = round(steps * t) - 1
        found: Row = {"fem_reference": float(solid[k]), "message": answer.stopped}
        if k < calculix.size:
            found |= {"calculix": float(calculix[k]), "difference": float(differences[k])}
            found["message"] = answer.stopped if t == SHOWN[-1] else ""
        path = {"penalty": penalty, "step": 1 / steps, "load_parameter": t}
        yield _row("pin on the face", problem.strips[0], **path, **ended, **found)


def _row(case: str, strip: "Strip", **values: float | str | None) -> Row:
    start: Row = {"case": case, "clamp": strip.clamp, "mesh": "x".join(map(str, strip.mesh))}
    path: Row = {"penalty": None, "step": None, "load_parameter": 1.0, "reached": 1.0}
    found = dict.fromkeys(("fem_reference", "calculix", "difference", "largest"))
    return {**start, **path, **found, "message": "", **values}

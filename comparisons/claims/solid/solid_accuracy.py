"""How far the solid can be trusted: one question each, as rows of numbers."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.claims.solid.peers import peers
from comparisons.models import ROD, solve
from comparisons.models.solid import to_solid
from comparisons.output import Report, Row
from comparisons.response import Array
from comparisons.scene import Scene, load_scene

if TYPE_CHECKING:
    from fem_reference import SolidProblem

STEPS = 20
"""Load parameters of every run."""
LATE = slice(2, None)
"""Load parameters past t = .1."""
MESHES = tuple((nx, 2) for nx in range(40, 61))
"""Meshes of the scatter study."""
SEQUENCE = ((25, 2), (50, 2), (100, 2), (200, 4))
PENETRATION = 1e-10


def locking(report: Report) -> list[Row]:
    """Error of the contact force half way through KS in plane strain, where Poisson's ratio can lock, against the exact rod.

    The rod of a strip in plane strain has ``E / (1 - nu^2)`` in place of E. All elements have the same nodes.
    """
    rows = []
    for slenderness in (0.02, 0.002):
        for nu in (0.3, 0.49, 0.4999):
            scene = _slender(slenderness, nu)
            beam = scene.beams[0]
            stiff = replace(
                beam,
                youngs_modulus=beam.youngs_modulus / (1 - nu**2),
                poissons_ratio=None,
                shear_modulus=beam.youngs_modulus / (2 * (1 + nu)),
            )
            exact = (
                solve(replace(scene, beams=(stiff,)), ROD.name)
                .contacts[scene.contacts[0].pair]
                .force[STEPS // 2 - 1]
            )
            row: Row = {"h_over_L": slenderness, "poissons_ratio": nu}
            for element, mesh in (("Q1", (100, 4)), ("Q2-full", (50, 2)), ("Q2", (50, 2))):
                problem = _with_strip(
                    to_solid(scene), element=element, mesh=mesh, plane="strain", material="biot-linear"
                )
                force, _ = _history(problem, STEPS // 2)
                row[element] = float(force[-1] / exact - 1.0)
            report(f"h/L = {slenderness:g}, nu = {nu:g}")
            rows.append(row)
    return rows


def thin_beams(report: Report) -> list[Row]:
    """The solid of the rod's own law against the rod, for thinner and thinner strips: the difference falls as h^2."""
    rows: list[Row] = []
    for slenderness in (0.02, 0.01, 0.005):
        scene = _slender(slenderness, 0.3)
        rod = solve(scene, ROD.name).contacts[scene.contacts[0].pair]
        force, arc = _history(_biot(scene, (100, 2)))
        differences = {
            "contact_force": float(np.abs(force / rod.force - 1.0)[LATE].max()),
            "arc_position": float(np.abs(arc / rod.arc_position - 1.0)[LATE].max()),
        }
        last = rows[-1] if rows else None
        orders = {
            f"{name}_order": None if last is None else float(np.log2(last[name] / value))
            for name, value in differences.items()
        }
        report(f"h/L = {slenderness:g}")
        rows.append({"h_over_L": slenderness, **differences, **orders})
    return rows


def scatter(report: Report) -> list[Row]:
    """Largest relative difference of force and arc position between any two of 21 meshes, and from mesh to finer mesh."""
    rows = []
    for name, radius in (("ks-cantilever", 0.0), ("ks-face", 0.005)):
        scene = replace(load_scene(name), load_parameters=STEPS)
        found = np.array([_history(_round(_biot(scene, mesh), radius)) for mesh in MESHES])[:, :, LATE]
        force, arc = (float(np.max(np.ptp(q, axis=0) / q.mean(axis=0))) for q in found.swapaxes(0, 1))
        rows.append(_scatter_row(name, radius, "21 meshes, 40x2 to 60x2", force, arc))
        finer = np.array([_history(_round(_biot(scene, mesh), radius)) for mesh in SEQUENCE])[:, :, LATE]
        for (a, b), (coarse, fine) in zip(pairwise(finer), pairwise(SEQUENCE), strict=True):
            force, arc = (float(np.abs(p / q - 1.0).max()) for p, q in zip(a, b, strict=True))
            label = f"{coarse[0]}x{coarse[1]} to {fine[0]}x{fine[1]}"
            rows.append(_scatter_row(name, radius, label, force, arc))
        report(f"{name}, radius {radius:g}")
    return rows


def _scatter_row(scene: str, radius: float, meshes: str, force: float, arc: float) -> Row:
    return {"scene": scene, "radius": radius, "meshes": meshes, "contact_force": force, "arc_position": arc}


def penalty(report: Report) -> list[Row]:
    """Penetration half way and error of the force, against augmented Lagrangian steps, over sixteen decades of the penalty."""
    import fem_reference

    rows: list[Row] = []
    for name in ("ks-cantilever", "ks-face"):
        problem = to_solid(replace(load_scene(name), load_parameters=STEPS))
        exact, _ = _history(_with_contact(problem, penetration=PENETRATION))
        for eps in 10.0 ** np.arange(-3, 14):
            result = fem_reference.solve(_with_contact(problem, penalty=eps), _loads(STEPS), throw=False)
            contact = next(iter(result.contacts.values()))
            reached = result.status is fem_reference.Status.COMPLETED
            rows.append(
                {
                    "scene": name,
                    "penalty": float(eps),
                    "penetration": float(-contact.gap[STEPS // 2 - 1]) if reached else None,
                    "force_error": float(np.abs(contact.force / exact - 1.0).max()) if reached else None,
                    "message": result.message,
                }
            )
        report(name)
    return rows


STUDIES: dict[str, Callable[[Report], list[Row]]] = {
    "locking": locking,
    "thin-beams": thin_beams,
    "scatter": scatter,
    "penalty": penalty,
    "peers": peers,
}
"""The studies by name; `comparisons.claims.solid.questions` says what they answer."""


def _slender(slenderness: float, nu: float) -> Scene:
    """Return the KS cantilever with another height over length and Poisson's ratio."""
    scene = load_scene("ks-cantilever")
    beam = replace(scene.beams[0], height=slenderness * scene.beams[0].length, poissons_ratio=nu)
    return replace(scene, beams=(beam,), load_parameters=STEPS)


def _biot(scene: Scene, mesh: tuple[int, int]) -> "SolidProblem":
    problem = _with_strip(to_solid(scene, mesh=mesh), material="biot-linear")
    return _with_contact(problem, penetration=PENETRATION)


def _with_strip(problem: "SolidProblem", **changes: Any) -> "SolidProblem":
    return replace(problem, strips=(replace(problem.strips[0], **changes),))


def _with_contact(problem: "SolidProblem", **changes: Any) -> "SolidProblem":
    return replace(problem, contacts=(replace(problem.contacts[0], **changes),))


def _round(problem: "SolidProblem", radius: float) -> "SolidProblem":
    """Return the problem with a pin of finite radius, its centre that much below the scene's sharp pin."""
    pin = problem.pins[0]
    path = tuple((x, y - radius) for x, y in pin.path)
    return replace(problem, pins=(replace(pin, path=path, radius=radius),))


def _loads(count: int, steps: int = STEPS) -> Array:
    return np.asarray(np.arange(1, count + 1) / steps)


def _history(problem: "SolidProblem", count: int = STEPS) -> Sequence[Array]:
    """Force and arc position over the first load parameters."""
    import fem_reference

    contact = next(iter(fem_reference.solve(problem, _loads(count)).contacts.values()))
    return contact.force, contact.arc_position

"""How far the solid can be trusted: one question each, as rows of numbers."""

from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise, product
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.cases.settings import changed
from comparisons.claims.solid.peers import PENETRATION, peers, solved
from comparisons.models import ROD, solve
from comparisons.models.solid import to_solid
from comparisons.output import Report, Row
from comparisons.response import Array
from comparisons.scene import Scene, load_scene

if TYPE_CHECKING:
    from fem_reference import ContactHistory

Mesh = tuple[int, int]
STEPS = 20
"""Load parameters of every run."""
LATE = slice(2, None)
"""Load parameters past t = .1."""
MESHES = tuple((nx, 2) for nx in range(40, 61))
"""Meshes of the scatter study."""
SEQUENCE = ((25, 2), (50, 2), (100, 2), (200, 4))
ROD_LAW: Mapping[tuple[str, ...], object] = {
    ("beam", "material"): "biot-linear",
    ("contact", "penetration"): PENETRATION,
}
"""The rod's own law, without penetration."""


def locking(report: Report) -> Iterator[Row]:
    """Error of the force in plane strain against the rod of ``E / (1 - nu^2)``, elements of equal nodes."""
    for slenderness, nu in product((0.02, 0.002), (0.3, 0.49, 0.4999)):
        scene = _slender(slenderness, nu)
        E = scene.beams[0].youngs_modulus
        moduli = {"youngs_modulus": E / (1 - nu**2), "shear_modulus": E / (2 * (1 + nu))}
        (rod,) = solve(_beam(scene, poissons_ratio=None, **moduli), ROD.name).contacts.values()
        row: Row = {"h_over_L": slenderness, "poissons_ratio": nu}
        for element, mesh in (("Q1", (100, 4)), ("Q2-full", (50, 2)), ("Q2", (50, 2))):
            strip = _beam(scene, solid_element=element, mesh=mesh, material="biot-linear")
            force = _contact(strip, STEPS // 2, plane="strain").force[-1]
            row[element] = float(force / rod.force[STEPS // 2 - 1] - 1.0)
        report(f"h/L = {slenderness:g}, nu = {nu:g}")
        yield row


def thin_beams(report: Report) -> Iterator[Row]:
    """The solid of the rod's own law against the rod, for thinner and thinner strips: the difference falls as h^2."""
    last: Row = {}
    for slenderness in (0.02, 0.01, 0.005):
        scene = _slender(slenderness, 0.3)
        (rod,), solid = (
            solve(scene, ROD.name).contacts.values(),
            _contact(_beam(changed(scene, ROD_LAW), mesh=(100, 2))),
        )
        pairs = {
            "contact_force": (solid.force, rod.force),
            "arc_position": (solid.arc_position, rod.arc_position),
        }
        row = {name: float(np.abs(own / exact - 1.0)[LATE].max()) for name, (own, exact) in pairs.items()}
        orders = {f"{name}_order": float(np.log2(last[name] / row[name])) if last else None for name in row}
        report(f"h/L = {slenderness:g}")
        last = row
        yield {"h_over_L": slenderness, **row, **orders}


def scatter(report: Report) -> Iterator[Row]:
    """Largest relative difference of force and arc position between any two of 21 meshes, and from mesh to finer mesh."""
    for name, radius in (("ks-cantilever", 0.0), ("ks-face", 0.005)):
        scene = changed(_stepped(name), ROD_LAW)
        x, y = scene.pins[0].points[0]
        # the centre of a pin of finite radius lies that much below the scene's sharp pin
        scene = changed(scene, {("pin", "start"): (x, y - radius), ("pin", "radius"): radius or None})

        def histories(meshes: tuple[Mesh, ...], scene: Scene = scene) -> Array:
            found = (_contact(_beam(scene, mesh=mesh)) for mesh in meshes)
            return np.array([[one.force, one.arc_position] for one in found])[:, :, LATE]

        found, finer = histories(MESHES), histories(SEQUENCE)
        differences = {"21 meshes, 40x2 to 60x2": np.ptp(found, axis=0) / found.mean(axis=0)}
        for (a, b), (coarse, fine) in zip(pairwise(finer), pairwise(SEQUENCE), strict=True):
            differences[f"{coarse[0]}x{coarse[1]} to {fine[0]}x{fine[1]}"] = np.abs(a / b - 1.0)
        for label, (force, arc) in differences.items():
            largest = {"contact_force": float(force.max()), "arc_position": float(arc.max())}
            yield {"scene": name, "radius": radius, "meshes": label, **largest}
        report(f"{name}, radius {radius:g}")


def penalty(report: Report) -> Iterator[Row]:
    """Penetration half way and error of the force, against augmented Lagrangian steps, over sixteen decades of the penalty."""
    for name in ("ks-cantilever", "ks-face"):
        scene = _stepped(name)
        exact = _contact(changed(scene, {("contact", "penetration"): PENETRATION})).force
        for eps in 10.0 ** np.arange(-3, 14):
            stated = changed(scene, {("contact", "penalty"): float(eps)})
            result = solved(to_solid(stated), stated.times, throw=False)
            contact, reached = next(iter(result.contacts.values())), result.status.name == "COMPLETED"
            yield {
                "scene": name,
                "penalty": float(eps),
                "penetration": float(-contact.gap[STEPS // 2 - 1]) if reached else None,
                "force_error": float(np.abs(contact.force / exact - 1.0).max()) if reached else None,
                "message": result.message,
            }
        report(name)


STUDIES: dict[str, Callable[[Report], Iterator[Row]]] = {
    "locking": locking,
    "thin-beams": thin_beams,
    "scatter": scatter,
    "penalty": penalty,
    "peers": peers,
}
"""The studies by name; `comparisons.claims.solid.questions` says what they answer."""


def _stepped(name: str) -> Scene:
    return changed(load_scene(name), {("scene", "load_parameters"): STEPS})


def _slender(slenderness: float, nu: float) -> Scene:
    """Return the KS cantilever with another height over length and Poisson's ratio."""
    scene = _stepped("ks-cantilever")
    return _beam(scene, height=slenderness * scene.beams[0].length, poissons_ratio=nu)


def _beam(scene: Scene, **changes: object) -> Scene:
    return changed(scene, {("beam", key): value for key, value in changes.items()})


def _contact(scene: Scene, count: int = STEPS, **strip: Any) -> "ContactHistory":
    """Return the contact of the solid over the first load parameters; `strip` changes what a scene does not state."""
    (contact,) = solved(to_solid(scene), scene.times[:count], **strip).contacts.values()
    return contact

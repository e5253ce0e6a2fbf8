"""How far the solid can be trusted: one question each, as rows of numbers, one put to CalculiX, too."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise, product
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.answer import Array
from comparisons.models import ROD, solve
from comparisons.models.outside.adapters.calculix import Answer, pressed, tip_load
from comparisons.models.solid import to_solid
from comparisons.output import Report, Row
from comparisons.scene import Scene, load_scene
from comparisons.suite.settings import changed

if TYPE_CHECKING:
    from fem_reference import ContactHistory, Result, SolidProblem, Strip

LOADS = (1.0, 5.0)
"""Loads on the tip, in EI/L^2."""
PEER_MESHES = ((50, 2), (100, 4))
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
    for clamp, load, mesh in product((ROD.name, "full"), LOADS, PEER_MESHES):
        yield _tip_row(replace(strip, clamp=clamp, mesh=mesh), load)
        report(f"tip load {load:g}, {clamp} clamp, {mesh[0]}x{mesh[1]}")
    for steps, penalty in RUNS:
        yield from _pin_rows(problem, steps, penalty)
        report(f"pin on the face, step {1 / steps:g}, {penalty:g} N/m")


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
    """Displacement of the free end under a transverse dead load that is spread over it, in ten steps."""
    from fem_reference import PointLoad, SolidProblem

    force = load * strip.bending_stiffness / strip.length**2
    dead = PointLoad(strip=strip.name, force=(0.0, force))
    result = solved(SolidProblem(strips=(strip,), loads=(dead,)), np.arange(1, 11) / 10)
    u, other = result.tips[strip.name][-1] - strip.end, tip_load(strip, force).tip[-1]
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


STEPS = 20
"""Load parameters of every run."""
LATE = slice(2, None)
"""Load parameters past t = .1."""
MESHES = tuple((nx, 2) for nx in range(40, 61))
"""Meshes of the scatter study."""
COMPARED = ("contact_force", "arc_position")
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
        (rod,) = solve(scene, ROD.name).contacts.values()
        solid = _history(_beam(changed(scene, ROD_LAW), mesh=(100, 2)))
        found = np.abs(solid / np.array([rod.force, rod.arc_position])[:, LATE] - 1.0).max(axis=1)
        row = dict(zip(COMPARED, found.tolist(), strict=True))
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
        found, finer = (
            np.array([_history(_beam(scene, mesh=one)) for one in of]) for of in (MESHES, SEQUENCE)
        )
        differences = {"21 meshes, 40x2 to 60x2": np.ptp(found, axis=0) / found.mean(axis=0)}
        for (a, b), (coarse, fine) in zip(pairwise(finer), pairwise(SEQUENCE), strict=True):
            differences[f"{coarse[0]}x{coarse[1]} to {fine[0]}x{fine[1]}"] = np.abs(a / b - 1.0)
        for label, apart in differences.items():
            largest = dict(zip(COMPARED, apart.max(axis=1).tolist(), strict=True))
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
"""The studies by name; `comparisons.suites.names` says what they answer."""


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


def _history(scene: Scene) -> Array:
    """Return the quantities compared past t = .1, shape (2, n)."""
    contact = _contact(scene)
    return np.array([contact.force, contact.arc_position])[:, LATE]

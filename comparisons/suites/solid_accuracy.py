"""How far the solid can be trusted: one question each, as rows of numbers, one put to CalculiX, too."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise, product
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.answer import Array
from comparisons.models import ROD, solve
from comparisons.models.outside.adapters.calculix import pressed, tip_load
from comparisons.models.solid import to_solid
from comparisons.output import Row
from comparisons.scene import Scene, load_scene
from comparisons.suite.settings import Changes, changed

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
STEPS = 20
"""Load parameters of every run but those beside CalculiX."""
LATE = slice(2, None)
"""Load parameters past t = .1."""
MESHES = tuple((nx, 2) for nx in range(40, 61))
"""Meshes of the scatter study."""
SEQUENCE = ((25, 2), (50, 2), (100, 2), (200, 4))
SCENES = ("ks-cantilever", "ks-face")
COMPARED = ("contact_force", "arc_position")
EXACT: Changes = {"contact.penetration": 1e-10}
"""Hardly any penetration of the solid, over the length."""
LAW: Changes = {"beam.material": "biot-linear"}
"""The rod's own law."""


def solved(
    problem: "SolidProblem", times: Sequence[float] | Array, *, throw: bool = True, **strip: Any
) -> "Result":
    """Return the result of a solid at the load parameters, with changes of its strip."""
    import fem_reference

    changed = replace(problem, strips=(replace(problem.strips[0], **strip),))
    return fem_reference.solve(changed, np.asarray(times), throw=throw)


def peers() -> Iterator[Row]:
    """Tip displacement and contact force of the solid and of CalculiX on the same meshes."""
    scene = load_scene("ks-face")
    (strip,) = to_solid(scene).strips
    for clamp, load, mesh in product((ROD.name, "full"), LOADS, PEER_MESHES):
        one = replace(strip, clamp=clamp, mesh=mesh)
        yield {"case": f"tip load {load:g} EI/L^2", **_named(one), **_tip(one, load)}
    for steps, penalty in RUNS:
        of = {"case": "pin on the face", **_named(strip), "penalty": penalty, "step": 1 / steps}
        yield from (of | row for row in _pin(scene, steps, penalty))


def _named(strip: "Strip") -> Row:
    return {"clamp": strip.clamp, "mesh": "x".join(map(str, strip.mesh))}


def _tip(strip: "Strip", load: float) -> Row:
    """Displacement of the free end under a transverse dead load that is spread over it, in ten steps."""
    from fem_reference import PointLoad, SolidProblem

    force = load * strip.bending_stiffness / strip.length**2
    dead = PointLoad(strip=strip.name, force=(0.0, force))
    result = solved(SolidProblem(strips=(strip,), loads=(dead,)), np.arange(1, 11) / 10)
    u, other = result.tips[strip.name][-1] - strip.end, tip_load(strip, force).tip[-1]
    own, peer, apart = (float(np.hypot(*one)) for one in (u, other, other - u))
    found = {"fem_reference": own, "calculix": peer, "difference": apart / own}
    return {"load_parameter": 1.0, "reached": 1.0, **found}


def _pin(scene: Scene, steps: int, penalty: float) -> Iterator[Row]:
    """Yield a row per load parameter shown, with the contact force as the clamp bears it."""
    problem, stepped = to_solid(scene), changed(scene, {**EXACT, "scene.load_parameters": steps})
    answer = pressed(problem.strips[0], problem.pins[0].path, steps, penalty)
    calculix = np.hypot(*answer.force.T)
    solid = _contact(stepped, max(calculix.size, round(steps * SHOWN[-1]))).force
    differences = calculix / solid[: calculix.size] - 1.0
    ended = {"reached": float(answer.load_parameter[-1]), "largest": float(np.abs(differences).max())}
    for t in SHOWN:
        k = round(steps * t) - 1
        there = k < calculix.size
        found = {"calculix": float(calculix[k]), "difference": float(differences[k])} if there else {}
        said = {"message": "" if there and t < SHOWN[-1] else answer.stopped}
        yield {"load_parameter": t, "fem_reference": float(solid[k]), **found, **ended, **said}


def locking() -> Iterator[Row]:
    """Error of the force in plane strain against the rod of ``E / (1 - nu^2)``, elements of equal nodes."""
    for slenderness, nu in product((0.02, 0.002), (0.3, 0.49, 0.4999)):
        scene = _slender(slenderness, nu)
        E = scene.beams[0].youngs_modulus
        moduli: Changes = {"beam.youngs_modulus": E / (1 - nu**2), "beam.shear_modulus": E / (2 * (1 + nu))}
        (rod,) = solve(changed(scene, {"beam.poissons_ratio": None, **moduli}), ROD.name).contacts.values()
        row: Row = {"h_over_L": slenderness, "poissons_ratio": nu}
        for element, mesh in (("Q1", (100, 4)), ("Q2-full", (50, 2)), ("Q2", (50, 2))):
            strip: Changes = {"beam.solid_element": element, "beam.mesh": mesh, **LAW}
            force = _contact(changed(scene, strip), STEPS // 2, plane="strain").force[-1]
            row[element] = float(force / rod.force[STEPS // 2 - 1] - 1.0)
        yield row


def thin_beams() -> Iterator[Row]:
    """The solid of the rod's own law against the rod, for thinner and thinner strips: the difference falls as h^2."""
    last: Row = {}
    for slenderness in (0.02, 0.01, 0.005):
        scene = _slender(slenderness, 0.3)
        (rod,) = solve(scene, ROD.name).contacts.values()
        solid = _history(scene, (100, 2))
        row = _largest(solid / np.array([rod.force, rod.arc_position])[:, LATE] - 1.0)
        orders = {f"{name}_order": float(np.log2(last[name] / row[name])) if last else None for name in row}
        last = row
        yield {"h_over_L": slenderness, **row, **orders}


def scatter() -> Iterator[Row]:
    """Largest relative difference of force and arc position between any two of 21 meshes, and from mesh to finer mesh."""
    for name, radius in zip(SCENES, (0.0, 0.005), strict=True):
        scene = _stepped(name)
        x, y = scene.pins[0].points[0]
        # the centre of a pin of finite radius lies that much below the scene's sharp pin
        scene = changed(scene, {"pin.start": (x, y - radius), "pin.radius": radius or None})
        found, finer = (np.array([_history(scene, mesh) for mesh in of]) for of in (MESHES, SEQUENCE))
        differences = {"21 meshes, 40x2 to 60x2": np.ptp(found, axis=0) / found.mean(axis=0)}
        for (a, b), (coarse, fine) in zip(pairwise(finer), pairwise(SEQUENCE), strict=True):
            differences[f"{coarse[0]}x{coarse[1]} to {fine[0]}x{fine[1]}"] = a / b - 1.0
        for label, apart in differences.items():
            yield {"scene": name, "radius": radius, "meshes": label, **_largest(apart)}


def penalty() -> Iterator[Row]:
    """Penetration half way and error of the force, against augmented Lagrangian steps, over sixteen decades of the penalty."""
    for name in SCENES:
        scene = _stepped(name)
        exact = _contact(changed(scene, EXACT)).force
        for eps in (10.0 ** np.arange(-3, 14)).tolist():
            result = solved(to_solid(changed(scene, {"contact.penalty": eps})), scene.times, throw=False)
            (contact,), found = result.contacts.values(), (None, None)
            if result.status.name == "COMPLETED":
                found = -contact.gap[STEPS // 2 - 1], np.abs(contact.force / exact - 1.0).max()
            measured = dict(zip(("penetration", "force_error"), found, strict=True))
            yield {"scene": name, "penalty": eps, **measured, "message": result.message}


STUDIES: dict[str, Callable[[], Iterator[Row]]] = {
    study.__name__.replace("_", "-"): study for study in (locking, thin_beams, scatter, penalty, peers)
}
"""The studies by name; `comparisons.suites.names` says what they answer."""


def _stepped(name: str) -> Scene:
    return replace(load_scene(name), load_parameters=STEPS)


def _slender(slenderness: float, nu: float) -> Scene:
    """Return the KS cantilever with another height over length and Poisson's ratio."""
    scene = _stepped("ks-cantilever")
    height = slenderness * scene.beams[0].length
    return changed(scene, {"beam.height": height, "beam.poissons_ratio": nu})


def _contact(scene: Scene, count: int = STEPS, **strip: Any) -> "ContactHistory":
    """Return the contact of the solid over the first load parameters; `strip` changes what a scene does not state."""
    (contact,) = solved(to_solid(scene), scene.times[:count], **strip).contacts.values()
    return contact


def _history(scene: Scene, mesh: tuple[int, int]) -> Array:
    """Return the quantities compared of a solid with the rod's own law, without penetration, past t = .1, shape (2, n)."""
    contact = _contact(changed(scene, {**EXACT, **LAW, "beam.mesh": mesh}))
    return np.array([contact.force, contact.arc_position])[:, LATE]


def _largest(apart: Array) -> Row:
    """Return the largest size of a difference of the quantities compared."""
    return dict(zip(COMPARED, np.abs(apart).max(axis=1).tolist(), strict=True))

"""Cases whose exact value follows from a principle: work and energy, frames of reference, mirror images."""

from collections.abc import Callable

import numpy as np

from comparisons.claims.claim import Quantity, StoppedError
from comparisons.claims.manual.models import (
    EXACT,
    Model,
    answered,
    deflected,
    mixed,
    solid,
    trial,
    undeformed,
)
from comparisons.claims.manual.record import Curve, Measured, Picture, Problem, Trial
from comparisons.claims.manual.scenes import ks, mirrored, moved, reversed_
from comparisons.models import SOLID
from comparisons.models.solid import to_solid
from comparisons.models.tsm import to_structure
from comparisons.response import Array
from comparisons.scene import Scene

MODELS = (EXACT, mixed(20), solid(25, 2))


def energy_balance() -> Problem:
    """Work of the pin against the energy stored."""
    scene = ks()
    reasons = {
        EXACT: (1e-9, "round-off and the tolerances of Newton's method and of the integration"),
        mixed(20): (
            1e-8,
            "the force jumps by its discretisation error where the pin passes from element to element",
        ),
        solid(25, 2): (
            1e-5,
            "the force changes slope where the pin passes from element to element, which quadrature rounds off",
        ),
    }
    return Problem(
        name="energy-balance",
        title="Work of the pin and energy stored",
        purpose="A contact that neither creates nor dissipates energy.",
        uncertainty=0.0,
        scene=scene,
        statement="The main scene, Konyukhov and Schweizerhof's cantilever in contact on the axis. The work of the pin, the integral of its force along "
        "its path by Gauss quadrature (20 panels of 4 points), over the strain energy at the end.",
        source="conservation of energy: a frictionless contact and an elastic beam",
        quantities=(Quantity(name="work over energy", exact=1.0),),
        trials=tuple(
            trial(model, tolerance, reason, _work_over_energy(model))
            for model, (tolerance, reason) in reasons.items()
        ),
        picture=Picture(curves=undeformed(scene)),
    )


def _work_over_energy(model: Model, panels: int = 20) -> Callable[[Scene], Measured]:
    """Return the measurement of work over energy; the solvers are called at the points of the quadrature."""

    def measure(scene: Scene) -> Measured:
        gauss, weights = np.polynomial.legendre.leggauss(4)
        t = np.append(((np.arange(panels)[:, None] + (1.0 + gauss) / 2.0) / panels).ravel(), 1.0)
        run = _solid if model.key == SOLID.name else _beam
        force, energy, line = run(scene, model, t)
        start, end = np.array(scene.pins[0].points)
        work = float(np.tile(weights / 2.0 / panels, panels) @ (force[:-1] @ (end - start)))
        return Measured(values=(work / energy,), curves=(Curve(style=model.name, points=line),))

    return measure


def _beam(scene: Scene, model: Model, t: Array) -> tuple[Array, float, Array]:
    """Return forces of the pin (s, 2), energy and axis at the end."""
    import tsm

    structure = to_structure(scene, elements=model.options.elements, element=model.options.element)
    result = tsm.solve(structure, t, throw=False)
    if result.status is not tsm.Status.COMPLETED:
        raise StoppedError(f"{result.status.name}: {result.message}")
    name = scene.beams[0].name
    return (
        -next(iter(result.supports.values())).force,
        float(result.strain_energy[-1]),
        result.axis_line(name, -1)[1],
    )


def _solid(scene: Scene, model: Model, t: Array) -> tuple[Array, float, Array]:
    """Return the same of the solid, whose contact stores energy too."""
    import fem_reference

    result = fem_reference.solve(to_solid(scene, mesh=model.options.mesh), t, throw=False)
    if result.status is not fem_reference.Status.COMPLETED:
        raise StoppedError(f"{result.status.name}: {result.message}")
    name = scene.beams[0].name
    energy = float(sum(fem_reference.energy(result, -1)))
    return -next(iter(result.supports.values())).force, energy, fem_reference.axis_line(result, name, -1)


ANGLE, SHIFT = 0.7, (2.0, -3.0)
SAME = {
    "tsm exact": (1e-10, "round-off"),
    "tsm mixed": (1e-10, "round-off"),
    SOLID.name: (1e-8, "round-off, which the penalty amplifies"),
}
CHANGES = (
    Quantity(name="largest change of F, over the largest", exact=0.0, scale=1.0),
    Quantity(name="largest change of the clamp moment, over the largest", exact=0.0, scale=1.0),
)


def _unchanged(change: Callable[[Scene], Scene], model: Model) -> Trial:
    """Return the trial that solves two scenes whose forces must be the same."""
    tolerance, reason = SAME[model.name]

    def measure(scene: Scene) -> Measured:
        other = change(scene)
        first, second = (answered(one, model) for one in (scene, other))
        pair = scene.contacts[0].pair
        forces = [response.contacts[pair].force for response in (first, second)]
        moments = [np.abs(next(iter(one.supports.values())).moment) for one in (first, second)]
        values = tuple(float(np.abs(b - a).max() / np.abs(a).max()) for a, b in (forces, moments))
        return Measured(values=values, curves=(deflected(other, second, model.name),))

    return trial(model, tolerance, reason, measure)


def _invariant(name: str, title: str, text: str, source: str, change: Callable[[Scene], Scene]) -> Problem:
    scene = ks("ks-face", 10)
    return Problem(
        name=name,
        title=title,
        purpose="Answers that depend on how the same scene is stated.",
        uncertainty=0.0,
        scene=scene,
        statement=f"Konyukhov and Schweizerhof's cantilever in contact on its face, ten load parameters, solved twice: as it is, and {text}.",
        source=source,
        quantities=CHANGES,
        trials=tuple(_unchanged(change, model) for model in MODELS),
        picture=Picture(curves=undeformed(change(scene))),
    )


def objectivity() -> Problem:
    """The scene in another frame of reference."""
    return _invariant(
        "objectivity",
        "A scene does not care where it stands",
        f"turned by {ANGLE} rad and moved by {SHIFT} m (drawn)",
        "objectivity: forces turn with the frame of reference, their magnitudes do not change",
        lambda scene: moved(scene, ANGLE, SHIFT),
    )


def mirror() -> Problem:
    """The scene's mirror image."""
    return _invariant(
        "mirror",
        "A scene and its mirror image",
        "mirrored at the x axis, with the pin coming from the other side (drawn)",
        "symmetry: forces are mirrored, their magnitudes do not change",
        mirrored,
    )


def reversal() -> Problem:
    """The scene with its beam named from the other end."""
    return _invariant(
        "reversal",
        "A beam does not care which end is its start",
        "with the beam given from its free end to its clamp",
        "the same scene: nothing changes",
        reversed_,
    )

"""Cases whose exact value is an order: how errors fall with the mesh, the height and the penalty."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from comparisons.claims.claim import Quantity, StoppedError
from comparisons.claims.manual.models import (
    ANSWER,
    ROD,
    Model,
    answered,
    deflected,
    mixed,
    paper,
    solid,
    trial,
    undeformed,
)
from comparisons.claims.manual.record import Curve, Measured, Picture, Problem, Trial
from comparisons.claims.manual.scenes import PAIR, half_way, ks
from comparisons.models.solid import to_solid
from comparisons.response import Array
from comparisons.scene import Scene


def _slope(x: Sequence[float], y: Array) -> float:
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def _guide(x: Sequence[float], order: float, start: float) -> Curve:
    """Return a line of the exact order through a start, for the eye."""
    ends = np.array([min(x), max(x)])
    return Curve(style="exact order", points=np.stack([ends, start * (ends / ends[0]) ** order], axis=1))


ELEMENTS = (5, 10, 20, 40)


def _force_error(scene: Scene, model: Model, exact: Array) -> float:
    force = answered(scene, model).contacts[PAIR].force
    return float(np.abs(force - exact).max() / exact.max())


def _orders(model: Model, tolerance: float, exact: Array) -> Trial:
    def measure(scene: Scene) -> Measured:
        errors = np.array(
            [
                _force_error(scene, replace(model, options=replace(model.options, elements=n)), exact)
                for n in ELEMENTS
            ]
        )
        curve = Curve(style=model.name, points=np.stack([np.array(ELEMENTS), errors], axis=1))
        return Measured(values=(-_slope(ELEMENTS, errors),), curves=(curve,))

    return trial(model, tolerance, "the order is that of many elements, the fit begins with five", measure)


def mixed_order() -> Problem:
    """Fourth order of the element with the contact force as unknown."""
    return _element_order(
        "mixed-order", "Order of the element with the contact force as unknown", 4, mixed(40), 0.2
    )


def paper_order() -> Problem:
    """Second order of the paper's element."""
    return _element_order("timoshenko-order", "Order of the paper's Timoshenko element", 2, paper(40), 0.3)


def _element_order(name: str, title: str, order: int, model: Model, tolerance: float) -> Problem:
    scene = ks()
    exact = answered(scene, ROD).contacts[PAIR].force
    counts = ", ".join(map(str, ELEMENTS))
    return Problem(
        name=name,
        title=title,
        purpose="The order in which an element converges in contact.",
        uncertainty=0.0,
        scene=scene,
        statement=f"The main scene on {counts} elements: the largest error of the contact force over 20 load parameters, over the largest force.",
        source={
            4: "the error of a cubic element's strains, of fourth order in the energy",
            2: "chords in place of arcs: the error of the bow that is left out, of second order",
        }[order],
        quantities=(Quantity(name="order", exact=float(order), scale=1.0),),
        trials=(_orders(replace(model, setting=f"{counts} elements"), tolerance, exact),),
        picture=Picture(
            axes=("elements", "error of the contact force"),
            curves=(_guide(ELEMENTS, -float(order), {4: 1e-4, 2: 2e-2}[order]),),
            shape=False,
            logarithmic=True,
        ),
    )


HEIGHTS = (0.02, 0.01, 0.005)


def thin_strips() -> Problem:
    """The solid becomes the rod as the square of the height."""
    scene, model = half_way(ks(material="biot-linear"), penetration=1e-10), solid(50, 2)

    def measure(scene: Scene) -> Measured:
        found = []
        for height in HEIGHTS:
            strip = replace(scene, beams=(replace(scene.beams[0], height=height),))
            found.append(_force_error(strip, model, answered(strip, ROD).contacts[PAIR].force))
        errors = np.array(found)
        curve = Curve(style=model.name, points=np.stack([np.array(HEIGHTS), errors], axis=1))
        return Measured(values=(_slope(HEIGHTS, errors),), curves=(curve,))

    return Problem(
        name="thin-strips",
        title="The solid becomes the rod as the strip gets thin",
        purpose="Agreement of the solid with rod theory in the limit.",
        uncertainty=0.0,
        scene=scene,
        statement="The first half of the main scene with h/L = .02, .01 and .005, the solid of the rod's own law (stress linear in Biot's strain): the largest "
        "difference of the contact force from the exact rod's, over the largest force.",
        source="a rod is what is left of a strip for h -> 0, the next term is of the order h^2",
        quantities=(Quantity(name="order", exact=2.0, scale=1.0),),
        trials=(
            trial(
                model,
                0.2,
                "the order is that of thin strips; what the mesh leaves is not as small as the last difference",
                measure,
            ),
        ),
        picture=Picture(
            axes=("h/L", "difference of the contact force"),
            curves=(_guide(HEIGHTS, 2.0, 1e-5),),
            shape=False,
            logarithmic=True,
        ),
    )


PENALTIES = (1e2, 1e4, 1e6, 1e8, 1e10)


def penalty() -> Problem:
    """The penetration falls as the inverse of the penalty."""
    scene, model = half_way(ks(load_parameters=10)), solid(25, 2)

    def measure(scene: Scene) -> Measured:
        depths = []
        for value in PENALTIES:
            sprung = replace(scene, contacts=(replace(scene.contacts[0], penalty=value),))
            depths.append(-answered(sprung, model).contacts[PAIR].gap[-1])
        curve = Curve(style=model.name, points=np.stack([np.array(PENALTIES), np.array(depths)], axis=1))
        return Measured(values=(_slope(PENALTIES, np.array(depths)),), curves=(curve,))

    return Problem(
        name="penalty-slope",
        title="The penetration falls as the inverse of the penalty",
        purpose="The effect of a penalty on the penetration.",
        uncertainty=0.0,
        scene=scene,
        statement="The main scene half way, the solid with contact stiffnesses of 1e2 to 1e10 N/m: the depth by which the pin enters the axis.",
        source="a penalty eps is a spring: depth = F/eps, and F has a limit",
        quantities=(Quantity(name="slope", exact=-1.0),),
        trials=(trial(model, 1e-3, "at 1e2 N/m the force still is 1e-4 below its limit", measure),),
        picture=Picture(
            axes=("contact stiffness [N/m]", "penetration [m]"),
            curves=(_guide(PENALTIES, -1.0, 2e-5),),
            shape=False,
            logarithmic=True,
        ),
    )


def locking() -> Problem:
    """A thin, nearly incompressible strip does not lock."""
    nu, height = 0.4999, 0.002
    scene = half_way(ks(height=height, poissons_ratio=nu, material="biot-linear"))
    beam = scene.beams[0]
    stiff = replace(
        beam,
        youngs_modulus=beam.youngs_modulus / (1.0 - nu**2),
        poissons_ratio=None,
        shear_modulus=beam.youngs_modulus / (2.0 * (1.0 + nu)),
    )
    rod_scene = replace(scene, beams=(stiff,))
    rod = answered(rod_scene, ROD)
    model = solid(50, 2)

    def measure(scene: Scene) -> Measured:
        import fem_reference

        problem = to_solid(scene, mesh=model.options.mesh)
        problem = replace(problem, strips=(replace(problem.strips[0], plane="strain"),))
        result = fem_reference.solve(problem, np.array(scene.times), throw=False)
        if result.status is not fem_reference.Status.COMPLETED:
            raise StoppedError(f"{result.status.name}: {result.message}")
        contact, name = result.contacts[PAIR], scene.beams[0].name
        line = Curve(style=model.name, points=fem_reference.axis_line(result, name, -1))
        return Measured(values=(float(contact.force[-1]), float(contact.arc_position[-1])), curves=(line,))

    exact = rod.contacts[PAIR]
    return Problem(
        name="locking",
        title="A thin, nearly incompressible strip does not lock",
        purpose="Volumetric locking of the solid.",
        uncertainty=1e-5,
        scene=scene,
        statement=f"The main scene half way in plane strain, h/L = {height}, nu = {nu}, the solid of the rod's own law. Elements that lock are too stiff by hundreds "
        "of per cent here.",
        source="Reissner's rod by quadratures (comparisons.exact.rod) with E/(1 - nu^2) in place of E, which is plane strain",
        quantities=(
            Quantity(name="F [N] at t = .5", exact=float(exact.force[-1])),
            Quantity(name="s [m] at t = .5", exact=float(exact.arc_position[-1]), scale=1.0),
        ),
        trials=(trial(model, 2e-4, "the mesh", measure),),
        picture=Picture(curves=(*undeformed(scene), deflected(rod_scene, rod, ANSWER))),
    )

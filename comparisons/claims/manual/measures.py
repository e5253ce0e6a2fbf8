"""What problems of the manual measure that no answer has as a number: limits, orders, identities, invariance."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from comparisons.claims.claim import StoppedError
from comparisons.claims.manual.problem import Curve, Measured, Problem, Trial
from comparisons.claims.manual.read import ANSWER, answered, deflected, pieces, undeformed
from comparisons.models import ROD, SOLID
from comparisons.models.solid import to_solid
from comparisons.models.tsm import to_structure
from comparisons.response import Array, Response
from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene

BESIDE = 5
"""Samples to either side of an extreme one through which a polynomial is drawn."""


def _solved(trial: Trial, scene: Scene | None = None) -> Response:
    return answered(scene or trial.scene, trial.key, trial.options)


def critical_load(problem: Problem, trial: Trial) -> Measured:
    """Seek the load at which a column needs no force to stay aside; the exact value is the estimate."""
    from scipy.optimize import brentq

    scene, estimate = trial.scene, problem.quantities[0].exact
    aside, _ = scene.supports[0].displacement or (1.0, 0.0)

    def sideways(load: float) -> float:
        loaded = replace(scene, load_parameters=1, loads=(replace(scene.loads[0], force=(0.0, -load)),))
        return float(_solved(trial, loaded).supports["column.end"].force[-1, 0])

    loads = estimate * np.linspace(0.0, 1.2, 13)[1:]
    forces = np.array([sideways(float(load)) for load in loads])
    found = float(brentq(sideways, 0.8 * estimate, 1.2 * estimate, xtol=1e-12, rtol=1e-12))
    line = pieces(trial.model, [np.stack([loads, forces / aside], axis=1)])
    return Measured(values=(found,), curves=(line, _stiffness(1.2 * estimate, scene.beams[0])))


def _stiffness(highest: float, beam: BeamSpec) -> Curve:
    """Return the force that holds the head aside over the distance, for loads up to `highest`, in units of EI and L.

    ``R/d = 1/(c (tan k - k)/(P k) + 1/GA)``, ``c = 1 + P/GA - P/EA``, ``k^2 = P c``: Reissner's rod for small d.
    """
    load = np.linspace(0.01, highest, 200)
    c = 1.0 + load / beam.GA - load / beam.EA
    k = np.sqrt(load * c)
    sine, cosine = np.sin(k), np.cos(k)
    force = load * k * cosine / (c * (sine - k * cosine) + load * k * cosine / beam.GA)
    return Curve(style=ANSWER, points=np.stack([load, force], axis=1))


def identity(_: Problem, trial: Trial) -> Measured:
    """First integral of the elastica, ``F (x cos tc + y sin tc)^2/(2 EI sin tc) = 1``, with the contact force's own direction."""
    response, pin = _solved(trial), trial.scene.pins[0]
    (contact,) = response.contacts.values()
    assert contact.vector is not None, "the models state the force's direction"
    fx, fy = contact.vector[[2, 5, 9]].T
    x, y = np.array([pin.position(t) for t in response.load_parameter[[2, 5, 9]]]).T
    tangent = np.arctan2(-fx, fy)
    lever = x * np.cos(tangent) + y * np.sin(tangent)
    values = np.hypot(fx, fy) * lever**2 / (2.0 * np.sin(tangent))
    return Measured(values=tuple(values.tolist()), curves=(deflected(trial.scene, response, trial.model),))


def greatest_load(problem: Problem, trial: Trial) -> Measured:
    """Read the greatest load and its place: of a pin that is raised, or of three-point bending, whose half is the same cantilever."""
    from comparisons.exact import elastica_under_pin

    response, vertical = _solved(trial), problem.settings["force"] == "vertical"
    pin, EI = trial.scene.pins[-1], trial.scene.beams[0].EI
    a = pin.points[0][0]
    rise = np.array([pin.position(t)[1] for t in response.load_parameter]) / a
    pushed = (
        -response.supports["left.end"].force[:, 1]
        if vertical
        else next(iter(response.contacts.values())).force
    )
    curve = Curve(style=trial.model, points=np.stack([rise, pushed * a**2 / EI], axis=1))
    heights = np.linspace(0.01, rise[-1], 200)
    path = elastica_under_pin(np.stack([np.ones(200), heights], axis=1), length=3.0)
    exact = 2.0 * path.force[:, 1] if vertical else path.magnitude
    limit = Curve(style=ANSWER, points=np.stack([heights, exact], axis=1))
    return Measured(values=summit(*curve.points.T), curves=(curve, limit))


def summit(x: Array, y: Array) -> tuple[float, float]:
    """Return the greatest value of a history and its place, by the polynomial of degree 8 through eleven samples around it."""
    k = int(np.clip(np.argmax(y), BESIDE, len(y) - 1 - BESIDE))
    part = slice(k - BESIDE, k + BESIDE + 1)
    fit = np.polynomial.Polynomial.fit(x[part] - x[k], y[part], 8)
    turns = [float(root.real) for root in fit.deriv().roots() if abs(root.imag) < 1e-9]
    place = min(turns, key=abs, default=np.nan)
    return float(fit(place)), float(place + x[k])


def limits_with_friction(_: Problem, trial: Trial) -> Measured:
    """Read the greatest load of a support and its place while the beam is drawn in, and while it is pushed back."""
    response, pin = _solved(trial), trial.scene.pins[1]
    t, a, turn = response.load_parameter, pin.points[0][0], pin.corners[0]
    rise = np.array([pin.position(one)[1] for one in t]) / a
    load = -response.supports["left.end"].force[:, 1] * a**2 / trial.scene.beams[0].EI / 2.0
    back = (t > turn)[::-1]
    values = (*summit(rise[t <= turn], load[t <= turn]), *summit(rise[::-1][back], load[::-1][back]))
    return Measured(values=values, curves=(deflected(trial.scene, response, trial.model),))


def hysteresis(_: Problem, trial: Trial) -> Measured:
    """Compare the second cycle of a pin that goes to and fro with the first one, and the work with the energy dissipated."""
    response = _solved(trial)
    (contact,) = response.contacts.values()
    assert contact.friction is not None, "the beams state their friction"
    assert response.work is not None, "the beams state their work"
    legs = np.array([3, 7, 11, 15, 19])
    force, spent, work = (x[legs] for x in (contact.force, contact.friction.dissipated, response.work))
    lost = spent[4] - spent[2]
    ratios = force[3] / force[1], force[4] / force[2], (work[4] - work[2]) / lost
    values = (*force[3:], *contact.arc_position[legs[3:]], lost, *ratios)
    return Measured(values=tuple(map(float, values)), curves=(deflected(trial.scene, response, trial.model),))


def sleeve(problem: Problem, trial: Trial) -> Measured:
    """Material force at the clamp over M^2/EI for several distances of two opposed pins."""
    scene, beam = trial.scene, trial.scene.beams[0]
    inner, outer = scene.pins
    (x, y), values, curves = inner.points[0], [], []
    for distance in problem.settings["distances"]:
        response = _solved(trial, replace(scene, pins=(inner, replace(outer, start=(x + distance, y)))))
        clamp = response.supports[f"{beam.name}.start"]
        N, Q = -clamp.force[-1]
        H = clamp.moment[-1] ** 2 / (2.0 * beam.EI) + N + N**2 / (2.0 * beam.EA) + Q**2 / (2.0 * beam.GA)
        values.append(float(H * beam.EI / scene.loads[0].moment ** 2))
        curves.append(deflected(scene, response, trial.model))
    return Measured(values=tuple(values), curves=(curves[1],))


def under_load(scene: Scene, force: float) -> Scene:
    """Return a frame with a downward dead force on the joint that a support presses down in the scene, in place of the support."""
    pressed = next(support for support in scene.supports if support.moves)
    return replace(
        scene,
        supports=tuple(support for support in scene.supports if support is not pressed),
        loads=(LoadSpec(beam=pressed.beam, end=pressed.end, force=(0.0, -force)),),
    )


def limit_points(problem: Problem, trial: Trial) -> Measured:
    """Follow a frame by arc length under a dead load in place of the support that presses it, and read its limit points."""
    import tsm

    given, exact = problem.settings, [quantity.exact for quantity in problem.quantities]
    loaded = under_load(trial.scene, given["force"])
    structure = to_structure(loaded, elements=trial.options.elements, element=trial.options.element)
    result = tsm.trace(structure, arc_length=given["arc_length"], steps=given["steps"], throw=False)
    found = [event.load_parameter for event in result.events if event.kind is tsm.EventKind.LIMIT_POINT]
    if len(found) < len(exact):
        raise StoppedError(
            f"{result.status.name}: {result.message}; {len(found)} limit points of {len(exact)}"
        )
    load = np.append(0.0, result.load_parameter)
    end = int(np.argmax(np.append(load > given["highest"], True)))
    joint = loaded.loads[0]
    down = np.append(0.0, loaded.place(joint.node)[1] - result.tips[joint.beam][:, 1])
    curve = Curve(style=trial.model, points=np.stack([down, load], axis=1)[:end])
    width = float(curve.points[:, 0].max())
    levels = pieces(ANSWER, (np.array([[0.0, one], [width, one]]) for one in exact))
    return Measured(values=tuple(found[: len(exact)]), curves=(curve, levels))


def _power(trial: Trial, x: Sequence[float], y: Sequence[float], sign: float = 1.0) -> Measured:
    """Return the slope of a law in a logarithmic picture."""
    slope = float(np.polyfit(np.log(x), np.log(y), 1)[0])
    return Measured(
        values=(sign * slope,), curves=(Curve(style=trial.model, points=np.stack([x, y], axis=1)),)
    )


def _force_error(trial: Trial, scene: Scene) -> float:
    """Largest error of the contact force against the exact rod's, over the largest."""
    own, exact = (
        next(iter(one.contacts.values())).force for one in (_solved(trial, scene), answered(scene, ROD.name))
    )
    return float(np.abs(own - exact).max() / exact.max())


def order_of_element(problem: Problem, trial: Trial) -> Measured:
    """Order of an element: how the error of the contact force falls with the number of elements."""
    counts = problem.settings["elements"]
    errors = [
        _force_error(replace(trial, options=replace(trial.options, elements=n)), trial.scene) for n in counts
    ]
    return _power(trial, counts, errors, -1.0)


def order_of_height(problem: Problem, trial: Trial) -> Measured:
    """Order in which a solid becomes the rod as its height falls."""
    heights, beam = problem.settings["heights"], trial.scene.beams[0]
    strips = (replace(trial.scene, beams=(replace(beam, height=height),)) for height in heights)
    return _power(trial, heights, [_force_error(trial, strip) for strip in strips])


def slope_of_penalty(problem: Problem, trial: Trial) -> Measured:
    """Exponent of the penetration over the penalty."""
    penalties, (contact,) = problem.settings["penalties"], trial.scene.contacts
    sprung = (replace(trial.scene, contacts=(replace(contact, penalty=one),)) for one in penalties)
    return _power(trial, penalties, [-_solved(trial, one).contacts[contact.pair].gap[-1] for one in sprung])


def in_plane_strain(_: Problem, trial: Trial) -> Measured:
    """Contact force and arc position of a solid in plane strain."""
    import fem_reference

    solid = to_solid(trial.scene, mesh=trial.options.mesh)
    solid = replace(solid, strips=(replace(solid.strips[0], plane="strain"),))
    result = fem_reference.solve(solid, np.array(trial.scene.times), throw=False)
    if result.status is not fem_reference.Status.COMPLETED:
        raise StoppedError(f"{result.status.name}: {result.message}")
    (contact,), beam = result.contacts.values(), trial.scene.beams[0]
    line = Curve(style=trial.model, points=fem_reference.axis_line(result, beam.name, -1))
    nu, E = float(beam.poissons_ratio or 0.0), beam.youngs_modulus
    strip = replace(
        beam, youngs_modulus=E / (1.0 - nu**2), poissons_ratio=None, shear_modulus=E / (2.0 + 2.0 * nu)
    )
    stiff = replace(trial.scene, beams=(strip,))
    exact = deflected(stiff, answered(stiff, ROD.name), ANSWER)
    return Measured(values=(float(contact.force[-1]), float(contact.arc_position[-1])), curves=(line, exact))


def work_over_energy(_: Problem, trial: Trial, panels: int = 20) -> Measured:
    """Work of a pin, by Gauss quadrature at whose points the solver is called, over the energy stored, a penalty's included."""
    import fem_reference
    import tsm

    scene, options = trial.scene, trial.options
    gauss, weights = np.polynomial.legendre.leggauss(4)
    t = np.append(((np.arange(panels)[:, None] + (1.0 + gauss) / 2.0) / panels).ravel(), 1.0)
    result: tsm.Result | fem_reference.Result
    if trial.key == SOLID.name:
        result = fem_reference.solve(to_solid(scene, mesh=options.mesh), t, throw=False)
    else:
        result = tsm.solve(
            to_structure(scene, elements=options.elements, element=options.element), t, throw=False
        )
    if result.status.name != "COMPLETED":
        raise StoppedError(f"{result.status.name}: {result.message}")
    name, support = scene.beams[0].name, scene.all_supports[0].node
    if isinstance(result, tsm.Result):
        energy, line = float(result.strain_energy[-1]), result.axis_line(name, -1)[1]
    else:
        energy = float(sum(fem_reference.energy(result, -1)))
        line = fem_reference.axis_line(result, name, -1)
    force = -result.supports[support].force
    start, end = np.array(scene.pins[0].points)
    work = float(np.tile(weights / 2.0 / panels, panels) @ (force[:-1] @ (end - start)))
    return Measured(values=(work / energy,), curves=(Curve(style=trial.model, points=line),))


def invariance(problem: Problem, trial: Trial) -> Measured:
    """Largest changes of contact force and clamp moment in a scene that is moved, mirrored or named from the other end."""
    other = CHANGES[problem.settings["change"]](trial.scene)
    first, second = (_solved(trial, one) for one in (trial.scene, other))
    pair = trial.scene.contacts[0].pair
    forces = [response.contacts[pair].force for response in (first, second)]
    moments = [np.abs(next(iter(one.supports.values())).moment) for one in (first, second)]
    values = tuple(float(np.abs(b - a).max() / np.abs(a).max()) for a, b in (forces, moments))
    return Measured(values=values, curves=(*undeformed(other), deflected(other, second, trial.model)))


def moved(scene: Scene, angle: float = 0.7, shift: tuple[float, float] = (2.0, -3.0)) -> Scene:
    """Return the scene turned about the origin by an angle [rad], then shifted."""
    c, s = math.cos(angle), math.sin(angle)
    return _placed(scene, lambda x, y: (c * x - s * y + shift[0], s * x + c * y + shift[1]))


def mirrored(scene: Scene) -> Scene:
    """Return the scene mirrored at the x axis: what came from the right comes from the left."""
    return _placed(scene, lambda x, y: (x, -y), _other_side(scene))


def reversed_(scene: Scene) -> Scene:
    """Return the scene with its beams named from their other ends."""
    other = {"start": "end", "end": "start"}
    beams = tuple(
        replace(beam, start=beam.end, end=beam.start, clamped=tuple(other[end] for end in beam.clamped))
        for beam in scene.beams
    )
    return replace(scene, beams=beams, contacts=_other_side(scene))


def _other_side(scene: Scene) -> tuple[ContactSpec, ...]:
    side = {"left": "right", "right": "left"}
    return tuple(replace(contact, side=side[contact.side]) for contact in scene.contacts)


def _placed(
    scene: Scene, place: Callable[[float, float], tuple[float, float]], contacts: tuple[ContactSpec, ...] = ()
) -> Scene:
    pins = (
        PinSpec(name=pin.name, path=tuple(place(*point) for point in pin.points), radius=pin.radius)
        for pin in scene.pins
    )
    beams = (replace(beam, start=place(*beam.start), end=place(*beam.end)) for beam in scene.beams)
    return replace(scene, beams=tuple(beams), pins=tuple(pins), contacts=contacts or scene.contacts)


CHANGES = {"moved": moved, "mirrored": mirrored, "reversed": reversed_}
Measure = Callable[[Problem, Trial], Measured]
MEASURES: dict[str, Measure] = {
    measure.__name__: measure
    for measure in (
        critical_load, identity, greatest_load, limits_with_friction, hysteresis, sleeve, limit_points, order_of_element,
        order_of_height, slope_of_penalty, in_plane_strain, work_over_energy, invariance,
    )
}  # fmt: skip
"""The functions that a problem can name as its ``measure``."""

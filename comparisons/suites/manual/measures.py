"""What is read from the answers to a problem, and what no answer has as a number: limits, orders."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from comparisons.answer import Array, Response
from comparisons.answer.axis import STATIONS, axes_at_stations
from comparisons.answer.table import table
from comparisons.models import ROD, SOLID, solve
from comparisons.models.options import Options
from comparisons.models.solid import to_solid
from comparisons.models.tsm import to_structure
from comparisons.scene import LoadSpec, Scene, read_scene
from comparisons.suites.manual.problem import Line, Problem, Quantity, Trial, varied
from comparisons.suites.solid_accuracy import solved

ANSWER = "exact answer"
"""Style of lines of the exact answer, which no model computed."""


class StoppedError(RuntimeError):
    """A solution that stopped before it had an answer: its status and sentence."""


class Answers:
    """A model at a problem, and the lines that it adds to the picture."""

    def __init__(self, problem: Problem, trial: Trial) -> None:
        self.trial, self.scene, self.shown = trial, trial.scene, problem.picture.shown
        self.lines: list[Line] = []

    def solved(
        self, scene: Scene | None = None, *, draw: bool = True, options: Options | None = None
    ) -> Response:
        """Return the response to the trial's scene or another one, whose deflected axes are drawn."""
        scene = scene or self.scene
        response = answered(scene, self.trial.key, options or self.trial.options)
        if draw:
            self.lines.extend(deflected(scene, response, self.trial.model, self.shown))
        return response

    def draw(self, *lines: ArrayLike, style: str = "") -> None:
        """Draw lines of points (n, 2), by default in the style of the model."""
        self.lines.extend((style or self.trial.model, np.asarray(line, dtype=float)) for line in lines)


def answered(scene: Scene, model: str, options: Options | None = None) -> Response:
    """Return the response of a model to a scene; one that is not complete and checked is a `StoppedError`."""
    response = solve(scene, model, options)
    if not response.completed:
        raise StoppedError(f"{response.status}: {response.message}")
    return response


def readings(problem: Problem, answers: Answers) -> list[float]:
    """Read every quantity from the answer to the problem's scene, with what each changes in it."""
    found: dict[str, Response] = {}
    for one in problem.quantities:
        if repr(one.changes) not in found:
            found[repr(one.changes)] = answers.solved(varied(answers.scene, one.changes))
    return [one.times * _read(found[repr(one.changes)], one) for one in problem.quantities]


def _read(response: Response, quantity: Quantity) -> float:
    found = value(response, quantity.read, quantity.at)
    if quantity.since is not None:
        found -= value(response, quantity.read, quantity.since)
    return found / _read(response, quantity.over) if quantity.over else found


def value(response: Response, words: str, at: float) -> float:
    """Return a number of a response at a load parameter; nan for an event that it does not have."""
    # `words` is a name of `comparisons.answer.table`; a vector's name without _x is its size. Or it is one of
    # "axis BEAM .5 x" (the axis at half the length), "slip-off PAIR" and "event KIND PAIR 0" (the first event)
    what, *more = words.split()
    if what == "slip-off":
        return response.contacts[more[0]].slip_off
    if what == "event":
        kind, pair, number = more
        events = [one for one in response.events or () if [one.kind, one.pair] == [kind, pair]]
        return next((one.load_parameter for one in events[int(number) :]), np.nan)
    k = step(response, at)
    if what == "axis":
        beam, part, direction = more
        station = round(float(part) * (len(STATIONS) - 1))
        return float(axes_at_stations(response, beam, [k])[0, station, "xy".index(direction)])
    columns = table(replace(response, definition=None))
    if what in columns:
        return float(columns[what][k])
    return float(np.hypot(columns[f"{what}_x"][k], columns[f"{what}_y"][k]))


def step(response: Response, load_parameter: float) -> int:
    """Return the number of a load parameter of the scene."""
    k = int(np.argmin(np.abs(response.load_parameter - load_parameter)))
    assert abs(response.load_parameter[k] - load_parameter) < 1e-9, "must be one of the scene's"
    return k


def deflected(scene: Scene, response: Response, style: str, shown: Sequence[float]) -> Iterator[Line]:
    """Yield the deflected axes of all beams at some load parameters."""
    for beam in scene.beams:
        yield from ((style, response.axis_line(beam.name, step(response, t))[1]) for t in shown)


def undeformed(scene: Scene) -> Iterator[Line]:
    """Yield the undeformed axes and the paths of the pins."""
    yield from (("undeformed", np.array([beam.start, beam.end])) for beam in scene.beams)
    yield from (("path of the pin", np.array(pin.points)) for pin in scene.pins)


BESIDE = 5
"""Samples to either side of an extreme one through which a polynomial is drawn."""


def critical_load(problem: Problem, answers: Answers) -> Sequence[float]:
    """Seek the load at which a column needs no force to stay aside; the exact value is the estimate."""
    from scipy.optimize import brentq

    scene, estimate = answers.scene, problem.quantities[0].exact
    aside, _ = scene.supports[0].displacement or (1.0, 0.0)

    def sideways(load: float) -> float:
        loaded = replace(scene, load_parameters=1, loads=(replace(scene.loads[0], force=(0.0, -load)),))
        return float(answers.solved(loaded, draw=False).supports["column.end"].force[-1, 0])

    loads = estimate * np.linspace(0.0, 1.2, 13)[1:]
    stiffness = np.array([sideways(float(load)) for load in loads]) / aside
    answers.draw(np.stack([loads, stiffness], axis=1))
    answers.draw([[estimate, 0.0], [estimate, stiffness.max()]], style=ANSWER)
    return (float(brentq(sideways, 0.8 * estimate, 1.2 * estimate, xtol=1e-12, rtol=1e-12)),)


def identity(_: Problem, answers: Answers) -> Sequence[float]:
    """First integral of the elastica, ``F (x cos tc + y sin tc)^2/(2 EI sin tc) = 1``, with the contact force's own direction."""
    response, pin = answers.solved(), answers.scene.pins[0]
    (contact,) = response.contacts.values()
    assert contact.vector is not None, "the models state the force's direction"
    fx, fy = contact.vector[[2, 5, 9]].T
    x, y = np.array([pin.position(t) for t in response.load_parameter[[2, 5, 9]]]).T
    tangent = np.arctan2(-fx, fy)
    lever = x * np.cos(tangent) + y * np.sin(tangent)
    return (np.hypot(fx, fy) * lever**2 / (2.0 * np.sin(tangent))).tolist()  # type: ignore[no-any-return]


def greatest_load(problem: Problem, answers: Answers) -> Sequence[float]:
    """Read the greatest load and its place: of a pin that is raised, or of half of three-point bending."""
    # a pin whose path has a corner turns back there: both are read on the way there, then on the way back
    given, response, pin = problem.settings, answers.solved(draw=False), answers.scene.pins[-1]
    t, a, EI = response.load_parameter, pin.points[0][0], answers.scene.beams[0].EI
    rise = np.array([pin.position(one)[1] for one in t]) / a
    pushed = next(iter(response.contacts.values())).force
    if given["force"] == "vertical":
        pushed = -response.supports["left.end"].force[:, 1]
    load = pushed * a**2 / EI * given.get("times", 1.0)
    answers.draw(np.stack([rise, load], axis=1))
    answers.draw(*_levels(problem.quantities[::2], rise.max()), style=ANSWER)
    back = np.flatnonzero(t > max(pin.corners, default=1.0))[::-1]
    legs = (np.arange(len(t) - len(back)), *((back,) if len(back) else ()))
    return [value for leg in legs for value in summit(rise[leg], load[leg])]


def _levels(quantities: Sequence[Quantity], width: float) -> list[list[list[float]]]:
    """Exact values as lines."""
    return [[[0.0, quantity.exact], [width, quantity.exact]] for quantity in quantities]


def summit(x: Array, y: Array) -> tuple[float, float]:
    """Return the greatest value of a history and its place, by the polynomial of degree 8 through eleven samples around it."""
    k = int(np.clip(np.argmax(y), BESIDE, len(y) - 1 - BESIDE))
    part = slice(k - BESIDE, k + BESIDE + 1)
    fit = np.polynomial.Polynomial.fit(x[part] - x[k], y[part], 8)
    turns = [float(root.real) for root in fit.deriv().roots() if abs(root.imag) < 1e-9]
    place = min(turns, key=abs, default=np.nan)
    return float(fit(place)), float(place + x[k])


def sleeve(problem: Problem, answers: Answers) -> Sequence[float]:
    """Material force at the clamp over M^2/EI for several distances of two opposed pins."""
    scene, beam = answers.scene, answers.scene.beams[0]
    inner, outer = scene.pins
    (x, y), values = inner.points[0], []
    for distance in problem.settings["distances"]:
        apart = replace(scene, pins=(inner, replace(outer, start=(x + distance, y))))
        clamp = answers.solved(apart).supports[f"{beam.name}.start"]
        N, Q = -clamp.force[-1]
        H = clamp.moment[-1] ** 2 / (2.0 * beam.EI) + N + N**2 / (2.0 * beam.EA) + Q**2 / (2.0 * beam.GA)
        values.append(float(H * beam.EI / scene.loads[0].moment ** 2))
    return values


def under_load(scene: Scene, force: float) -> Scene:
    """Return a frame with a downward dead force on the joint that a support presses down in the scene, in place of the support."""
    pressed = next(support for support in scene.supports if support.moves)
    return replace(
        scene,
        supports=tuple(support for support in scene.supports if support is not pressed),
        loads=(LoadSpec(beam=pressed.beam, end=pressed.end, force=(0.0, -force)),),
    )


def limit_points(problem: Problem, answers: Answers) -> Sequence[float]:
    """Follow a frame by arc length under a dead load in place of the support that presses it, and read its limit points."""
    import tsm

    given, count, options = problem.settings, len(problem.quantities), answers.trial.options
    loaded = under_load(answers.scene, given["force"])
    structure = to_structure(loaded, elements=options.elements, element=options.element)
    result = tsm.trace(structure, arc_length=given["arc_length"], steps=given["steps"], throw=False)
    found = [event.load_parameter for event in result.events if event.kind is tsm.EventKind.LIMIT_POINT]
    if len(found) < count:
        raise StoppedError(f"{result.status.name}: {result.message}; {len(found)} limit points of {count}")
    load, joint = np.append(0.0, result.load_parameter), loaded.loads[0]
    end = int(np.argmax(np.append(load > given["highest"], True)))
    down = np.append(0.0, loaded.place(joint.node)[1] - result.tips[joint.beam][:, 1])
    answers.draw(np.stack([down, load], axis=1)[:end])
    answers.draw(*_levels(problem.quantities, float(down[:end].max())), style=ANSWER)
    return found[:count]


def power_law(problem: Problem, answers: Answers) -> Sequence[float]:
    """Exponent of the error of the force against the rod, or of the penetration, in what is varied."""
    # ``varies`` is ``elements`` or a setting of the scene; ``sign`` is -1 for that of the inverse
    given, found = problem.settings, []
    for one in given["values"]:
        scene, options = answers.scene, answers.trial.options
        if given["varies"] == "elements":
            options = replace(options, elements=one)
        else:
            scene = varied(scene, {given["varies"]: one})
        (contact,) = answers.solved(scene, options=options, draw=False).contacts.values()
        if given["of"] == "penetration":
            found.append(-contact.gap[-1])
            continue
        (exact,) = answered(scene, ROD.name).contacts.values()
        found.append(np.abs(contact.force - exact.force).max() / exact.force.max())
    answers.draw(np.stack([given["values"], found], axis=1))
    slope = np.polyfit(np.log(given["values"]), np.log(found), 1)[0]
    return (float(given["sign"] * slope),)


def _solved_directly(answers: Answers, times: Array, **strip: Any) -> Any:
    """The result of the program of `tsm` or the solid itself; `strip` changes what a scene does not state."""
    import fem_reference
    import tsm

    scene, options, name = answers.scene, answers.trial.options, answers.scene.beams[0].name
    solid = answers.trial.key == SOLID.name
    result: Any
    if solid:
        result = solved(to_solid(scene, mesh=options.mesh), times, throw=False, **strip)
    else:
        beams = to_structure(scene, elements=options.elements, element=options.element)
        result = tsm.solve(beams, times, throw=False)
    if result.status.name != "COMPLETED":
        raise StoppedError(f"{result.status.name}: {result.message}")
    answers.draw(fem_reference.axis_line(result, name, -1) if solid else result.axis_line(name, -1)[1])
    return result


def in_plane_strain(_: Problem, answers: Answers) -> Sequence[float]:
    """Contact force and arc position of a solid in plane strain."""
    result = _solved_directly(answers, np.array(answers.scene.times), plane="strain")
    (contact,) = result.contacts.values()
    return float(contact.force[-1]), float(contact.arc_position[-1])


def work_over_energy(_: Problem, answers: Answers) -> Sequence[float]:
    """Work of a pin, by Gauss quadrature at whose points the solver is called, over the energy stored, a penalty's included."""
    import fem_reference

    panels = 20
    gauss, weights = np.polynomial.legendre.leggauss(4)
    t = np.append(((np.arange(panels)[:, None] + (1.0 + gauss) / 2.0) / panels).ravel(), 1.0)
    result = _solved_directly(answers, t)
    solid = answers.trial.key == SOLID.name
    energy = sum(fem_reference.energy(result, -1)) if solid else result.strain_energy[-1]
    force = -result.supports[answers.scene.all_supports[0].node].force
    start, end = np.array(answers.scene.pins[0].points)
    work = np.tile(weights / 2.0 / panels, panels) @ (force[:-1] @ (end - start))
    return (float(work / energy),)


def invariance(problem: Problem, answers: Answers) -> Sequence[float]:
    """Largest changes of contact force and clamp moment in the scene that is moved, mirrored or named from the other end."""
    other = read_scene(problem.settings["other"], problem.name)
    pair = answers.scene.contacts[0].pair
    first, second = answers.solved(draw=False), answers.solved(other)
    answers.lines.extend(undeformed(other))
    forces = [response.contacts[pair].force for response in (first, second)]
    moments = [np.abs(next(iter(one.supports.values())).moment) for one in (first, second)]
    return [float(np.abs(b - a).max() / np.abs(a).max()) for a, b in (forces, moments)]


Measure = Callable[[Problem, Answers], Sequence[float]]
MEASURES: dict[str, Measure] = {
    measure.__name__: measure
    for measure in (
        readings, critical_load, identity, greatest_load, sleeve, limit_points, power_law,
        in_plane_strain, work_over_energy, invariance,
    )
}  # fmt: skip
"""The functions that a problem can name as its ``measure``."""

"""What is read from the answers to a problem, and what no answer has as a number: limits, orders."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import field, replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from comparisons.answer import Array, Response
from comparisons.answer.axis import STATIONS, axes_at_stations
from comparisons.answer.errors import difference
from comparisons.answer.table import table
from comparisons.frozen import Frozen
from comparisons.models import ROD, SOLID, solve
from comparisons.models.model import Options
from comparisons.models.shared import kept
from comparisons.models.solid import to_solid
from comparisons.models.tsm import to_structure
from comparisons.report import palette
from comparisons.report.plot import Line
from comparisons.scene import LoadSpec, Scene, read_scene
from comparisons.suite.settings import changed
from comparisons.suites.formula import value_of
from comparisons.suites.manual.problem import Problem, Trial
from comparisons.suites.solid_accuracy import solved

EXACT = {"color": palette.GREY, "linewidth": 0.8, "linestyle": (0, (4, 3)), "zorder": 3}
"""Style of the lines of what is exact; those of models have none."""


class StoppedError(RuntimeError):
    """A solution that stopped before it had an answer: its status and sentence."""


class Answers(Frozen):
    """A model at a problem, and the lines that it adds to the picture."""

    problem: Problem
    trial: Trial
    lines: list[Line] = field(default_factory=list)

    @property
    def scene(self) -> Scene:
        """What the model solves."""
        return self.trial.scene

    def solved(self, scene: Scene) -> Response:
        """Return the response to a scene."""
        return answered(scene, self.trial.model.split()[0], self.trial.options)

    def shown(self, scene: Scene) -> Response:
        """Return the response to a scene, and draw its deflected axes."""
        response = self.solved(scene)
        for points in deflected(scene, response, self.problem.picture.shown):
            self.draw(*points)
        return response

    def draw(self, x: Any, y: Any) -> None:
        """Draw a line of the model."""
        self.lines.append(Line(self.trial.model, (x, y)))

    def draw_exact(self, x: Any, y: Any) -> None:
        """Draw a line of the exact answer."""
        self.lines.append(Line("exact answer", (x, y), EXACT))


def answered(scene: Scene, model: str, options: Options | None = None) -> Response:
    """Return the response of a model to a scene; one that is not complete and checked is a `StoppedError`."""
    response = solve(scene, model, options)
    if not response.completed:
        raise StoppedError(response.ended)
    return response


def readings(answers: Answers) -> Iterable[float]:
    """Read every quantity from the answer to the problem's scene, with what each changes in it."""
    found: dict[str, Response] = {}
    for one in answers.problem.quantities:
        if repr(one.changes) not in found:
            found[repr(one.changes)] = answers.shown(changed(answers.scene, one.changes))
        of, beam = partial(value, found[repr(one.changes)]), answers.scene.beams[0]
        yield value_of(one.formula, of=of, read=one.read, at=one.at, beam=beam)


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
    found = table(response, along=False)
    return float(found[what][k] if what in found else np.hypot(found[f"{what}_x"][k], found[f"{what}_y"][k]))


def step(response: Response, load_parameter: float) -> int:
    """Return the number of a load parameter of the scene."""
    return int(np.flatnonzero(np.abs(response.load_parameter - load_parameter) < 1e-9)[0])


def deflected(scene: Scene, response: Response, shown: Sequence[float]) -> Iterator[Array]:
    """Yield the deflected axes of all beams at some load parameters, shape (2, n)."""
    for beam, t in product(scene.beams, shown):
        yield response.axis_line(beam.name, step(response, t))[1].T


def undeformed(scene: Scene) -> Iterator[Line]:
    """Yield the undeformed axes and the paths of the pins."""
    dashed = {"color": "0.6", "linewidth": 1.0, "linestyle": "--", "zorder": 1}
    dotted = dashed | {"linewidth": 0.8, "linestyle": ":"}
    yield from (Line("undeformed", np.array([one.start, one.end]).T, dashed) for one in scene.beams)
    yield from (Line("path of the pin", np.array(one.points).T, dotted) for one in scene.pins)


def exact_lines(problem: Problem, found: Sequence[Line]) -> Iterator[Line]:
    """Yield what a picture has whatever the models answer: undeformed axes, the exact answer, a line for the eye."""
    picture, scene = problem.picture, problem.scene
    if picture.guide:
        order, first = picture.guide
        ends = np.sort(np.asarray(found[0].points)[0, [0, -1]])
        yield Line("exact order", (ends, first * (ends / ends[0]) ** order), EXACT)
    elif not picture.axes:
        yield from undeformed(scene)
    if picture.exact:
        for points in deflected(scene, answered(scene, picture.exact), picture.shown):
            yield Line("exact answer", points, EXACT)


def critical_load(answers: Answers) -> Iterable[float]:
    """Seek the load at which a column needs no force to stay aside; the exact value is the estimate."""
    from scipy.optimize import brentq

    scene, estimate = answers.scene, answers.problem.quantities[0].exact

    def sideways(load: float) -> float:
        loaded = changed(scene, {"scene.load_parameters": 1, "load.force": (0.0, -load)})
        return value(answers.solved(loaded), "column.end.force_x", 1.0)

    aside, loads = scene.supports[0].motion[0] or 1.0, (estimate * np.linspace(0.1, 1.2, 12)).tolist()
    stiffness = [sideways(load) / aside for load in loads]
    answers.draw(loads, stiffness)
    answers.draw_exact([estimate, estimate], [0.0, max(stiffness)])
    yield float(brentq(sideways, 0.8 * estimate, 1.2 * estimate, xtol=1e-12, rtol=1e-12))


def greatest_load(answers: Answers) -> Iterable[float]:
    """Read the greatest load and its place: of a pin that is raised, or of half of three-point bending."""
    # a pin whose path has a corner turns back there: both are read on the way there, then on the way back
    given, scene = answers.problem.settings, answers.scene
    response, pin = answers.solved(scene), scene.pins[-1]
    t, a = response.load_parameter, pin.points[0][0]
    rise = np.array([pin.position(one)[1] for one in t]) / a
    load = table(response, along=False)[given["load"]] * given["times"] * a**2 / scene.beams[0].EI
    answers.draw(rise, load)
    for one in answers.problem.quantities[::2]:
        answers.draw_exact([0.0, rise.max()], [one.exact, one.exact])
    there = t <= max(pin.corners, default=1.0)
    yield from summit(rise[there], load[there])
    if not there.all():
        yield from summit(rise[~there][::-1], load[~there][::-1])


def summit(x: Array, y: Array) -> tuple[float, float]:
    """Return the greatest value of a history over rising places, and its place, by a spline of degree 7."""
    from scipy.interpolate import PPoly, make_interp_spline

    history = make_interp_spline(x, y, 7)
    place = max(PPoly.from_spline(history.derivative()).roots(extrapolate=False), key=history)
    return float(history(place)), float(place)


def limit_points(answers: Answers) -> Iterable[float]:
    """Follow a frame by arc length under a dead load in place of the support that presses it, and read its limit points."""
    import tsm

    given, options, scene = answers.problem.settings, answers.trial.options, answers.scene
    pressed = next(support for support in scene.supports if support.moves)
    dead = LoadSpec(**kept(pressed, "beam end"), force=(0.0, -given["force"]))
    held = tuple(support for support in scene.supports if support is not pressed)
    loaded = replace(scene, supports=held, loads=(dead,))
    structure = to_structure(loaded, **kept(options, "elements element"))
    result = tsm.trace(structure, arc_length=given["arc_length"], steps=given["steps"], throw=False)
    found = [event.load_parameter for event in result.events if event.kind is tsm.EventKind.LIMIT_POINT]
    if len(found) < (count := len(answers.problem.quantities)):
        raise StoppedError(f"{result.status.name}: {result.message}; {len(found)} limit points of {count}")
    shown = result.load_parameter <= given["highest"]
    down = scene.place(dead.node)[1] - result.tips[dead.beam][shown, 1]
    answers.draw(np.append(0.0, down), np.append(0.0, result.load_parameter[shown]))
    for one in answers.problem.quantities:
        answers.draw_exact([0.0, down.max()], [one.exact, one.exact])
    yield from found[:count]


def power_law(answers: Answers) -> Iterable[float]:
    """Exponent of the error of the force against the rod, or of the size of what is read, in the setting that is varied."""
    # ``of`` is what is read, ``sign`` is -1 for the exponent in the inverse of the setting
    given, found = answers.problem.settings, list[float]()
    for one in given["values"]:
        scene = changed(answers.scene, {given["varies"]: one})
        response = answers.solved(scene)
        if "of" in given:
            found.append(abs(value(response, given["of"], 1.0)))
        else:
            found.append(difference(response, answered(scene, ROD.name), scene, "force"))
    answers.draw(given["values"], found)
    yield float(given["sign"] * np.polyfit(np.log(given["values"]), np.log(found), 1)[0])


def _solved_directly(answers: Answers, times: Array, **strip: Any) -> Any:
    """The result of the program of `tsm` or the solid itself; `strip` changes what a scene does not state."""
    import fem_reference
    import tsm

    scene, options, name = answers.scene, answers.trial.options, answers.scene.beams[0].name
    solid = answers.trial.model == SOLID.name
    result: Any
    if solid:
        result = solved(to_solid(scene, mesh=options.mesh), times, throw=False, **strip)
    else:
        beams = to_structure(scene, **kept(options, "elements element"))
        result = tsm.solve(beams, times, throw=False)
    if result.status.name != "COMPLETED":
        raise StoppedError(f"{result.status.name}: {result.message}")
    line = fem_reference.axis_line(result, name, -1) if solid else result.axis_line(name, -1)[1]
    answers.draw(*line.T)
    return result


def in_plane_strain(answers: Answers) -> Iterable[float]:
    """Contact force and arc position of a solid in plane strain."""
    result = _solved_directly(answers, np.array(answers.scene.times), plane="strain")
    (contact,) = result.contacts.values()
    yield from (float(contact.force[-1]), float(contact.arc_position[-1]))


def work_over_energy(answers: Answers) -> Iterable[float]:
    """Work of a pin, by Gauss quadrature at whose points the solver is called, over the energy stored, a penalty's included."""
    import fem_reference

    t, weights = np.polynomial.legendre.leggauss(80)
    result = _solved_directly(answers, np.append((1.0 + t) / 2.0, 1.0))
    solid = answers.trial.model == SOLID.name
    energy = sum(fem_reference.energy(result, -1)) if solid else result.strain_energy[-1]
    force = -result.supports[answers.scene.all_supports[0].node].force[:-1]
    start, end = np.array(answers.scene.pins[0].points)
    yield float(weights / 2.0 @ force @ (end - start) / energy)


def invariance(answers: Answers) -> Iterable[float]:
    """Largest changes of contact force and clamp moment in the scene that is moved, mirrored or named from the other end."""
    other = read_scene(answers.problem.settings["other"], answers.problem.name)
    found = [table(one, along=False) for one in (answers.solved(answers.scene), answers.shown(other))]
    answers.lines.extend(undeformed(other))
    for name in (".force", ".moment"):
        a, b = (np.abs(next(one[key] for key in one if key.endswith(name))) for one in found)
        yield float(np.abs(b - a).max() / np.abs(a).max())


Measure = Callable[[Answers], Iterable[float]]
MEASURES: dict[str, Measure] = {
    measure.__name__: measure
    for measure in (
        readings, critical_load, greatest_load, limit_points, power_law, in_plane_strain, work_over_energy, invariance,
    )
}  # fmt: skip
"""The functions that a problem can name as its ``measure``."""

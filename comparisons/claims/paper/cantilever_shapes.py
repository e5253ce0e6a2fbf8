"""Fig. 7a: the cantilever of section 4.1 lifted by a pin from six starting positions until it slips off."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.claims.paper.critical_area import STARTS, lifted
from comparisons.claims.paper.figure_study import Study, column, legend, shape_panels
from comparisons.claims.paper.formulations import LABELS, MIXED, TIMOSHENKO, line
from comparisons.models import ROD, TSM, solve
from comparisons.models.options import Options
from comparisons.output import Report, Row
from comparisons.response import Response
from comparisons.scene import Scene
from comparisons.show import palette
from comparisons.show.plot import EXACT, save

ELEMENTS = (18, 72)
"""The paper's number of elements, and four times as many."""
DEPTHS = (0.25, 0.5, 0.75, 1.0)
"""Shapes shown, in parts of the displacement at slip-off: the last load parameter before."""
Drawn = tuple[Scene, Response, Response]
"""A scene with the responses of `mixed` and of the exact rod."""


def cantilever_shapes(*, quick: bool, report: Report) -> Study:
    """Solve the six; `quick` takes two of them with a quarter of the load parameters and without Euler-Bernoulli."""
    lifts, histories, drawn, stopped = list[Row](), list[Row](), list[Drawn](), list[str]()
    for start in STARTS[::4] if quick else STARTS:
        report(f"pin at {start:g} m")
        scene = lifted(start)
        if quick:
            scene = replace(scene, load_parameters=scene.load_parameters // 4)
        pair, travel = scene.contacts[0].pair, scene.pins[0].points[1][1]
        runs = {elements: solve(scene, TSM.name, Options(elements=elements)) for elements in ELEMENTS}
        beams, rod = runs[ELEMENTS[0]], solve(scene, ROD.name)
        history = list(_history(travel, beams, rod, pair))
        histories += [{"start": start, **row} for row in history]
        force, exact_force = column(history, "force"), column(history, "rod_force")
        slip_off = {elements: travel * run.contacts[pair].slip_off for elements, run in runs.items()}
        exact = travel * rod.contacts[pair].slip_off
        tried = (TIMOSHENKO, MIXED) if quick else LABELS
        lift = {
            "start": start,
            "slip_off_rod": exact,
            "slip_off": slip_off,
            "slip_off_error": {elements: abs(value / exact - 1.0) for elements, value in slip_off.items()},
            "force_error": float(np.abs(force - exact_force).max() / exact_force.max()),
            "reached_in_contact": {element: travel * _reached(scene, element) for element in tried},
        }
        lifts.append(lift)
        drawn.append((scene, beams, rod))
        failed = [one for one in (beams, rod) if not one.completed]
        stopped += [f"pin at {start:g} m, {one.model}: {one.message}" for one in failed]
    return Study(
        tables={"fig7a": histories},
        numbers={"starting_positions": lifts, "stopped": stopped},
        pictures={"fig7a": partial(plot_lifts, lifts, drawn)},
        scenes=tuple(scene for scene, _, _ in drawn),
    )


def _history(travel: float, beams: Response, rod: Response, pair: str) -> Iterator[Row]:
    """Yield forces [N] and arc positions [m] against the displacement of the pin [m], where both are in contact."""
    touching, exact = beams.contacts[pair], rod.contacts[pair]
    places = travel * beams.load_parameter
    columns = (places, touching.force, exact.force, touching.arc_position, exact.arc_position)
    for values in zip(*columns, strict=False):
        if np.isfinite(values).all():
            yield dict(zip(("displacement", "force", "rod_force", "arc", "rod_arc"), values, strict=True))


def _reached(scene: Scene, element: str) -> float:
    """Load parameter up to which the contact was followed: the slip-off, or the end of the run before it."""
    response = solve(scene, TSM.name, Options(element=element))
    slip_off = response.contacts[scene.contacts[0].pair].slip_off
    return slip_off if np.isfinite(slip_off) else float(max(response.load_parameter, default=0.0))


def plot_lifts(lifts: list[Row], drawn: list[Drawn], *paths: Path) -> None:
    """Draw the deformed beams over the exact rod, one panel per starting position."""
    fig, grid = shape_panels(len(lifts), 1.5, 0.8)
    for axes, lift, found in zip(grid.flat, lifts, drawn, strict=False):
        _draw_lift(axes, *found)
        words = f"pin at {lift['start']:g} m: slips off at {lift['slip_off'][ELEMENTS[0]]:.4f} m"
        axes.set_title(words, fontsize="small")
        axes.set_xlim(-0.1, 5.35)
    legend(fig, grid, 3)
    save(fig, *paths)


def _draw_lift(axes: Any, scene: Scene, beams: Response, rod: Response) -> None:
    beam, contact = scene.beams[0], beams.contacts[scene.contacts[0].pair]
    last = int(np.flatnonzero(np.isfinite(contact.arc_position))[-1])
    axes.plot(*np.array([beam.start, beam.end]).T, color="0.6", linewidth=0.8)
    for part in DEPTHS:
        k = round(part * last)
        exact, axis = rod.axis_line(beam.name, k)[1], beams.axis_line(beam.name, k)[1]
        wide = {**EXACT, "linewidth": 4.0, "alpha": 0.25}
        axes.plot(*exact.T, color=palette.BLACK, **wide, label="exact rod")
        style = {**line(MIXED), "marker": ".", "markersize": 5, "linestyle": "-", "linewidth": 0.9}
        every = (len(axis) - 1) // ELEMENTS[0]
        axes.plot(*axis.T, **style, markevery=every, label=f"TSM mixed, {ELEMENTS[0]} elements")
        place = scene.pins[0].position(float(beams.load_parameter[k]))
        mark = {"marker": "^", "linestyle": "none", "label": "pin, its displacement [m]", "zorder": 5}
        axes.plot(*place, color=palette.PIN, **mark)
        axes.annotate(f"{place[1]:.2f}", (4.85, axis[-1, 1]), fontsize="small", va="center", color="0.25")

"""Fig. 7a: the cantilever of section 4.1 lifted by a pin from six starting positions until it slips off."""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.claims.paper.critical_area import STARTS, lifted
from comparisons.claims.paper.figure_study import Study, column, legend, shape_panels
from comparisons.claims.paper.formulations import LABELS, MIXED, TIMOSHENKO, line
from comparisons.exact.rod import rod_under_pin
from comparisons.models import ROD, TSM, solve
from comparisons.models.options import Options
from comparisons.models.translate import to_rod
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
    lifts: list[Row] = []
    histories: list[Row] = []
    drawn: list[Drawn] = []
    for start in STARTS[::4] if quick else STARTS:
        report(f"pin at {start:g} m")
        scene = lifted(start)
        if quick:
            scene = replace(scene, load_parameters=scene.load_parameters // 4)
        runs = {elements: solve(scene, TSM.name, Options(elements=elements)) for elements in ELEMENTS}
        drawn.append((scene, runs[ELEMENTS[0]], solve(scene, ROD.name)))
        history = _history(start, *drawn[-1])
        histories += history
        lifts.append(_slipped(start, scene, runs, history, (TIMOSHENKO, MIXED) if quick else tuple(LABELS)))
    stopped = [
        f"pin at {lift['start']:g} m, {one.model}: {one.message}"
        for lift, (_, *both) in zip(lifts, drawn, strict=True)
        for one in both
        if not one.completed
    ]
    return Study(
        tables={"fig7a": histories},
        numbers={"starting_positions": lifts, "stopped": stopped},
        pictures={"fig7a": partial(plot_lifts, lifts, drawn)},
        scenes=tuple(scene for scene, _, _ in drawn),
    )


def _history(start: float, scene: Scene, beams: Response, rod: Response) -> list[Row]:
    """Forces [N] and arc positions [m] against the displacement of the pin [m], where both are in contact."""
    touching, exact = (one.contacts[scene.contacts[0].pair] for one in (beams, rod))
    found = zip(
        beams.load_parameter,
        touching.force,
        exact.force,
        touching.arc_position,
        exact.arc_position,
        strict=False,
    )
    names = ("displacement", "force", "rod_force", "arc", "rod_arc")
    travel = scene.pins[0].points[1][1]
    return [
        {"start": start, **dict(zip(names, (travel * t, *values), strict=True))}
        for t, *values in found
        if np.isfinite(values[2:]).all()
    ]


def _slipped(
    start: float, scene: Scene, runs: dict[int, Response], history: list[Row], tried: tuple[str, ...]
) -> Row:
    """Displacements of the pin at slip-off [m], errors against the exact rod, and how far each formulation comes by `tsm.solve`."""
    travel, pair, local = scene.pins[0].points[1][1], scene.contacts[0].pair, to_rod(scene)
    section = {"EA": local.beam.EA, "GA": local.beam.GA, "EI": local.beam.EI, "length": local.beam.length}
    exact = travel * rod_under_pin(local.path[[0, -1]], **section).slip_off
    slip_off = {elements: travel * run.contacts[pair].slip_off for elements, run in runs.items()}
    force, rod_force = column(history, "force"), column(history, "rod_force")
    return {
        "start": start,
        "slip_off_rod": exact,
        "slip_off": slip_off,
        "slip_off_error": {elements: abs(value / exact - 1.0) for elements, value in slip_off.items()},
        "force_error": float(np.abs(force - rod_force).max() / rod_force.max()),
        "reached_in_contact": {element: travel * _reached(scene, element) for element in tried},
    }


def _reached(scene: Scene, element: str) -> float:
    """Load parameter up to which the contact was followed: the slip-off, or the end of the run before it."""
    response = solve(scene, TSM.name, Options(element=element))
    slip_off = response.contacts[scene.contacts[0].pair].slip_off
    if np.isfinite(slip_off):
        return slip_off
    return float(response.load_parameter[-1]) if len(response.load_parameter) else 0.0


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
        nodes = {
            "marker": ".",
            "markersize": 5,
            "markevery": (len(axis) - 1) // ELEMENTS[0],
            "linewidth": 0.9,
        }
        color = line(MIXED)["color"]
        axes.plot(*axis.T, color=color, **nodes, label=f"TSM mixed, {ELEMENTS[0]} elements")
        place = scene.pins[0].position(float(beams.load_parameter[k]))
        mark = {"marker": "^", "linestyle": "none", "label": "pin, its displacement [m]", "zorder": 5}
        axes.plot(*place, color=palette.PIN, **mark)
        axes.annotate(f"{place[1]:.2f}", (4.85, axis[-1, 1]), fontsize="small", va="center", color="0.25")

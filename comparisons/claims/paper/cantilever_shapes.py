"""Fig. 7a: the cantilever of section 4.1 lifted by a pin from six starting positions until it slips off."""

from dataclasses import replace
from functools import partial

import numpy as np

from comparisons.claims.drawing import SHAPE, Line, Panel, draw
from comparisons.claims.paper.critical_area import STARTS, lifted
from comparisons.claims.paper.figure_study import Study, column, reached, stops
from comparisons.claims.paper.formulations import LABELS, MIXED, TIMOSHENKO, line
from comparisons.models import ROD, TSM, solve
from comparisons.models.options import Options
from comparisons.output import Report, Row
from comparisons.response import Response
from comparisons.scene import Scene
from comparisons.show import palette

ELEMENTS = (18, 72)
"""The paper's number of elements, and four times as many."""
DEPTHS = (0.25, 0.5, 0.75, 1.0)
"""Shapes shown, in parts of the displacement at slip-off: the last load parameter before."""


def cantilever_shapes(*, quick: bool, report: Report) -> Study:
    """Solve the six; `quick` takes two of them with a quarter of the load parameters and without Euler-Bernoulli."""
    lifts, histories, panels = list[Row](), list[Row](), list[Panel]()
    scenes, runs = list[Scene](), dict[str, Response]()
    for start in STARTS[::4] if quick else STARTS:
        place, scene = f"pin at {start:g} m", lifted(start)
        report(place)
        if quick:
            scene = replace(scene, load_parameters=scene.load_parameters // 4)
        scenes.append(scene)
        pair, (_, (_, travel)) = scene.contacts[0].pair, scene.pins[0].points
        found = {elements: solve(scene, TSM.name, Options(elements=elements)) for elements in ELEMENTS}
        beams, rod = found[ELEMENTS[0]], solve(scene, ROD.name)
        runs |= {f"{place}, {one.model}": one for one in (beams, rod)}
        history = _history(travel, beams, rod, pair)
        histories += [{"start": start, **row} for row in history]
        force, exact_force = column(history, "force"), column(history, "rod_force")
        slip_off = {elements: travel * run.contacts[pair].slip_off for elements, run in found.items()}
        exact = travel * rod.contacts[pair].slip_off
        tried = {
            one: solve(scene, TSM.name, Options(element=one))
            for one in ((TIMOSHENKO, MIXED) if quick else LABELS)
        }
        lifts.append(
            {
                "start": start,
                "slip_off_rod": exact,
                "slip_off": slip_off,
                "slip_off_error": {n: abs(value / exact - 1.0) for n, value in slip_off.items()},
                "force_error": float(np.abs(force - exact_force).max() / exact_force.max()),
                # up to the slip-off, or the end of the run before it
                "reached_in_contact": {
                    element: travel * float(np.nan_to_num(run.contacts[pair].slip_off, nan=reached(run)))
                    for element, run in tried.items()
                },
            }
        )
        panels.append(_panel(f"{place}: slips off at {slip_off[ELEMENTS[0]]:.4f} m", scene, beams, rod))
    return Study(
        tables={"fig7a": histories},
        numbers={"starting_positions": lifts, "stopped": stops(runs)},
        pictures={"fig7a": partial(draw, panels, tall=1.5)},
        scenes=tuple(scenes),
    )


def _history(travel: float, beams: Response, rod: Response, pair: str) -> list[Row]:
    """Forces [N] and arc positions [m] against the displacement of the pin [m], where both are in contact."""
    own, exact = beams.contacts[pair], rod.contacts[pair]
    columns = (travel * beams.load_parameter, own.force, exact.force, own.arc_position, exact.arc_position)
    names = ("displacement", "force", "rod_force", "arc", "rod_arc")
    rows = zip(*columns, strict=False)
    return [dict(zip(names, row, strict=True)) for row in rows if np.isfinite(row).all()]


def _panel(title: str, scene: Scene, beams: Response, rod: Response) -> Panel:
    """The deformed beam over the exact rod, at some displacements of the pin."""
    beam, contact = scene.beams[0], beams.contacts[scene.contacts[0].pair]
    last = int(np.flatnonzero(np.isfinite(contact.arc_position))[-1])
    wide = {"color": palette.BLACK, "linewidth": 4.0, "alpha": 0.25, "label": "exact rod"}
    own = {**line(MIXED), "marker": ".", "linestyle": "-", "label": f"TSM mixed, {ELEMENTS[0]} elements"}
    mark = {"color": palette.PIN, "marker": "^", "linestyle": "none", "label": "pin, its displacement [m]"}
    lines: list[Line] = [(*np.array([beam.start, beam.end]).T, {"color": "0.6", "linewidth": 0.8})]
    notes = []
    for k in (round(part * last) for part in DEPTHS):
        axis, exact = (one.axis_line(beam.name, k)[1] for one in (beams, rod))
        x, y = scene.pins[0].position(float(beams.load_parameter[k]))
        lines += [
            (*exact.T, wide),
            (*axis.T, {**own, "markevery": (len(axis) - 1) // ELEMENTS[0]}),
            (x, y, mark),
        ]
        notes.append((f"{y:.2f}", (4.85, float(axis[-1, 1]))))
    return Panel(
        title=title, lines=lines, settings={**SHAPE, "xlim": (-0.1, 5.6), "ylim": (-0.1, 1.95)}, notes=notes
    )

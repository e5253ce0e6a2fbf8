"""Fig. 9: two cantilevers pressed by one pin, stage by stage, against the exact rods."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from comparisons.cases.settings import changed
from comparisons.claims.paper.double_beam_plot import NAMES, plot_histories, plot_stages
from comparisons.claims.paper.figure_study import Study
from comparisons.claims.paper.formulations import CANTILEVER, SIMPLE, TIMOSHENKO
from comparisons.claims.problems.double_beam import EVENTS, HAND_OVER, LOWER, TIP, UPPER
from comparisons.models import ROD, TSM, solve
from comparisons.models.options import Options
from comparisons.output import Report, Row
from comparisons.response import Array, Response
from comparisons.scene import Scene, load_scene
from comparisons.show.pages import Section, Track, motion_section

FINER = 10
"""Load parameters of the picture per load parameter of the scene."""
BEAMS, RODS = "TSM mixed, 10 elements a beam", "exact rods, coupled"
"""The runs on the page."""
Columns = Mapping[str, Array]
"""The depth of the pin [m]; by pair, forces [N] and arc positions [m] of the beams and the exact rods, nan where the pair is open."""


def double_beam(*, quick: bool, report: Report) -> Study:
    """Solve the scene; `quick` keeps the scene's load parameters and tries only the paper's Timoshenko element."""
    scene = load_scene("double-beam")
    report("mixed, 10 + 10 elements")
    own = solve(scene, TSM.name)
    finer = scene if quick else replace(scene, load_parameters=FINER * scene.load_parameters)
    response = own if quick else solve(finer, TSM.name)
    report("exact rods")
    exact = solve(finer, ROD.name)
    travel = abs(scene.pins[0].points[1][1])
    columns = {"depth": travel * response.load_parameter}
    for pair in NAMES:
        beams, rods = response.contacts[pair], exact.contacts[pair]
        closed, touching = np.isfinite(beams.arc_position), np.isfinite(rods.arc_position)
        columns |= {
            f"{pair} force": np.where(closed, beams.force, np.nan),
            f"{pair} arc": beams.arc_position,
            f"{pair} exact_force": np.where(touching, rods.force, np.nan),
            f"{pair} exact_arc": rods.arc_position,
        }
    events = [
        {
            "kind": event.kind,
            "depth": travel * event.load_parameter,
            "pair": event.pair,
            "element": event.element,
            "arc": event.arc_position,
            "force": event.force,
            "released": event.released,
        }
        for event in response.events or ()
    ]
    report("the paper's elements")
    tried = (TIMOSHENKO,) if quick else (TIMOSHENKO, SIMPLE, CANTILEVER)
    stages = list(_stages(columns["depth"]))
    pictures = {"fig9": partial(plot_stages, finer, response, stages)} if stages else {}
    return Study(
        tables={
            "fig9": [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
        },
        numbers={
            "exact_events": EVENTS,
            "events": events,
            "checks": list(_checks(columns)),
            "stages": stages,
            "iterations": own.iterations,
            "seconds": own.wall_seconds,
            "attempts": [_attempt(scene, element, place) for element in tried for place in HAND_OVER],
            "stopped": [
                f"{one.setting or one.model}: {one.status}: {one.message}"
                for one in (own, response, exact)
                if not one.completed
            ],
        },
        pictures={**pictures, "fig9-forces": partial(plot_histories, finer, columns, events)},
        scenes=(finer,),
        moving=(_moving(finer, response, columns),),
    )


def _checks(columns: Columns) -> Iterator[Row]:
    """Yield the largest errors against the exact rods by stage: of the force over its largest, and of the arc position [m]."""
    depth = columns["depth"]
    before, after = depth < EVENTS["touch"], depth > EVENTS["hand-over"]
    parts: tuple[tuple[str, str, NDArray[np.bool_]], ...] = (
        ("one rod under the pin", UPPER, before),
        ("coupled", UPPER, ~before & ~after),
        ("coupled", TIP, ~before & ~after),
        ("the other rod under the pin", LOWER, after),
    )
    for stage, pair, part in parts:
        force, arc, exact_force, exact_arc = (
            columns[f"{pair} {name}"] for name in ("force", "arc", "exact_force", "exact_arc")
        )
        both = part & np.isfinite(arc) & np.isfinite(exact_arc)
        differences = (
            (
                np.abs(force - exact_force)[both].max() / exact_force[both].max(),
                np.abs(arc - exact_arc)[both].max(),
            )
            if both.any()
            else (np.nan, np.nan)
        )
        yield {"stage": stage, "pair": pair, "force": differences[0], "arc": differences[1]}


def _stages(depth: Array) -> Iterator[Row]:
    """Yield the paper's stages, none if the run does not reach the last; `index` counts the depths, -1 is the undeformed state."""
    touch, over, off = EVENTS["touch"], EVENTS["hand-over"], EVENTS["slip-off"]
    if depth[-1] < off:
        return
    for key, title, k in (
        ("a", "contact about to occur", -1),
        ("b", "both contacts begin", int(np.argmax(depth >= touch))),
        ("c", "both contacts slide", int(np.argmax(depth >= (touch + over) / 2.0))),
        ("d", "just before the hand-over", int(np.argmax(depth >= over)) - 1),
        ("e", "pin on the lower beam", int(np.argmax(depth >= over + 0.02))),
        ("f", "about to leave the lower beam", int(np.argmax(depth >= off)) - 1),
    ):
        yield {"key": key, "title": title, "depth": 0.0 if k < 0 else float(depth[k]), "index": k}


def _attempt(scene: Scene, element: str, place: float) -> Row:
    """How far `tsm.solve` comes with a formulation and a place of the pin [m], the last depth [m], and the beam nodes passed.

    `at_hand_over`: what stops it is the second contact on an element that knows one, where the exact rods hand over, between the
    last depth with an answer and the next one.
    """
    moved = changed(scene, {("pin", "start"): (place, scene.pins[0].points[0][1])})
    response = solve(moved, TSM.name, Options(element=element))
    travel = abs(moved.pins[0].points[1][1])
    reached = float(response.load_parameter[-1]) if len(response.load_parameter) else 0.0
    over = HAND_OVER[place] / travel
    return {
        "element": element,
        "place": place,
        "status": response.status,
        "depth": travel * reached,
        "passes": sum(event.kind == "pass-through" for event in response.events or ()),
        "at_hand_over": response.status == "TWO_CONTACTS"
        and reached < over <= reached + 1.0 / scene.load_parameters,
    }


def _moving(scene: Scene, response: Response, columns: Columns) -> Section:
    histories = [
        Track(
            title=f"{title}, {name}", unit=unit, values={BEAMS: beams, RODS: columns[f"{pair} exact_{key}"]}
        )
        for pair, name in NAMES.items()
        for title, unit, key in (("force", "N", "force"), ("arc position", "m", "arc"))
        if np.isfinite(beams := columns[f"{pair} {key}"]).any()
    ]
    title = "Double beam: shapes and histories"
    return motion_section(title, scene, {BEAMS: response}, histories, focus=BEAMS)

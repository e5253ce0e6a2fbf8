"""Fig. 9: two cantilevers pressed by a pin, against the exact rods of `tests/oracles/coupled.py`."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from itertools import groupby, product
from typing import Any

import numpy as np

from comparisons.answer import Array, Response
from comparisons.models import ROD, TSM, solve
from comparisons.models.options import Options
from comparisons.output import Report, Row
from comparisons.report import palette
from comparisons.report.motion import motion_section, tracks
from comparisons.scene import Scene, load_scene
from comparisons.suite.settings import changed
from comparisons.suites.drawing import NOTE, SHAPE, draw
from comparisons.suites.paper.figure import (
    CANTILEVER,
    SIMPLE,
    TIMOSHENKO,
    Facts,
    Study,
    column,
    reached,
    stops,
)

UPPER, TIP, LOWER = "pin->upper", "upper.end->lower", "pin->lower"
"""The contact pairs."""
HAND_OVER = {0.8: 0.53711095995669, 0.81: 0.52556048878907}
"""Depth at which the pin leaves the upper beam, by the place of the pin [m]: the tip still presses on the lower one."""
EVENTS = {"touch": 0.14978639329635, "hand-over": HAND_OVER[0.8], "slip-off": 0.73869353636162}
"""Depths of the pin at which the tip meets the lower beam, and the pin leaves the upper beam and the lower one [m]."""
FORCES = (1.00397705580342, 0.2905931420562)
"""Forces of the pin and of the tip at the depth .31 m [N]."""


EXPECTED = {"touch": ("touch", TIP), "hand-over": ("slip-off", UPPER), "slip-off": ("slip-off", LOWER)}
"""Kind and pair of the events whose depths the exact rods have."""
FINER = 10
"""Load parameters of the picture per load parameter of the scene."""
BEAMS, RODS = "TSM mixed, 10 elements a beam", "exact rods, coupled"
"""The runs on the page."""
COLOURS = {"upper": palette.BLUE, "lower": palette.SKY}
NAMES = {UPPER: "pin on upper", TIP: "upper's tip on lower", LOWER: "pin on lower"}
"""The contact pairs in words."""
STYLES: dict[str, dict[str, Any]] = {
    UPPER: {"color": palette.VERMILION, "linestyle": "-"},
    TIP: {"color": palette.PURPLE, "linestyle": (0, (6, 1))},
    LOWER: {"color": palette.GREEN, "linestyle": (0, (2, 1))},
}
ARROW = 0.16
"""Length of the line of a force per force [m/N]."""
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
    for pair, (prefix, run) in product(NAMES, (("", response), ("exact_", exact))):
        contact = run.contacts[pair]
        closed = np.isfinite(contact.arc_position)
        columns[f"{pair} {prefix}force"] = np.where(closed, contact.force, np.nan)
        columns[f"{pair} {prefix}arc"] = contact.arc_position
    names = ("kind", "pair", "element", "force", "released")
    events = [
        {
            **{name: getattr(event, name) for name in names},
            "depth": travel * event.load_parameter,
            "arc": event.arc_position,
        }
        for event in response.events or ()
    ]
    report("the paper's elements")
    tried = (TIMOSHENKO,) if quick else (TIMOSHENKO, SIMPLE, CANTILEVER)
    rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    stages = list(_stages(columns["depth"]))
    title = "Mixed elements, 10 + 10;\nthe forces act on the touched beams, grey are the beams at rest"
    panels = [partial(_stage, finer, response, stage) for stage in stages]
    shapes = {"fig9": partial(draw, panels, tall=2.8, title=title)} if stages else {}
    drawn = {"force": "contact force [N]", "arc": "arc position [m]"}.items()
    forces = [partial(_histories, columns, events, *of) for of in drawn]
    shown = tracks({BEAMS: response, RODS: exact}, RODS, finer)
    moving = motion_section("Double beam: shapes and histories", finer, {BEAMS: response}, shown, focus=BEAMS)
    return Study(
        tables={"fig9": rows},
        numbers={
            "exact_events": EVENTS,
            "events": events,
            "checks": list(_checks(columns)),
            "stages": stages,
            "iterations": own.iterations,
            "seconds": own.wall_seconds,
            "attempts": [_attempt(scene, element, place) for element, place in product(tried, HAND_OVER)],
            "stopped": stops({one.setting or one.model: one for one in (own, response, exact)}),
        },
        pictures={**shapes, "fig9-forces": partial(draw, forces, tall=3.2, columns=1)},
        scenes=(finer,),
        moving=(moving,),
    )


def _checks(columns: Columns) -> Iterator[Row]:
    """Yield the largest errors against the exact rods by stage: of the force over its largest, and of the arc position [m]."""
    depth = columns["depth"]
    before, after = depth < EVENTS["touch"], depth > EVENTS["hand-over"]
    for stage, pair, part in (
        ("one rod under the pin", UPPER, before),
        ("coupled", UPPER, ~before & ~after),
        ("coupled", TIP, ~before & ~after),
        ("the other rod under the pin", LOWER, after),
    ):
        exact = columns[f"{pair} exact_force"]
        force, arc = (
            np.abs(columns[f"{pair} {name}"] - columns[f"{pair} exact_{name}"]) for name in ("force", "arc")
        )
        both = part & np.isfinite(arc)
        largest = (force[both].max() / exact[both].max(), arc[both].max()) if both.any() else (np.nan, np.nan)
        yield {"stage": stage, "pair": pair, **dict(zip(("force", "arc"), largest, strict=True))}


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
    """How deep [m] `tsm.solve` comes with a formulation and a place of the pin, and the nodes passed."""
    # at_hand_over: a second contact on an element that knows one stops it where the exact rods hand over
    moved = changed(scene, {("pin", "start"): (place, scene.pins[0].points[0][1])})
    response = solve(moved, TSM.name, Options(element=element))
    travel = abs(moved.pins[0].points[1][1])
    last, over = reached(response), HAND_OVER[place] / travel
    return {
        "element": element,
        "place": place,
        "status": response.status,
        "depth": travel * last,
        "passes": sum(event.kind == "pass-through" for event in response.events or ()),
        "at_hand_over": response.status == "TWO_CONTACTS"
        and last < over <= last + 1.0 / scene.load_parameters,
    }


def _stage(scene: Scene, response: Response, stage: Row, axes: Any) -> None:
    """Both beams, the pin and the contact forces at a stage."""
    k = stage["index"]
    for beam in scene.beams:
        rest = np.array([beam.start, beam.end])
        axis = rest if k < 0 else response.axis_line(beam.name, k)[1]
        every = max(1, (len(axis) - 1) // beam.divisions)
        style = {"color": COLOURS[beam.name], "marker": "o", "markersize": 3, "markevery": every}
        axes.plot(*rest.T, color="0.75", linewidth=0.8)
        axes.plot(*axis.T, label=f"{beam.name} beam", **style)
    pin = np.array(scene.pins[0].position(0.0 if k < 0 else float(response.load_parameter[k])))
    for row, (pair, name) in enumerate(NAMES.items() if k >= 0 else ()):
        contact, point = response.contacts[pair], response.tips["upper"][k] if pair == TIP else pin
        if np.isfinite(contact.arc_position[k]) and contact.vector is not None:
            ends = np.array([point - ARROW * contact.vector[k], point])
            axes.plot(*ends.T, color=STYLES[pair]["color"], label=f"force of {name}")
            axes.annotate(f"{name}: {contact.force[k]:.3f} N", (0.0, -0.62 - 0.07 * row), **NOTE)
    axes.plot(*pin, color="black", marker="o", markerfacecolor="white", linestyle="none", label="pin")
    title = f"({stage['key']}) {stage['title']},\ndepth {stage['depth']:.3f} m"
    axes.set(title=title, xlim=(-0.05, 1.08), ylim=(-0.8, 0.2), **SHAPE)


def _histories(columns: Columns, events: list[Row], quantity: str, label: str, axes: Any) -> None:
    """A quantity of all contacts against the depth, with the exact rods and the events, those at one depth together."""
    for pair, name in NAMES.items():
        axes.plot(
            columns["depth"], columns[f"{pair} exact_{quantity}"], color="0.7", linewidth=5.0, label=RODS
        )
        axes.plot(columns["depth"], columns[f"{pair} {quantity}"], label=name, **STYLES[pair])
    high = axes.dataLim.y1
    later = (one for one in events if one["depth"] > 0.0)
    for number, (_, found) in enumerate(groupby(later, key=lambda one: round(one["depth"], 3)), 1):
        same = list(found)
        depth, words = same[0]["depth"], "; ".join(f"{one['kind']}, {NAMES[one['pair']]}" for one in same)
        dotted = {"color": "0.4", "linestyle": ":", "label": f"{number}: {depth:.4f} m, {words}"}
        axes.plot([depth, depth], [0.0, high], **dotted)
        axes.annotate(str(number), (depth, high), **NOTE)
    axes.set(xlabel="depth of the pin [m]", ylabel=label, title="Double beam, 10 + 10 mixed elements")


def of_double_beam(found: Study) -> Facts:
    """Events against those of the exact rods, and how far the paper's element comes."""
    events, rows = found.numbers["events"], found.tables["fig9"]
    attempts = [attempt for attempt in found.numbers["attempts"] if attempt["element"] == TIMOSHENKO]
    first = {(one["kind"], one["pair"]): one for one in reversed(events)}
    depths = {name: first[one]["depth"] if one in first else np.nan for name, one in EXPECTED.items()}
    coupled = [row for row in rows if EVENTS["touch"] < row["depth"] < EVENTS["hand-over"]]
    # a run that ends at the hand-over ends where this program does, and the paper's went on
    through = [None if one["at_hand_over"] else one["status"] == "COMPLETED" for one in attempts]
    over = [one for one in events if one["depth"] == depths["hand-over"] and one["pair"] in {TIP, LOWER}]
    crowded = ", ".join(map(str, sorted({one["element"] + 1 for one in over})))
    reasons = {
        False: " A pin that starts on a beam node is in the critical area from the start.",
        None: " Beside the node both contacts pass every node until the hand-over. There pin and upper tip are on one element of the "
        f"lower beam (number {crowded}), the paper's element has one contact point, and how its program went on is not said.",
    }
    deepest = max(attempt["depth"] for attempt in attempts)
    return {
        "event": {
            name: f"{kind} of {pair} at depth {depths[name]:.6f} m, exact rods {EVENTS[name]:.6f} m"
            if (kind, pair) in first
            else f"no {kind} of {pair}"
            for name, (kind, pair) in EXPECTED.items()
        },
        "off": {name: abs(depth - EVENTS[name]) for name, depth in depths.items()},
        "closed": [np.isfinite(column(coupled, f"{pair} arc")).all() for pair in (UPPER, TIP)],
        "taken_over": ("touch", LOWER) in first,
        "expected": EVENTS,
        "released": sum(
            one["released"] for one in events if (one["kind"], one["pair"]) == EXPECTED["hand-over"]
        ),
        "last": np.nanmax(column(rows, f"{TIP} exact_force")),
        "attempts": ", ".join(
            f"pin at {one['place']:g} m: {one['status']} at depth {one['depth']:.2f} m, {one['passes']} nodes passed"
            for one in attempts
        ),
        "passed": sum(one["kind"] == "pass-through" for one in events),
        "through": through,
        "reasons": "".join(words for end, words in reasons.items() if end in through),
        "deepest": deepest,
        "beyond": deepest - EVENTS["touch"],
        "apart": max(one["force"] for one in found.numbers["checks"] if one["stage"] == "coupled"),
    }

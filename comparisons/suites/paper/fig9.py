"""Fig. 9: two cantilevers pressed by a pin, against the exact rods of `tests/oracles/coupled.py`."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, product

import numpy as np

from comparisons.answer import Array, Response
from comparisons.models import ROD, TSM, solve
from comparisons.models.model import Options
from comparisons.models.shared import kept
from comparisons.output import Report, Row
from comparisons.report import palette
from comparisons.report.motion import motion_section, tracks
from comparisons.report.plot import Line
from comparisons.scene import Scene, load_scene
from comparisons.suite.settings import changed
from comparisons.suites.paper.figure import (
    CANTILEVER,
    SIMPLE,
    STATED,
    TIMOSHENKO,
    Study,
    pictures,
    shapes,
    stops,
)

UPPER, TIP, LOWER = "pin->upper", "upper.end->lower", "pin->lower"
"""The contact pairs."""
HAND_OVER = {0.8: 0.53711095995669, 0.81: 0.52556048878907}
"""Depth at which the pin leaves the upper beam, by the place of the pin [m]: the tip still presses on the lower one."""
EVENTS = {"touch": 0.14978639329635, "hand-over": HAND_OVER[0.8], "slip-off": 0.73869353636162}
"""Depths of the pin at which the tip meets the lower beam, and the pin leaves the upper beam and the lower one [m], of the exact rods."""
EXPECTED = {"touch": ("touch", TIP), "hand-over": ("slip-off", UPPER), "slip-off": ("slip-off", LOWER)}
"""Kind and pair of these events."""
FINER = 10
"""Load parameters of the picture per load parameter of the scene."""
BEAMS, RODS = "TSM mixed, 10 elements a beam", "exact rods, coupled"
"""The runs on the page."""
NAMES = {UPPER: "pin on upper", TIP: "upper's tip on lower", LOWER: "pin on lower"}
"""The contact pairs in words."""
COLOURS = {UPPER: palette.VERMILION, TIP: palette.PURPLE, LOWER: palette.BLUE}
ARROW = 0.16
"""Length of the line of a force per force [m/N]."""
Columns = Mapping[str, Array]
"""The depth of the pin [m]; by pair, forces [N] and arc positions [m] of the beams, the exact rods and the paper's element, nan where the pair is open."""


def double_beam(*, quick: bool, report: Report) -> Study:
    """Solve the scene; `quick` keeps the scene's load parameters and tries only the paper's Timoshenko element."""
    scene = load_scene("double-beam")
    report("mixed, 10 + 10 elements")
    own = solve(scene, TSM.name)
    finer = scene if quick else replace(scene, load_parameters=FINER * scene.load_parameters)
    response = own if quick else solve(finer, TSM.name)
    report("exact rods")
    exact = solve(finer, ROD.name)
    report("the paper's elements")
    tried = (TIMOSHENKO,) if quick else (TIMOSHENKO, SIMPLE, CANTILEVER)
    attempts = [_attempt(scene, element, place) for element, place in product(tried, HAND_OVER)]
    # with an element more than the scene has the pin starts on no node
    given = scene.beams[0].divisions
    paper = solve(finer, TSM.name, Options(element=TIMOSHENKO, elements=given + 1))
    columns = {"depth": (travel := _travel(scene)) * response.load_parameter}
    stopped = travel * float(paper.load_parameter.max(initial=0.0))
    label = f"TSM {TIMOSHENKO}, {given + 1} elements a beam:\n{paper.status} after {stopped:.3f} m,\n"
    label += f"with {given} {attempts[0]['status']} after {attempts[0]['depth']:g} m"
    for pair, (prefix, run) in product(NAMES, (("", response), ("exact_", exact), ("paper_", paper))):
        contact, missing = run.contacts[pair], len(columns["depth"]) - len(run.load_parameter)
        force = np.where(np.isnan(contact.arc_position), np.nan, contact.force)
        for name, values in (("force", force), ("arc", contact.arc_position)):
            columns[f"{pair} {prefix}{name}"] = np.append(values, np.full(missing, np.nan))
    events = [{**vars(one), "depth": travel * one.load_parameter} for one in response.events or ()]
    stages = _stages(columns["depth"])
    drawn = dict(_stage(finer, {label: paper, BEAMS: response}, stage) for stage in stages)
    quantities = {"force": "contact force [N]", "arc": "arc position [m]"}
    forces = {title: _histories(columns, events, name, label) for name, title in quantities.items()}
    shown = tracks({BEAMS: response, RODS: exact}, RODS, finer)
    numbers = {
        "exact_events": EVENTS,
        "events": events,
        **of_events(columns, events),
        "checks": list(_checks(columns)),
        "stages": stages,
        "iterations": own.iterations,
        "seconds": own.wall_seconds,
        "paper": {**kept(paper, "setting status"), "depth": stopped},
        "attempts": attempts,
        "stopped": stops({one.setting or one.model: one for one in (own, response, exact)}),
    }
    moving = motion_section("Double beam: shapes and histories", finer, {BEAMS: response}, shown, focus=BEAMS)
    return Study(
        tables={
            "fig9": [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
        },
        numbers=numbers,
        pictures=pictures({**({"fig9": drawn} if stages else {}), "fig9-forces": forces}),
        scenes=[finer],
        moving=[moving],
    )


def _travel(scene: Scene) -> float:
    """Depth [m] to which the pin goes."""
    return -scene.pins[0].points[1][1]


def _checks(columns: Columns) -> Iterator[Row]:
    """Yield the largest errors against the exact rods by stage: of the force over its largest, and of the arc position [m]."""
    before, after = columns["depth"] < EVENTS["touch"], columns["depth"] > EVENTS["hand-over"]
    for stage, pair, part in (
        ("one rod under the pin", UPPER, before),
        ("coupled", UPPER, ~before & ~after),
        ("coupled", TIP, ~before & ~after),
        ("the other rod under the pin", LOWER, after),
    ):
        both = part & np.isfinite(columns[f"{pair} arc"] + columns[f"{pair} exact_arc"])
        if both.any():
            names = [f"{pair} {name}" for name in ("force", "arc", "exact_force", "exact_arc")]
            force, arc, exact_force, exact_arc = (columns[name][both] for name in names)
            error = np.abs(force - exact_force).max() / exact_force.max()
            yield {"stage": stage, "pair": pair, "force": error, "arc": np.abs(arc - exact_arc).max()}


def _stages(depth: Array) -> list[Row]:
    """Return the paper's stages, none if the run does not reach the last; `index` counts the depths."""
    touch, over, off = EVENTS.values()
    if depth[-1] < off:
        return []
    places = [depth[0], touch, (touch + over) / 2.0, over, over + 0.02, off]
    steps = np.searchsorted(depth, places) - [0, 0, 0, 1, 0, 1]
    return [
        {"key": key, "title": title, "depth": float(depth[k]), "index": int(k)}
        for (key, title), k in zip(STATED["stages"].items(), steps, strict=True)
    ]


def _attempt(scene: Scene, element: str, place: float) -> Row:
    """How deep [m] `tsm.solve` comes with a formulation and a place of the pin, and the nodes passed."""
    # at_hand_over: a second contact on an element that knows one stops it where the exact rods hand over
    moved = changed(scene, {"pin.start": (place, scene.pins[0].points[0][1])})
    response, travel = solve(moved, TSM.name, Options(element=element)), _travel(moved)
    last, over = float(max(response.load_parameter, default=0.0)), HAND_OVER[place] / travel
    at_hand_over = response.status == "TWO_CONTACTS" and last < over <= last + scene.times[0]
    return {
        "element": element,
        "place": place,
        "status": response.status,
        "depth": travel * last,
        "passes": sum(event.kind == "pass-through" for event in response.events or ()),
        "at_hand_over": at_hand_over,
        # a run that ends at the hand-over ends where this program does, and the paper's went on
        "through": None if at_hand_over else response.status == "COMPLETED",
    }


def _stage(scene: Scene, runs: Mapping[str, Response], stage: Row) -> tuple[str, Iterator[Line]]:
    """Title of a stage with the contact forces; both beams, the pin, and the forces as lines."""
    k, forces, lines, response = stage["index"], list[str](), list[Line](), runs[BEAMS]
    for pair, name in NAMES.items():
        contact, vector = response.contacts[pair], response.contacts[pair].vector
        if np.isfinite(contact.arc_position[k]) and vector is not None:
            pin = scene.pins[0].position(float(response.load_parameter[k]))
            point = response.tips["upper"][k] if pair == TIP else pin
            ends = np.array([point - ARROW * vector[k], point])
            lines.append(Line(f"force of {name}", ends.T, {"color": COLOURS[pair]}))
            forces.append(f"{name} {contact.force[k]:.3f} N")
    head = [f"({stage['key']}) {stage['title']},", f"depth {stage['depth']:.3f} m"]
    return "\n".join([*head, *forces]), chain(shapes(scene, runs, [k]), lines)


def _histories(columns: Columns, events: Sequence[Row], quantity: str, paper: str) -> Iterator[Line]:
    """A quantity of all contacts against the depth, with the exact rods and the events, those at one depth together."""
    at: dict[str, list[str]] = {}
    for one in (one for one in events if one["depth"] > 0.0):
        at.setdefault(f"{one['depth']:.4f}", []).append(f"{one['kind']}, {NAMES[one['pair']]}")
    depth, values = columns["depth"], [columns[f"{pair} {quantity}"] for pair in NAMES]
    for (pair, name), own in zip(NAMES.items(), values, strict=True):
        yield Line(RODS, (depth, columns[f"{pair} exact_{quantity}"]), {"color": "0.7", "linewidth": 5.0})
        yield Line(name, (depth, own), {"color": COLOURS[pair]})
        yield Line(paper, (depth, columns[f"{pair} paper_{quantity}"]), {"color": "black", "linestyle": ":"})
    ends = np.nanmin(values), np.nanmax(values)
    for place, words in at.items():
        dotted = {"color": "0.4", "linestyle": ":"}
        yield Line(f"{place} m: {'; '.join(words)}", ((float(place), float(place)), ends), dotted)


def of_events(columns: Columns, events: Sequence[Row]) -> Row:
    """Return the depths of the expected events, nan of one that is missing, and what the coupled stage shows."""
    first = {(one["kind"], one["pair"]): one["depth"] for one in reversed(events)}
    depths = {name: first.get(one, np.nan) for name, one in EXPECTED.items()}
    coupled = (columns["depth"] > EVENTS["touch"]) & (columns["depth"] < EVENTS["hand-over"])
    over = [one for one in events if one["depth"] == depths["hand-over"] and one["pair"] in {TIP, LOWER}]
    return {
        "depths": depths,
        "closed": [bool(np.isfinite(columns[f"{pair} arc"][coupled]).all()) for pair in (UPPER, TIP)],
        "crowded": sorted({one["element"] + 1 for one in over}),
        "last_tip_force": float(np.nanmax(columns[f"{TIP} exact_force"])),
    }

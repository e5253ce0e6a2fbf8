"""Fig. 9: two cantilevers pressed by one pin, stage by stage, against the exact rods."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.cases.settings import changed
from comparisons.claims.paper.figure_study import Study, legend, shape_panels
from comparisons.claims.paper.formulations import CANTILEVER, SIMPLE, TIMOSHENKO
from comparisons.claims.problems.double_beam import EVENTS, HAND_OVER, LOWER, TIP, UPPER
from comparisons.models import ROD, TSM, solve
from comparisons.models.options import Options
from comparisons.output import Report, Row
from comparisons.response import Array, Response
from comparisons.scene import Scene, load_scene
from comparisons.show import palette
from comparisons.show.pages import Section, Track, motion_section
from comparisons.show.plot import WIDTH, figure, save

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
ROOM = 1.7
"""Height of the forces' diagram over the largest force; the list of the events stands above."""
ARROW = 0.16
"""Length of an arrow per force [m/N]."""
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
        for prefix, contact in (("", response.contacts[pair]), ("exact_", exact.contacts[pair])):
            closed = np.isfinite(contact.arc_position)
            columns[f"{pair} {prefix}force"] = np.where(closed, contact.force, np.nan)
            columns[f"{pair} {prefix}arc"] = contact.arc_position
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
    rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    stages = list(_stages(columns["depth"]))
    pictures = {"fig9": partial(plot_stages, finer, response, stages)} if stages else {}
    return Study(
        tables={"fig9": rows},
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
    """How far `tsm.solve` comes with a formulation and a place of the pin [m], the last depth [m], and the beam nodes passed.

    `at_hand_over`: what stops it is the second contact on an element that knows one, where the exact rods hand over, between the
    last depth with an answer and the next one.
    """
    moved = changed(scene, {("pin", "start"): (place, scene.pins[0].points[0][1])})
    response = solve(moved, TSM.name, Options(element=element))
    travel = abs(moved.pins[0].points[1][1])
    reached = float(max(response.load_parameter, default=0.0))
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


def plot_stages(scene: Scene, response: Response, stages: list[Row], *paths: Path) -> None:
    """Draw both beams, the pin and the contact forces at the six stages."""
    fig, grid = shape_panels(len(stages), 2.8)
    for axes, stage in zip(grid.flat, stages, strict=True):
        _draw_stage(axes, scene, response, stage["index"])
        words = f"({stage['key']}) {stage['title']},\ndepth {stage['depth']:.3f} m"
        axes.set_title(words, fontsize="small")
        axes.set(xlim=(-0.05, 1.08), ylim=(-0.8, 0.2))
    legend(fig, grid, 3)
    fig.suptitle(
        "Mixed elements, 10 + 10;\narrows are the forces on the touched beams, grey the beams at rest",
        fontsize="medium",
    )
    save(fig, *paths)


def _draw_stage(axes: Any, scene: Scene, response: Response, k: int) -> None:
    for beam in scene.beams:
        rest, color = np.array([beam.start, beam.end]), COLOURS[beam.name]
        line = rest if k < 0 else response.axis_line(beam.name, k)[1]
        nodes = np.linspace(0, len(line) - 1, beam.divisions + 1).round().astype(int)
        axes.plot(*rest.T, color="0.75", linewidth=0.8)
        axes.plot(*line.T, color=color, linewidth=1.8, label=f"{beam.name} beam")
        if k >= 0:
            axes.plot(*line[nodes].T, color=color, marker="o", markersize=3, linestyle="none")
    pin = np.array(scene.pins[0].position(0.0 if k < 0 else float(response.load_parameter[k])))
    for row, pair in enumerate(NAMES if k >= 0 else ()):
        point = response.tips["upper"][k] if pair == TIP else pin
        _draw_force(axes, response, pair, k, point, -0.62 - 0.07 * row)
    mark = {"marker": "o", "markersize": 6, "markerfacecolor": "white", "linestyle": "none", "zorder": 6}
    axes.plot(*pin, color="black", label="pin", **mark)


def _draw_force(axes: Any, response: Response, pair: str, k: int, point: Array, height: float) -> None:
    contact, color = response.contacts[pair], STYLES[pair]["color"]
    if not np.isfinite(contact.arc_position[k]) or contact.vector is None:
        return
    arrow = {"arrowstyle": "-|>", "color": color, "linewidth": 1.8, "shrinkA": 0.0, "shrinkB": 0.0}
    axes.annotate("", point, point - ARROW * contact.vector[k], arrowprops=arrow)
    axes.plot([], [], color=color, linewidth=1.8, label=f"force of {NAMES[pair]}")
    axes.annotate(f"{NAMES[pair]}: {contact.force[k]:.3f} N", (0.0, height), color=color, fontsize="small")


def plot_histories(scene: Scene, columns: Columns, events: list[Row], *paths: Path) -> None:
    """Draw forces and places of all contacts against the depth, with the exact rods and the events."""
    fig = figure(figsize=(WIDTH, 8.0))
    forces, places = fig.subplots(2, 1, sharex=True, height_ratios=(1.5, 1.0))
    depth = columns["depth"]
    for axes, quantity in ((forces, "force"), (places, "arc")):
        for pair, name in NAMES.items():
            exact = "exact rods" if pair == UPPER else "_"
            axes.plot(depth, columns[f"{pair} exact_{quantity}"], color="0.7", linewidth=5.0, label=exact)
            axes.plot(depth, columns[f"{pair} {quantity}"], **STYLES[pair], linewidth=1.6, label=name)
    _mark_events(events, forces, places)
    beam = scene.beams[0]
    for node in np.linspace(0.0, beam.length, beam.divisions + 1)[-4:]:
        places.axhline(node, color="0.8", linewidth=0.6, zorder=0)
    forces.set(ylabel="contact force [N]", ylim=(0.0, ROOM * forces.dataLim.y1))
    places.set(xlabel="depth of the pin [m]", ylabel="arc position [m]", xlim=(0.0, depth[-1]))
    forces.legend(loc="lower right", fontsize="small")
    forces.set_title("Double beam, 10 + 10 mixed elements", pad=20)
    save(fig, *paths)


def _mark_events(events: list[Row], forces: Any, places: Any) -> None:
    """Draw a numbered line per event, those at one depth together, and the list of the events."""
    groups: dict[float, list[str]] = {}
    for event in events:
        near = next((depth for depth in groups if abs(depth - event["depth"]) < 2e-3), event["depth"])
        if event["depth"] > 0.0:
            groups.setdefault(near, []).append(f"{event['kind']}, {NAMES[event['pair']]}")
    lines = []
    for number, (depth, texts) in enumerate(groups.items(), 1):
        for axes in (forces, places):
            axes.axvline(depth, color="0.4", linewidth=0.8, linestyle=":")
        forces.annotate(
            f"{number}", (depth, 1.0), (0, 4), xycoords=("data", "axes fraction"), textcoords="offset points",
            ha="center",
        )  # fmt: skip
        lines += [f"{number}   {depth:.4f} m   {texts[0]}", *(f"{'':20}{text}" for text in texts[1:])]
    forces.annotate(
        "\n".join(lines), (0.012, 0.975), xycoords="axes fraction", va="top", fontsize="small",
        bbox={"facecolor": "white", "edgecolor": "0.8"},
    )  # fmt: skip

"""The pictures of Fig. 9: the six stages, and forces and places of all contacts against the depth."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.claims.paper.figure_study import legend, shape_panels
from comparisons.claims.problems.double_beam import LOWER, TIP, UPPER
from comparisons.output import Row
from comparisons.response import Array, Response
from comparisons.scene import Scene
from comparisons.show import palette
from comparisons.show.plot import WIDTH, figure, save

BEAMS = {"upper": palette.BLUE, "lower": palette.SKY}
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
        rest, color = np.array([beam.start, beam.end]), BEAMS[beam.name]
        line = rest if k < 0 else response.axis_line(beam.name, k)[1]
        nodes = np.linspace(0, len(line) - 1, beam.elements + 1).round().astype(int)
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


def plot_histories(scene: Scene, columns: Mapping[str, Array], events: list[Row], *paths: Path) -> None:
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
    for node in np.linspace(0.0, beam.length, beam.elements + 1)[-4:]:
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

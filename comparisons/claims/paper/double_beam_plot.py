"""The pictures of Fig. 9: the six stages, and forces and places of all contacts against the depth."""

from pathlib import Path
from typing import Any

import numpy as np

from comparisons.claims.paper.double_beam import PAIRS, DoubleBeam, Stage
from comparisons.claims.problems.double_beam import LOWER, TIP, UPPER
from comparisons.response import Array
from comparisons.show import palette
from comparisons.show.plot import WIDTH, figure, save

BEAMS = {"upper": palette.BLUE, "lower": palette.SKY}
STYLES: dict[str, tuple[str, Any]] = {
    UPPER: (palette.VERMILION, "-"),
    TIP: (palette.PURPLE, (0, (6, 1))),
    LOWER: (palette.GREEN, (0, (2, 1))),
}
NAMES = {UPPER: "pin on upper", TIP: "upper's tip on lower", LOWER: "pin on lower"}
ROOM = 1.7
"""Height of the forces' diagram over the largest force; the list of the events stands above."""
ARROW = 0.16
"""Length of an arrow per force [m/N]."""


def plot_stages(found: DoubleBeam, *paths: Path) -> None:
    """Draw both beams, the pin and the contact forces at the six stages."""
    fig = figure(figsize=(WIDTH, 8.4))
    panels = fig.subplots(3, 2, sharex=True, sharey=True)
    for axes, stage in zip(panels.flat, found.stages, strict=True):
        _draw_stage(axes, found, stage)
        axes.set_title(f"({stage.key}) {stage.title},\ndepth {stage.depth:.3f} m", fontsize="small")
        axes.set_aspect("equal", adjustable="box")
        axes.grid(visible=True, linewidth=0.3)
        axes.set(xlim=(-0.05, 1.08), ylim=(-0.8, 0.2))
    for axes in panels[-1]:
        axes.set_xlabel("x [m]")
    for axes in panels[:, 0]:
        axes.set_ylabel("y [m]")
    handles = [handle for axes in panels.flat for handle in axes.get_legend_handles_labels()[0]]
    unique = {handle.get_label(): handle for handle in handles}
    fig.legend(
        unique.values(), unique.keys(), loc="outside lower center", ncols=3, fontsize="small", frameon=False
    )
    fig.suptitle(
        "Mixed elements, 10 + 10;\narrows are the forces on the touched beams, grey the beams at rest",
        fontsize="medium",
    )
    save(fig, *paths)


def _draw_stage(axes: Any, found: DoubleBeam, stage: Stage) -> None:
    scene, response, k = found.scene, found.response, stage.index
    for beam in scene.beams:
        rest = np.array([beam.start, beam.end])
        line = rest if k < 0 else response.axis_line(beam.name, k)[1]
        nodes = np.linspace(0, len(line) - 1, beam.elements + 1).round().astype(int)
        axes.plot(*rest.T, color="0.75", linewidth=0.8)
        axes.plot(*line.T, color=BEAMS[beam.name], linewidth=1.8, label=f"{beam.name} beam")
        if k >= 0:
            axes.plot(*line[nodes].T, color=BEAMS[beam.name], marker="o", markersize=3, linestyle="none")
    if k >= 0:
        for pair in PAIRS:
            _draw_force(axes, found, pair, k)
    place = np.array(scene.pins[0].position(0.0 if k < 0 else float(response.load_parameter[k])))
    axes.plot(
        *place, color="black", marker="o", markersize=6, markerfacecolor="white", linestyle="none",
        label="pin", zorder=6,
    )  # fmt: skip


def _draw_force(axes: Any, found: DoubleBeam, pair: str, k: int) -> None:
    contact = found.response.contacts[pair]
    if not np.isfinite(contact.arc_position[k]) or contact.vector is None:
        return
    point, color = _point(found, pair, k), STYLES[pair][0]
    arrow = {"arrowstyle": "-|>", "color": color, "linewidth": 1.8, "shrinkA": 0.0, "shrinkB": 0.0}
    axes.annotate("", point, point - ARROW * contact.vector[k], arrowprops=arrow)
    axes.plot([], [], color=color, linewidth=1.8, label=f"force of {NAMES[pair]}")
    place = (0.0, -0.76 + 0.07 * (len(PAIRS) - 1 - PAIRS.index(pair)))
    axes.annotate(f"{NAMES[pair]}: {contact.force[k]:.3f} N", place, color=color, fontsize="small")


def _point(found: DoubleBeam, pair: str, k: int) -> Array:
    """Contact point: the pin or the tip."""
    if pair == TIP:
        return np.asarray(found.response.tips["upper"][k])
    return np.array(found.scene.pins[0].position(float(found.response.load_parameter[k])))


def plot_histories(found: DoubleBeam, *paths: Path) -> None:
    """Draw forces and places of all contacts against the depth, with the exact rods and the events."""
    fig = figure(figsize=(WIDTH, 8.0))
    forces, places = fig.subplots(2, 1, sharex=True, height_ratios=(1.5, 1.0))
    for pair in PAIRS:
        color, dashes = STYLES[pair]
        history = found.histories[pair]
        for axes, beams, exact in (
            (forces, history.force, history.exact_force),
            (places, history.arc, history.exact_arc),
        ):
            axes.plot(found.depth, exact, color="0.7", linewidth=5.0, label="exact rods")
            axes.plot(found.depth, beams, color=color, linestyle=dashes, linewidth=1.6, label=NAMES[pair])
    _mark_events(found, forces, places)
    beam = found.scene.beams[0]
    for node in np.linspace(0.0, beam.length, beam.elements + 1)[-4:]:
        places.axhline(node, color="0.8", linewidth=0.6, zorder=0)
    forces.set(ylabel="contact force [N]", ylim=(0.0, ROOM * forces.dataLim.y1))
    places.set(xlabel="depth of the pin [m]", ylabel="arc position [m]", xlim=(0.0, found.depth[-1]))
    handles, labels = forces.get_legend_handles_labels()
    unique = dict(zip(labels, handles, strict=True))
    forces.legend(unique.values(), unique.keys(), loc="lower right", fontsize="small")
    forces.set_title("Double beam, 10 + 10 mixed elements", pad=20)
    save(fig, *paths)


def _mark_events(found: DoubleBeam, forces: Any, places: Any) -> None:
    """Draw a numbered line per event, those at one depth together, and the list of the events."""
    groups: dict[float, list[str]] = {}
    for event in found.events:
        near = next((depth for depth in groups if abs(depth - event.depth) < 2e-3), event.depth)
        if event.depth > 0.0:
            groups.setdefault(near, []).append(f"{event.kind}, {NAMES[event.pair]}")
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

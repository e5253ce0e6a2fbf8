"""The error budget as one figure of stacked bars, as a section of a page, and as a file of numbers."""

from math import ceil
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.output import write_numbers
from comparisons.report import palette
from comparisons.report.pages import Section, picture, piece, table
from comparisons.report.plot import WIDTH, figure, save
from comparisons.suite.budget import PARTS, STEPS, TIMES, Budget, budget_rows

COLOURS = (
    palette.ORANGE, palette.YELLOW, palette.SKY, palette.VERMILION, palette.GREEN, palette.PURPLE, palette.GREY,
)  # fmt: skip
HATCHES = ("", "////", "...", "", "xxx", "\\\\\\\\", "+++")
"""Colours and hatches of the parts, in their order; hatches distinguish neighbours in grey print."""
COLUMNS = 3
"""Panels beside each other."""


def plot_budget(budget: Budget, *paths: Path) -> None:
    """Draw every quantity's parts stacked at the load parameters of the budget, and the total as a mark."""
    rows = ceil(len(budget.total) / COLUMNS)
    fig = figure(figsize=(WIDTH, 2.6 * rows + 1.1))
    panels = fig.subplots(rows, COLUMNS, squeeze=False).ravel()
    for axes in panels[len(budget.total) :]:
        axes.set_axis_off()
    for axes, quantity in zip(panels, budget.total, strict=False):
        # the limits would lie on the edge of a thin part, and cut the parts beyond it
        axes.use_sticky_edges = False
        _stack(axes, budget, quantity)
        kind, _, column = quantity.partition(" ")
        axes.set_title(f"{kind.replace('_', ' ')}\n{column}".strip(), fontsize="medium")
        axes.set_xlabel("load parameter", fontsize="small")
        axes.tick_params(labelsize="small")
        axes.margins(y=0.08)
    fig.supylabel("(TSM - solid) / exact rod [%]", fontsize="medium")
    fig.suptitle(f"{budget.scene}: what the difference is made of")
    handles, words = fig.axes[0].get_legend_handles_labels()
    fig.legend(handles, words, loc="outside lower center", ncols=3, fontsize="small", frameon=False)
    save(fig, *paths)


def _stack(axes: Any, budget: Budget, quantity: str) -> None:
    places = np.arange(len(TIMES))
    above, below = np.zeros(len(TIMES)), np.zeros(len(TIMES))
    for (name, values), colour, hatch in zip(budget.parts[quantity].items(), COLOURS, HATCHES, strict=True):
        height = 100.0 * np.nan_to_num(values)
        bottom = np.where(height >= 0.0, above, below)
        style = {"color": colour, "hatch": hatch, "edgecolor": "0.25", "linewidth": 0.0, "width": 0.6}
        axes.bar(places, height, bottom=bottom, label=name, **style)
        above, below = above + np.maximum(height, 0.0), below + np.minimum(height, 0.0)
    total = 100.0 * budget.total[quantity]
    axes.hlines(total, places - 0.4, places + 0.4, colors="black", linewidth=1.8, label="difference")
    axes.axhline(0.0, color="0.3", linewidth=0.6)
    axes.set_xticks(places, [f"{t:g}" for t in TIMES])
    axes.grid(visible=True, axis="y", linewidth=0.3)
    axes.set_axisbelow(True)


def budget_section(budget: Budget, drawn: Path) -> Section:
    """Return the figure `drawn`, the numbers, and what each part measures."""
    rows = [
        {
            "quantity": row["quantity"].replace("_", " "),
            "load parameter": row["load_parameter"],
            "difference": row["total"],
            **row["parts"],
            "rest": row["rest_over_total"],
        }
        for row in budget_rows(budget)
    ]
    caption = "(TSM - solid) / exact rod; parts are measured by themselves, the rest is over the difference"
    numbers = table(caption, rows)
    shown = picture(drawn, "What the difference of TSM and solid is made of.")
    return Section("Error budget", f"{shown}\n{numbers}\n{piece('definitions', PARTS)}")


def write_budget(budget: Budget, path: Path) -> None:
    """Write the budget's numbers and what each part measures."""
    rests = [float(np.nanmax(np.abs(budget.rest(quantity)))) for quantity in budget.total]
    numbers = {
        "scene": budget.scene,
        "difference": "(q_TSM - q_solid) / q_rod",
        "load_parameters_of_the_runs": STEPS,
        "parts": PARTS,
        "rows": list(budget_rows(budget)),
        "largest_rest_over_total": max(rests),
    }
    write_numbers(path, numbers)

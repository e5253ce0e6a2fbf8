"""The error budget as one figure of stacked bars, and as a file of numbers."""

from math import ceil
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.budget import PARTS, STEPS, TIMES, Budget, budget_rows
from comparisons.output import write_numbers
from comparisons.show import palette
from comparisons.show.plot import figure, save

COLOURS = (
    palette.ORANGE, palette.YELLOW, palette.SKY, palette.VERMILION, palette.GREEN, palette.PURPLE, palette.GREY,
)  # fmt: skip
COLUMNS = 3
"""Panels beside each other."""
HATCHES = ("", "//", "..", "", "xx", "\\\\", "++")
"""Colours and hatches of the parts, in their order; hatches distinguish neighbours in grey print."""


def plot_budget(budget: Budget, *paths: Path) -> None:
    """Draw every quantity's parts stacked at the load parameters of the budget, and the total as a mark."""
    rows = ceil(len(budget.total) / COLUMNS)
    fig = figure(figsize=(11.0, 3.4 * rows + 1.2))
    panels = fig.subplots(rows, COLUMNS, squeeze=False).ravel()
    for axes in panels[len(budget.total) :]:
        axes.set_axis_off()
    for axes, quantity in zip(panels, budget.total, strict=False):
        _stack(axes, budget, quantity)
        axes.set(title=quantity.replace("_", " "), xlabel="load parameter")
        axes.margins(y=0.08)
    fig.axes[0].set_ylabel("(TSM - solid) / exact rod [%]")
    fig.suptitle(f"{budget.scene}: what the difference is made of")
    fig.legend(
        *fig.axes[0].get_legend_handles_labels(),
        loc="outside lower center",
        ncols=4,
        fontsize="small",
        markerscale=0.4,
    )
    save(fig, *paths)


def _stack(axes: Any, budget: Budget, quantity: str) -> None:
    places = np.arange(len(TIMES))
    above, below = np.zeros(len(TIMES)), np.zeros(len(TIMES))
    for (name, values), colour, hatch in zip(budget.parts[quantity].items(), COLOURS, HATCHES, strict=True):
        height = 100.0 * np.nan_to_num(values)
        bottom = np.where(height >= 0.0, above, below)
        axes.bar(
            places,
            height,
            bottom=bottom,
            width=0.6,
            color=colour,
            label=name,
            hatch=hatch,
            edgecolor="0.25",
            linewidth=0.0,
        )
        above, below = above + np.maximum(height, 0.0), below + np.minimum(height, 0.0)
    axes.plot(
        places, 100.0 * budget.total[quantity], "k_", markersize=34, markeredgewidth=1.6, label="difference"
    )
    axes.axhline(0.0, color="0.3", linewidth=0.6)
    axes.set_xticks(places, [f"{t:g}" for t in TIMES])
    axes.grid(visible=True, axis="y", linewidth=0.3)


def write_budget(budget: Budget, path: Path) -> None:
    """Write the budget's numbers and what each part measures."""
    numbers = {
        "scene": budget.scene,
        "difference": "(q_TSM - q_solid) / q_rod",
        "load_parameters_of_the_runs": STEPS,
        "parts": PARTS,
        "rows": list(budget_rows(budget)),
        "largest_rest_over_total": max(
            float(np.nanmax(np.abs(budget.rest(quantity)))) for quantity in budget.total
        ),
    }
    write_numbers(path, numbers)

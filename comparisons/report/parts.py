"""The error budget as a picture of stacked bars, a section of a page, and numbers."""

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.report import palette
from comparisons.report.pages import Section, picture, piece, table
from comparisons.report.plot import draw
from comparisons.suite.budget import PARTS, STEPS, TIMES, Budget, budget_rows

COLOURS = (
    palette.ORANGE, palette.YELLOW, palette.SKY, palette.VERMILION, palette.GREEN, palette.PURPLE, palette.GREY,
)  # fmt: skip
HATCHES = ("", "////", "||||", "", "xxx", "\\\\\\\\", "+++")
"""Colours and hatches of the parts of a budget, in their order; hatches distinguish neighbours in grey print."""


def plot_budget(budget: Budget, path: Path) -> None:
    """Draw every quantity's parts stacked at the load parameters of the budget, and the total as a mark."""
    panels = [partial(_stack, budget=budget, quantity=quantity) for quantity in budget.total]
    title = f"{budget.scene}: what the difference is made of, (TSM - solid) / exact rod [%]"
    draw(panels, path, tall=2.6, title=title, columns=3)


def _stack(axes: Any, *, budget: Budget, quantity: str) -> None:
    places = np.arange(len(TIMES))
    above, below = np.zeros(len(TIMES)), np.zeros(len(TIMES))
    for (name, values), colour, hatch in zip(budget.parts[quantity].items(), COLOURS, HATCHES, strict=True):
        height = 100.0 * np.nan_to_num(values)
        bottom = np.where(height >= 0.0, above, below)
        style = {"color": colour, "hatch": hatch, "edgecolor": "0.25", "linewidth": 0.0, "width": 0.6}
        axes.bar(places, height, bottom=bottom, label=name, zorder=3, **style)
        above, below = above + np.maximum(height, 0.0), below + np.minimum(height, 0.0)
    total = 100.0 * budget.total[quantity]
    mark = {"colors": "black", "linewidth": 1.8, "zorder": 4}
    axes.hlines(total, places - 0.4, places + 0.4, label="difference", **mark)
    axes.axhline(0.0, color="0.3", linewidth=0.6)
    axes.set_xticks(places, [f"{t:g}" for t in TIMES])
    # the limits would lie on the edge of a thin part, and cut the parts beyond it
    axes.use_sticky_edges = False
    axes.margins(y=0.08)
    kind, _, column = quantity.partition(" ")
    axes.set(title=f"{kind.replace('_', ' ')}\n{column}".strip(), xlabel="load parameter")


def budget_section(budget: Budget, drawn: Path) -> Section:
    """Return the figure `drawn`, the numbers, and what each part measures."""
    rows = [
        {name.replace("_", " "): value for name, value in {**row, **row["parts"]}.items() if name != "parts"}
        for row in budget_rows(budget)
    ]
    caption = "(TSM - solid) / exact rod; parts are measured by themselves, the rest is over the difference"
    numbers = table(caption, rows)
    shown = picture(drawn, "What the difference of TSM and solid is made of.")
    return Section("Error budget", f"{shown}\n{numbers}\n{piece('definitions', PARTS)}")


def budget_numbers(budget: Budget) -> dict[str, Any]:
    """Return the budget's numbers and what each part measures."""
    return {
        "scene": budget.scene,
        "difference": "(q_TSM - q_solid) / q_rod",
        "load_parameters_of_the_runs": STEPS,
        "parts": PARTS,
        "rows": list(budget_rows(budget)),
        "largest_rest_over_total": max(np.nanmax(np.abs(budget.rest(quantity))) for quantity in budget.total),
    }

"""The pictures of Fig. 7b: curves against displacement, the critical area against the tolerance, the floor."""

from pathlib import Path
from typing import Any

import numpy as np

from comparisons.claims.paper.approach import NEAREST
from comparisons.claims.paper.critical_area import (
    FITTED,
    PRINTED,
    PRINTED_SHEAR_PSI,
    PSI,
    RATIOS,
    SHOWN_TOLERANCE,
    CriticalAreas,
    Measured,
)
from comparisons.claims.paper.formulations import FORMULATIONS, Formulation
from comparisons.show import palette
from comparisons.show.plot import WIDTH, figure, save

COLUMNS = 2
"""Panels beside each other."""


def plot_curves(found: CriticalAreas, *paths: Path) -> None:
    """Draw l_i/l against the displacement of the pin, one panel per starting position."""
    tolerance = nearest_tolerance(found)
    shown = [one for one in found.measured if one.tolerance == tolerance]
    starts = sorted({one.start for one in shown})
    rows = -(-len(starts) // COLUMNS)
    fig = figure(figsize=(WIDTH, 1.3 + 2.3 * rows))
    panels = fig.subplots(rows, min(len(starts), COLUMNS), sharey=True, squeeze=False)
    for axes, start in zip(panels.flat, starts, strict=False):
        for formulation in FORMULATIONS:
            own = [one for one in shown if (one.start, one.element) == (start, formulation.element)]
            for number, one in enumerate(own):
                _draw_curve(axes, formulation, one, labelled=number == 0)
        axes.set_title(f"pin starts at {start:g} m", fontsize="medium")
        axes.set_xlabel("displacement of the pin [m]", fontsize="small")
        axes.set_yscale("log")
        axes.tick_params(labelsize="small")
        axes.set_ylim(NEAREST / 3.0, 3.0)
        axes.grid(visible=True, linewidth=0.3)
    for axes in panels.flat[len(starts) :]:
        axes.set_axis_off()
    fig.supylabel("$l_i/l$: distance to the next node", fontsize="medium")
    handles, labels = panels.flat[0].get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside lower center", ncols=2, fontsize="small", frameon=False)
    fig.suptitle(
        f"How near to a beam node equilibrium is found, tolerance {tolerance:.0e} EI/L$^2$;\n"
        "a large mark is the last equilibrium",
        fontsize="medium",
    )
    save(fig, *paths)


def nearest_tolerance(found: CriticalAreas) -> float:
    """Tolerance of the curves: the measured one nearest to the shown one."""
    return min(found.tolerances, key=lambda tolerance: abs(np.log(tolerance / SHOWN_TOLERANCE)))


def _draw_curve(axes: Any, formulation: Formulation, one: Measured, *, labelled: bool) -> None:
    if not len(one.ratio):
        return
    line = {**formulation.line, "marker": None}
    order = FORMULATIONS.index(formulation)
    axes.plot(one.displacement, one.ratio, **line, linewidth=3.2 - 0.7 * order)
    last = int(np.argmin(one.ratio))
    axes.plot(
        one.displacement[last],
        max(one.ratio[last], NEAREST),
        color=formulation.color,
        marker=formulation.marker,
        markersize=(13, 8, 8, 7)[order],
        markeredgecolor="black",
        markeredgewidth=0.5,
        linestyle=formulation.linestyle,
        label=formulation.label if labelled else "_",
        clip_on=False,
        zorder=4,
    )


def plot_tolerances(found: CriticalAreas, *paths: Path) -> None:
    """Draw the range of the critical area over nodes and starting positions against the tolerance."""
    fig = figure(figsize=(WIDTH, 5.2))
    axes = fig.subplots()
    tolerances = np.array(found.tolerances)
    for formulation in FORMULATIONS:
        element = formulation.element
        areas = [np.maximum(found.areas(element, tolerance), NEAREST) for tolerance in found.tolerances]
        low, high = [part.min() for part in areas], [part.max() for part in areas]
        axes.fill_between(tolerances, low, high, color=formulation.color, alpha=0.2, linewidth=0)
        axes.plot(
            tolerances, [np.median(part) for part in areas], **formulation.line, label=formulation.label
        )
        if element in PRINTED:
            _draw_printed(axes, formulation)
    axes.set(
        xscale="log",
        yscale="log",
        ylim=(NEAREST / 3.0, 2.0),
        xlim=(tolerances[0] * 2.5, tolerances[-1] / 100.0),
        xlabel="tolerance on the unbalanced force [EI/L$^2$]",
        ylabel="smallest $l_i/l$ with equilibrium",
        title="Critical area against tolerance:\nmedian and range over nodes and starting positions",
    )
    axes.annotate(
        f"search ends at {NEAREST:.0e}",
        (tolerances[0], NEAREST),
        (4, 4),
        textcoords="offset points",
        fontsize="small",
    )
    axes.grid(visible=True, linewidth=0.3)
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.06), fontsize="small")
    save(fig, *paths)


def _draw_printed(axes: Any, formulation: Formulation) -> None:
    """Mark the paper's range at the right-hand edge."""
    low, high = PRINTED[formulation.element]
    axes.axhspan(low, high, xmin=0.7, color=formulation.color, alpha=0.45, linewidth=0)
    axes.annotate(
        f"paper: {100.0 * low:.3f} - {100.0 * high:.3f} %",
        (1.0, np.sqrt(low * high)),
        (-4, 0),
        xycoords=("axes fraction", "data"),
        textcoords="offset points",
        ha="right",
        va="center",
        fontsize="small",
    )


def plot_floors(found: CriticalAreas, *paths: Path) -> None:
    """Draw the floor of the unbalanced force against l_i/l with the fitted slopes."""
    fig = figure(figsize=(WIDTH, 5.4))
    axes = fig.subplots()
    for formulation in FORMULATIONS:
        slopes = found.slopes(formulation.element)
        label = f"{formulation.label}: slope {round(float(np.mean(slopes)), 2) + 0.0:.2f}"
        for one in found.floors:
            if (one.element, one.psi, one.end) == (formulation.element, PSI, "end"):
                simple = formulation.marker == "o"
                size = {"markersize": 9.0, "markerfacecolor": "none"} if simple else {"markersize": 5.0}
                axes.plot(RATIOS, one.floor, **formulation.line, **size, linewidth=1.0, label=label)
    for one in found.floors:
        if one.psi == PRINTED_SHEAR_PSI:
            axes.plot(
                RATIOS, one.floor, color=palette.BLUE, marker="v", markersize=5.0, linestyle="-.", linewidth=1.0,
                label="Timoshenko, printed G of section 4.2",
            )  # fmt: skip
    for edge in FITTED:
        axes.axvline(edge, color="0.6", linewidth=0.8, linestyle=":")
    axes.annotate("slopes fitted between the dotted lines", (np.sqrt(FITTED[0] * FITTED[1]), 0.01),
                  xycoords=("data", "axes fraction"), ha="center", color="0.4")  # fmt: skip
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="$l_i/l$",
        ylabel="unbalanced force / contact force",
        title="What round-off leaves of the unbalanced force, section of 4.1",
    )
    axes.grid(visible=True, linewidth=0.3)
    axes.legend(loc="upper right", fontsize="small")
    save(fig, *paths)

"""Fig. 7b: how near to a beam node each element formulation finds equilibrium, and why not nearer.

Two measurements: the smallest l_i/l with equilibrium before every beam node, by starting position and tolerance, and the
floor of the unbalanced force against l_i/l, which no tolerance can pass.
"""

from collections.abc import Iterator, Mapping
from functools import partial
from itertools import groupby
from pathlib import Path
from typing import Any, Literal

import numpy as np

from comparisons.cases.settings import changed
from comparisons.claims.paper import turned_frame
from comparisons.claims.paper.approach import NEAREST, approaches
from comparisons.claims.paper.figure_study import Study, column, legend, panels
from comparisons.claims.paper.force_floor import force_floor
from comparisons.claims.paper.formulations import CANTILEVER, LABELS, SIMPLE, TIMOSHENKO, line
from comparisons.models.tsm import to_structure
from comparisons.output import Report, Row
from comparisons.scene import Scene, load_scene
from comparisons.show.plot import WIDTH, figure, save

STARTS = (4.05, 4.1, 4.2, 4.3, 4.35, 4.4)
"""The paper's starting positions of the pin [m]."""
PRINTED = {SIMPLE: (0.07749, 0.12952), CANTILEVER: (0.02164, 0.03865), TIMOSHENKO: (0.00067, 0.00501)}
"""The ranges of the critical area in [P] section 4.1."""
PSI = 9.0
"""EI/(G A_e l0^2) in section 4.1."""
PRINTED_SHEAR_PSI = 4.5e-9
"""The same in section 4.2 with its printed shear modulus and 20 elements."""
TOLERANCES = (1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
SHOWN_TOLERANCE = 1e-10
"""Tolerance of the curves against displacement, or the measured one nearest to it."""
RATIOS = 10.0 ** -np.arange(1.0, 16.5, 0.5)
FITTED = (1e-13, 1e-2)
"""Ratios of the fitted slopes: below, a ratio has no digits left; above, it is no small one."""
BESIDE = {"textcoords": "offset points", "fontsize": "small"}
"""Words at a distance from their place."""

_ENDS: tuple[Literal["start", "end"], ...] = ("start", "end")
_FLOOR_CASES = (
    *((element, end, PSI) for element in (*LABELS, turned_frame.NAME) for end in _ENDS),
    (TIMOSHENKO, _ENDS[1], PRINTED_SHEAR_PSI),
)


def lifted(start: float) -> Scene:
    """Return the scene of section 4.1 with a starting position of the pin [m]."""
    return changed(load_scene("cantilever-critical-area"), {("pin", "start"): (start, 0.0)})


def critical_areas(*, quick: bool, report: Report) -> Study:
    """Measure both; `quick` takes fewer starting positions, tolerances and samples."""
    tolerances = TOLERANCES[::3] if quick else TOLERANCES
    shown = _shown(tolerances)
    areas: list[Row] = []
    curves: list[Row] = []
    for tolerance in tolerances:
        report(f"approach to the nodes at tolerance {tolerance:.0e}")
        for element in LABELS:
            for start in STARTS[::4] if quick else STARTS:
                for area, curve in _ways(element, tolerance, start):
                    areas.append(area)
                    curves += curve if tolerance == shown else []
    report("floor of the unbalanced force")
    floors = list(_floors(samples=8 if quick else 50))
    numbers = measured(areas, floors)
    return Study(
        tables={"fig7b": curves, "fig7b-tolerance": areas, "fig7b-floor": floors},
        numbers=numbers,
        pictures={
            "fig7b": partial(plot_curves, shown, curves),
            "fig7b-tolerance": partial(plot_tolerances, numbers["critical_area"]),
            "fig7b-floor": partial(plot_floors, floors, numbers["slopes_of_the_floor"]),
        },
    )


def _shown(tolerances: tuple[float, ...]) -> float:
    return min(tolerances, key=lambda tolerance: abs(np.log(tolerance / SHOWN_TOLERANCE)))


def _ways(element: str, tolerance: float, start: float) -> Iterator[tuple[Row, list[Row]]]:
    """Yield the critical area before every node, and the equilibria on the way to it: l_i/l against the pin's displacement [m]."""
    scene = lifted(start)
    travel = abs(scene.pins[0].points[1][1])
    for way in approaches(to_structure(scene, element=element), tolerance):
        place = {"element": element, "start": start, "node": way.node}
        area = {"element": element, "tolerance": tolerance, **place, "smallest": way.smallest}
        curve = zip(way.load_parameter * travel, way.ratio, strict=True)
        yield area, [{**place, "displacement": d, "ratio": ratio} for d, ratio in curve]


def _floors(samples: int) -> Iterator[Row]:
    """Yield the floor of the unbalanced force, relative to the contact force, at one end of the element over `RATIOS`."""
    for element, end, psi in _FLOOR_CASES:
        for ratio in RATIOS:
            floor = force_floor(element, ratio, end=end, Psi=psi, samples=samples)
            yield {"element": element, "end": end, "psi": psi, "ratio": ratio, "floor": floor}


def measured(areas: list[Row], floors: list[Row]) -> dict[str, Any]:
    """Return the numbers of the figure from its rows.

    Smallest, median and largest critical area of each formulation over nodes and starting positions, by tolerance, where an element
    without equilibrium counts as 1; the tolerances at which the median is in the middle of the printed ranges; the slopes of the
    floors in section 4.1, before both ends of the element.
    """
    tolerances = tuple(dict.fromkeys(row["tolerance"] for row in areas))
    critical = {
        element: {f"{tolerance:.0e}": _spread(areas, element, tolerance) for tolerance in tolerances}
        for element in LABELS
    }
    return {
        "tolerance_of_the_curves": _shown(tolerances),
        "wanted_tolerance_of_the_curves": SHOWN_TOLERANCE,
        "critical_area": critical,
        "printed": PRINTED,
        "tolerance_for_the_printed": {
            element: _tolerance_for(critical[element], float(np.sqrt(low * high)))
            for element, (low, high) in PRINTED.items()
        },
        "slopes_of_the_floor": _slopes(floors),
    }


def _spread(areas: list[Row], element: str, tolerance: float) -> dict[str, float]:
    own = [row["smallest"] for row in areas if (row["element"], row["tolerance"]) == (element, tolerance)]
    found = np.nan_to_num(own, nan=1.0)
    return {"smallest": found.min(), "median": float(np.median(found)), "largest": found.max()}


def _tolerance_for(areas: Mapping[str, Mapping[str, float]], area: float) -> float:
    """Tolerance at which the median is `area`, interpolated in logarithms; nan outside what was measured."""
    medians = np.log([max(one["median"], 1e-300) for one in areas.values()])
    if not medians.min() <= np.log(area) <= medians.max():
        return np.nan
    order = np.argsort(medians)
    tolerances = np.log([float(tolerance) for tolerance in areas])
    return float(np.exp(np.interp(np.log(area), medians[order], tolerances[order])))


def _slopes(floors: list[Row]) -> dict[str, list[float]]:
    """Slopes of the straight lines fitted to the logarithms of the floors in section 4.1, one per end of the element."""
    low, high = FITTED
    slopes: dict[str, list[float]] = {}
    for case in (case for case in _FLOOR_CASES if PSI in case):
        own = [row for row in floors if (row["element"], row["end"], row["psi"]) == case]
        own = [row for row in own if low * (1.0 - 1e-9) < row["ratio"] < high * (1.0 + 1e-9)]
        slope = np.polyfit(np.log(column(own, "ratio")), np.log(column(own, "floor")), 1)[0]
        slopes.setdefault(case[0], []).append(float(slope))
    return slopes


def plot_curves(tolerance: float, curves: list[Row], *paths: Path) -> None:
    """Draw l_i/l against the displacement of the pin, one panel per starting position."""
    starts = sorted({row["start"] for row in curves})
    fig, grid = panels(len(starts), 2.3, 1.3)
    for (element, start, _), way in groupby(
        curves, key=lambda row: (row["element"], row["start"], row["node"])
    ):
        _draw_curve(grid.flat[starts.index(start)], element, list(way))
    for axes, start in zip(grid.flat, starts, strict=False):
        axes.set_title(f"pin starts at {start:g} m", fontsize="medium")
        axes.set_xlabel("displacement of the pin [m]", fontsize="small")
        axes.set(yscale="log", ylim=(NEAREST / 3.0, 3.0))
        axes.tick_params(labelsize="small")
    fig.supylabel("$l_i/l$: distance to the next node", fontsize="medium")
    legend(fig, grid, 2)
    fig.suptitle(
        f"How near to a beam node equilibrium is found, tolerance {tolerance:.0e} EI/L$^2$;\n"
        "a large mark is the last equilibrium",
        fontsize="medium",
    )
    save(fig, *paths)


def _draw_curve(axes: Any, element: str, way: list[Row]) -> None:
    displacement, ratio = column(way, "displacement"), column(way, "ratio")
    order, last = list(LABELS).index(element), int(np.argmin(ratio))
    axes.plot(displacement, ratio, **{**line(element), "marker": None}, linewidth=3.2 - 0.7 * order)
    mark = {"markersize": (13, 8, 8, 7)[order], "markeredgecolor": "black", "markeredgewidth": 0.5}
    place = displacement[last], max(ratio[last], NEAREST)
    axes.plot(*place, **line(element), **mark, label=LABELS[element], clip_on=False, zorder=4)


def plot_tolerances(areas: Mapping[str, Mapping[str, Mapping[str, float]]], *paths: Path) -> None:
    """Draw the range of the critical area over nodes and starting positions against the tolerance."""
    fig = figure(figsize=(WIDTH, 5.2))
    axes = fig.subplots()
    tolerances = [float(tolerance) for tolerance in next(iter(areas.values()))]
    for element, label in LABELS.items():
        low, middle, high = (
            [max(one[name], NEAREST) for one in areas[element].values()]
            for name in ("smallest", "median", "largest")
        )
        axes.fill_between(tolerances, low, high, color=line(element)["color"], alpha=0.2, linewidth=0)
        axes.plot(tolerances, middle, **line(element), label=label)
        if element in PRINTED:
            _draw_printed(axes, element)
    axes.set(
        xscale="log",
        yscale="log",
        ylim=(NEAREST / 3.0, 2.0),
        xlim=(tolerances[0] * 2.5, tolerances[-1] / 100.0),
        xlabel="tolerance on the unbalanced force [EI/L$^2$]",
        ylabel="smallest $l_i/l$ with equilibrium",
        title="Critical area against tolerance:\nmedian and range over nodes and starting positions",
    )
    axes.annotate(f"search ends at {NEAREST:.0e}", (tolerances[0], NEAREST), (4, 4), **BESIDE)
    axes.grid(visible=True, linewidth=0.3)
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.06), fontsize="small")
    save(fig, *paths)


def _draw_printed(axes: Any, element: str) -> None:
    """Mark the paper's range at the right-hand edge."""
    low, high = PRINTED[element]
    axes.axhspan(low, high, xmin=0.7, color=line(element)["color"], alpha=0.45, linewidth=0)
    words, place = f"paper: {100.0 * low:.3f} - {100.0 * high:.3f} %", (1.0, np.sqrt(low * high))
    axes.annotate(
        words, place, (-4, 0), xycoords=("axes fraction", "data"), ha="right", va="center", **BESIDE
    )


def plot_floors(floors: list[Row], slopes: Mapping[str, list[float]], *paths: Path) -> None:
    """Draw the floor of the unbalanced force against l_i/l with the fitted slopes."""
    fig = figure(figsize=(WIDTH, 5.4))
    axes = fig.subplots()
    shown = {
        (element, PSI): f"{label}: slope {round(float(np.mean(slopes[element])), 2) + 0.0:.2f}"
        for element, label in LABELS.items()
    }
    shown[TIMOSHENKO, PRINTED_SHEAR_PSI] = "Timoshenko, printed G of section 4.2"
    for case, label in shown.items():
        own = [row for row in floors if (row["element"], row["psi"]) == case and row["end"] == "end"]
        style = {**line(case[0]), "markersize": 5.0}
        style |= {"markersize": 9.0, "markerfacecolor": "none"} if case[0] == SIMPLE else {}
        style |= {"marker": "v", "linestyle": "-."} if case[1] == PRINTED_SHEAR_PSI else {}
        axes.plot(column(own, "ratio"), column(own, "floor"), **style, linewidth=1.0, label=label)
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

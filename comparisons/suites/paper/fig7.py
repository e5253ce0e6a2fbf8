"""Fig. 7: the cantilever of section 4.1, lifted by a pin, and how near to a node equilibrium is found."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from itertools import pairwise, product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.answer import Response
from comparisons.models import ROD, TSM, solve
from comparisons.models.options import Options
from comparisons.models.tsm import to_structure
from comparisons.output import Report, Row
from comparisons.report import palette
from comparisons.scene import Scene, load_scene
from comparisons.suite.settings import changed
from comparisons.suites.drawing import NOTE, SHAPE, draw
from comparisons.suites.paper.approach import NEAREST, approaches
from comparisons.suites.paper.figure import (
    CANTILEVER,
    LABELS,
    MIXED,
    SIMPLE,
    TIMOSHENKO,
    Facts,
    Study,
    column,
    line,
    percent,
    reached,
    stops,
)
from comparisons.suites.paper.force_floor import TURNED, force_floor

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

MOVES = 0.5
"""A median critical area beyond half the element means that the tolerance is below the round-off everywhere in it."""
_FLOORS: tuple[dict[str, Any], ...] = (
    *({"element": one, "end": end, "psi": PSI} for one in (*LABELS, TURNED) for end in ("start", "end")),
    {"element": TIMOSHENKO, "end": "end", "psi": PRINTED_SHEAR_PSI},
)
"""Where the floor of the unbalanced force is measured."""


def lifted(start: float) -> Scene:
    """Return the scene of section 4.1 with a starting position of the pin [m]."""
    return changed(load_scene("cantilever-critical-area"), {("pin", "start"): (start, 0.0)})


def critical_areas(*, quick: bool, report: Report) -> Study:
    """Measure both; `quick` takes fewer starting positions, tolerances and samples."""
    tolerances = TOLERANCES[::3] if quick else TOLERANCES
    shown, areas, curves = _shown(tolerances), list[Row](), list[Row]()
    for tolerance in tolerances:
        report(f"approach to the nodes at tolerance {tolerance:.0e}")
        for element, start in product(LABELS, STARTS[::4] if quick else STARTS):
            scene = lifted(start)
            travel = abs(scene.pins[0].points[1][1])
            for way in approaches(to_structure(scene, element=element), tolerance):
                place = {"element": element, "start": start, "node": way.node}
                areas.append({"element": element, "tolerance": tolerance, **place, "smallest": way.smallest})
                curve = zip(way.load_parameter * travel, way.ratio, strict=True) if tolerance == shown else ()
                curves += ({**place, "displacement": d, "ratio": ratio} for d, ratio in curve)
    report("floor of the unbalanced force")
    floors, samples = list[Row](), 8 if quick else 50
    for of, ratio in product(_FLOORS, RATIOS):
        floor = force_floor(of["element"], ratio, of["end"], of["psi"], samples=samples)
        floors.append({**of, "ratio": ratio, "floor": floor})
    numbers = measured(areas, floors)
    drawn = partial(_drawn_floors, floors, numbers["slopes_of_the_floor"])
    panels = [partial(_curves, curves, start) for start in sorted({row["start"] for row in curves})]
    title = f"How near to a beam node equilibrium is found, tolerance {shown:.0e} EI/L$^2$;\na large mark is the last equilibrium"
    return Study(
        tables={"fig7b": curves, "fig7b-tolerance": areas, "fig7b-floor": floors},
        numbers=numbers,
        pictures={
            "fig7b": partial(draw, panels, tall=2.3, title=title),
            "fig7b-tolerance": partial(draw, [partial(_areas, numbers["critical_area"])], tall=4.5),
            "fig7b-floor": partial(draw, [drawn], tall=4.5),
        },
    )


def _shown(tolerances: tuple[float, ...]) -> float:
    return min(tolerances, key=lambda tolerance: abs(np.log(tolerance / SHOWN_TOLERANCE)))


def measured(areas: list[Row], floors: list[Row]) -> dict[str, Any]:
    """Return the numbers of the figure from its rows; an area of 1 stands for no equilibrium."""
    tolerances = tuple(dict.fromkeys(row["tolerance"] for row in areas))
    critical: dict[str, dict[str, dict[str, float]]] = {element: {} for element in LABELS}
    for element, at in product(LABELS, tolerances):
        found = np.nan_to_num(column(areas, "smallest", element=element, tolerance=at), nan=1.0)
        spread = {"smallest": found.min(), "median": float(np.median(found)), "largest": found.max()}
        critical[element][f"{at:.0e}"] = spread
    takes = {}
    for element, printed in PRINTED.items():
        # where the median is in the middle, interpolated in logarithms; nan outside what was measured
        medians = np.log([max(one["median"], 1e-300) for one in critical[element].values()])
        rising, middle = np.argsort(medians), np.log(np.sqrt(np.prod(printed)))
        at = np.interp(middle, medians[rising], np.log(tolerances)[rising], left=np.nan, right=np.nan)
        takes[element] = float(np.exp(at))
    (low, high), slopes = FITTED, dict[str, list[float]]()
    for of in (of for of in _FLOORS if of["psi"] == PSI):
        ratio, floor = (column(floors, name, **of) for name in ("ratio", "floor"))
        fitted = (low * (1.0 - 1e-9) < ratio) & (ratio < high * (1.0 + 1e-9))
        slope = np.polyfit(np.log(ratio[fitted]), np.log(floor[fitted]), 1)[0]
        slopes.setdefault(of["element"], []).append(float(slope))
    return {
        "tolerance_of_the_curves": _shown(tolerances),
        "critical_area": critical,
        "printed": PRINTED,
        "tolerance_for_the_printed": takes,
        "slopes_of_the_floor": slopes,
    }


def _curves(curves: list[Row], start: float, axes: Any) -> None:
    """l_i/l against the displacement of the pin, from one starting position."""
    ways = dict.fromkeys((row["element"], row["node"]) for row in curves if row["start"] == start)
    for element, node in ways:
        of = {"element": element, "start": start, "node": node}
        displacement, ratio = (column(curves, name, **of) for name in ("displacement", "ratio"))
        last, order = int(np.argmin(ratio)), list(LABELS).index(element)
        mark = {
            "markersize": (13, 8, 8, 7)[order],
            "markeredgecolor": "black",
            "linestyle": "none",
            "zorder": 4,
        }
        axes.plot(displacement, ratio, **{**line(element), "marker": None, "linewidth": 3.2 - 0.7 * order})
        end = displacement[last], max(ratio[last], NEAREST)
        axes.plot(*end, label=LABELS[element], **{**line(element), **mark})
    axes.set(xlabel="displacement of the pin [m]", ylabel="$l_i/l$", title=f"pin starts at {start:g} m")
    axes.set(yscale="log", ylim=(NEAREST / 3.0, 3.0))


def _areas(areas: Mapping[str, Mapping[str, Mapping[str, float]]], axes: Any) -> None:
    """The range of the critical area over nodes and starting positions against the tolerance, and the paper's."""
    tolerances = [float(tolerance) for tolerance in next(iter(areas.values()))]
    beside = tolerances[-1] / 10.0, tolerances[-1] / 100.0
    for element, label in LABELS.items():
        faint = {"color": line(element)["color"], "linewidth": 0.8}
        styles = {"smallest": faint, "largest": faint, "median": {**line(element), "label": label}}
        for name, style in styles.items():
            axes.plot(tolerances, [max(one[name], NEAREST) for one in areas[element].values()], **style)
        for edge in PRINTED.get(element, ()):
            axes.plot(beside, [edge, edge], label="printed in the paper", **{**faint, "linewidth": 3.0})
    axes.annotate(f"search ends at {NEAREST:.0e}", (tolerances[0], 1.4 * NEAREST), **NOTE)
    title = "Critical area against tolerance:\nmedian and range over nodes and starting positions"
    axes.set(xscale="log", yscale="log", ylim=(NEAREST / 3.0, 2.0), xlim=(tolerances[0] * 2.5, beside[1]))
    axes.set(xlabel="tolerance on the unbalanced force [EI/L$^2$]", title=title)
    axes.set(ylabel="smallest $l_i/l$ with equilibrium")


def _drawn_floors(floors: list[Row], slopes: Mapping[str, list[float]], axes: Any) -> None:
    """The floor of the unbalanced force against l_i/l with the fitted slopes."""
    stiff = {"marker": "v", "linestyle": "-.", "label": f"{LABELS[TIMOSHENKO]}, printed G of section 4.2"}
    for of in (of for of in _FLOORS if of["end"] == "end" and of["element"] in LABELS):
        element = of["element"]
        slope = f"slope {round(float(np.mean(slopes[element])), 2) + 0.0:.2f}"
        plain = {"markersize": 8 if element == SIMPLE else 5, "label": f"{LABELS[element]}: {slope}"}
        style = {**line(element), **(plain if of["psi"] == PSI else stiff)}
        axes.plot(column(floors, "ratio", **of), column(floors, "floor", **of), **style)
    for edge in FITTED:
        axes.plot([edge, edge], [1e-16, 1.0], color="0.6", linestyle=":", label="fitted between")
    title = "What round-off leaves of the unbalanced force, section of 4.1"
    axes.set(
        xscale="log", yscale="log", xlabel="$l_i/l$", ylabel="unbalanced force / contact force", title=title
    )


ELEMENTS = (18, 72)
"""The paper's number of elements, and four times as many."""
FOLLOWED = 5e-4
"""Relative error of a slip-off displacement that counts as followed."""
DEPTHS = (0.25, 0.5, 0.75, 1.0)
"""Shapes shown, in parts of the displacement at slip-off: the last load parameter before."""


def cantilever_shapes(*, quick: bool, report: Report) -> Study:
    """Solve the six; `quick` takes two of them with a quarter of the load parameters and without Euler-Bernoulli."""
    lifts, histories, panels = list[Row](), list[Row](), list[Callable[[Any], None]]()
    scenes, runs = list[Scene](), dict[str, Response]()
    for start in STARTS[::4] if quick else STARTS:
        place, scene = f"pin at {start:g} m", lifted(start)
        report(place)
        if quick:
            scene = replace(scene, load_parameters=scene.load_parameters // 4)
        scenes.append(scene)
        pair, (_, (_, travel)) = scene.contacts[0].pair, scene.pins[0].points
        found = {elements: solve(scene, TSM.name, Options(elements=elements)) for elements in ELEMENTS}
        beams, rod = found[ELEMENTS[0]], solve(scene, ROD.name)
        runs |= {f"{place}, {one.model}": one for one in (beams, rod)}
        history = _history(travel, beams, rod, pair)
        histories += [{"start": start, **row} for row in history]
        force, exact_force = column(history, "force"), column(history, "rod_force")
        slip_off = {elements: travel * run.contacts[pair].slip_off for elements, run in found.items()}
        exact = travel * rod.contacts[pair].slip_off
        tried = {
            one: solve(scene, TSM.name, Options(element=one))
            for one in ((TIMOSHENKO, MIXED) if quick else LABELS)
        }
        lifts.append(
            {
                "start": start,
                "slip_off_rod": exact,
                "slip_off": slip_off,
                "slip_off_error": {n: abs(value / exact - 1.0) for n, value in slip_off.items()},
                "force_error": float(np.abs(force - exact_force).max() / exact_force.max()),
                # up to the slip-off, or the end of the run before it
                "reached_in_contact": {
                    element: travel * float(np.nan_to_num(run.contacts[pair].slip_off, nan=reached(run)))
                    for element, run in tried.items()
                },
            }
        )
        words = f"{place}: slips off at {slip_off[ELEMENTS[0]]:.4f} m"
        panels.append(partial(_panel, words, scene, beams, rod))
    return Study(
        tables={"fig7a": histories},
        numbers={"starting_positions": lifts, "stopped": stops(runs)},
        pictures={"fig7a": partial(draw, panels, tall=1.5)},
        scenes=tuple(scenes),
    )


def _history(travel: float, beams: Response, rod: Response, pair: str) -> list[Row]:
    """Forces [N] and arc positions [m] against the displacement of the pin [m], where both are in contact."""
    own, exact = beams.contacts[pair], rod.contacts[pair]
    columns = (travel * beams.load_parameter, own.force, exact.force, own.arc_position, exact.arc_position)
    names = ("displacement", "force", "rod_force", "arc", "rod_arc")
    rows = zip(*columns, strict=False)
    return [dict(zip(names, row, strict=True)) for row in rows if np.isfinite(row).all()]


def _panel(title: str, scene: Scene, beams: Response, rod: Response, axes: Any) -> None:
    """The deformed beam over the exact rod, at some displacements of the pin."""
    beam, contact = scene.beams[0], beams.contacts[scene.contacts[0].pair]
    last = int(np.flatnonzero(np.isfinite(contact.arc_position))[-1])
    own = {**line(MIXED), "marker": ".", "linestyle": "-", "label": f"TSM mixed, {ELEMENTS[0]} elements"}
    mark = {"color": palette.PIN, "marker": "^", "linestyle": "none", "label": "pin, its displacement [m]"}
    axes.plot(*np.array([beam.start, beam.end]).T, color="0.6", linewidth=0.8)
    for k in (round(part * last) for part in DEPTHS):
        axis, exact = (one.axis_line(beam.name, k)[1] for one in (beams, rod))
        x, y = scene.pins[0].position(float(beams.load_parameter[k]))
        axes.plot(*exact.T, color=palette.BLACK, linewidth=4.0, alpha=0.25, label="exact rod")
        axes.plot(*axis.T, markevery=(len(axis) - 1) // ELEMENTS[0], **own)
        axes.plot(x, y, **mark)
        axes.annotate(f"{y:.2f}", (4.85, float(axis[-1, 1])), **NOTE)
    axes.set(title=title, xlim=(-0.1, 5.6), ylim=(-0.1, 1.95), **SHAPE)


def of_lifts(found: Study) -> Facts:
    """Displacements at slip-off against the exact rod."""
    lifts = found.numbers["starting_positions"]
    ends = [(lift["reached_in_contact"][TIMOSHENKO], lift["slip_off_rod"]) for lift in lifts]
    paper = sum(bool(np.isclose(own, exact, rtol=FOLLOWED)) for own, exact in ends)
    early = " Its own element stops before the tip, in the last node's critical area."
    return {
        "slip_off": [max(lift["slip_off_error"][elements] for lift in lifts) for elements in ELEMENTS],
        "elements": ELEMENTS,
        "force": max(lift["force_error"] for lift in lifts),
        "paper": (paper, len(lifts)),
        "stops": "" if paper == len(lifts) else early,
    }


def of_critical_areas(found: Study) -> Facts:
    """Critical areas by formulation and tolerance, and slopes of the floors before both ends."""
    numbers, rows = found.numbers, found.tables["fig7b-tolerance"]
    areas, takes, slopes = (
        numbers[name] for name in ("critical_area", "tolerance_for_the_printed", "slopes_of_the_floor")
    )
    tolerances = list(areas[SIMPLE])
    smallest, median, largest = (
        {name: np.array([one[part] for one in by.values()]) for name, by in areas.items()}
        for part in ("smallest", "median", "largest")
    )
    # by tolerance and way, from a start to a node, which may have a way from the same start before it
    ways = {name: column(rows, "smallest", element=name).reshape(len(tolerances), -1) for name in LABELS}
    starts = column(rows, "start", element=SIMPLE, tolerance=rows[0]["tolerance"])
    passed = {
        name: _part(np.isfinite(one[:, 1:][:, starts[1:] == starts[:-1]])) for name, one in ways.items()
    }
    # at the tolerances at which the Euler-Bernoulli contact still moves
    usable = median[SIMPLE] < MOVES
    smaller, gain = {}, {}
    for above, below in pairwise(PRINTED):
        both = usable[:, None] & np.isfinite(ways[above] + ways[below])
        smaller[above] = _part((ways[above] > ways[below])[both])
        factors = median[above][usable] / np.maximum(median[below][usable], NEAREST)
        printed = float(np.sqrt(np.prod(PRINTED[above]) / np.prod(PRINTED[below])))
        gain[above] = factors.min(), factors.max(), printed, factors.min() / printed, factors.max() / printed
    low, high = PRINTED[TIMOSHENKO]
    under = [at for at, area in zip(tolerances, largest[TIMOSHENKO], strict=True) if area <= low]
    shown = tolerances[0], tolerances[-1], f"{numbers['tolerance_of_the_curves']:.0e}"
    floors = found.tables["fig7b-floor"]
    ratio = {"end": "end", "ratio": min(column(floors, "ratio"), key=lambda ratio: abs(ratio - 1e-3))}
    stiff = column(floors, "floor", element=TIMOSHENKO, psi=PRINTED_SHEAR_PSI, **ratio)
    return {
        "tolerance": shown,
        "range": {name: [_range(by[at]) for at in shown] for name, by in areas.items()},
        "least": {name: one.min() for name, one in smallest.items()},
        "areas": {name: one.tolist() for name, one in largest.items()},
        "largest": {name: one.max() for name, one in largest.items()},
        "slopes": slopes,
        "slope": {
            name: " and ".join(f"{round(one, 3) + 0.0:.3f}" for one in both) for name, both in slopes.items()
        },
        # with the printed G, over that of Euler-Bernoulli
        "stiff": float(stiff[0] / column(floors, "floor", element=SIMPLE, psi=PSI, **ratio)[0]),
        # where the measured range meets the printed one, and whether the printed one lies between two that do not
        "meets": {
            name: [*((smallest[name] <= most) & (largest[name] >= least)), *[True] * bool(takes[name] > 0.0)]
            for name, (least, most) in PRINTED.items()
        },
        "takes": {
            name: "beyond those measured" if np.isnan(one) else f"{one:.0e} EI/L^2"
            for name, one in takes.items()
        },
        "smaller": smaller,
        "gain": gain,
        "passed": passed,
        "ahead": passed[TIMOSHENKO][2] - max(passed[SIMPLE][2], passed[CANTILEVER][2]),
        "printed": (low, high),
        "nearest": NEAREST,
        "under": f"at {under[-1]} EI/L^2 and looser" if under else "at no tolerance measured",
    }


def _part(holds: NDArray[np.bool_]) -> tuple[int, int, float]:
    """Return how many hold, of how many, and their ratio."""
    return int(holds.sum()), holds.size, float(np.divide(holds.sum(), holds.size))


def _range(area: Mapping[str, float]) -> str:
    nowhere = " (nowhere in the element)" if area["largest"] == 1.0 else ""
    return f"{percent(area['smallest'])} to {percent(area['largest'])}{nowhere}"

"""Fig. 7: the cantilever of section 4.1, lifted by a pin, and how near to a node equilibrium is found."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise, product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparisons.answer import Array, Response
from comparisons.models import ROD, TSM, solve
from comparisons.models.model import Options
from comparisons.models.tsm import to_structure
from comparisons.output import Report, Row
from comparisons.scene import Scene, load_scene
from comparisons.suite.settings import changed
from comparisons.suites.drawing import Line
from comparisons.suites.paper.approach import NEAREST, approaches
from comparisons.suites.paper.figure import (
    CANTILEVER,
    LABELS,
    MIXED,
    SIMPLE,
    TIMOSHENKO,
    Numbers,
    Study,
    line,
    shapes,
    stops,
)
from comparisons.suites.paper.force_floor import TURNED, force_floor

STARTS = (4.05, 4.1, 4.2, 4.3, 4.35, 4.4)
"""The paper's starting positions of the pin [m]."""
PRINTED = {SIMPLE: (0.07749, 0.12952), CANTILEVER: (0.02164, 0.03865), TIMOSHENKO: (0.00067, 0.00501)}
"""The ranges of the critical area in [P] section 4.1."""
TOLERANCES = (1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
RATIOS = 10.0 ** -np.arange(1.0, 16.5, 0.5)
FITTED = (1e-13, 1e-2)
"""Ratios of the fitted slopes: below, a ratio has no digits left; above, it is no small one."""
MOVES = 0.5
"""A median critical area beyond half the element means that the tolerance is below the round-off everywhere in it."""
FLOORS: tuple[dict[str, Any], ...] = (
    *({"element": one, "end": end, "psi": 9.0} for one in (*LABELS, TURNED) for end in ("start", "end")),
    {"element": TIMOSHENKO, "end": "end", "psi": 4.5e-9},
)
"""Where the floor of the unbalanced force is measured: with EI/(G A_e l0^2) of section 4.1, and of section 4.2 as its G is printed."""


def lifted(start: float) -> Scene:
    """Return the scene of section 4.1 with a starting position of the pin [m]."""
    return changed(load_scene("cantilever-critical-area"), {("pin", "start"): (start, 0.0)})


def critical_areas(*, quick: bool, report: Report) -> Study:
    """Measure both; `quick` takes fewer starting positions, tolerances and samples."""
    tolerances, shown = (TOLERANCES[::3], 1e-9) if quick else (TOLERANCES, 1e-10)
    areas, curves = list[Row](), list[tuple[Row, Array, Array]]()
    for tolerance in tolerances:
        report(f"approach to the nodes at tolerance {tolerance:.0e}")
        for element, start in product(LABELS, STARTS[::4] if quick else STARTS):
            scene = lifted(start)
            for way in approaches(to_structure(scene, element=element), tolerance):
                place = {"element": element, "start": start, "node": way.node}
                areas.append({"element": element, "tolerance": tolerance, **place, "smallest": way.smallest})
                if tolerance == shown:
                    curves.append((place, way.load_parameter * scene.pins[0].points[1][1], way.ratio))
    report("floor of the unbalanced force")
    floors = np.array([
        [force_floor(of["element"], ratio, of["end"], of["psi"], samples=8 if quick else 50) for ratio in RATIOS]
        for of in FLOORS
    ])  # fmt: skip
    numbers = measured(areas, floors, shown)
    cases = zip(product(FLOORS, RATIOS), floors.ravel(), strict=True)
    panels: dict[str, list[Line]] = {}
    for place, raised, ratio in curves:
        element, title = place["element"], f"pin at {place['start']:g} m, tolerance {shown:.0e} EI/L$^2$"
        style = {"markevery": [-1], "linewidth": 3.2 - 0.7 * list(LABELS).index(element), **line(element)}
        curve = Line(LABELS[element], (raised, np.maximum(ratio, NEAREST)), style)
        panels.setdefault(title, []).append(curve)
    return Study(
        tables={
            "fig7b": [
                {**place, "displacement": d, "ratio": one}
                for place, raised, ratio in curves
                for d, one in zip(raised, ratio, strict=True)
            ],
            "fig7b-tolerance": areas,
            "fig7b-floor": [{**of, "ratio": ratio, "floor": floor} for (of, ratio), floor in cases],
        },
        numbers=numbers,
        pictures={
            "fig7b": panels,
            "fig7b-tolerance": {"": _areas(numbers)},
            "fig7b-floor": {"": _floors(floors, numbers)},
        },
    )


def measured(areas: Sequence[Row], floors: Array, shown: float) -> Numbers:
    """Return the numbers of critical areas, and of floors by `FLOORS` and `RATIOS`; an area of 1 stands for no equilibrium."""
    tolerances = list(dict.fromkeys(row["tolerance"] for row in areas))
    # by tolerance and way, from a start to a node, which may have a way from the same start before it
    count = len(areas) // len(tolerances) // len(LABELS)
    found = np.array([row["smallest"] for row in areas]).reshape(len(tolerances), len(LABELS), count)
    ways = dict(zip(LABELS, np.moveaxis(found, 1, 0), strict=True))
    later = [before["start"] == after["start"] for before, after in pairwise(areas[:count])]
    of_parts: dict[str, Any] = {"smallest": np.min, "median": np.median, "largest": np.max}
    critical = {
        name: {part: of(np.nan_to_num(one, nan=1.0), axis=1) for part, of in of_parts.items()}
        for name, one in ways.items()
    }
    takes, meets, smaller, gain, printed_gain = {}, {}, {}, {}, {}
    for name, (least, most) in PRINTED.items():
        # where the median is in the middle, interpolated in logarithms; nan outside what was measured
        medians = np.log(np.maximum(critical[name]["median"], 1e-300))
        rising, middle = np.argsort(medians), np.log(least * most) / 2.0
        at = np.interp(middle, medians[rising], np.log(tolerances)[rising], left=np.nan, right=np.nan)
        takes[name] = float(np.exp(at))
        # where the measured range meets the printed one, and whether the printed one lies between two that do not
        meeting = (critical[name]["smallest"] <= most) & (critical[name]["largest"] >= least)
        meets[name] = [*meeting, *[True] * (takes[name] > 0.0)]
    # the tolerances at which the Euler-Bernoulli contact still moves
    usable = critical[SIMPLE]["median"] < MOVES
    for above, below in pairwise(PRINTED):
        both = usable[:, None] & np.isfinite(ways[above] + ways[below])
        smaller[above] = _part((ways[above] > ways[below])[both])
        medians = np.maximum(critical[below]["median"][usable], NEAREST)
        gain[above] = critical[above]["median"][usable] / medians
        printed_gain[above] = float(np.sqrt(np.prod(PRINTED[above]) / np.prod(PRINTED[below])))
    fitted = (FITTED[0] * 0.999 < RATIOS) & (FITTED[1] * 1.001 > RATIOS)
    slopes = np.polyfit(np.log(RATIOS[fitted]), np.log(floors[:, fitted]).T, 1)[0]
    near = np.argmin(np.abs(RATIOS - 1e-3))
    below_printed = critical[TIMOSHENKO]["largest"] <= PRINTED[TIMOSHENKO][0]
    ends = slopes[:-1].reshape(-1, 2).tolist()
    return {
        "tolerances": tolerances,
        "tolerance_of_the_curves": shown,
        "critical_area": critical,
        "printed": PRINTED,
        "tolerance_for_the_printed": takes,
        "slopes_of_the_floor": dict(zip((*LABELS, TURNED), ends, strict=True)),
        "stiff": floors[-1, near] / floors[1, near],  # with the printed G, over that of Euler-Bernoulli
        "meets": meets,
        "smaller": smaller,
        "gain": gain,
        "printed_gain": printed_gain,
        "passed": {name: _part(np.isfinite(one[:, 1:][:, later])) for name, one in ways.items()},
        "search_ends": NEAREST,
        "below_printed": np.array(tolerances)[below_printed].tolist(),
    }


def _part(holds: NDArray[np.bool_]) -> tuple[int, int]:
    """Return how many hold, of how many."""
    return int(holds.sum()), holds.size


def _areas(numbers: Numbers) -> Iterator[Line]:
    """The range of the critical area over nodes and starting positions against the tolerance, and the paper's."""
    tolerances = numbers["tolerances"]
    beside = tolerances[-1] / 10.0, tolerances[-1] / 100.0
    for element, label in LABELS.items():
        faint = {"color": line(element)["color"], "linewidth": 0.8}
        for part, area in numbers["critical_area"][element].items():
            words, style = (label, line(element)) if part == "median" else ("_", faint)
            yield Line(words, (tolerances, np.maximum(area, NEAREST)), style)
        for edge in PRINTED.get(element, ()):
            yield Line("printed in the paper", (beside, (edge, edge)), faint | {"linewidth": 3.0})
    ends = {"color": "0.6", "linestyle": ":"}
    yield Line(f"search ends at {NEAREST:.0e}", (tolerances, [NEAREST] * len(tolerances)), ends)


def _floors(floors: Array, numbers: Numbers) -> Iterator[Line]:
    """The floor of the unbalanced force against l_i/l with the fitted slopes."""
    for element, floor in zip(LABELS, floors[1::2], strict=False):
        slope = np.mean(numbers["slopes_of_the_floor"][element])
        style = {"markersize": 8 if element == SIMPLE else 5, **line(element)}
        yield Line(f"{LABELS[element]}: slope {slope:z.2f}", (RATIOS, floor), style)
    stiff = {**line(TIMOSHENKO), "marker": "v", "linestyle": "-."}
    yield Line(f"{LABELS[TIMOSHENKO]}, printed G of section 4.2", (RATIOS, floors[-1]), stiff)
    for edge in FITTED:
        yield Line("fitted between", ((edge, edge), (1e-16, 1.0)), {"color": "0.6", "linestyle": ":"})


ELEMENTS = (18, 72)
"""The paper's number of elements, and four times as many."""
FOLLOWED = 5e-4
"""Relative error of a slip-off displacement that counts as followed."""
DEPTHS = (0.25, 0.5, 0.75, 1.0)
"""Shapes shown, in parts of the displacement at slip-off: the last load parameter before."""


def cantilever_shapes(*, quick: bool, report: Report) -> Study:
    """Solve the six; `quick` takes two of them with a quarter of the load parameters and without Euler-Bernoulli."""
    lifts, histories, panels = list[Row](), list[Row](), dict[str, list[Line]]()
    scenes, runs = list[Scene](), dict[str, Response]()
    for start in STARTS[::4] if quick else STARTS:
        place, scene = f"pin at {start:g} m", lifted(start)
        report(place)
        if quick:
            scene = replace(scene, load_parameters=scene.load_parameters // 4)
        scenes.append(scene)
        pair, travel = scene.contacts[0].pair, scene.pins[0].points[1][1]
        elements = (TIMOSHENKO, MIXED) if quick else LABELS
        tried = {one: solve(scene, TSM.name, Options(element=one)) for one in elements}
        finer = solve(scene, TSM.name, Options(elements=ELEMENTS[1]))
        beams, rod = tried[MIXED], solve(scene, ROD.name)
        runs |= {f"{place}, {one.model}": one for one in (beams, rod)}
        own, exact = beams.contacts[pair], rod.contacts[pair]
        # forces [N] and arc positions [m] against the displacement of the pin [m], where both are in contact
        columns = (beams.load_parameter, own.force, exact.force, own.arc_position, exact.arc_position)
        history = np.array([row for row in zip(*columns, strict=False) if np.isfinite(row).all()])
        history[:, 0] *= travel
        names = ("start", "displacement", "force", "rod_force", "arc", "rod_arc")
        histories += [dict(zip(names, (start, *row), strict=True)) for row in history]
        slip_off = {
            n: travel * run.contacts[pair].slip_off for n, run in zip(ELEMENTS, (beams, finer), strict=True)
        }
        # up to the slip-off, or the end of the run before it
        ends = {
            element: travel * np.nanmin([run.contacts[pair].slip_off, max(run.load_parameter, default=0.0)])
            for element, run in tried.items()
        }
        lifts.append({
            "start": start,
            "slip_off_rod": travel * exact.slip_off,
            "slip_off": slip_off,
            "slip_off_error": {n: abs(value / (travel * exact.slip_off) - 1.0) for n, value in slip_off.items()},
            "force_error": np.abs(history[:, 2] - history[:, 1]).max() / history[:, 2].max(),
            "reached_in_contact": ends,
            "paper_followed": bool(np.isclose(ends[TIMOSHENKO], travel * exact.slip_off, rtol=FOLLOWED)),
        })  # fmt: skip
        last = int(np.flatnonzero(np.isfinite(own.arc_position))[-1])
        shown = {"exact rod": rod, f"TSM mixed, {ELEMENTS[0]} elements": beams}
        title = f"{place}: slips off at {slip_off[ELEMENTS[0]]:.4f} m"
        panels[title] = list(shapes(scene, shown, [round(part * last) for part in DEPTHS]))
    return Study(
        tables={"fig7a": histories},
        numbers={"starting_positions": lifts, "stopped": stops(runs)},
        pictures={"fig7a": panels},
        scenes=scenes,
    )

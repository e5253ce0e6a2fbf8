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
from comparisons.report.plot import Line
from comparisons.scene import Scene, load_scene
from comparisons.suite.settings import changed
from comparisons.suites.paper.approach import NEAREST, approaches
from comparisons.suites.paper.figure import (
    CANTILEVER,
    LABELS,
    MIXED,
    SIMPLE,
    STATED,
    TIMOSHENKO,
    Numbers,
    Study,
    line,
    pictures,
    shapes,
    stops,
)
from comparisons.suites.paper.force_floor import TURNED, force_floor

GIVEN = STATED["fig7"]
PRINTED = {SIMPLE: (0.07749, 0.12952), CANTILEVER: (0.02164, 0.03865), TIMOSHENKO: (0.00067, 0.00501)}
"""The ranges of the critical area in [P] section 4.1."""
RATIOS = 10.0 ** -np.arange(1.0, 16.5, 0.5)
DOTTED = {"color": "0.6", "linestyle": ":"}
FLOORS: tuple[dict[str, Any], ...] = (
    *({"element": one, "end": end, "psi": 9.0} for one in (*LABELS, TURNED) for end in ("start", "end")),
    {"element": TIMOSHENKO, "end": "end", "psi": 4.5e-9},
)
"""Where the floor of the unbalanced force is measured: with EI/(G A_e l0^2) of section 4.1, and of section 4.2 as its G is printed."""


def lifted(start: float) -> Scene:
    """Return the scene of section 4.1 with a starting position of the pin [m]."""
    return changed(load_scene("cantilever-critical-area"), {"pin.start": (start, 0.0)})


def critical_areas(*, quick: bool, report: Report) -> Study:
    """Measure both; `quick` takes fewer starting positions, tolerances and samples."""
    tolerances, shown = GIVEN["tolerances"][:: 3 if quick else 1], 1e-9 if quick else 1e-10
    areas, curves, panels = list[Row](), list[Row](), dict[str, list[Line]]()
    for tolerance in tolerances:
        report(f"approach to the nodes at tolerance {tolerance:.0e}")
        for element, start in product(LABELS, GIVEN["starts"][:: 4 if quick else 1]):
            scene = lifted(start)
            for way in approaches(to_structure(scene, element=element), tolerance):
                place = {"element": element, "start": start, "node": way.node}
                areas.append({"element": element, "tolerance": tolerance, **place, "smallest": way.smallest})
                if tolerance == shown:
                    raised = way.load_parameter * scene.pins[0].points[1][1]
                    both = zip(raised, way.ratio, strict=True)
                    curves += ({**place, "displacement": d, "ratio": ratio} for d, ratio in both)
                    wide = {"markevery": [-1], "linewidth": 3.2 - 0.7 * list(LABELS).index(element)}
                    seen = raised, np.maximum(way.ratio, NEAREST)
                    curve = Line(LABELS[element], seen, wide | line(element))
                    title = f"pin at {start:g} m, tolerance {shown:.0e} EI/L$^2$"
                    panels.setdefault(title, []).append(curve)
    report("floor of the unbalanced force")
    samples = 8 if quick else 50
    cases = [{**of, "ratio": ratio} for of, ratio in product(FLOORS, RATIOS)]
    rows = [{**of, "floor": force_floor(**of, samples=samples)} for of in cases]
    floors = np.reshape([row["floor"] for row in rows], (len(FLOORS), -1))
    numbers = measured(areas, floors, shown)
    drawn = {"fig7b-tolerance": {"": _areas(numbers)}, "fig7b-floor": {"": _floors(floors, numbers)}}
    return Study(
        tables={"fig7b": curves, "fig7b-tolerance": areas, "fig7b-floor": rows},
        numbers=numbers,
        pictures=pictures({"fig7b": panels, **drawn}),
    )


def measured(areas: Sequence[Row], floors: Array, shown: float) -> Numbers:
    """Return the numbers of critical areas, and of floors by `FLOORS` and `RATIOS`; an area of 1 stands for no equilibrium."""
    tolerances = list(dict.fromkeys(row["tolerance"] for row in areas))
    # by tolerance and way, from a start to a node
    found = np.reshape([row["smallest"] for row in areas], (len(tolerances), len(LABELS), -1))
    ways = {name: found[:, k] for k, name in enumerate(LABELS)}
    # ways that have one from the same start before them
    later = np.diff([row["start"] for row in areas[: found.shape[2]]]) == 0.0
    of_parts: dict[str, Any] = {"smallest": np.min, "median": np.median, "largest": np.max}
    critical = {
        name: {part: of(np.nan_to_num(one, nan=1.0), axis=1) for part, of in of_parts.items()}
        for name, one in ways.items()
    }
    takes, meets, smaller, gain = {}, {}, {}, {}
    for name, (least, most) in PRINTED.items():
        area = critical[name]
        # where the median is in the middle, interpolated in logarithms; nan outside what was measured
        known = np.log([np.maximum(area["median"], 1e-300), tolerances])
        medians, sharp = known[:, np.argsort(known[0])]
        at = np.interp(np.log(least * most) / 2.0, medians, sharp, left=np.nan, right=np.nan)
        takes[name] = float(np.exp(at))
        # where the measured range meets the printed one, and whether the printed one lies between two that do not
        meeting = (area["smallest"] <= most) & (area["largest"] >= least)
        meets[name] = [*meeting, *[True] * (takes[name] > 0.0)]
    # the tolerances at which the Euler-Bernoulli contact still moves
    usable = critical[SIMPLE]["median"] < GIVEN["moves"]
    for above, below in pairwise(PRINTED):
        both = usable[:, None] & np.isfinite(ways[above] + ways[below])
        smaller[above] = _part((ways[above] > ways[below])[both])
        gain[above] = (critical[above]["median"] / np.maximum(critical[below]["median"], NEAREST))[usable]
    middle = {name: np.sqrt(np.prod(ends)) for name, ends in PRINTED.items()}
    least, most = GIVEN["fitted"]
    fitted = (least * 0.999 < RATIOS) & (most * 1.001 > RATIOS)
    slopes = np.polyfit(np.log(RATIOS[fitted]), np.log(floors[:, fitted]).T, 1)[0]
    near = np.argmin(np.abs(RATIOS - 1e-3))
    below_printed = critical[TIMOSHENKO]["largest"] <= PRINTED[TIMOSHENKO][0]
    return {
        "tolerances": tolerances,
        "tolerance_of_the_curves": shown,
        "critical_area": critical,
        "printed": PRINTED,
        "tolerance_for_the_printed": takes,
        "slopes_of_the_floor": dict(zip((*LABELS, TURNED), slopes[:-1].reshape(-1, 2).tolist(), strict=True)),
        "stiff": floors[-1, near] / floors[1, near],  # with the printed G, over that of Euler-Bernoulli
        "meets": meets,
        "smaller": smaller,
        "gain": gain,
        "printed_gain": {above: float(middle[above] / middle[below]) for above, below in pairwise(PRINTED)},
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
    yield Line(f"search ends at {NEAREST:.0e}", (tolerances, [NEAREST] * len(tolerances)), DOTTED)


def _floors(floors: Array, numbers: Numbers) -> Iterator[Line]:
    """The floor of the unbalanced force against l_i/l with the fitted slopes."""
    for element, floor in zip(LABELS, floors[1::2], strict=False):
        slope = np.mean(numbers["slopes_of_the_floor"][element])
        style = {"markersize": 8 if element == SIMPLE else 5, **line(element)}
        yield Line(f"{LABELS[element]}: slope {slope:z.2f}", (RATIOS, floor), style)
    stiff = {**line(TIMOSHENKO), "marker": "v", "linestyle": "-."}
    yield Line(f"{LABELS[TIMOSHENKO]}, printed G of section 4.2", (RATIOS, floors[-1]), stiff)
    yield from (Line("fitted between", ((edge, edge), (1e-16, 1.0)), DOTTED) for edge in GIVEN["fitted"])


def cantilever_shapes(*, quick: bool, report: Report) -> Study:
    """Solve the six; `quick` takes two of them with a quarter of the load parameters and without Euler-Bernoulli."""
    lifts, histories, panels = list[Row](), list[Row](), dict[str, Iterator[Line]]()
    scenes, runs = list[Scene](), dict[str, Response]()
    coarse, fine = GIVEN["elements"]
    for start in GIVEN["starts"][:: 4 if quick else 1]:
        place, scene = f"pin at {start:g} m", lifted(start)
        report(place)
        if quick:
            scene = replace(scene, load_parameters=scene.load_parameters // 4)
        scenes.append(scene)
        pair, travel = scene.contacts[0].pair, scene.pins[0].points[1][1]
        asked = (TIMOSHENKO, MIXED) if quick else LABELS
        tried = {one: solve(scene, TSM.name, Options(element=one)) for one in asked}
        finer = solve(scene, TSM.name, Options(elements=fine))
        beams, rod = tried[MIXED], solve(scene, ROD.name)
        runs |= {f"{place}, {one.model}": one for one in (beams, rod)}
        own, exact = beams.contacts[pair], rod.contacts[pair]
        # forces [N] and arc positions [m] against the displacement of the pin [m], where both are in contact
        way = travel * beams.load_parameter
        columns = (way, own.force, exact.force, own.arc_position, exact.arc_position)
        history = np.array([row for row in zip(*columns, strict=False) if np.isfinite(row).all()])
        names = ("start", "displacement", "force", "rod_force", "arc", "rod_arc")
        histories += (dict(zip(names, (start, *row), strict=True)) for row in history)
        # up to the slip-off, or the end of the run before it
        off = {one: travel * one.contacts[pair].slip_off for one in (*tried.values(), finer, rod)}
        last = {one: travel * max(one.load_parameter, default=0.0) for one in tried.values()}
        ends = {name: np.nanmin([off[one], last[one]]) for name, one in tried.items()}
        slip_off = {coarse: off[beams], fine: off[finer]}
        lifts.append({
            "start": start,
            "slip_off_rod": off[rod],
            "slip_off": slip_off,
            "slip_off_error": {n: abs(value / off[rod] - 1.0) for n, value in slip_off.items()},
            "force_error": np.abs(history[:, 2] - history[:, 1]).max() / history[:, 2].max(),
            "reached_in_contact": ends,
            "paper_followed": bool(np.isclose(ends[TIMOSHENKO], off[rod], rtol=GIVEN["followed"])),
        })  # fmt: skip
        closed = int(np.flatnonzero(np.isfinite(own.arc_position))[-1])
        shown = {f"TSM {one}, {coarse} elements": tried[one] for one in (TIMOSHENKO, MIXED)}
        stop = f"timoshenko: {tried[TIMOSHENKO].status} after {ends[TIMOSHENKO]:.4f} m"
        steps = [round(part * closed) for part in GIVEN["depths"]]
        title = f"{place}: slips off at {off[beams]:.4f} m\n{stop}"
        panels[title] = shapes(scene, {"exact rod": rod, **shown}, steps)
    return Study(
        tables={"fig7a": histories},
        numbers={"starting_positions": lifts, "stopped": stops(runs)},
        pictures=pictures({"fig7a": panels}),
        scenes=scenes,
    )

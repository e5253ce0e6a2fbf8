"""The tables and diagrams of a trade-off: every setting, the cheapest for an accuracy, fronts, orders."""

from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from itertools import chain, pairwise, product
from math import isfinite, log
from operator import itemgetter
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.answer.quantities import KEPT, SCOPES
from comparisons.models import MODELS, ROD, SOLID, TSM
from comparisons.output import Row as Line
from comparisons.output import tabulated
from comparisons.report import palette
from comparisons.report.brief import Brief
from comparisons.report.pages import Section, picture, piece, table
from comparisons.report.plot import draw, tag
from comparisons.scene import Scene, to_toml
from comparisons.suite.progress import Runner
from comparisons.suite.study import result_rows
from comparisons.suites.found import Found
from comparisons.suites.trade.trade import (
    COSTS,
    MESHED,
    TARGETS,
    Trade,
    cheapest,
    front,
    measure_trade,
    orders,
)

SHOWN = "force"
"""The quantity of the diagrams, and of the tables for people; the files have all."""
WORK = "path-seconds"
"""The name of the diagram."""
SCOPE = "path"
"""The scope of the diagram."""
SECONDS = "processor seconds of one thread, from the scene to the checked answer"
APART = 0.045
"""Least distance of two labels, over the height of the diagram."""


def _draw(axes: Any, trade: Trade, *, own: bool) -> None:
    """Draw the errors of the completed settings over their seconds in the order of the legend; their uncertainty bounds them from below."""
    order = [words for model in MODELS.values() for words in model.styles()]
    models = (model.name for model in MODELS.values() if model.meshed or not model.rod)
    rows = [row for name in models for row in trade.of_model(name, SCOPE)]
    rank = {row: max(k for k, words in enumerate(order) if row.family.startswith(words)) for row in rows}
    for row in sorted(rows, key=rank.__getitem__):
        style, error = palette.style(row.family), row.error(SCOPE, SHOWN, own=own)
        floor = trade.uncertainty(row.case.model if own else ROD.name, SCOPE, SHOWN)
        mark = {"color": style.colour, "marker": style.marker, "markersize": 9 if style.marker == "*" else 6}
        if np.isfinite(error):
            axes.plot(row.seconds, max(error, floor), ls="none", label=row.family, alpha=0.85, **mark)
    title = "against what each model converges to, Pareto fronts" if own else "against the exact rod"
    axes.set(xscale="log", yscale="log", ylabel=f"largest error of {SHOWN}", title=title)
    axes.margins(x=0.3, y=0.06)
    if own:
        axes.set_xlabel(SECONDS)
        doubt = trade.uncertainty(SOLID.name, SCOPE, SHOWN)
        if np.isfinite(doubt) and doubt > 0.0:
            words = "the solid's limit is known to this"
            axes.axhline(doubt, color=SOLID.colour, linewidth=0.9, linestyle=":", label=words)
        for model in MESHED:
            _draw_front(axes, front(trade, model, SCOPE, SHOWN, COSTS[0]), model)


def _draw_front(axes: Any, points: Sequence[Line], model: str) -> None:
    """Draw a front, and name its points where they lie apart: beams, which are cheaper, to the left, solids above to the right."""
    spent, errors = ([one[name] for one in points] for name in ("spent", "own_error"))
    axes.plot(spent, errors, color=MODELS[model].colour, linewidth=1.6, drawstyle="steps-post", zorder=1)
    low, high = np.log(axes.get_ylim())
    style: dict[str, Any] = {"va": "center", "ha": "right", "offset": (-7, 0)}
    if model == SOLID.name:
        style = {"va": "bottom", "ha": "left", "offset": (3, 3)}
    last = np.inf
    for one in points:
        height = np.log(one["own_error"])
        if height < last - APART * (high - low):
            last = height
            words, place = one["setting"].partition(" [")[0], (one["spent"], one["own_error"])
            tag(axes, words, place, fontsize="small", **style)


SETTING = (
    "label", "scene.load_parameters", "status", "unknowns", "iterations", "seconds", "own_error_end_force", "own_error_path_force",
    "error_path_force",
)  # fmt: skip
"""Columns of all settings for people; the files have all."""
HIDDEN = ("scope", "quantity", "limit_uncertainty", "settings", "order_scatter", "cost_exponent_scatter")
"""Columns that the other tables for people leave out."""


def trade(scene: Scene, run: Runner, *, quick: bool) -> Found:
    """Return what a trade-off found: every setting, the cheapest for an accuracy, orders, fronts, and what stopped."""
    trade = measure_trade(scene, run, quick=quick)
    settings, known = result_rows(trade.rows), trade.reference.uncertainty
    stated = [(scope, name) for scope, name in product(SCOPES, KEPT) if isfinite(known[scope][name])]
    cheap = [cheapest(trade, *of, target) for of, target in product(stated, TARGETS)]
    fitted = {quantity: list(orders(trade, quantity)) for quantity in KEPT}
    references = {"error": trade.reference, "own_error of the solid": trade.limit}
    numbers = {
        "scene": scene.name,
        "scene_file": to_toml(scene),
        "references": {
            name: one and {"is": one.sentence, "end": one.end, "uncertainty": one.uncertainty}
            for name, one in references.items()
        },
        "cheapest": cheap,
        "orders": fitted,
        "pareto": [row for of in product(MESHED, SCOPES, KEPT, COSTS) for row in front(trade, *of)],
    }
    stopped = (row for row in trade.rows if not row.response.completed)
    reasons = {f"{row.label} [{row.case.scene.load_parameters}]": row.response.ended for row in stopped}
    shown = _tables(trade)
    said = [f"{title}\n\n{tabulated(rows) if rows else 'none'}" for title, rows in chain(*shown.values())]
    ends = ["settings without a solution:", *(f"  {name}: {why}" for name, why in reasons.items())]
    limit = trade.limit.sentence if trade.limit else "not known: a solid that it is extrapolated from stopped"
    sources = {"errors against": trade.reference.sentence, "the solid's own limit": limit}

    panels = [partial(_draw, trade=trade, own=own) for own in (False, True)]
    title = f"{scene.name}: what accuracy costs over {scene.load_parameters} load steps"
    work = partial(draw, panels, tall=3.95, title=title, columns=1, sharex=True, sharey=True)

    def sections(folder: Path) -> list[Section]:
        seen = picture(folder / f"{WORK}.svg", f"Largest error of {SHOWN} over the path, against seconds.")
        every = _shown([{name: row[name] for name in SETTING} for row in settings])
        return [
            Section("Work and precision", seen),
            *(Section(name, "\n".join(table(*one) for one in tables)) for name, tables in shown.items()),
            Section("All settings", piece("definitions", sources) + table(f"Seconds: {SECONDS}", every)),
            Section("Settings without a solution", piece("definitions", reasons)),
        ]

    return Found(
        title=f"{scene.name}: what accuracy costs",
        brief=_brief(trade, sources, len(reasons)),
        files={
            "trade.csv": settings,
            "cheapest.csv": cheap,
            "orders.csv": [{"quantity": name, **row} for name, rows in fitted.items() for row in rows],
            "trade.json": numbers,
        },
        sections=sections,
        pictures={WORK: work},
        scenes=[scene],
        text="\n\n".join([*said, "\n".join(ends if reasons else [])]),
    )


def _shown(rows: Iterable[Line]) -> list[Line]:
    """Return rows for people, without `HIDDEN`, with blanks in the names."""
    return [{key.replace("_", " "): value for key, value in row.items() if key not in HIDDEN} for row in rows]


def _tables(trade: Trade) -> dict[str, list[tuple[str, list[Line]]]]:
    """Return the tables for people, each with its title, by the section of the page."""
    places = {
        "end": f"at the load parameter {trade.reference.end:g}, any number of load steps",
        "path": f"the largest over all {trade.scene.load_parameters} load parameters",
    }
    cheap = [
        (
            f"cheapest for an error of {SHOWN}, {place}",
            _shown(cheapest(trade, of, SHOWN, one) for one in TARGETS),
        )
        for of, place in places.items()
    ]
    title = f"orders over elements and cost exponents over unknowns, error of {SHOWN} over the path"
    return {"Cheapest settings": cheap, "Orders of convergence": [(title, _shown(orders(trade, SHOWN)))]}


def _brief(trade: Trade, sources: Mapping[str, str], stopped: int) -> Brief:
    """Return what is found: what the solid costs beside beams of equal error, and what more time buys."""
    rows = [cheapest(trade, SCOPE, SHOWN, target) for target in TARGETS]
    ratios = [row["ratio"] for row in rows if row["ratio"]]
    said = "No solid here is as near to its limit as beams are to theirs"
    if ratios:
        between = " to ".join(dict.fromkeys(f"{ratio:.2g}" for ratio in (min(ratios), max(ratios))))
        said = f"At equal error the solid takes {between} times the seconds of beams"
    steps = pairwise(front(trade, TSM.name, SCOPE, SHOWN, COSTS[0]))
    # by how many decades the error falls over how many the seconds rise
    gains = [(log(a["own_error"] / b["own_error"]) / log(b["spent"] / a["spent"]), a, b) for a, b in steps]
    for _, a, b in sorted(gains, key=itemgetter(0))[-1:]:
        more = b["spent"] / a["spent"] - 1.0
        said += f"; {more:.0%} more time buys an error of {b['own_error']:.0e} instead of {a['own_error']:.0e} ({b['setting']})"
    points = [f"{name[0].upper()}{name[1:]}: {what}." for name, what in sources.items()]
    legend = "[n]: n load steps; -: no setting does it."
    points.append(f"{len(trade.rows)} settings, {stopped} without a solution; {legend}")
    names = ("error", "beams", "seconds", SOLID.label, "seconds ", "ratio")
    columns = ("target", TSM.name, f"{TSM.name}_seconds", SOLID.name, f"{SOLID.name}_seconds", "ratio")
    answer = [dict(zip(names, map(row.get, columns), strict=True)) for row in rows]
    about = f"The cheapest settings for an error of {SHOWN} over the path, and their seconds:"
    return Brief(f"{said}.", points, answer, about)

"""Make the set anew: scenes.json, queries.json and answers.json, from two programs that share no code.

    python bench/make.py [FOLDER]

Needs this repository's package, and the set alone does not. Values are of exact beam elements (tsm) and of the
referee's energy elements, which start at the first program's state and find their own equilibrium. A number that both
still give to its stated digits keeps its text, so that another processor's round-off changes no byte.
"""

import json
import math
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.answer import Response
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.referee import Equilibrium, certify
from comparisons.referee.friction import History, dissipated
from comparisons.referee.path import corners, reach
from comparisons.scene import Scene
from comparisons.suites import bench

HERE = Path(__file__).parent
MOST = 12
"""Most digits that are stated."""
KINDS = {
    "force_x": "force",
    "force_y": "force",
    "displacement_x": "displacement",
    "displacement_y": "displacement",
}
EXACT = Options(element="exact", integration_tolerance=1e-13)


def referee(scene: Scene, response: Response) -> tuple[dict[str, Any], Callable[[Any], float]]:
    """Return what the referee says: histories by OF.WHAT over all load parameters, and the load parameter of an event."""
    verdict = certify(response, scene, at=range(len(scene.times)))
    assert verdict.certified, f"{scene.name}: {verdict.line()}"
    states = [one.exact for one in verdict.judged]
    history = History(response, scene)
    found: dict[str, Any] = {}
    for one in scene.contacts:
        there = [state.contacts.get(one.pair) for state in states]
        for i, x in enumerate("xy"):
            found[f"{one.pair}.force_{x}"] = [0.0 if c is None else c.force[i] for c in there]
        found[f"{one.pair}.arc_position"] = [math.nan if c is None else c.arc_position for c in there]
    if any(one.friction for one in scene.contacts):
        lost = [dissipated(history, k, state) for k, state in enumerate(states)]
        found |= {f"{pair}.dissipated": np.cumsum([one[pair] for one in lost]) for pair in lost[0]}
    for one in scene.all_supports:
        for i, what in enumerate(("force_x", "force_y", "moment")):
            found[f"{one.node}.{what}"] = [state.reactions[one.node][i] for state in states]
    for end in states[0].ends:
        for i, x in enumerate("xy"):
            found[f"{end}.displacement_{x}"] = [state.ends[end][i] - scene.place(end)[i] for state in states]
    return found, lambda event: located(scene, response, event, states)


def located(scene: Scene, response: Response, event: Any, states: list[Equilibrium]) -> float:
    """Return the load parameter of an event by the referee's own equilibria, told a wrong one, but not where it must be at a corner."""
    if event.kind != "slip-off":
        t = event.load_parameter
        corner = any(abs(t - other) < 1e-9 for other in corners(scene))
        after = next(time for time in scene.times if time > t)
        told = replace(event, load_parameter=t if corner else t + 1e-3 * (after - t))
        events = tuple(told if one is event else one for one in response.events or ())
        history = History(replace(response, events=events), scene)
        (phase,) = (phase for phase in history.phases[event.pair] if phase.event is told)
        return float(history.begin(phase).load_parameter)
    near = [state for state in states if state.load_parameter < event.load_parameter][-1]
    length = scene.beam(event.pair.rpartition(">")[2]).length

    def beyond(t: float) -> float:
        return reach(near, t, near.layout.grips).closed[event.pair] - length

    t, before = event.load_parameter, event.load_parameter - 1e-5
    for _ in range(4):
        a, b = beyond(before), beyond(t)
        if a == b:
            break
        before, t = t, t - b * (t - before) / (b - a)
    return t


def agreed(old: Mapping[str, Any], found: Mapping[str, Response]) -> Iterator[dict[str, Any]]:
    """Yield the answers: value, digits, scale, and how they were obtained."""
    other = {name: referee(scene, found[name]) for name, (scene, _) in bench.scenes().items()}
    own = {name: bench.histories(scene, found[name]) for name, (scene, _) in bench.scenes().items()}
    rows = []
    for query in bench.queries(found):
        scene, at = bench.scenes()[query["scene"]]
        columns, time = other[scene.name]
        first = bench.told(query, found[scene.name], own[scene.name])
        if "at" in query:
            second = columns[f"{query['of']}.{query['what']}"][at[query["at"]]]
        else:
            second = time(bench.event(query, found[scene.name]))
        rows.append((query, first, float(second)))
    for query, *values in rows:
        scene, kind = bench.scenes()[query["scene"]][0], KINDS.get(query["what"], query["what"])
        alike = [
            abs(v) for q, v, _ in rows if (q["scene"], KINDS.get(q["what"], q["what"])) == (scene.name, kind)
        ]
        scale = 1.0 if "number" in query else float(f"{max(alike):.2g}")
        if kind == "arc_position":
            scale = scene.beam(query["of"].rpartition(">")[2]).length
        apart = abs(values[0] - values[1]) / scale
        digits = MOST if apart < 10.0**-MOST else math.floor(-math.log10(apart))
        value = round(math.fsum(values) / 2.0, digits + 1 - math.floor(math.log10(scale)))
        kept = old.get(json.dumps(query), {})
        if kept.get("scale") == scale and all(
            abs(one - kept["value"]) <= 10.0 ** -kept["digits"] * scale for one in values
        ):
            value, digits = kept["value"], kept["digits"]
        rubs = any(one.friction for one in scene.contacts) or "number" in query
        yield query | {
            "value": value,
            "digits": digits,
            "scale": scale,
            "kind": "history" if rubs else "state",
        }


def texts(old: str) -> dict[str, str]:
    """Return the texts of the files of the set, with the numbers that an old text of answers.json keeps."""
    kept = json.loads(old)["answers"] if old else []
    keys = ("scene", "of", "what", "at", "number")
    before = {json.dumps({key: row[key] for key in keys if key in row}): row for row in kept}
    found = {
        name: replace(solve(scene, "tsm", EXACT), definition=None)
        for name, (scene, _) in bench.scenes().items()
    }
    stated, asked, name = bench.set_texts(found)
    how = "two programs without common code: exact beam elements (tsm), and energy elements (referee)"
    right = bench.lines("answers", list(agreed(before, found)), **bench.HEAD, set=name, obtained=how)
    return {"scenes.json": stated, "queries.json": asked, "answers.json": right}


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if sys.argv[1:] else HERE
    known = folder / "answers.json"
    for file, text in texts(known.read_text(encoding="utf-8") if known.exists() else "").items():
        (folder / file).write_text(text, encoding="utf-8")

"""Make the set anew: scenes.json, queries.json and answers.json. Usage: python bench/make.py [FOLDER].

Needs this repository's package; the set does not. A number is of exact beam elements (tsm) and of the referee's energy
elements, which share no code. Where both still give it to its stated digits, its text is kept, so that the round-off
of another processor changes no byte.
"""

import json
import math
import sys
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from comparisons.answer import ContactEvent, Response
from comparisons.models import solve
from comparisons.models.model import Options, unwatched
from comparisons.models.rod import solve_rods
from comparisons.referee import certify
from comparisons.referee.friction import History
from comparisons.referee.path import corners, reach
from comparisons.scene import Scene
from comparisons.suites import bench

EXACT = Options(element="exact", integration_tolerance=1e-13)
HOW = "two programs without common code: exact beam elements (tsm), energy elements (referee)"


def located(scene: Scene, response: Response, event: ContactEvent) -> float:
    """Return the load parameter of an event by the referee's own equilibria, sought from a wrong one."""
    t = event.load_parameter
    if event.kind != "slip-off":
        corner = any(abs(t - other) < 1e-9 for other in corners(scene))  # where it must be
        after = next(time for time in scene.times if time > t)
        told = replace(event, load_parameter=t if corner else t + 1e-3 * (after - t))
        events = tuple(told if one is event else one for one in response.events or ())
        history = History(replace(response, events=events), scene)
        (phase,) = (phase for phase in history.phases[event.pair] if phase.event is told)
        return float(history.begin(phase).load_parameter)
    near = certify(response, scene, at=[sum(time < t for time in scene.times) - 1]).judged[0].exact
    assert near is not None, f"{event.pair} slips off where the referee finds nothing"
    length = scene.beam(event.pair.rpartition(">")[2]).length
    times = [t - 1e-4 * k for k in range(1, 6)]  # a contact within round-off of an end has no equilibrium
    off = [reach(near, one, near.layout.grips).closed[event.pair] - length for one in times]
    shares = (math.prod(b / (b - a) for b in off if b != a) for a in off)
    return math.fsum(one * share for one, share in zip(times, shares, strict=True))


def values(found: Mapping[str, Response]) -> Iterator[tuple[bench.Query, float, float]]:
    """Yield every query with both programs' values."""
    other = {name: solve_rods(scene, unwatched) for name, (scene, _) in bench.scenes().items()}
    stopped = [name for name, response in other.items() if not response.completed]
    assert not stopped, f"the referee does not certify {stopped}"
    columns = {
        name: [bench.histories(scene, one[name]) for one in (found, other)]
        for name, (scene, _) in bench.scenes().items()
    }
    for query in bench.queries(found):
        scene, event = bench.scenes()[query["scene"]][0], bench.event(query, found[query["scene"]])
        first, second = (bench.told(query, found[scene.name], one) for one in columns[scene.name])
        if event is not None:
            second = located(scene, found[scene.name], event)
        yield query, first, second


def answers(found: Mapping[str, Response], old: Mapping[str, bench.Query]) -> Iterator[bench.Query]:
    """Yield the queries with value, digits and scale, and whether they are of the state or of the history."""
    rows = [*values(found)]
    for query, *both in rows:
        scene, kind = bench.scenes()[query["scene"]][0], query["what"].rstrip("xy")
        alike = [abs(v) for q, v, _ in rows if (q["scene"], q["what"].rstrip("xy")) == (scene.name, kind)]
        scale = 1.0 if "number" in query else float(f"{max(alike):.2g}")
        if kind == "arc_position":
            scale = scene.beam(query["of"].rpartition(">")[2]).length
        apart = abs(both[0] - both[1]) / scale
        digits = 12 if apart < 1e-12 else math.floor(-math.log10(apart))
        value = round(math.fsum(both) / 2.0, digits + 1 - math.floor(math.log10(scale)))
        kept = old.get(json.dumps(query), {"value": math.nan, "digits": 0})
        same = all(abs(one - kept["value"]) <= 10.0 ** -kept["digits"] * scale for one in both)
        if same and digits <= kept["digits"] + 1:
            value, digits = kept["value"], kept["digits"]
        history = "number" in query or any(one.friction for one in scene.contacts)
        how = {"value": value, "digits": digits, "scale": scale, "kind": "history" if history else "state"}
        yield {**query, **how}


def texts(folder: Path) -> dict[str, str]:
    """Return the texts of the files of the set; the folder may have an answers.json, whose numbers are kept."""
    known = folder / "answers.json"
    old = json.loads(known.read_text(encoding="utf-8"))["answers"] if known.exists() else []
    found = {name: solve(scene, "tsm", EXACT) for name, (scene, _) in bench.scenes().items()}
    stated, asked = bench.set_texts(found)
    head = {**bench.HEAD, "set": json.loads(asked)["set"], "obtained": HOW}
    right = answers(found, {json.dumps(bench.query_of(row)): row for row in old})
    return {
        "scenes.json": stated,
        "queries.json": asked,
        "answers.json": bench.lines("answers", [*right], **head),
    }


if __name__ == "__main__":
    place = Path(*sys.argv[1:]) if sys.argv[1:] else Path(__file__).parent
    for file, text in texts(place).items():
        (place / file).write_text(text, encoding="utf-8")

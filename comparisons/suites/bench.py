"""The benchmark set: resolved scenes, queries addressed by structure, and the answers of models to them."""

import hashlib
import json
import math
import tomllib
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial

from comparisons.answer import ContactEvent, Response
from comparisons.answer.axis import place_of
from comparisons.answer.table import table, unit_names
from comparisons.files import writable_folder, write_text
from comparisons.models import TSM, find, solve
from comparisons.models.model import ModelError, Options
from comparisons.models.shared import joints, kept, line_loads
from comparisons.output import Report
from comparisons.referee.rod import face_of
from comparisons.scene import BeamSpec, Scene, load_scene
from comparisons.scene.conditions import COMPONENTS

Query = dict[str, Any]
SET = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
"""Name, version, conventions and scenes of the set."""
HEAD = {"benchmark": SET["name"], "version": SET["version"]}
KEYS = ("scene", "of", "what", "at", "number")
"""What a query has."""
EVENTS = ("touch", "release", "slip-off", "slip", "stick")


def query_of(row: Query) -> Query:
    """Return what an answer answers."""
    return {key: row[key] for key in KEYS if key in row}


@cache
def scenes() -> dict[str, tuple[Scene, tuple[int, ...]]]:
    """Return the scenes with the places, from 0, of the load parameters that are asked for."""
    return {row["name"]: (load_scene(row["name"]), tuple(k - 1 for k in row["at"])) for row in SET["scene"]}


def resolved(about: str, scene: Scene, at: Sequence[int]) -> dict[str, Any]:
    """Return all that a scene's answer depends on, and nothing that only a program needs."""
    corners = [(0.0, *pin.corners, 1.0 + len(pin.moves or ())) for pin in scene.pins]
    return {
        "name": scene.name,
        "about": about,
        "units": {kind: unit_names(scene.units)[kind] for kind in ("force", "length")},
        "load_parameters": [scene.times[k] for k in at],
        "beams": [_beam(beam) for beam in scene.beams],
        "joints": joints(scene),
        "hinges": [one.node for one in scene.hinges],
        "supports": [_held(one.node, one.motion) for one in scene.all_supports],
        "springs": [_held(one.node, (*one.stiffness, one.rotation)) for one in scene.springs],
        "loads": [
            *({"end": one.node, "force": one.force, "moment": one.moment} for one in scene.loads),
            *({"beam": beam.name, "force_per_length": q} for beam, _, (q,), _ in line_loads(scene)),
        ],
        "pins": [
            {"name": pin.name, "radius": pin.radius or 0.0, "path": [(t, *pin.position(t)) for t in turns]}
            for pin, turns in zip(scene.pins, corners, strict=True)
        ],
        "contacts": [
            {
                **kept(one, "pair node beam side"),
                "distance": _coefficients((face := face_of(scene, one)).start, face.slope * scene.beam(one.beam).length),
                "friction": one.friction,
            }
            for one in scene.contacts
        ],
    }  # fmt: skip


def _held(end: str, values: Sequence[Any]) -> dict[str, Any]:
    return {"end": end, **dict(zip(COMPONENTS, values, strict=True))}


def _beam(beam: BeamSpec) -> dict[str, Any]:
    """Return a beam with its stiffnesses, polynomials in the fraction of its length where it tapers."""
    EA, GA, EI = (Polynomial([value]) for value in (beam.EA, beam.GA, beam.EI))
    if beam.tapers:
        sides: Any = (one if isinstance(one, tuple) else (one, one) for one in (beam.height, beam.width))
        h, b = (Polynomial([start, end - start]) for start, end in sides)
        EA = beam.youngs_modulus * h * b
        GA, EI = EA * (GA / beam.EA), EA * h * h / 12.0
    stiffness = {"EA": EA, "GA": GA, "EI": EI}
    return {
        **kept(beam, "name start end length curvature"),
        "direction": beam.tangent(0.0),
        **{name: _coefficients(*one.coef.tolist()) for name, one in stiffness.items()},
    }


def _coefficients(*values: float) -> float | list[float]:
    return values[0] if not any(values[1:]) else list(values)


def queries(found: Mapping[str, Response]) -> list[Query]:
    """Return the queries. The right answers tell which contacts are closed and which events there are."""
    return [query for name, (scene, at) in scenes().items() for query in _queries(scene, at, found[name])]


def _queries(scene: Scene, at: Sequence[int], right: Response) -> Iterator[Query]:
    """Yield the queries about a scene, without what is zero at all load parameters."""
    columns = histories(scene, right)
    wanted = [
        *((one.pair, what) for one in scene.contacts for what in ("force_x", "force_y", "arc_position")),
        *((one.pair, "dissipated") for one in scene.contacts if one.friction),
        *((one.node, what) for one in scene.all_supports for what in ("force_x", "force_y", "moment")),
        *((end, f"displacement_{x}") for end in _free(scene) for x in "xy"),
    ]
    for of, what in wanted:
        values = columns[f"{of}.{what}"][list(at)]
        alike = (v for key, v in columns.items() if key.rpartition(".")[2].rstrip("xy") == what.rstrip("xy"))
        largest, scale = (max(np.nanmax(np.abs(v), initial=0.0) for v in one) for one in ([values], alike))
        if largest > 1e-9 * scale:
            known = np.flatnonzero(np.isfinite(values)).tolist()
            yield from ({"scene": scene.name, "of": of, "what": what, "at": k} for k in known)
    last, numbers = scene.times[at[-1]], Counter[tuple[str, str]]()
    jumps = {event.load_parameter for event in right.events or () if event.kind == "slip-off"}
    # by contact: round-off orders two events at one load parameter
    for event in sorted(right.events or (), key=attrgetter("pair")):
        key = (event.pair, event.kind)
        numbers[key] += 1
        # what else happens in the jump behind a slip-off is no state
        alone = event.kind == "slip-off" or event.load_parameter not in jumps
        if event.kind in EVENTS and alone and 0.0 < event.load_parameter < last:
            yield {"scene": scene.name, "of": event.pair, "what": event.kind, "number": numbers[key]}


def _free(scene: Scene) -> list[str]:
    """Return an end at every place whose position is not held."""
    held = {scene.place(one.node) for one in scene.all_supports if {"x", "y"} <= set(one.held)}
    nodes = [f"{beam.name}.{end}" for beam in scene.beams for end in ("start", "end")]
    return [node for place, node in {scene.place(node): node for node in nodes}.items() if place not in held]


def histories(scene: Scene, response: Response) -> dict[str, Any]:
    """Return what a response states, by ``OF.WHAT``, each of shape (s,)."""
    found, steps = table(response, along=False), range(len(response.load_parameter))
    for node in _free(scene):
        places = [place_of(response, scene, node, k) for k in steps]
        moved = np.reshape(places, (-1, 2)) - scene.place(node)
        found |= {f"{node}.displacement_{x}": moved[:, i] for i, x in enumerate("xy")}
    return found


def told(query: Query, response: Response, columns: Mapping[str, Any]) -> float | None:
    """Return a response's answer to a query; None where it states none."""
    _, at = scenes()[query["scene"]]
    if "at" in query:
        column = columns.get(f"{query['of']}.{query['what']}", ())
        k = at[query["at"]]
        return float(column[k]) if k < len(column) and math.isfinite(column[k]) else None
    found = event(query, response)
    return None if found is None else float(found.load_parameter)


def event(query: Query, response: Response) -> ContactEvent | None:
    """Return the event that is asked for; None where none is, or a response states none."""
    same = [one for one in response.events or () if (one.pair, one.kind) == (query["of"], query["what"])]
    return dict(enumerate(same, 1)).get(query.get("number", 0))


def lines(key: str, rows: Sequence[Mapping[str, Any]], **head: Any) -> str:
    """Return JSON text with a row on each line."""
    first = "".join(f" {json.dumps(name)}: {json.dumps(value)},\n" for name, value in head.items())
    return f"{{\n{first} {json.dumps(key)}: [\n  " + ",\n  ".join(map(json.dumps, rows)) + "\n ]\n}\n"


def set_texts(found: Mapping[str, Response]) -> tuple[str, str]:
    """Return the texts of ``scenes.json`` and ``queries.json``, which has the name of the set, a digest of both."""
    text = json.dumps([resolved(row["about"], *scenes()[row["name"]]) for row in SET["scene"]])
    # 15 digits do not depend on the machine
    rows = json.loads(text, parse_float=lambda number: float(f"{float(number):.15g}"))
    stated, asked = lines("scenes", rows, **HEAD, conventions=SET["conventions"]), queries(found)
    name = hashlib.sha256((stated + json.dumps(asked)).encode()).hexdigest()[:16]
    return stated, lines("queries", asked, **HEAD, set=name)


def answers(model: str, setting: Sequence[str], given: Mapping[str, Any], report: Report) -> str:
    """Return the answers of a model with its setting to the queries of a set, as JSON text; `report` takes a line for each scene.

    What is not stated has the reason. A model that refuses all scenes is a `ModelError`.
    """
    options, name = Options(**dict(map(_option, setting))), " ".join([find(model).label, *setting])
    rows, refused = list[Query](), dict[str, str]()
    for scene, _ in scenes().values():
        try:
            response = solve(scene, model, options)
        except ModelError as error:
            refused[scene.name] = str(error)
            continue
        columns = histories(scene, response)
        why = "is not stated" if response.completed else response.ended
        for query in (query for query in given["queries"] if query["scene"] == scene.name):
            value = told(query, response, columns)
            rows.append(query | ({"refused": why} if value is None else {"value": value}))
        report(f"{name}: {scene.name}: {response.status}")
    if len(refused) == len(scenes()):
        raise ModelError(refused[scene.name])
    return lines("answers", rows, **HEAD, set=given["set"], program=name, refused=refused)


def _option(word: str) -> tuple[str, Any]:
    """Return the option that a word of a setting is: elements, a mesh, or an element."""
    numbers = word.split("x")
    if not all(map(str.isdecimal, numbers)):
        return "element", word
    return ("mesh", tuple(map(int, numbers))) if len(numbers) > 1 else ("elements", int(word))


def write_bench(folder: Path, models: Sequence[str], report: Report) -> list[Path]:
    """Write the scenes and the queries, and the answers of models with their settings, as ``tsm mixed 20``; return the files."""
    asked = [one.split(" ") for one in dict.fromkeys(models)]
    named = ("-".join([find(model).name, *setting]) for model, *setting in asked)
    files = [writable_folder(folder) / f"{name}.json" for name in ("scenes", "queries", *named)]
    exact = {name: solve(scene, TSM.name, TSM.reference) for name, (scene, _) in scenes().items()}
    texts = list(set_texts(exact))
    texts += (answers(model, setting, json.loads(texts[1]), report) for model, *setting in asked)
    for file, text in zip(files, texts, strict=True):
        write_text(file, text)
    return files

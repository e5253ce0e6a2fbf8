"""Forged files: each is made from a true answer, and ``crossval certify`` refuses it in one line; the true ones are certified."""

import copy
import json
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from comparisons.cli import main
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.response.to_json import as_json
from comparisons.scene import Scene, load_scene, read_scene

Data = dict[str, Any]
Forgery = Callable[[Data], object]
KS, AGAIN, STEPS = "ks-cantilever", "touch-again", 10
PAIR, CLAMP, BEAM = "pin->cantilever", "cantilever.start", "cantilever"
STEEL = """
scene = { name = "steel", units = "N, mm", load_parameters = 4 }
beam = [{ name = "cantilever", start = [0, 0], end = [1000, 0], clamped = ["start"], width = 40, height = 15.8, youngs_modulus = 2.1e5, poissons_ratio = 0.3 }]
load = [{ beam = "cantilever", end = "end", force = [0, -50] }]
"""
"""A strip of 1 m that bends by .6 % of its length."""


@cache
def scene(name: str) -> Scene:
    """Return a scene; of the built-in cantilever with a fifth of its load parameters."""
    if name == "steel":
        return read_scene(STEEL, "steel")
    return replace(load_scene(name), load_parameters=STEPS) if name == KS else load_scene(name)


@cache
def truth(name: str, model: str) -> str:
    options = {"exact": Options(element="exact"), "mixed": Options(element="mixed", elements=10)}
    return as_json(solve(scene(name), "solid" if model == "solid" else "tsm", options.get(model)))


def certify(name: str, data: Data, folder: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    """Return the exit status of ``crossval certify`` and its verdict in one line."""
    from comparisons.scene import to_toml

    (folder / "scene.toml").write_text(to_toml(scene(name)), encoding="utf-8")
    (folder / "answer.json").write_text(json.dumps(data), encoding="utf-8")
    status = main(["certify", str(folder / "answer.json"), "--scene", str(folder / "scene.toml")])
    printed, said = capsys.readouterr()
    assert "Traceback" not in printed + said
    return status, (said or printed.splitlines()[1]).strip()


def scaled(factor: float, held: float = 1.0) -> Forgery:
    """Displacements times a factor, reactions times another."""

    def forge(data: Data) -> None:
        axis = data["axes"][BEAM]
        straight = np.stack([axis["arc_length"], 0.0 * np.array(axis["arc_length"])], axis=1)
        axis["position"] = (straight + factor * (np.array(axis["position"]) - straight)).tolist()
        data["tips"][BEAM] = [line[-1] for line in axis["position"]]
        support = data["supports"][CLAMP]
        for key in ("force", "moment"):
            support[key] = (held * np.array(support[key])).tolist()

    return forge


def times(factor: float, steps: slice, *, clamp: bool = True) -> Forgery:
    """Contact forces, and reactions, times a factor."""

    def forge(data: Data) -> None:
        tables = [(data["contacts"][PAIR], ("force", "vector"))]
        tables += [(data["supports"][CLAMP], ("force", "moment"))] if clamp else []
        for table, keys in tables:
            for key in keys:
                column = np.array(table[key])
                column[steps] *= factor
                table[key] = column.tolist()

    return forge


def histories(data: Data) -> list[tuple[Data, str]]:
    """Every list over the load parameters, as the table that has it and its key."""
    contact = [
        (item, key)
        for item in data["contacts"].values()
        for key in ("force", "vector", "arc_position", "gap")
    ]
    support = [(item, key) for item in data["supports"].values() for key in ("force", "moment")]
    other = [(data[name], key) for name in ("tips", "material_force") for key in data[name]]
    axes = [(item, "position") for item in data["axes"].values()]
    own = [(data, key) for key in ("index", "newton_iterations") if data[key] is not None]
    return [*contact, *support, *other, *axes, *own]


def exchanged(first: int, second: int) -> Forgery:
    def forge(data: Data) -> None:
        for table, key in histories(data):
            if table[key] is not None:
                table[key][first], table[key][second] = table[key][second], table[key][first]

    return forge


def half(data: Data) -> None:
    for table, key in [*histories(data), (data, "load_parameter"), (data, "stage")]:
        if table[key] is not None:
            table[key] = table[key][: STEPS // 2]
    data["events"] = [event for event in data["events"] or () if event["load_parameter"] <= 0.5]


def history(key: str, value: float | None, step: int = 6) -> Forgery:
    return lambda data: data["contacts"][PAIR][key].__setitem__(step, value)


def event(kind: str, t: float, **more: object) -> Data:
    return {
        "kind": kind,
        "load_parameter": t,
        "pair": PAIR,
        "element": 0,
        "arc_position": 0.5,
        "force": 0.001,
        "released": 0.0,
        "stage": 1,
        **more,
    }


def changed_events(change: Callable[[list[Data]], object]) -> Forgery:
    return lambda data: change(data["events"])


def both(*forgeries: Forgery) -> Forgery:
    return lambda data: [forge(data) for forge in forgeries]


def open_gap(data: Data) -> None:
    """Enlarge the first gap of an open contact."""
    gaps, force = data["contacts"][PAIR]["gap"], data["contacts"][PAIR]["force"]
    k = next(k for k in range(len(gaps)) if not force[k] and gaps[k])
    gaps[k] += 30.0


def releasing(events: list[Data]) -> Data:
    return next(item for item in events if item["kind"] in ("release", "slip-off"))


def claimed(**words: object) -> Forgery:
    """What an answer says of itself."""
    return lambda data: data.update(words)


ALL = slice(None)
OUTSIDE, CONTINUUM = claimed(outside=True), claimed(continuum=True)
STRANGER, SOLID = claimed(model="other"), claimed(model="solid")
FORGED: dict[str, tuple[str, str, Forgery]] = {
    "nothing moves": ("steel", "exact", scaled(0.0)),
    "nothing moves, by a program": ("steel", "exact", both(scaled(0.0), STRANGER)),
    "displacements times 3": ("steel", "exact", scaled(3.0)),
    "displacements times 3, by a program": ("steel", "exact", both(scaled(3.0), STRANGER)),
    "displacements times -1": ("steel", "exact", scaled(-1.0)),
    "displacements times -1, by a program": ("steel", "exact", both(scaled(-1.0), STRANGER)),
    "displacements times 1.2, by a program": ("steel", "exact", both(scaled(1.2), STRANGER)),
    "nothing moves, of a solid": ("steel", "solid", scaled(0.0)),
    "displacements times 3, of a solid": ("steel", "solid", scaled(3.0)),
    "displacements times -1, of a solid": ("steel", "solid", scaled(-1.0)),
    "nothing moves, as if of a solid": ("steel", "exact", both(scaled(0.0), SOLID, CONTINUUM)),
    "nothing acts": ("steel", "exact", scaled(0.0, held=0.0)),
    "reactions times 3": ("steel", "exact", scaled(1.0, held=3.0)),
    "forces times 3": (KS, "exact", times(3.0, ALL)),
    "forces times 3 at all but one": (KS, "exact", times(3.0, slice(STEPS - 1))),
    "forces times 3 at all but one, by a program": (KS, "exact", both(times(3.0, slice(STEPS - 1)), STRANGER)),
    "forces times 3 at one alone": (KS, "mixed", times(3.0, slice(4, 5))),
    "two states exchanged": (KS, "exact", exchanged(4, 7)),
    "two neighbours exchanged": (KS, "exact", exchanged(7, 8)),
    "half an answer": (KS, "exact", half),
    "half an answer, by a program": (KS, "exact", both(half, STRANGER)),
    "contact force times 1.009": (KS, "exact", times(1.009, ALL, clamp=False)),
    "contact force times 1.009, outside claimed": (KS, "exact", both(times(1.009, ALL, clamp=False), OUTSIDE)),
    "contact force times 1.009, a continuum claimed": (KS, "exact", both(times(1.009, ALL, clamp=False), CONTINUUM)),
    "contact force times 1.009, of a solid": (KS, "solid", times(1.009, ALL, clamp=False)),
    "contact force times 1.06, by a program": (KS, "exact", both(times(1.06, ALL), STRANGER)),
    "contact force times 1.06, a continuum claimed by a program": (KS, "exact", both(times(1.06, ALL), STRANGER, CONTINUUM)),
    "index 7": (KS, "exact", lambda data: data["index"].__setitem__(6, 7)),
    "index 7 everywhere": (KS, "exact", lambda data: data.update(index=[7] * STEPS)),
    "a gap of -.1 L at a closed contact": (KS, "exact", history("gap", -0.1)),
    "a gap of -.1 L, by a program": (KS, "exact", both(history("gap", -0.1), STRANGER)),
    "a gap of .1 L at a closed contact": (KS, "exact", history("gap", 0.1)),
    "a gap of .1 L, of a solid": (KS, "solid", history("gap", 0.1)),
    "no gap at a closed contact": (KS, "exact", history("gap", None)),
    "a gap of .3 L at an open contact": (AGAIN, "exact", open_gap),
    "a pull": (KS, "exact", history("force", -1.0)),
    "an arc position beyond the end": (KS, "exact", history("arc_position", 1.1)),
    "an invented release": (KS, "exact", changed_events(lambda events: events.append(event("release", 0.505)))),
    "an invented release and touch": (KS, "exact", changed_events(lambda events: events.extend([event("release", 0.501), event("touch", 0.502)]))),
    "an event of another pair": (KS, "exact", changed_events(lambda events: events.append(event("touch", 0.5, pair="pin->other")))),
    "an event after the end": (KS, "exact", changed_events(lambda events: events.append(event("release", 1.5)))),
    "an event of an unknown kind": (KS, "exact", changed_events(lambda events: events.append(event("weld", 0.5)))),
    "a deleted event": (AGAIN, "exact", changed_events(lambda events: events.pop())),
    "all events deleted": (AGAIN, "exact", changed_events(lambda events: events.clear())),
    "a displaced event": (AGAIN, "exact", changed_events(lambda events: events[-1].update(load_parameter=events[-1]["load_parameter"] + 0.2))),
    "an event at another place": (AGAIN, "exact", changed_events(lambda events: events[-1].update(arc_position=events[-1]["arc_position"] - 30.0))),
    "an event with another force": (AGAIN, "exact", changed_events(lambda events: releasing(events).update(force=1.0))),
    "a material force": (KS, "exact", lambda data: data["material_force"].update(cantilever=[1e6] * STEPS)),
    "a material force at one alone": (KS, "exact", lambda data: data["material_force"][BEAM].__setitem__(6, 1e-3)),
    "a status": (KS, "exact", lambda data: data.update(status="NOT_CONVERGED")),
    "no reported success": (KS, "exact", lambda data: data.update(reported_success=False)),
    "no tips": (KS, "exact", lambda data: data.update(tips={})),
    "no axes": (KS, "exact", lambda data: data.update(axes={})),
    "a beam of another name": (KS, "exact", lambda data: data.update(tips={"b": data["tips"][BEAM]})),
    "the referee's own": ("portal-frame", "exact", lambda data: data.update(model="rod")),
}  # fmt: skip
"""The scene, the model whose true answer is forged, and the forgery."""


def test_there_are_forty() -> None:
    assert len(FORGED) >= 40


@pytest.mark.parametrize("forgery", FORGED)
def test_a_forged_file_is_refused(forgery: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name, model, forge = FORGED[forgery]
    data = copy.deepcopy(json.loads(truth(name, model)))
    forge(data)
    status, line = certify(name, data, tmp_path, capsys)
    assert status in (1, 2, 3), line
    assert not line.startswith("CERTIFIED")
    assert len(line.splitlines()) == 1


@pytest.mark.parametrize(("name", "model"), sorted({(name, model) for name, model, _ in FORGED.values()}))
def test_the_true_file_is_certified(
    name: str, model: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status, line = certify(name, json.loads(truth(name, model)), tmp_path, capsys)
    assert (status, line.split(" within")[0]) == (0, "CERTIFIED"), line
    data = json.loads(truth(name, model))
    if model != "solid":
        data.update(model="other", outside=False, continuum=True)
        assert certify(name, data, tmp_path, capsys)[0] == 0

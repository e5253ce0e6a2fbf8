"""Forged and damaged files: each is made from a true answer, and ``crossval certify`` refuses it in one line, which says why."""

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
from comparisons.models.model import Options
from comparisons.referee import certify
from comparisons.scene import ContactSpec, PinSpec, Scene, load_scene, to_toml
from tests.comparisons.referee.forged import scene_of

Data = dict[str, Any]
Forgery = Callable[[Data], object]
PAIR, BEAM, CLAMP, STEPS = "pin->cantilever", "cantilever", "cantilever.start", 10


def cantilever(
    friction: float = 0.0, steps: int = STEPS, *path: tuple[float, float], side: str = "right"
) -> Scene:
    scene = load_scene("ks-cantilever")
    pin = PinSpec(name="pin", path=path) if path else scene.pins[0]
    spec = ContactSpec(node="pin", beam=BEAM, side=side, friction=friction)
    return replace(scene, load_parameters=steps, pins=(pin,), contacts=(spec,))


EXACT = ("--element", "exact")
SOURCES: dict[str, tuple[Scene, tuple[str, ...]]] = {
    "ks": (cantilever(), EXACT),
    "mixed": (cantilever(), ("--element", "mixed", "--elements", "10")),
    "solid": (cantilever(), ("--model", "solid")),
    "again": (load_scene("touch-again"), EXACT),
    "portal": (load_scene("portal-frame"), EXACT),
    "steel": (scene_of("steel"), EXACT),
    "steel solid": (scene_of("steel"), ("--model", "solid")),
    "rubbed": (cantilever(0.3, 20), EXACT),
    "smooth": (cantilever(0.0, 20), EXACT),
}
"""Scenes, and the options of the model whose true answers are forged."""
SCENES = {"left": cantilever(0.0, STEPS, (1.0, 0.0), (0.0, 2.0 / np.pi), side="left")}
"""Scenes that are judged with answers of others."""


@cache
def truth(name: str) -> str:
    scene, options = SOURCES[name]
    folder = Path(FOLDER[0])
    (folder / "truth.toml").write_text(to_toml(scene), encoding="utf-8")
    out = folder / "truth.json"
    assert main(["solve", str(folder / "truth.toml"), *options, "--certify", "none", "--quiet", "--out", str(out)]) == 0  # fmt: skip
    return out.read_text(encoding="utf-8")


FOLDER: list[str] = []


@pytest.fixture(autouse=True, scope="module")
def _folder(tmp_path_factory: pytest.TempPathFactory) -> None:
    FOLDER[:] = [str(tmp_path_factory.mktemp("forged"))]


Certify = Callable[..., tuple[int, str]]


@pytest.fixture
def judged(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Certify:
    def run(name: str, text: str, *options: str) -> tuple[int, str]:
        """Return the exit status of ``crossval certify`` and its verdict or complaint, one line."""
        scene = SCENES[name] if name in SCENES else SOURCES[name][0]
        (tmp_path / "scene.toml").write_text(to_toml(scene), encoding="utf-8")
        (tmp_path / "answer.json").write_text(text, encoding="utf-8")
        capsys.readouterr()
        status = main(
            ["certify", str(tmp_path / "answer.json"), "--scene", str(tmp_path / "scene.toml"), *options]
        )
        printed, said = capsys.readouterr()
        assert "Traceback" not in printed + said
        assert said.count("\n") == (status == 2)
        assert len(said) < 800
        assert (printed == "") == (status == 2)
        return status, said or printed.splitlines()[1].strip()

    return run


def put(*path: str | int, to: object) -> Forgery:
    """Put a value, or a function of what is there, at the end of a path of keys and numbers."""

    def forge(data: Any) -> None:
        for key in path[:-1]:
            data = data[key]
        new = to(data[path[-1]]) if callable(to) else to
        data[path[-1]] = new.tolist() if isinstance(new, np.ndarray) else new

    return forge


def by(factor: float, steps: slice = slice(None)) -> Callable[[Any], np.ndarray]:
    """A list times a factor at some load parameters."""

    def times(values: Any) -> np.ndarray:
        column = np.array(values, dtype=float)
        column[steps] *= factor
        return column

    return times


def plus(size: float) -> Callable[[Any], np.ndarray]:
    return lambda values: np.array(values) + size


def both(*forgeries: Forgery) -> Forgery:
    return lambda data: [forge(data) for forge in forgeries]


def pin(key: str, to: object, *step: int) -> Forgery:
    return put("contacts", PAIR, key, *step, to=to)


def clamp(key: str, to: object, *step: int) -> Forgery:
    return put("supports", CLAMP, key, *step, to=to)


def rubs(key: str, to: object) -> Forgery:
    return put("contacts", PAIR, "friction", key, to=to)


def claimed(**words: object) -> Forgery:
    """What an answer says of itself."""
    return lambda data: data.update(words)


def instead(name: str) -> Forgery:
    """The answer to another scene."""
    return lambda data: data.update(json.loads(truth(name)))


def pushed(factor: float, steps: slice = slice(None)) -> Forgery:
    """The contact force times a factor."""
    return both(*(pin(key, by(factor, steps)) for key in ("force", "vector")))


def held(factor: float, steps: slice = slice(None)) -> Forgery:
    """The reactions times a factor."""
    return both(*(clamp(key, by(factor, steps)) for key in ("force", "moment")))


def moved(factor: float) -> Forgery:
    """Displacements times a factor."""

    def forge(data: Data) -> None:
        axis = data["axes"][BEAM]
        straight = np.stack([axis["arc_length"], 0.0 * np.array(axis["arc_length"])], axis=1)
        axis["position"] = (straight + factor * (np.array(axis["position"]) - straight)).tolist()
        data["tips"][BEAM] = [line[-1] for line in axis["position"]]

    return forge


def lost(data: Data) -> None:
    """No force from the beginning, and the beam straight."""
    moved(0.0)(data)
    held(0.0)(data)
    pushed(0.0)(data)
    data["contacts"][PAIR].update(arc_position=[None] * STEPS, gap=[None] * STEPS)
    data.update(events=[], material_force={}, index=[0] * STEPS, load_parameter=(np.arange(1.0, STEPS + 1.0) / STEPS).tolist())  # fmt: skip


def reordered(*order: int) -> Forgery:
    """States in another order, or some of them."""
    own = ("load_parameter", "stage")

    def taken(data: Any) -> Any:
        if isinstance(data, dict):
            return {key: value if key in own and len(order) == STEPS else taken(value) for key, value in data.items()}  # fmt: skip
        return [data[k] for k in order] if isinstance(data, list) and len(data) == STEPS else data

    return lambda data: data.update(taken(data))


def exchanged(first: int, second: int) -> Forgery:
    order = list(range(STEPS))
    order[first], order[second] = second, first
    return reordered(*order)


def event(kind: str, t: float, **more: object) -> Data:
    own = {"kind": kind, "load_parameter": t, "pair": PAIR, "element": 0, "arc_position": 0.5}
    return own | {"force": 0.001, "released": 0.0, "stage": 1} | more


def events(change: Callable[[list[Data]], object]) -> Forgery:
    return lambda data: change(data["events"])


def shifted(kind: str, **by: float) -> Forgery:
    """The last event of a kind elsewhere."""

    def forge(data: Data) -> None:
        own = [item for item in data["events"] if item["kind"] == kind][-1]
        own.update({key: own[key] + size for key, size in by.items()})

    return forge


PROGRAM, OUTSIDE = claimed(model="other"), claimed(outside=True, continuum=True)
CONE, STEEP = np.arctan(0.3), 1.05 * np.arctan(0.3)
BUT_ONE = slice(STEPS - 1)
WRONG, NOT = "NOT_AN_EQUILIBRIUM: ", "INADMISSIBLE: "
BALANCE = "NOT_AN_EQUILIBRIUM: the support reactions do not balance contact forces and loads"
FORGED: dict[str, tuple[str, Forgery, str]] = {
    "nothing moves": ("steel", moved(0.0), WRONG + "displacement off by 25 % (cantilever), allowed 5 %"),
    "nothing moves, of a solid": ("steel solid", moved(0.0), WRONG + "displacement off by 25 % (cantilever), allowed 6.58 %"),
    "reactions times 3": ("steel", held(3.0), WRONG + "reaction off by 50 % (moment of cantilever.start)"),
    "forces times 3 at all but one": ("ks", both(pushed(3.0, BUT_ONE), held(3.0, BUT_ONE)), WRONG + "force off by 2e+02 % (pin->cantilever)"),
    "two states exchanged": ("ks", exchanged(4, 7), WRONG + "supports and contacts are off by 0.36 L (pin->cantilever) at load parameter 0.5"),
    "half an answer": ("ks", reordered(*range(STEPS // 2)), "load_parameter: has 5 of 10 load parameters, and the status is COMPLETED"),
    "contact force times 1.009, outside claimed": ("ks", both(pushed(1.009), OUTSIDE), BALANCE),
    "contact force times 1.06, by a program": ("ks", both(pushed(1.06), held(1.06), PROGRAM, claimed(outside=False)), WRONG + "force off by 6 % (pin->cantilever), allowed 5 %"),
    "contact force times 1.08, of a program's body": ("ks", both(pushed(1.08), held(1.08), PROGRAM, OUTSIDE), WRONG + "force off by 8 % (pin->cantilever), allowed 7 %"),
    "all arc positions .3": ("ks", pin("arc_position", [0.3] * STEPS), WRONG + "supports and contacts are off by 0.6 L"),
    "tip moved by 7": ("ks", put("tips", BEAM, to=plus(7.0)), WRONG + "tip off by 9.9e+02 %"),
    "lost contact": ("ks", lost, NOT + "pin->cantilever is open and its node goes through the beam up to load parameter 0.1"),
    "a slip-off without an event": ("ks", both(lost, pin("slip_off", 0.0)), NOT + "pin->cantilever slips off at load parameter 0 without an event"),
    "a pin from the other side": ("left", instead("ks"), NOT + "the contact force of pin->cantilever pulls, -7.28e-05"),
    "closed without an event": ("ks", pin("force", 0.0, 4), WRONG + "tip off by 66 %"),
    "index 7": ("ks", put("index", 6, to=7), WRONG + "index 7 is stated, the equilibrium has 0 at load parameter 0.7"),
    "a gap of -.1 L at a closed contact": ("ks", pin("gap", -0.1, 6), WRONG + "gap off by 10 % (pin->cantilever)"),
    "a gap of 30 at an open contact": ("again", put("contacts", PAIR, "gap", 0, to=30.0), WRONG + "gap off by 28 %"),
    "an arc position beyond the end": ("ks", pin("arc_position", 1.1, 6), WRONG + "the arc position of pin->cantilever is not on its beam"),
    "an invented release": ("ks", events(lambda own: own.append(event("release", 0.505))), NOT + "release of pin->cantilever at load parameter 0.505: arc position off by 0.11"),
    "an event of another pair": ("ks", events(lambda own: own.append(event("touch", 0.5, pair="pin->other"))), NOT + "no contact of the scene has the event touch"),
    "a deleted event": ("again", events(lambda own: own.pop()), NOT + "pin->cantilever closes without an event up to load parameter 0.65"),
    "an event at another place": ("again", shifted("touch", arc_position=-30.0), NOT + "touch of pin->cantilever at load parameter 0.636364: arc position off by 0.3"),
    "an event with another force": ("again", shifted("release", force=1.0), NOT + "release of pin->cantilever at load parameter 0.454545: contact force off"),
    "a material force at one alone": ("ks", put("material_force", BEAM, 6, to=1e-3), WRONG + "the material force of cantilever"),
    "a status": ("ks", claimed(status="NOT_CONVERGED"), "NOT_JUDGED: the answer stopped: NOT_CONVERGED, off by less than 1e-07 % where it was judged"),
    "no reported success": ("ks", claimed(reported_success=False), NOT + "the status is COMPLETED, and reported_success is false"),
    "the referee's own": ("portal", claimed(model="rod"), "NOT_JUDGED: exact equilibria along TSM's path"),
    "slip reversed": ("rubbed", rubs("slip", by(-1)), NOT + "pin->cantilever sticks from load parameter 0.620498, exactly from 0.632501"),
    "stick outside the cone": ("rubbed", both(rubs("slip", [0] * 20), rubs("tangential", by(np.sin(STEEP) / np.sin(CONE))), rubs("normal", by(np.cos(STEEP) / np.cos(CONE))), claimed(events=None)), NOT + "pin->cantilever sticks with a force outside its cone"),
    "dissipation": ("rubbed", both(rubs("dissipated", by(1.5)), claimed(work=None)), NOT + "the dissipation of pin->cantilever up to load parameter 0.75 is off by 0.0078 of the work"),
    "stick is not stated": ("rubbed", events(lambda own: own.pop(0)), NOT + "pin->cantilever sticks without an event up to load parameter 0.65"),
    "stick is stated too early": ("rubbed", shifted("stick", load_parameter=-0.015), NOT + "pin->cantilever sticks from load parameter 0.605498, exactly from 0.620498"),
    "slip is stated too late": ("rubbed", shifted("slip", load_parameter=0.015), NOT + "pin->cantilever slips from load parameter 0.698287, exactly from 0.683287"),
    "no axes": ("ks", lambda data: data.pop("axes"), "axes = (missing): must be a table"),
    "empty axes": ("ks", claimed(axes={}), "axes: must have cantilever, has none"),
    "a short list": ("ks", pin("force", [1.0]), "force = [1.0]: must be a list of 10 numbers, one for each load parameter, has 1"),
    "other load parameters": ("ks", put("load_parameter", to=by(0.999)), "load_parameter: must be those of the scene"),
    "a truth value": ("ks", put("tips", BEAM, 3, 0, to=True), "must be a list of 10 x 2 numbers"),
    "no number": ("ks", clamp("moment", None, 7), "supports.cantilever.start.moment[7] = nan: must be a finite number"),
    "a huge whole number": ("ks", claimed(cutbacks=10**40), "must be a whole number"),
    "a falling arc": ("ks", lambda data: data["axes"][BEAM]["arc_length"].reverse(), "must be two or more increasing numbers"),
    "a misspelt key": ("ks", lambda data: data.update(evnts=data.pop("events")), "unknown key, did you mean events?"),
    "another scene": ("ks", claimed(scene="ks-friction"), "scene = ks-friction: the scene was ks-cantilever"),
}  # fmt: skip
"""The source, the forgery, and words of the line."""
TEXTS: dict[str, tuple[Callable[[str], str], str]] = {
    "half a file": (lambda text: text[: len(text) // 2], "must be valid JSON: "),
    "brackets": (lambda _: "[" * 100_000, "must be valid JSON: "),
    "lists in lists": (lambda _: '{"status": ' + "[" * 900 + "]" * 900 + "}", "must be"),
    "a list": (lambda _: "[1, 2]", "file = [1, 2]: must be a table"),
    "17 MB": (lambda text: " " * 17_000_000 + text, "has more than 16 MB"),
    "a key twice": (lambda text: text.rstrip()[:-1] + ', "cutbacks": 0}', "cutbacks = 0: must stand once in its table"),
    "infinite": (lambda text: text.replace("0.1", "1e400", 1), "load_parameter[0] = inf: must be a finite number"),
    "5000 digits": (lambda text: text.replace("0.1", "1" * 5000, 1), "must be valid JSON: "),
}  # fmt: skip
NEAR = ("--allowance", "0.01")


@pytest.mark.slow_at("slip is stated too late", "stick is not stated", "stick is stated too early")
@pytest.mark.parametrize("forgery", FORGED)
def test_a_forged_file_is_refused(forgery, judged):
    name, forge, words = FORGED[forgery]
    data = json.loads(truth(name if name in SOURCES else "ks"))
    forge(data)
    status, line = judged(name, json.dumps(data), *(NEAR if name == "rubbed" else ()))
    assert words in line
    assert status == {"crossval": 2, "NOT_JUDGED": 3}.get(line.split(":")[0], 1)


@pytest.mark.parametrize("damage", TEXTS)
def test_a_damaged_file_is_one_line(damage, judged):
    change, words = TEXTS[damage]
    text = change(truth("ks"))
    assert text != truth("ks")
    status, line = judged("ks", text)
    assert status == 2
    assert words in line


@pytest.mark.slow_at("rubbed")
@pytest.mark.parametrize(
    "name", ["ks", "mixed", "solid", "again", "portal", "steel", "steel solid", "rubbed"]
)
def test_the_true_file_is_certified(name, judged):
    """Whatever it claims to be."""
    status, line = judged(name, truth(name), *(NEAR if name == "rubbed" else ()))
    assert (status, line.split(" within")[0]) == (0, "CERTIFIED"), line
    if name in ("ks", "portal"):
        data = json.loads(truth(name)) | {"model": "other", "outside": False, "continuum": True}
        assert judged(name, json.dumps(data))[0] == 0


def test_a_stored_response_is_judged_as_the_response_itself(tmp_path, judged):
    scene, out = SOURCES["mixed"][0], tmp_path / "certificate.json"
    assert judged("mixed", truth("mixed"), "--out", str(out))[0] == 0
    read = json.loads(out.read_text(encoding="utf-8"))
    whole = certify(solve(scene, "tsm", Options(element="mixed", elements=10)), scene)
    assert read["verdict"] == "CERTIFIED"
    for name in ("force", "arc_position", "reaction", "tip"):
        size = whole.judged[-1].distance.sizes[name]
        assert read["judged"][-1]["distance"][name] == pytest.approx(size, rel=1e-6)
    arc = read["judged"][-1]["exact"]["contacts"][PAIR]["arc_position"]
    assert arc == pytest.approx(whole.judged[-1].exact.contacts[PAIR].arc_position, rel=1e-13)

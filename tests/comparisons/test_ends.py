"""A pin that meets the end of a beam: named, with its load parameter, by every model, in scenes drawn in any place, size and direction."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from comparisons.answer import Response
from comparisons.cli import main
from comparisons.models import solve
from comparisons.models.model import Options
from comparisons.scene import (
    BeamSpec,
    ContactSpec,
    LoadSpec,
    PinSpec,
    Scene,
    SupportSpec,
    load_scene,
    to_toml,
)
from tests.laws.transform import Change, swapped

MODELS = {
    "exact": ("tsm", Options(element="exact")),
    "mixed": ("tsm", Options(elements=10)),
    "rod": ("rod", Options()),
    "solid": ("solid", Options(mesh=(25, 2))),
}
WITHIN = 1e-8
COARSE = {
    "moment": {"mixed": 1e-6, "solid": 2e-3},
    "slip-off": {"mixed": 1e-3, "solid": 1e-2},
    "clamp": {"solid": 2e-8},
}
"""By kind: a strip of finite height wound into an arc, and a pin that bends the beam and slides to its corner."""
KINDS = {
    "pin": "the pin moves to the end of a beam at rest",
    "clamp": "the clamp carries the end to a pin at rest",
    "both": "the pin and the clamp move",
    "through": "in one load step the pin goes through the end and is clear of it again",
    "past": "the pin passes the end at a distance above its radius and meets nothing",
    "moment": "a moment at the end winds the beam into an arc until it meets a pin at rest",
    "slip-off": "the pin pushes the beam and slides to its corner",
}


def approach(seed: int) -> tuple[str, Scene, float | None]:
    """Kind, scene and load parameter of its end contact: nan at a slip-off, which the exact rod states, None where nothing meets.

    The beam of length 1 ends at the origin. The pin's circle touches the end, a point or a segment across, from beyond along `normal`.
    """
    kind, rng = list(KINDS)[seed % len(KINDS)], np.random.default_rng(seed)
    face, radius = bool(rng.integers(2)), float(10 ** rng.uniform(-2, -0.7))
    half = float(10 ** rng.uniform(-2, -1)) / 2.0
    high = half if face else 0.0
    steep = rng.choice([-1.0, 1.0]) * rng.uniform(0.5, 1.5) if kind == "moment" else rng.uniform(-1.5, 1.5)
    flat = face and kind != "moment" and rng.integers(3) == 0
    normal = np.array([1.0, 0.0]) if flat else np.array([math.cos(steep), math.sin(steep)])
    touched = np.array([0.0, rng.uniform(-0.9, 0.9) * half if flat else math.copysign(high, steep)])
    radius *= 0.0 if flat and kind in ("pin", "clamp") and rng.integers(2) else 1.0
    along = np.array([abs(normal[1]), math.copysign(normal[0], -normal[1] * normal[0])])
    before, after = rng.uniform(0.05, 0.5, 2)
    t, moves, moment = before / (before + after), np.zeros(2), 0.0
    if kind in ("pin", "clamp", "both"):
        lean, share = rng.uniform(-0.9, 0.9), {"pin": 0.0, "clamp": 1.0, "both": rng.uniform(0.2, 0.8)}[kind]
        way = (before + after) * (math.cos(lean) * normal + math.sin(lean) * along)
        moves, centre = share * way, touched + radius * normal
        pins = [centre + t * way, centre + t * way if kind == "clamp" else centre - (1.0 - t) * way + moves]
    elif kind in ("through", "past"):
        deep = radius * (rng.uniform(0.1, 0.6) if kind == "through" else -(10 ** rng.uniform(-6, -2)))
        centre = touched + (radius - deep) * normal
        pins = [centre + 0.5 * along, centre - 0.5 * along]
        t = None if kind == "past" else met(lambda t: room((1.0 - t) * pins[0] + t * pins[1], high, radius))
    elif kind == "slip-off":
        x, angle, far = rng.uniform(-0.3, -0.05), rng.uniform(0.3, 1.2), rng.uniform(0.6, 0.9)
        start, t = np.array([x, -radius - high]), math.nan
        pins = [start, start + far * np.array([math.cos(angle), math.sin(angle)])]
    else:
        moment = rng.choice([-1.0, 1.0]) * rng.uniform(0.4, 1.2)
        tip, axes = wound(moment * rng.uniform(0.3, 0.9))
        facing = np.array([1.0, math.copysign(1.0, moment * (axes @ normal)[1])])
        pins = [tip + axes @ (facing * (touched + radius * normal))] * 2

        def left(t: float) -> float:
            tip, axes = wound(moment * t)
            x, y = axes.T @ (pins[0] - tip)
            return room(np.array([x, y]), high, radius) if x > 0.0 else math.inf

        t = met(left)
    beam = BeamSpec(
        name="b", start=(-1.0, 0.0), end=(0.0, 0.0), width=0.1, height=2.0 * half, youngs_modulus=1.0, poissons_ratio=0.3,
    )  # fmt: skip
    over = pins[0][0] > 0.0
    scene = Scene(
        name=kind, load_parameters=1 if kind == "through" else int(rng.integers(1, 8)), beams=(beam,),
        supports=(SupportSpec(beam="b", end="start", kind="clamped", displacement=tuple(moves)),),
        loads=(LoadSpec(beam="b", end="end", moment=moment * beam.EI),) if moment else (),
        pins=(PinSpec(name="ball", start=tuple(pins[0]), displacement=tuple(pins[1] - pins[0]), radius=radius or None),),
        contacts=(
            ContactSpec(
                node="ball", beam="b", surface="face" if face else "axis",
                side="left" if (rng.integers(2) if over else pins[0][1] > 0.0) else "right",
            ),
        ),
    )  # fmt: skip
    x, y = rng.uniform(-2.0, 2.0, 2)
    place = Change(
        length=10 ** rng.uniform(-1, 2),
        angle=rng.uniform(0, 2 * math.pi),
        mirror=bool(rng.integers(2)),
        shift=(x, y),
    )
    return kind, swapped(place.scene(scene), ["b"] if rng.integers(2) else []), t


def room(ball: np.ndarray, high: float, radius: float) -> float:
    """Distance of a circle from the end, a segment across."""
    return math.hypot(ball[0], max(abs(ball[1]) - high, 0.0)) - radius


def wound(angle: float) -> tuple[np.ndarray, np.ndarray]:
    """Tip of a beam of length 1 bent into an arc by an angle, from where it was, and the axes of the tip."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([s / angle - 1.0, (1.0 - c) / angle]), np.array([[c, -s], [s, c]])


def met(gap) -> float:
    """Load parameter at which a gap first closes."""
    times = np.linspace(1e-3, 1.0, 2000)
    k = next(k for k, t in enumerate(times) if gap(t) < 0.0)
    return float(brentq(gap, times[k - 1], times[k], xtol=1e-15))


def met_at(response: Response) -> float:
    """Load parameter that the message states, to its digits."""
    found = re.search(r"meets the \w+ of b\D* at load parameter ([0-9.e-]*\d)", response.message)
    assert found, response.message
    events = [event.load_parameter for event in response.events or () if event.kind == "end-contact"]
    assert events == pytest.approx([float(found[1])] * len(events), rel=1e-8)
    return events[-1] if events else float(found[1])


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(
    "seed", [*range(7), *(pytest.param(k, marks=pytest.mark.slow) for k in range(7, 42))]
)
def test_approaches_end_where_the_pin_meets_the_end(seed, model):
    kind, scene, expected = approach(seed)
    found = solve(scene, *MODELS[model])
    if expected is None:
        assert found.status == "COMPLETED"
        return
    assert found.status == "END_CONTACT", found.message
    if math.isnan(expected):
        expected = met_at(solve(scene, "rod"))
    assert met_at(found) == pytest.approx(expected, abs=COARSE.get(kind, {}).get(model, WITHIN))
    assert found.load_parameter.max(initial=0.0) < met_at(found)


def test_check_names_a_path_that_comes_to_an_end(tmp_path, capsys):
    said, nose = [], load_scene(str(Path(__file__).parent / "referee" / "scenes" / "nose.toml"))
    for path in (((40.5, -4.0), (40.5, 0.0)), ((42.6, -4.0), (42.6, 5.0))):
        (tmp_path / "nose.toml").write_text(
            to_toml(replace(nose, pins=(PinSpec(name="ball", path=path, radius=2.5),)))
        )
        main(["check", str(tmp_path / "nose.toml")])
        printed = " ".join(capsys.readouterr().out.split())
        said.append("ball meets the end of b, if it has not moved" in printed)
    assert said == [True, False]

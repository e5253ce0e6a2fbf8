"""Pins that approach the free end of a beam, drawn at random, with the load parameter at which they meet it.

In the frame of the end, which points along the beam, the end is a point or a segment across. The place of the pin is laid so that its
circle touches there from beyond the end. The outline of the beam lies behind the normal, so that a straight approach touches nothing
before.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene, SupportSpec

KINDS = {
    "pin": "the pin moves to the end of a beam at rest",
    "clamp": "the clamp carries the end to a pin at rest",
    "both": "the pin and the clamp move",
    "through": "in one load step the pin goes through the end and is clear of it again",
    "past": "the pin passes the end at a distance above its radius and meets nothing",
    "moment": "a moment at the end winds the beam into an arc until it meets a pin at rest",
    "slip-off": "the pin pushes the beam and slides to its corner",
}


@dataclass(frozen=True, kw_only=True)
class Approach:
    """A scene and the load parameter of its end contact: nan at a slip-off, None where nothing meets."""

    kind: str
    scene: Scene
    load_parameter: float | None


def approach(seed: int) -> Approach:
    """Return approach number `seed`; the kinds follow one another."""
    kind, rng = list(KINDS)[seed % len(KINDS)], np.random.default_rng(seed)
    face, radius = bool(rng.integers(2)), float(10 ** rng.uniform(-2, -0.7))
    half = float(10 ** rng.uniform(-2, -1)) / 2.0
    steep = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.5, 1.5))
    turn = steep if kind == "moment" else float(rng.uniform(-1.5, 1.5))
    flat = face and kind != "moment" and rng.integers(3) == 0
    normal = np.array([1.0, 0.0] if flat else [math.cos(turn), math.sin(turn)])
    across = float(rng.uniform(-0.9, 0.9)) * half if flat else math.copysign(half, turn) if face else 0.0
    if flat and kind in ("pin", "clamp") and rng.integers(2):
        radius = 0.0
    touched = np.array([0.0, across])
    along = np.array([abs(normal[1]), math.copysign(normal[0], -normal[1] * normal[0])])
    before, after = (float(way) for way in rng.uniform(0.05, 0.5, 2))
    t, pins, moves, moment = before / (before + after), np.zeros((2, 2)), np.zeros(2), 0.0
    if kind in ("pin", "clamp", "both"):
        lean = float(rng.uniform(-0.9, 0.9))
        way = math.cos(lean) * normal + math.sin(lean) * along
        centre = touched + radius * normal
        way *= before + after
        share = {"pin": 0.0, "clamp": 1.0, "both": float(rng.uniform(0.2, 0.8))}[kind]
        moves = share * way
        pins = np.array([centre + t * way, centre - (1.0 - t) * way + moves])
        if kind == "clamp":
            pins[1] = pins[0]
    elif kind in ("through", "past"):
        deep = radius * float(rng.uniform(0.1, 0.6) if kind == "through" else -(10 ** rng.uniform(-6, -2)))
        centre = touched + (radius - deep) * normal
        pins = np.array([centre + 0.5 * along, centre - 0.5 * along])
        t = _first(pins, half if face else 0.0, radius) if kind == "through" else None
    elif kind == "slip-off":
        depth = radius + (half if face else 0.0)
        x, angle, far = rng.uniform(-0.3, -0.05), rng.uniform(0.3, 1.2), rng.uniform(0.6, 0.9)
        start = np.array([x, -depth])
        pins, t = np.array([start, start + far * np.array([math.cos(angle), math.sin(angle)])]), math.nan
    else:
        t = float(rng.uniform(0.3, 0.9))
        moment = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.4, 1.2))
        tip, turned = _wound(moment * t)
        if (turned @ normal)[1] * moment < 0:
            normal, touched = normal * [1.0, -1.0], touched * [1.0, -1.0]
        pins = np.array([tip + turned @ (touched + radius * normal)] * 2)
        t = _met(moment, pins[0], half if face else 0.0, radius)
    return Approach(
        kind=kind,
        scene=_scene(rng, kind, pins, radius, half if face else None, half, moves, moment),
        load_parameter=t,
    )


def _wound(angle: float) -> tuple[np.ndarray, np.ndarray]:
    """Tip of a beam of length 1 bent into an arc by an angle, from where it was, and the axes of the tip."""
    x, y = math.sin(angle) / angle, (1.0 - math.cos(angle)) / angle
    c, s = math.cos(angle), math.sin(angle)
    return np.array([x - 1.0, y]), np.array([[c, -s], [s, c]])


def _met(moment: float, ball: np.ndarray, half: float, radius: float) -> float:
    """Load parameter at which the end of the arc first meets a ball at rest."""

    def room(t: float) -> float:
        tip, turned = _wound(moment * t)
        x, y = turned.T @ (ball - tip)
        return math.hypot(x, max(abs(y) - half, 0.0)) - radius if x > 0.0 else math.inf

    times = np.linspace(1e-3, 1.0, 2000)
    k = next(k for k, t in enumerate(times) if room(t) < 0.0)
    return float(brentq(room, times[k - 1], times[k], xtol=1e-15))


def _first(path: np.ndarray, half: float, radius: float) -> float:
    """Part of a straight path at which a circle first touches the segment across the end."""

    def room(t: float) -> float:
        x, y = (1.0 - t) * path[0] + t * path[1]
        return math.hypot(x, max(abs(y) - half, 0.0)) - radius

    return float(brentq(room, 0.0, 0.5, xtol=1e-15))


def _scene(
    rng: np.random.Generator,
    kind: str,
    pins: np.ndarray,
    radius: float,
    face: float | None,
    half: float,
    moves: np.ndarray,
    moment: float,
) -> Scene:
    """Scene of any size, place and direction, stated from either end; positions are from the undeformed end, along and across."""
    length, angle = float(10 ** rng.uniform(-1, 2)), float(rng.uniform(0, 2 * math.pi))
    mirror, backwards, place = float(rng.choice([-1.0, 1.0])), bool(rng.integers(2)), rng.uniform(-2, 2, 2)
    turn = length * np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])

    def vector(v: np.ndarray) -> tuple[float, float]:
        x, y = turn @ (v * [1.0, mirror])
        return float(x), float(y)

    def point(v: np.ndarray) -> tuple[float, float]:
        x, y = vector(v)
        return float(place[0] * length + x), float(place[1] * length + y)

    over = pins[0, 0] <= 0.0
    left = bool(rng.integers(2)) if not over else (pins[0, 1] * mirror > 0) != backwards
    root, tip = point(np.array([-1.0, 0.0])), point(np.zeros(2))
    held, free = ("end", "start") if backwards else ("start", "end")
    modulus, height, width = 1.0, 2.0 * half * length, 0.1 * length
    stiff = modulus * width * height**3 / 12.0
    still = bool((pins[0] == pins[1]).all())
    return Scene(
        name=f"drawn-{kind}",
        load_parameters=1 if kind == "through" else int(rng.integers(1, 8)),
        beams=(
            BeamSpec(
                name="b",
                start=tip if backwards else root,
                end=root if backwards else tip,
                width=width,
                height=height,
                youngs_modulus=modulus,
                poissons_ratio=0.3,
            ),
        ),
        supports=(
            SupportSpec(
                beam="b", end=held, kind="clamped", displacement=vector(moves) if moves.any() else None
            ),
        ),
        loads=(LoadSpec(beam="b", end=free, moment=moment * mirror * stiff / length),) if moment else (),
        pins=(
            PinSpec(
                name="ball",
                start=point(pins[0]),
                displacement=(0.0, 0.0) if still else vector(pins[1] - pins[0]),
                radius=radius * length or None,
            ),
        ),
        contacts=(
            ContactSpec(
                node="ball",
                beam="b",
                side="left" if left else "right",
                surface="axis" if face is None else "face",
            ),
        ),
    )

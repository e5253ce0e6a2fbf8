"""Drawn scenes with hinges, springs, stages, loads along and inside beams, weight, curvature and taper, one for every seed: ``python -m tests.fuzz special SEED`` prints it."""

import math
from collections.abc import Callable
from dataclasses import replace
from random import Random

from comparisons.scene import (
    FieldError,
    HingeSpec,
    LoadSpec,
    PinMove,
    Scene,
    SpringSpec,
    StageSpec,
    SupportMove,
)
from tests.fuzz.held import drawn_held
from tests.fuzz.world import ENDS, Corner, drawn, drawn_with_friction

ATTEMPTS = 40
"""Changes that are tried for a drawn scene before the next one is drawn."""
SPARE = 7_000_000
"""From the seed of a drawn scene that takes no change to the next one."""


def drawn_special(seed: int) -> Scene:
    """Return the scene of a seed: a drawn one, with friction or without, and one to three keys that are special."""
    random = Random(-2_000_000_000 - seed)  # noqa: S311 - nothing is secret
    while True:
        scene = drawn_with_friction(seed) if random.random() < 0.3 else drawn(seed)
        wanted = random.choice((1, 1, 2, 2, 3))
        changed = 0
        for _ in range(ATTEMPTS):
            try:
                scene = random.choice(CHANGES)(random, scene)
            except FieldError:
                continue
            changed += 1
            if changed == wanted:
                return replace(scene, name=f"special-{seed}")
        seed += SPARE


def stiffness(random: Random, scene: Scene, beam: str) -> tuple[float, float, float]:
    """EI/L, EI/L^2 and EI/L^3 of a beam, times one number."""
    spec, size = scene.beam(beam), 10.0 ** random.uniform(-2.0, 3.0)
    return tuple(size * spec.EI / spec.length**power for power in (1, 2, 3))  # type: ignore[return-value]


def vector(random: Random, size: float) -> Corner:
    """A vector of a size in any direction, or in an axis."""
    angle = random.choice((0.0, math.pi / 2, math.pi, -math.pi / 2, random.uniform(-math.pi, math.pi)))
    return round(size * math.cos(angle), 12), round(size * math.sin(angle), 12)


def hinge(random: Random, scene: Scene) -> Scene:
    """Hinge a beam's end."""
    beam, end = random.choice(scene.beams).name, random.choice(ENDS)
    turning = stiffness(random, scene, beam)[0] if random.random() < 0.3 else 0.0
    return replace(scene, hinges=(*scene.hinges, HingeSpec(beam=beam, end=end, stiffness=turning)))


def spring(random: Random, scene: Scene) -> Scene:
    """Hold a beam's end by springs, or exchange its support for springs."""
    beam, end = random.choice(scene.beams).name, random.choice(ENDS)
    turning, _, pulling = stiffness(random, scene, beam)
    x, y, rotation = random.choice(((1, 1, 0), (0, 1, 0), (1, 0, 0), (0, 0, 1), (1, 2, 1)))
    held = SpringSpec(beam=beam, end=end, stiffness=(x * pulling, y * pulling), rotation=rotation * turning)
    supports = scene.supports
    if random.random() < 0.3:
        supports = tuple(item for item in supports if item.node != held.node)
    return replace(scene, supports=supports, springs=(*scene.springs, held))


def stage(random: Random, scene: Scene) -> Scene:
    """Add a stage: pins go on or back, supports and loads too."""
    length = max(beam.length for beam in scene.beams)
    pins = tuple(
        PinMove(name=pin.name, path=_onward(random, pin.points, length))
        for pin in scene.pins
        if random.random() < 0.7
    )
    moves = tuple(
        SupportMove(
            beam=support.beam,
            end=support.end,
            displacement=vector(random, length * 10.0 ** random.uniform(-3.0, -1.0)),
            rotation=random.uniform(-0.5, 0.5) if "rotation" in support.held else 0.0,
        )
        for support in scene.all_supports
        if {"x", "y"} <= set(support.held) and random.random() < 0.2
    )
    loads = tuple(_changed(random, history.load) for history in scene.load_histories if random.random() < 0.7)
    count = random.choice((1, 2, 3, 5))
    more = StageSpec(load_parameters=count, pin=pins, support=moves, load=loads)
    return replace(scene, stages=(*scene.stages, more))


def _onward(random: Random, points: tuple[Corner, ...], length: float) -> tuple[Corner, ...]:
    """Points of a pin in a stage: back to where it was before, or on."""
    (x, y) = points[-1]
    if random.random() < 0.5:
        return (points[-2],)
    dx, dy = vector(random, length * random.uniform(0.01, 0.3))
    return ((x + dx, y + dy), *((points[-2],) if random.random() < 0.3 else ()))


def _changed(random: Random, load: LoadSpec) -> LoadSpec:
    """A change of a load: away, as much again, or something else."""
    part = random.choice((-1.0, -0.5, 0.5, random.uniform(-2.0, 1.0)))
    if load.force_per_length is not None:
        x, y = load.force_per_length
        return replace(load, force_per_length=(part * x, part * y))
    return replace(load, force=(part * load.force[0], part * load.force[1]), moment=part * load.moment)


def along(random: Random, scene: Scene) -> Scene:
    """Load a beam along a part, or inside."""
    beam = random.choice(scene.beams).name
    _, force, pulling = stiffness(random, scene, beam)
    size = min(force, 10.0 * force) * 10.0 ** random.uniform(-2.0, 0.0)
    if random.random() < 0.5:
        load = LoadSpec(beam=beam, at=round(random.uniform(0.05, 0.95), 3), force=vector(random, size))
        return replace(scene, loads=(*scene.loads, load))
    a, b = sorted(random.sample((0.0, 0.1, 0.25, 0.5, 0.7, 1.0), 2))
    part = None if random.random() < 0.5 else (a, b)
    more = vector(random, size * pulling / force)
    return replace(scene, loads=(*scene.loads, LoadSpec(beam=beam, force_per_length=more, part=part)))


def weight(random: Random, scene: Scene) -> Scene:
    """Give beams a weight."""
    heavy = tuple(
        replace(beam, density=random.uniform(0.1, 3.0) * beam.EI / beam.length**3 / beam.section()[0])
        if random.random() < 0.7
        else beam
        for beam in scene.beams
    )
    return replace(scene, beams=heavy, gravity=vector(random, 1.0))


def turn(random: Random, scene: Scene) -> Scene:
    """Curve a beam."""
    k = random.randrange(len(scene.beams))
    curved = replace(scene.beams[k], turn=random.choice((-0.1, 0.5, random.uniform(-3.0, 3.0))))
    return replace(scene, beams=(*scene.beams[:k], curved, *scene.beams[k + 1 :]))


def taper(random: Random, scene: Scene) -> Scene:
    """Taper a beam whose axis alone is touched."""
    k = random.randrange(len(scene.beams))
    beam = scene.beams[k]
    faces = any(contact.surface == "face" for contact in scene.contacts)
    if beam.height is None or faces:
        raise FieldError("height", beam.height, "is not there, or its face is touched")
    part = random.uniform(0.3, 1.5)
    height = (beam.height_at(0.0), part * beam.height_at(0.0))
    tapered = replace(beam, height=height)
    return replace(scene, beams=(*scene.beams[:k], tapered, *scene.beams[k + 1 :]))


CHANGES: tuple[Callable[[Random, Scene], Scene], ...] = (
    hinge, hinge, spring, spring, stage, stage, stage, along, weight, turn, taper,
)  # fmt: skip
DRAW = {"world": drawn, "friction": drawn_with_friction, "special": drawn_special, "held": drawn_held}
"""The scene of a seed, by kind."""

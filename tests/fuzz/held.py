"""Scenes of one beam that is held at both ends and shortened, one for every seed: ``python -m tests.fuzz held SEED`` prints it.

Clamped at both ends, or clamped and pinned; slender to stocky, straight and arched; shortened by one to four times what buckles it, some
by up to a third of the length; turned and moved aside, or neither, so that the path bifurcates; with a pin beside it, or without.
"""

import math
from random import Random

from comparisons.scene import InputError, Scene, read_scene
from tests.fuzz.world import Place, Tables, toml_text


def drawn_held(seed: int) -> Scene:
    """Return the scene of a seed: the first that its numbers make and that breaks no rule."""
    random = Random(-3_000_000_000 - seed)  # noqa: S311 - nothing is secret
    while True:
        try:
            return read_scene(toml_text(_tables(random, f"held-{seed}")), f"seed {seed}")
        except InputError:
            continue


def _tables(random: Random, name: str) -> Tables:
    place = Place(10.0 ** random.uniform(-1.0, 3.0), random.choice((0.0, math.pi / 2, -2.1)), (0.0, 0.0))
    length, height = place.length, 10.0 ** random.uniform(-2.7, -0.9)
    beam: Tables = {
        "name": "b", "start": place.point(0.0, 0.0), "end": place.point(1.0, 0.0), "clamped": ["start"],
        "width": height * length, "height": height * length,
        "youngs_modulus": 10.0 ** random.uniform(3.0, 11.0), "poissons_ratio": 0.3, "elements": 80,
    }  # fmt: skip
    kind = random.choice(("clamped", "clamped", "pinned"))
    # critical shortening over the length: the load, 39.5 or 20.2 EI/L^2, over EA
    critical = (39.478 if kind == "clamped" else 20.191) * height**2 / 12.0
    shortened = random.choice((1.0, 1.0, 1.0, 0.0)) * critical * random.uniform(1.0, 4.0) or random.uniform(
        0.02, 0.3
    )
    aside = random.choice((0.0, 0.0, random.uniform(-0.1, 0.1)))
    end: Tables = {"beam": "b", "end": "end", "kind": kind, "displacement": place.vector(-shortened, aside)}
    turn = random.choice((0.0, random.uniform(0.0, 0.4), 10.0 ** random.uniform(-6.0, -0.4)))
    if turn and kind == "clamped":
        end["rotation"] = turn
    if random.random() < 0.4:
        beam["turn"] = random.choice((-1.0, 1.0)) * 10.0 ** random.uniform(-3.0, 0.0)
    tables: Tables = {
        "scene": {"name": name, "load_parameters": 1}, "beam": [beam], "support": [end],
    }  # fmt: skip
    if random.random() < 0.4:
        side, at, far = random.choice((-1.0, 1.0)), random.uniform(0.15, 0.85), random.uniform(0.01, 0.15)
        begin, way = random.choice((0.0, 0.02)) + 1.0 / 8.0, random.uniform(-0.1, 0.1)
        path = {
            "start": place.point(at, -side * begin),
            "displacement": place.vector(way, side * (begin + far)),
        }
        tables["pin"] = [{"name": "p", **path}]
        tables["contact"] = [{"node": "p", "beam": "b", "side": "right" if side > 0 else "left"}]
    return tables

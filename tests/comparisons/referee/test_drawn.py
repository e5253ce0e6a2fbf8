"""Drawn scenes: what exact elements complete is certified at every load parameter, and on the branch that leads there from rest."""

import numpy as np
import pytest

from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.referee import certify
from comparisons.scene import BeamSpec, ContactSpec, PinSpec, Scene, SupportSpec

Rng = np.random.Generator


def beam(
    rng: Rng, name: str, start: tuple[float, float], end: tuple[float, float], height: float
) -> BeamSpec:
    return BeamSpec(
        name=name, start=start, end=end, clamped=("start",), width=height, height=height,
        youngs_modulus=1e7, poissons_ratio=float(rng.uniform(0.0, 0.45)),
    )  # fmt: skip


def pin(rng: Rng, name: str, x: float, offset: float, depth: float, radius: float | None = None) -> PinSpec:
    """Pin from the left, above, for positive depths, else from the right."""
    side = 1.0 if depth > 0.0 else -1.0
    first = (x, side * (offset + float(rng.uniform(0.0, 0.05))))
    return PinSpec(
        name=name, path=(first, (x + float(rng.uniform(-0.3, 0.2)), first[1] - depth)), radius=radius
    )


def one_pin(rng: Rng, height: float, surface: str) -> Scene:
    radius = float(10.0 ** rng.uniform(-2.0, -0.5)) if rng.random() < 0.5 else None
    offset = (height / 2.0 if surface == "face" else 0.0) + (radius or 0.0)
    return Scene(
        name="one-pin", load_parameters=int(rng.integers(2, 9)), beams=(beam(rng, "b", (0.0, 0.0), (1.0, 0.0), height),),
        pins=(pin(rng, "p", float(rng.uniform(0.4, 0.95)), offset, -float(rng.uniform(0.05, 0.6)), radius),),
        contacts=(ContactSpec(node="p", beam="b", side="right", surface=surface),),
    )  # fmt: skip


def two_pins(rng: Rng, height: float, surface: str) -> Scene:
    offset = height / 2.0 if surface == "face" else 0.0
    return Scene(
        name="two-pins", load_parameters=int(rng.integers(2, 9)), beams=(beam(rng, "b", (0.0, 0.0), (1.0, 0.0), height),),
        pins=(
            pin(rng, "p", float(rng.uniform(0.3, 0.5)), offset, -float(rng.uniform(0.02, 0.15))),
            pin(rng, "q", float(rng.uniform(0.65, 0.95)), offset, float(rng.uniform(0.02, 0.15))),
        ),
        contacts=(
            ContactSpec(node="p", beam="b", side="right", surface=surface),
            ContactSpec(node="q", beam="b", side="left", surface=surface),
        ),
    )  # fmt: skip


def two_beams(rng: Rng, height: float, surface: str) -> Scene:
    gap = height + float(rng.uniform(0.05, 0.2))
    return Scene(
        name="two-beams", load_parameters=int(rng.integers(2, 9)),
        beams=(beam(rng, "u", (0.0, 0.0), (1.0, 0.0), height), beam(rng, "d", (0.1, -gap), (1.3, -gap), height)),
        pins=(pin(rng, "p", float(rng.uniform(0.5, 0.8)), 0.0, float(rng.uniform(0.1, 0.5))),),
        contacts=(
            ContactSpec(node="p", beam="u", side="left"),
            ContactSpec(node="u.end", beam="d", side="left", surface=surface),
            ContactSpec(node="p", beam="d", side="left"),
        ),
    )  # fmt: skip


def held(rng: Rng, height: float, surface: str) -> Scene:
    """A pin on a beam whose other end is moved: often a strut that buckles."""
    offset = height / 2.0 if surface == "face" else 0.0
    moved = (float(rng.uniform(-0.4, 0.02)), float(rng.uniform(-0.3, 0.3)))
    return Scene(
        name="held", load_parameters=int(rng.integers(2, 9)), beams=(beam(rng, "b", (0.0, 0.0), (1.0, 0.0), height),),
        supports=(SupportSpec(beam="b", end="end", kind=("pinned", "clamped")[rng.integers(2)], displacement=moved),),
        pins=(pin(rng, "p", float(rng.uniform(0.3, 0.7)), offset, -float(rng.uniform(0.05, 0.3))),),
        contacts=(ContactSpec(node="p", beam="b", side="right", surface=surface),),
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("draw", [one_pin, two_pins, two_beams, held])
def test_what_exact_elements_complete_is_certified_all_along(draw: object) -> None:
    completed = 0
    for seed in range(12):
        rng = np.random.default_rng(seed)
        scene = draw(rng, float(10.0 ** rng.uniform(-2.4, -0.9)), ("axis", "face")[rng.integers(2)])  # type: ignore[operator]
        response = solve(scene, "tsm", Options(element="exact"))
        if not response.completed:
            continue
        completed += 1
        found = certify(response, scene, at=range(scene.load_parameters))
        assert found.certified, f"seed {seed}: {found.line()}"
        for item in found.judged:
            apart, unloaded = item.distance, item.exact.strain_energy < 1e-15 * scene.beams[0].EI
            assert max(apart.force, apart.arc_position, apart.tip) < 1e-6
            # of an unloaded beam the solver's forces are its tolerance
            assert unloaded or apart.reaction < 1e-6
    assert completed >= 6

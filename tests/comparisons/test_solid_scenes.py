"""The solid by its end sections, with the rod's law, against exact elements: the difference is of the order of the height squared."""

import tomllib
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from pathlib import Path
from string import Template

import numpy as np
import pytest

from comparisons.answer import Response
from comparisons.models import certified, solve
from comparisons.models.model import Options
from comparisons.scene import Scene, load_scene, read_scene

FINDINGS = Path(__file__).parent / "findings"
EXACT = Options(element="exact")
SCENES = tomllib.loads(Path(__file__).with_name("solid_scenes.toml").read_text(encoding="utf-8"))
SECTION = "youngs_modulus = 1.0\npoissons_ratio = 0.3\nmesh = [50, 2]\nmaterial = 'biot-linear'\n"


def scene(name: str, height: float, **chosen: object) -> Scene:
    """A scene of the table at a height, with some of the values below chosen."""
    width = 12.0 / height**3
    given = {
        "width": width, "height": height, "narrow": width / 2, "low": 0.6 * height, "section": SECTION,
        "size": f"width = {width}\nheight = {height}\n{SECTION}", "aside": 1e-3, "rise": 1e-4,
        # a round pin below the axis or a face, on which its strut rolls
        "press": 2e-4, "heavy": 5 / width / height, "surface": "axis",
        "below": 0.05 + height / 2 * (chosen.get("surface") == "face"),
        # a round pin above the top of an arc that turns by -1.4, and one above a sloping face
        "above": 0.5 * (1 - np.cos(0.7)) / np.sin(0.7) + height / 2 + 0.0501, "slope": 0.05 + 0.341 * height,
    }  # fmt: skip
    return read_scene(Template(SCENES[name]).substitute(given | chosen), name)


def values(response: Response) -> tuple[np.ndarray, np.ndarray]:
    """Forces of contacts, supports and springs (s, n), and moments (s, m), at every load parameter."""
    held = (*response.supports.values(), *response.springs.values())
    forces = [contact.force[:, None] for contact in response.contacts.values()] + [
        item.force for item in held
    ]
    return np.hstack(forces), np.stack([item.moment for item in held], axis=1)


def cut(case: Scene, solid: Response, exact: Response) -> Iterator[np.ndarray]:
    """Yield section forces, then moments, of both at the ends of the solid's stations, (2, ...)."""
    steps = range(len(exact.load_parameter))
    for letters in ("NV", "M"):
        found = []
        for beam, k, letter in product(case.beams, steps, letters):
            own, rods = solid.sections(beam.name, k), exact.sections(beam.name, k)
            there = np.interp(own.arc[[0, -1]], rods.arc, getattr(rods, letter))
            found.append((getattr(own, letter)[[0, -1]], there))
        yield np.swapaxes(found, 0, 1)


def distance(case: Scene, mesh: tuple[int, int] | None = None, *, inside: bool = True) -> float:
    """Largest difference of a force or moment, also inside the beams, over the largest of the path, and of the tips over the length; certified and stable."""
    exact, solid = solve(case, "tsm", EXACT), solve(case, "solid", Options(mesh=mesh))
    assert exact.completed, exact.message
    assert certified(solid, case).completed, solid.message
    assert list(solid.index) == list(exact.index)
    found = [np.abs(solid.tips[beam.name] - exact.tips[beam.name]).max() / beam.length for beam in case.beams]
    pairs = [*zip(values(solid), values(exact), strict=True)] + inside * [*cut(case, solid, exact)]
    found += [np.abs(a - b).max() / (np.abs(b).max() or 1.0) for a, b in pairs]
    return float(max(found))


@pytest.mark.slow_at("turned pins", "moved clamp", "pushed between", "raised")
@pytest.mark.slow_at("other end", "sliding on an arc", "stuck strut")
@pytest.mark.parametrize("case", SCENES)
def test_forces_and_reactions_are_the_rods(case):
    """Within a thousandth at h/L = .02."""
    assert distance(scene(case, 0.02), (40, 1)) < 1e-3


def test_a_straight_strut_that_sticks_bifurcates_where_the_rods_does():
    """A slip elsewhere does not hide it in one step; one from before on, until it comes to rest where the pin turns."""
    cases = [
        replace(scene("stuck strut", 0.02, aside=0.0, rise=rise), load_parameters=1) for rise in (5e-4, 0.02)
    ]
    solids = [solve(case, "solid", Options(mesh=(40, 1))) for case in cases]
    found = [solve(cases[0], "tsm", EXACT), *solids]
    assert [item.status for item in found] == ["BIFURCATION"] * 3
    exact, solid = (point.load_parameter for item in found for point in item.critical)
    assert solid == pytest.approx(exact, rel=1e-3)
    assert solids[1].message.endswith("at load parameter 0.5")


@pytest.mark.parametrize("surface", ["axis", "face"])
def test_a_strut_rolls_on_a_round_pin_and_bifurcates_where_the_rods_does(surface):
    """Held at its arc position it would bear nearly twice the force, and on its face not bifurcate."""
    case = scene("rolling strut", 0.02, press=0.0025, surface=surface)
    answers = solve(case, "tsm", EXACT), solve(case, "solid", Options(mesh=(40, 1)))
    exact, solid = (point.load_parameter for answer in answers for point in answer.critical)
    assert solid == pytest.approx(exact, rel=1e-2)


@pytest.mark.slow
@pytest.mark.parametrize("case", ["moved clamp", "driven tip", "frame"])
def test_the_difference_falls_as_the_height_squared(case):
    thick, thin = (
        distance(scene(case, h), mesh, inside=False) for h, mesh in ((0.02, None), (0.01, (100, 2)))
    )
    assert np.log2(thick / thin) == pytest.approx(2.0, abs=0.25)


def test_a_frame_of_a_user_is_the_rods():
    """A portal stated by area and second moment."""
    portal = load_scene(str(FINDINGS / "portal.toml"))
    beams = tuple(replace(item, material="biot-linear") for item in portal.beams)
    assert distance(replace(portal, beams=beams)) < 1e-4
